//! The built-in `roughconductor` as a module.

use bidir_standard::{Distribution, Microfacet, RoughConductor};

bidir_sdk::parameters! {
    /// A metal of microfacets; without eta and k it absorbs nothing.
    pub struct Settings {
        /// Real part of the index of refraction.
        eta: rgb(min 0.0) = 0.0;
        /// Imaginary part of the index of refraction.
        k: rgb(min 0.0) = 1.0;
        /// Multiplies the reflection.
        specular_reflectance: rgb(min 0.0, max 1.0, texturable) = 1.0;
        /// How slopes are distributed.
        distribution: choice Slopes { Beckmann = "beckmann", Ggx = "ggx" } = "beckmann";
        /// Roughness.
        alpha: float(min 0.0, texturable) = 0.1;
        /// Roughness along the first tangent; -1: as alpha.
        alpha_u: float(min -1.0, texturable) = -1.0;
        /// Roughness along the second tangent; -1: as alpha.
        alpha_v: float(min -1.0, texturable) = -1.0;
        /// Read for the scene's sake: visible microfacets are always sampled.
        sample_visible: bool = true;
    }
}

bidir_sdk::bsdf! {
    Settings => |settings: &Settings| {
        let Settings { eta, k, specular_reflectance, alpha, alpha_u, alpha_v, .. } = *settings;
        let distribution = match settings.distribution {
            Slopes::Beckmann => Distribution::Beckmann,
            Slopes::Ggx => Distribution::Ggx,
        };
        RoughConductor { eta, k, specular_reflectance, microfacet: Microfacet::with_alphas(distribution, alpha, alpha_u, alpha_v) }
    },
    lobes: [glossy_reflection, delta_reflection],
}
