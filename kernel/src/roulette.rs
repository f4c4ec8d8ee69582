//! Russian roulette, outside all densities: the weights still add up to 1, and the estimate stays unbiased.

use crate::real::Real;

/// The highest chance of survival: nothing lives for ever.
const MOST: Real = 0.95;

/// Decides over a walk whose relative throughput is `throughput`: the factor that a survivor is scaled by, or `None`.
#[inline]
pub(crate) fn survive(throughput: Real, u: Real) -> Option<Real> {
    let chance = throughput.min(MOST);
    (u < chance).then(|| 1.0 / chance)
}
