//! The tree and the way of a ray through it.

use std::{cell::RefCell, mem::size_of_val};

use bidir_kernel::Ray;
use glam::DVec3;

use super::{
    Geometry, RayHit,
    bounds::Bounds,
    build::BuildStats,
    cylinder::RoundCylinder,
    disk::FlatDisk,
    lanes::{Lanes, Machine, Work},
    nearest::{Key, Nearest},
    node::{Child, Leaf, Node, Slabs, WIDTH},
    primitives::PrimitiveId,
    probe::Probe,
    sphere::Sphere,
    surface::SurfacePoint,
    triangle::{PACKET, Packet},
};

/// A bounding volume hierarchy over triangles and analytic shapes.
#[derive(Clone, Debug)]
pub struct Bvh {
    pub(super) nodes: Vec<Node>,
    pub(super) packets: Vec<Packet>,
    pub(super) spheres: Vec<Owned<Sphere>>,
    pub(super) disks: Vec<Owned<FlatDisk>>,
    pub(super) cylinders: Vec<Owned<RoundCylinder>>,
    pub(super) root: Option<Child>,
    /// How many nodes a ray can have waiting.
    pub(super) most_waiting: usize,
    pub(super) stats: BuildStats,
    bounds: Bounds,
    some_hidden: bool,
    machine: Machine,
    triangles: Triangles,
}

/// A shape and whose it is.
#[derive(Clone, Debug)]
pub(super) struct Owned<T> {
    pub shape: T,
    pub key: Key,
}

/// A subtree that waits for the ray, and where the ray enters it.
type Waiting = (Child, f32);

const NONE: Waiting = (Child(0), 0.0);

/// As many subtrees as wait in all but degenerate trees.
const STACK: usize = 512;

thread_local! {
    /// Kept from ray to ray: clearing it would cost as much as a ray in a small tree.
    static WAITING: RefCell<[Waiting; STACK]> = const { RefCell::new([NONE; STACK]) };
}

/// How rays meet triangles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Triangles {
    /// No ray passes between triangles that share an edge or a corner.
    #[default]
    Watertight,
    /// A little sooner; now and then a ray passes between neighbours.
    Fast,
}

/// One ray's way down.
struct Descent<'a, const ANY: bool, const FAST: bool> {
    bvh: &'a Bvh,
    probe: &'a Probe,
    root: Child,
    stack: &'a mut [Waiting],
}

impl<const ANY: bool, const FAST: bool> Work for Descent<'_, ANY, FAST> {
    type Output = Nearest;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> Nearest {
        let Self { bvh, probe, root, stack } = self;
        let slabs = Slabs::new(lanes, probe);
        let mut nearest = Nearest::before(probe.limit);
        let mut current = root;
        let mut waiting = 0;
        loop {
            let next = if current.is_leaf() {
                bvh.visit::<FAST>(current, probe, &mut nearest);
                if ANY && nearest.found() {
                    return nearest;
                }
                None
            } else {
                let node = &bvh.nodes[current.0 as usize];
                let (mask, entries) = slabs.enter(node, nearest.t);
                order(lanes, bvh, node, (mask, &entries), stack, &mut waiting)
            };
            current = match next {
                Some(child) => child,
                None => loop {
                    if waiting == 0 {
                        return nearest;
                    }
                    waiting -= 1;
                    let (child, entry) = stack[waiting];
                    if entry <= nearest.t {
                        break child;
                    }
                },
            };
        }
    }
}

impl Geometry for Bvh {
    #[inline]
    fn closest(&self, ray: &Ray) -> Option<RayHit> {
        let nearest = self.cast::<false>(ray)?;
        let mut coordinates = nearest.coordinates;
        if nearest.key.is_second_half() {
            coordinates = (1.0 - coordinates.0, 1.0 - coordinates.1);
        }
        Some(RayHit { t: nearest.t, primitive: PrimitiveId(nearest.key.primitive()), coordinates, slot: nearest.slot })
    }

    #[inline]
    fn occluded(&self, ray: &Ray) -> bool {
        self.cast::<true>(ray).is_some()
    }

    fn surface(&self, ray: &Ray, hit: &RayHit) -> SurfacePoint {
        let leaf = Child(hit.slot);
        let on_ray = || ray.origin.as_dvec3() + ray.direction.as_dvec3() * f64::from(hit.t);
        match leaf.kind() {
            Leaf::Packet => {
                let (packet, lane) = (&self.packets[leaf.index() / PACKET], leaf.index() % PACKET);
                let [a, b, c] = packet.triangle(lane).map(|corner| corner.as_dvec3());
                let (x, y) = (b - a, c - a);
                let (one, two) = (f64::from(hit.coordinates.0), f64::from(hit.coordinates.1));
                let (b1, b2) = if packet.keys[lane].is_second_half() { (1.0 - one, 1.0 - two) } else { (one, two) };
                let normal = x.cross(y).normalize_or(DVec3::Z);
                SurfacePoint::new(a + x * b1 + y * b2, normal, DVec3::new(one, two, 0.0), &self.bounds)
            }
            Leaf::Sphere => {
                let sphere = &self.spheres[leaf.index()].shape;
                let normal = sphere.normal(on_ray());
                SurfacePoint::new(sphere.point(normal), normal, normal, &self.bounds)
            }
            Leaf::Disk => {
                let disk = &self.disks[leaf.index()].shape;
                let (a, b) = disk.coordinates(on_ray());
                SurfacePoint::new(disk.centre + disk.x * a + disk.y * b, disk.normal, DVec3::new(a, b, 0.0), &self.bounds)
            }
            Leaf::Cylinder => {
                let cylinder = &self.cylinders[leaf.index()].shape;
                let (normal, local) = cylinder.normal(on_ray());
                SurfacePoint::new(cylinder.point(normal, local.z), normal, local, &self.bounds)
            }
        }
    }

    fn bounds(&self) -> Bounds {
        self.bounds
    }
}

impl Bvh {
    pub(super) fn empty(bounds: Bounds, some_hidden: bool) -> Self {
        Self {
            nodes: vec![],
            packets: vec![],
            spheres: vec![],
            disks: vec![],
            cylinders: vec![],
            root: None,
            most_waiting: 0,
            stats: BuildStats::default(),
            bounds,
            some_hidden,
            machine: Machine::detected(),
            triangles: Triangles::default(),
        }
    }

    /// The same tree with triangles met in another way.
    pub fn with_triangles(self, triangles: Triangles) -> Self {
        Self { triangles, ..self }
    }

    /// The same tree without the registers that only some machines have. Answers are the same, bit for bit.
    pub fn portable(self) -> Self {
        Self { machine: Machine::Any, ..self }
    }

    /// What building took and made.
    pub fn stats(&self) -> BuildStats {
        self.stats
    }

    pub(super) fn bytes(&self) -> usize {
        size_of_val(&*self.nodes)
            + size_of_val(&*self.packets)
            + size_of_val(&*self.spheres)
            + size_of_val(&*self.disks)
            + size_of_val(&*self.cylinders)
    }

    /// The nearest hit, or with `ANY` whichever is found first.
    #[inline(always)]
    fn cast<const ANY: bool>(&self, ray: &Ray) -> Option<Nearest> {
        let root = self.root?;
        let probe = &Probe::new(ray, &self.bounds, self.some_hidden)?;
        let nearest = if self.most_waiting <= STACK {
            WAITING.with_borrow_mut(|stack| self.descend::<ANY>(probe, root, stack))
        } else {
            self.descend::<ANY>(probe, root, &mut vec![NONE; self.most_waiting])
        };
        let mut nearest = nearest.found().then_some(nearest)?;
        let leaf = Child(nearest.slot);
        if !ANY && leaf.kind() == Leaf::Packet && self.triangles == Triangles::Watertight {
            let t = self.packets[leaf.index() / PACKET].exact_distance(probe, leaf.index() % PACKET);
            if t > 0.0 && t < probe.limit {
                nearest.t = t;
            }
        }
        Some(nearest)
    }

    #[inline(always)]
    fn descend<const ANY: bool>(&self, probe: &Probe, root: Child, stack: &mut [Waiting]) -> Nearest {
        let machine = if probe.fusible { self.machine } else { Machine::Any };
        match self.triangles {
            Triangles::Watertight => machine.run(Descent::<ANY, false> { bvh: self, probe, root, stack }),
            Triangles::Fast => machine.run(Descent::<ANY, true> { bvh: self, probe, root, stack }),
        }
    }

    #[inline(always)]
    fn prefetch<L: Lanes>(&self, lanes: L, child: Child) {
        if !child.is_leaf() {
            lanes.prefetch(&self.nodes, child.index());
        } else if child.kind() == Leaf::Packet {
            lanes.prefetch(&self.packets, child.index());
        }
    }

    /// Offers what the ray hits in a leaf.
    #[inline(always)]
    fn visit<const FAST: bool>(&self, leaf: Child, probe: &Probe, nearest: &mut Nearest) {
        if leaf.kind() == Leaf::Packet {
            let slot = Child::leaf(Leaf::Packet, leaf.index() * PACKET);
            let packet = &self.packets[leaf.index()];
            return if FAST { packet.intersect_fast(probe, slot.0, nearest) } else { packet.intersect(probe, slot.0, nearest) };
        }
        let (origin, direction) = probe.in_f64();
        let (t, key) = match leaf.kind() {
            Leaf::Sphere => {
                let sphere = &self.spheres[leaf.index()];
                (sphere.shape.distance(origin, direction), sphere.key)
            }
            Leaf::Disk => {
                let disk = &self.disks[leaf.index()];
                (disk.shape.distance(origin, direction), disk.key)
            }
            Leaf::Cylinder | Leaf::Packet => {
                let cylinder = &self.cylinders[leaf.index()];
                (cylinder.shape.distance(origin, direction), cylinder.key)
            }
        };
        let t = t as f32;
        if nearest.loses_to(t, key) && !(probe.hide && key.hidden_from_lens()) {
            *nearest = Nearest { t, key, slot: leaf.0, coordinates: (0.0, 0.0) };
        }
    }
}

/// The nearest of the children that the ray enters; the others wait, the nearer on top.
#[inline(always)]
fn order<L: Lanes>(
    lanes: L,
    bvh: &Bvh,
    node: &Node,
    (mut mask, entries): (u32, &[f32; WIDTH]),
    stack: &mut [Waiting],
    waiting: &mut usize,
) -> Option<Child> {
    if mask == 0 {
        return None;
    }
    let lane = mask.trailing_zeros() as usize;
    mask &= mask - 1;
    let mut first = (node.children[lane], entries[lane]);
    if mask == 0 {
        return Some(first.0);
    }
    bvh.prefetch(lanes, first.0);
    let floor = *waiting;
    while mask != 0 {
        let lane = mask.trailing_zeros() as usize;
        mask &= mask - 1;
        let mut one = (node.children[lane], entries[lane]);
        bvh.prefetch(lanes, one.0);
        if one.1 < first.1 {
            std::mem::swap(&mut one, &mut first);
        }
        let mut place = *waiting;
        while place > floor && stack[place - 1].1 < one.1 {
            stack[place] = stack[place - 1];
            place -= 1;
        }
        stack[place] = one;
        *waiting += 1;
    }
    Some(first.0)
}
