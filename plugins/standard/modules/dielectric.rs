//! The built-in `dielectric` as a module.

bidir_sdk::parameters! {
    /// A smooth boundary between two media.
    pub struct Settings {
        /// Index of refraction inside.
        int_ior: float(min 0.001, max 1000.0) = 1.5046;
        /// Index of refraction outside.
        ext_ior: float(min 0.001, max 1000.0) = 1.000277;
        /// Multiplies the reflection.
        specular_reflectance: rgb(min 0.0, max 1.0, texturable) = 1.0;
        /// Multiplies the refraction.
        specular_transmittance: rgb(min 0.0, max 1.0, texturable) = 1.0;
    }
}

bidir_sdk::bsdf! {
    Settings => |settings: &Settings| {
        let Settings { int_ior, ext_ior, specular_reflectance, specular_transmittance } = *settings;
        bidir_standard::Dielectric { eta: int_ior / ext_ior, specular_reflectance, specular_transmittance }
    },
    lobes: [delta_reflection, delta_transmission],
    isotropic: true,
}
