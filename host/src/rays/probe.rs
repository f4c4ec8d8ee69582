//! A ray with everything computed that its box and triangle tests share.

use bidir_kernel::{Ray, Segment, Vec3};
use glam::DVec3;
use wide::f32x4;

use super::bounds::{Bounds, larger};

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
        let largest = larger(larger(d.x.abs(), d.y.abs()), d.z.abs());
        if !(finite && largest >= f32::MIN_POSITIVE && limit > 0.0) {
            return None;
        }

        let reach = bounds.reach(o);
        let slack = SLACK * larger(larger(reach.x, reach.y), reach.z);
        if !slack.is_finite() {
            return None;
        }
        let (origin, direction) = (o, d);
        let (o, d) = (o.to_array(), d.to_array());
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
            inverse: d.map(|d| (1.0 / d).clamp(-FLAT, FLAT)),
        };
        for (axis, origin) in o.into_iter().enumerate() {
            // Always more than half a step of the origin, or adding it would do nothing; and two roundings of origin · inverse.
            let wide = slack + 4.0 * U * origin.abs();
            let out = wide.copysign(d[axis]);
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

/// What of a ray meets triangles without leaks: a shear that turns the ray into the z axis, once axes are permuted so that the
/// direction's largest component comes last.
pub(super) struct Shear {
    pub axes: [usize; 3],
    /// The origin in permuted axes.
    pub apex: [f32x4; 3],
    /// d_x / d_z, d_y / d_z and 1 / d_z in permuted axes: x − shear·z turns the ray into the z axis.
    pub shear: [f32x4; 3],
    /// |d_z| in permuted axes.
    pub depth: f32x4,
}

impl Shear {
    #[inline(always)]
    pub fn new(probe: &Probe) -> Self {
        let (o, d) = (probe.origin.to_array(), probe.direction.to_array());
        let [x, y, z] = d.map(f32::abs);
        let (of_two, longer) = if x > y { (0, x) } else { (1, y) };
        let (last, largest) = if longer > z { (of_two, longer) } else { (2, z) };
        let after = |axis: usize| if axis == 2 { 0 } else { axis + 1 };
        let axes = [after(last), after(after(last)), last];
        let inverse = probe.inverse[last];
        Self {
            axes,
            apex: axes.map(|axis| f32x4::splat(o[axis])),
            shear: [d[axes[0]] * inverse, d[axes[1]] * inverse, inverse].map(f32x4::splat),
            depth: f32x4::splat(largest),
        }
    }
}
