//! When chance is no longer an excuse.

/// The risk that a whole check of something that is right fails by chance, shared out among all judgments (Bonferroni).
pub const RISK: f64 = 1e-5;

/// No check makes more judgments by chance than this; one number for all, so that a case replayed alone is judged as it was.
pub const JUDGMENTS: f64 = 20_000.0;

/// A deviation that a correct shader shows in one of fifty cases is looked at again, with more samples and other numbers;
/// only what is found then counts.
const SUSPICION: f64 = 0.02;

/// How unlikely a deviation has to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Significance(f64);

impl Significance {
    /// For a verdict.
    pub(super) fn verdict() -> Self {
        Self((2.0 * JUDGMENTS / RISK).ln())
    }

    /// For a second look.
    pub(super) fn suspicion() -> Self {
        Self((2.0f64 / SUSPICION).ln())
    }

    /// In standard deviations of a Gaussian; a little more than its quantile.
    pub(super) fn sigmas(self) -> f64 {
        (2.0 * self.0).sqrt()
    }

    /// How far the mean of so many values may lie from what it should be: the empirical bound of Maurer & Pontil 2009, theorem 4,
    /// which assumes of the values nothing but that they lie within a stretch as long as `extent`.
    pub(super) fn bound(self, values: &Moments, extent: f64) -> f64 {
        let n = values.count.max(2.0);
        (2.0 * values.variance() * self.0 / n).sqrt() + 7.0 * self.0 * extent / (3.0 * (n - 1.0))
    }
}

/// Of values: how many, their mean and variance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Moments {
    pub(super) count: f64,
    sum: f64,
    squares: f64,
    /// The largest, by its amount.
    pub(super) largest: f64,
}

impl Moments {
    pub(super) fn add(&mut self, value: f64) {
        self.count += 1.0;
        self.sum += value;
        self.squares += value * value;
        self.largest = self.largest.max(value.abs());
    }

    pub(super) fn mean(&self) -> f64 {
        if self.count > 0.0 { self.sum / self.count } else { 0.0 }
    }

    pub(super) fn variance(&self) -> f64 {
        if self.count > 1.0 { ((self.squares - self.sum * self.mean()) / (self.count - 1.0)).max(0.0) } else { 0.0 }
    }
}

/// χ² in standard deviations above its mean, as a Gaussian would have it (Wilson & Hilferty 1931).
pub(super) fn sigmas_of_chi_square(chi_square: f64, freedom: f64) -> f64 {
    let spread = 2.0 / (9.0 * freedom);
    ((chi_square / freedom).cbrt() - (1.0 - spread)) / spread.sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chi_square_has_its_tabled_quantiles() {
        // 0.1 % and 50 % of 10 and 100 degrees of freedom.
        for (freedom, value, sigmas) in [(10.0, 29.588, 3.09), (100.0, 149.449, 3.09), (10.0, 9.342, 0.0), (100.0, 99.334, 0.0)] {
            assert!((sigmas_of_chi_square(value, freedom) - sigmas).abs() < 0.02, "{freedom}, {value}");
        }
    }
}
