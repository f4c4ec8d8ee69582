//! Triangles, four at a time, without leaks between neighbours.
//!
//! The test of Woop, Benthin and Wald 2013, "Watertight Ray/Triangle Intersection": the ray is sheared into the z axis, the
//! signs of three 2D edge functions decide. A sign is exact given the sheared corners, and those depend on the ray
//! and the corner alone; so two triangles that share an edge always agree on which of them a ray passes.

use bidir_kernel::Vec3;
use glam::DVec3;
use wide::f32x4;

use super::{
    nearest::{Key, Nearest},
    probe::{Probe, Shear},
};

/// Three corners in the world; the normal is (b − a) × (c − a).
pub(super) type Triangle = [Vec3; 3];

/// How many triangles a leaf holds at most.
pub(super) const PACKET: usize = 4;

/// γ_n of Higham: the relative error of n roundings.
const fn gamma(n: u32) -> f32 {
    let u = f32::EPSILON / 2.0;
    n as f32 * u / (1.0 - n as f32 * u)
}

/// Up to four triangles, by coordinate.
#[derive(Clone, Debug)]
pub(super) struct Packet {
    /// `corners[corner][axis]`, one triangle per lane; NaN where there is none, which no comparison holds for.
    corners: [[f32x4; 3]; 3],
    pub keys: [Key; PACKET],
}

impl Packet {
    pub fn new(triangles: &[(Triangle, Key)]) -> Self {
        let coordinate = |corner: usize, axis: usize| {
            f32x4::new(std::array::from_fn(|lane| triangles.get(lane).map_or(f32::NAN, |(triangle, _)| triangle[corner][axis])))
        };
        Self {
            corners: std::array::from_fn(|corner| std::array::from_fn(|axis| coordinate(corner, axis))),
            keys: std::array::from_fn(|lane| triangles.get(lane).map_or(Key(u32::MAX), |&(_, key)| key)),
        }
    }

    /// The triangle of a lane.
    pub fn triangle(&self, lane: usize) -> Triangle {
        std::array::from_fn(|corner| Vec3::from_array(std::array::from_fn(|axis| self.corners[corner][axis].as_array()[lane])))
    }

    /// Offers what the ray hits here. `slot` is that of the first lane; `entry` is where the ray enters the box of all lanes.
    #[inline(always)]
    pub fn intersect(&self, probe: &Probe, shear: &Shear, slot: u32, entry: f32, nearest: &mut Nearest) {
        let [x, y, z] = shear.axes;
        let [shear_x, shear_y, scale_z] = shear.shear;
        let sheared = |corner: &[f32x4; 3]| {
            let depth = corner[z] - shear.apex[2];
            (corner[x] - shear.apex[0] - shear_x * depth, corner[y] - shear.apex[1] - shear_y * depth, depth)
        };
        let (ax, ay, az) = sheared(&self.corners[0]);
        let (bx, by, bz) = sheared(&self.corners[1]);
        let (cx, cy, cz) = sheared(&self.corners[2]);

        // No fused operations: each edge function has to be the exact negative of the neighbour's.
        let mut u = cx * by - cy * bx;
        let mut v = ax * cy - ay * cx;
        let mut w = bx * ay - by * ax;
        let zero = f32x4::ZERO;
        let tied = u.simd_eq(zero) | v.simd_eq(zero) | w.simd_eq(zero);
        if tied.any() {
            [u, v, w] = exact_edges([ax, ay, bx, by, cx, cy]);
        }
        let least = u.fast_min(v).fast_min(w);
        let most = u.fast_max(v).fast_max(w);
        let area = u + v + w;
        let inside = (least.simd_ge(zero) | most.simd_le(zero)) & area.simd_ne(zero);
        if !inside.any() {
            return;
        }

        let (az, bz, cz) = (az * scale_z, bz * scale_z, cz * scale_z);
        let per_area = f32x4::ONE / area;
        let t = (u * az + v * bz + w * cz) * per_area;
        let candidates = inside & t.simd_gt(zero) & t.simd_le(f32x4::splat(nearest.t));
        let mut candidates = candidates.to_bitmask();
        if candidates == 0 {
            return;
        }

        let error = distance_error(shear.depth, [ax, bx, cx], [ay, by, cy], [az, bz, cz], [u, v, w], per_area);
        let unsure = t.simd_le(error) | (t - f32x4::splat(probe.limit)).abs().simd_le(error) | t.simd_lt(f32x4::splat(entry));
        let unsure = unsure.to_bitmask();
        let (t, v, w) = (t.to_array(), (v * per_area).to_array(), (w * per_area).to_array());
        while candidates != 0 {
            let lane = candidates.trailing_zeros() as usize & 3;
            candidates &= candidates - 1;
            // An area that is too small for f32 to divide by has no coordinates: the ray passes.
            if !(v[lane] + w[lane]).is_finite() {
                continue;
            }
            let key = self.keys[lane];
            let t = if unsure >> lane & 1 != 0 { self.unsure_distance(probe, lane) } else { t[lane] };
            if nearest.loses_to(t, key) && !(probe.hide && key.hidden_from_lens()) {
                *nearest = Nearest { t, key, slot: slot + lane as u32, coordinates: (v[lane], w[lane]) };
            }
        }
    }

    /// Offers what the ray hits here, by the test of Möller and Trumbore 1997: sooner than [`Packet::intersect`], but rays may pass
    /// between neighbours, and rounding decides what lies at the ray's ends.
    #[inline(always)]
    pub fn intersect_fast(&self, probe: &Probe, slot: u32, nearest: &mut Nearest) {
        let splat = |v: Vec3| v.to_array().map(f32x4::splat);
        let (origin, d) = (splat(probe.origin), splat(probe.direction));
        let sub = |p: &[f32x4; 3], q: &[f32x4; 3]| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
        let dot = |p: &[f32x4; 3], q: &[f32x4; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
        let cross = |p: &[f32x4; 3], q: &[f32x4; 3]| [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
        let [a, b, c] = &self.corners;
        let (x, y, to_origin) = (sub(b, a), sub(c, a), sub(&origin, a));
        let (across, along) = (cross(&d, &y), cross(&to_origin, &x));
        let per_area = f32x4::ONE / dot(&x, &across);
        let (v, w) = (dot(&to_origin, &across) * per_area, dot(&d, &along) * per_area);
        let t = dot(&y, &along) * per_area;
        let inside = v.fast_min(w).fast_min(f32x4::ONE - v - w).simd_ge(f32x4::ZERO);
        let candidates = inside & t.simd_gt(f32x4::ZERO) & t.simd_le(f32x4::splat(nearest.t));
        let mut candidates = candidates.to_bitmask();
        if candidates == 0 {
            return;
        }
        let (t, v, w) = (t.to_array(), v.to_array(), w.to_array());
        while candidates != 0 {
            let lane = candidates.trailing_zeros() as usize & 3;
            candidates &= candidates - 1;
            let key = self.keys[lane];
            if nearest.loses_to(t[lane], key) && !(probe.hide && key.hidden_from_lens()) {
                *nearest = Nearest { t: t[lane], key, slot: slot + lane as u32, coordinates: (v[lane], w[lane]) };
            }
        }
    }

    /// The distance to the plane of a triangle whose f32 distance could be on the wrong side of the ray's start or end, or before the
    /// box of the triangle: then it would depend on the order of the search whether it is found.
    #[cold]
    #[inline(never)]
    fn unsure_distance(&self, probe: &Probe, lane: usize) -> f32 {
        self.exact_distance(probe, lane)
    }

    /// The distance to the plane of a triangle, computed in f64.
    #[inline(always)]
    pub fn exact_distance(&self, probe: &Probe, lane: usize) -> f32 {
        let [a, b, c] = self.triangle(lane).map(|corner| corner.as_dvec3());
        let (origin, direction) = probe.in_f64();
        let normal: DVec3 = (b - a).cross(c - a);
        (normal.dot(a - origin) / normal.dot(direction)) as f32
    }
}

/// The edge functions in f64, where the products are exact and so is the sign of their difference.
#[cold]
#[inline(never)]
fn exact_edges(sheared: [f32x4; 6]) -> [f32x4; 3] {
    let [ax, ay, bx, by, cx, cy] = sheared.map(|lanes| lanes.to_array());
    let edge = |px: [f32; 4], qy: [f32; 4], py: [f32; 4], qx: [f32; 4]| {
        f32x4::new(std::array::from_fn(|lane| {
            (f64::from(px[lane]) * f64::from(qy[lane]) - f64::from(py[lane]) * f64::from(qx[lane])) as f32
        }))
    };
    [edge(cx, by, cy, bx), edge(ax, cy, ay, cx), edge(bx, ay, by, ax)]
}

/// A bound on the rounding error of t (Pharr, Jakob and Humphreys 2016, §3.9.6), in units of the direction's length.
#[inline(always)]
fn distance_error(depth: f32x4, x: [f32x4; 3], y: [f32x4; 3], z: [f32x4; 3], edges: [f32x4; 3], per_area: f32x4) -> f32x4 {
    let largest = |[a, b, c]: [f32x4; 3]| a.abs().fast_max(b.abs()).fast_max(c.abs());
    let (x, y, z, edge) = (largest(x), largest(y), largest(z), largest(edges));
    let depth = z * depth;
    let error_x = f32x4::splat(gamma(5)) * (x + depth);
    let error_y = f32x4::splat(gamma(5)) * (y + depth);
    let error_edge = f32x4::splat(2.0) * (f32x4::splat(gamma(2)) * x * y + error_y * x + error_x * y);
    let sum = f32x4::splat(gamma(3) + gamma(3)) * edge * z + error_edge * z;
    f32x4::splat(3.0) * sum * per_area.abs()
}
