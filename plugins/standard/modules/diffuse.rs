//! The built-in `diffuse` as a module.

bidir_sdk::parameters! {
    /// Scatters alike in every direction, above.
    pub struct Settings {
        /// Albedo.
        reflectance: rgb(min 0.0, max 1.0, texturable) = 0.5;
    }
}

bidir_sdk::bsdf! {
    Settings => |settings: &Settings| bidir_standard::Diffuse { reflectance: settings.reflectance },
    lobes: [diffuse_reflection],
    isotropic: true,
}
