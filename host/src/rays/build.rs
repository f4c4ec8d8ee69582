//! Building the tree.
//!
//! A binary tree by locally ordered clustering (Meister and Bittner 2018), improved by reinsertion (2017), both from `obvhs`;
//! then [`Collapse`] makes wide nodes and packets of it.

use std::time::Instant;

use obvhs::{
    aabb::Aabb,
    bvh2::{Bvh2, reinsertion::ReinsertionOptimizer},
    ploc::{PlocBuilder, PlocSearchDistance, SortPrecision},
};

use super::{
    bounds::Bounds,
    bvh::{Bvh, Owned},
    collapse::Collapse,
    cylinder::RoundCylinder,
    disk::FlatDisk,
    node::{Child, Leaf, Node},
    primitives::Primitives,
    triangle::Packet,
};

/// What building took and made.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BuildStats {
    /// Primitives that went in.
    pub primitives: usize,
    /// Triangles among them, and two for each parallelogram.
    pub triangles: usize,
    /// Instances among them.
    pub instances: usize,
    /// Inner nodes of the tree.
    pub nodes: usize,
    /// Leaves that hold up to four triangles.
    pub packets: usize,
    /// Memory of the whole structure; what stands in instances is not counted.
    pub bytes: usize,
    /// Wall-clock time.
    pub seconds: f64,
}

impl std::ops::AddAssign for BuildStats {
    fn add_assign(&mut self, other: Self) {
        self.primitives += other.primitives;
        self.triangles += other.triangles;
        self.instances += other.instances;
        self.nodes += other.nodes;
        self.packets += other.packets;
        self.bytes += other.bytes;
        self.seconds += other.seconds;
    }
}

/// How much building is worth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quality {
    /// For rays that are as fast as can be.
    #[default]
    High,
    /// For a tree that is there soon: a short search, and nothing is placed better afterwards.
    Low,
}

impl Bvh {
    /// Builds the tree; the primitives' memory is freed on the way.
    pub fn build(primitives: Primitives) -> Self {
        Self::build_as(primitives, Quality::default())
    }

    /// The same with so much care.
    pub fn build_as(primitives: Primitives, quality: Quality) -> Self {
        let start = Instant::now();
        let bounds: Vec<Bounds> = primitives.all_bounds().collect();
        let everything = bounds.iter().fold(Bounds::EMPTY, |all, &one| all.join(one));
        let binary = binary_tree(&bounds, quality);
        drop(bounds);

        let mut bvh = Self::empty(everything, primitives.some_hidden);
        let (count, triangles) = (primitives.len(), primitives.triangles.len());
        if count > 0 {
            let plan = Collapse::new(&binary, |primitive| primitive < triangles);
            Wide { binary: &binary, plan: &plan, primitives: &primitives, bvh: &mut bvh }.emit();
        }
        // A ray in an instance has what waits outside and what waits inside.
        let inside = |of: fn(&Bvh) -> usize| bvh.instances.iter().map(|one| of(one.shape.geometry())).max().unwrap_or(0);
        let (waiting, levels) = (inside(|inner| inner.most_waiting), inside(|inner| inner.levels + 1));
        (bvh.most_waiting, bvh.levels) = (bvh.most_waiting + waiting, levels);
        bvh.stats = BuildStats {
            primitives: count,
            triangles,
            instances: bvh.instances.len(),
            nodes: bvh.nodes.len(),
            packets: bvh.packets.len(),
            bytes: bvh.bytes(),
            seconds: start.elapsed().as_secs_f64(),
        };
        bvh
    }
}

impl Primitives {
    /// In the order of the tree's items: triangles, spheres, disks, cylinders, instances.
    fn all_bounds(&self) -> impl Iterator<Item = Bounds> {
        let triangles = self.triangles.shapes.iter().map(|corners| Bounds::of(corners));
        let spheres = self.spheres.shapes.iter().map(|sphere| sphere.bounds());
        let disks = self.disks.shapes.iter().map(|disk| disk.bounds());
        let cylinders = self.cylinders.shapes.iter().map(|cylinder| cylinder.bounds());
        let instances = self.instances.shapes.iter().map(|instance| instance.bounds());
        triangles.chain(spheres).chain(disks).chain(cylinders).chain(instances)
    }
}

fn binary_tree(bounds: &[Bounds], quality: Quality) -> Bvh2 {
    /// How many nodes reinsertion tries to place better, and which share that is at least and at most.
    const REINSERTED: f32 = 150_000.0;
    const SHARE: [f32; 2] = [0.05, 0.15];
    /// Below this many primitives the whole tree is worth improving.
    const SMALL: usize = 10_000;
    let boxes: Vec<Aabb> = bounds.iter().map(|b| Aabb::new(b.min.into(), b.max.into())).collect();
    let indices = (0..boxes.len() as u32).collect();
    let search = match quality {
        Quality::High => PlocSearchDistance::Medium,
        Quality::Low => PlocSearchDistance::Minimum,
    };
    let mut binary = PlocBuilder::with_capacity(boxes.len()).build(search, &boxes, indices, SortPrecision::U64, 3);
    if quality == Quality::Low {
        return binary;
    }
    let share = if boxes.len() < SMALL { 1.0 } else { (REINSERTED / boxes.len() as f32).clamp(SHARE[0], SHARE[1]) };
    ReinsertionOptimizer::default().run(&mut binary, share, None);
    binary
}

/// A wide tree on its way out of its plan.
struct Wide<'a> {
    binary: &'a Bvh2,
    plan: &'a Collapse<'a>,
    primitives: &'a Primitives,
    bvh: &'a mut Bvh,
}

impl Wide<'_> {
    fn emit(mut self) {
        if self.plan.is_leaf(0) {
            self.bvh.root = Some(self.leaf(0));
            return;
        }
        self.bvh.root = Some(Child::inner(0));
        self.bvh.nodes.push(Node::new(&[]));
        // Subtree of the binary tree, the place of its node, and how many nodes can be waiting when a ray gets there.
        let mut open = vec![(0, 0, 0)];
        while let Some((subtree, place, waiting)) = open.pop() {
            let subtrees = self.plan.children(subtree);
            let waiting = waiting + subtrees.len() - 1;
            self.bvh.most_waiting = self.bvh.most_waiting.max(waiting);
            let mut children = Vec::with_capacity(subtrees.len());
            for subtree in subtrees {
                let aabb = self.binary.nodes[subtree].aabb();
                let child = if self.plan.is_leaf(subtree) {
                    self.leaf(subtree)
                } else {
                    let place = self.bvh.nodes.len();
                    self.bvh.nodes.push(Node::new(&[]));
                    open.push((subtree, place, waiting));
                    Child::inner(place)
                };
                children.push((Bounds { min: aabb.min.into(), max: aabb.max.into() }, child));
            }
            self.bvh.nodes[place] = Node::new(&children);
        }
    }

    fn leaf(&mut self, subtree: usize) -> Child {
        let all = self.primitives;
        let items = self.plan.primitives(subtree);
        let mut item = items[0];
        if item < all.triangles.len() {
            let triangles: Vec<_> = items.iter().map(|&item| (all.triangles.shapes[item], all.triangles.keys[item])).collect();
            self.bvh.packets.push(Packet::new(&triangles));
            return Child::leaf(Leaf::Packet, self.bvh.packets.len() - 1);
        }
        item -= all.triangles.len();
        if item < all.spheres.len() {
            self.bvh.spheres.push(Owned { shape: all.spheres.shapes[item], key: all.spheres.keys[item] });
            return Child::leaf(Leaf::Sphere, self.bvh.spheres.len() - 1);
        }
        item -= all.spheres.len();
        if item < all.disks.len() {
            self.bvh.disks.push(Owned { shape: FlatDisk::new(&all.disks.shapes[item]), key: all.disks.keys[item] });
            return Child::leaf(Leaf::Disk, self.bvh.disks.len() - 1);
        }
        item -= all.disks.len();
        if item < all.cylinders.len() {
            self.bvh.cylinders.push(Owned { shape: RoundCylinder::new(&all.cylinders.shapes[item]), key: all.cylinders.keys[item] });
            return Child::leaf(Leaf::Cylinder, self.bvh.cylinders.len() - 1);
        }
        item -= all.cylinders.len();
        self.bvh.instances.push(Owned { shape: all.instances.shapes[item].clone(), key: all.instances.keys[item] });
        Child::leaf(Leaf::Instance, self.bvh.instances.len() - 1)
    }
}
