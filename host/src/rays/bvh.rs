//! The tree and the way of a ray through it.

use std::mem::size_of_val;

use bidir_kernel::Ray;
use glam::DVec3;

use super::{
    Geometry, RayHit,
    bounds::Bounds,
    build::BuildStats,
    cylinder::RoundCylinder,
    disk::FlatDisk,
    nearest::{Key, Nearest},
    node::{Child, Leaf, Node},
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
}

/// A shape and whose it is.
#[derive(Clone, Debug)]
pub(super) struct Owned<T> {
    pub shape: T,
    pub key: Key,
}

/// A subtree that waits for the ray, and where the ray enters it.
type Waiting = (Child, f32);

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
        }
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
        let probe = Probe::new(ray, &self.bounds, self.some_hidden)?;
        const NONE: Waiting = (Child(0), 0.0);
        // Small trees get a small stack: clearing a large one would cost as much as the ray.
        let nearest = match self.most_waiting {
            0..=16 => self.descend::<ANY>(&probe, root, &mut [NONE; 16]),
            17..=32 => self.descend::<ANY>(&probe, root, &mut [NONE; 32]),
            33..=64 => self.descend::<ANY>(&probe, root, &mut [NONE; 64]),
            most => self.descend::<ANY>(&probe, root, &mut vec![NONE; most]),
        };
        nearest.found().then_some(nearest)
    }

    fn descend<const ANY: bool>(&self, probe: &Probe, root: Child, stack: &mut [Waiting]) -> Nearest {
        let mut nearest = Nearest::before(probe.limit);
        let mut current = root;
        let mut waiting = 0;
        loop {
            let next = if current.is_leaf() {
                self.visit(current, probe, &mut nearest);
                if ANY && nearest.found() {
                    return nearest;
                }
                None
            } else {
                let node = &self.nodes[current.0 as usize];
                let (mask, entries) = node.hit(probe, nearest.t);
                order(node, mask, &entries, stack, &mut waiting)
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

    /// Offers what the ray hits in a leaf.
    #[inline(always)]
    fn visit(&self, leaf: Child, probe: &Probe, nearest: &mut Nearest) {
        if leaf.kind() == Leaf::Packet {
            let slot = Child::leaf(Leaf::Packet, leaf.index() * PACKET);
            return self.packets[leaf.index()].intersect(probe, slot.0, nearest);
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
fn order(node: &Node, mut mask: u32, entries: &[f32], stack: &mut [Waiting], waiting: &mut usize) -> Option<Child> {
    if mask == 0 {
        return None;
    }
    let lane = mask.trailing_zeros() as usize;
    mask &= mask - 1;
    let mut first = (node.children[lane], entries[lane]);
    let floor = *waiting;
    while mask != 0 {
        let lane = mask.trailing_zeros() as usize;
        mask &= mask - 1;
        let mut one = (node.children[lane], entries[lane]);
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
