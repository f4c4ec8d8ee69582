//! What calls cost, and how much may be asked in the time there is.

use std::{hint::black_box, time::Instant};

use bidir_kernel::{Carried, Vec2};

use super::{
    dice::Dice,
    report::Cost,
    subject::{Lamps, Surfaces},
};

const BATCHES: usize = 9;
const QUESTIONS: usize = 1024;

/// With all parameters as the first set has them.
pub(super) fn of_bsdf(surfaces: &dyn Surfaces) -> Cost {
    let surface = surfaces.open();
    let bsdf = surface.bsdf(0);
    let mut dice = Dice::new(1);
    let questions: Vec<_> = (0..QUESTIONS)
        .map(|_| {
            let wo = dice.direction();
            (wo.with_z(wo.z.abs()), dice.direction(), dice.three())
        })
        .collect();
    let eval_nanoseconds = median(|at| {
        let (wo, wi, _) = questions[at];
        black_box(bsdf.eval(wo, wi, Carried::Radiance));
    });
    let sample_nanoseconds = median(|at| {
        let (wo, _, u) = questions[at];
        black_box(bsdf.sample(wo, u, Carried::Radiance));
    });
    Cost { eval_nanoseconds, sample_nanoseconds, memory_bytes: surface.memory_bytes() }
}

/// As [`of_bsdf`].
pub(super) fn of_light(lamps: &dyn Lamps) -> Cost {
    let lamp = lamps.open();
    let profile = lamp.profile(0);
    let mut dice = Dice::new(1);
    let questions: Vec<_> = (0..QUESTIONS).map(|_| (dice.direction(), dice.pair())).collect();
    let eval_nanoseconds = median(|at| {
        black_box(profile.eval(Vec2::ZERO, questions[at].0));
    });
    let sample_nanoseconds = median(|at| {
        black_box(profile.emit(Vec2::ZERO, questions[at].1));
    });
    Cost { eval_nanoseconds, sample_nanoseconds, memory_bytes: lamp.memory_bytes() }
}

/// Nanoseconds of one of the questions.
fn median(mut ask: impl FnMut(usize)) -> f64 {
    let mut times = [0.0; BATCHES];
    for time in &mut times {
        let start = Instant::now();
        (0..QUESTIONS).for_each(&mut ask);
        *time = start.elapsed().as_secs_f64() * 1e9 / QUESTIONS as f64;
    }
    times.sort_by(f64::total_cmp);
    times[BATCHES / 2]
}

/// Samples per piece, as a power of 2, where a call takes up to [`PLENTY`]; half as many where it takes twice as long, and so on.
const MOST: u32 = 14;
const LEAST: u32 = 9;
const PLENTY: f64 = 500.0;

/// How much can be asked in well under a minute.
pub(super) fn effort(cost: &Cost) -> u32 {
    let slower = (0.5 * (cost.eval_nanoseconds + cost.sample_nanoseconds) / PLENTY).log2().ceil().max(0.0);
    MOST.saturating_sub(slower as u32).max(LEAST)
}
