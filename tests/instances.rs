//! What stands in an instance is what would stand there if it were written out.

use std::{fmt::Write, fs, sync::Arc};

use bidir::{
    error::Error,
    load,
    plugin::Library,
    rays::{Geometry as _, LEVELS, Primitives},
    scene::{
        Scene,
        description::{Description, Geometry, GroupId},
    },
};
use bidir_kernel::{Heuristic, Point, Ray, Segment, Vec3};
use tempfile::TempDir;

use crate::{
    pictures::{BDPT, PATH, Subject, mean_of},
    random::Random,
    scenes::*,
};

/// A group, by its id.
pub fn group(id: &str, content: &str) -> String {
    format!(r#"<shape type="shapegroup" id="{id}">{content}</shape>"#)
}

/// Where it stands.
pub fn instance(id: &str, transform: &str) -> String {
    format!(r#"<shape type="instance"><ref id="{id}"/><transform name="to_world">{transform}</transform></shape>"#)
}

/// A folder with a bumpy ball in it, `ball.obj`: about (0.4, 1, −0.3), with normals of its own and coordinates.
pub fn folder_with_ball() -> TempDir {
    const ROWS: usize = 24;
    const COLUMNS: usize = 48;
    let mut text = String::new();
    for row in 0..=ROWS {
        for column in 0..=COLUMNS {
            let (v, u) = (row as f32 / ROWS as f32, column as f32 / COLUMNS as f32);
            let (polar, turn) = ((0.05 + 0.9 * v) * std::f32::consts::PI, u * 2.0 * std::f32::consts::PI);
            let out = Vec3::new(polar.sin() * turn.cos(), polar.cos(), polar.sin() * turn.sin());
            let radius = 1.0 + 0.05 * (3.0 * turn).sin() * (5.0 * polar).sin();
            let p = out * radius + Vec3::new(0.4, 1.0, -0.3);
            let n = out + Vec3::new(0.1 * (4.0 * turn).sin(), 0.0, 0.1);
            writeln!(text, "v {} {} {}\nvn {} {} {}\nvt {u} {v}", p.x, p.y, p.z, n.x, n.y, n.z).expect("a text");
        }
    }
    for row in 0..ROWS {
        for column in 0..COLUMNS {
            let at = |down: usize, right: usize| (row + down) * (COLUMNS + 1) + column + right + 1;
            let corner = |i: usize| format!("{i}/{i}/{i}");
            let [a, b, c, d] = [at(0, 0), at(0, 1), at(1, 0), at(1, 1)].map(corner);
            writeln!(text, "f {a} {b} {d}\nf {a} {d} {c}").expect("a text");
        }
    }
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("ball.obj"), text).expect("a mesh");
    folder
}

/// Coordinates and tangents are asked for where a material depends on them.
const BRUSHED: &str = r#"<bsdf type="roughconductor"><float name="alpha_u" value="0.4"/><float name="alpha_v" value="0.1"/></bsdf>"#;
const BALL: &str = r#"<string name="filename" value="ball.obj"/>"#;

/// How the shapes of a group stand in it, and how the group stands.
const WITHIN: &str = r#"<rotate x="1" angle="25"/><scale value="0.7"/><translate value="3, -1, 2"/>"#;
const RIGID: &str = r#"<scale value="1.6"/><rotate x="1" y="2" z="-1" angle="70"/><translate value="4, 5, -9"/>"#;
const SKEWED: &str = r#"<scale value="1.4, 0.5, 0.9"/><matrix value="1 0.6 0  0 1 0.3  -0.2 0 1"/><rotate x="1" y="2" z="-1" angle="70"/>
    <translate value="4, 5, -9"/>"#;
const MIRRORED: &str = r#"<scale value="-1.4, 0.5, 0.9"/><matrix value="1 0.6 0  0 1 0.3  -0.2 0 1"/><translate value="-4, 2, 7"/>"#;

/// The same shape, once in an instance and once written out.
fn both(kind: &str, content: &str, transform: &str) -> [Subject; 2] {
    both_by_way_of(["", ""], kind, content, transform)
}

/// The same; `there` is how the group's coordinates begin, and `back` undoes it.
fn both_by_way_of([there, back]: [&str; 2], kind: &str, content: &str, transform: &str) -> [Subject; 2] {
    let folder = folder_with_ball();
    let content = content.to_owned() + BRUSHED;
    let instanced = group("g", &shape(kind, &format!("{WITHIN}{there}"), &content)) + &instance("g", &format!("{back}{transform}"));
    let flat = shape(kind, &format!("{WITHIN}{transform}"), &content);
    [instanced, flat].map(|shapes| read_beside(&(pinhole() + &shapes), Some(folder.path())))
}

fn ray(origin: Vec3, direction: Vec3) -> Ray {
    Ray { origin, direction, t_max: f32::INFINITY, segment: Segment::Inner }
}

/// Rays from all around into the box of a scene.
fn rays_into(scene: &Scene, count: usize) -> impl Iterator<Item = Ray> {
    let bounds = scene.geometry().bounds();
    let (centre, half) = (0.5 * (bounds.min + bounds.max), 0.5 * (bounds.max - bounds.min));
    let mut random = Random(11);
    (0..count).map(move |_| {
        let origin = centre + random.direction() * (3.0 * half.length());
        ray(origin, centre + random.cube() * half - origin)
    })
}

/// How many rays hit both in the same place; the points there are compared.
fn compare([instanced, flat]: &[Subject; 2]) -> usize {
    let (bounds, other) = (instanced.scene.geometry().bounds(), flat.scene.geometry().bounds());
    let size = (other.max - other.min).length();
    // Boxes about boxes are larger, and their middles lie elsewhere.
    let shift = (flat.scene.origin() - instanced.scene.origin()).as_vec3();
    assert!((bounds.max - bounds.min).length() >= 0.999 * size);
    let (mut hits, mut misses) = (0, 0);
    for one in rays_into(&flat.scene, 40_000) {
        let moved = ray(one.origin + shift, one.direction);
        let (a, b) = (flat.scene.geometry().closest(&one), instanced.scene.geometry().closest(&moved));
        let (Some(a), Some(b)) = (a, b) else {
            misses += usize::from(a.is_some() != b.is_some());
            continue;
        };
        let last = instanced.scene.geometry().path(&b).last().expect("a primitive");
        if last != a.primitive {
            misses += 1;
            continue;
        }
        hits += 1;
        let (a, b) = (flat.scene.met(&one, &a).0, instanced.scene.met(&moved, &b).0);
        same(&a, &Point { position: b.position - shift, ..b }, one.direction.normalize(), size);
    }
    assert!(misses < hits / 50, "{misses} misses, {hits} hits");
    hits
}

fn same(a: &Point, b: &Point, direction: Vec3, size: f32) {
    // Where a ray grazes, its hit lies anywhere along it.
    let slant = a.normal.dot(direction).abs().max(1e-3);
    assert!((a.position - b.position).length() * slant < 1e-5 * size, "{a:?}\n{b:?}");
    if slant < 0.05 {
        return;
    }
    assert!(a.normal.dot(b.normal) > 0.9999, "{a:?}\n{b:?}");
    assert!(a.frame.z.dot(b.frame.z) > 0.9999, "{a:?}\n{b:?}");
    assert!(a.frame.x.dot(b.frame.x) > 0.999, "{a:?}\n{b:?}");
    assert!(a.frame.y.dot(b.frame.y) > 0.999, "{a:?}\n{b:?}");
    let turned = (a.uv - b.uv).abs();
    // Round the seam, u may be 0 or 1.
    assert!(turned.max_element() < 1e-3 || (turned - 1.0).abs().min_element() < 1e-3, "{a:?}\n{b:?}");
}

#[test]
fn a_mesh_in_an_instance_is_the_mesh_written_out_whatever_the_transform() {
    for transform in [RIGID, SKEWED, MIRRORED] {
        let hits = compare(&both("obj", BALL, transform));
        assert!(hits > 10_000, "{hits}");
    }
}

#[test]
fn every_shape_in_an_instance_is_the_shape_written_out() {
    for (kind, transform) in [
        ("rectangle", SKEWED),
        ("rectangle", MIRRORED),
        ("disk", RIGID),
        ("disk", MIRRORED),
        ("sphere", RIGID),
        ("cylinder", RIGID),
        ("cube", SKEWED),
    ] {
        let hits = compare(&both(kind, "", transform));
        assert!(hits > 1_000, "{kind}: {hits}");
    }
}

/// In f32, a million sizes away, there would be nothing left of the mesh's triangles.
#[test]
fn a_group_far_from_where_its_coordinates_begin_loses_nothing() {
    let there_and_back = [r#"<translate value="1e6, -2e6, 3e6"/>"#, r#"<translate value="-1e6, 2e6, -3e6"/>"#];
    let hits = compare(&both_by_way_of(there_and_back, "obj", BALL, SKEWED));
    assert!(hits > 10_000, "{hits}");
}

/// A sphere cannot be scaled unequally when it is written out; in an instance it is an ellipsoid, (x/2)² + (2y)² + z² = 1.
#[test]
fn a_stretched_sphere_is_an_ellipsoid() {
    let content = group("g", &shape("sphere", "", BRUSHED)) + &instance("g", r#"<scale value="2, 0.5, -1"/>"#);
    let Subject { scene, .. } = read(&(pinhole() + &content));
    let mut hits = 0;
    for ray in rays_into(&scene, 5_000) {
        let Some(hit) = scene.geometry().closest(&ray) else { continue };
        hits += 1;
        let (at, _) = scene.met(&ray, &hit);
        let Vec3 { x, y, z } = at.position;
        assert!((0.25 * x * x + 4.0 * y * y + z * z - 1.0).abs() < 1e-5, "{at:?}");
        let normal = Vec3::new(0.25 * x, 4.0 * y, z).normalize();
        assert!(at.normal.dot(normal) > 0.99999 && at.frame.z.dot(normal) > 0.99999, "{at:?}");
    }
    assert!(hits > 1_000);
}

/// Furniture of the room: a ball, a box, a tube and a plate, at most moved, turned and scaled evenly.
fn furniture(instanced: bool) -> String {
    let glossy = bsdf("roughconductor", &float("alpha", 0.3));
    let pieces = [
        ("sphere", r#"<scale value="0.3"/><translate value="0, 0.3, 0"/>"#, glossy),
        ("cube", r#"<scale value="0.15"/><rotate y="1" angle="30"/><translate value="0.5, 0.15, 0.1"/>"#, diffuse("0.7, 0.5, 0.2")),
        ("cylinder", r#"<scale value="0.1"/><rotate x="1" angle="-90"/><translate value="-0.4, 0.1, 0.2"/>"#, bsdf("plastic", "")),
        ("disk", r#"<scale value="0.2"/><rotate x="1" angle="-90"/><translate value="0, 0.01, 0.6"/>"#, diffuse("0.2, 0.7, 0.3")),
    ];
    let places = [
        r#"<translate value="-0.7, 0, -0.4"/>"#,
        r#"<scale value="1.3"/><rotate y="1" angle="130"/><translate value="0.6, 0.02, 0"/>"#,
        r#"<scale value="0.6"/><rotate x="1" angle="80"/><translate value="0, 1.4, -1"/>"#,
    ];
    let within = |place: &str| pieces.iter().map(|(kind, at, material)| shape(kind, &format!("{at}{place}"), material)).collect::<String>();
    if !instanced {
        return places.map(within).concat();
    }
    group("furniture", &within("")) + &places.map(|place| instance("furniture", place)).concat()
}

/// The room with furniture in three places.
pub fn furnished_room(instanced: bool) -> String {
    [depth(6), pinhole(), room(), furniture(instanced), panel()].concat()
}

/// The same random numbers make the same paths but for rounding; only where that changes a choice do pixels differ.
#[test]
fn instances_make_the_picture_of_the_scene_written_out() {
    let [instanced, flat] = [true, false].map(|instanced| read(&furnished_room(instanced)));
    for techniques in [PATH, BDPT] {
        let image = |subject: &Subject| subject.image(&subject.job(subject.strategy(techniques, Heuristic::Balance), 64, 3));
        let (a, b) = (image(&instanced), image(&flat));
        let (a_mean, b_mean) = (mean_of(&a), mean_of(&b));
        let near = |(a, b): (&[f32; 3], &[f32; 3])| (0..3).all(|band| (a[band] - b[band]).abs() <= 1e-2 * b[band]);
        let near = a.pixels.iter().zip(&b.pixels).filter(|pair| near(*pair)).count();
        println!("{techniques:?}: means {a_mean} and {b_mean}, {near} of {} pixels within 1 %", a.pixels.len());
        assert!((a_mean / b_mean - 1.0).abs() < 2e-3, "{a_mean} and {b_mean}");
        assert!(near * 10 > a.pixels.len() * 9, "{near} of {} pixels are alike", a.pixels.len());
    }
}

/// Groups g0 … within each other; the innermost holds a sphere.
fn nested(levels: usize) -> String {
    let step = r#"<scale value="1.1, 0.9, 1"/><rotate z="1" angle="10"/><translate value="1, 0, 2"/>"#;
    let mut text = group("g0", &shape("sphere", "", ""));
    for level in 1..levels {
        text += &group(&format!("g{level}"), &instance(&format!("g{}", level - 1), step));
    }
    text + &instance(&format!("g{}", levels - 1), step)
}

fn refused(content: &str) -> Error {
    let text = format!("<scene version=\"3.0.0\">{}{content}</scene>", pinhole());
    let loaded = load::load_str(&text, std::path::Path::new("test.xml"), None, &[], &Library::default());
    loaded.and_then(|loaded| Scene::new(&loaded.description)).map(|_| ()).expect_err("an error")
}

#[test]
fn eight_levels_are_rendered_and_nine_refused() {
    let Subject { scene, .. } = read(&(pinhole() + &nested(LEVELS)));
    let hits = rays_into(&scene, 20_000).filter(|ray| {
        let hit = scene.geometry().closest(ray);
        hit.inspect(|hit| assert_eq!(scene.geometry().path(hit).count(), LEVELS + 1)).is_some()
    });
    assert!(hits.count() > 200);
    let error = refused(&nested(LEVELS + 1));
    assert!(error.place.is_some() && error.thing.contains("more than 8 deep"), "{error}");
}

#[test]
fn a_description_by_hand_is_held_to_what_files_are() {
    let Subject { description, .. } = read(&(pinhole() + &nested(2)));
    let changed = |change: &dyn Fn(&mut Description)| {
        let mut description = description.clone();
        change(&mut description);
        Scene::new(&description).map(|_| ()).expect_err("an error").thing
    };
    assert!(changed(&|all| all.instances[0].group = GroupId(7)).contains("does not stand before it"));
    assert!(changed(&|all| all.groups.reverse()).contains("does not stand before it"));
    assert!(changed(&|all| all.instances[0].to_world.matrix3.x_axis *= 0.0).contains("flattens"));
    assert!(changed(&|all| all.instances[0].to_world.matrix3.x_axis *= 1e31).contains("reaches farther"));
    assert!(
        changed(&|all| {
            let light = read(&(pinhole() + &panel())).description.shapes;
            Arc::make_mut(&mut all.groups[0]).shapes = light;
        })
        .contains("shines")
    );
}

/// A mesh of a million triangles named three hundred times takes no memory, and is refused before it would take any.
#[test]
fn more_primitives_than_a_tree_holds_are_one_error() {
    let mut description = read(&(pinhole() + &shape("cube", "", ""))).description;
    if let Geometry::Mesh { mesh, .. } = &mut description.shapes[0].geometry {
        Arc::make_mut(mesh).triangles = vec![[0, 1, 2]; 1 << 20];
    }
    description.shapes = vec![description.shapes[0].clone(); Primitives::MOST / (1 << 20) + 1];
    let error = Scene::new(&description).expect_err("too many").to_string();
    assert!(error.starts_with("test.xml:1:") && error.contains("more than 268435455") && error.contains("shapegroup"), "{error}");
}

/// Moving an instance, and changing what is in one group of two, builds nothing else again.
#[test]
fn a_scene_that_changed_is_rebuilt_with_the_trees_that_did_not() {
    let folder = folder_with_ball();
    let content = [
        pinhole(),
        group("a", &shape("obj", WITHIN, &(BALL.to_owned() + BRUSHED))),
        group("b", &(shape("sphere", "", "") + &shape("cube", r#"<translate x="3"/>"#, BRUSHED))),
        group("c", &instance("b", RIGID)),
        instance("a", SKEWED) + &instance("a", MIRRORED) + &instance("b", RIGID) + &instance("c", SKEWED),
    ];
    let Subject { mut description, scene } = read_beside(&content.concat(), Some(folder.path()));
    let kept = |from: &Scene, to: &Scene| {
        let tree = |scene: &Scene, id| Arc::clone(scene.group(GroupId(id)).expect("a group"));
        [0, 1, 2].map(|id| Arc::ptr_eq(&tree(from, id), &tree(to, id)))
    };
    description.instances[1].to_world.translation.x += 5.0;
    let moved = scene.rebuilt(&description).expect("a scene");
    assert_eq!(kept(&scene, &moved), [true; 3]);
    answers_are_the_same(&moved, &Scene::new(&description).expect("a scene"));

    Arc::make_mut(&mut description.groups[1]).shapes.remove(0);
    let changed = moved.rebuilt(&description).expect("a scene");
    assert_eq!(kept(&moved, &changed), [true, false, false], "c shows b");
    answers_are_the_same(&changed, &Scene::new(&description).expect("a scene"));
}

fn answers_are_the_same(a: &Scene, b: &Scene) {
    let mut hits = 0;
    for ray in rays_into(a, 20_000) {
        let [one, other] = [a, b].map(|scene| scene.geometry().closest(&ray).map(|hit| (hit, scene.met(&ray, &hit))));
        hits += usize::from(one.is_some());
        assert_eq!(format!("{one:?}"), format!("{other:?}"));
    }
    assert!(hits > 1_000);
}
