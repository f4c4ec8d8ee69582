//! What lights have in common: where they are, which way they shine, and how much.

use bidir_kernel::{Real, Vec3};
use glam::DVec3;
use std::f64::consts::PI;

use super::cone::Cone;
use crate::scene::{
    extent::{Ellipse, Flat, LightExtent, Parallelogram, Surface, Tube},
    lights::{LightSource, Seat},
};

/// One light or several.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cluster {
    /// Of a box that holds them.
    pub low: Vec3,
    /// Of a box that holds them.
    pub high: Vec3,
    /// Where they shine brightest.
    pub cone: Cone,
    /// Whether what is sent beyond the cone falls off as a cosine, to end 90° farther out; else it ends with the cone.
    pub falls_off: bool,
    /// Whether nothing is sent where it has ended; else this is only what a profile's samples said.
    pub certain: bool,
    /// Added up, each one's towards where it shines brightest: about W/sr.
    pub intensity: f64,
}

/// How much wider than the widest of its samples a profile is taken to shine: a factor, and radians.
const WIDER: (f64, f64) = (1.05, 0.01);

/// No profile is taken to send all it sends into fewer steradians than 2π times this.
const NARROWEST: f64 = 1e-7;

impl Cluster {
    /// One light; `None` if it is infinitely far away.
    pub fn of(source: &LightSource) -> Option<Self> {
        let everywhere = |(low, high), intensity| Self { low, high, cone: Cone::ALL, falls_off: true, certain: true, intensity };
        let power = source.power();
        Some(match &source.seat {
            Seat::Point { position, frame } => {
                let reach = source.outflow.reach.max(-1.0);
                let angle = libm::acos(reach) * WIDER.0 + WIDER.1;
                let cone = if angle < PI { Cone { axis: frame.z.as_dvec3(), angle } } else { Cone::ALL };
                let steradians = 2.0 * PI * if cone.is_all() { 2.0 } else { (1.0 - reach).max(NARROWEST) };
                Self { cone, falls_off: false, certain: false, ..everywhere((*position, *position), power / steradians) }
            }
            Seat::Shape(extent) => {
                let cluster = everywhere(bounds(extent), power / (4.0 * PI));
                match extent {
                    LightExtent::Parallelogram(Parallelogram(flat)) | LightExtent::Ellipse(Ellipse(flat)) if !flat.both_sides() => {
                        let cone = Cone { axis: flat.frame.z.as_dvec3(), angle: 0.0 };
                        Self { cone, intensity: power / PI, ..cluster }
                    }
                    LightExtent::Surface(surface) if !source.outflow.both_sides => {
                        Self { cone: normals(surface), certain: false, intensity: power / PI * flatness(surface), ..cluster }
                    }
                    _ => cluster,
                }
            }
            Seat::Environment { .. } | Seat::Directional(_) => return None,
        })
    }

    /// Both.
    pub fn union(&self, other: &Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
            cone: self.cone.union(&other.cone),
            falls_off: self.falls_off || other.falls_off,
            certain: self.certain && other.certain,
            intensity: self.intensity + other.intensity,
        }
    }
}

/// A box that holds the shape and what rounding does to its points; never empty.
fn bounds(extent: &LightExtent) -> (Vec3, Vec3) {
    let flat = |flat: &Flat| around(flat.center, flat.a.abs() + flat.b.abs());
    let (low, high) = match extent {
        LightExtent::Parallelogram(Parallelogram(shape)) | LightExtent::Ellipse(Ellipse(shape)) => flat(shape),
        LightExtent::Ball(ball) => around(ball.center, Vec3::splat(ball.radius)),
        LightExtent::Tube(Tube { base, axis, radius, .. }) => {
            let radius = Vec3::splat(*radius);
            (base.min(*base + *axis) - radius, base.max(*base + *axis) + radius)
        }
        LightExtent::Surface(surface) => {
            let corners = surface.triangles.iter().flat_map(|(corners, _)| corners);
            corners.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), corner| (low.min(*corner), high.max(*corner)))
        }
    };
    let spare = (low.abs().max(high.abs())) * (8.0 * Real::EPSILON);
    (low - spare, high + spare)
}

fn around(center: Vec3, half: Vec3) -> (Vec3, Vec3) {
    (center - half, center + half)
}

/// Of the triangles' normals.
fn normals(surface: &Surface) -> Cone {
    Cone::about(areas(surface))
}

/// About the share of the area that is seen from where most of it is: 1 for a plane, ¼ for a closed surface.
fn flatness(surface: &Surface) -> f64 {
    let (sum, total) = areas(surface).fold((DVec3::ZERO, 0.0), |(sum, total), (normal, area)| (sum + normal * area, total + area));
    (sum.length() / total).clamp(0.25, 1.0)
}

/// Normals and areas of the triangles.
fn areas(surface: &Surface) -> impl Iterator<Item = (DVec3, f64)> + Clone {
    let before = std::iter::once(0.0).chain(surface.cumulative.iter().copied());
    let areas = surface.cumulative.iter().zip(before).map(|(end, start)| end - start);
    surface.triangles.iter().zip(areas).map(|((_, normal), area)| (normal.as_dvec3(), area))
}
