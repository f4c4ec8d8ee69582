//! The scene: what was written down ([`description`]), and what paths meet ([`Scene`]).

mod build;
pub mod camera;
pub mod description;
pub mod extent;
pub mod lights;
pub mod shape;
pub mod surface;
pub mod texture;

use bidir_kernel::{Chance, Point, Ray, Real, Segment};

use crate::rays::{BuildStats, Bvh, Geometry};
use camera::SceneCamera;
use lights::{LightId, Lights, SceneLight};
use shape::Shape;
use surface::{Finish, Surface};

/// A scene ready to be rendered; its coordinates are the file's, moved to the scene's own centre.
#[derive(Debug)]
pub struct Scene {
    camera: SceneCamera,
    geometry: Bvh,
    /// Of each primitive: its shape, and its number among the shape's triangles.
    owners: Vec<(u32, u32)>,
    shapes: Vec<Shape>,
    finishes: Vec<Finish>,
    lights: Lights,
    hides_emitters: bool,
    degenerate: usize,
}

impl Scene {
    /// How many triangles and shapes without area were dropped.
    pub fn degenerate(&self) -> usize {
        self.degenerate
    }

    /// What building the tree took.
    pub fn build_stats(&self) -> &BuildStats {
        self.geometry.stats()
    }

    /// The lights.
    pub fn all_lights(&self) -> &Lights {
        &self.lights
    }

    /// The shapes.
    pub fn shapes(&self) -> &[Shape] {
        &self.shapes
    }

    /// The finish of a shape.
    pub fn finish_of(&self, shape: &Shape) -> &Finish {
        &self.finishes[shape.finish as usize]
    }
}

/// A ray's end: the shape it met.
#[derive(Clone, Copy, Debug)]
pub struct Hit {
    shape: u32,
}

impl bidir_kernel::Scene for Scene {
    type Hit = Hit;
    type LightId = LightId;
    type Camera = SceneCamera;
    type Bsdf<'a> = Surface;
    type Light<'a> = SceneLight<'a>;

    #[inline]
    fn camera(&self) -> &SceneCamera {
        &self.camera
    }

    #[inline]
    fn intersect(&self, ray: &Ray) -> Option<(Point, Hit)> {
        let hit = self.geometry.closest(ray)?;
        let at = self.geometry.surface(ray, &hit);
        let (shape, triangle) = self.owners[hit.primitive.0 as usize];
        Some((self.shapes[shape as usize].point(&at, triangle), Hit { shape }))
    }

    #[inline]
    fn unoccluded(&self, a: &Point, b: &Point, segment: Segment) -> bool {
        !self.geometry.occluded(&Ray::between(a, b, segment))
    }

    #[inline]
    fn bsdf(&self, point: &Point, hit: Hit) -> Surface {
        self.finishes[self.shapes[hit.shape as usize].finish as usize].at(point.uv)
    }

    #[inline]
    fn light(&self, id: LightId) -> SceneLight<'_> {
        self.lights.get(id)
    }

    #[inline]
    fn light_id_at(&self, hit: Hit) -> Option<LightId> {
        self.shapes[hit.shape as usize].light
    }

    #[inline]
    fn environment(&self) -> Option<LightId> {
        self.lights.environment()
    }

    #[inline]
    fn pick_light(&self, lit: Option<&Point>, u: Real) -> Option<(LightId, Chance)> {
        self.lights.pick(lit, u)
    }

    #[inline]
    fn light_chance(&self, id: LightId, lit: Option<&Point>) -> Chance {
        self.lights.chance(id, lit)
    }

    #[inline]
    fn hides_emitters(&self) -> bool {
        self.hides_emitters
    }
}
