//! The built-in `point` as a module.

bidir_sdk::parameters! {
    /// The same intensity in every direction.
    pub struct Settings {
        /// W/sr.
        intensity: rgb(min 0.0) = 1.0;
    }
}

bidir_sdk::light! { Settings => |settings: &Settings| bidir_standard::Isotropic { intensity: settings.intensity }, emits_from: [point] }
