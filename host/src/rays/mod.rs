//! Geometry: what a ray hits first, and exactly where.
//!
//! This module knows primitives and rays; it never hears of materials, lights or scenes. A caller collects
//! [`Primitives`], builds a [`Bvh`] from them, and maps the [`PrimitiveId`]s of its answers back to whatever it keeps.
//!
//! No constant decides how near is too near. Distances that rounding could put on the wrong side of a ray's start or end
//! are computed again in f64, and a hit point comes with the distance a ray has to keep from it to clear its rounding error
//! ([`SurfacePoint::offset`]). Answers have the same bits on every machine: nothing but IEEE 754 additions,
//! multiplications, divisions and square roots, none of them fused where a hit's numbers come from; and equal distances go to the lower
//! primitive.

mod bounds;
mod build;
mod bvh;
mod collapse;
mod cylinder;
mod descent;
mod disk;
mod instance;
mod lanes;
mod nearest;
mod node;
mod parallelogram;
mod primitives;
mod probe;
mod sphere;
mod surface;
mod triangle;

#[cfg(test)]
mod tests;

pub use bounds::Bounds;
pub use build::{BuildStats, Quality};
pub use bvh::{Bvh, Triangles};
pub use cylinder::Cylinder;
pub use disk::Disk;
pub use instance::{Instance, LEVELS};
pub use parallelogram::Parallelogram;
pub use primitives::{PrimitiveId, Primitives, Visibility};
pub use sphere::Sphere;
pub use surface::SurfacePoint;

use bidir_kernel::Ray;

/// Where a ray met a primitive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayHit {
    /// The distance, in lengths of the ray's direction; 0 < t < t_max.
    pub t: f32,
    /// Which primitive: its number in the order of insertion.
    pub primitive: PrimitiveId,
    /// Triangles: the barycentric coordinates b1, b2 of the second and third corner. Parallelograms: the coordinates along
    /// its two edges, 0 … 1. Everything else: 0, 0, and [`Geometry::surface`] knows more.
    pub coordinates: (f32, f32),
    /// Where the structure that answered keeps the primitive.
    slot: u32,
    /// Of an instance: where the trees within it keep what was hit there, from the outermost inwards.
    trail: [u32; LEVELS],
}

/// What rays are cast against.
pub trait Geometry {
    /// The first thing on the ray: 0 < t < t_max. A ray that is not finite, has no direction, or no length hits nothing.
    /// What lies within four roundings of t_max counts as its end, not as in its way.
    fn closest(&self, ray: &Ray) -> Option<RayHit>;

    /// Whether anything is on the ray; the same answer as `closest(ray).is_some()`, sooner.
    fn occluded(&self, ray: &Ray) -> bool;

    /// What a hit lies on, from the outermost instance inwards; the last one is the primitive itself.
    fn path(&self, hit: &RayHit) -> impl Iterator<Item = PrimitiveId>;

    /// The point of a hit that [`Self::closest`] gave for this ray, reconstructed on the primitive itself.
    fn surface(&self, ray: &Ray, hit: &RayHit) -> SurfacePoint;

    /// The box of everything; empty where there is nothing.
    fn bounds(&self) -> Bounds;
}
