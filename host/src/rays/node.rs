//! The nodes of the tree: a few boxes tested at once.

use super::{bounds::Bounds, lanes::Lanes, probe::Probe};

pub(super) use super::lanes::WIDTH;

/// What a child is: an inner node, or a leaf of one kind. The top bit tells leaves; the next is 0 for a packet, which leaves
/// thirty bits for its number, or for that of one of its triangles; else two more tell the kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Child(pub u32);

/// What a leaf holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub(super) enum Leaf {
    /// A packet of up to four triangles.
    Packet = 8,
    Sphere = 12,
    Disk = 13,
    Cylinder = 14,
    Instance = 15,
}

impl Child {
    pub fn inner(index: usize) -> Self {
        Self(index as u32)
    }

    pub fn leaf(kind: Leaf, index: usize) -> Self {
        Self((kind as u32) << 28 | index as u32)
    }

    #[inline(always)]
    pub fn is_leaf(self) -> bool {
        self.0 >> 31 != 0
    }

    #[inline(always)]
    pub fn kind(self) -> Leaf {
        match self.0 >> 28 {
            12 => Leaf::Sphere,
            13 => Leaf::Disk,
            14 => Leaf::Cylinder,
            15 => Leaf::Instance,
            _ => Leaf::Packet,
        }
    }

    /// Of a packet, or of a triangle in one.
    #[inline(always)]
    pub fn packet(self) -> usize {
        (self.0 & 0x3fff_ffff) as usize
    }

    /// Of any other leaf, among its kind.
    #[inline(always)]
    pub fn index(self) -> usize {
        (self.0 & 0x0fff_ffff) as usize
    }
}

/// Up to [`WIDTH`] boxes and what is in them.
#[derive(Clone, Debug)]
#[repr(align(32))]
pub(super) struct Node {
    /// Per axis minima and maxima. Empty boxes are turned inside out, so that no ray enters them.
    rows: [[[f32; WIDTH]; 2]; 3],
    pub children: [Child; WIDTH],
}

impl Node {
    pub fn new(children: &[(Bounds, Child)]) -> Self {
        let mut node = Self { rows: [[[0.0; WIDTH]; 2]; 3], children: [Child(0); WIDTH] };
        for lane in 0..WIDTH {
            let (bounds, child) = children.get(lane).copied().unwrap_or((Bounds::EMPTY, Child(0)));
            node.children[lane] = child;
            for axis in 0..3 {
                node.rows[axis][0][lane] = bounds.min[axis];
                node.rows[axis][1][lane] = bounds.max[axis];
            }
        }
        node
    }
}

/// What of a ray meets boxes.
#[derive(Clone, Copy)]
pub(super) struct Slabs<L: Lanes> {
    lanes: L,
    backwards: [bool; 3],
    near_start: [L::Eight; 3],
    far_start: [L::Eight; 3],
    inverse: [L::Eight; 3],
}

impl<L: Lanes> Slabs<L> {
    #[inline(always)]
    pub fn new(lanes: L, probe: &Probe) -> Self {
        Self {
            lanes,
            backwards: probe.backwards,
            near_start: std::array::from_fn(|axis| lanes.start(probe.near_origin[axis], probe.inverse[axis])),
            far_start: std::array::from_fn(|axis| lanes.start(probe.far_origin[axis], probe.inverse[axis])),
            inverse: probe.inverse.map(|inverse| lanes.splat(inverse)),
        }
    }

    /// Which boxes the ray is in before `t`, as bits, and where it enters them.
    /// The slab test of Kay and Kajiya 1986; its rounding (Ize 2013) is in the probe's slack.
    #[inline(always)]
    pub fn enter(&self, node: &Node, t: f32) -> (u32, [f32; WIDTH]) {
        let lanes = self.lanes;
        let plane = |axis: usize, upper: bool| lanes.load(&node.rows[axis][usize::from(upper)]);
        let near = |axis: usize| lanes.along(plane(axis, self.backwards[axis]), self.near_start[axis], self.inverse[axis]);
        let far = |axis: usize| lanes.along(plane(axis, !self.backwards[axis]), self.far_start[axis], self.inverse[axis]);
        let entry = lanes.max(lanes.max(near(0), near(1)), lanes.max(near(2), lanes.splat(0.0)));
        let exit = lanes.min(lanes.min(far(0), far(1)), lanes.min(far(2), lanes.splat(t)));
        (lanes.at_most(entry, exit), lanes.store(entry))
    }
}
