//! Boxes along the axes.

use bidir_kernel::Vec3;
use glam::DVec3;

/// A closed box along the axes of the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The corner with the smallest coordinates.
    pub min: Vec3,
    /// The corner with the largest coordinates.
    pub max: Vec3,
}

impl Bounds {
    /// The box of nothing: the least of anything joined to it.
    pub const EMPTY: Self = Self { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    /// The box of some points.
    pub fn of(points: &[Vec3]) -> Self {
        points.iter().fold(Self::EMPTY, |all, &point| Self { min: all.min.min(point), max: all.max.max(point) })
    }

    /// The box centre ± half, rounded outwards.
    pub(super) fn around(centre: DVec3, half: DVec3) -> Self {
        let (low, high) = (centre - half, centre + half);
        let down = |x: f64| (x as f32).next_down();
        let up = |x: f64| (x as f32).next_up();
        Self { min: Vec3::new(down(low.x), down(low.y), down(low.z)), max: Vec3::new(up(high.x), up(high.y), up(high.z)) }
    }

    /// The box of both.
    pub fn join(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Whether nothing is inside, not even a point.
    pub fn is_empty(&self) -> bool {
        !(self.min.x <= self.max.x && self.min.y <= self.max.y && self.min.z <= self.max.z)
    }

    /// Per axis, how far the farthest side is from `point`; at least 0.
    #[inline(always)]
    pub fn reach(&self, point: Vec3) -> Vec3 {
        let reach = |min: f32, max: f32, at: f32| larger(larger(max - at, at - min), 0.0);
        Vec3::new(reach(self.min.x, self.max.x, point.x), reach(self.min.y, self.max.y, point.y), reach(self.min.z, self.max.z, point.z))
    }
}

/// The larger of two numbers, one instruction where neither is NaN; b where one is.
#[inline(always)]
pub(super) fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}
