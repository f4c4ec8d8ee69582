//! Where on the film a point of the image plane lies.

use crate::{
    math::vec2,
    real::{Real, Vec2},
};

/// The image plane: it spans −half … half in the camera's own x (to the left) and y (up), and the whole image covers it.
#[derive(Clone, Copy, Debug)]
pub struct FilmPlane {
    /// Half its width and height, in the unit of the camera that holds it.
    pub half: Vec2,
    /// The whole image, in pixels.
    pub resolution: Vec2,
    /// The sampled window's upper left corner, in pixels of the whole image.
    pub window_min: Vec2,
    /// Its lower right corner.
    pub window_max: Vec2,
    /// Where the optical axis meets the film, as a fraction of the image, relative to its middle; right and down are positive.
    pub principal: Vec2,
}

impl FilmPlane {
    /// A whole image of `resolution` pixels, centred on the optical axis, on a plane 2 · `half_width` wide.
    pub fn centred(resolution: Vec2, half_width: Real) -> Self {
        let half = vec2(half_width, half_width * resolution.y / resolution.x);
        Self { half, resolution, window_min: Vec2::ZERO, window_max: resolution, principal: Vec2::ZERO }
    }

    /// Raster → plane.
    #[inline]
    pub fn at(&self, raster: Vec2) -> Vec2 {
        let f = raster / self.resolution - self.principal;
        vec2((1.0 - 2.0 * f.x) * self.half.x, (1.0 - 2.0 * f.y) * self.half.y)
    }

    /// Plane → raster; `None` outside the sampled window.
    #[inline]
    pub fn raster(&self, at: Vec2) -> Option<Vec2> {
        let f = vec2(0.5 - 0.5 * at.x / self.half.x, 0.5 - 0.5 * at.y / self.half.y);
        let raster = (f + self.principal) * self.resolution;
        let inside =
            raster.x >= self.window_min.x && raster.x < self.window_max.x && raster.y >= self.window_min.y && raster.y < self.window_max.y;
        inside.then_some(raster)
    }

    /// The sampled window's area on the plane.
    #[inline]
    pub fn window_area(&self) -> Real {
        let share = (self.window_max - self.window_min) / self.resolution;
        4.0 * self.half.x * self.half.y * share.x * share.y
    }
}
