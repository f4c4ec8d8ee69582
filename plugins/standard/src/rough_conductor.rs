//! A metal of microfacets.

use bidir_sdk::{
    Bsdf, Carried, Chance, Lobe, Made, PerSolidAngle, Real, Scatter, Scattered, Spectrum, Vec3,
    math::{dot, normalize},
};

use crate::{
    conductor::mirrored,
    fresnel,
    microfacet::{Microfacet, reflect},
};

/// Tiny mirrors that reflect by Fresnel's equations, above; nothing below (Walter et al. 2007, eq. 20).
/// Too little roughness to be told from a mirror is a mirror: see [`Microfacet::LEAST`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoughConductor {
    /// Real part of the index of refraction, relative to outside. 0 with `k` = 1 reflects everything.
    pub eta: Spectrum,
    /// Imaginary part.
    pub k: Spectrum,
    /// Multiplies the reflection.
    pub specular_reflectance: Spectrum,
    /// The mirrors.
    pub microfacet: Microfacet,
}

impl RoughConductor {
    #[inline]
    fn fresnel(&self, cos: Real) -> Spectrum {
        fresnel::conductor(cos.clamp(0.0, 1.0), self.eta, self.k) * self.specular_reflectance
    }

    /// D/4 and the visibility of both directions; all of f and of the densities but the Fresnel factor.
    #[inline]
    fn facing(&self, wo: Vec3, wi: Vec3, m: Vec3) -> (Real, Real, Real) {
        (0.25 * self.microfacet.density(m), self.microfacet.visibility(wo), self.microfacet.visibility(wi))
    }
}

impl Bsdf for RoughConductor {
    #[inline]
    fn eval(&self, wo: Vec3, wi: Vec3, _: Carried) -> Scatter {
        if !(wo.z > 0.0 && wi.z > 0.0) || self.microfacet.is_smooth() {
            return Scatter::NONE;
        }
        let Some(m) = normalize(wo + wi) else { return Scatter::NONE };
        let (density, out, back) = self.facing(wo, wi, m);
        Scatter {
            value: self.fresnel(dot(wo, m)) * (density * out * back * wi.z),
            pdf: PerSolidAngle(density * out),
            pdf_rev: PerSolidAngle(density * back),
        }
    }

    #[inline]
    fn sample(&self, wo: Vec3, u: [Real; 3], _: Carried) -> Option<Scattered> {
        if !(wo.z > 0.0) {
            return None;
        }
        if self.microfacet.is_smooth() {
            return Some(mirrored(wo, self.fresnel(wo.z), Chance(1.0)));
        }
        let wi = normalize(reflect(wo, self.microfacet.sample_visible(wo, [u[0], u[1]])?))?;
        if !(wi.z > 0.0) {
            return None;
        }
        // Densities of the rounded direction, so that they are those that `eval` gives.
        let m = normalize(wo + wi)?;
        let (density, out, back) = self.facing(wo, wi, m);
        if !(density > 0.0) {
            return None;
        }
        Some(Scattered {
            wi,
            weight: self.fresnel(dot(wo, m)) * (back * wi.z),
            made: Made::Smooth { pdf: PerSolidAngle(density * out), pdf_rev: PerSolidAngle(density * back) },
            eta: 1.0,
            lobe: Lobe::GLOSSY_REFLECTION,
        })
    }

    #[inline]
    fn lobes(&self) -> Lobe {
        if self.microfacet.is_smooth() { Lobe::DELTA_REFLECTION } else { Lobe::GLOSSY_REFLECTION }
    }
}
