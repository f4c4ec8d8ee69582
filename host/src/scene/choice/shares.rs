//! Shares in what is chosen with one random number, whoever asks: those of the lights in their power.

use bidir_kernel::Real;

/// How many numbers a sampler can give: multiples of 2^−24.
pub(super) const STEPS: u64 = 1 << 24;

/// A distribution over indices. Random numbers come in steps, and each index owns a whole number of them, at least one, however small
/// its share is: so what is picked and what is asked afterwards agree exactly.
#[derive(Clone, Debug, Default)]
pub(super) struct Shares {
    shares: Vec<Real>,
    /// Those shares, added up.
    cumulative: Vec<Real>,
}

impl Shares {
    /// In proportion to these numbers, each above 0 and finite.
    pub fn new(weights: &[f64]) -> Self {
        let total: f64 = weights.iter().sum();
        let spare = STEPS.saturating_sub(weights.len() as u64) as f64;
        let (mut sum, mut before, mut all) = (0.0, 0, Self::default());
        for (weight, count) in weights.iter().zip(1..) {
            sum += weight / total;
            let end = count + (sum.min(1.0) * spare).round() as u64;
            all.shares.push((end - before) as Real / STEPS as Real);
            all.cumulative.push(end as Real / STEPS as Real);
            before = end;
        }
        all
    }

    /// The index that `u` in [0, 1) chooses, and its share; `None` where there are none.
    #[inline]
    pub fn pick(&self, u: Real) -> Option<(usize, Real)> {
        let index = self.cumulative.partition_point(|&sum| sum <= u).min(self.shares.len().checked_sub(1)?);
        Some((index, self.shares[index]))
    }

    /// The share of an index.
    #[inline]
    pub fn of(&self, index: usize) -> Real {
        self.shares[index]
    }
}
