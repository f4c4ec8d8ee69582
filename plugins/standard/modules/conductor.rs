//! The built-in `conductor` as a module.

bidir_sdk::parameters! {
    /// A smooth metal; without eta and k a perfect mirror.
    pub struct Settings {
        /// Real part of the index of refraction.
        eta: rgb(min 0.0) = 0.0;
        /// Imaginary part of the index of refraction.
        k: rgb(min 0.0) = 1.0;
        /// Multiplies the reflection.
        specular_reflectance: rgb(min 0.0, max 1.0, texturable) = 1.0;
    }
}

bidir_sdk::bsdf! {
    Settings => |settings: &Settings| {
        let Settings { eta, k, specular_reflectance } = *settings;
        bidir_standard::Conductor { eta, k, specular_reflectance }
    },
    lobes: [delta_reflection],
    isotropic: true,
}
