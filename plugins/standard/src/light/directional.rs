//! Parallel rays from infinitely far away.

use bidir_sdk::{
    Chance, Emission, EndDensity, Exit, Frame, Illumination, Light, PerArea, Point, Real, Spectrum, Spread, Vec3, real::PI, warp::disk,
};

/// The sun, if it were a point. No ray ever lands on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Directional {
    /// Unit: which way light travels, in the world.
    pub direction: Vec3,
    /// W/m², on a surface perpendicular to it.
    pub irradiance: Spectrum,
    /// Of a sphere that holds the whole scene.
    pub center: Vec3,
    /// Of that sphere.
    pub radius: Real,
}

const CERTAIN: EndDensity = EndDensity::Chance(Chance(1.0));

impl Directional {
    /// π R².
    #[inline]
    fn cross_section(&self) -> Real {
        PI * self.radius * self.radius
    }

    #[inline]
    fn exit(&self) -> Exit {
        Exit { radiance: self.irradiance, end: CERTAIN, spread: Spread::Parallel(PerArea(1.0 / self.cross_section())) }
    }
}

impl Light for Directional {
    #[inline]
    fn emit(&self, u: [Real; 4]) -> Option<Emission> {
        let across = Frame::from_z(self.direction);
        let disk = disk([u[0], u[1]]) * self.radius;
        let origin = self.center - self.direction * self.radius + across.x * disk.x + across.y * disk.y;
        Some(Emission {
            point: Point::distant(origin, self.direction),
            direction: self.direction,
            weight: self.irradiance * self.cross_section(),
            exit: self.exit(),
        })
    }

    #[inline]
    fn illuminate(&self, lit: &Point, _: [Real; 2]) -> Option<Illumination> {
        Some(Illumination {
            point: Point::distant(lit.position - self.direction * (2.0 * self.radius), self.direction),
            direction: -self.direction,
            weight: self.irradiance,
            density: CERTAIN,
            exit: self.exit(),
        })
    }

    #[inline]
    fn emitted(&self, _: &Point, _: Vec3) -> Exit {
        self.exit()
    }

    #[inline]
    fn next_event_density(&self, _: &Point, _: &Point) -> EndDensity {
        CERTAIN
    }
}
