//! The same radiance from everywhere.

use bidir_sdk::{Emitted, Profile, Real, Spectrum, Vec2, Vec3, profile::Profiled};

use super::Isotropic;

/// Surroundings that shine alike from every direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constant {
    /// W/(m² sr).
    pub radiance: Spectrum,
}

impl Constant {
    #[inline(always)]
    fn sphere(&self) -> Isotropic {
        Isotropic { intensity: self.radiance }
    }
}

impl Profile for Constant {
    #[inline]
    fn eval(&self, uv: Vec2, direction: Vec3) -> Profiled {
        self.sphere().eval(uv, direction)
    }

    #[inline]
    fn emit(&self, uv: Vec2, u: [Real; 2]) -> Option<Emitted> {
        self.sphere().emit(uv, u)
    }
}
