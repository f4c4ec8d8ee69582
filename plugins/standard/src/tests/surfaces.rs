//! Every surface, over many parameters.

use std::{boxed::Box, format, string::String, vec::Vec};

use bidir_sdk::{Bsdf, Real, Spectrum};

use crate::*;

/// A surface under test.
pub struct Surface {
    /// What the message says.
    pub name: String,
    /// The surface.
    pub bsdf: Box<dyn Bsdf>,
    /// Index of refraction below / above, 1 for what does not refract.
    pub eta: Real,
}

const TINT: Spectrum = Spectrum([0.9, 0.5, 0.2]);
const WHITE: Spectrum = Spectrum::ONE;

fn surface(name: impl Into<String>, bsdf: impl Bsdf + 'static, eta: Real) -> Surface {
    Surface { name: name.into(), bsdf: Box::new(bsdf), eta }
}

/// GGX and Beckmann, isotropic and not.
pub fn microfacets(alphas: &[(Real, Real)]) -> Vec<Microfacet> {
    let both = [Distribution::Ggx, Distribution::Beckmann];
    both.iter()
        .flat_map(|&distribution| alphas.iter().map(move |&(alpha_u, alpha_v)| Microfacet { distribution, alpha_u, alpha_v }))
        .collect()
}

/// A metal like gold.
pub fn gold(microfacet: Microfacet) -> RoughConductor {
    let (eta, k) = (Spectrum([0.14, 0.37, 1.44]), Spectrum([3.98, 2.38, 1.6]));
    RoughConductor { eta, k, specular_reflectance: TINT, microfacet }
}

/// A rough metal that loses nothing but what its own microfacets hide.
pub fn rough_mirror(microfacet: Microfacet) -> RoughConductor {
    RoughConductor { eta: Spectrum::BLACK, k: WHITE, specular_reflectance: WHITE, microfacet }
}

/// Colourless rough glass.
pub fn rough_glass(eta: Real, microfacet: Microfacet) -> RoughDielectric {
    RoughDielectric { eta, specular_reflectance: WHITE, specular_transmittance: WHITE, microfacet }
}

fn dielectrics(out: &mut Vec<Surface>) {
    for eta in [1.5, 1.0, 1.000_001, 0.999_999, 0.6, 2.4] {
        let glass = Dielectric { eta, specular_reflectance: TINT, specular_transmittance: WHITE };
        out.push(surface(format!("dielectric {eta}"), glass, eta));
        out.push(surface(format!("dielectric {eta}, no reflection"), Dielectric { specular_reflectance: Spectrum::BLACK, ..glass }, eta));
        out.push(surface(format!("dielectric {eta}, no refraction"), Dielectric { specular_transmittance: Spectrum::BLACK, ..glass }, eta));
        let thin = ThinDielectric { eta, specular_reflectance: WHITE, specular_transmittance: TINT };
        out.push(surface(format!("thin dielectric {eta}"), thin, 1.0));
    }
}

/// All of them.
pub fn all() -> Vec<Surface> {
    let mut out = Vec::new();
    out.push(surface("null", Null, 1.0));
    out.push(surface("diffuse", Diffuse { reflectance: TINT }, 1.0));
    let metal = gold(microfacets(&[(0.0, 0.0)])[0]);
    out.push(surface("conductor", Conductor { eta: metal.eta, k: metal.k, specular_reflectance: TINT }, 1.0));
    out.push(surface("smooth rough conductor", metal, 1.0));
    for eta in [1.0, 1.3, 1.9] {
        for nonlinear in [false, true] {
            out.push(surface(format!("plastic {eta} {nonlinear}"), Plastic::new(eta, TINT, WHITE, nonlinear), 1.0));
        }
    }
    out.push(surface("plastic without a coat", Plastic::new(1.5, TINT, Spectrum::BLACK, false), 1.0));
    out.push(surface("plastic on black", Plastic::new(1.5, Spectrum::BLACK, WHITE, false), 1.0));
    dielectrics(&mut out);
    for m in microfacets(&[(0.05, 0.05), (0.2, 0.2), (0.1, 0.5), (1.0, 1.0)]) {
        out.push(surface(format!("rough conductor {m:?}"), gold(m), 1.0));
        // Refraction spreads by (η − 1) α: indices nearer to 1 are too narrow for the bins of the χ² test.
        for eta in [1.5, 0.7, 2.0] {
            out.push(surface(format!("rough dielectric {eta} {m:?}"), rough_glass(eta, m), eta));
        }
    }
    for m in microfacets(&[(0.3, 0.2)]) {
        let glass = rough_glass(1.5, m);
        out.push(surface(
            format!("rough dielectric, no reflection {m:?}"),
            RoughDielectric { specular_reflectance: Spectrum::BLACK, ..glass },
            1.5,
        ));
        out.push(surface(
            format!("rough dielectric, no refraction {m:?}"),
            RoughDielectric { specular_transmittance: Spectrum::BLACK, ..glass },
            1.5,
        ));
    }
    blends(&mut out);
    principled(&mut out);
    for (distribution, alpha) in [(Distribution::Beckmann, 0.0), (Distribution::Beckmann, 0.1), (Distribution::Ggx, 0.5)] {
        for nonlinear in [false, true] {
            let plastic = RoughPlastic::new(1.5, TINT, WHITE, nonlinear, distribution, alpha);
            out.push(surface(format!("rough plastic {distribution:?} {alpha} {nonlinear}"), plastic, 1.0));
        }
    }
    out
}

/// Nothing but a diffuse base under a dielectric's reflection.
const PLAIN: Principled = Principled {
    base_color: TINT,
    roughness: 0.5,
    anisotropic: 0.0,
    metallic: 0.0,
    spec_trans: 0.0,
    eta: 1.5,
    spec_tint: 0.0,
    sheen: 0.0,
    sheen_tint: 0.0,
    flatness: 0.0,
    clearcoat: 0.0,
    clearcoat_gloss: 0.0,
};

fn principled(out: &mut Vec<Surface>) {
    let metal = Principled { metallic: 0.8, anisotropic: 0.7, spec_tint: 0.5, ..PLAIN };
    let cloth = Principled { roughness: 0.9, sheen: 0.3, sheen_tint: 0.5, flatness: 0.6, ..PLAIN };
    let coated = Principled { roughness: 0.8, clearcoat: 1.0, clearcoat_gloss: 0.0, ..PLAIN };
    for (name, bsdf) in [("plain", PLAIN), ("metal", metal), ("cloth", cloth), ("coated", coated)] {
        out.push(surface(format!("principled {name}"), bsdf, 1.0));
    }
    for eta in [1.5, 0.7] {
        let glass = Principled { spec_trans: 0.8, eta, ..PLAIN };
        out.push(surface(format!("principled glass {eta}"), glass, eta));
        out.push(surface(format!("principled clear glass {eta}"), Principled { spec_trans: 1.0, clearcoat: 0.5, ..glass }, eta));
    }
    for (spec_trans, diff_trans, sheen) in [(0.0, 0.0, 0.2), (0.5, 0.8, 0.2), (1.0, 0.0, 0.0), (0.0, 2.0, 0.0)] {
        let Principled { base_color, roughness, anisotropic, spec_tint, .. } = metal;
        let (sheen_tint, flatness, eta) = (0.5, 0.4, 1.4);
        let thin =
            PrincipledThin { base_color, roughness, anisotropic, spec_trans, eta, spec_tint, sheen, sheen_tint, flatness, diff_trans };
        out.push(surface(format!("principled thin {spec_trans} {diff_trans}"), thin, 1.0));
    }
}

fn blends(out: &mut Vec<Surface>) {
    let gold = gold(microfacets(&[(0.2, 0.2)])[0]);
    let glass = rough_glass(1.5, microfacets(&[(0.3, 0.2)])[1]);
    for weight in [0.0, 0.3, 1.0] {
        let matt = Diffuse { reflectance: TINT };
        out.push(surface(format!("{weight} of gold on matt"), Blend { weight, first: matt, second: gold }, 1.0));
        out.push(surface(format!("a mask {weight}"), Blend { weight, first: Null, second: Plastic::new(1.5, TINT, WHITE, false) }, 1.0));
    }
    out.push(surface("gold and glass", Blend { weight: 0.6, first: gold, second: Blend { weight: 0.5, first: gold, second: gold } }, 1.0));
    out.push(surface("glass behind a mask", Blend { weight: 0.7, first: glass, second: glass }, 1.5));
}
