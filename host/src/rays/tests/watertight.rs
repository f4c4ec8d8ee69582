//! Hard case 29: rays at shared edges and corners of closed meshes.

use bidir_kernel::Vec3;

use super::random::{Random, ray, sphere_mesh, tree};
use crate::rays::{Bvh, Geometry, Parallelogram, Primitives, Visibility};

const RAYS: usize = 1_000_000;

fn leaks(bvh: &Bvh, corners: &[Vec3], faces: &[[usize; 3]], centre: Vec3, radius: f32, seed: u64) -> usize {
    let mut random = Random(seed);
    let mut leaks = 0;
    for i in 0..RAYS {
        let [a, b, c] = faces[(random.unit() * faces.len() as f32) as usize % faces.len()].map(|corner| corners[corner]);
        let along = random.unit();
        let target = match i % 3 {
            0 => a,
            1 => a + (b - a) * along,
            _ => b + (c - b) * along,
        };
        let origin = if i % 2 == 0 { centre + random.cube() * radius * 0.5 } else { centre + random.direction() * radius * 3.0 };
        let hit = bvh.closest(&ray(origin, target - origin));
        // From outside, a ray at the silhouette may pass; only what would hit a slightly smaller sphere counts.
        let (o, d) = ((origin - centre).as_dvec3(), (target - origin).as_dvec3().normalize());
        let clearance = (o - d * o.dot(d)).length();
        leaks += usize::from(hit.is_none() && clearance < 0.95 * f64::from(radius));
    }
    leaks
}

#[test]
fn closed_spheres_let_no_ray_through_their_edges() {
    for (radius, centre) in [
        (1e-4, Vec3::ZERO),
        (1e-3, Vec3::ZERO),
        (1.0, Vec3::ZERO),
        (1.0, Vec3::splat(1e3)),
        (1e-3, Vec3::new(1.0, 2.0, 3.0)),
        (1e3, Vec3::ZERO),
    ] {
        let (corners, faces) = sphere_mesh(centre, radius, 24);
        let bvh = tree(&corners, &faces);
        let leaks = leaks(&bvh, &corners, &faces, centre, radius, 1);
        assert_eq!(leaks, 0, "of {RAYS} rays at a sphere of radius {radius} at {centre}");
    }
}

#[test]
fn a_flat_grid_along_the_axes_lets_no_ray_through() {
    // Boxes end exactly at the edges here: the box test must forgive what the triangle test rounds.
    let n = 16;
    for (scale, lift, centre) in [(1.0, 0.0, Vec3::ZERO), (0.1, 0.3, Vec3::new(7.1, 0.0, 3.3)), (1e-4, 0.0, Vec3::ZERO)] {
        let mut triangles = Primitives::new();
        let mut quads = Primitives::new();
        let at = |i: i32, j: i32| centre + Vec3::new((i - n / 2) as f32, lift, (j - n / 2) as f32) * scale;
        for i in 0..n {
            for j in 0..n {
                let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1));
                triangles.triangle([a, b, d], Visibility::Everywhere);
                triangles.triangle([a, d, c], Visibility::Everywhere);
                if scale == 1.0 {
                    quads.parallelogram(Parallelogram { corner: a, x: b - a, y: c - a }, Visibility::Everywhere);
                }
            }
        }
        let trees = [Bvh::build(triangles), Bvh::build(quads)];
        let mut random = Random(3);
        for i in 0..RAYS {
            let line = (random.unit() * (n - 2) as f32) as i32 + 1;
            let along = (random.unit() - 0.5) * (n - 2) as f32 * scale;
            let mut target = at(line, n / 2) + Vec3::Z * along;
            if i % 2 == 0 {
                target = at(n / 2, line) + Vec3::X * along;
            }
            let origin = target + random.direction().with_y(0.2 + random.unit()) * scale * 30.0;
            for bvh in trees.iter().filter(|bvh| bvh.stats().primitives > 0) {
                assert!(bvh.closest(&ray(origin, target - origin)).is_some(), "{origin} to {target} at scale {scale}");
            }
        }
    }
}
