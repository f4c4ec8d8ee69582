//! Metal under a film that is a few wavelengths of light thick: anodised titanium, tempered steel, oil on a blade.
//!
//! f = F D G/(4 cos θ_o cos θ_i) with GGX microfacets (Walter et al. 2007, eq. 20) and the reflectance F of metal and film
//! together ([`film`]).
#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "`!(x > 0.0)` refuses NaN too")]

pub mod film;

use bidir_sdk::{
    Bsdf, Carried, Lobe, Made, PerSolidAngle, Real, Scatter, Scattered, Spectrum, Vec3,
    math::{dot, normalize},
};
use bidir_standard::{Distribution, Microfacet};
use film::Film;

bidir_sdk::parameters! {
    /// Rough metal in the colours of a thin film: anodised titanium, tempered steel, oil on a blade.
    pub struct ThinFilm {
        /// Of the film, in nanometres.
        thickness: float(min 0.0, max 20000.0, texturable, label "Thickness") = 400.0;
        /// Index of refraction of the film.
        film_ior: float(min 1.0, max 4.0, label "Index of the film") = 2.0;
        /// Real part of the metal's index of refraction; chromium unless said.
        eta: rgb(min 0.0, max 20.0, label "Eta") = [4.3697, 2.9165, 1.6549];
        /// Its imaginary part.
        k: rgb(min 0.0, max 20.0, label "k") = [5.2066, 4.2313, 3.7547];
        /// Roughness (GGX).
        alpha: float(min 0.001, max 1.0, texturable, label "Roughness") = 0.15;
    }
}

impl ThinFilm {
    fn microfacet(&self) -> Microfacet {
        Microfacet { distribution: Distribution::Ggx, alpha_u: self.alpha, alpha_v: self.alpha }
    }

    fn reflectance(&self, cos: Real) -> Spectrum {
        Film { thickness: self.thickness, index: self.film_ior, eta: self.eta, k: self.k }.reflectance(cos.clamp(0.0, 1.0))
    }
}

impl Bsdf for ThinFilm {
    fn eval(&self, wo: Vec3, wi: Vec3, _: Carried) -> Scatter {
        if !(wo.z > 0.0 && wi.z > 0.0) {
            return Scatter::NONE;
        }
        let Some(m) = normalize(wo + wi) else { return Scatter::NONE };
        let facets = self.microfacet();
        let (quarter, out, into) = (0.25 * facets.density(m), facets.visibility(wo), facets.visibility(wi));
        Scatter {
            value: self.reflectance(dot(wo, m)) * (quarter * out * into * wi.z),
            pdf: PerSolidAngle(quarter * out),
            pdf_rev: PerSolidAngle(quarter * into),
        }
    }

    fn sample(&self, wo: Vec3, u: [Real; 3], _: Carried) -> Option<Scattered> {
        if !(wo.z > 0.0) {
            return None;
        }
        let facets = self.microfacet();
        let seen = facets.sample_visible(wo, [u[0], u[1]])?;
        let wi = normalize(seen * (2.0 * dot(wo, seen)) - wo)?;
        if !(wi.z > 0.0) {
            return None;
        }
        // Densities of the rounded direction, so that they are those that `eval` gives.
        let m = normalize(wo + wi)?;
        let (quarter, out, into) = (0.25 * facets.density(m), facets.visibility(wo), facets.visibility(wi));
        (quarter > 0.0).then_some(Scattered {
            wi,
            weight: self.reflectance(dot(wo, m)) * (into * wi.z),
            made: Made::Smooth { pdf: PerSolidAngle(quarter * out), pdf_rev: PerSolidAngle(quarter * into) },
            eta: 1.0,
            lobe: Lobe::GLOSSY_REFLECTION,
        })
    }

    fn lobes(&self) -> Lobe {
        Lobe::GLOSSY_REFLECTION
    }
}

bidir_sdk::bsdf! { ThinFilm, lobes: [glossy_reflection], isotropic: true }

#[cfg(test)]
mod tests {
    use super::*;

    fn cases() -> Vec<(String, Box<dyn Bsdf>)> {
        let case = |thickness, film_ior, alpha| {
            let bsdf = ThinFilm { thickness, film_ior, alpha, ..ThinFilm::default() };
            (format!("{thickness} nm, index {film_ior}, alpha {alpha}"), Box::new(bsdf) as Box<dyn Bsdf>)
        };
        vec![case(400.0, 2.0, 0.15), case(0.0, 1.5, 0.1), case(150.0, 1.33, 0.5), case(1000.0, 4.0, 1.0), case(250.0, 1.0, 0.3)]
    }

    bidir_proof::surface_tests!(cases());
}
