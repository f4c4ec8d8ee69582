//! The built-in `plastic` as a module.

use core::sync::atomic::{AtomicU64, Ordering::Relaxed};

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
        let eta = int_ior / ext_ior;
        Plastic { eta, diffuse_reflectance, specular_reflectance, nonlinear, inner_reflectance: inner_reflectance(eta) }
    },
    lobes: [diffuse_reflection, delta_reflection],
    isotropic: true,
}

/// [`Plastic::inner_reflectance`], kept for the index that was asked last: its logarithms cost as much as the rest of a call,
/// and a scene's plastics mostly share one index. The answer depends on `eta` alone, remembered or not.
fn inner_reflectance(eta: f32) -> f32 {
    /// The bits of an index above those of its answer; no index is 0.
    static LAST: AtomicU64 = AtomicU64::new(0);
    let last = LAST.load(Relaxed);
    if last >> 32 == u64::from(eta.to_bits()) {
        return f32::from_bits(last as u32);
    }
    let inner = Plastic::inner_reflectance(eta);
    LAST.store(u64::from(eta.to_bits()) << 32 | u64::from(inner.to_bits()), Relaxed);
    inner
}
