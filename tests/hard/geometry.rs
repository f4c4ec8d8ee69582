//! Rows 18 to 29: shapes.

use std::{f64::consts::TAU, fmt::Write, fs, path::Path, sync::Arc};

use bidir::{
    load,
    plugin::Library,
    rays::{Geometry as _, Triangles},
    scene::{
        Scene,
        description::{Description, Geometry, Mesh, Shape},
    },
};
use bidir_kernel::{Heuristic, Ray, Segment, Vec3};
use glam::{DAffine3, DVec3};

use super::{
    Case, Form, Held, file,
    files::{self, bad, different, image},
    lights::Dice,
    native,
    transforms::{Change, alike, changed},
};
use crate::{
    pictures::{BDPT, LIGHT, PATH, Subject},
    scenes::{self, ball, depth, diffuse, emitter, pinhole, rgb, room, shape},
};

pub(super) const CASES: &[Case] = &[
    Case {
        number: 18,
        what: "triangles without area, slivers (1e6:1), corners that are no numbers",
        seen: "mitsuba3 1733, moonray 21",
        must: "dropped at load with a count; densities consistent",
        run: |form| [files::run(18, form), dropped(form)].concat(),
    },
    Case { number: 19, what: "coincident and coplanar surfaces", seen: "–", must: "deterministic", run: coincident },
    Case { number: 20, what: "a shell 4e-5 above a sphere", seen: "mitsuba3 1871", must: "visible", run: shell },
    Case {
        number: 21,
        what: "a scene 1e6 from the origin",
        seen: "three-gpu 812, mitsuba3 219",
        must: "finite, no leak, no acne, bounded loops",
        run: far_away,
    },
    file!(22, "the whole scene × 1e-6 … 1e6, moved, turned", "GLSL-PathTracer 35, pbrt", "the relative image does not change"),
    file!(23, "a tiny sphere from 1e7 radii", "pytracer 22", "hit"),
    file!(24, "shading normals that lean below the surface", "mitsuba3 444, 1723, pbrt-v4 385, 526", "estimators agree; finite; no leak"),
    file!(25, "a coarse mesh's terminator", "mitsuba3 1726", "estimators agree"),
    file!(26, "joined vertices nearly coincident", "pbrt-v3 73", "finite; bounded weights: estimators agree"),
    file!(27, "degenerate uv, normals of length 0", "Cycles", "a fallback frame: finite; estimators agree"),
    file!(28, "mirrored and stretched shapes and lights", "Cycles", "densities right: estimators agree"),
    Case {
        number: 29,
        what: "rays at edges and vertices of a closed mesh",
        seen: "every box test that was measured",
        must: "0 leaks, r = 1e-4 … 1e3, and 1e3 radii away",
        run: leaks,
    },
];

/// Of `slivers.obj`: two have no area, and a corner of one is no number.
fn dropped(form: Form) -> Vec<Held> {
    native(form, || {
        let file = &files::of_case(18)[0];
        let loaded = load::load(file, &[], &Library::default()).expect("a good scene");
        let said = loaded.warnings.iter().any(|warning| warning.contains("dropped 2 triangles"));
        let kept = loaded.description.primitives();
        vec![
            Held::none("warnings that do not say that 2 triangles were dropped", usize::from(!said)),
            Held::none(format!("primitives kept, {kept} of 7, that should not be, or the other way round"), kept.abs_diff(7)),
        ]
    })
}

/// Two quads in one plane, and cubes that share faces: the same picture whoever traces it.
fn coincident(form: Form) -> Vec<Held> {
    native(form, || {
        let sheet = |colour: &str, x: f64| {
            shape("rectangle", &format!(r#"<scale value="0.5"/><translate value="{x}, 0.8, 0.3"/>"#), &diffuse(colour))
        };
        let cube =
            |x: f64, colour: &str| shape("cube", &format!(r#"<scale value="0.25"/><translate value="{x}, 0.25, 1"/>"#), &diffuse(colour));
        let things = [sheet("0.8, 0.1, 0.1", 0.0), sheet("0.1, 0.8, 0.1", 0.3), cube(-0.25, "0.1, 0.1, 0.8"), cube(0.25, "0.8, 0.8, 0.1")];
        let subject = scenes::read(&[depth(5), pinhole(), room(), things.concat(), scenes::panel()].concat());
        let picture = |threads| {
            let job = subject.job(subject.strategy(BDPT, Heuristic::Balance), 16, 5);
            subject.image(&bidir::render::Job { threads, ..job })
        };
        let again = scenes::read(&[depth(5), pinhole(), room(), things.concat(), scenes::panel()].concat());
        let other = image(&again, BDPT, 16);
        let one = picture(1);
        vec![Held::none("pixels that change with the threads or from run to run", different(&one, &picture(3)) + different(&one, &other))]
    })
}

fn shell(form: Form) -> Vec<Held> {
    native(form, || {
        let ball =
            |radius: f64, content: &str| shape("sphere", &format!(r#"<scale value="{radius}"/><translate value="0, 0.8, 0"/>"#), content);
        let bright = ball(1.000_04, &(diffuse("0, 0, 0") + &emitter("area", &rgb("radiance", "1, 1, 1"))));
        let picture = |content: &str| image(&scenes::read(&[depth(3), pinhole(), content.to_owned()].concat()), PATH, 16);
        let with = picture(&(ball(1.0, &diffuse("0, 0, 0")) + &bright));
        vec![Held::none("pixels that a ball 4e-5 below the shell changes", different(&with, &picture(&bright)))]
    })
}

/// A small thing on the other side of the origin, so that the scene's own middle is of no help to its coordinates.
pub fn anchored(mut description: Description, away: DVec3) -> Description {
    let to_world = DAffine3::from_translation(-away);
    let geometry = Geometry::Sphere { center: DVec3::ZERO, radius: 1e-3, to_world, flip_normals: false };
    let first = description.shapes[0].clone();
    description.shapes.push(Shape { geometry, light: None, ..first });
    description
}

fn camera_at_a_million() -> String {
    pinhole().replace("0, 1.2, 4", "1e6, 5, 40").replace("0, 0.8, 0", "1e6, 0, 0")
}

fn far_away(form: Form) -> Vec<Held> {
    native(form, || {
        let small = scenes::read(&[depth(5), pinhole(), room(), ball(&diffuse("0.6, 0.4, 0.3")), scenes::panel()].concat());
        let as_it_is = changed(&small, &Change::scaled(1.0));
        let mut held = alike("a room 1e6 from the origin", &as_it_is, &changed(&small, &Change::moved(1e6 / 4.0)));
        // A dark room 100 units wide under a bright sky, kept at 1e6 in f32, where a step is 0.06.
        let walls = shape("cube", r#"<scale value="50"/><translate value="1e6, 0, 0"/>"#, &diffuse("0.9, 0.9, 0.9"));
        let within = shape("sphere", r#"<scale value="20"/><translate value="1e6, 0, -20"/>"#, &diffuse("0.9, 0.9, 0.9"));
        let sky = emitter("constant", &rgb("radiance", "1e6, 1e6, 1e6"));
        let description = scenes::read(&[depth(64), camera_at_a_million(), walls, within, sky].concat()).description;
        let description = anchored(description, DVec3::new(1e6, 0.0, 0.0));
        let scene = Scene::new(&description).expect("a scene");
        let dark = Subject { description, scene };
        let pictures = [PATH, LIGHT, BDPT].map(|techniques| image(&dark, techniques, 64));
        // A bright one: each wall sends out 1 and half of what arrives. Acne or lost light would show in the mean.
        let walls = r#"<boolean name="flip_normals" value="true"/>"#.to_owned()
            + &diffuse("0.5, 0.5, 0.5")
            + &emitter("area", &rgb("radiance", "1, 1, 1"));
        let furnace = shape("sphere", r#"<scale value="50"/><translate value="1e6, 0, 0"/>"#, &walls);
        let description = scenes::read(&[depth(-1), camera_at_a_million(), furnace].concat()).description;
        let description = anchored(description, DVec3::new(1e6, 0.0, 0.0));
        let scene = Scene::new(&description).expect("a scene");
        let bright = Subject { description, scene };
        for (name, techniques) in [("path", PATH), ("bdpt", BDPT)] {
            let found = bright.pictures(bright.strategy(techniques, Heuristic::Balance), 64, 1);
            held.extend(files::known(&format!("a furnace at 1e6, {name}"), &found.mean(found.whole(), &[0, 1, 2]), 2.0, 0.01));
        }
        held.push(Held::none("bad values in a dark room at 1e6", pictures.iter().map(bad).sum()));
        let lit = |picture: &bidir::image::Image| picture.pixels.iter().filter(|pixel| **pixel != [0.0; 3]).count();
        held.push(Held::none("pixels of a dark room at 1e6 that the sky leaks into", pictures.iter().map(lit).sum()));
        held
    })
}

/// A closed ball of triangles, as the text of an OBJ file.
fn globe(radius: f64, centre: f64) -> String {
    const ROWS: usize = 20;
    const COLUMNS: usize = 40;
    let mut text = String::new();
    let mut vertex = |polar: f64, turn: f64| {
        let (x, y, z) = (polar.sin() * turn.cos(), polar.cos(), polar.sin() * turn.sin());
        writeln!(text, "v {} {} {}", (centre + radius * x) as f32, (radius * y) as f32, (radius * z) as f32).expect("a text");
    };
    vertex(0.0, 0.0);
    for row in 1..ROWS {
        (0..COLUMNS).for_each(|column| vertex(TAU * 0.5 * row as f64 / ROWS as f64, TAU * column as f64 / COLUMNS as f64));
    }
    vertex(TAU * 0.5, 0.0);
    let at = |row: usize, column: usize| match row {
        0 => 1,
        ROWS => 2 + (ROWS - 1) * COLUMNS,
        _ => 2 + (row - 1) * COLUMNS + column % COLUMNS,
    };
    for row in 0..ROWS {
        for column in 0..COLUMNS {
            let [a, b, c, d] = [at(row, column), at(row, column + 1), at(row + 1, column), at(row + 1, column + 1)];
            if row > 0 {
                writeln!(text, "f {a} {b} {d}").expect("a text");
            }
            if row + 1 < ROWS {
                writeln!(text, "f {a} {d} {c}").expect("a text");
            }
        }
    }
    text
}

/// Such a ball as a scene, and its mesh, in coordinates that are kept as they are.
pub(crate) fn globe_scene(radius: f64, centre: f64, triangles: Triangles) -> (Scene, Arc<Mesh>) {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("globe.obj"), globe(radius, centre)).expect("a mesh");
    let mesh = r#"<shape type="obj"><string name="filename" value="globe.obj"/></shape>"#;
    let text = format!(r#"<scene version="3.0.0">{}{mesh}</scene>"#, pinhole());
    let read = load::load_str(&text, Path::new("globe.xml"), Some(folder.path()), &[], &Library::default());
    let description = read.expect("a good scene").description;
    let description = if centre == 0.0 { description } else { anchored(description, DVec3::new(centre, 0.0, 0.0)) };
    let Geometry::Mesh { mesh, .. } = description.shapes[0].geometry.clone() else { panic!("no mesh") };
    (Scene::new(&description).expect("a scene").with_triangles(triangles), mesh)
}

/// Rays from within at the edges and vertices of closed balls that get out.
pub fn lost_rays(radius: f64, centre: f64, rays: usize, triangles: Triangles) -> usize {
    let (scene, mesh) = globe_scene(radius, centre, triangles);
    let origin = (DVec3::new(centre, 0.0, 0.0) - scene.origin()).as_vec3();
    let corner = |i: u32| (Vec3::from(mesh.positions[i as usize]).as_dvec3() - scene.origin()).as_vec3();
    let mut numbers = Dice::new(9);
    (0..rays)
        .filter(|turn| {
            let [a, b, c] = mesh.triangles[numbers.below(mesh.triangles.len())].map(corner);
            let share = if turn % 2 == 0 { 0.0 } else { numbers.number() };
            let target = a + (b - a) * share;
            // From somewhere in the inner half.
            let from = origin + (c - origin) * (0.5 * numbers.number());
            let ray = Ray { origin: from, direction: target - from, t_max: f32::INFINITY, segment: Segment::Inner };
            scene.geometry().closest(&ray).is_none()
        })
        .count()
}

fn leaks(form: Form) -> Vec<Held> {
    native(form, || {
        let places = [(1e-4, 0.0), (1e-3, 0.0), (1.0, 0.0), (1e3, 0.0), (1.0, 1e3)];
        let lost = places.iter().map(|(radius, centre)| lost_rays(*radius, *centre, 200_000, Triangles::Watertight)).sum();
        vec![Held::none("of 1e6 rays at edges and vertices, those that get out", lost)]
    })
}
