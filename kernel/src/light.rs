//! Lights, as a path asks them.

mod area;
mod environment;
mod point;

pub use area::{AreaLight, Extent, Toward, per_area};
pub use environment::EnvironmentLight;
pub use point::PointLight;

use crate::{
    density::{EndDensity, Spread},
    point::Point,
    real::{Real, Vec3},
    spectrum::Spectrum,
};

/// What leaves a point of a light along one direction, and how densely a light walk would have made both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exit {
    /// Radiance, W/(m² sr); W/sr from a point light; W/m² (irradiance perpendicular to it) from a directional light.
    pub radiance: Spectrum,
    /// How densely [`Light::emit`] makes the point (for infinitely far lights: the direction), given this light.
    pub end: EndDensity,
    /// How densely [`Light::emit`] sends light along the direction from there.
    pub spread: Spread,
}

/// The start of a light walk.
#[derive(Clone, Copy, Debug)]
pub struct Emission {
    /// x_0.
    pub point: Point,
    /// Unit, away from the light.
    pub direction: Vec3,
    /// radiance · |cos θ| / (end · spread), finite even where a factor is not.
    pub weight: Spectrum,
    /// The densities behind it.
    pub exit: Exit,
}

/// A sample for next event estimation.
#[derive(Clone, Copy, Debug)]
pub struct Illumination {
    /// x_0.
    pub point: Point,
    /// Unit, from the receiver towards the light.
    pub direction: Vec3,
    /// What arrives at the receiver per steradian / density per steradian (for a Dirac: what arrives).
    pub weight: Spectrum,
    /// How densely this call makes x_0, in the light's own measure.
    pub density: EndDensity,
    /// What leaves x_0 towards the receiver, and how densely a light walk would have made it.
    pub exit: Exit,
}

/// A light. Its choice among all lights is the scene's and in none of these densities.
///
/// Of a receiver `lit`, nothing counts but position, geometric normal and place.
pub trait Light {
    /// Starts a light walk with four numbers in [0, 1); `None` where nothing leaves.
    fn emit(&self, u: [Real; 4]) -> Option<Emission>;

    /// Samples x_0 for the receiver `lit` with two numbers in [0, 1); `None` where nothing arrives.
    fn illuminate(&self, lit: &Point, u: [Real; 2]) -> Option<Illumination>;

    /// A ray landed on the light at `at`: what leaves there along the unit direction `toward`.
    /// For a distant light, `at` lies on the line along which the light arrives.
    fn emitted(&self, at: &Point, toward: Vec3) -> Exit;

    /// How densely [`Light::illuminate`] makes `at` for the receiver `lit`, in the measure of [`Exit::end`].
    fn next_event_density(&self, at: &Point, lit: &Point) -> EndDensity;
}

impl<L: Light> Light for &L {
    #[inline(always)]
    fn emit(&self, u: [Real; 4]) -> Option<Emission> {
        (**self).emit(u)
    }

    #[inline(always)]
    fn illuminate(&self, lit: &Point, u: [Real; 2]) -> Option<Illumination> {
        (**self).illuminate(lit, u)
    }

    #[inline(always)]
    fn emitted(&self, at: &Point, toward: Vec3) -> Exit {
        (**self).emitted(at, toward)
    }

    #[inline(always)]
    fn next_event_density(&self, at: &Point, lit: &Point) -> EndDensity {
        (**self).next_event_density(at, lit)
    }
}
