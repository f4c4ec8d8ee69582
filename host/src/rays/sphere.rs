//! Spheres.

use bidir_kernel::Vec3;
use glam::DVec3;

use super::bounds::Bounds;

/// A sphere; its normal points outwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// In the world.
    pub centre: Vec3,
    /// More than 0.
    pub radius: f32,
}

impl Sphere {
    pub(super) fn bounds(&self) -> Bounds {
        Bounds::around(self.centre.as_dvec3(), DVec3::splat(f64::from(self.radius)))
    }

    /// The distance of the first point on the ray, or NaN.
    #[inline(always)]
    pub(super) fn distance(&self, origin: DVec3, direction: DVec3) -> f64 {
        let [near, far] = crossings(origin - self.centre.as_dvec3(), direction, f64::from(self.radius));
        if near > 0.0 { near } else { far }
    }

    /// The outward normal nearest to `point`.
    pub(super) fn normal(&self, point: DVec3) -> DVec3 {
        (point - self.centre.as_dvec3()).normalize_or(DVec3::Z)
    }

    /// The point with that normal.
    pub(super) fn point(&self, normal: DVec3) -> DVec3 {
        self.centre.as_dvec3() + normal * f64::from(self.radius)
    }
}

/// Where a line enters and leaves the sphere about the coordinates' origin, or NaN twice; also a circle's, if nothing has a z.
/// The discriminant is taken from the line's nearest point, not from b² − 4ac, so that a sphere many radii away
/// is not lost (Haines et al. 2019, "Precision Improvements for Ray/Sphere Intersection").
#[inline(always)]
pub(super) fn crossings(origin: DVec3, direction: DVec3, radius: f64) -> [f64; 2] {
    let a = direction.dot(direction);
    let b = -origin.dot(direction);
    let c = origin.dot(origin) - radius * radius;
    let nearest = origin + direction * (b / a);
    let root = (a * (radius * radius - nearest.dot(nearest))).sqrt();
    let q = if b < 0.0 { b - root } else { b + root };
    let (one, other) = (c / q, q / a);
    if one <= other { [one, other] } else { [other, one] }
}
