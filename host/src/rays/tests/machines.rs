//! Whatever registers the machine has, hits are the same, bit for bit.

use std::sync::Arc;

use bidir_kernel::{Ray, Vec3};
use glam::{DAffine3, DMat3};

use super::random::{Random, ray, segment, sphere_mesh, tree};
use crate::rays::{Bvh, Cylinder, Disk, Geometry, Instance, Primitives, RayHit, Sphere, Triangles, Visibility::Everywhere};

/// Triangles, closed and loose, and everything else there is, about a place.
fn crowd(centre: Vec3, size: f32, seed: u64) -> Bvh {
    let mut random = Random(seed);
    let mut primitives = Primitives::new();
    let (corners, faces) = sphere_mesh(centre, size, 20);
    for face in faces {
        primitives.triangle(face.map(|corner| corners[corner]), Everywhere);
    }
    for _ in 0..2000 {
        let at = centre + random.cube() * size;
        primitives.triangle([(); 3].map(|()| at + random.cube() * (0.1 * size)), Everywhere);
    }
    for _ in 0..50 {
        let (at, radius) = (centre + random.cube() * size, (0.01 + 0.1 * random.unit()) * size);
        primitives.sphere(Sphere { centre: at, radius }, Everywhere);
        let (x, y) = random.direction().any_orthonormal_pair();
        primitives.disk(Disk { centre: at, x: x * radius, y: y * radius }, Everywhere);
        primitives.cylinder(Cylinder { p0: at, p1: at + x * (3.0 * radius), x: y, radius }, Everywhere);
    }
    let (corners, faces) = sphere_mesh(Vec3::X, 1.0, 8);
    let ball = Arc::new(tree(&corners, &faces));
    for _ in 0..30 {
        let turned = DMat3::from_axis_angle(random.direction().as_dvec3().normalize(), f64::from(random.unit())) * f64::from(0.2 * size);
        let at = (centre + random.cube() * size).as_dvec3();
        let twice = DAffine3 { matrix3: turned, translation: at };
        // The second lies exactly in the first's place.
        for _ in 0..2 {
            primitives.instance(Instance::new(Arc::clone(&ball), twice).expect("an inverse"), Everywhere);
        }
    }
    Bvh::build(primitives)
}

fn bits(hit: Option<RayHit>) -> Option<[u32; 4]> {
    hit.map(|RayHit { t, primitive, coordinates: (one, two), .. }| [t.to_bits(), primitive.0, one.to_bits(), two.to_bits()])
}

fn rays(centre: Vec3, size: f32, seed: u64) -> impl Iterator<Item = Ray> {
    let mut random = Random(seed);
    (0..60_000).map(move |i| {
        let (a, b) = (centre + random.cube() * (2.0 * size), centre + random.cube() * (2.0 * size));
        match i % 6 {
            0 | 1 => ray(a, b - a),
            2 => segment(a, b),
            // Along an axis, in a plane of two, and hardly off them: where products could be infinite, or 0 times that.
            3 => ray(a, [Vec3::X, Vec3::NEG_Y, Vec3::Z][i / 6 % 3]),
            4 => ray(a, (b - a) * [Vec3::new(1.0, 0.0, 1.0), Vec3::new(-0.0, 1.0, 1.0)][i / 6 % 2]),
            _ => ray(a, (b - a) * [Vec3::new(1e-30, 1.0, 1.0), Vec3::new(1.0, 1e-38, 1e-44)][i / 6 % 2]),
        }
    })
}

#[test]
fn hits_do_not_depend_on_the_machine() {
    let places = [(Vec3::ZERO, 1.0), (Vec3::ZERO, 1e-5), (Vec3::new(5e3, -4e3, 3e3), 1.0), (Vec3::ZERO, 1e15), (Vec3::splat(1e9), 1e6)];
    for (seed, (centre, size)) in places.into_iter().enumerate() {
        let best = crowd(centre, size, seed as u64);
        let portable = best.clone().portable();
        let mut hits = 0;
        for ray in rays(centre, size, 100 + seed as u64) {
            let (one, other) = (best.closest(&ray), portable.closest(&ray));
            assert_eq!(bits(one), bits(other), "{ray:?}: {one:?} and {other:?}");
            assert_eq!(one, other);
            assert!(one.is_none_or(|hit| best.path(&hit).eq(portable.path(&hit))));
            assert_eq!(best.occluded(&ray), one.is_some(), "{ray:?}");
            assert_eq!(portable.occluded(&ray), one.is_some(), "{ray:?}");
            hits += usize::from(one.is_some());
        }
        assert!(hits > 20_000, "{hits} at {centre}");
    }
}

#[test]
fn the_fast_test_sees_what_the_watertight_one_sees() {
    let watertight = crowd(Vec3::ZERO, 1.0, 9);
    let fast = watertight.clone().with_triangles(Triangles::Fast);
    let differing = rays(Vec3::ZERO, 1.0, 8).filter(|ray| {
        let (one, other) = (watertight.closest(ray), fast.closest(ray));
        one.map(|hit| hit.primitive) != other.map(|hit| hit.primitive)
    });
    let differing = differing.count();
    assert!(differing < 60, "{differing} of 60,000");
}
