//! Means, their errors, and how far apart two may be.

use bidir_kernel::math;

/// Chance that a right program fails one test when its seeds are changed. There are about a hundred tests.
pub const LEVEL: f64 = 2e-4;

/// A mean with its standard error, from independent batches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The mean.
    pub mean: f64,
    /// Its standard error.
    pub error: f64,
    /// Degrees of freedom behind the error; infinite if it is known rather than estimated.
    pub degrees: f64,
}

impl Estimate {
    /// From what the batches brought.
    pub fn of(batches: &[f64]) -> Self {
        let n = batches.len() as f64;
        let mean = batches.iter().sum::<f64>() / n;
        let squares: f64 = batches.iter().map(|b| (b - mean) * (b - mean)).sum();
        Self { mean, error: (squares / (n * (n - 1.0))).sqrt(), degrees: n - 1.0 }
    }

    /// What is known without error.
    pub fn exactly(mean: f64) -> Self {
        Self { mean, error: 0.0, degrees: f64::INFINITY }
    }

    /// The difference of two independent estimates (Welch & Satterthwaite's degrees of freedom).
    pub fn minus(&self, other: &Self) -> Self {
        let (a, b) = (self.error * self.error, other.error * other.error);
        let parts = a * a / self.degrees + b * b / other.degrees;
        let degrees = if parts > 0.0 { (a + b) * (a + b) / parts } else { f64::INFINITY };
        Self { mean: self.mean - other.mean, error: (a + b).sqrt(), degrees }
    }

    /// How many standard errors the mean lies from 0; f32 rounding of a sum of `scale` is no deviation.
    pub fn deviation(&self, scale: f64) -> f64 {
        let rounding = 2e-6 * scale.abs();
        let error = self.error.hypot(rounding);
        if self.mean == 0.0 { 0.0 } else { self.mean.abs() / error.max(f64::MIN_POSITIVE) }
    }
}

/// The larger one; not a number is larger than any.
pub fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || b <= a { a } else { b }
}

/// How many standard errors are too many in any of `comparisons`, at [`LEVEL`] for all of them together:
/// the two-sided quantile of Student's t, by its expansion about the normal one (Abramowitz & Stegun 26.7.5).
pub fn threshold(comparisons: usize, degrees: f64) -> f64 {
    let z = normal_quantile(LEVEL / comparisons.max(1) as f64);
    let (z2, n) = (z * z, degrees);
    let g = [
        z * (z2 + 1.0) / 4.0,
        z * ((5.0 * z2 + 16.0) * z2 + 3.0) / 96.0,
        z * (((3.0 * z2 + 19.0) * z2 + 17.0) * z2 - 15.0) / 384.0,
        z * ((((79.0 * z2 + 776.0) * z2 + 1482.0) * z2 - 1920.0) * z2 - 945.0) / 92160.0,
    ];
    z + g[0] / n + g[1] / (n * n) + g[2] / n.powi(3) + g[3] / n.powi(4)
}

/// The z that a normal variable exceeds in size with this chance.
fn normal_quantile(chance: f64) -> f64 {
    let (mut low, mut high) = (0.0, 10.0);
    for _ in 0..60 {
        let middle: f64 = 0.5 * (low + high);
        let beyond = f64::from(math::erfc((middle / std::f64::consts::SQRT_2) as f32));
        if beyond > chance { low = middle } else { high = middle }
    }
    high
}

/// One of `comparisons` with what is known: `found` must be `wanted` as far as chance explains, and within the share `within` of it,
/// or three standard errors where those are more; they may be half of it at most.
pub fn assert_is(what: &str, found: &Estimate, wanted: f64, comparisons: usize, within: f64) {
    let apart = found.minus(&Estimate::exactly(wanted));
    let (deviation, limit) = (apart.deviation(wanted), threshold(comparisons, apart.degrees));
    let (share, doubt) = (apart.mean / wanted, apart.error / wanted.abs());
    let what = format!(
        "{what}: {:.6} for {wanted:.6}, {:+.3} % ± {:.3} %, {deviation:.2} σ of {limit:.2}",
        found.mean,
        100.0 * share,
        100.0 * doubt
    );
    println!("{what}");
    assert!(doubt < 0.5 * within, "too little to tell: {what}");
    assert!(deviation < limit && share.abs() < within.max(3.0 * doubt), "{what}");
}

#[test]
fn thresholds_are_students_quantiles() {
    // From tables: t(1 − α/2, ν).
    for (comparisons, degrees, quantile) in [(1, f64::INFINITY, 3.7190), (1, 30.0, 4.2340), (20, 30.0, 5.2995)] {
        let found = threshold(comparisons, degrees);
        assert!((found - quantile).abs() < 0.02, "{found} for {quantile}");
    }
}

#[test]
fn a_shifted_mean_is_noticed_and_an_unshifted_one_is_not() {
    let batch = |i: u32, shift: f64| f64::from(i.wrapping_mul(2_654_435_761) >> 8) / f64::from(1 << 24) + shift;
    let estimate = |from: u32, shift| Estimate::of(&(from..from + 32).map(|i| batch(i, shift)).collect::<Vec<_>>());
    let (a, b, shifted) = (estimate(1, 0.0), estimate(100, 0.0), estimate(100, 0.5));
    let limit = threshold(1, a.minus(&b).degrees);
    assert!(a.minus(&b).deviation(a.mean) < limit);
    assert!(a.minus(&shifted).deviation(a.mean) > limit);
}
