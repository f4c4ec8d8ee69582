//! Light from a surface.

use crate::{
    density::{EndDensity, PerArea, Spread, conversion},
    frame::Frame,
    light::{Emission, Exit, Illumination, Light},
    math::dot,
    point::Point,
    profile::Profile,
    real::{Real, Vec3},
};

/// A point of a surface, chosen to light a receiver.
#[derive(Clone, Copy, Debug)]
pub struct Toward {
    /// The point.
    pub point: Point,
    /// How densely it was made.
    pub density: PerArea,
    /// Unit, from the receiver to the point.
    pub direction: Vec3,
    /// 1 / density per steradian about the receiver, finite even where the density is not.
    pub weight: Real,
}

/// A surface that points can be sampled on.
pub trait Extent {
    /// Samples a point with two numbers in [0, 1).
    fn sample(&self, u: [Real; 2]) -> (Point, PerArea);

    /// How densely [`Extent::sample`] makes `at`.
    fn density(&self, at: &Point) -> PerArea;

    /// Samples a point to light `lit` from; `None` where none can be seen from there.
    #[inline]
    fn sample_toward(&self, lit: &Point, u: [Real; 2]) -> Option<Toward> {
        let (point, PerArea(p)) = self.sample(u);
        let (direction, squared) = lit.direction_to(&point)?;
        Some(Toward { point, density: PerArea(p), direction, weight: dot(point.normal, direction).abs() / (squared * p) })
    }

    /// How densely [`Extent::sample_toward`] makes `at` for `lit`.
    #[inline]
    fn density_toward(&self, at: &Point, lit: &Point) -> PerArea {
        let _ = lit;
        self.density(at)
    }
}

/// A profile on every point of a surface.
#[derive(Clone, Copy, Debug)]
pub struct AreaLight<E, P> {
    /// The surface.
    pub extent: E,
    /// Its z is the geometric normal, its x the shading frame's.
    pub profile: P,
}

#[inline]
fn profile_frame(at: &Point) -> Frame {
    if at.frame.z == at.normal { at.frame } else { Frame::from_z_and_tangent(at.normal, at.frame.x) }
}

impl<E: Extent, P: Profile> AreaLight<E, P> {
    #[inline(always)]
    fn exit(&self, at: &Point, toward: Vec3, end: PerArea) -> Exit {
        let out = self.profile.eval(at.uv, profile_frame(at).to_local(toward));
        Exit { radiance: out.radiance, end: EndDensity::Area(end), spread: Spread::SolidAngle(out.pdf) }
    }
}

impl<E: Extent, P: Profile> Light for AreaLight<E, P> {
    #[inline]
    fn emit(&self, u: [Real; 4]) -> Option<Emission> {
        let (point, PerArea(p)) = self.extent.sample([u[0], u[1]]);
        let out = self.profile.emit(point.uv, [u[2], u[3]])?;
        Some(Emission {
            direction: profile_frame(&point).to_world(out.direction),
            weight: out.profiled.radiance * (out.direction.z.abs() / out.profiled.pdf.0 / p),
            exit: Exit { radiance: out.profiled.radiance, end: EndDensity::Area(PerArea(p)), spread: Spread::SolidAngle(out.profiled.pdf) },
            point,
        })
    }

    #[inline(always)]
    fn illuminate(&self, lit: &Point, u: [Real; 2]) -> Option<Illumination> {
        let Toward { point, density, direction, weight } = self.extent.sample_toward(lit, u)?;
        let exit = self.exit(&point, -direction, self.extent.density(&point));
        Some(Illumination { point, direction, weight: exit.radiance * weight, density: EndDensity::Area(density), exit })
    }

    #[inline(always)]
    fn emitted(&self, at: &Point, toward: Vec3) -> Exit {
        self.exit(at, toward, self.extent.density(at))
    }

    #[inline]
    fn next_event_density(&self, at: &Point, lit: &Point) -> EndDensity {
        EndDensity::Area(self.extent.density_toward(at, lit))
    }
}

/// Turns a density per steradian about `lit` into one per area at `at`; for extents that sample a cone of directions.
pub fn per_area(per_solid_angle: Real, lit: &Point, at: &Point) -> PerArea {
    match lit.direction_to(at) {
        Some((direction, _)) => PerArea((f64::from(per_solid_angle) * conversion(lit, at, direction)) as Real),
        None => PerArea(0.0),
    }
}
