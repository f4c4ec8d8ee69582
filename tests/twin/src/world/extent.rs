//! The surfaces of lights.

use super::{
    super::kernel::{
        Frame, PerArea, Point, Real, Vec2,
        light::{Extent, Toward, per_area},
    },
    moved, narrowed, turned, widened,
};
use crate::{geometry::Site, nudge::Nudge, setting::Shape};

/// A shape that shines.
#[derive(Clone, Copy, Debug)]
pub struct Patch<'a> {
    pub shape: &'a Shape,
    pub nudge: &'a Nudge,
}

/// The place as this world holds it. Rays start off it by a bound on its rounding; those that find out what rounding does
/// start where f32 would have them.
pub fn placed(nudge: &Nudge, site: &Site) -> Point {
    let position = moved(nudge, narrowed(site.position));
    let normal = turned(nudge, narrowed(site.normal));
    let shading = if site.shading == site.normal { normal } else { turned(nudge, narrowed(site.shading)) };
    let frame = Frame::from_z_and_tangent(shading, narrowed(site.tangent));
    let relative = if nudge.active() { 8.0 * f64::from(f32::EPSILON) } else { (8.0 * f64::from(Real::EPSILON)).max(1e-12) };
    let offset = (relative * site.position.abs().max_element()) as Real;
    Point::surface(position, normal, frame, Vec2::ZERO, offset)
}

impl Extent for Patch<'_> {
    fn sample(&self, u: [Real; 2]) -> (Point, PerArea) {
        (placed(self.nudge, &self.shape.sampled(u.map(f64::from))), PerArea(self.shape.density() as Real))
    }

    fn density(&self, _: &Point) -> PerArea {
        PerArea(self.shape.density() as Real)
    }

    fn sample_toward(&self, lit: &Point, u: [Real; 2]) -> Option<Toward> {
        let from = widened(lit.position);
        let Some(pdf) = self.shape.cone_density(from) else {
            let (point, PerArea(p)) = self.sample(u);
            let (direction, squared) = lit.direction_to(&point)?;
            return Some(Toward { point, density: PerArea(p), direction, weight: point.normal.dot(direction).abs() / (squared * p) });
        };
        let point = placed(self.nudge, &self.shape.sampled_toward(from, u.map(f64::from))?);
        let (direction, _) = lit.direction_to(&point)?;
        Some(Toward { point, density: per_area(pdf as Real, lit, &point), direction, weight: (1.0 / pdf) as Real })
    }

    fn density_toward(&self, at: &Point, lit: &Point) -> PerArea {
        match self.shape.cone_density(widened(lit.position)) {
            Some(pdf) => per_area(pdf as Real, lit, at),
            None => self.density(at),
        }
    }
}
