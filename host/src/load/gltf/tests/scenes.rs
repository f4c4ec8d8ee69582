//! Files, meshes, nodes, cameras and lights.

use glam::DVec3;
use serde_json::json;

use super::*;
use crate::scene::description::SensorKind;

fn with_square() -> Model {
    let mut model = Model::default();
    let mesh = model.square(json!({}));
    model.node(json!({"mesh": mesh}));
    model
}

#[test]
fn a_glb_a_gltf_and_files_beside_it_say_the_same() {
    let model = with_square();
    let folder = tempfile::tempdir().unwrap();
    let (text, binary) = model.beside("my%20mesh.bin");
    fs::write(folder.path().join("my mesh.bin"), binary).unwrap();
    fs::write(folder.path().join("m.GLTF"), text).unwrap();
    fs::write(folder.path().join("m.glb"), model.glb()).unwrap();
    fs::write(folder.path().join("m"), model.glb()).unwrap();
    for name in ["m.GLTF", "m.glb", "m"] {
        let path = folder.path().join(name);
        assert!(is_meant(&path));
        let found = load(&path, &[]).unwrap().description;
        assert_eq!(mesh(&found, 0).0.positions, SQUARE, "{name}");
    }
    assert!(!is_meant(&folder.path().join("my mesh.bin")) && !is_meant(&folder.path().join("none.xml")));
}

#[test]
fn indices_may_be_absent_and_triangles_without_normals_are_flat() {
    let mut model = Model::default();
    let positions = model.vectors(&[SQUARE[0], SQUARE[1], SQUARE[2]]);
    let of_mesh = model.add("meshes", json!({"primitives": [{"attributes": {"POSITION": positions}}]}));
    model.node(json!({"mesh": of_mesh}));
    let scene = scene(&model);
    let (found, _) = mesh(&scene, 0);
    assert_eq!((found.triangles.as_slice(), found.normals.len(), found.uvs.len()), (&[[0, 1, 2]][..], 0, 0));
}

#[test]
fn whole_numbers_are_positions_where_they_are_quantized_and_fractions_where_normalized() {
    for (normalized, scale) in [(false, 127.0), (true, 1.0)] {
        let mut model = Model::default();
        model.set("extensionsRequired", json!(["KHR_mesh_quantization"]));
        // 8 bits each, four bytes apart.
        let view = model.view(&[0, 0, 0, 0, 127, 0, 0, 0, 0, 127, 129, 0]);
        model.set("bufferViews", json!([{"buffer": 0, "byteLength": 12, "byteStride": 4}]));
        let accessor = json!({"bufferView": view, "componentType": 5120, "normalized": normalized, "type": "VEC3", "count": 3});
        let positions = model.add("accessors", accessor);
        let of_mesh = model.add("meshes", json!({"primitives": [{"attributes": {"POSITION": positions}}]}));
        model.node(json!({"mesh": of_mesh}));
        assert_eq!(mesh(&scene(&model), 0).0.positions[2], [0.0, scale, -scale]);
    }
}

#[test]
fn a_sparse_accessor_replaces_what_it_names() {
    let mut model = with_square();
    let (indices, values) = (model.view(&[2, 0]), model.view(&[5.0_f32, 6.0, 7.0].map(f32::to_le_bytes).concat()));
    let sparse = json!({"count": 1, "indices": {"bufferView": indices, "componentType": 5121}, "values": {"bufferView": values}});
    let with = json!({"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 4, "sparse": sparse});
    let positions = model.add("accessors", with);
    let of_mesh = model.add("meshes", json!({"primitives": [{"attributes": {"POSITION": positions}, "mode": 6}]}));
    model.node(json!({"mesh": of_mesh}));
    assert_eq!(mesh(&scene(&model), 1).0.positions[1..3], [SQUARE[1], [5.0, 6.0, 7.0]]);
}

#[test]
fn transforms_multiply_down_the_tree() {
    let mut model = Model::default();
    let of_mesh = model.square(json!({}));
    let child = model.add("nodes", json!({"mesh": of_mesh, "translation": [1, 0, 0], "scale": [2, 2, -2]}));
    // A quarter turn about z: x goes to y. Then a matrix that moves, column by column.
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let turned = model.add("nodes", json!({"rotation": [0, 0, half, half], "children": [child]}));
    model.node(json!({"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 10, 20, 30, 1], "children": [turned]}));
    let scene = scene(&model);
    let (_, to_world) = mesh(&scene, 0);
    let found = to_world.transform_point3(DVec3::new(1.0, 0.0, 1.0));
    assert!(found.abs_diff_eq(DVec3::new(10.0, 23.0, 28.0), 1e-6), "{found}");
}

#[test]
fn a_mesh_that_stands_twice_is_kept_once_but_for_what_shines() {
    let mut model = Model::default();
    let lamp = model.add("materials", json!({"emissiveFactor": [1, 0.5, 0.25]}));
    let shining = model.square(json!({"material": lamp}));
    let matt = model.square(json!({}));
    for at in 0..3 {
        model.node(json!({"mesh": matt, "translation": [at, 0, 0]}));
        model.node(json!({"mesh": shining, "translation": [at, 0, 1]}));
    }
    let scene = scene(&model);
    assert_eq!((scene.shapes.len(), scene.groups.len(), scene.instances.len(), scene.emitters.len()), (3, 1, 3, 0));
    assert!(scene.shapes.iter().all(|shape| shape.light.is_some()));
    assert_eq!(scene.instances[2].to_world.translation.x, 2.0);
    crate::scene::Scene::new(&scene).unwrap();
}

#[test]
fn what_is_hidden_is_not_there_nor_is_what_it_holds() {
    let mut model = with_square();
    let of_mesh = model.square(json!({}));
    let child = model.add("nodes", json!({"mesh": of_mesh}));
    model.node(json!({"children": [child], "extensions": {"KHR_node_visibility": {"visible": false}}}));
    assert_eq!(scene(&model).shapes.len(), 1);
}

#[test]
fn gpu_instances_are_instances() {
    let mut model = Model::default();
    let of_mesh = model.square(json!({}));
    let places = model.vectors(&[[0.0, 0.0, 0.0], [3.0, 0.0, 0.0]]);
    let scales = model.vectors(&[[1.0, 1.0, 1.0], [2.0, 2.0, 2.0]]);
    let extension = json!({"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": places, "SCALE": scales}}});
    model.node(json!({"mesh": of_mesh, "scale": [10, 10, 10], "extensions": extension}));
    let scene = scene(&model);
    assert_eq!((scene.shapes.len(), scene.instances.len()), (0, 2));
    let to_world = scene.instances[1].to_world;
    assert_eq!((to_world.translation.x, to_world.matrix3.x_axis.x), (30.0, 20.0));
}

#[test]
fn a_camera_sees_its_field_of_view_along_minus_z_whatever_its_scale() {
    let mut model = with_square();
    let camera = model.add("cameras", json!({"type": "perspective", "perspective": {"yfov": 1.0, "aspectRatio": 2.0, "znear": 0.1}}));
    let flat = model.add("cameras", json!({"type": "orthographic", "orthographic": {"xmag": 3.0, "ymag": 6.0, "zfar": 9.0, "znear": 0.1}}));
    model.node(json!({"camera": camera, "translation": [0, 0, 5], "scale": [3, 3, 3]}));
    model.node(json!({"camera": flat}));
    let found = loaded(&model);
    warning(&found, "there are 2 cameras; camera 0, the first, is used");
    let sensor = &found.description.sensor;
    let SensorKind::Perspective { fov_x, .. } = sensor.kind else { panic!("{:?}", sensor.kind) };
    assert!(near((0.5 * fov_x.to_radians()).tan(), 2.0 * 0.5_f64.tan()));
    assert_eq!(sensor.to_world.matrix3.to_cols_array(), [-1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, -1.0]);
    assert_eq!((found.description.film.width, found.description.film.height), (1280, 640));
}

#[test]
fn an_orthographic_camera_is_twice_its_magnifications_wide_and_high() {
    let mut model = with_square();
    let flat = model.add("cameras", json!({"type": "orthographic", "orthographic": {"xmag": 3.0, "ymag": 6.0, "zfar": 9.0, "znear": 0.1}}));
    model.node(json!({"camera": flat}));
    let scene = scene(&model);
    assert_eq!(scene.sensor.kind, SensorKind::Orthographic);
    assert_eq!(scene.sensor.to_world.matrix3.y_axis, DVec3::new(0.0, 3.0, 0.0));
    assert_eq!((scene.film.width, scene.film.height), (640, 1280));
}

#[test]
fn without_a_camera_everything_is_seen_and_without_a_light_it_is_lit() {
    let model = with_square();
    let found = loaded(&model);
    warning(&found, "there is no camera");
    warning(&found, "nothing shines");
    let EmitterKind::Constant { radiance } = found.description.emitters[0].kind else { panic!("no sky") };
    assert_eq!(radiance, Spectrum::ONE);
    let SensorKind::Perspective { fov_x, .. } = found.description.sensor.kind else { panic!("no perspective") };
    let half = [(0.5 * fov_x.to_radians()).tan(), (0.5 * fov_x.to_radians()).tan() * 9.0 / 16.0];
    let to_camera = found.description.sensor.to_world.inverse();
    for corner in SQUARE {
        let seen = to_camera.transform_point3(DVec3::from_array(corner.map(f64::from)));
        assert!(seen.z > 0.0 && (seen.x / seen.z).abs() < half[0] && (seen.y / seen.z).abs() < half[1], "{seen}");
    }
}

#[test]
fn size_and_lights_are_defined_on_the_command_line_and_nothing_else() {
    let mut model = with_square();
    model.set("extensions", json!({"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 8.0}]}}));
    model.node(json!({"extensions": {"KHR_lights_punctual": {"light": 0}}}));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m.gltf");
    fs::write(&path, model.gltf()).unwrap();
    let with = |name: &str, value: &str| load(&path, &[(name.into(), value.into())]).map(|loaded| loaded.description);
    assert_eq!(with("size", "160").unwrap().film.height, 90);
    let lights = with("lights", "0.5").unwrap().emitters;
    assert!(matches!(lights[0].kind, EmitterKind::Point { intensity: Spectrum([4.0, ..]), .. }));
    for (name, value) in [("size", "0"), ("size", "x"), ("lights", "-1"), ("spp", "3")] {
        assert!(with(name, value).unwrap_err().to_string().contains(name), "{name}");
    }
}

#[test]
fn lights_keep_their_numbers_and_spots_their_cones() {
    let mut model = with_square();
    let lights = json!([
        {"type": "directional", "intensity": 3.0, "color": [1.0, 0.5, 0.0]},
        {"type": "spot", "intensity": 5.0, "spot": {"innerConeAngle": 0.25, "outerConeAngle": 0.5}},
        {"type": "spot"},
    ]);
    model.set("extensions", json!({"KHR_lights_punctual": {"lights": lights}}));
    for light in 0..3 {
        model.node(json!({"translation": [0, 4, 0], "extensions": {"KHR_lights_punctual": {"light": light}}}));
    }
    let emitters = scene(&model).emitters;
    let EmitterKind::Directional { direction, irradiance } = emitters[0].kind else { panic!("no sun") };
    assert_eq!((direction, irradiance), (DVec3::NEG_Z, Spectrum([3.0, 1.5, 0.0])));
    let cones = |emitter: &Emitter| match emitter.kind {
        EmitterKind::Spot { cutoff_angle, beam_width, to_world, .. } => {
            assert_eq!((to_world.translation, to_world.matrix3.z_axis), (DVec3::new(0.0, 4.0, 0.0), DVec3::NEG_Z));
            (cutoff_angle, beam_width)
        }
        _ => panic!("no spot"),
    };
    assert_eq!(cones(&emitters[1]), (0.5_f64.to_degrees(), 0.25_f64.to_degrees()));
    assert!(near(cones(&emitters[2]).0, 45.0) && cones(&emitters[2]).1 == 0.0);
}

#[test]
fn what_is_left_out_is_listed_once() {
    let mut model = Model::default();
    let colors = model.vectors(&[[1.0_f32; 3]; 4]);
    let positions = model.vectors(&SQUARE);
    let primitive = |mode: u32| json!({"attributes": {"POSITION": positions, "COLOR_0": colors}, "mode": mode});
    let of_mesh = model.add("meshes", json!({"primitives": [primitive(5), primitive(1), primitive(0), primitive(6)]}));
    model.node(json!({"mesh": of_mesh}));
    model.node(json!({"mesh": of_mesh, "scale": [1, 0, 1]}));
    model.set("animations", json!([{"channels": [], "samplers": []}]));
    model.set("extensionsUsed", json!(["KHR_materials_iridescence", "KHR_materials_ior", "ACME_rockets"]));
    let found = loaded(&model);
    let said = warning(&found, "left out: ");
    let all = "ACME_rockets, KHR_materials_iridescence, animations, points and lines, vertex colours (COLOR_0), what a scale of 0 flattens";
    assert!(said.ends_with(&format!("left out: {all}")), "{said}");
    assert_eq!(found.description.shapes.len(), 2);
}

#[test]
fn what_is_required_and_not_read_is_one_error() {
    let mut model = with_square();
    model.set("extensionsRequired", json!(["KHR_texture_transform", "KHR_draco_mesh_compression", "ACME_rockets"]));
    let error = error(&model);
    assert!(error.contains("requires KHR_draco_mesh_compression and ACME_rockets"), "{error}");
    assert!(error.contains("export it without compression"), "{error}");
}
