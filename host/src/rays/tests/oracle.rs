//! The tree against every primitive in turn, in f64.

use bidir_kernel::{Ray, Vec3};
use glam::DVec3;

use super::random::{Random, ray, segment};
use crate::rays::{Bvh, Cylinder, Disk, Geometry, Parallelogram, Primitives, Sphere, Visibility};

enum Shape {
    Triangle([Vec3; 3]),
    Parallelogram(Parallelogram),
    Sphere(Sphere),
    Disk(Disk),
    Cylinder(Cylinder),
}

/// A distance, and how far from its rim or silhouette the ray meets the shape, in parts of the shape.
type Met = (f64, f64);

/// The plane corner + a·x + b·y: t, a, b by Cramer's rule.
fn plane(corner: Vec3, x: Vec3, y: Vec3, o: DVec3, d: DVec3) -> [f64; 3] {
    let (corner, x, y) = (corner.as_dvec3(), x.as_dvec3(), y.as_dvec3());
    let (n, from) = (x.cross(y), corner - o);
    let t = n.dot(from) / n.dot(d);
    let q = d * t - from;
    [t, q.cross(y).dot(n) / n.dot(n), x.cross(q).dot(n) / n.dot(n)]
}

impl Shape {
    fn random(random: &mut Random, kind: u32) -> Self {
        let centre = random.cube();
        let size = 0.02 + 0.2 * random.unit();
        let (x, y) = (random.direction() * size, random.direction() * size);
        match kind {
            0 => Self::Triangle([centre, centre + x, centre + y]),
            1 => Self::Parallelogram(Parallelogram { corner: centre, x, y }),
            2 => Self::Sphere(Sphere { centre, radius: size * 0.5 }),
            3 => Self::Disk(Disk { centre, x, y }),
            _ => Self::Cylinder(Cylinder { p0: centre, p1: centre + x, x: y, radius: size * 0.3 }),
        }
    }

    fn insert(&self, all: &mut Primitives) {
        match self {
            Self::Triangle(corners) => all.triangle(*corners, Visibility::Everywhere),
            Self::Parallelogram(shape) => all.parallelogram(*shape, Visibility::Everywhere),
            Self::Sphere(shape) => all.sphere(*shape, Visibility::Everywhere),
            Self::Disk(shape) => all.disk(*shape, Visibility::Everywhere),
            Self::Cylinder(shape) => all.cylinder(*shape, Visibility::Everywhere),
        };
    }

    /// The first point of the ray on the shape.
    fn meet(&self, o: DVec3, d: DVec3) -> Vec<Met> {
        match self {
            Self::Triangle([a, b, c]) => {
                let (x, y) = (b.as_dvec3() - a.as_dvec3(), c.as_dvec3() - a.as_dvec3());
                let (n, from) = (x.cross(y), a.as_dvec3() - o);
                let t = n.dot(from) / n.dot(d);
                let q = d * t - from;
                let (b1, b2) = (q.cross(y).dot(n) / n.dot(n), x.cross(q).dot(n) / n.dot(n));
                vec![(t, b1.min(b2).min(1.0 - b1 - b2))]
            }
            Self::Parallelogram(p) => {
                let [t, a, b] = plane(p.corner, p.x, p.y, o, d);
                vec![(t, a.min(b).min(1.0 - a).min(1.0 - b))]
            }
            Self::Disk(disk) => {
                let [t, a, b] = plane(disk.centre, disk.x, disk.y, o, d);
                vec![(t, 1.0 - a.hypot(b))]
            }
            Self::Sphere(sphere) => {
                let (o, r) = (o - sphere.centre.as_dvec3(), f64::from(sphere.radius));
                let (a, b, c) = (d.dot(d), o.dot(d), o.dot(o) - r * r);
                let inside = (b * b - a * c) / (a * r * r);
                let root = (b * b - a * c).max(0.0).sqrt();
                vec![((-b - root) / a, inside), ((-b + root) / a, inside)]
            }
            Self::Cylinder(tube) => {
                let (p0, axis) = (tube.p0.as_dvec3(), tube.p1.as_dvec3() - tube.p0.as_dvec3());
                let (r, z) = (f64::from(tube.radius), axis.normalize());
                let flat = |v: DVec3| v - z * z.dot(v);
                let (of, df) = (flat(o - p0), flat(d));
                let (a, b, c) = (df.dot(df), of.dot(df), of.dot(of) - r * r);
                let inside = (b * b - a * c) / (a * r * r);
                let root = (b * b - a * c).max(0.0).sqrt();
                let met = |t: f64| {
                    let height = z.dot(o + d * t - p0) / axis.length();
                    (t, inside.min(height).min(1.0 - height))
                };
                vec![met((-b - root) / a), met((-b + root) / a)]
            }
        }
    }
}

/// What is hit for sure, and what may be.
fn oracle(shapes: &[Shape], ray: &Ray) -> (Option<(usize, f64)>, bool) {
    const SURE: f64 = 1e-4;
    let (o, d) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let mut nearest: Option<(usize, f64)> = None;
    let mut doubtful = f64::INFINITY;
    for (index, shape) in shapes.iter().enumerate() {
        for (t, inside) in shape.meet(o, d) {
            if !(t > -1e-5 && t < f64::from(ray.t_max) * (1.0 + 1e-5)) || inside < -SURE {
                continue;
            }
            if inside < SURE || t < 1e-5 || t > f64::from(ray.t_max) * (1.0 - 1e-5) {
                doubtful = doubtful.min(t);
            } else if nearest.is_none_or(|(_, best)| t < best) {
                // Two almost equally near are as doubtful.
                if nearest.is_some_and(|(_, best)| best - t < 1e-5) {
                    doubtful = doubtful.min(t);
                }
                nearest = Some((index, t));
            } else if nearest.is_some_and(|(_, best)| t - best < 1e-5) {
                doubtful = doubtful.min(t);
            }
        }
    }
    (nearest, doubtful > nearest.map_or(f64::MAX, |(_, t)| t + 1e-5))
}

fn check(kinds: &[u32], count: usize, seed: u64) {
    let mut random = Random(seed);
    let shapes: Vec<Shape> = (0..count).map(|i| Shape::random(&mut random, kinds[i % kinds.len()])).collect();
    let mut primitives = Primitives::new();
    shapes.iter().for_each(|shape| shape.insert(&mut primitives));
    let bvh = Bvh::build(primitives);
    let (mut hits, mut sure, mut worst) = (0, 0, 0.0_f64);
    const RAYS: usize = 20_000;
    for i in 0..RAYS {
        let origin = random.cube() * 2.0;
        let length = 10.0_f32.powf(random.unit() * 12.0 - 6.0);
        let ray = if i % 2 == 0 { ray(origin, random.direction() * length) } else { segment(origin, random.cube()) };
        let hit = bvh.closest(&ray);
        assert_eq!(hit.is_some(), bvh.occluded(&ray), "{ray:?}");
        let (expected, is_sure) = oracle(&shapes, &ray);
        if is_sure {
            sure += 1;
            assert_eq!(hit.map(|hit| hit.primitive.0 as usize), expected.map(|(index, _)| index), "{ray:?}");
        }
        if let (Some(hit), Some((index, t)), true) = (hit, expected, is_sure) {
            hits += 1;
            let at = bvh.surface(&ray, &hit);
            let true_point = ray.origin.as_dvec3() + ray.direction.as_dvec3() * t;
            // Seen at a slant an error along the ray is larger than across it.
            let slant = at.normal.dot(ray.direction.normalize()).abs().max(1e-3);
            let error = (at.position.as_dvec3() - true_point).length() * f64::from(slant);
            worst = worst.max(error);
            assert!(error < 2e-6, "{ray:?}: {at:?} for {true_point} of {index}");
            let distance = (f64::from(hit.t) - t).abs() * f64::from(ray.direction.length() * slant);
            assert!(distance < 2e-6, "{ray:?}: {hit:?} for {t}");
            assert!((at.normal.length() - 1.0).abs() < 1e-6);
        }
    }
    assert!(sure > RAYS / 2 && hits > RAYS / 500, "{sure} of {RAYS} rays were sure, {hits} hit");
    println!("{count} shapes of kinds {kinds:?}: {sure} sure, {hits} hits, largest error {worst:e}");
}

#[test]
fn triangles_are_hit_where_the_oracle_says() {
    check(&[0], 12, 1);
    check(&[0], 300, 2);
    check(&[0], 2000, 3);
}

#[test]
fn analytic_shapes_are_hit_where_the_oracle_says() {
    for kind in 1..5 {
        check(&[kind], 200, 10 + u64::from(kind));
    }
}

#[test]
fn mixed_shapes_are_hit_where_the_oracle_says() {
    check(&[0, 1, 2, 3, 4], 20, 20);
    check(&[0, 1, 2, 3, 4, 0, 0, 0], 1000, 21);
}
