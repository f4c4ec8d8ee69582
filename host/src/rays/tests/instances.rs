//! Instances: what is placed by a transform answers as if its triangles had been moved.

use std::sync::Arc;

use bidir_kernel::Vec3;
use glam::{DAffine3, DMat3, DVec3};

use super::random::{Random, ray, segment, sphere_mesh, tree};
use crate::rays::{Bvh, Geometry, Instance, LEVELS, PrimitiveId, Primitives, Sphere, Visibility::Everywhere};

/// A rotation, a stretch along each axis, perhaps a reflection, and a move.
fn placement(random: &mut Random, size: f64) -> DAffine3 {
    let mut turn = || DMat3::from_axis_angle(random.direction().as_dvec3().normalize(), 6.0 * f64::from(random.unit()));
    let (turn, before) = (turn(), turn());
    let mut stretch = || 10.0_f64.powf(f64::from(random.unit()) - 0.5);
    let mut stretched = DVec3::new(stretch(), stretch(), stretch()) * size;
    if random.unit() < 0.5 {
        stretched.x = -stretched.x;
    }
    DAffine3 { matrix3: turn * DMat3::from_diagonal(stretched) * before, translation: random.cube().as_dvec3() * (4.0 * size) }
}

#[test]
fn instances_answer_as_moved_triangles_do() {
    for size in [1e-3, 1.0, 1e3] {
        let mut random = Random(31);
        let (corners, faces) = sphere_mesh(Vec3::ZERO, 1.0, 12);
        let inner = Arc::new(tree(&corners, &faces));
        let (mut flat, mut nested) = (Primitives::new(), Primitives::new());
        for _ in 0..12 {
            let to_world = placement(&mut random, size);
            for face in &faces {
                let moved = face.map(|corner| to_world.transform_point3(corners[corner].as_dvec3()).as_vec3());
                flat.triangle(moved, Everywhere);
            }
            nested.instance(Instance::new(Arc::clone(&inner), to_world).expect("an inverse"), Everywhere);
        }
        let (flat, nested) = (Bvh::build(flat), Bvh::build(nested));
        let size = size as f32;
        let (mut hits, mut same) = (0, 0);
        for i in 0..50_000 {
            let (a, b) = (random.cube() * (6.0 * size), random.cube() * (6.0 * size));
            let ray = if i % 2 == 0 { ray(a, b - a) } else { segment(a, b) };
            let (one, other) = (flat.closest(&ray), nested.closest(&ray));
            assert_eq!(nested.occluded(&ray), other.is_some(), "{ray:?}");
            let (Some(one), Some(other)) = (one, other) else {
                // Rays along silhouettes pass one and hit the other.
                same += usize::from(one.is_none() && other.is_none());
                continue;
            };
            hits += 1;
            let path: Vec<PrimitiveId> = nested.path(&other).collect();
            assert_eq!(path.len(), 2);
            assert_eq!(path[0], other.primitive);
            if one.primitive.0 as usize == path[0].0 as usize * faces.len() + path[1].0 as usize {
                same += 1;
                let (one, other) = (flat.surface(&ray, &one), nested.surface(&ray, &other));
                let apart = (one.position - other.position).length();
                // Of grazed triangles the hit lies where it may along the ray.
                let slant = one.normal.dot(ray.direction.normalize()).abs().max(1e-3);
                assert!(apart * slant < 1e-5 * size, "{one:?} and {other:?}");
                assert!(one.normal.dot(other.normal).abs() > 0.9999, "{one:?} and {other:?}");
            }
        }
        assert!(hits > 10_000 && same > 49_900, "{hits} hits, {same} of 50,000 the same");
    }
}

#[test]
fn eight_levels_lie_within_each_other_and_no_more() {
    let mut random = Random(5);
    let mut primitives = Primitives::new();
    primitives.triangle([Vec3::splat(9.0), Vec3::splat(9.0) + Vec3::X, Vec3::splat(9.0) + Vec3::Y], Everywhere);
    primitives.sphere(Sphere { centre: Vec3::ZERO, radius: 1.0 }, Everywhere);
    let mut outer = Arc::new(Bvh::build(primitives));
    let mut whole = DAffine3::IDENTITY;
    for level in 0..LEVELS {
        let mut to_world = placement(&mut random, 1.0);
        to_world.translation *= 0.1;
        let mut primitives = Primitives::new();
        // Instances come after as many others as there are levels, so that each level's number is its own.
        for i in 0..level {
            primitives.triangle([Vec3::splat(1e3), Vec3::splat(1e3) + Vec3::X, Vec3::splat(1e3 + i as f32)], Everywhere);
        }
        primitives.instance(Instance::new(outer, to_world).expect("room for another level"), Everywhere);
        outer = Arc::new(Bvh::build(primitives));
        whole = to_world * whole;
    }
    for _ in 0..1000 {
        let target = whole.transform_point3(random.direction().as_dvec3() * 0.5);
        let origin = whole.transform_point3(random.direction().as_dvec3() * 3.0);
        let ray = ray(origin.as_vec3(), (target - origin).as_vec3());
        let hit = outer.closest(&ray).expect("the ball");
        let path: Vec<u32> = outer.path(&hit).map(|id| id.0).collect();
        assert_eq!(path, [7, 6, 5, 4, 3, 2, 1, 0, 1]);
        let at = outer.surface(&ray, &hit);
        let on_ball = whole.inverse().transform_point3(at.position.as_dvec3());
        assert!((on_ball.length() - 1.0).abs() < 1e-4, "{on_ball}");
        let normal = (whole.matrix3.inverse().transpose() * on_ball).normalize();
        assert!(normal.dot(at.normal.as_dvec3()) > 0.999, "{normal} and {}", at.normal);
    }
    assert!(Instance::new(outer, DAffine3::IDENTITY).is_none());
}

#[test]
fn what_cannot_be_placed_is_no_instance() {
    let (corners, faces) = sphere_mesh(Vec3::ZERO, 1.0, 4);
    let ball = Arc::new(tree(&corners, &faces));
    assert!(Instance::new(Arc::clone(&ball), DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0))).is_none());
    assert!(Instance::new(Arc::clone(&ball), DAffine3::from_translation(DVec3::new(f64::NAN, 0.0, 0.0))).is_none());
    assert!(Instance::new(Arc::new(Bvh::build(Primitives::new())), DAffine3::IDENTITY).is_none());
    assert!(Instance::new(Arc::clone(&ball), DAffine3::from_scale(DVec3::splat(1e39))).is_none());
    assert!(Instance::new(ball, DAffine3::from_scale(DVec3::splat(1e20))).is_some());
}

/// Rays that leave an instance must not find it again, however it is stretched and wherever it stands.
#[test]
fn instances_never_hit_themselves() {
    let (corners, faces) = sphere_mesh(Vec3::new(3.0, -2.0, 5.0), 1.0, 24);
    let ball = Arc::new(tree(&corners, &faces));
    let mut random = Random(77);
    for (size, far) in [(1e-3, 0.0), (1.0, 0.0), (1e3, 0.0), (1.0, 5e3), (1e-3, 5.0)] {
        for _ in 0..4 {
            let mut to_world = placement(&mut random, size);
            to_world.translation += random.direction().as_dvec3() * far;
            let mut primitives = Primitives::new();
            primitives.instance(Instance::new(Arc::clone(&ball), to_world).expect("an inverse"), Everywhere);
            let bvh = Bvh::build(primitives);
            let (centre, radius) = (0.5 * (bvh.bounds().min + bvh.bounds().max), 0.5 * (bvh.bounds().max - bvh.bounds().min).length());
            let mut hits = 0;
            while hits < 50_000 {
                let origin = centre + random.direction() * (2.0 * radius);
                let into = ray(origin, centre + random.cube() * radius - origin);
                let Some(hit) = bvh.closest(&into) else { continue };
                hits += 1;
                let at = bvh.surface(&into, &hit);
                let side = if into.direction.dot(at.normal) < 0.0 { 1.0 } else { -1.0 };
                let mut out = random.direction();
                if out.dot(at.normal) * side < 0.0 {
                    out = -out;
                }
                let again = ray(at.position + at.normal * (at.offset * side), out);
                assert!(!bvh.occluded(&again), "size {size}, {far} away: {into:?} {at:?} {again:?}");
            }
        }
    }
}
