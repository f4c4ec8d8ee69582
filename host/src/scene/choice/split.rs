//! How a cluster of lights is split in two.

use bidir_kernel::Vec3;
use glam::DVec3;

use super::cluster::Cluster;

/// A light on its way into the tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct Item {
    /// Of its box.
    low: Vec3,
    /// Of its box.
    high: Vec3,
    /// Which way it shines: shorter than 1 the wider, and 0 for everywhere.
    axis: Vec3,
    intensity: f64,
    /// What its builder knows it by.
    pub index: u32,
}

impl Item {
    pub fn new(cluster: &Cluster, index: u32) -> Self {
        let Cluster { low, high, cone, intensity, .. } = *cluster;
        let axis = cone.axis * (0.5 * (1.0 + libm::cos(cone.angle)));
        Self { low, high, axis: if cone.is_all() { Vec3::ZERO } else { axis.as_vec3() }, intensity, index }
    }
}

/// How many parts each axis is cut into.
const BINS: usize = 16;

/// What lights are sorted by: a coordinate of the middle of their box, or, where those are all alike, of the axis that they shine along.
#[derive(Clone, Copy)]
enum Key {
    Place(usize),
    Axis(usize),
}

impl Key {
    fn of(self, item: &Item) -> f64 {
        match self {
            Self::Place(i) => 0.5 * (f64::from(item.low[i]) + f64::from(item.high[i])),
            Self::Axis(i) => item.axis[i].into(),
        }
    }
}

/// An axis cut into [`BINS`] parts from `low` on.
#[derive(Clone, Copy)]
struct Cuts {
    key: Key,
    low: f64,
    width: f64,
}

impl Cuts {
    fn of(items: &[Item], key: Key) -> Self {
        let widened = |(low, high): (f64, f64), x: f64| (low.min(x), high.max(x));
        let (low, high) = items.iter().map(|item| key.of(item)).fold((f64::INFINITY, f64::NEG_INFINITY), widened);
        Self { key, low, width: high - low }
    }

    fn bin(&self, item: &Item) -> usize {
        (((self.key.of(item) - self.low) / self.width * BINS as f64) as usize).min(BINS - 1)
    }
}

/// What a side of a split holds, as far as can be added up.
#[derive(Clone, Copy)]
struct Bin {
    count: usize,
    low: Vec3,
    high: Vec3,
    intensity: f64,
    /// The axes added up, each times its intensity.
    axes: DVec3,
}

impl Bin {
    const EMPTY: Self = Self { count: 0, low: Vec3::INFINITY, high: Vec3::NEG_INFINITY, intensity: 0.0, axes: DVec3::ZERO };

    fn of(item: &Item) -> Self {
        let Item { low, high, axis, intensity, .. } = *item;
        Self { count: 1, low, high, intensity, axes: axis.as_dvec3() * intensity }
    }

    fn add(&mut self, other: &Self) {
        self.count += other.count;
        (self.low, self.high) = (self.low.min(other.low), self.high.max(other.high));
        self.intensity += other.intensity;
        self.axes += other.axes;
    }

    /// Intensity times extent times spread of directions, as the surface area orientation heuristic of Conty Estevez and Kulla 2018,
    /// but for two things: the diagonal's square stands for the surface, which is 0 for lights in a row; and what the mean of all
    /// axes lacks of length 1 stands for the cone about them, from π steradians to 4π.
    fn cost(&self) -> f64 {
        let diagonal = self.high.as_dvec3() - self.low.as_dvec3();
        self.intensity * diagonal.dot(diagonal) * (4.0 - 3.0 * (self.axes.length() / self.intensity).min(1.0))
    }
}

/// Sorts the lights into two parts, neither of them empty, and tells how many are in the first. There must be two at least.
pub(super) fn split(items: &mut [Item]) -> usize {
    let found = best(items, [0, 1, 2].map(Key::Place)).or_else(|| best(items, [0, 1, 2].map(Key::Axis)));
    let Some((cuts, cut)) = found else { return items.len() / 2 };
    let mut first = 0;
    for i in 0..items.len() {
        if cuts.bin(&items[i]) < cut {
            items.swap(first, i);
            first += 1;
        }
    }
    first
}

/// The best bin to cut before by one of these keys; `None` where all lights agree in them.
fn best(items: &[Item], keys: [Key; 3]) -> Option<(Cuts, usize)> {
    let axes = keys.map(|key| Cuts::of(items, key));
    let widest = axes.iter().fold(0.0, |widest: f64, cuts| widest.max(cuts.width));
    let mut best = None;
    let mut least = f64::INFINITY;
    for cuts in axes.into_iter().filter(|cuts| cuts.width > 0.0) {
        let mut bins = [Bin::EMPTY; BINS];
        items.iter().for_each(|item| bins[cuts.bin(item)].add(&Bin::of(item)));
        for (cut, cost) in costs(&bins) {
            // A box that is thin this way is better cut another.
            let cost = cost * (widest / cuts.width);
            if cost < least || best.is_none() {
                (least, best) = (cost, Some((cuts, cut)));
            }
        }
    }
    best
}

/// What it costs to cut before each bin, where neither side is empty.
fn costs(bins: &[Bin; BINS]) -> impl Iterator<Item = (usize, f64)> {
    let mut after = [Bin::EMPTY; BINS];
    let mut sum = Bin::EMPTY;
    for (slot, bin) in after.iter_mut().zip(bins).rev() {
        sum.add(bin);
        *slot = sum;
    }
    let mut before = Bin::EMPTY;
    (1..BINS).filter_map(move |cut| {
        before.add(&bins[cut - 1]);
        (before.count > 0 && after[cut].count > 0).then(|| (cut, before.cost() + after[cut].cost()))
    })
}
