//! Orthonormal frames: the way between the world and a shader's own coordinates.

use crate::{
    math::{dot, normalize, vec3},
    real::{Real, Vec3},
};

/// A right-handed orthonormal frame; a shader sees z as its normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// First tangent, in the world.
    pub x: Vec3,
    /// Second tangent, in the world.
    pub y: Vec3,
    /// The normal, in the world.
    pub z: Vec3,
}

impl Frame {
    /// Some frame about the unit vector `z` (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
    #[inline]
    pub fn from_z(z: Vec3) -> Self {
        let sign: Real = if z.z >= 0.0 { 1.0 } else { -1.0 };
        let a = -1.0 / (sign + z.z);
        let b = z.x * z.y * a;
        Self { x: vec3(1.0 + sign * z.x * z.x * a, sign * b, -sign * z.x), y: vec3(b, sign + z.y * z.y * a, -z.y), z }
    }

    /// The frame about the unit vector `z` whose x is `tangent` made perpendicular to it;
    /// some frame about `z` where the tangent is parallel to it, zero or not finite.
    #[inline]
    pub fn from_z_and_tangent(z: Vec3, tangent: Vec3) -> Self {
        let flat = tangent - z * dot(z, tangent);
        match normalize(flat) {
            Some(x) if dot(flat, flat) > 1e-12 * dot(tangent, tangent) => Self { x, y: z.cross(x), z },
            _ => Self::from_z(z),
        }
    }

    /// World → this frame.
    #[inline(always)]
    pub fn to_local(&self, v: Vec3) -> Vec3 {
        vec3(dot(v, self.x), dot(v, self.y), dot(v, self.z))
    }

    /// This frame → world.
    #[inline(always)]
    pub fn to_world(&self, v: Vec3) -> Vec3 {
        self.x * v.x + self.y * v.y + self.z * v.z
    }
}
