//! Parallelograms: one primitive for its owner, two triangles for the ray.

use bidir_kernel::Vec3;

use super::triangle::Triangle;

/// The points corner + a·x + b·y with a, b in 0 … 1; the normal is x × y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parallelogram {
    /// One corner, in the world.
    pub corner: Vec3,
    /// The first edge from there.
    pub x: Vec3,
    /// The second edge from there.
    pub y: Vec3,
}

impl Parallelogram {
    /// The half at the corner and the half opposite, which sees the coordinates (1 − a, 1 − b).
    pub(super) fn halves(&self) -> [Triangle; 2] {
        let (right, left) = (self.corner + self.x, self.corner + self.y);
        [[self.corner, right, left], [right + self.y, left, right]]
    }
}
