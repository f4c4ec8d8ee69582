//! A glTF and the Mitsuba scene that says the same give the same image, bit for bit.

use std::{fmt::Write, fs, path::Path};

use bidir::{load, plugin::Library, scene::Scene};
use bidir_kernel::Heuristic;
use serde_json::{Value, json};
use tempfile::TempDir;

use crate::{
    model::{Model, SQUARE, SQUARE_UVS, png},
    pictures::{BDPT, Subject, leave, mean_of},
};

/// Rows of a transform.
type Rows = [[f32; 4]; 3];

/// By columns, as glTF has it.
fn columns(rows: Rows) -> Value {
    let at = |column: usize, row: usize| if row < 3 { rows[row][column] } else { f32::from(column == 3) };
    json!((0..16).map(|i| at(i / 4, i % 4)).collect::<Vec<_>>())
}

/// As Mitsuba has it.
fn to_world(rows: Rows) -> String {
    let mut text = String::new();
    rows.iter().flatten().for_each(|v| write!(text, "{v} ").expect("a text"));
    format!(r#"<transform name="to_world"><matrix value="{text} 0 0 0 1"/></transform>"#)
}

/// Where a camera or a spot looks along −z from.
fn looking_from([x, y, z]: [f32; 3]) -> (Value, String) {
    let rows = [[-1.0, 0.0, 0.0, x], [0.0, 1.0, 0.0, y], [0.0, 0.0, -1.0, z]];
    (json!([x, y, z]), to_world(rows))
}

const FLOOR: Rows = [[2.0, 0.0, 0.0, 0.0], [0.0, 0.0, 2.0, 0.0], [0.0, -2.0, 0.0, 0.0]];
const BACK: Rows = [[2.0, 0.0, 0.0, 0.0], [0.0, 2.0, 0.0, 1.5], [0.0, 0.0, 2.0, -2.0]];
/// Seen in a mirror, and turned a little.
const LEFT: Rows = [[-0.5, 0.0, 0.0, -1.0], [0.0, 0.5, 0.25, 0.75], [0.25, 0.0, 0.5, -0.5]];
const RIGHT: Rows = [[0.5, 0.0, 0.25, 1.0], [0.0, 0.75, 0.0, 0.75], [-0.25, 0.0, 0.5, -0.5]];
/// Faces down.
const LAMP: Rows = [[0.5, 0.0, 0.0, 0.0], [0.0, 0.0, -0.5, 2.75], [0.0, 0.5, 0.0, 0.0]];

/// Pixels of a texture, no two alike.
fn pixels() -> Vec<[u8; 4]> {
    (0..16_u8).map(|i| [255 - 9 * i, 40 + 13 * i, 16 * i, 255 - 17 * (i % 5)]).collect()
}

/// Leaning by up to half a right angle or so.
fn normals() -> Vec<[u8; 4]> {
    (0..16_u8).map(|i| [90 + 5 * i, 170 - 6 * i, 220 + i, 255]).collect()
}

/// One band of the pixels, in all three.
fn band(band: usize) -> Vec<[u8; 4]> {
    pixels().iter().map(|pixel| [pixel[band], pixel[band], pixel[band], 255]).collect()
}

/// A folder with the square and the images.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let mut ply = "ply\nformat ascii 1.0\nelement vertex 4\n".to_owned();
    ["x", "y", "z", "s", "t"].iter().for_each(|name| writeln!(ply, "property float {name}").expect("a text"));
    ply += "element face 2\nproperty list uchar int vertex_indices\nend_header\n";
    for ([x, y, z], [s, t]) in SQUARE.iter().zip(SQUARE_UVS) {
        writeln!(ply, "{x} {y} {z} {s} {t}").expect("a text");
    }
    ply += "3 0 1 2\n3 0 2 3\n";
    let write = |name: &str, bytes: &[u8]| fs::write(folder.path().join(name), bytes).expect("a file");
    write("square.ply", ply.as_bytes());
    write("base.png", &png(4, &pixels()));
    write("normals.png", &png(4, &normals()));
    for (name, which) in [("green.png", 1), ("blue.png", 2), ("alpha.png", 3)] {
        write(name, &png(4, &band(which)));
    }
    folder
}

fn subject(path: &Path) -> Subject {
    let defines = if path.extension().is_some_and(|ending| ending == "xml") { vec![] } else { vec![("size".into(), "48".into())] };
    let description = load::load(path, &defines, &Library::default()).expect("a scene").description;
    Subject { scene: Scene::new(&description).expect("a scene"), description }
}

fn assert_alike(name: &str, folder: &TempDir, model: &Model, xml: &str) {
    let write = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        fs::write(&path, bytes).expect("a file");
        path
    };
    let xml = write("scene.xml", format!(r#"<scene version="3.0.0">{xml}</scene>"#).as_bytes());
    let image = |path: &Path| {
        let subject = subject(path);
        subject.image(&subject.job(subject.strategy(BDPT, Heuristic::Balance), 8, 1))
    };
    let wanted = image(&xml);
    assert!(mean_of(&wanted) > 0.01, "{name} is dark");
    let (beside, buffer) = model.beside("its%20buffer.bin");
    write("its buffer.bin", buffer);
    for path in [write("model.gltf", &model.gltf()), write("model.glb", &model.glb()), write("beside.gltf", &beside)] {
        let found = image(&path);
        if found != wanted {
            let folder = leave(name, &[("gltf", &found), ("xml", &wanted)]);
            panic!("{name}: the images differ; they are in {}", folder.display());
        }
    }
}

fn texture(name: &str, file: &str, raw: bool) -> String {
    format!(r#"<texture type="bitmap" name="{name}"><string name="filename" value="{file}"/><boolean name="raw" value="{raw}"/></texture>"#)
}

fn principled(content: &str) -> String {
    format!(r#"<bsdf type="principled"><float name="eta" value="1.5"/>{content}</bsdf>"#)
}

fn square(rows: Rows, content: &str) -> String {
    let file = r#"<string name="filename" value="square.ply"/><boolean name="face_normals" value="true"/>"#;
    format!(r#"<shape type="ply">{file}{}{content}</shape>"#, to_world(rows))
}

fn film(width: u32, height: u32) -> String {
    let film = format!(r#"<integer name="width" value="{width}"/><integer name="height" value="{height}"/>"#);
    format!(r#"<film type="hdrfilm">{film}</film>"#)
}

/// Textures of all kinds, instances, one of them mirrored, and a lamp.
#[test]
fn surfaces_instances_and_what_shines_are_alike() {
    let mut model = Model::default();
    let (base, bumps) = (model.texture(4, &pixels()), model.texture(4, &normals()));
    let (yfov, aspect) = (0.75_f32, 1.5_f32);
    let camera = model.add("cameras", json!({"type": "perspective", "perspective": {"yfov": yfov, "aspectRatio": aspect, "znear": 0.1}}));
    let (from, to_world_of_camera) = looking_from([0.0, 1.25, 5.0]);
    model.node(json!({"camera": camera, "translation": from}));
    let rough_metal = json!({"baseColorTexture": {"index": base}, "metallicRoughnessTexture": {"index": base}});
    let floor = model.add("materials", json!({"pbrMetallicRoughness": rough_metal, "normalTexture": {"index": bumps}}));
    let back = model.add(
        "materials",
        json!({"alphaMode": "BLEND", "pbrMetallicRoughness":
        {"baseColorTexture": {"index": base}, "metallicFactor": 0.0, "roughnessFactor": 0.5}}),
    );
    let lamp = model.add(
        "materials",
        json!({"emissiveFactor": [1.0, 0.75, 0.5], "pbrMetallicRoughness": {"metallicFactor": 0.25},
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 8.0}}}),
    );
    for (material, rows) in [(floor, FLOOR), (back, BACK), (lamp, LAMP)] {
        let mesh = model.square(json!({"material": material}));
        model.node(json!({"mesh": mesh, "matrix": columns(rows)}));
    }
    let pane = model.add("materials", json!({"pbrMetallicRoughness": {"baseColorFactor": [0.75, 0.5, 0.25, 1.0], "metallicFactor": 0.5}}));
    let mesh = model.square(json!({"material": pane}));
    model.node(json!({"mesh": mesh, "matrix": columns(LEFT)}));
    model.node(json!({"mesh": mesh, "matrix": columns(RIGHT)}));

    let fov = (2.0 * libm::atan(libm::tan(0.5 * f64::from(yfov)) * f64::from(aspect))).to_degrees();
    let camera = format!(r#"<sensor type="perspective"><float name="fov" value="{fov}"/>{to_world_of_camera}{}</sensor>"#, film(48, 32));
    let maps = [texture("base_color", "base.png", false), texture("roughness", "green.png", true), texture("metallic", "blue.png", true)];
    let bent = format!(r#"<bsdf type="normalmap">{}{}</bsdf>"#, texture("normalmap", "normals.png", true), principled(&maps.concat()));
    let twosided = |content: &str| format!(r#"<bsdf type="twosided">{content}</bsdf>"#);
    let numbers = |color: &str, metallic: f32, roughness: f32| {
        let number = |name: &str, value: f32| format!(r#"<float name="{name}" value="{value}"/>"#);
        format!(r#"{color}{}{}"#, number("metallic", metallic), number("roughness", roughness))
    };
    let through = twosided(&principled(&numbers(&texture("base_color", "base.png", false), 0.0, 0.5)));
    let masked = format!(r#"<bsdf type="mask">{}{through}</bsdf>"#, texture("opacity", "alpha.png", true));
    let white = r#"<rgb name="base_color" value="1"/>"#;
    let light = r#"<emitter type="area"><rgb name="radiance" value="8, 6, 4"/></emitter>"#;
    let pane = twosided(&principled(&numbers(r#"<rgb name="base_color" value="0.75, 0.5, 0.25"/>"#, 0.5, 1.0)));
    let file = r#"<string name="filename" value="square.ply"/><boolean name="face_normals" value="true"/>"#;
    let group = format!(r#"<shape type="shapegroup" id="pane"><shape type="ply">{file}{pane}</shape></shape>"#);
    let instance = |rows| format!(r#"<shape type="instance"><ref id="pane"/>{}</shape>"#, to_world(rows));
    let xml = [
        camera,
        square(FLOOR, &twosided(&bent)),
        square(BACK, &masked),
        square(LAMP, &(twosided(&principled(&numbers(white, 0.25, 1.0))) + light)),
        group,
        instance(LEFT),
        instance(RIGHT),
    ];
    assert_alike("gltf_surfaces", &folder(), &model, &xml.concat());
}

/// Points, spots, the sun, panes that let light through, and an orthographic camera.
#[test]
fn lights_and_what_lets_light_through_are_alike() {
    let mut model = Model::default();
    let camera = json!({"type": "orthographic", "orthographic": {"xmag": 2.5, "ymag": 2.5, "zfar": 9.0, "znear": 0.1}});
    let camera = model.add("cameras", camera);
    let (from, to_world_of_camera) = looking_from([0.0, 1.25, 5.0]);
    model.node(json!({"camera": camera, "translation": from}));
    let matt = json!({"baseColorFactor": [0.5, 0.5, 0.5, 1.0], "metallicFactor": 0.0});
    let wall = model.add("materials", json!({"pbrMetallicRoughness": matt}));
    let glass = json!({"KHR_materials_transmission": {"transmissionFactor": 1.0}, "KHR_materials_ior": {"ior": 1.25}});
    let pbr = json!({"baseColorFactor": [1.0, 0.5, 0.25, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.5});
    let pane = model.add("materials", json!({"pbrMetallicRoughness": pbr, "extensions": glass}));
    for (material, rows) in [(wall, BACK), (pane, LEFT)] {
        let mesh = model.square(json!({"material": material}));
        model.node(json!({"mesh": mesh, "matrix": columns(rows)}));
    }
    let (inner, outer) = (0.25_f32, 0.5_f32);
    model.set(
        "extensions",
        json!({"KHR_lights_punctual": {"lights": [
            {"type": "point", "intensity": 4.0, "color": [1.0, 0.5, 0.25]},
            {"type": "spot", "intensity": 16.0, "spot": {"innerConeAngle": inner, "outerConeAngle": outer}},
            {"type": "directional", "intensity": 0.5},
        ]}}),
    );
    let (from, to_world_of_spot) = looking_from([0.5, 1.0, 3.0]);
    model.node(json!({"translation": [-1, 2, 1], "extensions": {"KHR_lights_punctual": {"light": 0}}}));
    model.node(json!({"translation": from, "extensions": {"KHR_lights_punctual": {"light": 1}}}));
    model.node(json!({"extensions": {"KHR_lights_punctual": {"light": 2}}}));

    let matrix = to_world_of_camera.replace("<matrix", r#"<scale value="2.5"/><matrix"#);
    let camera = format!(r#"<sensor type="orthographic">{matrix}{}</sensor>"#, film(48, 48));
    let matt = r#"<rgb name="base_color" value="0.5"/><float name="roughness" value="1"/>"#;
    let pane = r#"<bsdf type="principledthin"><rgb name="base_color" value="1, 0.5, 0.25"/><float name="roughness" value="0.5"/>
        <float name="spec_trans" value="1"/><float name="eta" value="1.25"/></bsdf>"#;
    let [beam, cutoff] = [inner, outer].map(|angle| f64::from(angle).to_degrees());
    let xml = [
        camera,
        square(BACK, &format!(r#"<bsdf type="twosided">{}</bsdf>"#, principled(matt))),
        square(LEFT, pane),
        r#"<emitter type="point"><point name="position" value="-1, 2, 1"/><rgb name="intensity" value="4, 2, 1"/></emitter>"#.to_owned(),
        format!(
            r#"<emitter type="spot"><rgb name="intensity" value="16"/><float name="cutoff_angle" value="{cutoff}"/>
            <float name="beam_width" value="{beam}"/>{to_world_of_spot}</emitter>"#
        ),
        r#"<emitter type="directional"><vector name="direction" value="0, 0, -1"/><rgb name="irradiance" value="0.5"/></emitter>"#
            .to_owned(),
    ];
    assert_alike("gltf_lights", &folder(), &model, &xml.concat());
}
