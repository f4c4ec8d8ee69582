//! Distances of hits against planes that are met in f64.

use bidir_kernel::Vec3;
use glam::DVec3;

use super::random::{Random, ray, sphere_mesh, tree};
use crate::rays::Geometry;

/// How many steps of f32 lie between two positive numbers.
fn steps(a: f32, b: f32) -> u32 {
    a.to_bits().abs_diff(b.to_bits())
}

/// Where the ray meets the plane of a triangle, by Cramer's rule: none of the code's operations in the code's order.
fn met(corners: [DVec3; 3], o: DVec3, d: DVec3) -> f64 {
    let [a, b, c] = corners;
    let (x, y, z) = (b - a, c - a, o - a);
    -z.dot(x.cross(y)) / d.dot(x.cross(y))
}

#[test]
fn distances_are_within_four_steps_of_f64() {
    for (centre, radius) in [(Vec3::ZERO, 1.0), (Vec3::ZERO, 1e-4), (Vec3::splat(1e3), 1.0), (Vec3::ZERO, 1e3)] {
        let (corners, faces) = sphere_mesh(centre, radius, 24);
        let bvh = tree(&corners, &faces);
        let mut random = Random(17);
        let (mut hits, mut grazing, mut worst) = (0, 0, 0);
        while hits < 100_000 {
            let origin = centre + random.direction() * radius * (1.0 + 3.0 * random.unit());
            // Every second ray grazes: it is nearly perpendicular to the way to the centre.
            let target = if hits % 2 == 0 {
                centre + random.cube() * radius
            } else {
                let side = (origin - centre).cross(random.direction()).normalize();
                let sine = radius / (origin - centre).length();
                let cosine = (1.0 - sine * sine).max(0.0).sqrt();
                let touching = (centre - origin).normalize() * cosine + side * (sine * (0.95 + 0.05 * random.unit()));
                origin + touching * radius
            };
            let ray = ray(origin, target - origin);
            let Some(hit) = bvh.closest(&ray) else { continue };
            hits += 1;
            let triangle = faces[hit.primitive.0 as usize].map(|corner| corners[corner].as_dvec3());
            let normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).normalize();
            grazing += usize::from(normal.dot(ray.direction.as_dvec3().normalize()).abs() < 0.2);
            let expected = met(triangle, ray.origin.as_dvec3(), ray.direction.as_dvec3()) as f32;
            worst = worst.max(steps(hit.t, expected));
            assert!(steps(hit.t, expected) <= 4, "{ray:?}: {} for {expected}", hit.t);
        }
        assert!(grazing > 10_000, "{grazing}");
        println!("radius {radius} at {centre}: {grazing} of {hits} graze; worst {worst} steps");
    }
}
