//! Where a mean lies, from a few independent values.

use serde::Serialize;

/// How sure intervals are.
pub const CONFIDENCE: f64 = 0.95;

/// Student's t: the quantile that leaves 2.5 % on either side, for 1, 2, 3 … degrees of freedom.
const STUDENT: [f64; 30] = [
    12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145, 2.131, 2.120, 2.110, 2.101, 2.093,
    2.086, 2.080, 2.074, 2.069, 2.064, 2.060, 2.056, 2.052, 2.048, 2.045, 2.042,
];

/// A value that was measured, and where it lies with [`CONFIDENCE`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Interval {
    /// The best guess.
    pub value: f64,
    /// Not below this; `None` if nothing can be said.
    pub low: Option<f64>,
    /// Not above this.
    pub high: Option<f64>,
}

impl Interval {
    /// Of the mean of independent values, less something that was known with that standard deviation (from many values, so that its own
    /// is exact). The values' mean has a standard deviation of `least` at least, told by many more samples: few values that all missed what
    /// is rare agree with each other, and do not know it. The degrees of freedom are Welch's (1947), rounded down.
    pub fn of(values: &[f64], deviation: f64, least: f64) -> Self {
        let n = values.len() as f64;
        let value = values.iter().sum::<f64>() / n.max(1.0);
        let squares: f64 = values.iter().map(|x| (x - value) * (x - value)).sum();
        let own = if n > 1.0 { squares / (n - 1.0) / n } else { f64::NAN };
        let all = if own < least * least { least * least } else { own } + deviation * deviation;
        let freedom = if own > 0.0 { (n - 1.0) * (all / own) * (all / own) } else { f64::INFINITY };
        let student = if freedom < 31.0 { STUDENT[(freedom as usize).clamp(1, 30) - 1] } else { 1.960 };
        let reach = student * all.sqrt();
        let end = |end: f64| end.is_finite().then_some(end);
        Self { value, low: end(value - reach), high: end(value + reach) }
    }

    /// Whether the interval leaves this out.
    pub fn excludes(&self, value: f64) -> bool {
        self.low.is_some_and(|low| value < low) || self.high.is_some_and(|high| value > high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_interval_is_students() {
        let found = Interval::of(&[1.0, 2.0, 3.0], 0.0, 0.0);
        let reach = 4.303 * (1.0f64 / 3.0).sqrt();
        assert!((found.value - 2.0).abs() < 1e-12 && (found.high.unwrap() - 2.0 - reach).abs() < 1e-9, "{found:?}");
        assert!(!found.excludes(0.0) && found.excludes(-1.0) && found.excludes(5.0));
    }

    #[test]
    fn a_reference_that_is_less_sure_than_the_values_widens_it() {
        let found = Interval::of(&[1.0, 1.0, 1.0, 1.0], 0.5, 0.0);
        assert!((found.high.unwrap() - 1.98).abs() < 1e-9, "{found:?}");
        let [few, many] = [&[0.9, 1.1][..], &[0.9, 1.1, 0.9, 1.1, 0.9, 1.1]].map(|values| Interval::of(values, 0.01, 0.0));
        assert!(few.high.unwrap() > many.high.unwrap());
    }

    #[test]
    fn values_that_agree_by_luck_are_no_surer_than_what_is_known() {
        let found = Interval::of(&[1.0, 1.001, 0.999, 1.0], 0.0, 0.1);
        assert!((found.high.unwrap() - 1.196).abs() < 1e-3, "{found:?}");
    }

    #[test]
    fn one_value_says_nothing_of_its_interval() {
        assert_eq!(Interval::of(&[1.0], 0.1, 0.0), Interval { value: 1.0, low: None, high: None });
        assert!(!Interval::of(&[1.0], 0.1, 0.0).excludes(0.0));
    }
}
