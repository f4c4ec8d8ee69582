//! The kernel's closed sums in f32, to see what f64 is for, and what it costs. Nothing renders with them.

use bidir_kernel::weight::Step;

/// [`bidir_kernel::weight::Side`], in f32.
#[derive(Clone, Copy, Debug)]
pub struct SingleSide {
    per_forward: f32,
    here: f32,
    back: f32,
    earlier: f32,
}

fn of(power: bool, x: f64) -> f32 {
    let x = x as f32;
    if power { x * x } else { x }
}

/// a · b, where 0 times whatever is 0.
fn times(a: f32, b: f32) -> f32 {
    if a == 0.0 || b == 0.0 { 0.0 } else { a * b }
}

impl SingleSide {
    /// As [`bidir_kernel::weight::Side::start`].
    #[inline]
    pub fn start(power: bool, end: f64, hit: f64) -> Self {
        Self { per_forward: of(power, 1.0 / end), here: of(power, hit), back: 0.0, earlier: 0.0 }
    }

    /// As [`bidir_kernel::weight::Side::advance`].
    #[inline]
    pub fn advance(&self, power: bool, step: &Step) -> Self {
        let (joined, effort) = if step.delta { (0.0, 0.0) } else { (self.here, step.effort) };
        Self {
            per_forward: of(power, 1.0 / (step.pdf * step.forward)),
            here: of(power, effort),
            back: times(of(power, step.backward), self.per_forward),
            earlier: joined + times(times(of(power, step.pdf_rev), self.back), self.earlier),
        }
    }

    /// As [`bidir_kernel::weight::Side::sum`].
    #[inline]
    pub fn sum(&self, power: bool, across: f64, pdf_rev: f64) -> f32 {
        times(times(of(power, across), self.per_forward), self.here + times(times(of(power, pdf_rev), self.back), self.earlier))
    }
}

/// The definition of the weights, from the kernel's own tests.
#[path = "../../kernel/src/weight_tests/oracle.rs"]
pub mod oracle;

use bidir_kernel as kernel;
use kernel::{Heuristic, Join};

impl oracle::Sums for SingleSide {
    fn start(heuristic: Heuristic, end: f64, _: Join, hit: f64) -> Self {
        Self::start(heuristic == Heuristic::Power, end, hit)
    }

    fn advance(&self, heuristic: Heuristic, step: &Step) -> Self {
        self.advance(heuristic == Heuristic::Power, step)
    }

    fn sum(&self, heuristic: Heuristic, across: f64, pdf_rev: f64) -> f64 {
        f64::from(self.sum(heuristic == Heuristic::Power, across, pdf_rev))
    }

    fn sum_of_hit(&self, heuristic: Heuristic, end: f64, pdf_rev: f64, (_, instead): (Join, f64)) -> f64 {
        let power = heuristic == Heuristic::Power;
        let closed = times(times(of(power, pdf_rev), self.back), self.earlier);
        f64::from(self.per_forward * (instead as f32 + of(power, end) * closed))
    }
}
