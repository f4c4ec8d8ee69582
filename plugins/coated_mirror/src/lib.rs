//! Rough metal under a smooth coat of lacquer: a mirror and a glossy lobe in one surface, shared out by Fresnel's
//! equations, so that the chance of each depends on the direction.
//!
//! The coat reflects R(ω) into the mirror direction. The rest is refracted, and meets the metal along ω' inside the coat:
//!
//! ```text
//! f = T(ω_o) T(ω_i)/η² · F D G(ω_o', ω_i')/(4 cos θ_o' cos θ_i') · 1/(1 − F min(R(ω_o), R(ω_i))) · tint^d
//! ```
//!
//! (after Weidlich & Wilkie 2007, "Arbitrarily Layered Micro-Facet Surfaces"). 1/(1 − F R) are the bounces between metal
//! and coat, exact where the metal is smooth; min keeps it reciprocal and never gains. tint^d is absorption
//! along the two legs, d = (1/cos θ_o' + 1/cos θ_i')/2: the colour at normal incidence, deeper towards grazing.
#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "`!(x > 0.0)` refuses NaN too")]

use bidir_sdk::{
    Bsdf, Carried, Chance, Lobe, Made, PerSolidAngle, Real, Scatter, Scattered, Spectrum, Vec3,
    math::{dot, normalize, pow, sqr, sqrt, vec3},
};
use bidir_standard::{
    Distribution, Microfacet,
    fresnel::{self, RelativeIndex},
};

bidir_sdk::parameters! {
    /// Rough metal under a smooth coat of clear or coloured lacquer.
    pub struct CoatedMirror {
        /// Index of refraction of the coat, in air.
        int_ior: float(min 1.0, max 3.0, label "Index of the coat") = 1.5;
        /// What the coat leaves of light that passes it twice at normal incidence.
        tint: rgb(min 0.0, max 1.0, texturable, label "Tint") = 1.0;
        /// Real part of the metal's index of refraction; aluminium unless said.
        eta: rgb(min 0.0, max 20.0, label "Eta") = [1.6575, 0.8804, 0.5212];
        /// Its imaginary part.
        k: rgb(min 0.0, max 20.0, label "k") = [9.2238, 6.2695, 4.837];
        /// Roughness of the metal (GGX).
        alpha: float(min 0.001, max 1.0, texturable, label "Roughness") = 0.2;
    }
}

/// What one direction says, whatever the other is.
struct End {
    /// |cos| outside the coat.
    cos: Real,
    /// The direction inside the coat, away from the metal.
    inside: Vec3,
    /// What the coat reflects.
    reflectance: Real,
    /// The chance that a sample is one of the mirror.
    mirror: Real,
    /// And of the metal; not 1 − `mirror`, which rounds to 0 too soon.
    metal: Real,
}

impl End {
    /// dω inside the coat / dω outside: cos θ dω grows with η².
    fn spread(&self, int_ior: Real) -> Real {
        self.cos / (sqr(int_ior) * self.inside.z)
    }
}

/// The metal through the coat, for a pair of directions.
struct Glossy {
    /// value / pdf, the chance of picking this lobe left out.
    weight: Spectrum,
    /// How densely the metal's samples make ω_i from ω_o, per steradian outside the coat.
    density: Real,
    /// And ω_o from ω_i.
    density_rev: Real,
}

/// The metal is sampled even where a dark tint lets nothing of this direction through: another one's way is shorter.
const FAINT: Real = 1e-6;

impl CoatedMirror {
    fn microfacet(&self) -> Microfacet {
        Microfacet { distribution: Distribution::Ggx, alpha_u: self.alpha, alpha_v: self.alpha }
    }

    /// η² − 1.
    fn excess(&self) -> Real {
        (self.int_ior - 1.0) * (self.int_ior + 1.0)
    }

    fn end(&self, w: Vec3) -> End {
        // Snell's law in cosines loses no digits at grazing.
        let inside = vec3(w.x, w.y, sqrt(self.excess() + sqr(w.z))) / self.int_ior;
        let reflectance = fresnel::dielectric(w.z, RelativeIndex::seen_from(self.int_ior, w.z)).reflectance;
        // As if the metal were smooth.
        let metal = self.fresnel(inside.z) * self.absorption(inside.z, inside.z);
        let below = (1.0 - reflectance) * metal.mean().max(FAINT);
        let total = (reflectance + below).max(Real::MIN_POSITIVE);
        End { cos: w.z, inside, reflectance, mirror: reflectance / total, metal: below / total }
    }

    /// The metal's: it meets the coat, not air.
    fn fresnel(&self, cos: Real) -> Spectrum {
        fresnel::conductor(cos.clamp(0.0, 1.0), self.eta / self.int_ior, self.k / self.int_ior)
    }

    /// What the coat leaves of light that comes along one cosine and goes along the other, both inside.
    fn absorption(&self, out: Real, into: Real) -> Spectrum {
        if self.tint == Spectrum::ONE {
            return Spectrum::ONE;
        }
        let depth = 0.5 * (1.0 / out + 1.0 / into);
        self.tint.map(|band| pow(band, depth))
    }

    fn glossy(&self, out: &End, into: &End) -> Option<Glossy> {
        let m = normalize(out.inside + into.inside)?;
        let least = out.reflectance.min(into.reflectance);
        let bounced = self.fresnel(dot(out.inside, m)).map(|f| f / (1.0 - f * least).max(1e-6));
        let through = (1.0 - out.reflectance) * (1.0 - into.reflectance);
        let metal = self.microfacet();
        let (quarter, seen, seen_rev) = (0.25 * metal.density(m), metal.visibility(out.inside), metal.visibility(into.inside));
        Some(Glossy {
            weight: bounced * self.absorption(out.inside.z, into.inside.z) * (through * seen_rev * into.inside.z),
            density: quarter * seen * into.spread(self.int_ior),
            density_rev: quarter * seen_rev * out.spread(self.int_ior),
        })
    }

    /// A direction that a microfacet below the coat reflects `out` into, outside; `None` where it does not get out.
    fn sample_glossy(&self, out: &End, u: [Real; 2]) -> Option<Vec3> {
        let m = self.microfacet().sample_visible(out.inside, u)?;
        let inside = m * (2.0 * dot(out.inside, m)) - out.inside;
        let squared = sqr(self.int_ior * inside.z) - self.excess();
        if !(inside.z > 0.0 && squared > 0.0) {
            return None;
        }
        normalize(vec3(inside.x * self.int_ior, inside.y * self.int_ior, sqrt(squared)))
    }
}

impl Bsdf for CoatedMirror {
    fn eval(&self, wo: Vec3, wi: Vec3, _: Carried) -> Scatter {
        if !(wo.z > 0.0 && wi.z > 0.0) {
            return Scatter::NONE;
        }
        let (out, into) = (self.end(wo), self.end(wi));
        let Some(glossy) = self.glossy(&out, &into) else { return Scatter::NONE };
        Scatter {
            value: glossy.weight * glossy.density,
            pdf: PerSolidAngle(out.metal * glossy.density),
            pdf_rev: PerSolidAngle(into.metal * glossy.density_rev),
        }
    }

    fn sample(&self, wo: Vec3, u: [Real; 3], _: Carried) -> Option<Scattered> {
        if !(wo.z > 0.0) {
            return None;
        }
        let out = self.end(wo);
        if u[2] < out.mirror {
            // The mirror direction has the same cosine, so the same chance.
            let chance = Chance(out.mirror);
            return Some(Scattered {
                wi: vec3(-wo.x, -wo.y, wo.z),
                weight: Spectrum::splat(out.reflectance / out.mirror),
                made: Made::Delta { chance, chance_rev: chance },
                eta: 1.0,
                lobe: Lobe::DELTA_REFLECTION,
            });
        }
        let wi = self.sample_glossy(&out, [u[0], u[1]])?;
        // Densities of the rounded direction, so that they are those that `eval` gives.
        let into = self.end(wi);
        let glossy = self.glossy(&out, &into)?;
        let pdf = out.metal * glossy.density;
        if !(pdf > 0.0) {
            return None;
        }
        Some(Scattered {
            wi,
            weight: glossy.weight / out.metal,
            made: Made::Smooth { pdf: PerSolidAngle(pdf), pdf_rev: PerSolidAngle(into.metal * glossy.density_rev) },
            eta: 1.0,
            lobe: Lobe::GLOSSY_REFLECTION,
        })
    }

    fn lobes(&self) -> Lobe {
        Lobe::GLOSSY_REFLECTION | Lobe::DELTA_REFLECTION
    }
}

bidir_sdk::bsdf! { CoatedMirror, lobes: [glossy_reflection, delta_reflection], isotropic: true }

#[cfg(test)]
mod tests {
    use super::*;

    const GOLD: (Spectrum, Spectrum) = (Spectrum([0.14, 0.37, 1.44]), Spectrum([3.98, 2.38, 1.6]));
    const MIRROR: (Spectrum, Spectrum) = (Spectrum::BLACK, Spectrum::ONE);

    fn coated((eta, k): (Spectrum, Spectrum), int_ior: Real, tint: Spectrum, alpha: Real) -> CoatedMirror {
        CoatedMirror { int_ior, tint, eta, k, alpha }
    }

    fn cases() -> Vec<(String, Box<dyn Bsdf>)> {
        let red = Spectrum([0.9, 0.1, 0.05]);
        let case = |name: &str, coated: CoatedMirror| (name.to_owned(), Box::new(coated) as Box<dyn Bsdf>);
        vec![
            case("clear", coated(GOLD, 1.5, Spectrum::ONE, 0.2)),
            case("candy", coated(GOLD, 1.5, red, 0.3)),
            case("rough", coated(GOLD, 1.5, red, 1.0)),
            case("high index", coated(GOLD, 2.4, Spectrum::ONE, 0.3)),
            case("no coat", coated(GOLD, 1.0, Spectrum::ONE, 0.3)),
            case("black", coated(GOLD, 1.5, Spectrum::BLACK, 0.3)),
            case("perfect", coated(MIRROR, 1.5, Spectrum::ONE, 0.2)),
        ]
    }

    bidir_proof::surface_tests!(cases());

    #[test]
    fn a_smooth_perfect_mirror_below_a_clear_coat_loses_nothing() {
        for cos in [1.0, 0.7, 0.3] {
            let mirror = coated(MIRROR, 1.5, Spectrum::ONE, 1e-3);
            let (albedo, error) = bidir_proof::surface::albedo(&mirror, bidir_proof::direction(cos, 0.4), 20_000);
            assert!((albedo - 1.0).abs() < 5e-3 + 4.5 * error, "at {cos}: {albedo} ± {error}");
        }
    }

    #[test]
    fn the_mirror_is_picked_more_often_the_lower_the_view() {
        let surface = coated(GOLD, 1.5, Spectrum::ONE, 0.2);
        let chances = [1.0, 0.5, 0.2, 0.05].map(|cos| surface.end(bidir_proof::direction(cos, 0.0)).mirror);
        assert!(chances.is_sorted() && chances[0] < 0.1 && chances[3] > 0.5, "{chances:?}");
    }

    #[test]
    fn a_coat_of_index_1_is_none() {
        let metal = coated(GOLD, 1.0, Spectrum::ONE, 0.3);
        let bare =
            bidir_standard::RoughConductor { eta: GOLD.0, k: GOLD.1, specular_reflectance: Spectrum::ONE, microfacet: metal.microfacet() };
        let (wo, wi) = (bidir_proof::direction(0.6, 0.1), bidir_proof::direction(0.7, 2.8));
        let (ours, theirs) = (metal.eval(wo, wi, Carried::Radiance), bare.eval(wo, wi, Carried::Radiance));
        assert!((0..3).all(|band| (ours.value[band] / theirs.value[band] - 1.0).abs() < 1e-4), "{ours:?} against {theirs:?}");
    }
}
