//! Rays nobody means to cast, and scenes nobody means to make.

use bidir_kernel::{Ray, Segment, Vec3};

use super::random::{Random, ray, segment, sphere_mesh, tree};
use crate::rays::{Bvh, Cylinder, Disk, Geometry, Parallelogram, PrimitiveId, Primitives, Sphere, Visibility};

fn build(insert: impl FnOnce(&mut Primitives)) -> Bvh {
    let mut primitives = Primitives::new();
    insert(&mut primitives);
    Bvh::build(primitives)
}

/// Twelve unit squares about the origin, some of them hidden in one another.
fn room() -> Bvh {
    build(|all| {
        for (corner, x, y) in [
            (Vec3::new(-1.0, -1.0, -1.0), Vec3::X, Vec3::Z),
            (Vec3::new(-1.0, 1.0, -1.0), Vec3::X, Vec3::Z),
            (Vec3::new(-1.0, -1.0, -1.0), Vec3::X, Vec3::Y),
            (Vec3::new(-1.0, -1.0, 1.0), Vec3::X, Vec3::Y),
            (Vec3::new(-1.0, -1.0, -1.0), Vec3::Y, Vec3::Z),
            (Vec3::new(1.0, -1.0, -1.0), Vec3::Y, Vec3::Z),
        ] {
            all.parallelogram(Parallelogram { corner, x: x * 2.0, y: y * 2.0 }, Visibility::Everywhere);
            all.parallelogram(Parallelogram { corner: corner * 0.5, x, y }, Visibility::Everywhere);
        }
    })
}

#[test]
fn an_empty_scene_answers_nothing() {
    let bvh = Bvh::build(Primitives::new());
    assert!(bvh.closest(&ray(Vec3::ZERO, Vec3::X)).is_none());
    assert!(!bvh.occluded(&segment(Vec3::ZERO, Vec3::X)));
    assert!(bvh.bounds().is_empty());
}

#[test]
fn a_triangle_thinner_than_f32_divides_by_gives_no_point_that_is_no_number() {
    for height in [1e-37, 1e-38, 4e-39, 1e-40, 1e-44] {
        let corners = [Vec3::ZERO, Vec3::X, Vec3::new(0.0, height, 0.0)];
        let bvh = build(|all| _ = all.triangle(corners, Visibility::Everywhere));
        let from_above = ray(Vec3::new(0.25, height * 0.25, 1.0), Vec3::NEG_Z);
        if let Some(hit) = bvh.closest(&from_above) {
            let point = bvh.surface(&from_above, &hit);
            assert!(point.position.is_finite() && point.offset.is_finite(), "{height}: {point:?}");
        }
    }
}

#[test]
fn rays_that_are_not_rays_hit_nothing() {
    let bvh = room();
    let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
    for value in bad {
        for axis in 0..3 {
            let (mut origin, mut direction) = (Vec3::splat(0.1), Vec3::new(0.3, 0.2, 0.1));
            origin[axis] = value;
            assert!(bvh.closest(&ray(origin, direction)).is_none());
            direction[axis] = value;
            assert!(bvh.closest(&ray(Vec3::ZERO, direction)).is_none());
        }
    }
    assert!(bvh.closest(&ray(Vec3::ZERO, Vec3::ZERO)).is_none());
    for t_max in [f32::NAN, 0.0, -1.0] {
        assert!(bvh.closest(&Ray { t_max, ..ray(Vec3::ZERO, Vec3::X) }).is_none());
    }
}

#[test]
fn rays_along_the_axes_hit_through_flat_boxes() {
    let bvh = room();
    for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
        for sign in [1.0, -1.0, 3.0, -1e-3] {
            let hit = bvh.closest(&ray(Vec3::new(0.01, 0.02, 0.03), axis * sign)).expect("the room is closed");
            let distance = hit.t * sign * axis.length();
            let at = Vec3::new(0.01, 0.02, 0.03).dot(axis) + distance;
            assert!((at.abs() - 0.5).abs() < 1e-6, "{axis} {sign}: {hit:?}");
            // And from outside, onto the zero-thickness box.
            let hit = bvh.closest(&ray(Vec3::new(0.01, 0.02, 0.03) - axis * sign.signum() * 5.0, axis * sign));
            assert!(hit.is_some());
        }
    }
}

#[test]
fn rays_in_the_plane_of_a_box_face_hit_what_stands_on_it() {
    // The wall x = 1 stands on the floor y = 0; the ray runs in the floor.
    let bvh = build(|all| {
        all.parallelogram(Parallelogram { corner: Vec3::new(1.0, 0.0, -1.0), x: Vec3::Y, y: Vec3::Z * 2.0 }, Visibility::Everywhere);
        all.parallelogram(Parallelogram { corner: Vec3::new(2.0, -1.0, -1.0), x: Vec3::Y, y: Vec3::Z * 2.0 }, Visibility::Everywhere);
        for i in 0..20 {
            let corner = Vec3::new(3.0 + i as f32, 0.0, -1.0);
            all.parallelogram(Parallelogram { corner, x: Vec3::Y, y: Vec3::Z * 2.0 }, Visibility::Everywhere);
        }
    });
    for y in [0.0, -0.0] {
        for z in [0.0, -1.0, 1.0, 0.3] {
            let hit = bvh.closest(&ray(Vec3::new(-1.0, y, z), Vec3::X)).expect("the wall's lower edge belongs to it");
            assert_eq!((hit.t, hit.primitive), (2.0, PrimitiveId(0)), "y {y} z {z}");
            let back = bvh.closest(&ray(Vec3::new(50.0, y, z), -Vec3::X)).expect("the wall's lower edge belongs to it");
            assert_eq!(back.primitive, PrimitiveId(21), "y {y} z {z}");
        }
    }
}

#[test]
fn a_tiny_sphere_is_hit_from_ten_million_radii() {
    let mut random = Random(8);
    let sphere = Sphere { centre: Vec3::new(0.1, 0.2, 0.3), radius: 1e-3 };
    let bvh = build(|all| {
        all.sphere(sphere, Visibility::Everywhere);
        all.sphere(Sphere { centre: Vec3::new(5e3, 0.0, 0.0), radius: 1.0 }, Visibility::Everywhere);
    });
    for _ in 0..10_000 {
        let from = random.direction() * 1e4;
        let direction = sphere.centre - from;
        let hit = bvh.closest(&ray(from, direction));
        // The direction is rounded: up to 5e-4 off at the far end, half a radius.
        assert!(hit.is_some_and(|hit| hit.primitive == PrimitiveId(0)), "from {from}");
    }
}

#[test]
fn near_hits_of_a_tiny_scene_are_not_lost() {
    let mut random = Random(9);
    let (corners, faces) = sphere_mesh(Vec3::ZERO, 1e-4, 16);
    let mesh = tree(&corners, &faces);
    let shell = build(|all| {
        all.sphere(Sphere { centre: Vec3::ZERO, radius: 1.0 }, Visibility::Everywhere);
        all.sphere(Sphere { centre: Vec3::ZERO, radius: 1.0 + 4e-5 }, Visibility::Everywhere);
    });
    for _ in 0..10_000 {
        let direction = random.direction();
        let out = ray(Vec3::ZERO, direction);
        let hit = mesh.closest(&out).expect("closed");
        let at = mesh.surface(&out, &hit);
        // 1e-6 of the scene in front of the surface, straight at it.
        let again = mesh.closest(&ray(at.position - at.normal * 1e-10, at.normal)).expect("closed");
        assert!((again.t - 1e-10).abs() < 3e-11, "{again:?}");
        // Hard case 20: the shell just above a sphere.
        let shell_hit = shell.closest(&ray(direction * 3.0, -direction)).expect("there");
        assert_eq!(shell_hit.primitive, PrimitiveId(1));
        let inner = shell.closest(&ray(direction * (1.0 + 2e-5), -direction)).expect("there");
        assert_eq!(inner.primitive, PrimitiveId(0));
    }
}

#[test]
fn equal_distances_go_to_the_lower_primitive() {
    let (corners, faces) = sphere_mesh(Vec3::ZERO, 1.0, 12);
    for reversed in [false, true] {
        let bvh = build(|all| {
            for face in &faces {
                for _ in 0..3 {
                    let mut face = face.map(|corner| corners[corner]);
                    if reversed {
                        face.swap(1, 2);
                    }
                    all.triangle(face, Visibility::Everywhere);
                }
            }
        });
        let mut random = Random(10);
        for _ in 0..10_000 {
            let hit = bvh.closest(&ray(random.cube() * 0.3, random.direction())).expect("closed");
            assert_eq!(hit.primitive.0 % 3, 0);
        }
    }
}

#[test]
fn lens_rays_pass_what_is_hidden_from_the_lens() {
    let bvh = build(|all| {
        let square = |z| Parallelogram { corner: Vec3::new(-1.0, -1.0, z), x: Vec3::X * 2.0, y: Vec3::Y * 2.0 };
        all.parallelogram(square(1.0), Visibility::HiddenFromLens);
        all.sphere(Sphere { centre: Vec3::Z * 3.0, radius: 1.0 }, Visibility::HiddenFromLens);
        all.disk(Disk { centre: Vec3::Z * 5.0, x: Vec3::X, y: Vec3::Y }, Visibility::HiddenFromLens);
        all.cylinder(
            Cylinder { p0: Vec3::new(0.0, -1.0, 7.0), p1: Vec3::new(0.0, 1.0, 7.0), x: Vec3::X, radius: 0.5 },
            Visibility::HiddenFromLens,
        );
        all.parallelogram(square(9.0), Visibility::Everywhere);
    });
    let inner = ray(Vec3::new(0.1, 0.2, 0.0), Vec3::Z);
    assert_eq!(bvh.closest(&inner).map(|hit| hit.primitive), Some(PrimitiveId(0)));
    let lens = Ray { segment: Segment::Lens, ..inner };
    assert_eq!(bvh.closest(&lens).map(|hit| hit.primitive), Some(PrimitiveId(4)));
    assert!(!bvh.occluded(&Ray { t_max: 8.0, ..lens }));
    assert!(bvh.occluded(&Ray { t_max: 8.0, ..inner }));
}

#[test]
fn every_number_of_primitives_builds() {
    for count in 1..70 {
        let bvh = build(|all| {
            for i in 0..count {
                let centre = Vec3::X * (3 * i) as f32;
                match i % 4 {
                    0 => all.sphere(Sphere { centre, radius: 1.0 }, Visibility::Everywhere),
                    1 => all.disk(Disk { centre, x: Vec3::X, y: Vec3::Y }, Visibility::Everywhere),
                    2 => all.parallelogram(Parallelogram { corner: centre, x: Vec3::X, y: Vec3::Y }, Visibility::Everywhere),
                    _ => all.triangle([centre, centre + Vec3::X, centre + Vec3::Y], Visibility::Everywhere),
                };
            }
        });
        for i in 0..count {
            let at = Vec3::new((3 * i) as f32 + 0.1, 0.1, 10.0);
            let hit = bvh.closest(&ray(at, -Vec3::Z)).expect("there");
            assert_eq!(hit.primitive, PrimitiveId(i));
        }
    }
}

#[test]
fn a_thousand_copies_of_one_triangle_build_and_answer() {
    let bvh = build(|all| {
        for _ in 0..1000 {
            all.triangle([Vec3::ZERO, Vec3::X, Vec3::Y], Visibility::Everywhere);
        }
    });
    let hit = bvh.closest(&ray(Vec3::new(0.2, 0.2, 1.0), -Vec3::Z)).expect("there");
    assert_eq!((hit.primitive, hit.t), (PrimitiveId(0), 1.0));
}
