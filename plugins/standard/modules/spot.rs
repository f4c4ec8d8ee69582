//! The built-in `spot` as a module.

use bidir_standard::Spot;

bidir_sdk::parameters! {
    /// A cone that falls off towards its edge.
    pub struct Settings {
        /// W/sr on the axis.
        intensity: rgb(min 0.0) = 1.0;
        /// Half the cone's angle, degrees.
        cutoff_angle: float(min 0.0, max 180.0) = 20.0;
        /// Half the angle of the part without falloff, degrees; -1: three quarters of cutoff_angle.
        beam_width: float(min -1.0, max 180.0) = -1.0;
    }
}

bidir_sdk::light! {
    Settings => |settings: &Settings| Spot::from_degrees(settings.intensity, settings.cutoff_angle, settings.beam_width),
    emits_from: [point],
}
