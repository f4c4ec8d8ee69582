//! Cylinders: the side, without the caps.

use bidir_kernel::Vec3;
use glam::DVec3;

use super::{bounds::Bounds, sphere::crossings};

/// The side of a round cylinder; its normal points away from the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    /// One end of the axis, in the world.
    pub p0: Vec3,
    /// The other end.
    pub p1: Vec3,
    /// Where the angle is 0: any vector that is not along the axis; what is perpendicular of it counts.
    pub x: Vec3,
    /// More than 0.
    pub radius: f32,
}

/// A cylinder with its frame computed.
#[derive(Clone, Debug)]
pub(super) struct RoundCylinder {
    base: DVec3,
    /// Unit vectors; z along the axis, y = z × x.
    x: DVec3,
    y: DVec3,
    z: DVec3,
    length: f64,
    radius: f64,
}

impl Cylinder {
    pub(super) fn bounds(&self) -> Bounds {
        let (p0, p1) = (self.p0.as_dvec3(), self.p1.as_dvec3());
        let z = (p1 - p0).normalize_or(DVec3::Z);
        let half = (DVec3::ONE - z * z).map(|squared| f64::from(self.radius) * squared.max(0.0).sqrt());
        Bounds::around(p0, half).join(Bounds::around(p1, half))
    }
}

impl RoundCylinder {
    pub fn new(cylinder: &Cylinder) -> Self {
        let base = cylinder.p0.as_dvec3();
        let axis = cylinder.p1.as_dvec3() - base;
        let z = axis.normalize_or(DVec3::Z);
        let flat = cylinder.x.as_dvec3();
        let flat = flat - z * z.dot(flat);
        let x = flat.try_normalize().unwrap_or_else(|| z.any_orthonormal_vector());
        Self { base, x, y: z.cross(x), z, length: axis.length(), radius: f64::from(cylinder.radius) }
    }

    /// The distance of the first point on the ray, or NaN.
    #[inline(always)]
    pub fn distance(&self, origin: DVec3, direction: DVec3) -> f64 {
        let (origin, direction) = (self.local(origin - self.base), self.local(direction));
        let flat = |v: DVec3| DVec3::new(v.x, v.y, 0.0);
        let crossings = crossings(flat(origin), flat(direction), self.radius);
        let on_side = |t: f64| t > 0.0 && (0.0..=self.length).contains(&(origin.z + t * direction.z));
        crossings.into_iter().find(|&t| on_side(t)).unwrap_or(f64::NAN)
    }

    /// Of the point of the side nearest to `point`: the outward normal, and (cos φ, sin φ, height as a part of the length).
    pub fn normal(&self, point: DVec3) -> (DVec3, DVec3) {
        let local = self.local(point - self.base);
        let round = DVec3::new(local.x, local.y, 0.0).normalize_or(DVec3::X);
        (self.x * round.x + self.y * round.y, round.with_z((local.z / self.length).clamp(0.0, 1.0)))
    }

    /// The point with that normal at that height.
    pub fn point(&self, normal: DVec3, height: f64) -> DVec3 {
        self.base + self.z * (height * self.length) + normal * self.radius
    }

    #[inline(always)]
    fn local(&self, v: DVec3) -> DVec3 {
        DVec3::new(self.x.dot(v), self.y.dot(v), self.z.dot(v))
    }
}
