//! A smooth boundary between two media.

use bidir_sdk::{
    Bsdf, Carried, Chance, Lobe, Made, Real, Scatter, Scattered, Spectrum, Vec3,
    math::{sqr, vec3},
};

use crate::{
    conductor::mirrored,
    fresnel::{self, RelativeIndex},
};

/// Reflects and refracts into one direction each, from both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dielectric {
    /// Index of refraction inside / outside; the normal points outside. 1 passes straight through.
    pub eta: Real,
    /// Multiplies the reflection; black: never picked.
    pub specular_reflectance: Spectrum,
    /// Multiplies the refraction; black: never picked.
    pub specular_transmittance: Spectrum,
}

impl Bsdf for Dielectric {
    #[inline]
    fn eval(&self, _: Vec3, _: Vec3, _: Carried) -> Scatter {
        Scatter::NONE
    }

    #[inline]
    fn sample(&self, wo: Vec3, u: [Real; 3], carried: Carried) -> Option<Scattered> {
        let cos = wo.z.abs();
        if !(cos > 0.0) {
            return None;
        }
        let index = RelativeIndex::seen_from(self.eta, wo.z);
        let (eta, boundary) = (index.eta, fresnel::dielectric(cos, index));
        let reflect = fresnel::reflection_chance(boundary.reflectance, self.specular_reflectance, self.specular_transmittance);
        if u[2] < reflect {
            return Some(mirrored(wo, self.specular_reflectance * (boundary.reflectance / reflect), Chance(reflect)));
        }
        if !(boundary.cos_refracted > 0.0 && reflect < 1.0) {
            return None;
        }
        let down = if wo.z > 0.0 { -boundary.cos_refracted } else { boundary.cos_refracted };
        let chance = Chance(1.0 - reflect);
        Some(Scattered {
            wi: vec3(-wo.x / eta, -wo.y / eta, down),
            weight: self.specular_transmittance * ((1.0 - boundary.reflectance) / chance.0 * refraction_factor(eta, carried)),
            made: Made::Delta { chance, chance_rev: chance },
            eta,
            lobe: Lobe::DELTA_TRANSMISSION,
        })
    }

    #[inline]
    fn lobes(&self) -> Lobe {
        Lobe::DELTA
    }
}

/// What refraction multiplies radiance with: it spreads over η² as much solid angle (Veach 1997, 5.2). Nothing for importance.
#[inline(always)]
pub(crate) fn refraction_factor(eta: Real, carried: Carried) -> Real {
    match carried {
        Carried::Radiance => 1.0 / sqr(eta),
        Carried::Importance => 1.0,
    }
}
