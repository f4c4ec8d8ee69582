//! The built-in `null` as a module.

bidir_sdk::parameters! {
    /// Lets light pass as if nothing were there.
    pub struct Settings {}
}

bidir_sdk::bsdf! { Settings => |_: &Settings| bidir_standard::Null, lobes: [delta_transmission], isotropic: true }
