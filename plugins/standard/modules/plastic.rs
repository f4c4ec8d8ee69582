//! The built-in `plastic` as a module.

use bidir_standard::Plastic;

bidir_sdk::parameters! {
    /// A smooth dielectric coat over a diffuse base.
    pub struct Settings {
        /// Index of refraction inside.
        int_ior: float(min 0.001, max 1000.0) = 1.49;
        /// Index of refraction outside.
        ext_ior: float(min 0.001, max 1000.0) = 1.000277;
        /// Albedo of the base.
        diffuse_reflectance: rgb(min 0.0, max 1.0, texturable) = 0.5;
        /// Multiplies the coat's reflection.
        specular_reflectance: rgb(min 0.0, max 1.0, texturable) = 1.0;
        /// Whether inner reflections saturate the base's colour.
        nonlinear: bool = false;
    }
}

bidir_sdk::bsdf! {
    Settings => |settings: &Settings| {
        let Settings { int_ior, ext_ior, diffuse_reflectance, specular_reflectance, nonlinear } = *settings;
        Plastic::new(int_ior / ext_ior, diffuse_reflectance, specular_reflectance, nonlinear)
    },
    lobes: [diffuse_reflection, delta_reflection],
    isotropic: true,
}
