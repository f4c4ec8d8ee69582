//! Light from infinitely far away, in every direction.

use crate::{
    density::{EndDensity, PerArea, PerSolidAngle, Spread},
    frame::Frame,
    light::{Emission, Exit, Illumination, Light},
    math::dot,
    point::Point,
    profile::Profile,
    real::{PI, Real, Vec2, Vec3},
    warp,
};

/// A profile on the sphere of directions about the scene.
#[derive(Clone, Copy, Debug)]
pub struct EnvironmentLight<P> {
    /// Of a sphere that holds everything there is to light.
    pub center: Vec3,
    /// Of that sphere.
    pub radius: Real,
    /// The profile's frame: z is up.
    pub frame: Frame,
    /// Its directions travel from the sphere towards the scene.
    pub profile: P,
}

impl<P: Profile> EnvironmentLight<P> {
    /// Rays of one direction start on a disk as wide as the scene (Veach 1997, 8.2.2.2).
    fn spread(&self) -> Spread {
        Spread::Parallel(PerArea(1.0 / (PI * self.radius * self.radius)))
    }
}

impl<P: Profile> Light for EnvironmentLight<P> {
    fn emit(&self, u: [Real; 4]) -> Option<Emission> {
        let out = self.profile.emit(Vec2::ZERO, [u[2], u[3]])?;
        let inward = self.frame.to_world(out.direction);
        let disk = warp::disk([u[0], u[1]]) * self.radius;
        let across = Frame::from_z(inward);
        let origin = self.center - inward * self.radius + across.x * disk.x + across.y * disk.y;
        let spread = self.spread();
        Some(Emission {
            point: Point::distant(origin, inward),
            direction: inward,
            weight: out.profiled.radiance / out.profiled.pdf.0 / spread.value(),
            exit: Exit { radiance: out.profiled.radiance, end: EndDensity::Direction(out.profiled.pdf), spread },
        })
    }

    fn illuminate(&self, lit: &Point, u: [Real; 2]) -> Option<Illumination> {
        let out = self.profile.emit(Vec2::ZERO, u)?;
        let inward = self.frame.to_world(out.direction);
        let density = EndDensity::Direction(out.profiled.pdf);
        Some(Illumination {
            point: Point::distant(lit.position, inward),
            direction: -inward,
            weight: out.profiled.radiance / out.profiled.pdf.0,
            density,
            exit: Exit { radiance: out.profiled.radiance, end: density, spread: self.spread() },
        })
    }

    fn emitted(&self, at: &Point, _: Vec3) -> Exit {
        let out = self.profile.eval(Vec2::ZERO, self.frame.to_local(at.normal));
        // A lens may stand outside the sphere, and see past it along a line that no light walk takes.
        let from_center = at.position - self.center;
        let across = from_center.cross(at.normal);
        let walked = dot(across, across) <= self.radius * self.radius && dot(from_center, at.normal) >= -self.radius;
        let spread = if walked { self.spread() } else { Spread::Parallel(PerArea(0.0)) };
        Exit { radiance: out.radiance, end: EndDensity::Direction(out.pdf), spread }
    }

    fn next_event_density(&self, at: &Point, _: &Point) -> EndDensity {
        let PerSolidAngle(pdf) = self.profile.eval(Vec2::ZERO, self.frame.to_local(at.normal)).pdf;
        EndDensity::Direction(PerSolidAngle(pdf))
    }
}
