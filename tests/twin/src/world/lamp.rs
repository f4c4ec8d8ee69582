//! The lights as one type.

use super::{
    super::{
        kernel::{
            Emission, EndDensity, Exit, Frame, Illumination, Light, Point, Real, Spectrum, Vec3,
            light::{AreaLight, EnvironmentLight, PointLight},
            math::normalize,
        },
        standard::{Area, Constant, Directional, Isotropic, Spot},
    },
    drawn,
    extent::Patch,
    moved, number, turned, vector,
};
use crate::{
    nudge::Nudge,
    setting::{Lamp, Setting},
};

/// Any light.
#[derive(Clone, Copy, Debug)]
pub enum Source<'a> {
    Area(AreaLight<Patch<'a>, Area>),
    Point(PointLight<Isotropic>),
    Spot(PointLight<Spot>),
    Directional(Directional),
    Sky(EnvironmentLight<Constant>),
}

macro_rules! whichever {
    ($source:expr, $light:ident => $answer:expr) => {
        match $source {
            Source::Area($light) => $answer,
            Source::Point($light) => $answer,
            Source::Spot($light) => $answer,
            Source::Directional($light) => $answer,
            Source::Sky($light) => $answer,
        }
    };
}

impl<'a> Source<'a> {
    /// Lights are counted over the things first, then over the lamps.
    pub fn new(setting: &'a Setting, id: usize, nudge: &'a Nudge) -> Self {
        if let Some(thing) = setting.things.get(id) {
            let radiance = Spectrum::splat(number(thing.radiance));
            return Self::Area(AreaLight { extent: Patch { shape: &thing.shape, nudge }, profile: Area { radiance } });
        }
        let axis = |v: [f64; 3]| normalize(vector(v)).unwrap_or(Vec3::Z);
        let squared = setting.scale * setting.scale;
        let (center, radius) = (vector(setting.centre), number(setting.radius));
        match setting.lamps[id - setting.things.len()] {
            Lamp::Point(at) => Self::Point(PointLight {
                position: vector(at),
                frame: Frame::from_z(Vec3::Z),
                profile: Isotropic { intensity: Spectrum::splat(number(30.0 * squared)) },
            }),
            Lamp::Spot(at, along, cutoff) => Self::Spot(PointLight {
                position: vector(at),
                frame: Frame::from_z(axis(along)),
                profile: Spot::from_degrees(Spectrum::splat(number(60.0 * squared)), number(cutoff), -1.0),
            }),
            Lamp::Directional(along) => {
                Self::Directional(Directional { direction: axis(along), irradiance: Spectrum::splat(3.0), center, radius })
            }
            Lamp::Sky => {
                Self::Sky(EnvironmentLight { center, radius, frame: Frame::from_z(Vec3::Y), profile: Constant { radiance: Spectrum::ONE } })
            }
        }
    }
}

/// A light whose answers are rounded on their way.
#[derive(Clone, Copy, Debug)]
pub struct Watched<'a> {
    pub source: Source<'a>,
    pub nudge: &'a Nudge,
}

impl Watched<'_> {
    fn moved(&self, point: &Point) -> Point {
        Point { position: moved(self.nudge, point.position), normal: self.turned(point.normal), ..*point }
    }

    fn turned(&self, direction: Vec3) -> Vec3 {
        if direction == Vec3::ZERO { direction } else { turned(self.nudge, direction) }
    }
}

impl Light for Watched<'_> {
    fn emit(&self, u: [Real; 4]) -> Option<Emission> {
        let emission = whichever!(&self.source, light => light.emit(drawn(self.nudge, u)))?;
        Some(Emission { point: self.moved(&emission.point), direction: self.turned(emission.direction), ..emission })
    }

    fn illuminate(&self, lit: &Point, u: [Real; 2]) -> Option<Illumination> {
        let lit = self.moved(lit);
        let sampled = whichever!(&self.source, light => light.illuminate(&lit, drawn(self.nudge, u)))?;
        Some(Illumination { point: self.moved(&sampled.point), direction: self.turned(sampled.direction), ..sampled })
    }

    fn emitted(&self, at: &Point, toward: Vec3) -> Exit {
        whichever!(&self.source, light => light.emitted(&self.moved(at), self.turned(toward)))
    }

    fn next_event_density(&self, at: &Point, lit: &Point) -> EndDensity {
        whichever!(&self.source, light => light.next_event_density(&self.moved(at), &self.moved(lit)))
    }
}
