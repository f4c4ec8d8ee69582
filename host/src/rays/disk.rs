//! Disks, and the ellipses that disks become under affine maps.

use bidir_kernel::Vec3;
use glam::DVec3;

use super::bounds::Bounds;

/// The points centre + a·x + b·y with a² + b² ≤ 1; the normal is x × y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disk {
    /// In the world.
    pub centre: Vec3,
    /// From the centre to the rim; need not be perpendicular to `y`, nor of its length.
    pub x: Vec3,
    /// From the centre to the rim.
    pub y: Vec3,
}

/// A disk with its plane computed.
#[derive(Clone, Debug)]
pub(super) struct FlatDisk {
    pub centre: DVec3,
    pub x: DVec3,
    pub y: DVec3,
    /// Unit.
    pub normal: DVec3,
    /// What a vector of the plane is multiplied by to get its a and its b.
    to_a: DVec3,
    to_b: DVec3,
}

impl Disk {
    pub(super) fn bounds(&self) -> Bounds {
        let (x, y) = (self.x.as_dvec3(), self.y.as_dvec3());
        let half = (x * x + y * y).map(f64::sqrt);
        Bounds::around(self.centre.as_dvec3(), half)
    }
}

impl FlatDisk {
    pub fn new(disk: &Disk) -> Self {
        let (x, y) = (disk.x.as_dvec3(), disk.y.as_dvec3());
        let cross = x.cross(y);
        let squared = cross.dot(cross);
        let normal = cross / squared.sqrt();
        Self { centre: disk.centre.as_dvec3(), x, y, normal, to_a: y.cross(cross) / squared, to_b: cross.cross(x) / squared }
    }

    /// The distance of the point on the ray, or something that is not positive.
    #[inline(always)]
    pub fn distance(&self, origin: DVec3, direction: DVec3) -> f64 {
        let from_centre = origin - self.centre;
        let t = -self.normal.dot(from_centre) / self.normal.dot(direction);
        let (a, b) = self.coordinates_of(from_centre + direction * t);
        if a * a + b * b <= 1.0 { t } else { f64::NAN }
    }

    /// (a, b) of a point of the plane.
    pub fn coordinates(&self, point: DVec3) -> (f64, f64) {
        self.coordinates_of(point - self.centre)
    }

    fn coordinates_of(&self, from_centre: DVec3) -> (f64, f64) {
        (self.to_a.dot(from_centre), self.to_b.dot(from_centre))
    }
}
