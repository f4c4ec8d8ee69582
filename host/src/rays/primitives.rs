//! What goes into a tree.

use bidir_kernel::Vec3;

use super::{
    cylinder::Cylinder, disk::Disk, instance::Instance, nearest::Key, parallelogram::Parallelogram, sphere::Sphere, triangle::Triangle,
};

/// A primitive's number: how many were inserted before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PrimitiveId(pub u32);

/// Which rays see a primitive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Visibility {
    /// All.
    #[default]
    Everywhere,
    /// All but those that end on the lens ([`bidir_kernel::Segment::Lens`]).
    HiddenFromLens,
}

/// A list of primitives, kept by kind. All of them have to be finite and of more than no area. What is inserted gets the next
/// number, or is left out, which is told by `None`, where the list holds [`Primitives::MOST`].
#[derive(Clone, Debug, Default)]
pub struct Primitives {
    count: u32,
    pub(super) some_hidden: bool,
    pub(super) triangles: Kind<Triangle>,
    pub(super) spheres: Kind<Sphere>,
    pub(super) disks: Kind<Disk>,
    pub(super) cylinders: Kind<Cylinder>,
    pub(super) instances: Kind<Instance>,
}

/// The primitives of one kind and whose they are.
#[derive(Clone, Debug)]
pub(super) struct Kind<T> {
    pub shapes: Vec<T>,
    pub keys: Vec<Key>,
}

impl<T> Default for Kind<T> {
    fn default() -> Self {
        Self { shapes: Vec::new(), keys: Vec::new() }
    }
}

impl<T> Kind<T> {
    fn push(&mut self, shape: T, key: Key) {
        self.shapes.push(shape);
        self.keys.push(key);
    }

    pub fn len(&self) -> usize {
        self.shapes.len()
    }
}

impl Primitives {
    /// How many there can be, and how many triangles, of which a parallelogram is two: places in a tree have 28 bits.
    pub const MOST: usize = (1 << 28) - 1;

    /// None yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.count as usize
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Makes room for that many more triangles.
    pub fn reserve_triangles(&mut self, more: usize) {
        self.triangles.shapes.reserve(more);
        self.triangles.keys.reserve(more);
    }

    /// Inserts the triangle a, b, c; its normal is (b − a) × (c − a).
    pub fn triangle(&mut self, corners: [Vec3; 3], visibility: Visibility) -> Option<PrimitiveId> {
        let key = self.next(visibility, 1)?;
        self.triangles.push(corners, key);
        Some(PrimitiveId(key.primitive()))
    }

    /// Inserts a parallelogram.
    pub fn parallelogram(&mut self, shape: Parallelogram, visibility: Visibility) -> Option<PrimitiveId> {
        let key = self.next(visibility, 2)?;
        let [first, second] = shape.halves();
        self.triangles.push(first, key);
        self.triangles.push(second, key.second_half());
        Some(PrimitiveId(key.primitive()))
    }

    /// Inserts a sphere.
    pub fn sphere(&mut self, shape: Sphere, visibility: Visibility) -> Option<PrimitiveId> {
        let key = self.next(visibility, 0)?;
        self.spheres.push(shape, key);
        Some(PrimitiveId(key.primitive()))
    }

    /// Inserts a disk or an ellipse.
    pub fn disk(&mut self, shape: Disk, visibility: Visibility) -> Option<PrimitiveId> {
        let key = self.next(visibility, 0)?;
        self.disks.push(shape, key);
        Some(PrimitiveId(key.primitive()))
    }

    /// Inserts the side of a cylinder.
    pub fn cylinder(&mut self, shape: Cylinder, visibility: Visibility) -> Option<PrimitiveId> {
        let key = self.next(visibility, 0)?;
        self.cylinders.push(shape, key);
        Some(PrimitiveId(key.primitive()))
    }

    /// Inserts an instance.
    pub fn instance(&mut self, shape: Instance, visibility: Visibility) -> Option<PrimitiveId> {
        let key = self.next(visibility, 0)?;
        self.some_hidden |= shape.geometry().some_hidden;
        self.instances.push(shape, key);
        Some(PrimitiveId(key.primitive()))
    }

    fn next(&mut self, visibility: Visibility, triangles: usize) -> Option<Key> {
        if self.len() >= Self::MOST || self.triangles.len() + triangles > Self::MOST {
            return None;
        }
        let hidden = visibility == Visibility::HiddenFromLens;
        let key = Key::new(self.count, hidden);
        self.count += 1;
        self.some_hidden |= hidden;
        Some(key)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_list_takes_nothing_more() {
        let mut all = Primitives { count: Primitives::MOST as u32 - 1, ..Primitives::default() };
        let mut insert = || all.triangle([Vec3::ZERO, Vec3::X, Vec3::Y], Visibility::Everywhere);
        assert_eq!(insert(), Some(PrimitiveId((1 << 28) - 2)));
        assert_eq!(insert(), None);
        assert_eq!((all.len(), all.triangles.len()), (Primitives::MOST, 1));
    }
}
