//! A light without extent.

use crate::{
    density::{Chance, EndDensity, Spread},
    frame::Frame,
    light::{Emission, Exit, Illumination, Light},
    point::Point,
    profile::Profile,
    real::{Real, Vec2, Vec3},
};

/// A profile at one point.
#[derive(Clone, Copy, Debug)]
pub struct PointLight<P> {
    /// In the world.
    pub position: Vec3,
    /// The profile's frame: z is its axis.
    pub frame: Frame,
    /// Radiance of the profile is read as intensity, W/sr.
    pub profile: P,
}

const CERTAIN: EndDensity = EndDensity::Chance(Chance(1.0));

impl<P: Profile> PointLight<P> {
    fn exit(&self, direction: Vec3) -> Exit {
        let out = self.profile.eval(Vec2::ZERO, self.frame.to_local(direction));
        Exit { radiance: out.radiance, end: CERTAIN, spread: Spread::SolidAngle(out.pdf) }
    }
}

impl<P: Profile> Light for PointLight<P> {
    fn emit(&self, u: [Real; 4]) -> Option<Emission> {
        let out = self.profile.emit(Vec2::ZERO, [u[2], u[3]])?;
        Some(Emission {
            point: Point::free(self.position),
            direction: self.frame.to_world(out.direction),
            weight: out.profiled.radiance / out.profiled.pdf.0,
            exit: Exit { radiance: out.profiled.radiance, end: CERTAIN, spread: Spread::SolidAngle(out.profiled.pdf) },
        })
    }

    fn illuminate(&self, lit: &Point, _: [Real; 2]) -> Option<Illumination> {
        let point = Point::free(self.position);
        let (direction, squared) = lit.direction_to(&point)?;
        let exit = self.exit(-direction);
        Some(Illumination { point, direction, weight: exit.radiance / squared, density: CERTAIN, exit })
    }

    fn emitted(&self, _: &Point, toward: Vec3) -> Exit {
        self.exit(toward)
    }

    fn next_event_density(&self, _: &Point, _: &Point) -> EndDensity {
        CERTAIN
    }
}
