//! Files that are damaged, or mean harm: one error that names file and thing, and no panic.

use serde_json::json;

use super::*;

/// A file with a bit of everything.
fn everything() -> Model {
    let mut model = Model::default();
    let texture = model.texture(2, &[[255, 128, 0, 255], [0, 64, 255, 51]]);
    let named = json!({"index": texture, "extensions": {"KHR_texture_transform": {"offset": [0.5, 0.5]}}});
    square_of(
        &mut model,
        json!({"normalTexture": {"index": texture}, "emissiveFactor": [1, 1, 1], "alphaMode": "BLEND",
        "pbrMetallicRoughness": {"baseColorTexture": named, "metallicRoughnessTexture": named},
        "extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.5}, "KHR_materials_clearcoat": {"clearcoatFactor": 0.5}}}),
    );
    let camera = model.add("cameras", json!({"type": "perspective", "perspective": {"yfov": 1.0, "aspectRatio": 2.0, "znear": 0.1}}));
    model.set("extensions", json!({"KHR_lights_punctual": {"lights": [{"type": "spot", "intensity": 8.0}]}}));
    model.node(json!({"camera": camera, "rotation": [0, 0, 0, 1], "extensions": {"KHR_lights_punctual": {"light": 0}}}));
    model
}

#[test]
fn a_glb_that_ends_early_is_one_error() {
    let whole = everything().glb();
    read("m.glb", &whole).unwrap();
    for length in (0..whole.len()).step_by(7) {
        let error = read("m.glb", &whole[..length]).unwrap_err();
        assert!(error.to_string().contains("m.glb") && !error.remedy.is_empty(), "{length}: {error}");
    }
}

#[test]
fn a_changed_byte_is_an_error_or_another_scene_but_never_a_panic() {
    let whole = everything().glb();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m.glb");
    for at in 0..whole.len() {
        for flip in [0x01, 0x10, 0xff] {
            let mut bytes = whole.clone();
            bytes[at] ^= flip;
            fs::write(&path, &bytes).unwrap();
            let _either = load(&path, &[]);
        }
    }
}

/// An error for what is put in place of one of the file's parts.
fn error_with(list: &str, index: usize, name: &str, value: serde_json::Value) -> String {
    let mut json: serde_json::Value = serde_json::from_slice(&everything().gltf()).unwrap();
    json[list][index][name] = value;
    let error = read("m.gltf", json.to_string().as_bytes()).unwrap_err();
    assert!(!error.remedy.is_empty() && error.to_string().contains("m.gltf"), "{error}");
    error.to_string()
}

#[test]
fn what_is_named_and_is_not_there_is_told() {
    for (list, name, value, thing) in [
        ("nodes", "mesh", json!(9), "mesh 9 is named"),
        ("nodes", "children", json!([9]), "node 9 is named"),
        ("nodes", "children", json!([0]), "node 0 has two parents, or is its own"),
        ("nodes", "camera", json!(9), "camera 9 is named"),
        ("nodes", "extensions", json!({"KHR_lights_punctual": {"light": 9}}), "light 9 is named"),
        ("nodes", "rotation", json!([0, 0, 0, 0]), "the rotation of node 0 is none"),
        ("nodes", "translation", json!([1e35, 0, 0]), "the transform of node 0 is not finite"),
        ("nodes", "matrix", json!([1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]), "the last row of the matrix of node 0"),
        ("scenes", "nodes", json!([0, 0]), "node 0 has two parents"),
        ("textures", "source", json!(9), "image 9 is named"),
        ("textures", "sampler", json!(9), "sampler 9 is named"),
        ("images", "bufferView", json!(1), "image 0 cannot be decoded"),
        ("images", "uri", json!("none.png"), "none.png cannot be read"),
        ("images", "uri", json!("https://example.org/a.png"), "nothing is fetched"),
        ("bufferViews", "buffer", json!(9), "buffer 9 is named"),
        ("bufferViews", "byteLength", json!(u64::MAX), "buffer view 0 is"),
        ("bufferViews", "byteOffset", json!(u64::MAX), "buffer view 0 is"),
        ("buffers", "byteLength", json!(1_u64 << 40), "buffer 0 has"),
        ("buffers", "uri", json!("none.bin"), "none.bin cannot be read"),
        ("accessors", "count", json!(u64::MAX), "accessor 0, the positions, has 18446744073709551615 elements"),
        ("accessors", "count", json!(3), "has 3 positions and 4 texture coordinates"),
        ("accessors", "byteOffset", json!(u64::MAX), "accessor 0, the positions,"),
        ("accessors", "type", json!("VEC4"), "has not 3 numbers"),
        ("accessors", "componentType", json!(5125), "cannot be of U32"),
        ("accessors", "componentType", json!(9), "is of no type"),
        ("meshes", "primitives", json!([{"attributes": {"POSITION": 0}, "mode": 9}]), "a mode that is none"),
        ("meshes", "primitives", json!([{"attributes": {"POSITION": 0, "NORMAL": 99}}]), "accessor 99 is named"),
        ("meshes", "primitives", json!([{"attributes": {"POSITION": 0}, "material": 9}]), "material 9 is named"),
        ("meshes", "primitives", json!([{"attributes": {"POSITION": 0}, "indices": 0}]), "the indices, "),
        ("cameras", "perspective", json!({"yfov": 4.0, "znear": 0.1}), "yfov 4 of camera 0"),
        ("cameras", "type", json!("fisheye"), "camera 0 is neither"),
    ] {
        let error = error_with(list, 0, name, value.clone());
        assert!(error.contains(thing), "{list} {name} {value}: {error}");
    }
}

#[test]
fn zeros_without_bytes_are_bounded() {
    let mut model = Model::default();
    let positions = model.add("accessors", json!({"componentType": 5126, "type": "VEC3", "count": 1_u64 << 40}));
    let of_mesh = model.add("meshes", json!({"primitives": [{"attributes": {"POSITION": positions}}]}));
    model.node(json!({"mesh": of_mesh}));
    assert!(error(&model).contains("1099511627776 elements and no bytes"));
}

#[test]
fn positions_that_are_no_points_drop_their_triangles_or_are_one_error() {
    for (bad, of_all) in [(f32::NAN, false), (f32::INFINITY, false), (f32::NAN, true)] {
        let mut model = Model::default();
        let mut corners = SQUARE;
        corners[1][0] = bad;
        if of_all {
            corners[0][0] = bad;
        }
        let positions = model.vectors(&corners);
        let indices = model.indices(&[0, 1, 2, 0, 2, 3]);
        let of_mesh =
            model.add("meshes", json!({"name": "Wall", "primitives": [{"attributes": {"POSITION": positions}, "indices": indices}]}));
        model.node(json!({"mesh": of_mesh}));
        if of_all {
            let error = error(&model);
            assert!(error.contains("mesh 0 \"Wall\": has 2 triangles, and none with an area"), "{error}");
        } else {
            warning(&loaded(&model), "dropped 1 triangles of mesh 0 \"Wall\"");
        }
    }
}

#[test]
fn what_is_no_gltf_is_told() {
    for (bytes, thing) in [
        (&b""[..], "is no glTF"),
        (b"<scene/>", "is no glTF"),
        (b"{}", "missing field"),
        (b"{\"asset\": {\"version\": \"1.0\"}}", "is glTF 1.0"),
        (b"glTF", "says that it has 0 bytes"),
        (b"glTF\x02\0\0\0\x05\0\0\0", "says that it has 5 bytes"),
        (b"glTF\x02\0\0\0\xff\xff\xff\xff", "says that it has 4294967295 bytes"),
        (b"glTF\x01\0\0\0\x0c\0\0\0", "no GLB that can be read"),
    ] {
        let error = read("m.gltf", bytes).unwrap_err();
        assert!(error.to_string().contains("m.gltf") && error.to_string().contains(thing) && !error.remedy.is_empty(), "{error}");
    }
    let folder = tempfile::tempdir().unwrap();
    assert!(load(&folder.path().join("none.glb"), &[]).unwrap_err().to_string().contains("none.glb: cannot be read"));
    assert!(load(folder.path(), &[]).unwrap_err().to_string().contains("is not a file"));
}

#[test]
fn a_long_chain_of_nodes_is_no_burden() {
    let mut model = Model::default();
    let of_mesh = model.square(json!({}));
    let mut child = model.add("nodes", json!({"mesh": of_mesh}));
    for _ in 0..100_000 {
        child = model.add("nodes", json!({"children": [child]}));
    }
    model.node(json!({"children": [child]}));
    assert_eq!(scene(&model).shapes.len(), 1);
}
