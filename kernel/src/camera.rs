//! Cameras, as a path asks them.

mod film_plane;
mod orthographic;
mod perspective;

pub use film_plane::FilmPlane;
pub use orthographic::Orthographic;
pub use perspective::{Perspective, Pinhole};

use crate::{
    density::{EndDensity, Spread},
    point::Point,
    real::{Real, Vec2, Vec3},
    spectrum::Spectrum,
};

/// One ray as the camera sees it.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    /// Where on the film, in pixels from the upper left corner of the whole image.
    pub raster: Vec2,
    /// x_k, on the lens.
    pub point: Point,
    /// Unit, from the lens into the scene.
    pub direction: Vec3,
    /// What the camera makes of radiance that arrives along the ray; 1 for a plain camera.
    pub weight: Spectrum,
    /// How densely the lens point is made.
    pub end: EndDensity,
    /// How densely the ray is made from there, over the whole sampled window of the film.
    pub spread: Spread,
    /// The ray sees nothing nearer to the lens than this (0 unless the scene clips).
    pub near: Real,
    /// Nor anything farther than this (infinite unless the scene clips).
    pub far: Real,
}

/// A camera. Every density is over the whole sampled window of the film, in raster-area form: a window twice as large halves it.
pub trait Camera {
    /// Starts a camera walk through `raster`, with two numbers in [0, 1) for the lens.
    fn look(&self, raster: Vec2, lens: [Real; 2]) -> Seen;

    /// How the lens sees `from`, through a lens point chosen with two numbers in [0, 1); `None` where it does not.
    fn see(&self, from: &Point, lens: [Real; 2]) -> Option<Seen>;

    /// Whether the line from `origin` along the unit `direction` lands on the lens within `t_max`, and what the lens makes of it.
    /// Never, for a camera whose lens is a point or a direction.
    fn hit(&self, origin: Vec3, direction: Vec3, t_max: Real) -> Option<Seen>;
}
