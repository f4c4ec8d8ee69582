//! The built-in `constant` as a module.

bidir_sdk::parameters! {
    /// The same radiance from everywhere.
    pub struct Settings {
        /// W/(m² sr).
        radiance: rgb(min 0.0) = 1.0;
    }
}

bidir_sdk::light! { Settings => |settings: &Settings| bidir_standard::Constant { radiance: settings.radiance }, emits_from: [environment] }
