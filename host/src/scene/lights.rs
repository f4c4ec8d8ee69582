//! Every kind of light that a scene can have.

use std::sync::Arc;

use bidir_kernel::{
    Emission, EndDensity, Exit, Frame, Illumination, Light, Point, Real, Spectrum, Vec3,
    light::{AreaLight, EnvironmentLight, PointLight},
    math,
    real::PI,
};
use bidir_standard as standard;

use crate::scene::{description::EnvironmentImage, extent::LightExtent};

/// A light's name: its index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LightId(pub u32);

/// A light as it is kept.
#[derive(Clone, Debug)]
pub enum LightSource {
    /// On a shape.
    Area(AreaLight<LightExtent, standard::Area>),
    /// At a point, alike in every direction.
    Point(PointLight<standard::Isotropic>),
    /// At a point, in a cone.
    Spot(PointLight<standard::Spot>),
    /// Parallel.
    Directional(standard::Directional),
    /// From everywhere alike.
    Constant(EnvironmentLight<standard::Constant>),
    /// An image.
    Envmap(EnvironmentLight<EnvironmentTables>),
}

/// An environment's image with its sampling tables.
#[derive(Clone, Debug)]
pub struct EnvironmentTables {
    image: Arc<EnvironmentImage>,
    /// The image, scaled.
    texels: Vec<Spectrum>,
    rows: Vec<Real>,
    columns: Vec<Real>,
}

impl EnvironmentTables {
    /// Tables of an image whose radiance is multiplied by `scale`; `None` if the image has no pixel.
    pub fn new(image: Arc<EnvironmentImage>, scale: Real) -> Option<Self> {
        let (width, height) = (image.width as usize, image.height as usize);
        let texels: Vec<_> = image.texels.iter().map(|&texel| texel * scale).collect();
        let sizes = standard::Envmap::sizes(width, height);
        let (mut rows, mut columns) = (vec![0.0; sizes.rows], vec![0.0; sizes.columns]);
        standard::Envmap::fill(width, height, &texels, &mut rows, &mut columns).then_some(Self { image, texels, rows, columns })
    }

    fn profile(&self) -> Option<standard::Envmap<'_>> {
        standard::Envmap::new(self.image.width as usize, self.image.height as usize, &self.texels, &self.rows, &self.columns)
    }

    /// ∫ of the radiance over all directions, mean of the bands: cell by cell, as the image is interpolated.
    pub fn total(&self) -> Real {
        let (width, height) = (self.image.width as usize, self.image.height as usize);
        let rows = height.saturating_sub(1).max(1);
        let row_mean = |row: usize| {
            let texels = &self.texels[row.min(height - 1) * width..][..width];
            texels.iter().map(|texel| texel.mean()).sum::<Real>() / width as Real
        };
        let cells = (0..rows).map(|row| 0.5 * (row_mean(row) + row_mean(row + 1)) * math::sin((row as Real + 0.5) / rows as Real * PI));
        cells.sum::<Real>() / rows as Real * PI * 2.0 * PI
    }
}

/// A light as a path asks it.
#[derive(Clone, Copy, Debug)]
pub enum SceneLight<'a> {
    /// On a shape.
    Area(AreaLight<&'a LightExtent, standard::Area>),
    /// At a point, alike in every direction.
    Point(PointLight<standard::Isotropic>),
    /// At a point, in a cone.
    Spot(PointLight<standard::Spot>),
    /// Parallel.
    Directional(standard::Directional),
    /// From everywhere alike.
    Constant(EnvironmentLight<standard::Constant>),
    /// An image.
    Envmap(EnvironmentLight<standard::Envmap<'a>>),
}

impl LightSource {
    /// The light as a path asks it.
    #[inline]
    pub fn asked(&self) -> SceneLight<'_> {
        match self {
            Self::Area(light) => SceneLight::Area(AreaLight { extent: &light.extent, profile: light.profile }),
            Self::Point(light) => SceneLight::Point(*light),
            Self::Spot(light) => SceneLight::Spot(*light),
            Self::Directional(light) => SceneLight::Directional(*light),
            Self::Constant(light) => SceneLight::Constant(*light),
            Self::Envmap(light) => match light.profile.profile() {
                Some(profile) => {
                    SceneLight::Envmap(EnvironmentLight { center: light.center, radius: light.radius, frame: light.frame, profile })
                }
                // Tables are only ever made to fit; an environment without any is black.
                None => SceneLight::Constant(EnvironmentLight {
                    center: light.center,
                    radius: light.radius,
                    frame: light.frame,
                    profile: standard::Constant { radiance: Spectrum::BLACK },
                }),
            },
        }
    }

    /// Power in W, mean of the bands: what a light walk chooses by. f64, since areas and radiances near the ends of f32 multiply.
    pub fn power(&self) -> f64 {
        let pi = std::f64::consts::PI;
        let disk = |radius: Real| pi * f64::from(radius) * f64::from(radius);
        match self {
            Self::Area(light) => pi * f64::from(light.extent.area()) * f64::from(light.profile.radiance.mean()),
            Self::Point(light) => 4.0 * pi * f64::from(light.profile.intensity.mean()),
            Self::Spot(light) => {
                let spot = &light.profile;
                let half = 0.5 * (spot.cutoff + spot.beam_width);
                2.0 * pi * f64::from(1.0 - math::cos(half)) * f64::from(spot.intensity.mean())
            }
            Self::Directional(light) => disk(light.radius) * f64::from(light.irradiance.mean()),
            Self::Constant(light) => disk(light.radius) * 4.0 * pi * f64::from(light.profile.radiance.mean()),
            Self::Envmap(light) => disk(light.radius) * f64::from(light.profile.total()),
        }
    }
}

macro_rules! of_light {
    ($self:ident, $light:ident => $call:expr) => {
        match $self {
            SceneLight::Area($light) => $call,
            SceneLight::Point($light) => $call,
            SceneLight::Spot($light) => $call,
            SceneLight::Directional($light) => $call,
            SceneLight::Constant($light) => $call,
            SceneLight::Envmap($light) => $call,
        }
    };
}

impl Light for SceneLight<'_> {
    #[inline]
    fn emit(&self, u: [Real; 4]) -> Option<Emission> {
        of_light!(self, light => light.emit(u))
    }

    #[inline]
    fn illuminate(&self, lit: &Point, u: [Real; 2]) -> Option<Illumination> {
        of_light!(self, light => light.illuminate(lit, u))
    }

    #[inline]
    fn emitted(&self, at: &Point, toward: Vec3) -> Exit {
        of_light!(self, light => light.emitted(at, toward))
    }

    #[inline]
    fn next_event_density(&self, at: &Point, lit: &Point) -> EndDensity {
        of_light!(self, light => light.next_event_density(at, lit))
    }
}

/// The frame of an environment: z is up (Mitsuba's local y), x is Mitsuba's local x.
pub fn environment_frame(x: Vec3, y: Vec3, z: Vec3) -> Frame {
    Frame { x, y: -z, z: y }
}
