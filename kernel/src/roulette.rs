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
///
/// Where δ is 0 and every ray is cast, nobody need ask: the ray then comes first, and what is hidden is never weighed.
#[inline]
pub(crate) fn casts(contribution: &mut Contribution, threshold: Real, sampler: &mut impl Sampler, (walk, dimension): (Walk, u32)) -> bool {
    let amount = (contribution.value * contribution.weight).max();
    // What is not a number is the film's to refuse.
    if amount.is_nan() || amount >= threshold {
        return true;
    }
    // The chance that a number is less than that: the next multiple above.
    let chance = (floor(amount / threshold * STEPS) + 1.0) / STEPS;
    sampler.seek(walk, dimension);
    let cast = sampler.next() < chance;
    if cast {
        contribution.value = contribution.value / chance;
    }
    cast
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{spectrum::Spectrum, technique::Technique};

    /// Gives one number, and counts how often it is asked.
    struct One(Real, u32);

    impl Sampler for One {
        fn seek(&mut self, _: Walk, _: u32) {}

        fn next(&mut self) -> Real {
            self.1 += 1;
            self.0
        }
    }

    fn cast(value: Real, threshold: Real, number: Real) -> (Option<Real>, u32) {
        let mut contribution = Contribution { value: Spectrum([0.0, value, 0.0]), weight: 0.5, technique: Technique { s: 1, t: 2 } };
        let mut sampler = One(number, 0);
        let cast = casts(&mut contribution, threshold, &mut sampler, (Walk::Camera, 0));
        (cast.then_some(contribution.value[1]), sampler.1)
    }

    /// The numbers are k/2²⁴, and the first n of them cast the ray: n/2²⁴ times the scaled value is the value.
    #[test]
    fn a_contribution_is_divided_by_how_often_its_ray_is_cast() {
        for (value, threshold) in [(1.0, 3.0), (0.7, 0.36), (1e-3, 10.0), (1e-9, 1.0), (1e-30, 1e30), (0.0, 1.0)] {
            let casts = |k: &u32| cast(value, threshold, *k as Real / STEPS);
            let (mut cast, mut spared) = (0, STEPS as u32);
            while spared - cast > 1 {
                let middle = cast + (spared - cast) / 2;
                if casts(&middle).0.is_some() { cast = middle } else { spared = middle }
            }
            let (Some(scaled), 1) = casts(&0) else { panic!("{value} of {threshold}: nothing is ever cast") };
            let mean = scaled * (spared as Real / STEPS);
            assert!((mean - value).abs() <= 1e-6 * value, "{value} of {threshold}: {mean} in the mean");
        }
    }

    #[test]
    fn what_reaches_the_threshold_asks_for_no_number() {
        for (value, threshold) in [(2.0, 1.0), (1.0, 0.25), (1.0, 0.0), (Real::INFINITY, 1.0)] {
            assert_eq!(cast(value, threshold, 0.999), (Some(value), 0));
        }
        assert!(cast(Real::NAN, 1.0, 0.999).0.is_some_and(Real::is_nan));
    }
}
