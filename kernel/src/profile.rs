//! What a light sends where, apart from the shape that sends it.

use crate::{
    density::PerSolidAngle,
    real::{Real, Vec2, Vec3},
    spectrum::Spectrum,
};

/// What leaves along one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Profiled {
    /// W/(m² sr) on a surface or from an environment, W/sr at a point.
    pub radiance: Spectrum,
    /// How densely [`Profile::emit`] makes this direction.
    pub pdf: PerSolidAngle,
}

/// A sampled direction of emission.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Emitted {
    /// Unit, in the profile's frame.
    pub direction: Vec3,
    /// What leaves along it.
    pub profiled: Profiled,
}

/// An emission profile: one side of a light plugin. z is the surface's normal, the axis of a point light, or up;
/// directions leave the light (an environment's come from the sphere of directions towards the scene).
pub trait Profile {
    /// What leaves along the unit `direction` at the surface coordinates `uv` ((0, 0) off surfaces).
    fn eval(&self, uv: Vec2, direction: Vec3) -> Profiled;

    /// Samples a direction with two numbers in [0, 1); `None` where nothing leaves.
    fn emit(&self, uv: Vec2, u: [Real; 2]) -> Option<Emitted>;
}
