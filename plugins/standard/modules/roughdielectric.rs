//! The built-in `roughdielectric` as a module.

use bidir_standard::{Distribution, Microfacet, RoughDielectric};

bidir_sdk::parameters! {
    /// A boundary of microfacets between two media.
    pub struct Settings {
        /// Index of refraction inside.
        int_ior: float(min 0.001, max 1000.0) = 1.5046;
        /// Index of refraction outside.
        ext_ior: float(min 0.001, max 1000.0) = 1.000277;
        /// Multiplies the reflection.
        specular_reflectance: rgb(min 0.0, max 1.0, texturable) = 1.0;
        /// Multiplies the refraction.
        specular_transmittance: rgb(min 0.0, max 1.0, texturable) = 1.0;
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
        let Settings { specular_reflectance, specular_transmittance, alpha, alpha_u, alpha_v, .. } = *settings;
        let distribution = match settings.distribution {
            Slopes::Beckmann => Distribution::Beckmann,
            Slopes::Ggx => Distribution::Ggx,
        };
        let (eta, microfacet) = (settings.int_ior / settings.ext_ior, Microfacet::with_alphas(distribution, alpha, alpha_u, alpha_v));
        RoughDielectric { eta, specular_reflectance, specular_transmittance, microfacet }
    },
    lobes: [glossy_reflection, delta_reflection, glossy_transmission, delta_transmission],
}
