//! Every kind of light that a scene can have: a profile (what is sent where) on a shape, at a point or all around, or parallel rays.

use std::sync::Arc;

use bidir_kernel::{
    Emission, Emitted, EndDensity, Exit, Frame, Illumination, Light, Point, Profile, Real, Spectrum, Vec2, Vec3,
    light::{AreaLight, EnvironmentLight, PointLight},
    math,
    profile::Profiled,
    real::PI,
};
use bidir_standard as standard;

use crate::{
    plugin::{Sandbox, ShaderId},
    scene::{
        description::{EnvironmentImage, Texture, TexturedParameter},
        extent::LightExtent,
        outflow::Outflow,
        painted::{Cells, Painted},
        surface::set_textured,
    },
};

/// A light's name: its index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LightId(pub u32);

/// A light as it is kept.
#[derive(Clone, Debug)]
pub struct LightSource {
    /// Where it shines from.
    pub seat: Seat,
    /// What it sends where.
    pub profile: ProfileSource,
    /// How much that is.
    pub outflow: Outflow,
}

/// Where a light shines from.
#[derive(Clone, Debug)]
pub enum Seat {
    /// Every point of a shape.
    Shape(LightExtent),
    /// One point.
    Point {
        /// In the world.
        position: Vec3,
        /// z is the profile's axis.
        frame: Frame,
    },
    /// All around.
    Environment {
        /// Of a sphere that holds the whole scene.
        center: Vec3,
        /// Of that sphere.
        radius: Real,
        /// z is up.
        frame: Frame,
    },
    /// Infinitely far away in one direction; it has no profile to speak of.
    Directional(standard::Directional),
}

/// What a light sends where, as it is kept.
#[derive(Clone, Debug)]
pub enum ProfileSource {
    /// The same radiance in every direction of a hemisphere.
    Area(standard::Area),
    /// The same in every direction of a hemisphere, and from place to place as a texture says.
    Textured(TexturedArea),
    /// The same intensity in every direction.
    Isotropic(standard::Isotropic),
    /// A cone.
    Spot(standard::Spot),
    /// The same radiance from everywhere.
    Constant(standard::Constant),
    /// An image.
    Envmap(EnvironmentTables),
    /// A module's.
    Plugin(PluginProfile),
}

/// Radiance that a texture decides.
#[derive(Clone, Debug)]
pub struct TexturedArea {
    radiance: Texture,
    /// How a rectangle is sampled.
    cells: Option<Cells>,
}

impl TexturedArea {
    /// With a radiance in W/(m² sr), on such a shape.
    pub fn new(radiance: Texture, extent: &LightExtent) -> Self {
        let rectangle = matches!(extent, LightExtent::Parallelogram(_));
        Self { cells: rectangle.then(|| Cells::of(&radiance)).flatten(), radiance }
    }
}

/// A module's emission profile.
#[derive(Clone, Debug)]
pub struct PluginProfile {
    /// In the scene's roster.
    pub id: ShaderId,
    /// The parameters that vary over the shape.
    pub textures: Vec<TexturedParameter>,
    /// What scenes call the module.
    pub name: String,
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

/// A profile as a path asks it.
#[derive(Clone, Copy, Debug)]
pub enum SceneProfile<'a> {
    /// The same radiance in every direction of a hemisphere.
    Area(standard::Area),
    /// The same in every direction of a hemisphere, and from place to place as a texture says.
    Textured(&'a Texture),
    /// The same intensity in every direction.
    Isotropic(standard::Isotropic),
    /// A cone.
    Spot(standard::Spot),
    /// The same radiance from everywhere.
    Constant(standard::Constant),
    /// An image.
    Envmap(standard::Envmap<'a>),
    /// A module's, in this thread's sandbox.
    Plugin(&'a PluginProfile, &'a Sandbox),
}

impl ProfileSource {
    /// The profile as a path asks it.
    #[inline]
    pub fn asked<'a>(&'a self, sandbox: &'a Sandbox) -> SceneProfile<'a> {
        match self {
            Self::Area(profile) => SceneProfile::Area(*profile),
            Self::Textured(profile) => SceneProfile::Textured(&profile.radiance),
            Self::Isotropic(profile) => SceneProfile::Isotropic(*profile),
            Self::Spot(profile) => SceneProfile::Spot(*profile),
            Self::Constant(profile) => SceneProfile::Constant(*profile),
            // Tables are only ever made to fit; an environment without any is black.
            Self::Envmap(tables) => {
                tables.profile().map_or(SceneProfile::Constant(standard::Constant { radiance: Spectrum::BLACK }), SceneProfile::Envmap)
            }
            Self::Plugin(profile) => SceneProfile::Plugin(profile, sandbox),
        }
    }
}

macro_rules! of_profile {
    ($self:ident, $uv:ident, $profile:ident => $call:expr) => {
        match $self {
            SceneProfile::Area($profile) => $call,
            SceneProfile::Textured(radiance) => {
                let $profile = standard::Area { radiance: radiance.at($uv) };
                $call
            }
            SceneProfile::Isotropic($profile) => $call,
            SceneProfile::Spot($profile) => $call,
            SceneProfile::Constant($profile) => $call,
            SceneProfile::Envmap($profile) => $call,
            SceneProfile::Plugin(plugin, sandbox) => {
                set_textured(sandbox, plugin.id, &plugin.textures, $uv);
                let $profile = sandbox.profile(plugin.id);
                $call
            }
        }
    };
}

impl Profile for SceneProfile<'_> {
    #[inline]
    fn eval(&self, uv: Vec2, direction: Vec3) -> Profiled {
        of_profile!(self, uv, profile => profile.eval(uv, direction))
    }

    #[inline]
    fn emit(&self, uv: Vec2, u: [Real; 2]) -> Option<Emitted> {
        of_profile!(self, uv, profile => profile.emit(uv, u))
    }
}

/// A light as a path asks it.
#[derive(Clone, Copy, Debug)]
pub enum SceneLight<'a> {
    /// On a shape.
    Area(AreaLight<&'a LightExtent, SceneProfile<'a>>),
    /// On a rectangle that is not alike all over.
    Painted(AreaLight<Painted<'a>, SceneProfile<'a>>),
    /// At a point.
    Point(PointLight<SceneProfile<'a>>),
    /// All around.
    Environment(EnvironmentLight<SceneProfile<'a>>),
    /// Parallel.
    Directional(standard::Directional),
}

impl LightSource {
    /// A light with a profile, and how much that sends: whoever asks a plugin for that asks it in `sandbox`.
    pub fn new(seat: Seat, profile: ProfileSource, sandbox: &Sandbox) -> Self {
        let outflow = match (&seat, &profile) {
            (Seat::Directional(light), _) => Outflow { total: f64::from(light.irradiance.mean()), ..Outflow::NONE },
            (_, ProfileSource::Textured(area)) => Outflow::of(&standard::Area { radiance: area.radiance.mean() }),
            (_, ProfileSource::Envmap(tables)) => Outflow { total: f64::from(tables.total()), ..Outflow::NONE },
            _ => Outflow::of(&profile.asked(sandbox)),
        };
        let seat = match seat {
            Seat::Shape(extent) if outflow.both_sides => Seat::Shape(extent.shining_both_ways()),
            other => other,
        };
        Self { seat, profile, outflow }
    }

    /// The light as a path asks it.
    #[inline]
    pub fn asked<'a>(&'a self, sandbox: &'a Sandbox) -> SceneLight<'a> {
        match &self.seat {
            Seat::Shape(LightExtent::Parallelogram(extent))
                if let ProfileSource::Textured(TexturedArea { radiance, cells: Some(cells) }) = &self.profile =>
            {
                SceneLight::Painted(AreaLight { extent: Painted { extent, cells }, profile: SceneProfile::Textured(radiance) })
            }
            Seat::Shape(extent) => SceneLight::Area(AreaLight { extent, profile: self.profile.asked(sandbox) }),
            Seat::Point { position, frame } => {
                SceneLight::Point(PointLight { position: *position, frame: *frame, profile: self.profile.asked(sandbox) })
            }
            Seat::Environment { center, radius, frame } => SceneLight::Environment(EnvironmentLight {
                center: *center,
                radius: *radius,
                frame: *frame,
                profile: self.profile.asked(sandbox),
            }),
            Seat::Directional(light) => SceneLight::Directional(*light),
        }
    }

    /// Power in W, mean of the bands: what a light walk chooses by. f64, since areas and radiances near the ends of f32 multiply.
    pub fn power(&self) -> f64 {
        let disk = |radius: Real| std::f64::consts::PI * f64::from(radius) * f64::from(radius);
        match &self.seat {
            Seat::Shape(extent) => f64::from(extent.area()) * self.outflow.exitance,
            Seat::Point { .. } => self.outflow.total,
            Seat::Environment { radius, .. } => disk(*radius) * self.outflow.total,
            Seat::Directional(light) => disk(light.radius) * self.outflow.total,
        }
    }

    /// What scenes call it.
    pub fn kind(&self) -> &str {
        match (&self.seat, &self.profile) {
            (Seat::Directional(_), _) => "directional",
            (_, ProfileSource::Area(_) | ProfileSource::Textured(_)) => "area",
            (_, ProfileSource::Isotropic(_)) => "point",
            (_, ProfileSource::Spot(_)) => "spot",
            (_, ProfileSource::Constant(_)) => "constant",
            (_, ProfileSource::Envmap(_)) => "envmap",
            (_, ProfileSource::Plugin(plugin)) => &plugin.name,
        }
    }
}

macro_rules! of_light {
    ($self:ident, $light:ident => $call:expr) => {
        match $self {
            SceneLight::Area($light) => $call,
            SceneLight::Painted($light) => $call,
            SceneLight::Point($light) => $call,
            SceneLight::Environment($light) => $call,
            SceneLight::Directional($light) => $call,
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
