//! Maps from the unit square to the shapes that directions and points are sampled from.

use crate::{
    math::{max, safe_sqrt, sin_cos, sqr, sqrt, vec2, vec3},
    real::{INV_PI, PI, Real, Vec2, Vec3},
};

/// Uniform on the unit disk; keeps strata together (Shirley & Chiu 1997). Density 1/π.
#[inline]
pub fn disk(u: [Real; 2]) -> Vec2 {
    let (a, b) = (2.0 * u[0] - 1.0, 2.0 * u[1] - 1.0);
    if a == 0.0 && b == 0.0 {
        return Vec2::ZERO;
    }
    let (r, phi) = if a.abs() > b.abs() { (a, PI / 4.0 * (b / a)) } else { (b, PI / 2.0 - PI / 4.0 * (a / b)) };
    let (sin, cos) = sin_cos(phi);
    vec2(r * cos, r * sin)
}

/// Cosine-weighted on the hemisphere about z. Density cos θ/π; cos θ > 0.
#[inline]
pub fn cosine_hemisphere(u: [Real; 2]) -> Vec3 {
    let d = disk(u);
    // z from 1 − r² loses all its digits at the rim; the floor keeps the direction, and its density, off 0.
    vec3(d.x, d.y, max(safe_sqrt(1.0 - d.x * d.x - d.y * d.y), 1e-7))
}

/// The density of [`cosine_hemisphere`] at a direction with this cosine; 0 below.
#[inline(always)]
pub fn cosine_hemisphere_pdf(cos: Real) -> Real {
    max(cos, 0.0) * INV_PI
}

/// Uniform on the unit sphere. Density 1/4π.
#[inline]
pub fn sphere(u: [Real; 2]) -> Vec3 {
    let z = 1.0 - 2.0 * u[0];
    let r = 2.0 * safe_sqrt(u[0] * (1.0 - u[0]));
    let (sin, cos) = sin_cos(2.0 * PI * u[1]);
    vec3(r * cos, r * sin, z)
}

/// The density of [`sphere`].
pub const SPHERE_PDF: Real = 1.0 / (4.0 * PI);

/// Uniform in the cone about z whose half angle has 1 − cos = `one_minus_cos`: that form keeps its digits
/// however narrow the cone is. Density 1/(2π · one_minus_cos).
#[inline]
pub fn cone(u: [Real; 2], one_minus_cos: Real) -> Vec3 {
    let h = u[0] * one_minus_cos;
    let r = safe_sqrt(h * (2.0 - h));
    let (sin, cos) = sin_cos(2.0 * PI * u[1]);
    vec3(r * cos, r * sin, 1.0 - h)
}

/// The density of [`cone`].
#[inline(always)]
pub fn cone_pdf(one_minus_cos: Real) -> Real {
    1.0 / (2.0 * PI * one_minus_cos)
}

/// 1 − cos θ for sin² θ, without cancellation: sin²/(1 + cos).
#[inline(always)]
pub fn one_minus_cos(sin_squared: Real) -> Real {
    sin_squared / (1.0 + safe_sqrt(1.0 - sin_squared))
}

/// Uniform on the triangle: the barycentric coordinates of its second and third corner.
#[inline]
pub fn triangle(u: [Real; 2]) -> Vec2 {
    let root = sqrt(u[0]);
    vec2(u[1] * root, 1.0 - root)
}

/// The squared length of the two-dimensional part of `v`.
#[inline(always)]
pub fn radius_squared(v: Vec2) -> Real {
    sqr(v.x) + sqr(v.y)
}
