//! The way of a ray through the tree.

use std::cell::RefCell;

use super::{
    bvh::{Bvh, Owned, Trail, Triangles},
    instance::LEVELS,
    lanes::{Lanes, Machine, Work},
    nearest::Nearest,
    node::{Child, Leaf, Node, Slabs, WIDTH},
    probe::{Probe, Shear},
    triangle::PACKET,
};

/// A subtree that waits for the ray: above its number where the ray enters it, never below 0, so that the nearer is less.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Waiting(u64);

impl Waiting {
    const NONE: Self = Self(0);

    #[inline(always)]
    fn new(child: Child, entry: f32) -> Self {
        Self(u64::from(entry.to_bits()) << 32 | u64::from(child.0))
    }

    #[inline(always)]
    fn child(self) -> Child {
        Child(self.0 as u32)
    }

    #[inline(always)]
    fn entry(self) -> f32 {
        f32::from_bits((self.0 >> 32) as u32)
    }

    /// The nearer one and the other. No branch: which one it is cannot be foretold.
    #[inline(always)]
    fn sorted(self, other: Self) -> (Self, Self) {
        (self.min(other), self.max(other))
    }
}

/// As many subtrees as wait in all but degenerate trees.
const STACK: usize = 512;

thread_local! {
    /// Kept from ray to ray: clearing it would cost as much as a ray in a small tree.
    static WAITING: RefCell<[Waiting; STACK]> = const { RefCell::new([Waiting::NONE; STACK]) };
}

/// One ray's way down.
struct Descent<'a, const ANY: bool, const FAST: bool, const NESTED: bool> {
    bvh: &'a Bvh,
    probe: &'a Probe,
    root: Child,
    /// Hits are nearer than this.
    limit: f32,
    stack: &'a mut [Waiting],
    /// Empty unless `NESTED`.
    trail: &'a mut [u32],
}

impl<const ANY: bool, const FAST: bool, const NESTED: bool> Work for Descent<'_, ANY, FAST, NESTED> {
    type Output = Nearest;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> Nearest {
        let Self { bvh, probe, root, limit, stack, trail } = self;
        let mut nearest = Nearest::before(limit);
        let slabs = Slabs::new(lanes, probe);
        let shear = Shear::new(probe);
        let mut current = Waiting::new(root, 0.0);
        let mut waiting = 0;
        loop {
            let child = current.child();
            let next = if child.is_leaf() {
                match child.kind() {
                    Leaf::Packet => bvh.meet_packet::<FAST>(child, probe, &shear, current.entry(), &mut nearest),
                    Leaf::Instance if NESTED => bvh.meet_instance::<ANY, FAST>(child, probe, &mut nearest, &mut stack[waiting..], trail),
                    _ => bvh.meet_shape(child, probe, &mut nearest),
                }
                if ANY && nearest.found() {
                    return nearest;
                }
                None
            } else {
                let node = &bvh.nodes[child.0 as usize];
                let entered = slabs.enter(node, nearest.t);
                bvh.next_child::<ANY, L>(lanes, node, entered, stack, &mut waiting)
            };
            current = match next {
                Some(next) => next,
                None => loop {
                    if waiting == 0 {
                        return nearest;
                    }
                    waiting -= 1;
                    let next = stack[waiting];
                    if ANY || next.entry() <= nearest.t {
                        break next;
                    }
                },
            };
        }
    }
}

impl Bvh {
    /// The nearest hit, or with `ANY` whichever is found first; `trail` keeps where in an instance it is.
    #[inline(always)]
    pub(super) fn cast<const ANY: bool>(&self, probe: &Probe, trail: &mut Trail) -> Option<Nearest> {
        if self.most_waiting <= STACK {
            WAITING.with_borrow_mut(|stack| self.descend::<ANY>(probe, stack, trail))
        } else {
            self.descend::<ANY>(probe, &mut vec![Waiting::NONE; self.most_waiting], trail)
        }
    }

    #[inline(always)]
    fn descend<const ANY: bool>(&self, probe: &Probe, stack: &mut [Waiting], trail: &mut Trail) -> Option<Nearest> {
        match self.triangles {
            Triangles::Watertight => self.search::<ANY, false>(self.machine, probe, probe.limit, stack, trail),
            Triangles::Fast => self.search::<ANY, true>(self.machine, probe, probe.limit, stack, trail),
        }
    }

    /// Something nearer than `limit`.
    #[inline(always)]
    fn search<const ANY: bool, const FAST: bool>(
        &self,
        machine: Machine,
        probe: &Probe,
        limit: f32,
        stack: &mut [Waiting],
        trail: &mut Trail,
    ) -> Option<Nearest> {
        let machine = if probe.fusible { machine } else { Machine::Any };
        let (bvh, root) = (self, self.root?);
        let mut nearest = if self.levels == 0 {
            machine.run(Descent::<ANY, FAST, false> { bvh, probe, root, limit, stack, trail: &mut [] })
        } else {
            machine.run(Descent::<ANY, FAST, true> { bvh, probe, root, limit, stack, trail })
        };
        if !nearest.found() {
            return None;
        }
        if nearest.key.is_second_half() {
            nearest.coordinates = (1.0 - nearest.coordinates.0, 1.0 - nearest.coordinates.1);
        }
        Some(nearest)
    }

    #[inline(always)]
    fn prefetch<L: Lanes>(&self, lanes: L, child: Child) {
        if !child.is_leaf() {
            lanes.prefetch(&self.nodes, child.0 as usize);
        } else if child.kind() == Leaf::Packet {
            lanes.prefetch(&self.packets, child.packet());
        }
    }

    /// Offers what the ray hits of a packet.
    #[inline(always)]
    fn meet_packet<const FAST: bool>(&self, leaf: Child, probe: &Probe, shear: &Shear, entry: f32, nearest: &mut Nearest) {
        let slot = Child::leaf(Leaf::Packet, leaf.packet() * PACKET);
        let packet = &self.packets[leaf.packet()];
        if FAST { packet.intersect_fast(probe, slot.0, nearest) } else { packet.intersect(probe, shear, slot.0, entry, nearest) }
    }

    /// Offers what the ray hits of any other shape.
    #[inline(always)]
    fn meet_shape(&self, leaf: Child, probe: &Probe, nearest: &mut Nearest) {
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
            _ => {
                let cylinder = &self.cylinders[leaf.index()];
                (cylinder.shape.distance(origin, direction), cylinder.key)
            }
        };
        let t = t as f32;
        if nearest.loses_to(t, key) && !(probe.hide && key.hidden_from_lens()) {
            *nearest = Nearest { t, key, slot: leaf.0, coordinates: (0.0, 0.0) };
        }
    }

    /// Offers what the ray hits in an instance.
    #[inline(never)]
    fn meet_instance<const ANY: bool, const FAST: bool>(
        &self,
        leaf: Child,
        probe: &Probe,
        nearest: &mut Nearest,
        stack: &mut [Waiting],
        trail: &mut [u32],
    ) {
        let Owned { shape: instance, key } = &self.instances[leaf.index()];
        if probe.hide && key.hidden_from_lens() {
            return;
        }
        let Some(localized) = instance.localized(probe) else { return };
        // Of what lies equally near the lower primitive is nearer, so it has to be found.
        let limit = nearest.t.next_up().min(probe.limit);
        let mut inner_trail = [0; LEVELS];
        let found = instance.geometry().search::<ANY, FAST>(self.machine, &localized, limit, stack, &mut inner_trail);
        if let Some(found) = found
            && nearest.loses_to(found.t, *key)
        {
            *nearest = Nearest { t: found.t, key: *key, slot: leaf.0, coordinates: found.coordinates };
            trail[0] = found.slot;
            trail[1..].copy_from_slice(&inner_trail[..LEVELS - 1]);
        }
    }

    /// The nearest of the children that the ray enters. The others wait, the nearer on top; for `ANY` hit just as they come.
    #[inline(always)]
    fn next_child<const ANY: bool, L: Lanes>(
        &self,
        lanes: L,
        node: &Node,
        (mask, entries): (u32, [f32; WIDTH]),
        stack: &mut [Waiting],
        waiting: &mut usize,
    ) -> Option<Waiting> {
        let mut entered = Entered(mask);
        let take = |entered: &mut Entered| entered.next().map(|lane| Waiting::new(node.children[lane], entries[lane]));
        let first = take(&mut entered)?;
        let Some(second) = take(&mut entered) else { return Some(first) };
        self.prefetch(lanes, first.child());
        self.prefetch(lanes, second.child());
        let floor = *waiting;
        let (mut nearest, other) = first.sorted(second);
        stack[floor] = other;
        *waiting = floor + 1;
        while let Some(one) = take(&mut entered) {
            self.prefetch(lanes, one.child());
            let (nearer, other) = one.sorted(nearest);
            nearest = nearer;
            let mut place = *waiting;
            while !ANY && place > floor && stack[place - 1] < other {
                stack[place] = stack[place - 1];
                place -= 1;
            }
            stack[place] = other;
            *waiting += 1;
        }
        Some(nearest)
    }
}

/// Lanes by their bits, from the lowest up.
struct Entered(u32);

impl Iterator for Entered {
    type Item = usize;

    #[inline(always)]
    fn next(&mut self) -> Option<usize> {
        let lane = self.0.trailing_zeros() as usize;
        if self.0 == 0 {
            return None;
        }
        self.0 &= self.0 - 1;
        Some(lane % WIDTH)
    }
}
