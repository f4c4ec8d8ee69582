//! Whose a primitive is, and groups: geometry that instances show, kept once.

use std::{ops::Range, sync::Arc};

use glam::DVec3;

use super::description;
use crate::rays::{Bounds, Bvh, Geometry as _};

/// Whose a primitive of a tree is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Owner {
    /// The number of a shape among the tree's, or of a group.
    pub of: u32,
    /// Its number among the shape's triangles; [`INSTANCE`] for an instance.
    part: u32,
}

/// No mesh has that many triangles.
const INSTANCE: u32 = u32::MAX;

impl Owner {
    pub fn shape(shape: u32, triangle: u32) -> Self {
        Self { of: shape, part: triangle }
    }

    pub fn instance(group: u32) -> Self {
        Self { of: group, part: INSTANCE }
    }

    /// Its number among the shape's triangles; `None` for an instance.
    #[inline(always)]
    pub fn triangle(self) -> Option<u32> {
        (self.part != INSTANCE).then_some(self.part)
    }
}

/// What a scene keeps of a group.
#[derive(Clone, Debug)]
pub(super) struct Group {
    /// What it was built from.
    pub source: Arc<description::Group>,
    /// About `origin`.
    pub geometry: Arc<Bvh>,
    /// Of each primitive; shapes count from the first of the group's.
    pub owners: Arc<[Owner]>,
    /// The group's among the scene's shapes.
    pub shapes: Range<u32>,
    /// Of the tree's coordinates, in the group's.
    pub origin: DVec3,
    /// Shapes without area, dropped.
    pub degenerate: usize,
}

impl Group {
    /// Of what is in it, about `origin`.
    pub fn bounds(&self) -> Bounds {
        self.geometry.bounds()
    }
}
