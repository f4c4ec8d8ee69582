//! What a render's own samples bring that is too rare for a pilot.
//!
//! A pilot has a small part of a render's time; what it saw a few times or never is often most of the error, and a plan may look good for no
//! other reason. The render itself makes such contributions as soon, and what it makes is not lost: it is on the film. So its first
//! samples are watched, and of every contribution is asked what each plan would have made of it: one that is larger than most that the
//! pilot saw of that plan adds to that plan's second moment.

use std::sync::Arc;

use bidir_kernel::Join;

use super::{Brought, Evidence, moments::Moments};
use crate::plan::Stage;

/// Second moments, for every plan, of the contributions that are rare in it, from samples by the plan under way.
#[derive(Clone, Debug)]
pub struct Record {
    plans: Vec<Rare>,
    bounds: Arc<[Bounds]>,
    importance: Arc<[f64]>,
    samples: usize,
    /// How many of the largest contributions are not counted, beside those on pixels that a trimmed error leaves out.
    spared: f64,
}

/// From which size on contributions are rare in each of a few plans, that are looked at all at once: few are.
#[derive(Clone, Copy, Debug)]
struct Bounds {
    /// How many times as often as the plan under way each makes a kind of join.
    counts: [[f32; Self::PLANS]; Join::COUNT],
    /// What is rare in it if its path is made with density 1; a little less, for what rounding takes.
    least: [f32; Self::PLANS],
}

/// What a plan makes seldom.
#[derive(Clone, Debug)]
struct Rare {
    stage: Stage,
    /// How many times as often as the plan under way it makes each kind of join.
    counts: [f64; Join::COUNT],
    /// The first bin of what is rare, and the least square there.
    from: usize,
    least: f64,
    moments: Moments,
    /// Something was seen that it never makes.
    misses: bool,
}

impl Bounds {
    /// How many are looked at at once.
    const PLANS: usize = 8;
    /// f32 is off by less than this.
    const ROUNDING: f64 = 1e-5;

    fn of(plans: &[Rare]) -> Self {
        let of = |value: &dyn Fn(&Rare) -> f64| std::array::from_fn(|at| plans.get(at).map_or(f32::MAX, |plan| value(plan) as f32));
        let counts = std::array::from_fn(|join| of(&|plan| plan.counts[join]));
        Self { counts, least: of(&|plan| plan.least.sqrt() * (1.0 - Self::ROUNDING)) }
    }

    /// Whether a contribution of that size is rare in any of the plans, or cannot be made by it.
    #[inline(always)]
    fn any(&self, size: f32, shares: &[f32; Join::COUNT]) -> bool {
        let mut densities = [0.0_f32; Self::PLANS];
        for (share, counts) in shares.iter().zip(&self.counts) {
            densities.iter_mut().zip(counts).for_each(|(density, count)| *density += share * count);
        }
        densities.iter().zip(self.least).fold(false, |any, (density, least)| any | (size >= density * least))
    }
}

impl Record {
    /// Nothing seen yet, of samples by the stage `under_way`; what is rare in each plan begins at that bin.
    pub(super) fn new(under_way: &Stage, plans: impl Iterator<Item = (Stage, usize)>, importance: Vec<f64>) -> Self {
        let rare = |(stage, from): (Stage, usize)| {
            let times = |join| if under_way.effort(join) > 0.0 { stage.effort(join) / under_way.effort(join) } else { 0.0 };
            Rare { stage, counts: Join::ALL.map(times), from, least: Moments::least(from), moments: Moments::default(), misses: false }
        };
        let plans: Vec<Rare> = plans.map(rare).collect();
        Self {
            bounds: plans.chunks(Bounds::PLANS).map(Bounds::of).collect(),
            plans,
            importance: importance.into(),
            samples: 0,
            spared: 0.0,
        }
    }

    /// A contribution to a cell of the image.
    pub fn take(&mut self, cell: u32, brought: &Brought) {
        let square = brought.value * brought.value * self.importance[cell as usize];
        let (size, shares) = (square.sqrt() as f32, brought.shares.map(|share| share as f32));
        // What the lens sees directly it sees with every sample.
        let seen = brought.technique.length() <= 1;
        let some = self.plans.chunks_mut(Bounds::PLANS).zip(self.bounds.iter()).filter(|(_, bounds)| bounds.any(size, &shares));
        for plan in some.flat_map(|(plans, _)| plans) {
            let density: f64 = brought.shares.iter().zip(plan.counts).map(|(share, count)| share * count).sum();
            if density == 0.0 {
                plan.misses = true;
            } else if !seen && square >= plan.least * density * density {
                plan.moments.take(density, square / (density * density), 1.0);
            }
        }
    }

    /// A camera path and its light paths are done.
    pub fn end_sample(&mut self) {
        self.samples += 1;
    }

    /// From now on so many of each plan's largest contributions are not counted: whether they are as frequent as they seem nobody knows.
    pub fn spare(&mut self, number: f64) {
        self.spared = number;
    }

    /// Camera paths.
    pub fn samples(&self) -> usize {
        self.samples
    }

    /// The same, with nothing seen.
    pub fn blank(&self) -> Self {
        let blank = |plan: &Rare| Rare { moments: Moments::default(), misses: false, ..plan.clone() };
        let (bounds, importance) = (self.bounds.clone(), self.importance.clone());
        Self { plans: self.plans.iter().map(blank).collect(), bounds, importance, samples: 0, spared: self.spared }
    }

    /// From now on, the image is as bright as that.
    pub fn see(&mut self, evidence: &Evidence) {
        self.importance = evidence.importance().into();
    }

    /// Takes in what was seen elsewhere by the same plan.
    pub fn merge(&mut self, other: &Self) {
        for (own, other) in self.plans.iter_mut().zip(&other.plans) {
            own.moments.merge(&other.moments);
            own.misses |= other.misses;
        }
        self.samples += other.samples;
    }

    /// Whether that plan was watched for, or nothing was watched.
    pub fn knows(&self, stage: &Stage) -> bool {
        self.samples == 0 || self.of(stage, 1.0).is_some()
    }

    /// The first bin of what is rare in a plan, and its second moment per camera path in a render of so many samples per pixel, infinite if
    /// the plan missed something; `None` where nobody watched for that plan.
    pub(super) fn of(&self, stage: &Stage, samples: f64) -> Option<(usize, f64)> {
        let plan = self.plans.iter().find(|plan| plan.stage.techniques() == stage.techniques()).filter(|_| self.samples > 0)?;
        let squares = plan.moments.squares(plan.from, samples, self.samples as f64, self.spared);
        Some((plan.from, if plan.misses { f64::INFINITY } else { squares }))
    }
}

#[cfg(test)]
mod tests {
    use bidir_kernel::{Technique, Techniques};

    use super::*;

    const ALL: Techniques = Techniques { light_hit: 1.0, next_event: 1.0, connection: 1.0, lens_splat: 1.0, lens_hit: 0.0 };

    /// So many samples per pixel that nothing is trimmed.
    const MANY: f64 = 1e30;

    /// Of one cell, whose squared errors count once; all squares of at least 1 are rare.
    fn record(under_way: Techniques, plans: &[Techniques]) -> Record {
        let plans = plans.iter().map(|plan| (Stage::of(plan), (0..).find(|bin| Moments::least(*bin) >= 1.0).unwrap_or(0)));
        Record::new(&Stage::of(&under_way), plans, vec![1.0])
    }

    /// What samples by that plan bring of a path that all kinds of join together make with density 1, each as often as `shares` says.
    fn brought(value: f64, shares: [f64; 5], under_way: &Techniques) -> Brought {
        let efforts = Join::ALL.map(|join| shares[join as usize] * under_way.effort(join));
        let density: f64 = efforts.iter().sum();
        Brought { value: value / density, technique: Technique { s: 1, t: 3 }, shares: efforts.map(|effort| effort / density) }
    }

    fn squares(record: &Record, plan: Techniques) -> f64 {
        record.of(&Stage::of(&plan), MANY).expect("a plan that is watched for").1
    }

    #[test]
    fn whatever_plan_is_under_way_tells_the_same_of_every_plan() {
        let few = Techniques { connection: 0.25, lens_splat: 0.5, ..ALL };
        let plans = [ALL, few, Techniques::PATH, Techniques { next_event: 0.0, ..ALL }];
        let path = (2.0, [0.1, 0.2, 0.3, 0.4, 0.0]);
        for under_way in [ALL, few] {
            let mut record = record(under_way, &plans);
            let density: f64 = Join::ALL.iter().map(|&join| path.1[join as usize] * under_way.effort(join)).sum();
            // As often as the plan under way makes it, in a hundred samples.
            let times = 100.0 * density;
            for _ in 0..times.round() as u32 {
                record.take(0, &brought(path.0, path.1, &under_way));
            }
            (0..100).for_each(|_| record.end_sample());
            for plan in plans {
                let made: f64 = Join::ALL.iter().map(|&join| path.1[join as usize] * plan.effort(join)).sum();
                let found = squares(&record, plan);
                assert!((found * made / (path.0 * path.0) - times.round() / times).abs() < 1e-9, "{plan:?}: {found}");
            }
        }
    }

    #[test]
    fn what_is_small_in_a_plan_is_left_to_the_pilot() {
        let mut record = record(ALL, &[ALL, Techniques::PATH]);
        // 0.9 by all, 9 by the path tracer, which makes it a tenth as often.
        record.take(0, &brought(0.9, [0.1, 0.0, 0.0, 0.9, 0.0], &ALL));
        record.end_sample();
        assert_eq!(squares(&record, ALL), 0.0);
        assert!((squares(&record, Techniques::PATH) - 8.1).abs() < 1e-9);
    }

    #[test]
    fn a_plan_that_cannot_make_what_was_seen_misses_it() {
        let mut record = record(ALL, &[ALL, Techniques::PATH]);
        record.take(0, &brought(0.5, [0.0, 0.0, 1.0, 0.0, 0.0], &ALL));
        record.end_sample();
        assert_eq!([ALL, Techniques::PATH].map(|plan| squares(&record, plan)), [0.0, f64::INFINITY]);
    }

    #[test]
    fn a_look_at_all_plans_at_once_passes_over_nothing() {
        let few = Techniques { connection: 0.25, lens_splat: 0.5, ..ALL };
        let mut plans: Vec<_> = (0..9).map(|i| Techniques { connection: 0.1 * f64::from(i), ..ALL }).collect();
        plans.push(Techniques::PATH);
        let record = record(few, &plans);
        assert_eq!(record.bounds.len(), 2);
        for i in 0..4000_i32 {
            let at = |k: i32| f64::from((i * (2 * k + 7) % 101) as u32);
            let shares = [at(1) * at(2), at(3), at(4), at(5) * at(6), 0.0].map(|share| share / 4000.0);
            let sum: f64 = shares.iter().sum::<f64>().max(1e-9);
            let shares = shares.map(|share| share / sum);
            let size = 0.02 * at(8);
            for (plans, bounds) in record.plans.chunks(Bounds::PLANS).zip(record.bounds.iter()) {
                let rare = plans.iter().any(|plan| {
                    let density: f64 = shares.iter().zip(plan.counts).map(|(share, count)| share * count).sum();
                    size * size >= plan.least * density * density
                });
                assert!(bounds.any(size as f32, &shares.map(|share| share as f32)) || !rare, "{i}: {size} {shares:?}");
            }
        }
    }

    #[test]
    fn the_largest_are_spared() {
        let mut record = record(ALL, &[ALL]);
        for value in [2.0, 4.0, 8.0] {
            record.take(0, &brought(value, [0.5, 0.5, 0.0, 0.0, 0.0], &ALL));
        }
        record.end_sample();
        let spared = |number: f64| {
            let mut record = record.clone();
            record.spare(number);
            squares(&record, ALL)
        };
        assert_eq!([0.0, 0.5, 1.0, 2.5].map(spared), [84.0, 52.0, 20.0, 2.0]);
    }

    #[test]
    fn parts_of_two_threads_are_one() {
        let whole = record(ALL, &[ALL]);
        assert!(whole.of(&Stage::of(&ALL), MANY).is_none() && whole.knows(&Stage::of(&Techniques::PATH)));
        let (mut a, mut b) = (whole.blank(), whole.blank());
        for (part, value) in [(&mut a, 2.0), (&mut b, 4.0)] {
            part.take(0, &brought(value, [0.5, 0.5, 0.0, 0.0, 0.0], &ALL));
            part.end_sample();
        }
        a.merge(&b);
        assert_eq!((squares(&a, ALL), a.samples()), (10.0, 2));
        assert!(!a.knows(&Stage::of(&Techniques::PATH)));
    }
}
