//! Rays and surfaces, in f64 for both worlds: what f32 and f64 then disagree about is not the world's.

use std::f64::consts::PI;

use bidir_kernel_f64::{
    Vec3,
    math::{dot, safe_sqrt, sqrt},
    warp,
};

use crate::setting::{Shape, Thing};

/// A ray's end.
#[derive(Clone, Copy, Debug)]
pub struct Hit {
    /// Which thing.
    pub thing: usize,
    /// Along the ray.
    pub t: f64,
    /// How far from the thing's edge (of a ball: its outline), relative to its size.
    pub edge: f64,
    /// What lies there.
    pub site: Site,
}

/// A point of a surface.
#[derive(Clone, Copy, Debug)]
pub struct Site {
    /// The point.
    pub position: Vec3,
    /// The unit geometric normal.
    pub normal: Vec3,
    /// The unit shading normal, on the same side.
    pub shading: Vec3,
    /// What the shading frame's x follows.
    pub tangent: Vec3,
}

/// The nearest thing with 0 < t < `t_max`; the first one of two that are equally near.
pub fn nearest(things: &[Thing], origin: Vec3, direction: Vec3, t_max: f64) -> Option<Hit> {
    let mut found: Option<Hit> = None;
    for (thing, Thing { shape, .. }) in things.iter().enumerate() {
        let limit = found.map_or(t_max, |hit| hit.t);
        if let Some((t, edge, site)) = shape.hit(origin, direction, limit) {
            found = Some(Hit { thing, t, edge, site });
        }
    }
    found
}

impl Shape {
    fn hit(&self, origin: Vec3, direction: Vec3, t_max: f64) -> Option<(f64, f64, Site)> {
        match *self {
            Self::Rectangle { centre, u, v } => {
                let [centre, u, v] = [centre, u, v].map(Vec3::from_array);
                let normal = u.cross(v).normalize();
                let t = dot(centre - origin, normal) / dot(direction, normal);
                if !(t > 0.0 && t < t_max) {
                    return None;
                }
                let across = origin + direction * t - centre;
                let (a, b) = (dot(across, u) / dot(u, u), dot(across, v) / dot(v, v));
                let edge = (1.0 - a.abs()).min(1.0 - b.abs());
                (edge >= 0.0).then(|| (t, edge, flat(centre + u * a + v * b, normal, u)))
            }
            Self::Ball { centre, radius } => {
                let centre = Vec3::from_array(centre);
                let from = origin - centre;
                let (a, b) = (dot(direction, direction), dot(from, direction));
                let miss = from - direction * (b / a);
                let squared = dot(miss, miss) / (radius * radius);
                if squared > 1.0 {
                    return None;
                }
                let root = radius * sqrt(a * (1.0 - squared));
                let far = if b > 0.0 { -b - root } else { -b + root };
                let (x, y) = ((dot(from, from) - radius * radius) / far, far / a);
                let t = [x.min(y), x.max(y)].into_iter().find(|&t| t > 0.0 && t < t_max)?;
                Some((t, 1.0 - sqrt(squared), ball(centre, radius, (from + direction * t).normalize())))
            }
            Self::Triangle { corners, normals } => {
                let [a, b, c] = corners.map(Vec3::from_array);
                let (ab, ac) = (b - a, c - a);
                let normal = ab.cross(ac);
                let t = dot(a - origin, normal) / dot(direction, normal);
                if !(t > 0.0 && t < t_max) {
                    return None;
                }
                let at = origin + direction * t - a;
                let v = dot(at.cross(ac), normal) / dot(normal, normal);
                let w = dot(ab.cross(at), normal) / dot(normal, normal);
                let edge = v.min(w).min(1.0 - v - w);
                let [na, nb, nc] = normals.map(Vec3::from_array);
                let (normal, shading) = (normal.normalize(), (na * (1.0 - v - w) + nb * v + nc * w).normalize());
                (edge >= 0.0).then(|| (t, edge, Site { position: a + ab * v + ac * w, normal, shading, tangent: ab }))
            }
        }
    }

    /// A point by two numbers in [0, 1); triangles are no lights.
    pub fn sampled(&self, u: [f64; 2]) -> Site {
        match *self {
            Self::Rectangle { centre, u: x, v: y } => {
                let [centre, x, y] = [centre, x, y].map(Vec3::from_array);
                flat(centre + x * (2.0 * u[0] - 1.0) + y * (2.0 * u[1] - 1.0), x.cross(y).normalize(), x)
            }
            Self::Ball { centre, radius } => ball(Vec3::from_array(centre), radius, warp::sphere(u)),
            Self::Triangle { .. } => unreachable!("a triangle shines"),
        }
    }

    /// Density of [`Shape::sampled`], per area.
    pub fn density(&self) -> f64 {
        match *self {
            Self::Rectangle { u, v, .. } => 0.25 / Vec3::from_array(u).cross(Vec3::from_array(v)).length(),
            Self::Ball { radius, .. } => 1.0 / (4.0 * PI * radius * radius),
            Self::Triangle { .. } => unreachable!("a triangle shines"),
        }
    }

    /// How densely directions towards a ball seen from outside are sampled, per steradian.
    pub fn cone_density(&self, lit: Vec3) -> Option<f64> {
        Some(warp::cone_pdf(self.opening(lit)?))
    }

    /// A point of a ball in the cone that it fills, seen from outside.
    pub fn sampled_toward(&self, lit: Vec3, u: [f64; 2]) -> Option<Site> {
        let Self::Ball { centre, radius } = *self else { return None };
        let centre = Vec3::from_array(centre);
        let to = centre - lit;
        let distance = sqrt(dot(to, to));
        let local = warp::cone(u, self.opening(lit)?);
        let direction = bidir_kernel_f64::Frame::from_z(to / distance).to_world(local);
        let along = distance * local.z;
        let across = distance * distance * (local.x * local.x + local.y * local.y);
        let t = along - safe_sqrt(radius * radius - across);
        Some(ball(centre, radius, (lit + direction * t - centre).normalize()))
    }

    /// 1 − cos of the cone in which a ball is seen from outside.
    fn opening(&self, lit: Vec3) -> Option<f64> {
        let Self::Ball { centre, radius } = *self else { return None };
        let to = Vec3::from_array(centre) - lit;
        let sin_squared = radius * radius / dot(to, to);
        (sin_squared < 0.999_999).then(|| warp::one_minus_cos(sin_squared))
    }
}

fn flat(position: Vec3, normal: Vec3, tangent: Vec3) -> Site {
    Site { position, normal, shading: normal, tangent }
}

fn ball(centre: Vec3, radius: f64, out: Vec3) -> Site {
    flat(centre + out * radius, out, Vec3::Y.cross(out))
}
