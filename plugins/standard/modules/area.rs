//! The built-in `area` as a module.

bidir_sdk::parameters! {
    /// The same radiance in every direction of the hemisphere.
    pub struct Settings {
        /// W/(m² sr).
        radiance: rgb(min 0.0) = 1.0;
    }
}

bidir_sdk::light! { Settings => |settings: &Settings| bidir_standard::Area { radiance: settings.radiance }, emits_from: [area] }
