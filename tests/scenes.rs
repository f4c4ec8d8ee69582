//! Small scenes, put together from pieces of Mitsuba's XML.

use std::path::Path;

use bidir::{load, plugin::Library, scene::Scene};

use crate::pictures::Subject;

/// Reads a scene that names no files.
pub fn read(content: &str) -> Subject {
    read_beside(content, None)
}

/// Reads a scene whose files are in `folder`.
pub fn read_beside(content: &str, folder: Option<&Path>) -> Subject {
    let text = format!("<scene version=\"3.0.0\">{content}</scene>");
    let description = load::load_str(&text, Path::new("test.xml"), folder, &[], &Library::default()).expect("a good scene").description;
    let scene = Scene::new(&description).expect("a scene");
    Subject { description, scene }
}

/// A path tracer for paths of up to `depth` segments (−1: any).
pub fn depth(depth: i32) -> String {
    format!(r#"<integrator type="path"><integer name="max_depth" value="{depth}"/></integrator>"#)
}

/// A square film with pixels for a filter.
pub fn film(size: u32) -> String {
    film_with(size, size, r#"<rfilter type="box"/>"#)
}

/// A film.
pub fn film_with(width: u32, height: u32, content: &str) -> String {
    format!(r#"<film type="hdrfilm"><integer name="width" value="{width}"/><integer name="height" value="{height}"/>{content}</film>"#)
}

/// A camera that looks at the middle of the [`room`], of any kind; `content` holds its film.
pub fn camera(kind: &str, content: &str) -> String {
    let scale = if kind == "orthographic" { r#"<scale value="1.3"/>"# } else { "" };
    let fov = if kind == "orthographic" { "" } else { r#"<float name="fov" value="45"/>"# };
    format!(
        r#"<sensor type="{kind}">{fov}{content}<transform name="to_world">{scale}<lookat origin="0, 1.2, 4" target="0, 0.8, 0" up="0, 1, 0"/></transform></sensor>"#
    )
}

/// A pinhole on the [`room`], 16×16 pixels.
pub fn pinhole() -> String {
    camera("perspective", &film(16))
}

/// A wide lens on the [`room`], focused on its middle, 16×16 pixels.
pub fn lens(radius: f64) -> String {
    let content = format!(r#"<float name="aperture_radius" value="{radius}"/><float name="focus_distance" value="4"/>{}"#, film(16));
    camera("thinlens", &content)
}

/// A floor, a back wall and a red wall at the left; x and z from −2 to 2, y from 0.
pub fn room() -> String {
    let wall = |transform: &str, colour: &str| shape("rectangle", transform, &diffuse(colour));
    let floor = wall(r#"<scale value="2"/><rotate x="1" angle="-90"/>"#, "0.6, 0.6, 0.7");
    let back = wall(r#"<scale value="2"/><translate value="0, 1.5, -2"/>"#, "0.5, 0.6, 0.5");
    let left = wall(r#"<scale value="2"/><rotate y="1" angle="90"/><translate value="-2, 1.5, 0"/>"#, "0.7, 0.3, 0.2");
    format!("{floor}{back}{left}")
}

/// A shape; `content` is its material and light.
pub fn shape(kind: &str, transform: &str, content: &str) -> String {
    format!(r#"<shape type="{kind}"><transform name="to_world">{transform}</transform>{content}</shape>"#)
}

/// A ball in the middle of the [`room`].
pub fn ball(material: &str) -> String {
    shape("sphere", r#"<scale value="0.6"/><translate value="0, 0.65, 0"/>"#, material)
}

/// A matt surface.
pub fn diffuse(colour: &str) -> String {
    format!(r#"<bsdf type="diffuse"><rgb name="reflectance" value="{colour}"/></bsdf>"#)
}

/// A surface with nothing but numbers.
pub fn bsdf(kind: &str, content: &str) -> String {
    format!(r#"<bsdf type="{kind}">{content}</bsdf>"#)
}

/// The light of a shape.
pub fn area(radiance: f64) -> String {
    format!(r#"<emitter type="area"><rgb name="radiance" value="{radiance}, {}, {}"/></emitter>"#, 0.9 * radiance, 0.7 * radiance)
}

/// A square metre of light under the [`room`]'s missing ceiling.
pub fn panel() -> String {
    panel_of("rectangle")
}

/// Such a light of a flat shape.
pub fn panel_of(kind: &str) -> String {
    let transform = r#"<scale value="0.5"/><rotate x="1" angle="90"/><translate value="0.5, 2.6, 0.5"/>"#;
    shape(kind, transform, &(diffuse("0.3, 0.3, 0.3") + &area(12.0)))
}

/// A light that is not on a shape.
pub fn emitter(kind: &str, content: &str) -> String {
    format!(r#"<emitter type="{kind}">{content}</emitter>"#)
}

/// A number.
pub fn float(name: &str, value: f64) -> String {
    format!(r#"<float name="{name}" value="{value}"/>"#)
}

/// A colour.
pub fn rgb(name: &str, value: &str) -> String {
    format!(r#"<rgb name="{name}" value="{value}"/>"#)
}

/// A coarse ball: shading normals that point away from its centre.
pub const OCTAHEDRON: &str = "\
v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1
vn 1 0 0\nvn -1 0 0\nvn 0 1 0\nvn 0 -1 0\nvn 0 0 1\nvn 0 0 -1
f 1//1 3//3 5//5\nf 3//3 2//2 5//5\nf 2//2 4//4 5//5\nf 4//4 1//1 5//5
f 3//3 1//1 6//6\nf 2//2 3//3 6//6\nf 4//4 2//2 6//6\nf 1//1 4//4 6//6
";
