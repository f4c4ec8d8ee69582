//! The scene: what was written down ([`description`]), and what paths meet ([`Scene`]).

mod build;
pub mod camera;
mod centre;
pub mod choice;
mod collection;
pub mod description;
pub mod extent;
mod group;
pub mod lights;
pub mod outflow;
pub mod painted;
pub mod plain;
pub mod preset;
pub mod shape;
pub mod surface;
pub mod texture;
pub mod view;

use std::sync::Arc;

use bidir_kernel::{Effects, Frame, Point, Ray};
use glam::DVec3;

use crate::{
    plugin::Roster,
    rays::{BuildStats, Bvh, Geometry as _, RayHit, Triangles},
};
use camera::SceneCamera;
use choice::Lights;
use description::GroupId;
use group::{Group, Owner};
use shape::{Shape, in_parts};
use surface::{Detail, Finish};
use texture::Face;

/// A scene ready to be rendered; its coordinates are the file's, moved to the scene's own centre.
#[derive(Debug)]
pub struct Scene {
    camera: SceneCamera,
    origin: DVec3,
    geometry: Bvh,
    /// Of each primitive of `geometry`.
    owners: Vec<Owner>,
    groups: Vec<Group>,
    /// Those that stand in no group, then each group's.
    shapes: Vec<Shape>,
    finishes: Vec<Finish>,
    lights: Lights,
    roster: Arc<Roster>,
    hides_emitters: bool,
    degenerate: usize,
    effects: Effects,
    plain: Option<plain::Parts>,
}

/// What a ray meets.
#[derive(Clone, Copy, Debug)]
pub struct Met {
    /// Where.
    pub point: Point,
    /// The number of its shape: those that stand in no group, then each group's.
    pub shape: u32,
    /// The number of the triangle in a mesh.
    pub triangle: u32,
    /// The number of its material.
    pub material: u32,
}

impl Scene {
    /// The same scene with triangles met in another way.
    pub fn with_triangles(self, triangles: Triangles) -> Self {
        Self { geometry: self.geometry.with_triangles(triangles), ..self }
    }

    /// The same scene with lights that receivers choose by power, as [`Lights::by_power`] has it.
    pub fn with_lights_by_power(self) -> Self {
        Self { lights: self.lights.by_power(), ..self }
    }

    /// The same scene, rendered as if these could occur as well: the image is the same, bit for bit.
    pub fn with_effects(self, effects: Effects) -> Self {
        Self { effects: self.effects | effects, ..self }
    }

    /// What sampling the scene may need of the kernel, whichever the techniques.
    pub fn effects(&self) -> Effects {
        self.effects
    }

    /// How many triangles and shapes without area were dropped.
    pub fn degenerate(&self) -> usize {
        self.degenerate
    }

    /// What building the trees took, added up, each group's once. Memory includes what tells whose a primitive is; the meshes'
    /// own vertices and indices come on top.
    pub fn build_stats(&self) -> BuildStats {
        let mut all = BuildStats { bytes: size_of_val(&*self.owners), ..BuildStats::default() };
        all += self.geometry.stats();
        for group in &self.groups {
            all += group.geometry.stats();
            all.bytes += size_of_val(&*group.owners);
        }
        all
    }

    /// Where the scene's coordinates begin, in the file's.
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// The outermost tree.
    pub fn geometry(&self) -> &Bvh {
        &self.geometry
    }

    /// The tree of a group, which is shared with scenes that were [rebuilt](Self::rebuilt) from this one or that this one was from.
    pub fn group(&self, id: GroupId) -> Option<&Arc<Bvh>> {
        self.groups.get(id.0 as usize).map(|group| &group.geometry)
    }

    /// The point of a hit that [`Self::geometry`] gave for this ray, and the number of its shape.
    #[inline]
    pub fn met(&self, ray: &Ray, hit: &RayHit) -> (Point, u32) {
        let owner = self.owners[hit.primitive.0 as usize];
        match owner.triangle() {
            Some(triangle) => (self.shapes[owner.of as usize].point(&self.geometry.surface(ray, hit), triangle), owner.of),
            None => self.met_in_instance(ray, hit, owner),
        }
    }

    /// What a ray meets first, with surface coordinates whether a material asks for them or not.
    pub fn first_met(&self, ray: &Ray) -> Option<Met> {
        let hit = self.geometry.closest(ray)?;
        let (owner, at) = (self.owners[hit.primitive.0 as usize], self.geometry.surface(ray, &hit));
        let (shape, triangle, point) = match owner.triangle() {
            Some(triangle) => (owner.of, triangle, self.shapes[owner.of as usize].point_in_full(&at, triangle, None)),
            None => {
                let (shape, triangle) = self.owner_in_instance(&hit, owner);
                let to_world = self.geometry.to_world(&hit).matrix3;
                (shape, triangle, self.shapes[shape as usize].point_in_full(&at, triangle, Some(&to_world)))
            }
        };
        Some(Met { point, shape, triangle, material: self.shapes[shape as usize].finish })
    }

    /// The same with the shape itself.
    #[inline(always)]
    fn met_shape(&self, ray: &Ray, hit: &RayHit) -> (Point, &Shape) {
        let owner = self.owners[hit.primitive.0 as usize];
        let Some(triangle) = owner.triangle() else {
            let (point, shape) = self.met_in_instance(ray, hit, owner);
            return (in_parts(&point), &self.shapes[shape as usize]);
        };
        let shape = &self.shapes[owner.of as usize];
        (shape.point(&self.geometry.surface(ray, hit), triangle), shape)
    }

    /// How coordinates lie on the surface at a hit, and where in its mesh it is; nothing unless its finish asks for that.
    #[inline(always)]
    fn detail(&self, ray: &Ray, hit: &RayHit, frame: &Frame, shape: &Shape) -> Detail {
        if shape.detailed { self.detail_of(ray, hit, frame, shape) } else { Detail::default() }
    }

    #[inline(never)]
    fn detail_of(&self, ray: &Ray, hit: &RayHit, frame: &Frame, shape: &Shape) -> Detail {
        let owner = self.owners[hit.primitive.0 as usize];
        let at = self.geometry.surface(ray, hit);
        let (triangle, stretch) = match owner.triangle() {
            Some(triangle) => (triangle, shape.stretch(&at, triangle, None, frame)),
            None => {
                let (_, triangle) = self.owner_in_instance(hit, owner);
                (triangle, shape.stretch(&at, triangle, Some(&self.geometry.to_world(hit).matrix3), frame))
            }
        };
        Detail { stretch, face: Face { triangle, b1: at.local.x, b2: at.local.y } }
    }

    #[inline(never)]
    fn met_in_instance(&self, ray: &Ray, hit: &RayHit, owner: Owner) -> (Point, u32) {
        let ((shape, triangle), to_world) = (self.owner_in_instance(hit, owner), self.geometry.to_world(hit).matrix3);
        (self.shapes[shape as usize].point_in_instance(&self.geometry.surface(ray, hit), triangle, &to_world), shape)
    }

    /// The shape that a ray met in an instance, and the number of the triangle within it.
    fn owner_in_instance(&self, hit: &RayHit, mut owner: Owner) -> (u32, u32) {
        let (mut triangle, mut first) = (0, 0);
        for inner in self.geometry.path(hit).skip(1) {
            let group = &self.groups[owner.of as usize];
            owner = group.owners[inner.0 as usize];
            (triangle, first) = (owner.triangle().unwrap_or(0), group.shapes.start);
        }
        (first + owner.of, triangle)
    }

    /// The lights.
    pub fn all_lights(&self) -> &Lights {
        &self.lights
    }

    /// The shapes: those that stand in no group, then each group's.
    pub fn shapes(&self) -> &[Shape] {
        &self.shapes
    }

    /// The finish of a shape.
    pub fn finish_of(&self, shape: &Shape) -> &Finish {
        &self.finishes[shape.finish as usize]
    }
}
