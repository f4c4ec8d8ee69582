//! A camera infinitely far away.

use crate::{
    camera::{Camera, FilmPlane, Seen},
    density::{Chance, EndDensity, PerArea, Spread},
    math::{dot, vec2},
    point::Point,
    real::{Real, Vec2, Vec3},
    spectrum::Spectrum,
};

/// An orthographic camera. Its direction is a Dirac, as a directional light's is; its rays start on the film plane,
/// and nothing behind that is seen.
#[derive(Clone, Copy, Debug)]
pub struct Orthographic {
    /// The film plane's centre, in the world.
    pub position: Vec3,
    /// x to the image's left, y up, z into the scene; orthonormal.
    pub axes: [Vec3; 3],
    /// In world units.
    pub film: FilmPlane,
    /// What lies nearer than this is not seen; 0 unless the scene clips.
    pub near: Real,
    /// Nor what lies farther; infinite unless the scene clips.
    pub far: Real,
}

impl Orthographic {
    fn seen(&self, raster: Vec2, at: Vec2) -> Seen {
        let position = self.position + self.axes[0] * at.x + self.axes[1] * at.y;
        Seen {
            raster,
            // Nothing behind the film plane is seen.
            point: Point { offset: 0.0, ..Point::distant(position, self.axes[2]) },
            direction: self.axes[2],
            weight: Spectrum::ONE,
            end: EndDensity::Chance(Chance(1.0)),
            spread: Spread::Parallel(PerArea(1.0 / self.film.window_area())),
            near: self.near,
            far: self.far,
        }
    }
}

impl Camera for Orthographic {
    fn look(&self, raster: Vec2, _: [Real; 2]) -> Seen {
        self.seen(raster, self.film.at(raster))
    }

    fn see(&self, from: &Point, _: [Real; 2]) -> Option<Seen> {
        // Light from infinitely far away lands on one direction of many: never on this one.
        if from.place == crate::point::Place::Distant {
            return None;
        }
        let d = from.position - self.position;
        if dot(d, self.axes[2]) <= 0.0 {
            return None;
        }
        let at = vec2(dot(d, self.axes[0]), dot(d, self.axes[1]));
        Some(self.seen(self.film.raster(at)?, at))
    }

    fn hit(&self, _: Vec3, _: Vec3, _: Real) -> Option<Seen> {
        None
    }
}
