//! Every plugin of the catalog, written as Mitsuba's documentation writes it: what is supported is read without a change and without a
//! warning, and what is not is refused by an error that names it and says what to use instead.

use std::path::Path;

use bidir::{
    error::Error,
    load::{
        self, Loaded,
        catalog::{Entry, entries},
    },
    plugin::Library,
};

/// Reads a scene whose files are those of `tests/peer`.
fn read(content: &str) -> Result<Loaded, Error> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("peer");
    let text = format!("<scene version=\"3.0.0\">{content}</scene>");
    load::load_str(&text, &folder.join("scene.xml"), Some(&folder), &[], &Library::default())
}

/// A whole scene with an element where it belongs.
fn around(tag: &str, element: &str) -> String {
    let sensor = |inside: &str| format!("<sensor type=\"perspective\">{inside}</sensor>");
    let plain = sensor("");
    match tag {
        "sensor" => element.into(),
        "film" | "sampler" => sensor(element),
        "rfilter" => sensor(&format!("<film type=\"hdrfilm\">{element}</film>")),
        "bsdf" => format!("{plain}<shape type=\"sphere\">{element}</shape>"),
        "texture" => {
            let material = format!("<bsdf type=\"diffuse\">{}</bsdf>", element.replacen("<texture", "<texture name=\"reflectance\"", 1));
            format!("{plain}<shape type=\"ply\"><string name=\"filename\" value=\"painted.ply\"/>{material}</shape>")
        }
        "emitter" if element.contains("type=\"area\"") => format!("{plain}<shape type=\"sphere\">{element}</shape>"),
        _ => plain + element,
    }
}

/// What stands inside the element that Mitsuba's documentation shows for a plugin.
fn inside(tag: &str, name: &str) -> &'static str {
    match (tag, name) {
        ("integrator", "direct") => r#"<integer name="emitter_samples" value="2"/><integer name="bsdf_samples" value="1"/>"#,
        ("integrator", "aov") => r#"<integrator type="path" name="my_image"/>"#,
        ("integrator", _) => {
            r#"<integer name="max_depth" value="8"/><integer name="rr_depth" value="5"/><boolean name="hide_emitters" value="true"/>"#
        }
        ("sampler", _) => r#"<integer name="sample_count" value="64"/><integer name="seed" value="7"/>"#,
        ("sensor", "perspective") => {
            r#"<float name="fov" value="45"/><string name="fov_axis" value="smaller"/><float name="near_clip" value="0.1"/>
               <float name="far_clip" value="100"/><transform name="to_world"><lookat origin="1, 1, 1" target="1, 2, 1" up="0, 0, 1"/></transform>"#
        }
        ("sensor", "thinlens") => {
            r#"<float name="fov" value="45"/><float name="focus_distance" value="1"/><float name="aperture_radius" value="0.1"/>"#
        }
        ("sensor", "orthographic") => {
            r#"<transform name="to_world"><scale x="10" y="10"/><lookat origin="1, 1, 1" target="1, 2, 1" up="0, 0, 1"/></transform>"#
        }
        ("film", "hdrfilm") => {
            r#"<string name="pixel_format" value="rgba"/><integer name="width" value="1920"/><integer name="height" value="1080"/>
               <string name="file_format" value="openexr"/><string name="component_format" value="float16"/><rfilter type="gaussian"/>"#
        }
        ("rfilter", "gaussian") => r#"<float name="stddev" value="0.4"/>"#,
        ("rfilter", "mitchell") => r#"<float name="B" value="0.25"/><float name="C" value="0.55"/>"#,
        ("rfilter", "lanczos") => r#"<integer name="lobes" value="4"/>"#,
        ("rfilter", "box" | "tent" | "catmullrom") | ("bsdf", "null") => "",
        ("bsdf", "diffuse") => r#"<rgb name="reflectance" value="0.2, 0.25, 0.7"/>"#,
        ("bsdf", "conductor") => r#"<string name="material" value="Au"/>"#,
        ("bsdf", "roughconductor") => {
            r#"<string name="material" value="Al"/><string name="distribution" value="ggx"/><float name="alpha_u" value="0.05"/><float name="alpha_v" value="0.3"/>"#
        }
        ("bsdf", "dielectric") => r#"<string name="int_ior" value="water"/><string name="ext_ior" value="air"/>"#,
        ("bsdf", "thindielectric") => r#"<string name="int_ior" value="bk7"/><string name="ext_ior" value="air"/>"#,
        ("bsdf", "roughdielectric") => {
            r#"<string name="distribution" value="beckmann"/><float name="alpha" value="0.1"/><string name="int_ior" value="bk7"/><string name="ext_ior" value="air"/>"#
        }
        ("bsdf", "plastic") => r#"<rgb name="diffuse_reflectance" value="0.1, 0.27, 0.36"/><float name="int_ior" value="1.9"/>"#,
        ("bsdf", "roughplastic") => {
            r#"<string name="distribution" value="beckmann"/><float name="int_ior" value="1.61"/><spectrum name="diffuse_reflectance" value="0"/>"#
        }
        ("bsdf", "principled") => {
            r#"<rgb name="base_color" value="1.0, 0.44, 0.17"/><float name="metallic" value="0.7"/><float name="specular" value="0.6"/><float name="roughness" value="0.2"/>"#
        }
        ("bsdf", "principledthin") => {
            r#"<rgb name="base_color" value="0.7, 0.1, 0.1"/><float name="roughness" value="0.15"/><float name="spec_tint" value="0.1"/><float name="diff_trans" value="0.8"/>"#
        }
        ("bsdf", "twosided") => r#"<bsdf type="diffuse"><rgb name="reflectance" value="0.4"/></bsdf>"#,
        ("bsdf", "mask") => {
            r#"<bsdf type="diffuse"/><texture type="bitmap" name="opacity"><string name="filename" value="spots.png"/></texture>"#
        }
        ("bsdf", "blendbsdf") => r#"<float name="weight" value="0.5"/><bsdf type="conductor"/><bsdf type="roughplastic"/>"#,
        ("bsdf", "normalmap") => {
            r#"<texture name="normalmap" type="bitmap"><boolean name="raw" value="true"/><string name="filename" value="normals.png"/></texture><bsdf type="roughplastic"/>"#
        }
        ("bsdf", "bumpmap") => {
            r#"<texture name="arbitrary" type="bitmap"><boolean name="raw" value="true"/><string name="filename" value="hills.png"/></texture><bsdf type="roughplastic"/>"#
        }
        ("texture", "bitmap") => r#"<string name="filename" value="spots.png"/><string name="wrap_mode" value="mirror"/>"#,
        ("texture", "checkerboard") => {
            r#"<rgb name="color0" value="0.1"/><rgb name="color1" value="0.5"/><transform name="to_uv"><scale x="8" y="8"/></transform>"#
        }
        ("texture", "mesh_attribute") => r#"<string name="name" value="vertex_color"/>"#,
        ("shape", "rectangle" | "disk") => r#"<bsdf type="diffuse"/><transform name="to_world"><rotate x="1" angle="45"/></transform>"#,
        ("shape", "sphere") => {
            r#"<transform name="to_world"><scale value="2"/><translate x="1" y="0" z="0"/></transform><bsdf type="diffuse"/>"#
        }
        ("shape", "cube") => r#"<transform name="to_world"><scale z="10"/></transform><boolean name="flip_normals" value="true"/>"#,
        ("shape", "cylinder") => {
            r#"<float name="radius" value="0.3"/><point name="p0" x="0" y="0" z="0"/><point name="p1" x="0" y="0" z="2"/>"#
        }
        ("shape", "obj") => r#"<string name="filename" value="roof.obj"/><boolean name="face_normals" value="true"/>"#,
        ("shape", "ply") => r#"<string name="filename" value="pyramid.ply"/><boolean name="flip_normals" value="true"/>"#,
        ("shape", "serialized") => r#"<string name="filename" value="roofs.serialized"/><integer name="shape_index" value="1"/>"#,
        ("shape", "merge") => r#"<shape type="cube"/><shape type="ply"><string name="filename" value="pyramid.ply"/></shape>"#,
        ("shape", "instance") => r#"<ref id="group"/><transform name="to_world"><rotate x="1" angle="45"/><translate x="2"/></transform>"#,
        ("emitter", "area") => r#"<rgb name="radiance" value="1.0"/>"#,
        ("emitter", "point") => r#"<point name="position" value="0.0, 5.0, 0.0"/><rgb name="intensity" value="1.0"/>"#,
        ("emitter", "spot") => {
            r#"<transform name="to_world"><lookat origin="1, 1, 1" target="1, 2, 1"/></transform><rgb name="intensity" value="1.0"/><float name="cutoff_angle" value="30"/>"#
        }
        ("emitter", "directional") => r#"<vector name="direction" value="1.0, 0.0, 0.0"/><rgb name="irradiance" value="1.0"/>"#,
        ("emitter", "constant") => r#"<rgb name="radiance" value="1.0"/>"#,
        ("emitter", "envmap") => r#"<string name="filename" value="dusk.exr"/><float name="scale" value="2"/>"#,
        _ => panic!("{tag} \"{name}\" has no scene here; write what Mitsuba's documentation shows for it"),
    }
}

#[test]
fn what_is_supported_is_read_as_mitsubas_documentation_writes_it() {
    for Entry { tag, name, .. } in entries().filter(|entry| entry.instead.is_none()) {
        let group =
            r#"<shape type="shapegroup" id="group"><shape type="cube"/><shape type="sphere"><bsdf type="diffuse"/></shape></shape>"#;
        let shown = r#"<shape type="instance"><ref id="group"/></shape>"#;
        let content = match name {
            "shapegroup" => around(tag, &format!("{group}{shown}")),
            "instance" => around(tag, &format!("{group}<shape type=\"instance\">{}</shape>", inside(tag, name))),
            _ => around(tag, &format!("<{tag} type=\"{name}\">{}</{tag}>", inside(tag, name))),
        };
        match read(&content) {
            Err(error) => panic!("{tag} {name}: {error}"),
            Ok(Loaded { warnings, .. }) => assert!(warnings.is_empty(), "{tag} {name}: {warnings:?}"),
        }
    }
}

#[test]
fn what_is_not_supported_is_refused_by_its_name_and_with_what_to_use_instead() {
    for Entry { tag, name, instead } in entries() {
        let Some(instead) = instead else { continue };
        let error = read(&around(tag, &format!("<{tag} type=\"{name}\"/>"))).expect_err(name);
        assert!(error.thing.contains(&format!("{tag} type \"{name}\"")), "{tag} {name}: {error}");
        assert!(error.remedy.contains(instead), "{tag} {name}: {error}");
        assert!(error.place.is_some_and(|place| place.position.is_some()), "{tag} {name} has no place");
    }
}
