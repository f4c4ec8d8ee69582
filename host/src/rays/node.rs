//! The nodes of the tree: a few boxes tested at once.

use wide::f32x4;

use super::{bounds::Bounds, probe::Probe};

/// How many vectors of four boxes a node holds.
const QUADS: usize = 2;
/// How many children a node has at most.
pub(super) const WIDTH: usize = 4 * QUADS;

/// What a child is: an inner node, or a leaf of one kind; the kind is in the top three bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Child(pub u32);

/// What a leaf holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub(super) enum Leaf {
    /// A packet of up to four triangles.
    Packet = 4,
    Sphere = 5,
    Disk = 6,
    Cylinder = 7,
}

impl Child {
    /// How many leaves of a kind there can be.
    pub const MOST: usize = 1 << 27;

    pub fn inner(index: usize) -> Self {
        Self(index as u32)
    }

    pub fn leaf(kind: Leaf, index: usize) -> Self {
        Self((kind as u32) << 29 | index as u32)
    }

    #[inline(always)]
    pub fn is_leaf(self) -> bool {
        self.0 >> 31 != 0
    }

    #[inline(always)]
    pub fn kind(self) -> Leaf {
        match self.0 >> 29 {
            5 => Leaf::Sphere,
            6 => Leaf::Disk,
            7 => Leaf::Cylinder,
            _ => Leaf::Packet,
        }
    }

    /// Of a leaf, among its kind.
    #[inline(always)]
    pub fn index(self) -> usize {
        (self.0 & 0x1fff_ffff) as usize
    }
}

/// Up to [`WIDTH`] boxes and what is in them.
#[derive(Clone, Debug)]
pub(super) struct Node {
    /// Minima and maxima: x, y, z; then x, y, z. Empty boxes are turned inside out, so that no ray enters them.
    rows: [[f32x4; QUADS]; 6],
    pub children: [Child; WIDTH],
}

impl Node {
    pub fn new(children: &[(Bounds, Child)]) -> Self {
        let mut rows = [[0.0_f32; WIDTH]; 6];
        let mut refs = [Child(0); WIDTH];
        for lane in 0..WIDTH {
            let (bounds, child) = children.get(lane).copied().unwrap_or((Bounds::EMPTY, Child(0)));
            refs[lane] = child;
            for axis in 0..3 {
                rows[axis][lane] = bounds.min[axis];
                rows[axis + 3][lane] = bounds.max[axis];
            }
        }
        let rows = rows.map(|row| std::array::from_fn(|quad| f32x4::new(std::array::from_fn(|lane| row[4 * quad + lane]))));
        Self { rows, children: refs }
    }

    /// Which boxes the ray is in before `t`, as bits, and where it enters them.
    /// The slab test of Kay and Kajiya 1986; its rounding (Ize 2013) is in the probe's slack.
    #[inline(always)]
    pub fn hit(&self, probe: &Probe, t: f32) -> (u32, [f32; WIDTH]) {
        let mut mask = 0;
        let mut entries = [0.0; WIDTH];
        let [nx, ny, nz] = probe.near_row.map(|row| &self.rows[row]);
        let [fx, fy, fz] = probe.far_row.map(|row| &self.rows[row]);
        for quad in 0..QUADS {
            let near_x = (nx[quad] - probe.near_origin[0]) * probe.inverse[0];
            let near_y = (ny[quad] - probe.near_origin[1]) * probe.inverse[1];
            let near_z = (nz[quad] - probe.near_origin[2]) * probe.inverse[2];
            let far_x = (fx[quad] - probe.far_origin[0]) * probe.inverse[0];
            let far_y = (fy[quad] - probe.far_origin[1]) * probe.inverse[1];
            let far_z = (fz[quad] - probe.far_origin[2]) * probe.inverse[2];
            let near = near_x.fast_max(near_y).fast_max(near_z.fast_max(f32x4::ZERO));
            let far = far_x.fast_min(far_y).fast_min(far_z.fast_min(f32x4::splat(t)));
            mask |= near.simd_le(far).to_bitmask() << (4 * quad);
            entries[4 * quad..4 * quad + 4].copy_from_slice(&near.to_array());
        }
        (mask, entries)
    }
}
