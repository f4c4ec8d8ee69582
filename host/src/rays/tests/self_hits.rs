//! Rays that leave a surface must not find it again.

use bidir_kernel::Vec3;

use super::random::{Random, ray, segment, sphere_mesh, tree};
use crate::rays::{Bvh, Cylinder, Disk, Geometry, Parallelogram, Primitives, Sphere, Visibility};

const BOUNCES: usize = 1_000_000;
const PLACES: [(f32, Vec3); 6] = [
    (1e-3, Vec3::ZERO),
    (1.0, Vec3::ZERO),
    (1e3, Vec3::ZERO),
    (1e-3, Vec3::new(5.0, -4.0, 3.0)),
    (1.0, Vec3::new(5e3, -4e3, 3e3)),
    (1e3, Vec3::new(5e6, -4e6, 3e6)),
];

/// Shoots from outside, leaves to the outside: a convex body must not be in the way, nor may it be on the segment back.
fn outside_self_hits(bvh: &Bvh, centre: Vec3, radius: f32) -> usize {
    let mut random = Random(5);
    let (mut hits, mut bad) = (0, 0);
    while hits < BOUNCES {
        let origin = centre + random.direction() * radius * 3.0;
        let into = ray(origin, centre + random.cube() * radius - origin);
        let Some(hit) = bvh.closest(&into) else { continue };
        let at = bvh.surface(&into, &hit);
        hits += 1;
        let side = if into.direction.dot(at.normal) < 0.0 { 1.0 } else { -1.0 };
        let spawn = at.position + at.normal * (at.offset * side);
        let mut out = random.direction();
        if out.dot(at.normal) * side < 0.0 {
            out = -out;
        }
        bad += usize::from(bvh.occluded(&ray(spawn, out)));
        // Back and forth along the ray that came, unless it grazes so much that it may have clipped an edge.
        if into.direction.normalize().dot(at.normal).abs() > 0.05 {
            bad += usize::from(bvh.occluded(&segment(spawn, origin)));
            bad += usize::from(bvh.occluded(&segment(origin, spawn)));
        }
    }
    bad
}

/// Stays inside a closed body and counts the bounces that end nowhere.
fn escapes(bvh: &Bvh, centre: Vec3) -> usize {
    let mut random = Random(6);
    let mut escapes = 0;
    let mut current = ray(centre, random.direction());
    for _ in 0..BOUNCES {
        let Some(hit) = bvh.closest(&current) else {
            escapes += 1;
            current = ray(centre, random.direction());
            continue;
        };
        let at = bvh.surface(&current, &hit);
        let side = if current.direction.dot(at.normal) < 0.0 { 1.0 } else { -1.0 };
        let mut out = random.direction();
        if out.dot(at.normal) * side < 0.0 {
            out = -out;
        }
        current = ray(at.position + at.normal * (at.offset * side), out);
    }
    escapes
}

/// Leaves every flat face it hits to either side and counts how often the next hit is the same face.
fn returns(bvh: &Bvh, centre: Vec3, radius: f32) -> usize {
    let mut random = Random(4);
    let mut returns = 0;
    for i in 0..BOUNCES {
        let origin = centre + random.direction() * radius * 3.0;
        let into = ray(origin, centre + random.cube() * radius - origin);
        let Some(hit) = bvh.closest(&into) else { continue };
        let at = bvh.surface(&into, &hit);
        // Half of the directions graze.
        let out = random.direction();
        let out = if i % 2 == 0 { out } else { out - at.normal * (out.dot(at.normal) * 0.9999) };
        let side = out.dot(at.normal).signum();
        let next = bvh.closest(&ray(at.position + at.normal * (at.offset * side), out));
        returns += usize::from(next.is_some_and(|next| next.primitive == hit.primitive));
    }
    returns
}

fn one(insert: impl FnOnce(&mut Primitives)) -> Bvh {
    let mut primitives = Primitives::new();
    insert(&mut primitives);
    Bvh::build(primitives)
}

#[test]
fn a_closed_mesh_never_hits_itself_from_outside_nor_loses_a_bounce_inside() {
    for (radius, centre) in PLACES {
        let (corners, faces) = sphere_mesh(centre, radius, 12);
        let bvh = tree(&corners, &faces);
        // 5,000 sizes away a corner moves by 2e-4 sizes when it is rounded: the body is not quite convex, so only its inside counts.
        if centre == Vec3::ZERO {
            assert_eq!(outside_self_hits(&bvh, centre, radius), 0, "radius {radius} at {centre}");
        }
        assert_eq!(returns(&bvh, centre, radius), 0, "radius {radius} at {centre}");
        assert_eq!(escapes(&bvh, centre), 0, "radius {radius} at {centre}");
    }
}

#[test]
fn a_sphere_never_hits_itself() {
    for (radius, centre) in PLACES {
        let bvh = one(|all| _ = all.sphere(Sphere { centre, radius }, Visibility::Everywhere));
        assert_eq!(outside_self_hits(&bvh, centre, radius), 0, "radius {radius} at {centre}");
        assert_eq!(escapes(&bvh, centre), 0, "radius {radius} at {centre}");
    }
}

#[test]
fn flat_shapes_and_cylinders_never_hit_themselves() {
    let (x, y) = (Vec3::new(0.6, 0.5, -0.2), Vec3::new(-0.1, 0.4, 0.8));
    for (radius, centre) in PLACES {
        let (x, y) = (x * radius, y * radius);
        let disk = one(|all| _ = all.disk(Disk { centre, x, y }, Visibility::Everywhere));
        let sheet = one(|all| _ = all.parallelogram(Parallelogram { corner: centre - x, x, y }, Visibility::Everywhere));
        let triangle = one(|all| _ = all.triangle([centre - x, centre + x, centre + y], Visibility::Everywhere));
        let tube = Cylinder { p0: centre - x, p1: centre + x, x: y, radius: radius * 0.5 };
        let tube = one(|all| _ = all.cylinder(tube, Visibility::Everywhere));
        for (name, bvh) in [("disk", disk), ("sheet", sheet), ("triangle", triangle)] {
            assert_eq!(outside_self_hits(&bvh, centre, radius), 0, "{name} of size {radius} at {centre}");
        }
        // Seen from outside only: through its open ends a ray may reach the inside, whose normal then is the other.
        let mut random = Random(7);
        for _ in 0..BOUNCES {
            let origin = centre + random.direction() * radius * 3.0;
            let into = ray(origin, centre + random.cube() * radius * 0.5 - origin);
            let Some(hit) = tube.closest(&into) else { continue };
            let at = tube.surface(&into, &hit);
            if into.direction.dot(at.normal) < 0.0 {
                let out = random.direction();
                let out = if out.dot(at.normal) < 0.0 { -out } else { out };
                assert!(!tube.occluded(&ray(at.position + at.normal * at.offset, out)), "cylinder of size {radius} at {centre}");
            }
        }
    }
}
