//! A tree within another, placed by a transform.

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};

use super::{Geometry, bounds::Bounds, bvh::Bvh, probe::Probe};

/// How many instances may lie within each other.
pub const LEVELS: usize = 8;

/// Beyond this, squares and products of coordinates have no finite value.
const FARTHEST: f32 = 1e30;

/// Geometry that stands somewhere, perhaps among many of the same; the geometry itself is kept once.
#[derive(Clone, Debug)]
pub struct Instance {
    geometry: Arc<Bvh>,
    to_world: DAffine3,
    to_local: DAffine3,
}

impl Instance {
    /// `None` if the transform has no inverse or is not finite, if it holds [`LEVELS`] levels of instances already, if there is
    /// nothing in it, or if it would reach farther than 1e30.
    pub fn new(geometry: Arc<Bvh>, to_world: DAffine3) -> Option<Self> {
        let to_local = to_world.inverse();
        let whole = to_world.is_finite() && to_local.is_finite() && geometry.levels < LEVELS && !geometry.bounds().is_empty();
        let instance = whole.then_some(Self { geometry, to_world, to_local })?;
        let Bounds { min, max } = instance.bounds();
        // No comparison holds for NaN.
        (min.min_element() > -FARTHEST && max.max_element() < FARTHEST).then_some(instance)
    }

    /// What stands there.
    #[inline(always)]
    pub(super) fn geometry(&self) -> &Bvh {
        &self.geometry
    }

    /// Local → world.
    pub(super) fn placed(&self) -> DAffine3 {
        self.to_world
    }

    /// In the world.
    pub(super) fn bounds(&self) -> Bounds {
        let Bounds { min, max } = self.geometry.bounds();
        let (centre, half) = (0.5 * (min.as_dvec3() + max.as_dvec3()), 0.5 * (max.as_dvec3() - min.as_dvec3()));
        Bounds::around(self.to_world.transform_point3(centre), magnitudes(&self.to_world.matrix3) * half)
    }

    /// The ray as the instance sees it: distances are the same, in lengths of the direction, which is not unit there.
    #[inline(always)]
    pub(super) fn localized(&self, probe: &Probe) -> Option<Probe> {
        let (origin, direction) = probe.in_f64();
        let (origin, direction) = self.to_local(origin, direction);
        let within = &self.geometry;
        Probe::within(origin.as_vec3(), direction.as_vec3(), probe.limit, probe.lens, &within.bounds(), within.some_hidden)
    }

    /// A ray in the instance's coordinates.
    #[inline(always)]
    pub(super) fn to_local(&self, origin: DVec3, direction: DVec3) -> (DVec3, DVec3) {
        (self.to_local.transform_point3(origin), self.to_local.transform_vector3(direction))
    }

    /// A point, a unit normal, and how far rounding may have moved the point along each axis, in the world; `reach` is how far the
    /// world reaches from the point. A ray's direction is rounded in local coordinates, so a ray that comes from that far away
    /// may be off by as much as a rounding of its length there.
    pub(super) fn to_world(&self, position: DVec3, normal: DVec3, error: DVec3, reach: DVec3) -> (DVec3, DVec3, DVec3) {
        const U: f64 = f32::EPSILON as f64 / 2.0;
        let normal = self.to_local.matrix3.transpose() * normal;
        let direction = magnitudes(&self.to_local.matrix3) * reach * U;
        let error = magnitudes(&self.to_world.matrix3) * (error + direction);
        (self.to_world.transform_point3(position), normal.normalize_or(DVec3::Z), error)
    }
}

fn magnitudes(matrix: &DMat3) -> DMat3 {
    DMat3::from_cols(matrix.x_axis.abs(), matrix.y_axis.abs(), matrix.z_axis.abs())
}
