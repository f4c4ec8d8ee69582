//! The same intensity in every direction.

use bidir_sdk::{
    Emitted, PerSolidAngle, Profile, Real, Spectrum, Vec2, Vec3,
    profile::Profiled,
    warp::{SPHERE_PDF, sphere},
};

/// A point that shines alike in every direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Isotropic {
    /// W/sr.
    pub intensity: Spectrum,
}

impl Profile for Isotropic {
    #[inline]
    fn eval(&self, _: Vec2, _: Vec3) -> Profiled {
        Profiled { radiance: self.intensity, pdf: PerSolidAngle(SPHERE_PDF) }
    }

    #[inline]
    fn emit(&self, uv: Vec2, u: [Real; 2]) -> Option<Emitted> {
        let direction = sphere(u);
        Some(Emitted { direction, profiled: self.eval(uv, direction) })
    }
}
