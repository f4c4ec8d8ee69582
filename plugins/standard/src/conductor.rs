//! A smooth metal.

use bidir_sdk::{Bsdf, Carried, Chance, Lobe, Made, Real, Scatter, Scattered, Spectrum, Vec3, math::vec3};

use crate::fresnel;

/// A mirror that reflects by Fresnel's equations, above; nothing below.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conductor {
    /// Real part of the index of refraction, relative to outside. 0 with `k` = 1 reflects everything.
    pub eta: Spectrum,
    /// Imaginary part.
    pub k: Spectrum,
    /// Multiplies the reflection.
    pub specular_reflectance: Spectrum,
}

impl Bsdf for Conductor {
    #[inline]
    fn eval(&self, _: Vec3, _: Vec3, _: Carried) -> Scatter {
        Scatter::NONE
    }

    #[inline]
    fn sample(&self, wo: Vec3, _: [Real; 3], _: Carried) -> Option<Scattered> {
        if !(wo.z > 0.0) {
            return None;
        }
        Some(mirrored(wo, fresnel::conductor(wo.z, self.eta, self.k) * self.specular_reflectance, Chance(1.0)))
    }

    #[inline]
    fn lobes(&self) -> Lobe {
        Lobe::DELTA_REFLECTION
    }
}

/// Reflected about the normal, with the same chance both ways.
#[inline]
pub(crate) fn mirrored(wo: Vec3, weight: Spectrum, chance: Chance) -> Scattered {
    Scattered {
        wi: vec3(-wo.x, -wo.y, wo.z),
        weight,
        made: Made::Delta { chance, chance_rev: chance },
        eta: 1.0,
        lobe: Lobe::DELTA_REFLECTION,
    }
}
