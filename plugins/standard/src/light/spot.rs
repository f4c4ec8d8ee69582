//! A cone that falls off towards its edge.

use bidir_sdk::{
    Emitted, PerSolidAngle, Profile, Real, Spectrum, Vec2, Vec3,
    math::{atan2, sin, sqr, sqrt},
    profile::Profiled,
    real::PI,
    warp::{cone, cone_pdf},
};

/// A point that shines into a cone about z: fully within `beam_width` of the axis, then linearly less with the angle,
/// and not at all from `cutoff` on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// W/sr on the axis.
    pub intensity: Spectrum,
    /// Half the cone's angle in radians, 0 … π. 0 sends nothing.
    pub cutoff: Real,
    /// Half the angle of the part without falloff, in radians. From `cutoff` on: no falloff.
    pub beam_width: Real,
}

impl Spot {
    /// From half angles in degrees; a negative `beam_width` is three quarters of the cutoff.
    #[inline]
    pub fn from_degrees(intensity: Spectrum, cutoff_angle: Real, beam_width: Real) -> Self {
        let beam_width = if beam_width < 0.0 { 0.75 * cutoff_angle } else { beam_width };
        Self { intensity, cutoff: cutoff_angle * DEGREE, beam_width: beam_width * DEGREE }
    }

    /// 1 − cos of the cutoff, without cancellation; 0 where the cone holds no direction.
    #[inline]
    fn opening(&self) -> Real {
        2.0 * sqr(sin(0.5 * self.cutoff.clamp(0.0, PI)))
    }

    #[inline]
    fn falloff(&self, angle: Real) -> Real {
        if angle <= self.beam_width {
            1.0
        } else if angle < self.cutoff {
            (self.cutoff - angle) / (self.cutoff - self.beam_width)
        } else {
            0.0
        }
    }
}

/// In radians.
const DEGREE: Real = PI / 180.0;

/// The angle to z; from both coordinates, since its cosine alone loses the digits of narrow cones.
#[inline]
fn angle_to_axis(direction: Vec3) -> Real {
    atan2(sqrt(sqr(direction.x) + sqr(direction.y)), direction.z)
}

impl Profile for Spot {
    #[inline]
    fn eval(&self, _: Vec2, direction: Vec3) -> Profiled {
        let (angle, opening) = (angle_to_axis(direction), self.opening());
        if !(opening > 0.0 && angle <= self.cutoff) {
            return Profiled { radiance: Spectrum::BLACK, pdf: PerSolidAngle(0.0) };
        }
        Profiled { radiance: self.intensity * self.falloff(angle), pdf: PerSolidAngle(cone_pdf(opening)) }
    }

    #[inline]
    fn emit(&self, _: Vec2, u: [Real; 2]) -> Option<Emitted> {
        let opening = self.opening();
        if !(opening > 0.0) {
            return None;
        }
        let direction = cone(u, opening);
        let radiance = self.intensity * self.falloff(angle_to_axis(direction));
        Some(Emitted { direction, profiled: Profiled { radiance, pdf: PerSolidAngle(cone_pdf(opening)) } })
    }
}
