//! A scene as it was written down: plain data, in f64 and in the file's own coordinates, before anything is built from it.

mod aov;
mod material;
mod mesh;

use std::sync::Arc;

use bidir_kernel::Spectrum;
use glam::{DAffine3, DVec2, DVec3};

pub use self::aov::{Aov, Quantity, Words};
pub use self::material::{
    Bending, Bitmap, Distribution, Material, MaterialId, NormalMap, PluginShader, Principled, Texture, TexturedParameter, UvTransform, Wrap,
};
pub use self::mesh::{Attribute, Mesh, Per};
use crate::error::Place;

/// Everything a scene file says.
#[derive(Clone, Debug)]
pub struct Description {
    /// The camera.
    pub sensor: Sensor,
    /// What it exposes.
    pub film: FilmSettings,
    /// How far paths go.
    pub integrator: Integrator,
    /// Samples per pixel that the scene's sampler asks for.
    pub samples_per_pixel: u32,
    /// The scene's seed; 0 unless its sampler says so.
    pub seed: u64,
    /// Surfaces, named by their index.
    pub materials: Vec<Material>,
    /// Geometry.
    pub shapes: Vec<Shape>,
    /// Geometry that only its instances show. A group's instances are of groups that stand before it.
    pub groups: Vec<Arc<Group>>,
    /// Where groups stand.
    pub instances: Vec<Instance>,
    /// Lights that are not on a shape.
    pub emitters: Vec<Emitter>,
}

impl Description {
    /// The shapes of the scene, and of every group once.
    pub fn all_shapes(&self) -> impl Iterator<Item = &Shape> {
        self.shapes.iter().chain(self.groups.iter().flat_map(|group| &group.shapes))
    }

    /// How many triangles and other shapes trees are built over; those of a group once.
    pub fn primitives(&self) -> usize {
        let sizes = self.all_shapes().map(|shape| match &shape.geometry {
            Geometry::Mesh { mesh, .. } => mesh.triangles.len(),
            _ => 1,
        });
        sizes.sum::<usize>()
    }
}

/// The scene's integrator. Which techniques run is not its to say.
#[derive(Clone, Debug)]
pub struct Integrator {
    /// The `type` as written.
    pub kind: String,
    /// The longest path, in segments; `None` is unlimited.
    pub max_depth: Option<u32>,
    /// The length at which Russian roulette begins.
    pub rr_depth: u32,
    /// Whether the lens sees through emitters.
    pub hide_emitters: bool,
    /// Layers that are asked for beside the picture.
    pub aovs: Vec<Aov>,
}

impl Default for Integrator {
    fn default() -> Self {
        Self { kind: "path".into(), max_depth: None, rr_depth: 5, hide_emitters: false, aovs: Vec::new() }
    }
}

/// The camera.
#[derive(Clone, Debug)]
pub struct Sensor {
    /// What kind of camera.
    pub kind: SensorKind,
    /// Camera → world: x to the image's left, y up, z into the scene.
    pub to_world: DAffine3,
    /// Where the optical axis meets the film, as a fraction of the image relative to its middle (Mitsuba's `principal_point_offset_x`, `_y`).
    pub principal_point_offset: DVec2,
    /// Acts only where the scene says so.
    pub near_clip: Option<f64>,
    /// Acts only where the scene says so.
    pub far_clip: Option<f64>,
    /// Where it stands in the file.
    pub place: Place,
}

/// Kinds of camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SensorKind {
    /// A pinhole, or a thin lens if the radius is above 0.
    Perspective {
        /// Horizontal field of view in degrees, already turned to the x axis from whatever axis was given.
        fov_x: f64,
        /// In world units.
        aperture_radius: f64,
        /// Distance of the plane in focus.
        focus_distance: f64,
    },
    /// Parallel rays; the image's width spans −1 … 1 before `to_world`.
    Orthographic,
}

/// The film.
#[derive(Clone, Debug)]
pub struct FilmSettings {
    /// The whole image, in pixels.
    pub width: u32,
    /// The whole image, in pixels.
    pub height: u32,
    /// What is rendered of it.
    pub crop: Crop,
    /// The reconstruction filter.
    pub filter: Filter,
}

/// A window of the image, in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crop {
    /// Left edge.
    pub x: u32,
    /// Upper edge.
    pub y: u32,
    /// At least 1.
    pub width: u32,
    /// At least 1.
    pub height: u32,
}

/// Reconstruction filters, as Mitsuba defines them; radii in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Filter {
    /// 1 within half a pixel.
    Box,
    /// Falls linearly to 0 at the radius.
    Tent {
        /// Where it ends.
        radius: f64,
    },
    /// max(0, exp(−x²/2σ²) − exp(−r²/2σ²)) with r = 4σ.
    Gaussian {
        /// σ, in pixels.
        stddev: f64,
    },
    /// Mitchell and Netravali's (1988), with radius 2 and negative lobes: B = C = 1/3 is theirs, B = 0 and C = 1/2 Catmull and Rom's.
    Cubic {
        /// How blurred.
        b: f64,
        /// How much it rings.
        c: f64,
    },
    /// sinc(x) sinc(x/n) with a radius of n, and negative lobes.
    Lanczos {
        /// n.
        lobes: f64,
    },
}

/// A shape, its surface and its light.
#[derive(Clone, Debug)]
pub struct Shape {
    /// The surface's form.
    pub geometry: Geometry,
    /// What it is made of.
    pub material: MaterialId,
    /// The light on it.
    pub light: Option<ShapeLight>,
    /// Its id, or its type where it has none; for messages.
    pub name: String,
    /// Where it stands in the file.
    pub place: Place,
}

/// A group's name: its index in [`Description::groups`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct GroupId(pub u32);

/// Geometry with coordinates of its own.
#[derive(Clone, Debug)]
pub struct Group {
    /// None of them shines.
    pub shapes: Vec<Shape>,
    /// Groups within this one.
    pub instances: Vec<Instance>,
    /// Where it stands in the file.
    pub place: Place,
}

/// A group that stands somewhere, perhaps among many of the same.
#[derive(Clone, Debug)]
pub struct Instance {
    /// Which group.
    pub group: GroupId,
    /// The group's coordinates → the world, or the group that this stands in.
    pub to_world: DAffine3,
    /// Where it stands in the file.
    pub place: Place,
}

/// What leaves every point of a shape.
#[derive(Clone, Debug)]
pub enum ShapeLight {
    /// The same radiance in every direction of the side that it faces, W/(m² sr); perhaps another one from place to place.
    Area(Texture),
    /// What a plugin says.
    Plugin(PluginShader),
}

impl ShapeLight {
    /// Whether it can be seen at all, as far as the scene says.
    pub fn is_black(&self) -> bool {
        matches!(self, Self::Area(radiance) if radiance.mean().is_black())
    }
}

/// Forms, in their own coordinates.
#[derive(Clone, Debug)]
pub enum Geometry {
    /// Triangles.
    Mesh {
        /// The triangles.
        mesh: Arc<Mesh>,
        /// Local → world.
        to_world: DAffine3,
        /// Whether normals point the other way.
        flip_normals: bool,
    },
    /// −1 … 1 in x and y, normal +z, uv 0 … 1.
    Rectangle {
        /// Local → world.
        to_world: DAffine3,
        /// Whether its normal points the other way.
        flip_normals: bool,
    },
    /// Radius 1 in x and y, normal +z; u is the radius, v the angle.
    Disk {
        /// Local → world.
        to_world: DAffine3,
        /// Whether its normal points the other way.
        flip_normals: bool,
    },
    /// A sphere about `center`, before `to_world` (rotation, uniform scale, translation, mirroring).
    Sphere {
        /// Local.
        center: DVec3,
        /// Local.
        radius: f64,
        /// Local → world.
        to_world: DAffine3,
        /// Whether its normals point inwards.
        flip_normals: bool,
    },
    /// The side of a cylinder between two points, normals outwards.
    Cylinder {
        /// Local.
        p0: DVec3,
        /// Local.
        p1: DVec3,
        /// Local.
        radius: f64,
        /// Local → world.
        to_world: DAffine3,
        /// Whether its normals point inwards.
        flip_normals: bool,
    },
}

/// Lights that are not on a shape.
#[derive(Clone, Debug)]
pub struct Emitter {
    /// Which light.
    pub kind: EmitterKind,
    /// Where it stands in the file.
    pub place: Place,
}

/// Kinds of light.
#[derive(Clone, Debug)]
pub enum EmitterKind {
    /// The same intensity in every direction.
    Point {
        /// In the world.
        position: DVec3,
        /// W/sr.
        intensity: Spectrum,
    },
    /// A cone along z that falls off linearly from `beam_width` to `cutoff_angle`.
    Spot {
        /// Local → world.
        to_world: DAffine3,
        /// W/sr on the axis.
        intensity: Spectrum,
        /// In degrees, half the cone.
        cutoff_angle: f64,
        /// In degrees, half the cone.
        beam_width: f64,
    },
    /// Parallel light.
    Directional {
        /// Which way it travels, in the world; any length but 0.
        direction: DVec3,
        /// W/m² perpendicular to it.
        irradiance: Spectrum,
    },
    /// The same radiance from everywhere.
    Constant {
        /// W/(m² sr).
        radiance: Spectrum,
    },
    /// An image of the surroundings.
    Envmap {
        /// Latitude and longitude.
        image: Arc<EnvironmentImage>,
        /// Multiplies the image.
        scale: f64,
        /// Local → world; up is y.
        to_world: DAffine3,
    },
    /// A plugin at a point; z is its axis.
    PluginPoint {
        /// Local → world.
        to_world: DAffine3,
        /// What it sends where.
        shader: PluginShader,
    },
    /// A plugin all around.
    PluginEnvironment {
        /// Local → world; up is y.
        to_world: DAffine3,
        /// What it sends where.
        shader: PluginShader,
    },
}

impl EmitterKind {
    /// Whether rays that escape land on it.
    pub fn is_environment(&self) -> bool {
        matches!(self, Self::Constant { .. } | Self::Envmap { .. } | Self::PluginEnvironment { .. })
    }
}

/// Pixels of an environment, linear, finite and not negative.
#[derive(Clone, Debug)]
pub struct EnvironmentImage {
    /// In pixels.
    pub width: u32,
    /// In pixels.
    pub height: u32,
    /// Rows from the top.
    pub texels: Vec<Spectrum>,
}
