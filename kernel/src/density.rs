//! Probability densities, each with its measure in its type, and the one conversion between them.

use crate::{
    math::dot,
    point::{Place, Point},
    real::{Real, Vec3},
};

/// A density per unit of area, 1/m².
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct PerArea(pub Real);

/// A density per unit of solid angle, 1/sr.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct PerSolidAngle(pub Real);

/// A discrete probability, 0 … 1.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Chance(pub Real);

/// How densely an endpoint (x_0 on a light, x_k on the lens) is made; the variant is its measure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EndDensity {
    /// A point of a surface, per area.
    Area(PerArea),
    /// A direction of something infinitely far away, per solid angle.
    Direction(PerSolidAngle),
    /// A Dirac: the one point (point light, pinhole) or the one direction (directional light, orthographic camera).
    /// No ray from elsewhere ever lands on it.
    Chance(Chance),
}

impl EndDensity {
    /// The number, in the variant's measure.
    #[inline(always)]
    pub fn value(self) -> Real {
        match self {
            Self::Area(PerArea(p)) | Self::Direction(PerSolidAngle(p)) | Self::Chance(Chance(p)) => p,
        }
    }

    /// Whether a ray from the other side can land on this endpoint.
    #[inline(always)]
    pub fn can_be_hit(self) -> bool {
        !matches!(self, Self::Chance(_))
    }
}

/// How densely an endpoint sends out the path's next vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spread {
    /// From a point: per solid angle about it.
    SolidAngle(PerSolidAngle),
    /// From infinitely far away: parallel rays, per area perpendicular to them.
    Parallel(PerArea),
}

impl Spread {
    /// The number, in the variant's measure.
    #[inline(always)]
    pub fn value(self) -> Real {
        match self {
            Self::SolidAngle(PerSolidAngle(p)) | Self::Parallel(PerArea(p)) => p,
        }
    }
}

/// The factor that turns a density of leaving `from` along the unit `direction` into the density of the point `to` that lies there:
/// |cos θ_to| / d² between finite points, with the cosine of the **geometric** normal (1 off surfaces);
/// |cos θ_to| from infinitely far away (parallel rays); 1 towards infinitely far away, where a density stays per solid angle.
///
/// Every change of measure in the kernel is this function. f64, since d² of a scene 1e±20 in size leaves f32.
#[inline]
pub fn conversion(from: &Point, to: &Point, direction: Vec3) -> f64 {
    conversions(from, to, direction).0
}

/// [`conversion`] there and back: the second one turns a density at `to` into one of `from`.
#[inline]
pub fn conversions(from: &Point, to: &Point, direction: Vec3) -> (f64, f64) {
    let cosine = |at: &Point| if at.place == Place::Surface { f64::from(dot(at.normal, direction).abs()) } else { 1.0 };
    match (from.place == Place::Distant, to.place == Place::Distant) {
        (false, false) => {
            let d = to.position - from.position;
            let (x, y, z) = (f64::from(d.x), f64::from(d.y), f64::from(d.z));
            let per_squared = 1.0 / (x * x + y * y + z * z);
            (cosine(to) * per_squared, cosine(from) * per_squared)
        }
        (true, false) => (cosine(to), 1.0),
        (false, true) => (1.0, cosine(from)),
        (true, true) => (1.0, 1.0),
    }
}
