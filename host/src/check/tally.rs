//! Two numbers that should be one, many times over.
//!
//! In f32 they seldom are: a half vector rounded by 6e-8 moves the density of a lobe 1e-4 wide by 0.1 %. What rounding may do
//! is found by moving the inputs by about as much; and since it goes either way, the mean of many differences tells a mistake
//! that is smaller.

use super::{
    ledger::{Inputs, Ledger},
    significance::{Moments, Significance},
    test::Test,
};

/// Relative: what plain arithmetic in f32 adds up to.
const ROUNDING: f64 = 2e-3;

/// What the inputs' rounding does counts so many times.
const CONDITION: f64 = 4.0;

/// From here on, rounding says more than the number.
const HOPELESS: f64 = 0.05;

/// Of differences beyond their tolerance, this share may be: a jump may lie between a direction and its rounding.
const STRAY: f64 = 0.005;

/// What the mean of many relative differences may be.
const DRIFT: f64 = 5e-3;
const MANY: f64 = 64.0;

/// Numbers below count as 0, both in a density and in a value.
const NOTHING: f64 = 1e-9;

/// The comparisons of one test in one piece.
#[derive(Debug)]
pub(super) struct Tally {
    test: Test,
    count: u64,
    strays: u64,
    drift: Moments,
    /// Of those beyond their tolerance, and of the others.
    worst: [Option<Worst>; 2],
}

#[derive(Debug)]
struct Worst {
    off: f64,
    tolerance: f64,
    inputs: Inputs,
    words: String,
}

impl Tally {
    pub(super) fn new(test: Test) -> Self {
        Self { test, count: 0, strays: 0, drift: Moments::default(), worst: [None, None] }
    }

    /// Compares what was `found` with what was `wanted`. `spread` is what rounding of the inputs does to them, relatively;
    /// `words` describes the case, given found over wanted.
    pub(super) fn take(&mut self, found: f64, wanted: f64, spread: impl FnOnce() -> f64, words: impl FnOnce(f64) -> (Inputs, String)) {
        self.count += 1;
        let largest = found.abs().max(wanted.abs());
        let off = if largest < NOTHING { 0.0 } else { (found - wanted) / largest };
        let spread = if off.abs() > ROUNDING { spread() } else { 0.0 };
        if spread < HOPELESS && !off.is_nan() {
            self.drift.add(off.clamp(-0.5, 0.5));
        }
        let tolerance = ROUNDING + CONDITION * spread;
        let beyond = off.is_nan() || off.abs() > tolerance;
        self.strays += u64::from(beyond);
        let worst = &mut self.worst[usize::from(!beyond)];
        if worst.as_ref().is_none_or(|worst| off.abs() / tolerance > worst.off.abs() / worst.tolerance) {
            let (inputs, words) = words(found / wanted);
            *worst = Some(Worst { off, tolerance, inputs, words });
        }
    }

    /// Judges all of them at once.
    pub(super) fn settle(self, ledger: &mut Ledger) {
        let Self { test, count, strays, drift, worst: [beyond, within] } = self;
        let allowed = ((STRAY * count as f64) as u64).max((count / 4).min(2));
        let mean = drift.mean().abs();
        let may = DRIFT + Significance::verdict().sigmas() * (drift.variance() / drift.count.max(1.0)).sqrt();
        let drifts = drift.count >= MANY && mean > may;
        match (beyond, within) {
            (Some(beyond), _) if strays > allowed => {
                ledger.judge(test, beyond.off.abs(), beyond.tolerance, count, || (beyond.inputs, beyond.words));
            }
            (_, Some(within)) if drifts => {
                let words = format!("{}, and by {:.2} % on average", within.words, 100.0 * mean);
                ledger.judge(test, mean, may, count, || (within.inputs, words));
            }
            (_, Some(within)) => ledger.judge(test, within.off.abs(), within.tolerance, count, || (within.inputs, within.words)),
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::dice::Dice;

    /// Whether the test fails for numbers that are off by a factor and by noise, where the inputs' rounding explains `spread`.
    fn fails(factor: f64, noise: f64, spread: f64) -> bool {
        let (mut tally, mut dice, mut ledger) = (Tally::new(Test::Weight), Dice::new(1), Ledger::default());
        for _ in 0..400 {
            let off = 1.0 + noise * (2.0 * dice.exact() - 1.0);
            tally.take(factor * off, 1.0, || spread, |ratio| (Inputs::default(), format!("{ratio}")));
        }
        tally.settle(&mut ledger);
        ledger.entries[&Test::Weight].failed > 0
    }

    #[test]
    fn noise_that_rounding_explains_passes_and_three_percent_do_not() {
        assert!(!fails(1.0, 0.0, 0.0) && !fails(1.0, 0.01, 0.01) && !fails(1.0, 0.03, 0.02));
        assert!(fails(1.03, 0.0, 0.0) && fails(0.97, 0.01, 0.01) && fails(1.03, 0.03, 0.02) && fails(1.003, 0.0, 0.0));
    }

    #[test]
    fn one_stray_is_forgiven_and_many_are_not() {
        for (strays, fails) in [(1, false), (40, true)] {
            let (mut tally, mut ledger) = (Tally::new(Test::Reverse), Ledger::default());
            for i in 0..400 {
                tally.take(if i < strays { 2.0 } else { 1.0 }, 1.0, || 0.0, |_| Default::default());
            }
            tally.settle(&mut ledger);
            assert_eq!(ledger.entries[&Test::Reverse].failed > 0, fails);
        }
    }
}
