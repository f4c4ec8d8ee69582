//! What a comparison found, and what it may.

use std::fmt;

/// One figure of a case against its bound.
#[derive(Clone, Debug)]
pub struct Held {
    /// What is measured.
    pub measure: &'static str,
    /// The worst that was found, in units of what rounding explains.
    pub worst: f64,
    /// The most that is accepted.
    pub bound: f64,
    /// The share of samples whose paths part.
    pub parted: f64,
    /// Where the worst was found, and what it was.
    pub what: String,
}

impl Held {
    /// Whether the worst lies within the bound. NaN does not.
    pub fn holds(&self) -> bool {
        self.worst <= self.bound
    }
}

impl fmt::Display for Held {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { measure, worst, bound, parted, what } = self;
        write!(f, "{measure}: {worst:.2} of {bound}, parted {:.3} % — {what}", 100.0 * parted)
    }
}

/// Answers below this are noughts: f32 ends at 1e-38.
const NOUGHT: f64 = 1e-30;

/// How far two answers are apart, relative to the largest number of either: at most 2, and infinite where one is no number.
pub fn relative(a: &[f64], b: &[f64]) -> f64 {
    let size = a.iter().chain(b).fold(NOUGHT, |size, x| size.max(x.abs()));
    let off = a.iter().zip(b).map(|(a, b)| (a - b).abs());
    off.fold(0.0, |worst, off| if off.is_finite() { worst.max(off / size) } else { f64::INFINITY })
}
