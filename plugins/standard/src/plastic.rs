//! A smooth dielectric coat over a diffuse base.

use bidir_sdk::{
    Bsdf, Carried, Chance, Lobe, Made, PerSolidAngle, Real, Scatter, Scattered, Spectrum, Vec3,
    math::sqr,
    real::INV_PI,
    warp::{cosine_hemisphere, cosine_hemisphere_pdf},
};

use crate::{
    conductor::mirrored,
    fresnel::{self, RelativeIndex},
};

/// A mirror of Fresnel reflectance R over a base that light enters, is scattered in, and leaves again:
/// f = ρ/(1 − ρ' R_inner) · (1 − R(ω_o)) (1 − R(ω_i)) / (π η²), above; nothing below.
/// ρ' is ρ where inner reflections saturate the colour (`nonlinear`), 1 where they do not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plastic {
    /// Index of refraction inside / outside.
    pub eta: Real,
    /// Albedo of the base, ρ.
    pub diffuse_reflectance: Spectrum,
    /// Multiplies the coat's reflection.
    pub specular_reflectance: Spectrum,
    /// Whether inner reflections saturate the base's colour.
    pub nonlinear: bool,
    /// What the coat reflects back of light that leaves the base: [`Plastic::inner_reflectance`] of `eta`.
    pub inner_reflectance: Real,
}

/// How the lobes share the samples of one direction.
struct Shares {
    /// The coat's reflectance.
    reflectance: Real,
    /// What both lobes' shares are divided by.
    total: Real,
    /// The chance of the coat.
    specular: Real,
}

impl Plastic {
    /// Derives `inner_reflectance`.
    pub fn new(eta: Real, diffuse_reflectance: Spectrum, specular_reflectance: Spectrum, nonlinear: bool) -> Self {
        Self { eta, diffuse_reflectance, specular_reflectance, nonlinear, inner_reflectance: Self::inner_reflectance(eta) }
    }

    /// What the coat reflects of diffuse light from inside; depends on `eta` alone, so it can be kept.
    pub fn inner_reflectance(eta: Real) -> Real {
        fresnel::diffuse(1.0 / eta)
    }

    /// The coat's part of the colours; the base has the rest.
    #[inline]
    pub(crate) fn coat_part(&self) -> Real {
        let (specular, diffuse) = (self.specular_reflectance.mean(), self.diffuse_reflectance.mean());
        if specular > 0.0 { specular / (specular + diffuse) } else { 0.0 }
    }

    #[inline]
    fn shares(&self, cos: Real, coat: Real) -> Shares {
        let reflectance = fresnel::dielectric(cos, RelativeIndex::seen_from(self.eta, cos)).reflectance;
        let specular = reflectance * coat;
        let total = specular + (1.0 - reflectance) * (1.0 - coat);
        let chance = if coat == 0.0 {
            0.0
        } else if coat == 1.0 {
            1.0
        } else {
            specular / total
        };
        Shares { reflectance, total, specular: chance }
    }

    /// f π / ((1 − R(ω_o)) (1 − R(ω_i))).
    #[inline]
    pub(crate) fn base(&self) -> Spectrum {
        let scale = 1.0 / sqr(self.eta);
        self.diffuse_reflectance.map(|rho| {
            let again = if self.nonlinear { rho * self.inner_reflectance } else { self.inner_reflectance };
            rho * scale / (1.0 - again)
        })
    }
}

impl Bsdf for Plastic {
    #[inline]
    fn eval(&self, wo: Vec3, wi: Vec3, _: Carried) -> Scatter {
        if !(wo.z > 0.0 && wi.z > 0.0) {
            return Scatter::NONE;
        }
        let coat = self.coat_part();
        let (out, back) = (self.shares(wo.z, coat), self.shares(wi.z, coat));
        // So close to grazing that the coat has every sample, the base is never sampled, and has no value.
        let through = if out.specular < 1.0 { (1.0 - out.reflectance) * (1.0 - back.reflectance) } else { 0.0 };
        Scatter {
            value: self.base() * (through * wi.z * INV_PI),
            pdf: PerSolidAngle((1.0 - out.specular) * cosine_hemisphere_pdf(wi.z)),
            pdf_rev: PerSolidAngle((1.0 - back.specular) * cosine_hemisphere_pdf(wo.z)),
        }
    }

    #[inline]
    fn sample(&self, wo: Vec3, u: [Real; 3], _: Carried) -> Option<Scattered> {
        if !(wo.z > 0.0) {
            return None;
        }
        let coat = self.coat_part();
        let out = self.shares(wo.z, coat);
        if u[2] < out.specular {
            let weight = if coat == 1.0 { out.reflectance } else { out.total / coat };
            return Some(mirrored(wo, self.specular_reflectance * weight, Chance(out.specular)));
        }
        if !(out.specular < 1.0) {
            return None;
        }
        let wi = cosine_hemisphere([u[0], u[1]]);
        let back = self.shares(wi.z, coat);
        let weight = if coat == 0.0 { 1.0 - out.reflectance } else { out.total / (1.0 - coat) };
        Some(Scattered {
            wi,
            weight: self.base() * (weight * (1.0 - back.reflectance)),
            made: Made::Smooth {
                pdf: PerSolidAngle((1.0 - out.specular) * cosine_hemisphere_pdf(wi.z)),
                pdf_rev: PerSolidAngle((1.0 - back.specular) * cosine_hemisphere_pdf(wo.z)),
            },
            eta: 1.0,
            lobe: Lobe::DIFFUSE_REFLECTION,
        })
    }

    #[inline]
    fn lobes(&self) -> Lobe {
        Lobe::DIFFUSE_REFLECTION | Lobe::DELTA_REFLECTION
    }
}
