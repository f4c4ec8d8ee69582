//! Lobes into one direction.

use bidir_kernel::{Carried, Chance, Lobe, Made, Real, Scattered, Vec3};

use super::view::View;
use crate::check::{
    dice::Dice,
    ledger::Ledger,
    report::names,
    significance::{Moments, Significance},
    test::Test,
};

/// Draws to count a lobe with, for each sample of a view.
const DRAWS: usize = 4;

/// What rounding may do to a chance or a weight, relatively, and how often what it does to the direction counts.
const ROUNDING: f64 = 2e-3;
const CONDITION: f64 = 4.0;

/// Chances below this are left alone: they are seldom met, and rounding makes them.
const SELDOM: f64 = 1e-5;

/// A delta sample, and how it was drawn.
#[derive(Clone, Copy)]
struct Ray {
    sample: Scattered,
    u: [Real; 3],
    chance: f64,
    chance_rev: f64,
}

fn ray(sample: Scattered, u: [Real; 3]) -> Option<Ray> {
    let Made::Delta { chance: Chance(chance), chance_rev: Chance(chance_rev) } = sample.made else { return None };
    Some(Ray { sample, u, chance: f64::from(chance), chance_rev: f64::from(chance_rev) })
}

pub(super) fn judge(view: &View<'_>, samples: usize, ledger: &mut Ledger, dice: &mut Dice) {
    for lobe in [Lobe::DELTA_REFLECTION, Lobe::DELTA_TRANSMISSION] {
        if !view.promises.lobes.intersects(lobe) {
            continue;
        }
        let Some(first) = counted(view, lobe, DRAWS * samples, ledger, dice) else { continue };
        carried(view, &first, ledger);
        back(view, lobe, &first, ledger, dice);
    }
}

/// Draws many samples, and gives the first from the lobe.
fn counted(view: &View<'_>, lobe: Lobe, draws: usize, ledger: &mut Ledger, dice: &mut Dice) -> Option<Ray> {
    let (mut first, mut off) = (None::<Ray>, Moments::default());
    for _ in 0..draws {
        let u = dice.three();
        let Some(found) = view.sample(u).filter(|sample| sample.lobe == lobe).and_then(|sample| ray(sample, u)) else {
            off.add(0.0);
            continue;
        };
        off.add(1.0);
        ledger.observe(lobe);
        let known = *first.get_or_insert(found);
        let apart = f64::from((found.sample.wi - known.sample.wi).length());
        let uneven = (found.chance / known.chance - 1.0).abs();
        ledger.judge(Test::Chance, apart.max(uneven), ROUNDING, draws as u64, || {
            let words = format!("{} has more than one direction or chance{}", names(lobe).join(""), view.place());
            (view.inputs(Some(found.sample.wi), Some(u)), words)
        });
    }
    let first = first?;
    let bound = Significance::verdict().bound(&off, 1.0) + ROUNDING * first.chance;
    ledger.judge(Test::Chance, (off.mean() - first.chance).abs(), bound, draws as u64, || {
        let (share, name) = (off.mean(), names(lobe).join(""));
        (
            view.inputs(Some(first.sample.wi), Some(first.u)),
            format!("the chance of {name} is {:.4}, and {share:.4} of the samples come from it{}", first.chance, view.place()),
        )
    });
    Some(first)
}

/// The largest of the bands' relative differences, and the ratio there.
fn apart(a: [f64; 3], b: [f64; 3]) -> (f64, f64) {
    let off = |(a, b): (f64, f64)| {
        let largest = a.abs().max(b.abs());
        (if largest > 1e-9 { (a - b).abs() / largest } else { 0.0 }, a / b)
    };
    a.into_iter().zip(b).map(off).fold((0.0, 1.0), |worst, one| if one.0 > worst.0 { one } else { worst })
}

fn weights(sample: &Scattered, factor: f64) -> [f64; 3] {
    sample.weight.0.map(|weight| factor * f64::from(weight))
}

/// weight for importance = η² · weight for radiance.
fn carried(view: &View<'_>, ray: &Ray, ledger: &mut Ledger) {
    let of = |carried| view.bsdf.sample(view.wo, ray.u, carried);
    let (Some(radiance), Some(importance)) = (of(Carried::Radiance), of(Carried::Importance)) else { return };
    let eta = f64::from(ray.sample.eta);
    let (off, ratio) = apart(weights(&importance, 1.0), weights(&radiance, eta * eta));
    ledger.judge(Test::Carried, off, ROUNDING, 1, || {
        let words =
            format!("a delta sample's weight for importance is {:.3} × that for radiance, and eta² is {:.3}", ratio * eta * eta, eta * eta);
        (view.inputs(Some(ray.sample.wi), Some(ray.u)), format!("{words}{}", view.place()))
    });
}

/// The way back has the chance that was said, leads there, and passes as much.
fn back(view: &View<'_>, lobe: Lobe, there: &Ray, ledger: &mut Ledger, dice: &mut Dice) {
    let wi = there.sample.wi;
    if there.chance_rev < SELDOM || wi.z == 0.0 {
        return;
    }
    let of =
        |wo: Vec3, u| view.bsdf.sample(wo, u, Carried::Importance).filter(|sample| sample.lobe == lobe).and_then(|sample| ray(sample, u));
    let place = || (view.inputs(Some(wi), Some(there.u)), view.place());
    let name = || names(lobe).join("");
    let draws = (25.0 / there.chance_rev).max(64.0) as usize;
    let found = (0..draws).find_map(|_| of(wi, dice.three()));
    // At the critical angle, a rounded direction may be reflected totally, and its neighbour not.
    if found.is_none() && (0..draws).any(|_| of(dice.nudged(wi), dice.three()).is_some()) {
        return;
    }
    ledger.demand(Test::Reverse, found.is_some(), || {
        let (inputs, place) = place();
        (
            inputs,
            format!("{} says that its way back has the chance {:.4}, and none of {draws} samples took it{place}", name(), there.chance_rev),
        )
    });
    let Some(back) = found else { return };
    // What rounding of the direction does to chance, direction and weight.
    let mut spread: f64 = 0.0;
    for _ in 0..4 {
        let Some(moved) = of(dice.nudged(wi), back.u) else { return };
        let weights = apart(weights(&moved.sample, moved.chance), weights(&back.sample, back.chance)).0;
        let away = f64::from((moved.sample.wi - back.sample.wi).length());
        spread = spread.max((moved.chance - back.chance).abs().max((moved.chance_rev - back.chance_rev).abs())).max(weights).max(away);
    }
    for (said, is, what) in [(there.chance_rev, back.chance, "chance_rev"), (back.chance_rev, there.chance, "chance_rev of the way back")] {
        let tolerance = ROUNDING * said.max(is) + CONDITION * spread;
        ledger.judge(Test::Reverse, (said - is).abs(), tolerance, 1, || {
            let (inputs, place) = place();
            (inputs, format!("{what} of {} is {said:.4}, and the chance there {is:.4}{place}", name()))
        });
    }
    let away = f64::from((back.sample.wi - view.wo).length());
    ledger.judge(Test::Reverse, away, ROUNDING + CONDITION * spread, 1, || {
        let (inputs, place) = place();
        (inputs, format!("the way back of {} leads {away:.2e} away from where it began{place}", name()))
    });
    let both = f64::from(there.sample.eta) * f64::from(back.sample.eta);
    ledger.judge(Test::Carried, (both - 1.0).abs(), ROUNDING, 1, || {
        let (inputs, place) = place();
        (inputs, format!("eta there and back multiply to {both:.4}, and must to 1{place}"))
    });
    if view.promises.reciprocal
        && let Some(out) = of(view.wo, there.u)
    {
        let (off, ratio) = apart(weights(&out.sample, out.chance), weights(&back.sample, back.chance));
        ledger.judge(Test::Reciprocity, off, ROUNDING + CONDITION * spread, 1, || {
            let (inputs, place) = place();
            (inputs, format!("{} lets {ratio:.3} times as much through as on the way back{place}", name()))
        });
    }
}
