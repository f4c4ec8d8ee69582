//! Both boundaries of a thin slab at once.

use bidir_sdk::{Bsdf, Carried, Chance, Lobe, Real, Scatter, Scattered, Spectrum, Vec3};

use crate::{
    conductor::mirrored,
    fresnel::{self, RelativeIndex},
    null::passed,
};

/// A slab too thin to displace light: with R at one boundary, all inner reflections together reflect
/// R + T²R + T²R³ + … = 2R/(1 + R) and let the rest straight through, from both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinDielectric {
    /// Index of refraction inside the slab / outside.
    pub eta: Real,
    /// Multiplies the reflection; black: never picked.
    pub specular_reflectance: Spectrum,
    /// Multiplies the transmission; black: never picked.
    pub specular_transmittance: Spectrum,
}

impl Bsdf for ThinDielectric {
    #[inline]
    fn eval(&self, _: Vec3, _: Vec3, _: Carried) -> Scatter {
        Scatter::NONE
    }

    #[inline]
    fn sample(&self, wo: Vec3, u: [Real; 3], _: Carried) -> Option<Scattered> {
        let cos = wo.z.abs();
        if !(cos > 0.0) {
            return None;
        }
        let once = fresnel::dielectric(cos, RelativeIndex::seen_from(self.eta, cos)).reflectance;
        let reflectance = 2.0 * once / (1.0 + once);
        let reflect = fresnel::reflection_chance(reflectance, self.specular_reflectance, self.specular_transmittance);
        if u[2] < reflect {
            return Some(mirrored(wo, self.specular_reflectance * (reflectance / reflect), Chance(reflect)));
        }
        if !(reflect < 1.0) {
            return None;
        }
        let transmit = 1.0 - reflect;
        Some(passed(wo, self.specular_transmittance * ((1.0 - reflectance) / transmit), Chance(transmit)))
    }

    #[inline]
    fn lobes(&self) -> Lobe {
        Lobe::DELTA
    }
}
