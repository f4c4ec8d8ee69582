//! The scene: what was written down ([`description`]), and what paths meet ([`Scene`]).

mod build;
pub mod camera;
pub mod choice;
pub mod description;
pub mod extent;
pub mod lights;
pub mod outflow;
pub mod shape;
pub mod surface;
pub mod texture;
pub mod view;

use std::sync::Arc;

use crate::{
    plugin::Roster,
    rays::{BuildStats, Bvh},
};
use camera::SceneCamera;
use choice::Lights;
use shape::Shape;
use surface::Finish;

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
    roster: Arc<Roster>,
    hides_emitters: bool,
    degenerate: usize,
}

impl Scene {
    /// How many triangles and shapes without area were dropped.
    pub fn degenerate(&self) -> usize {
        self.degenerate
    }

    /// What building the tree took.
    pub fn build_stats(&self) -> BuildStats {
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
