//! Russian roulette, outside all densities: the weights still add up to 1, and the estimate stays unbiased.

use crate::{
    film::Contribution,
    math::floor,
    real::Real,
    sampler::{Sampler, Walk},
};

/// The highest chance of survival: nothing lives for ever.
const MOST: Real = 0.95;

/// Decides over a walk whose relative throughput is `throughput`: the factor that a survivor is scaled by, or `None`.
#[inline]
pub(crate) fn survive(throughput: Real, u: Real) -> Option<Real> {
    let chance = throughput.min(MOST);
    (u < chance).then(|| 1.0 / chance)
}

/// Random numbers are multiples of 1 over this.
const STEPS: Real = 16_777_216.0;

/// Whether a contribution is worth its shadow ray (Veach 1997, 10.4): where it is less than `threshold`, δ, with the chance
/// contribution/δ, by which it is then divided. The number lies in a dimension of its own, and is drawn only where it decides.
#[inline]
pub(crate) fn casts(contribution: &mut Contribution, threshold: Real, sampler: &mut impl Sampler, (walk, dimension): (Walk, u32)) -> bool {
    let amount = (contribution.value * contribution.weight).max();
    // What is not a number is the film's to refuse.
    if !matches!(amount.partial_cmp(&threshold), Some(core::cmp::Ordering::Less)) {
        return true;
    }
    // The chance that a number is less: the next multiple above.
    let chance = (floor(amount / threshold * STEPS) + 1.0) / STEPS;
    sampler.seek(walk, dimension);
    let cast = sampler.next() < chance;
    if cast {
        contribution.value = contribution.value / chance;
    }
    cast
}
