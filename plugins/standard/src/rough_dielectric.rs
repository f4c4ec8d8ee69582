//! A boundary of microfacets between two media.

use bidir_sdk::{
    Bsdf, Carried, Lobe, Made, PerSolidAngle, Real, Scatter, Scattered, Spectrum, Vec3,
    math::{dot, min, normalize, sqr, sqrt, vec3},
};

use crate::{
    dielectric::{Dielectric, refraction_factor},
    fresnel::{self, RelativeIndex},
    microfacet::{Microfacet, reflect},
};

/// Tiny boundaries that reflect and refract, from both sides (Walter et al. 2007, eq. 20 and 21).
///
/// Refraction spreads by about |η − 1| α; where that is too little to be told from a smooth boundary
/// (see [`Microfacet::LEAST`]; η = 1 included), this is a [`Dielectric`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoughDielectric {
    /// Index of refraction inside / outside; the normal points outside. 1 passes straight through.
    pub eta: Real,
    /// Multiplies the reflection; black: never picked.
    pub specular_reflectance: Spectrum,
    /// Multiplies the refraction; black: never picked.
    pub specular_transmittance: Spectrum,
    /// The boundaries.
    pub microfacet: Microfacet,
}

/// One pair of directions, and the microfacet normal between them; ω_o is above.
pub(crate) struct Pair {
    /// ω_o·m.
    pub(crate) out: Real,
    /// |(ω_o + η ω_i)·m|² for refraction; 1 for reflection.
    length2: Real,
    /// ω_i·m.
    back: Real,
    /// The microfacet's reflectance.
    pub(crate) reflectance: Real,
    /// D(m).
    density: Real,
}

impl RoughDielectric {
    /// The boundary without its roughness, where that is too little to matter.
    #[inline]
    fn smooth(&self) -> Option<Dielectric> {
        let spread = (self.eta - 1.0).abs() * self.microfacet.largest_alpha();
        (self.microfacet.is_smooth() || !(spread >= Microfacet::LEAST)).then_some(Dielectric {
            eta: self.eta,
            specular_reflectance: self.specular_reflectance,
            specular_transmittance: self.specular_transmittance,
        })
    }

    /// `wo.z` > 0. `None` where no microfacet joins the two.
    #[inline]
    pub(crate) fn pair(&self, wo: Vec3, wi: Vec3, index: RelativeIndex) -> Option<Pair> {
        let reflected = wi.z > 0.0;
        let between = if reflected { wo + wi } else { wo + wi * index.eta };
        let m = normalize(between)?;
        let m = if m.z < 0.0 { -m } else { m };
        // The cosine of half the angle between unit vectors, whose dot products with m would cancel near grazing.
        let half = 0.5 * sqrt(dot(between, between));
        let (out, back) = if reflected { (half, half) } else { (dot(wo, m), dot(wi, m)) };
        // A microfacet is seen from its own front by ω_o, and from the side it sends light to by ω_i.
        if !(out > 0.0) || (back > 0.0) != reflected || back == 0.0 {
            return None;
        }
        let density = self.microfacet.density(m);
        if !(density > 0.0) {
            return None;
        }
        let (reflectance, length2) = if reflected {
            (fresnel::dielectric(min(out, 1.0), index).reflectance, 1.0)
        } else {
            (fresnel::dielectric_between(out, -back, index), dot(between, between))
        };
        Some(Pair { out, back, length2, reflectance, density })
    }

    #[inline]
    fn reflection_chance(&self, reflectance: Real) -> Real {
        fresnel::reflection_chance(reflectance, self.specular_reflectance, self.specular_transmittance)
    }

    /// Everything but the colours, for `wo.z` > 0: f |cos θ_i| for importance / (colour · power share), and what
    /// `pdf` and `pdf_rev` are.
    #[inline]
    pub(crate) fn densities(&self, wo: Vec3, wi: Vec3, eta: Real, pair: &Pair) -> Densities {
        let (out, back) = (self.microfacet.visibility(wo), self.microfacet.visibility(wi));
        let reflect = self.reflection_chance(pair.reflectance);
        let (jacobian, jacobian_rev, chance) = if wi.z > 0.0 {
            (0.25, 0.25, reflect)
        } else {
            let common = pair.out * pair.back.abs() / pair.length2;
            (common * sqr(eta), common, 1.0 - reflect)
        };
        Densities {
            masked: back * wi.z.abs(),
            pdf_of_facet: pair.density * out * jacobian,
            chance,
            rev_of_facet: pair.density * back * jacobian_rev,
        }
    }
}

/// What one pair of directions is worth.
pub(crate) struct Densities {
    /// G1(ω_i).
    pub(crate) masked: Real,
    /// How densely ω_i is made once reflection or refraction is chosen.
    pub(crate) pdf_of_facet: Real,
    /// The chance of that choice.
    chance: Real,
    /// How densely ω_o is made from ω_i, once the same is chosen.
    pub(crate) rev_of_facet: Real,
}

#[inline(always)]
pub(crate) fn flipped(w: Vec3) -> Vec3 {
    vec3(w.x, w.y, -w.z)
}

impl Bsdf for RoughDielectric {
    #[inline]
    fn eval(&self, wo: Vec3, wi: Vec3, carried: Carried) -> Scatter {
        if wo.z == 0.0 || wi.z == 0.0 || self.smooth().is_some() {
            return Scatter::NONE;
        }
        let index = RelativeIndex::seen_from(self.eta, wo.z);
        let eta = index.eta;
        let (wo, wi) = if wo.z > 0.0 { (wo, wi) } else { (flipped(wo), flipped(wi)) };
        let Some(pair) = self.pair(wo, wi, index) else { return Scatter::NONE };
        let densities = self.densities(wo, wi, eta, &pair);
        let colour = if wi.z > 0.0 {
            self.specular_reflectance * pair.reflectance
        } else {
            self.specular_transmittance * ((1.0 - pair.reflectance) * refraction_factor(eta, carried))
        };
        let pdf = densities.pdf_of_facet * densities.chance;
        // In the far tail of the facets the density may vanish before the value does.
        if !(pdf > 0.0) {
            return Scatter::NONE;
        }
        Scatter {
            value: colour * (densities.pdf_of_facet * densities.masked),
            pdf: PerSolidAngle(pdf),
            pdf_rev: PerSolidAngle(densities.rev_of_facet * densities.chance),
        }
    }

    #[inline]
    fn sample(&self, wo: Vec3, u: [Real; 3], carried: Carried) -> Option<Scattered> {
        if let Some(smooth) = self.smooth() {
            return smooth.sample(wo, u, carried);
        }
        if wo.z == 0.0 {
            return None;
        }
        let index = RelativeIndex::seen_from(self.eta, wo.z);
        let eta = index.eta;
        let above = wo.z > 0.0;
        let wo = if above { wo } else { flipped(wo) };
        let m = self.microfacet.sample_visible(wo, [u[0], u[1]])?;
        let out = dot(wo, m);
        let boundary = fresnel::dielectric(out.clamp(0.0, 1.0), index);
        let reflected = u[2] < self.reflection_chance(boundary.reflectance);
        if !(reflected || boundary.cos_refracted > 0.0) {
            return None;
        }
        let wi = if reflected { reflect(wo, m) } else { m * (out / eta - boundary.cos_refracted) - wo / eta };
        let wi = normalize(wi)?;
        if (wi.z > 0.0) != reflected || wi.z == 0.0 {
            return None;
        }
        // Densities of the rounded direction, so that they are those that `eval` gives.
        let pair = self.pair(wo, wi, index)?;
        let densities = self.densities(wo, wi, eta, &pair);
        if !(densities.chance > 0.0) {
            return None;
        }
        let (weight, refracted, lobe) = if reflected {
            (self.specular_reflectance * pair.reflectance, 1.0, Lobe::GLOSSY_REFLECTION)
        } else {
            let power = (1.0 - pair.reflectance) * refraction_factor(eta, carried);
            (self.specular_transmittance * power, eta, Lobe::GLOSSY_TRANSMISSION)
        };
        Some(Scattered {
            wi: if above { wi } else { flipped(wi) },
            weight: weight * (densities.masked / densities.chance),
            made: Made::Smooth {
                pdf: PerSolidAngle(densities.pdf_of_facet * densities.chance),
                pdf_rev: PerSolidAngle(densities.rev_of_facet * densities.chance),
            },
            eta: refracted,
            lobe,
        })
    }

    #[inline]
    fn lobes(&self) -> Lobe {
        if self.smooth().is_some() { Lobe::DELTA } else { Lobe::GLOSSY_REFLECTION | Lobe::GLOSSY_TRANSMISSION }
    }
}
