//! Rays that leave a surface never find what they left, in any scene, small or large, near or far.
//!
//! 5,000 sizes from the middle of its coordinates, where f32 tells 3,300 places along a scene apart, a mesh may be dented by
//! rounding, and neighbouring triangles see each other; no flat primitive sees itself, and no convex one from outside.

use std::{fs, path::Path};

use bidir::{
    load,
    plugin::Library,
    rays::{Geometry as _, RayHit},
    scene::{
        Scene,
        description::{Description, Geometry, Shape},
        shape::Form,
    },
};
use bidir_kernel::{Ray, Segment, Vec3};

use crate::{
    instances::{folder_with_ball, furnished_room, group, instance},
    random::Random,
    scenes::*,
};

/// Of all scenes and places together; `BIDIR_BOUNCES` sets how many there are for each.
const BOUNCES: usize = 1_000_000;
const SCALES: [f64; 3] = [1e-3, 1.0, 1e3];
/// In sizes of the scene.
const AWAY: [f64; 2] = [0.0, 5_000.0];

/// The scenes that come with the program, and those that these tests are made of.
fn subjects() -> Vec<(String, Description)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/scenes");
    let mut files: Vec<_> = fs::read_dir(&folder).expect("scenes").map(|entry| entry.expect("an entry").path().join("scene.xml")).collect();
    files.retain(|file| file.is_file());
    files.push(folder.join("welcome.xml"));
    files.sort();
    let loaded = |file: &Path| load::load(file, &[], &Library::default()).expect("a good scene").description;
    let mut all: Vec<_> = files.iter().map(|file| (file.display().to_string(), loaded(file))).collect();

    let folder = folder_with_ball();
    fs::write(folder.path().join("octahedron.obj"), OCTAHEDRON).expect("a mesh");
    let mesh = |name: &str, at: &str| shape("obj", at, &format!(r#"<string name="filename" value="{name}.obj"/>"#));
    let at = r#"<scale value="0.4"/><translate value="0, 0.7, 0"/>"#;
    let skewed = r#"<scale value="0.5, -0.2, 0.3"/><rotate x="1" y="1" angle="50"/><translate value="0.3, 0.9, 0.2"/>"#;
    let stretched = group("g", &[mesh("ball", ""), shape("sphere", r#"<translate y="3"/>"#, ""), shape("cylinder", "", "")].concat());
    for (name, content) in [
        ("a ball", ball("")),
        ("a tube", shape("cylinder", at, "")),
        ("a disk", shape("disk", at, "")),
        ("a coarse mesh", mesh("octahedron", at)),
        ("a bumpy mesh", mesh("ball", at)),
        ("instances", stretched + &instance("g", skewed) + &instance("g", at)),
    ] {
        let subject = read_beside(&[pinhole(), room(), content, panel()].concat(), Some(folder.path()));
        all.push((name.to_owned(), subject.description));
    }
    all.push(("a furnished room".to_owned(), read(&furnished_room(true)).description));
    all
}

/// The scene, scaled and so many of its sizes away from the middle, and the box that it is in.
fn moved(subject: &Description, scale: f64, away: f64) -> (Scene, [Vec3; 2]) {
    let as_it_is = Scene::new(subject).expect("a scene");
    let bounds = as_it_is.geometry().bounds();
    let half = (bounds.max - bounds.min).as_dvec3() * (0.5 * scale);
    let size = 2.0 * half.max_element();
    let mut towards = half;
    (towards.x, towards.y, towards.z) = (0.64, -0.48, 0.6);
    let offset = towards * (size * away);
    let origin = as_it_is.origin() + (0.5 * (bounds.min + bounds.max)).as_dvec3();
    let mut description = subject.clone();
    for shape in &mut description.shapes {
        let (Geometry::Mesh { to_world, .. }
        | Geometry::Rectangle { to_world, .. }
        | Geometry::Disk { to_world, .. }
        | Geometry::Sphere { to_world, .. }
        | Geometry::Cylinder { to_world, .. }) = &mut shape.geometry;
        to_world.matrix3 *= scale;
        to_world.translation = (to_world.translation - origin) * scale + offset;
    }
    for instance in &mut description.instances {
        instance.to_world.matrix3 *= scale;
        instance.to_world.translation = (instance.to_world.translation - origin) * scale + offset;
    }
    if away > 0.0 {
        // As far away on the other side, or the scene would be about its own middle again.
        let (mut to_world, radius) = (description.sensor.to_world, 0.01 * size);
        to_world.matrix3 = to_world.matrix3.inverse() * to_world.matrix3;
        to_world.translation = -offset;
        let geometry = Geometry::Sphere { center: offset * 0.0, radius, to_world, flip_normals: false };
        description.shapes.push(Shape { geometry, light: None, ..description.shapes[0].clone() });
    }
    let scene = Scene::new(&description).expect("a scene");
    let centre = offset - scene.origin();
    let corners = [centre - half, centre + half].map(|corner| corner.as_vec3());
    (scene, corners)
}

/// Bounces about and counts rays that find again what they leave.
fn self_hits(scene: &Scene, [low, high]: [Vec3; 2], bounces: usize) -> usize {
    let tree = scene.geometry();
    let mut random = Random(9);
    let mut bad = 0;
    let mut from: Option<(Ray, RayHit)> = None;
    let mut made = 0;
    let mut tries = 0;
    while made < bounces {
        let Some((ray, hit)) = from.take() else {
            let origin = 0.5 * (low + high) + 0.5 * (high - low) * random.cube();
            let ray = Ray { origin, direction: random.direction(), t_max: f32::INFINITY, segment: Segment::Inner };
            from = tree.closest(&ray).map(|hit| (ray, hit));
            tries += 1;
            assert!(tries < 100 * bounces + 1000, "nothing is hit");
            continue;
        };
        made += 1;
        let (point, shape) = scene.met(&ray, &hit);
        // The normal that the form has, which points outwards where there is an outside.
        let normal = tree.surface(&ray, &hit).normal;
        let out = random.direction();
        // Half of the directions graze.
        let out = if made % 2 == 0 { out } else { (out - normal * (out.dot(normal) * 0.9999)).normalize() };
        let next = Ray::leaving(&point, out, Segment::Inner);
        let found = tree.closest(&next);
        let may_not = match scene.shapes()[shape as usize].form {
            Form::Sphere(..) | Form::Cylinder { .. } => out.dot(normal) > 0.0,
            Form::Parallelogram(..) | Form::Disk(..) | Form::Mesh(_) => true,
        };
        if let Some(again) = found.filter(|again| may_not && tree.path(again).eq(tree.path(&hit))) {
            bad += 1;
            println!("{ray:?} met {hit:?} at {point:?}; {next:?} meets it again: {again:?}");
        }
        from = found.map(|hit| (next, hit));
    }
    bad
}

#[test]
fn no_ray_finds_the_primitive_that_it_left() {
    let subjects = subjects();
    let places = subjects.len() * SCALES.len() * AWAY.len();
    let bounces = std::env::var("BIDIR_BOUNCES").ok().and_then(|text| text.parse().ok()).unwrap_or(BOUNCES.div_ceil(places));
    let mut failures = Vec::new();
    for (name, subject) in &subjects {
        for scale in SCALES {
            for away in AWAY {
                let (scene, corners) = moved(subject, scale, away);
                let bad = self_hits(&scene, corners, bounces);
                if bad > 0 {
                    failures.push(format!("{name}, scale {scale}, {away} sizes away: {bad} self-hits"));
                }
            }
        }
    }
    println!("{places} scenes and places, {bounces} bounces each: {} with self-hits", failures.len());
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
