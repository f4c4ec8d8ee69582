//! The tree, and what its hits are.

use std::mem::size_of_val;

use bidir_kernel::Ray;
use glam::{DAffine3, DVec3};

use super::{
    Geometry, RayHit,
    bounds::Bounds,
    build::BuildStats,
    cylinder::RoundCylinder,
    disk::FlatDisk,
    instance::{Instance, LEVELS},
    lanes::Machine,
    nearest::{Key, Nearest},
    node::{Child, Leaf, Node},
    primitives::PrimitiveId,
    probe::Probe,
    sphere::Sphere,
    surface::{SurfacePoint, rounding},
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
    pub(super) instances: Vec<Owned<Instance>>,
    pub(super) root: Option<Child>,
    /// How many nodes a ray can have waiting, in instances as well.
    pub(super) most_waiting: usize,
    /// How many instances lie within each other.
    pub(super) levels: usize,
    pub(super) stats: BuildStats,
    bounds: Bounds,
    pub(super) some_hidden: bool,
    pub(super) machine: Machine,
    pub(super) triangles: Triangles,
}

/// A shape and whose it is.
#[derive(Clone, Debug)]
pub(super) struct Owned<T> {
    pub shape: T,
    pub key: Key,
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

/// Where the trees within an instance keep what was hit there.
pub(super) type Trail = [u32; LEVELS];

impl Geometry for Bvh {
    // One of either for all who cast rays: copies of them would differ by chance, and a call is little beside a ray.
    fn closest(&self, ray: &Ray) -> Option<RayHit> {
        let probe = &Probe::new(ray, &self.bounds, self.some_hidden)?;
        let mut trail = [0; LEVELS];
        let Nearest { mut t, key, slot, coordinates } = self.cast::<false>(probe, &mut trail)?;
        if self.triangles == Triangles::Watertight {
            t = self.exact_distance(probe, Child(slot), &trail).filter(|t| *t > 0.0 && *t < probe.limit).unwrap_or(t);
        }
        if Child(slot).kind() == Leaf::Instance {
            trail = self.trimmed(Child(slot), trail);
        }
        Some(RayHit { t, primitive: PrimitiveId(key.primitive()), coordinates, slot, trail })
    }

    fn occluded(&self, ray: &Ray) -> bool {
        Probe::new(ray, &self.bounds, self.some_hidden).is_some_and(|probe| self.cast::<true>(&probe, &mut [0; LEVELS]).is_some())
    }

    fn path(&self, hit: &RayHit) -> impl Iterator<Item = PrimitiveId> {
        let mut next = Some((self, Child(hit.slot)));
        let mut inner = hit.trail.into_iter();
        std::iter::from_fn(move || {
            let (bvh, leaf) = next.take()?;
            if leaf.kind() == Leaf::Instance {
                next = inner.next().map(|slot| (bvh.instances[leaf.index()].shape.geometry(), Child(slot)));
            }
            Some(PrimitiveId(bvh.key(leaf).primitive()))
        })
    }

    fn surface(&self, ray: &Ray, hit: &RayHit) -> SurfacePoint {
        let on_ray = OnRay { origin: ray.origin.as_dvec3(), direction: ray.direction.as_dvec3(), t: f64::from(hit.t) };
        let (one, two) = (f64::from(hit.coordinates.0), f64::from(hit.coordinates.1));
        let Found { position, normal, local, error } = self.found(on_ray, Child(hit.slot), (one, two), &hit.trail);
        SurfacePoint::new(position, normal, local, error)
    }

    fn bounds(&self) -> Bounds {
        self.bounds
    }
}

/// A point of a ray.
struct OnRay {
    origin: DVec3,
    direction: DVec3,
    t: f64,
}

/// A point of a primitive: exact compared to f32, with how far rounding may move it along each axis.
struct Found {
    position: DVec3,
    normal: DVec3,
    local: DVec3,
    error: DVec3,
}

impl Bvh {
    pub(super) fn empty(bounds: Bounds, some_hidden: bool) -> Self {
        Self {
            nodes: vec![],
            packets: vec![],
            spheres: vec![],
            disks: vec![],
            cylinders: vec![],
            instances: vec![],
            root: None,
            most_waiting: 0,
            levels: 0,
            stats: BuildStats::default(),
            bounds,
            some_hidden,
            machine: Machine::detected(),
            triangles: Triangles::default(),
        }
    }

    /// The same tree with triangles met in another way, those in its instances too.
    pub fn with_triangles(self, triangles: Triangles) -> Self {
        Self { triangles, ..self }
    }

    /// How rays meet triangles.
    pub fn triangles(&self) -> Triangles {
        self.triangles
    }

    /// The same tree without the registers that only some machines have. Answers are the same, bit for bit.
    pub fn portable(self) -> Self {
        Self { machine: Machine::Any, ..self }
    }

    /// From the coordinates of what was hit to those of this tree: the identity, unless it was hit in an instance.
    pub fn to_world(&self, hit: &RayHit) -> DAffine3 {
        let (mut whole, mut bvh, mut leaf) = (DAffine3::IDENTITY, self, Child(hit.slot));
        for slot in hit.trail {
            if leaf.kind() != Leaf::Instance {
                break;
            }
            let instance = &bvh.instances[leaf.index()].shape;
            whole *= instance.placed();
            (bvh, leaf) = (instance.geometry(), Child(slot));
        }
        whole
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
            + size_of_val(&*self.instances)
    }

    fn key(&self, leaf: Child) -> Key {
        match leaf.kind() {
            Leaf::Packet => self.packets[leaf.packet() / PACKET].keys[leaf.packet() % PACKET],
            Leaf::Sphere => self.spheres[leaf.index()].key,
            Leaf::Disk => self.disks[leaf.index()].key,
            Leaf::Cylinder => self.cylinders[leaf.index()].key,
            Leaf::Instance => self.instances[leaf.index()].key,
        }
    }

    fn found(&self, at: OnRay, leaf: Child, (one, two): (f64, f64), trail: &[u32]) -> Found {
        // From a sphere's radius away a rounded distance is as good as exact; from 10⁷ radii it tells no side of the sphere from the other.
        let exact = |t: f64| if (t - at.t).abs() <= 1e-6 * at.t.abs() { t } else { at.t };
        let on_ray = |t: f64| at.origin + at.direction * t;
        let here = |position: DVec3, normal, local| Found { position, normal, local, error: rounding(position, &self.bounds) };
        match leaf.kind() {
            Leaf::Packet => {
                let (packet, lane) = (&self.packets[leaf.packet() / PACKET], leaf.packet() % PACKET);
                let [a, b, c] = packet.triangle(lane).map(|corner| corner.as_dvec3());
                let (x, y) = (b - a, c - a);
                let (b1, b2) = if packet.keys[lane].is_second_half() { (1.0 - one, 1.0 - two) } else { (one, two) };
                here(a + x * b1 + y * b2, x.cross(y).normalize_or(DVec3::Z), DVec3::new(one, two, 0.0))
            }
            Leaf::Sphere => {
                let sphere = &self.spheres[leaf.index()].shape;
                let normal = sphere.normal(on_ray(exact(sphere.distance(at.origin, at.direction))));
                here(sphere.point(normal), normal, normal)
            }
            Leaf::Disk => {
                let disk = &self.disks[leaf.index()].shape;
                let (a, b) = disk.coordinates(on_ray(exact(disk.distance(at.origin, at.direction))));
                here(disk.centre + disk.x * a + disk.y * b, disk.normal, DVec3::new(a, b, 0.0))
            }
            Leaf::Cylinder => {
                let cylinder = &self.cylinders[leaf.index()].shape;
                let (normal, local) = cylinder.normal(on_ray(exact(cylinder.distance(at.origin, at.direction))));
                here(cylinder.point(normal, local.z), normal, local)
            }
            Leaf::Instance => {
                let instance = &self.instances[leaf.index()].shape;
                let (origin, direction) = instance.to_local(at.origin, at.direction);
                let (slot, trail) = trail.split_first().unwrap_or((&0, &[]));
                let inner = instance.geometry().found(OnRay { origin, direction, t: at.t }, Child(*slot), (one, two), trail);
                let reach = self.bounds.reach(on_ray(at.t).as_vec3()).as_dvec3();
                let (position, normal, error) = instance.to_world(inner.position, inner.normal, inner.error, reach);
                Found { position, normal, local: inner.local, error: error + rounding(position, &self.bounds) }
            }
        }
    }

    /// Without what other hits left behind the last step.
    #[cold]
    fn trimmed(&self, leaf: Child, trail: Trail) -> Trail {
        let mut trimmed = [0; LEVELS];
        let (mut bvh, mut leaf) = (self, leaf);
        for (slot, kept) in trail.into_iter().zip(&mut trimmed) {
            if leaf.kind() != Leaf::Instance {
                break;
            }
            (bvh, leaf, *kept) = (bvh.instances[leaf.index()].shape.geometry(), Child(slot), slot);
        }
        trimmed
    }

    /// How far it is to a triangle that was hit; `None` for other shapes, whose distances are exact.
    #[inline(always)]
    fn exact_distance(&self, probe: &Probe, leaf: Child, trail: &[u32]) -> Option<f32> {
        match leaf.kind() {
            Leaf::Packet => Some(self.packets[leaf.packet() / PACKET].exact_distance(probe, leaf.packet() % PACKET)),
            Leaf::Instance => self.exact_distance_within(probe, leaf, trail),
            _ => None,
        }
    }

    #[cold]
    fn exact_distance_within(&self, probe: &Probe, leaf: Child, trail: &[u32]) -> Option<f32> {
        let (slot, trail) = trail.split_first()?;
        let instance = &self.instances[leaf.index()].shape;
        instance.geometry().exact_distance(&instance.localized(probe)?, Child(*slot), trail)
    }
}
