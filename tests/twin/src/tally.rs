//! Adds up how far f32 is from f64, sample by sample.

use crate::{
    case::Case,
    double,
    held::{Held, relative},
    parting::{Parting, Said, before, partings},
    single,
    tape::{Given, Tape},
};

/// How often the f64 world runs with its numbers moved; and how often where that does not explain a difference, since a few
/// moves at random may all be small, or miss an edge that lies near.
const FEW: u64 = 3;
const MANY: u64 = 150;

/// A difference is measured in units of the largest one that the moved runs show, and never less than this for each vertex
/// of the path: what a few operations of f32 leave. A mirror asked twice for one angle is off by the same twice, so these add up.
const FLOOR: f64 = 2.0 * f32::EPSILON as f64;

/// How many units a single number may be off. Right formulas stay below 3 or so.
const BOUND: f64 = 8.0;

/// The same for sums, where chance has averaged out.
const SUM_BOUND: f64 = 2.0;

/// A join that exists in one run only is a parting if it shines more than this: about two points of one plane, or
/// at the end of a lobe, light fades to nothing, and where it does is nobody's loss.
const FAINT: f64 = 1e-9;

/// Standard deviations for the light of parted paths; one test per pool.
const DEVIATIONS: f64 = 4.5;

/// What was compared, over one case or many.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// Samples.
    pub samples: u64,
    /// Samples whose runs part: a walk meets or does something else, or a join exists in one of them only.
    pub parted: u64,
    /// The same between f64 and f64 moved; a mean over the moves.
    pub parted_nudged: f64,
    /// Contributions compared.
    pub compared: u64,
    /// The same by join: light hits, next events, connections, lens splats, lens hits.
    pub joins: [u64; 5],
    /// Contributions at an edge, where a moved run parts: whether light gets there is for rounding to say.
    pub edges: u64,
    /// The largest |w32 − w64|.
    pub weight_difference: f64,
    /// The first parting, in words.
    pub first: Option<String>,
    weight: Worst,
    value: Worst,
    /// Σ (light32 − light64) of what was compared, what the moved runs explain of it, and Σ light64.
    together: [f64; 3],
    /// Of parted samples: Σ (light32 − light64), and of its squares.
    apart: [f64; 2],
}

/// The worst of many numbers, and where.
#[derive(Clone, Debug, Default)]
struct Worst {
    score: f64,
    what: String,
}

impl Worst {
    fn see(&mut self, score: f64, what: impl FnOnce() -> String) {
        // NaN is worst of all.
        if !(score <= self.score) {
            *self = Self { score: if score.is_nan() { f64::INFINITY } else { score }, what: what() };
        }
    }

    fn merge(&mut self, other: Self) {
        let Self { score, what } = other;
        self.see(score, || what);
    }
}

impl Tally {
    /// Runs every sample of a case in both worlds.
    pub fn of(case: &Case) -> Self {
        let mut tally = Self::default();
        let (single, double) = (single::world::World::new(&case.setting), double::world::World::new(&case.setting));
        for index in 0..case.samples {
            let numbers = [case.seed(), index];
            let exact = double.trace(&case.plan, numbers, None);
            let found = single.trace(&case.plan, numbers, None);
            let moved = |count: u64| (1..=count).map(|k| double.trace(&case.plan, numbers, Some(index * count + k))).collect::<Vec<_>>();
            let mut sample = Self::one(case, index, &found, &exact, &moved(FEW));
            if !(sample.weight.score.max(sample.value.score) <= 0.5 * BOUND) {
                sample = Self::one(case, index, &found, &exact, &moved(MANY));
            }
            tally.merge(sample);
        }
        tally
    }

    /// Adds another tally to this one.
    pub fn merge(&mut self, other: Self) {
        self.samples += other.samples;
        self.parted += other.parted;
        self.parted_nudged += other.parted_nudged;
        self.compared += other.compared;
        self.joins.iter_mut().zip(other.joins).for_each(|(sum, part)| *sum += part);
        self.edges += other.edges;
        self.weight_difference = self.weight_difference.max(other.weight_difference);
        self.first = self.first.take().or(other.first);
        self.weight.merge(other.weight);
        self.value.merge(other.value);
        self.together.iter_mut().zip(other.together).for_each(|(sum, part)| *sum += part);
        self.apart.iter_mut().zip(other.apart).for_each(|(sum, part)| *sum += part);
    }

    /// Weights and values contribution by contribution, the image of what was compared, and the light of what parted.
    pub fn held(&self) -> Vec<Held> {
        let parted = self.parted as f64 / self.samples.max(1) as f64;
        let held = |measure, worst, bound, what| Held { measure, worst, bound, parted, what };
        let [difference, explained, light] = self.together;
        let [apart, squares] = self.apart;
        // Samples part as often as rounding has them part, give or take chance.
        let expected = self.parted_nudged.max(1.0);
        let first = self.first.clone().unwrap_or_else(|| "no path parts".to_owned());
        vec![
            held("weights", self.weight.score, BOUND, self.weight.what.clone()),
            held("values", self.value.score, BOUND, self.value.what.clone()),
            held(
                "image",
                difference.abs() / (FLOOR * light + explained).max(f64::MIN_POSITIVE),
                SUM_BOUND,
                format!("{difference:.1e} of {light:.3e} over {} contributions", self.compared),
            ),
            held("partings", self.parted as f64 / expected, 2.0 + 4.0 / expected.sqrt(), format!("{:.1} explained; {first}", expected)),
            held(
                "parted light",
                apart.abs() / squares.sqrt().max(f64::MIN_POSITIVE),
                DEVIATIONS,
                format!("{apart:.1e} over {} paths", self.parted),
            ),
        ]
    }

    fn one(case: &Case, index: u64, single: &Tape, double: &Tape, moved: &[Tape]) -> Self {
        let mut tally = Self { samples: 1, ..Self::default() };
        tally.add(case, index, single, double, moved);
        tally
    }

    fn add(&mut self, case: &Case, index: u64, single: &Tape, double: &Tape, moved: &[Tape]) {
        let apart = partings(single, double);
        let moved: Vec<_> = moved.iter().map(|tape| (partings(tape, double), tape)).collect();
        // What the film gets of f32 and f64 beyond what was compared.
        let mut rest = light(single) - light(double);
        for given in double.given.iter().filter(|given| before(given, &apart)) {
            if let Some(other) = single.by(given.s, given.t) {
                rest -= other.light() - given.light();
                self.compare(case, index, other, given, &moved);
            }
        }
        self.parted_nudged += moved.iter().filter(|(apart, tape)| parts(apart, tape, double)).count() as f64 / moved.len().max(1) as f64;
        if !parts(&apart, single, double) {
            return;
        }
        self.parted += 1;
        self.apart[0] += rest;
        self.apart[1] += rest * rest;
        if self.first.is_none() {
            let walk = apart[1].or(apart[0]).map(|parting| Said(&parting, &case.setting).to_string());
            let alone = lone(&apart, single, double).map(|given| (given, "f32"));
            let alone = alone.or_else(|| lone(&apart, double, single).map(|given| (given, "f64")));
            let join = alone.map(|(given, world)| format!("the join ({}, {}) exists in {world} only", given.s, given.t));
            self.first = Some(format!("{}, sample {index}: {}", case.name, walk.or(join).unwrap_or_default()));
        }
    }

    fn compare(&mut self, case: &Case, index: u64, single: &Given, double: &Given, moved: &[([Option<Parting>; 2], &Tape)]) {
        let mut others = Vec::with_capacity(moved.len());
        for (apart, tape) in moved {
            match tape.by(double.s, double.t) {
                Some(other) if before(double, apart) => others.push(other),
                _ => {
                    self.edges += 1;
                    return;
                }
            }
        }
        self.compared += 1;
        self.joins[join(double)] += 1;
        let most = |of: &dyn Fn(&Given) -> f64| others.iter().map(|other| of(other)).fold(0.0, f64::max);
        let weight = |other: &Given| (other.weight - double.weight).abs();
        let value = |other: &Given| relative(&other.value, &double.value);
        let said = |what: &str, a: f64, b: f64, unit: f64| {
            format!(
                "{}, sample {index}, ({}, {}): {what} {a:e} in f32, {b:e} in f64, rounding explains {unit:.1e}",
                case.name, double.s, double.t
            )
        };
        self.weight_difference = self.weight_difference.max(weight(single));
        let floor = FLOOR * f64::from(double.s + double.t);
        let unit = most(&weight);
        self.weight.see(finite(weight(single)) / (floor + unit), || said("weight", single.weight, double.weight, unit));
        let unit = most(&value);
        self.value.see(value(single) / (floor + unit), || said("value", single.value[0], double.value[0], unit));
        self.together[0] += single.light() - double.light();
        self.together[1] += most(&|other| (other.light() - double.light()).abs());
        self.together[2] += double.light();
    }
}

/// Which of the five kinds of join.
fn join(given: &Given) -> usize {
    match (given.s, given.t) {
        (0, _) => 0,
        (_, 0) => 4,
        (_, 1) => 3,
        (1, _) => 1,
        _ => 2,
    }
}

/// A difference with something infinite or no number in it is as bad as can be.
fn finite(difference: f64) -> f64 {
    if difference.is_finite() { difference } else { f64::INFINITY }
}

fn light(tape: &Tape) -> f64 {
    tape.given.iter().map(Given::light).sum()
}

/// Whether a walk parts, or a join before that exists in one of the two only.
fn parts(apart: &[Option<Parting>; 2], one: &Tape, other: &Tape) -> bool {
    apart.iter().any(Option::is_some) || lone(apart, one, other).is_some() || lone(apart, other, one).is_some()
}

/// What one run contributes before the walks part, and the other one does not.
fn lone<'a>(apart: &[Option<Parting>; 2], one: &'a Tape, other: &Tape) -> Option<&'a Given> {
    let alone = |given: &&Given| before(given, apart) && !(given.light() <= FAINT) && other.by(given.s, given.t).is_none();
    one.given.iter().find(alone)
}
