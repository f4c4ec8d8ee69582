//! A surface that is not there.

use bidir_sdk::{Bsdf, Carried, Chance, Lobe, Made, Real, Scatter, Scattered, Spectrum, Vec3};

/// Lets light pass as if nothing were there.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Null;

impl Bsdf for Null {
    #[inline]
    fn eval(&self, _: Vec3, _: Vec3, _: Carried) -> Scatter {
        Scatter::NONE
    }

    #[inline]
    fn sample(&self, wo: Vec3, _: [Real; 3], _: Carried) -> Option<Scattered> {
        Some(passed(wo, Spectrum::ONE, Chance(1.0)))
    }

    #[inline]
    fn lobes(&self) -> Lobe {
        Lobe::DELTA_TRANSMISSION
    }
}

/// Straight on, with the same chance both ways.
#[inline]
pub(crate) fn passed(wo: Vec3, weight: Spectrum, chance: Chance) -> Scattered {
    Scattered { wi: -wo, weight, made: Made::Delta { chance, chance_rev: chance }, eta: 1.0, lobe: Lobe::DELTA_TRANSMISSION }
}
