//! The point of a hit, on the primitive and not on the ray.

use bidir_kernel::Vec3;
use glam::DVec3;

use super::bounds::Bounds;

/// A point of a primitive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// In the world: the f32 point nearest to a point of the primitive.
    pub position: Vec3,
    /// The unit geometric normal, as the primitive's type defines it, whichever side the ray came from.
    pub normal: Vec3,
    /// How far along the normal, to either side, a ray has to start or end to clear the rounding error of `position`.
    pub offset: f32,
    /// On the primitive. Triangle: (b1, b2, 0). Parallelogram: (a, b, 0). Disk: (a, b, 0).
    /// Sphere: the unit outward normal. Cylinder: (cos φ, sin φ, height as a part of the length).
    pub local: Vec3,
}

impl SurfacePoint {
    /// From a point and a normal that are exact compared to f32, and how far rounding may move the point along each axis.
    /// The offset is twice that, along the normal.
    pub(super) fn new(position: DVec3, normal: DVec3, local: DVec3, error: DVec3) -> Self {
        let offset = 2.0 * normal.abs().dot(error);
        Self { position: position.as_vec3(), normal: normal.as_vec3(), offset: offset as f32, local: local.as_vec3() }
    }
}

/// How far rounding may move a point along each axis, where `bounds` is the box of all there is.
///
/// With u the relative error of one rounding, this is the sum of u·|p| for rounding the position, u·|p| for adding an offset to it,
/// and u·reach for rounding the direction of a segment that ends here after coming from the other end of the scene.
pub(super) fn rounding(position: DVec3, bounds: &Bounds) -> DVec3 {
    const U: f64 = f32::EPSILON as f64 / 2.0;
    (position.abs() * 2.0 + bounds.reach(position.as_vec3()).as_dvec3()) * U
}
