//! A rough dielectric coat over a diffuse base.

use bidir_sdk::{
    Bsdf, Carried, Lobe, Made, PerSolidAngle, Real, Scatter, Scattered, Spectrum, Vec3,
    math::{dot, min, normalize, safe_sqrt, sqr, sqrt, vec3},
    real::INV_PI,
    warp::{cosine_hemisphere, cosine_hemisphere_pdf},
};

use crate::{
    fresnel::{self, RelativeIndex},
    microfacet::{Distribution, Microfacet, reflect},
    plastic::Plastic,
};

/// As [`Plastic`], with a coat of microfacets: f = F D G/(4 cos θ_o cos θ_i) + ρ/(1 − ρ' R_inner) · T(ω_o) T(ω_i)/(π η²), above; nothing
/// below. T is what the coat lets through once, by its slopes. Too little roughness to be told from a mirror is a [`Plastic`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoughPlastic {
    /// The smooth one; its `inner_reflectance` is the rough coat's.
    pub plastic: Plastic,
    /// The coat's slopes, alike in all directions.
    pub microfacet: Microfacet,
    /// What the coat lets through.
    pub coat: Coat,
}

/// What a rough boundary lets through of light from a direction, tabulated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coat {
    /// At cosines (i/(NODES − 1))², which lie close where it is steep.
    transmittance: [Real; NODES],
}

const NODES: usize = 24;

/// Of the mean from inside.
const COSINES: usize = 64;

/// Steps of the integrals, per dimension.
const STEPS: usize = 32;

/// The shares of light from a direction with this cosine that a boundary of microfacets reflects to its own side, and lets through, both
/// once and not masked: ∫ F G1(ω_i) and ∫ (1 − F) G1(ω_t) over the microfacets that the direction sees.
fn once(microfacet: &Microfacet, cos: Real, eta: Real) -> (Real, Real) {
    let wo = vec3(safe_sqrt(1.0 - sqr(cos)), 0.0, cos);
    let index = RelativeIndex::seen_from(eta, 1.0);
    let (mut reflected, mut passed) = (0.0, 0.0);
    let unmasked = |w: Vec3| microfacet.visibility(w) * w.z.abs();
    for i in 0..STEPS * STEPS {
        let (row, column) = (i / STEPS, i % STEPS);
        // Rows shifted against each other by the golden ratio.
        let shift = (0.618_034 * row as Real) % 1.0;
        let u = [((column as Real + shift) / STEPS as Real) % 1.0, (row as Real + 0.5) / STEPS as Real];
        let Some(m) = microfacet.sample_visible(wo, u) else { continue };
        let out = dot(wo, m).clamp(0.0, 1.0);
        let boundary = fresnel::dielectric(out, index);
        let (mirrored, refracted) = (reflect(wo, m), m * (out / eta - boundary.cos_refracted) - wo / eta);
        if mirrored.z > 0.0 {
            reflected += boundary.reflectance * unmasked(mirrored);
        }
        if refracted.z < 0.0 && boundary.cos_refracted > 0.0 {
            passed += (1.0 - boundary.reflectance) * unmasked(refracted);
        }
    }
    let count = (STEPS * STEPS) as Real;
    (reflected / count, passed / count)
}

impl Coat {
    /// Of a boundary with that index inside / outside.
    pub fn new(microfacet: &Microfacet, eta: Real) -> Self {
        let node = |i: usize| {
            let cos = sqr(i as Real / (NODES - 1) as Real);
            once(microfacet, cos.max(1e-6), eta).1
        };
        Self { transmittance: core::array::from_fn(node) }
    }

    /// From a direction with this cosine.
    #[inline]
    pub fn transmittance(&self, cos: Real) -> Real {
        let at = sqrt(cos.clamp(0.0, 1.0)) * (NODES - 1) as Real;
        let left = (at as usize).min(NODES - 2);
        let [a, b] = [self.transmittance[left], self.transmittance[left + 1]];
        a + (b - a) * (at - left as Real)
    }

    /// What such a boundary reflects of diffuse light from inside: 2 ∫ R(c) c dc, as Mitsuba defines it, the mean over 64 cosines from 0 to 1
    /// with both ends. That is some 1.5 % less than the integral.
    pub fn inner_reflectance(microfacet: &Microfacet, eta: Real) -> Real {
        let term = |i: usize| {
            let cos = (i as Real / (COSINES - 1) as Real).max(1e-6);
            2.0 * cos * once(microfacet, cos, 1.0 / eta).0
        };
        (0..COSINES).map(term).sum::<Real>() / COSINES as Real
    }
}

/// How the lobes share the samples of one direction.
struct Shares {
    /// What the coat lets through.
    through: Real,
    /// The chance of the coat.
    specular: Real,
}

impl RoughPlastic {
    /// The roughness of both tangents is the larger one's.
    pub fn new(
        eta: Real,
        diffuse_reflectance: Spectrum,
        specular_reflectance: Spectrum,
        nonlinear: bool,
        distribution: Distribution,
        alpha: Real,
    ) -> Self {
        let microfacet = Microfacet { distribution, alpha_u: alpha, alpha_v: alpha };
        let plastic = Plastic::new(eta, diffuse_reflectance, specular_reflectance, nonlinear);
        if microfacet.is_smooth() {
            return Self { plastic, microfacet, coat: Coat { transmittance: [0.0; NODES] } };
        }
        let inner_reflectance = Coat::inner_reflectance(&microfacet, eta);
        Self { plastic: Plastic { inner_reflectance, ..plastic }, microfacet, coat: Coat::new(&microfacet, eta) }
    }

    #[inline]
    fn shares(&self, cos: Real) -> Shares {
        let through = self.coat.transmittance(cos);
        let coat = self.plastic.coat_part();
        let (specular, diffuse) = ((1.0 - through) * coat, through * (1.0 - coat));
        let total = specular + diffuse;
        Shares { through, specular: if total > 0.0 { specular / total } else { 1.0 } }
    }
}

impl Bsdf for RoughPlastic {
    #[inline]
    fn eval(&self, wo: Vec3, wi: Vec3, carried: Carried) -> Scatter {
        if self.microfacet.is_smooth() {
            return self.plastic.eval(wo, wi, carried);
        }
        if !(wo.z > 0.0 && wi.z > 0.0) {
            return Scatter::NONE;
        }
        let Some(m) = normalize(wo + wi) else { return Scatter::NONE };
        let (there, back) = (self.shares(wo.z), self.shares(wi.z));
        let density = 0.25 * self.microfacet.density(m);
        let (seen, lit) = (self.microfacet.visibility(wo), self.microfacet.visibility(wi));
        let index = RelativeIndex::seen_from(self.plastic.eta, 1.0);
        let fresnel = fresnel::dielectric(dot(wo, m).clamp(0.0, 1.0), index).reflectance;
        let base = self.plastic.base() * (there.through * back.through * wi.z * INV_PI);
        Scatter {
            value: self.plastic.specular_reflectance * (fresnel * density * seen * lit * wi.z) + base,
            pdf: PerSolidAngle(there.specular * density * seen + (1.0 - there.specular) * cosine_hemisphere_pdf(wi.z)),
            pdf_rev: PerSolidAngle(back.specular * density * lit + (1.0 - back.specular) * cosine_hemisphere_pdf(wo.z)),
        }
    }

    #[inline]
    fn sample(&self, wo: Vec3, u: [Real; 3], carried: Carried) -> Option<Scattered> {
        if self.microfacet.is_smooth() {
            return self.plastic.sample(wo, u, carried);
        }
        if !(wo.z > 0.0) {
            return None;
        }
        let specular = u[2] < self.shares(wo.z).specular;
        let (wi, lobe) = if specular {
            (normalize(reflect(wo, self.microfacet.sample_visible(wo, [u[0], u[1]])?))?, Lobe::GLOSSY_REFLECTION)
        } else {
            (cosine_hemisphere([u[0], u[1]]), Lobe::DIFFUSE_REFLECTION)
        };
        sampled_from(self, wo, wi, carried, lobe, 1.0)
    }

    #[inline]
    fn lobes(&self) -> Lobe {
        if self.microfacet.is_smooth() { self.plastic.lobes() } else { Lobe::DIFFUSE_REFLECTION | Lobe::GLOSSY_REFLECTION }
    }
}

/// A direction that one of several overlapping lobes made: its weight and densities are those of all of them.
#[inline]
pub(crate) fn sampled_from(bsdf: &impl Bsdf, wo: Vec3, wi: Vec3, carried: Carried, lobe: Lobe, eta: Real) -> Option<Scattered> {
    if lobe.intersects(Lobe::REFLECTION) != (wo.z * wi.z > 0.0) {
        return None;
    }
    let Scatter { value, pdf, pdf_rev } = bsdf.eval(wo, wi, carried);
    let weight = value * (1.0 / pdf.0);
    let whole = pdf.0 > 0.0 && weight.0.iter().all(|band| min(*band, Real::MAX) == *band);
    whole.then_some(Scattered { wi, weight, made: Made::Smooth { pdf, pdf_rev }, eta, lobe })
}
