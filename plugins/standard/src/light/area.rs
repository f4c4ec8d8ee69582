//! The same radiance in every direction of the hemisphere.

use bidir_sdk::{
    Emitted, PerSolidAngle, Profile, Real, Spectrum, Vec2, Vec3,
    profile::Profiled,
    warp::{cosine_hemisphere, cosine_hemisphere_pdf},
};

/// A surface that shines on the side of its normal; black on the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Area {
    /// W/(m² sr).
    pub radiance: Spectrum,
}

impl Profile for Area {
    #[inline]
    fn eval(&self, _: Vec2, direction: Vec3) -> Profiled {
        let radiance = if direction.z > 0.0 { self.radiance } else { Spectrum::BLACK };
        Profiled { radiance, pdf: PerSolidAngle(cosine_hemisphere_pdf(direction.z)) }
    }

    #[inline]
    fn emit(&self, _: Vec2, u: [Real; 2]) -> Option<Emitted> {
        let direction = cosine_hemisphere(u);
        let pdf = PerSolidAngle(cosine_hemisphere_pdf(direction.z));
        Some(Emitted { direction, profiled: Profiled { radiance: self.radiance, pdf } })
    }
}
