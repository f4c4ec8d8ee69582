//! A ray with everything computed that its box and triangle tests share.

use bidir_kernel::{Ray, Segment, Vec3};
use glam::DVec3;
use wide::f32x4;

use super::bounds::Bounds;

/// Half the distance from 1 to the next number: the relative error of one rounding.
const U: f32 = f32::EPSILON / 2.0;
/// How far rounding can move the ray a triangle test sees away from the ray a box test sees, in units of
/// U · the largest distance from the origin to anything, per axis: 1 for vertex − origin, 4 for the shear and 3 for
/// the slab, rounded up generously.
const SLACK: f32 = 12.0 * U;
/// The end of the ray is this much nearer than asked: four roundings.
const END: f32 = 1.0 - 4.0 * U;
/// Longer than any ray, and finite, so that 0 · inverse is 0 and not NaN.
const FLAT: f32 = f32::MAX;

pub(super) struct Probe {
    pub origin: Vec3,
    pub direction: Vec3,
    /// Hits are nearer than this.
    pub limit: f32,
    /// Whether the ray ends on the lens.
    pub lens: bool,
    /// Whether primitives that are hidden from the lens are passed.
    pub hide: bool,

    /// Whether box tests may multiply first and subtract then.
    pub fusible: bool,
    /// Per axis, whether the ray enters boxes at their maxima.
    pub backwards: [bool; 3],
    /// The origin, moved by the slack so that every box grows by it.
    pub near_origin: [f32; 3],
    pub far_origin: [f32; 3],
    pub inverse: [f32; 3],

    /// The axes permuted so that the direction's largest component comes last.
    pub axes: [usize; 3],
    /// The origin in permuted axes.
    pub apex: [f32x4; 3],
    /// d_x / d_z, d_y / d_z and 1 / d_z in permuted axes: x − shear·z turns the ray into the z axis.
    pub shear: [f32x4; 3],
    /// |d_z| in permuted axes.
    pub depth: f32x4,
}

impl Probe {
    /// `None` where the ray cannot hit anything in `bounds`, because it is not finite, has no direction or no length.
    #[inline(always)]
    pub fn new(ray: &Ray, bounds: &Bounds, some_hidden: bool) -> Option<Self> {
        Self::within(ray.origin, ray.direction, ray.t_max * END, ray.segment == Segment::Lens, bounds, some_hidden)
    }

    /// The same for a ray that ends before `limit`.
    #[inline(always)]
    pub fn within(o: Vec3, d: Vec3, limit: f32, lens: bool, bounds: &Bounds, some_hidden: bool) -> Option<Self> {
        // Each product is 0, or NaN where its factor is not finite.
        let finite = (o.x * 0.0 + o.y * 0.0 + o.z * 0.0) + (d.x * 0.0 + d.y * 0.0 + d.z * 0.0) == 0.0;
        let [x, y, z] = [d.x.abs(), d.y.abs(), d.z.abs()];
        let last = if x > y {
            if x > z { 0 } else { 2 }
        } else if y > z {
            1
        } else {
            2
        };
        let largest = x.max(y).max(z);
        if !(finite && largest >= f32::MIN_POSITIVE && limit > 0.0) {
            return None;
        }

        let reach = bounds.reach(o);
        let slack = SLACK * reach.x.max(reach.y).max(reach.z);
        if !slack.is_finite() {
            return None;
        }
        let inverse = [inverse(d.x), inverse(d.y), inverse(d.z)];
        let (origin, direction) = (o, d);
        let (o, d) = (o.to_array(), d.to_array());
        let axes = [[1, 2, 0], [2, 0, 1], [0, 1, 2]][last];
        let mut probe = Self {
            origin,
            direction,
            limit,
            lens,
            hide: some_hidden && lens,
            fusible: true,
            backwards: d.map(f32::is_sign_negative),
            near_origin: [0.0; 3],
            far_origin: [0.0; 3],
            inverse,
            axes,
            apex: axes.map(|axis| f32x4::splat(o[axis])),
            shear: [d[axes[0]] * inverse[last], d[axes[1]] * inverse[last], inverse[last]].map(f32x4::splat),
            depth: f32x4::splat(largest),
        };
        for (axis, origin) in o.into_iter().enumerate() {
            // Always more than half a step of the origin, or adding it would do nothing; and two roundings of origin · inverse.
            let wide = slack + 4.0 * U * origin.abs();
            let out = if probe.backwards[axis] { -wide } else { wide };
            probe.near_origin[axis] = origin + out;
            probe.far_origin[axis] = origin - out;
            // Where origin · inverse has no finite value, boxes are tested by (plane − origin) · inverse.
            let farthest = (origin.abs() + wide) * probe.inverse[axis].abs();
            probe.fusible &= farthest < f32::MAX;
        }
        Some(probe)
    }

    /// The origin and the direction, for tests that need f64.
    #[inline(always)]
    pub fn in_f64(&self) -> (DVec3, DVec3) {
        (self.origin.as_dvec3(), self.direction.as_dvec3())
    }
}

/// 1/d, finite also for d = 0.
#[inline(always)]
fn inverse(d: f32) -> f32 {
    let inverse = 1.0 / d;
    if inverse.abs() <= FLAT { inverse } else { FLAT.copysign(d) }
}
