//! Every kind of surface on the ball of a matt room under a square metre of light.

use std::fs;

use bidir::image::{Image, write};

use super::{ALL, NOT_LIGHT, agree, agree_after};
use crate::scenes::*;

fn with_ball(material: &str) -> String {
    [depth(7), pinhole(), room(), ball(material), panel()].concat()
}

/// The camera sees what the ball does to light, not the ball.
fn aside(material: &str) -> String {
    with_ball(material).replace(r#"target="0, 0.8, 0""#, r#"target="-3.2, 0.6, 0""#)
}

fn rough(kind: &str, content: &str) -> String {
    bsdf(kind, &format!(r#"{content}<string name="distribution" value="ggx"/>"#))
}

#[test]
fn a_mirror() {
    agree_after(8, "mirror", &read(&with_ball(&bsdf("conductor", ""))), NOT_LIGHT);
}

#[test]
fn a_mirror_out_of_sight() {
    agree("mirror_aside", &read(&aside(&bsdf("conductor", ""))), ALL);
}

#[test]
fn a_coloured_metal() {
    agree("metal", &read(&aside(&bsdf("conductor", r#"<string name="material" value="Au"/>"#))), ALL);
}

#[test]
fn rough_metal_ggx() {
    let material = rough("roughconductor", &(r#"<string name="material" value="Cu"/>"#.to_owned() + &float("alpha", 0.25)));
    agree("rough_metal_ggx", &read(&with_ball(&material)), ALL);
}

#[test]
fn rough_metal_beckmann() {
    let material = bsdf("roughconductor", &(float("alpha", 0.3) + r#"<string name="distribution" value="beckmann"/>"#));
    agree("rough_metal_beckmann", &read(&with_ball(&material)), ALL);
}

#[test]
fn brushed_metal() {
    let material = rough("roughconductor", &(float("alpha_u", 0.5) + &float("alpha_v", 0.15)));
    agree("brushed_metal", &read(&with_ball(&material)), ALL);
}

#[test]
fn glass() {
    agree_after(8, "glass", &read(&with_ball(&bsdf("dielectric", &float("int_ior", 1.5)))), NOT_LIGHT);
}

#[test]
fn glass_out_of_sight() {
    agree("glass_aside", &read(&aside(&bsdf("dielectric", &float("int_ior", 1.5)))), ALL);
}

/// A pane before the whole room: everything is seen through it, and it mirrors the room.
#[test]
fn a_pane() {
    let pane = shape("rectangle", r#"<scale value="3"/><translate value="0, 1, 2.4"/>"#, &bsdf("thindielectric", ""));
    agree("pane", &read(&(with_ball(&diffuse("0.6, 0.4, 0.3")) + &pane)), NOT_LIGHT);
}

#[test]
fn a_pane_out_of_sight() {
    let pane = shape("rectangle", r#"<rotate y="1" angle="90"/><translate value="0.8, 1, 0"/>"#, &bsdf("thindielectric", ""));
    agree("pane_aside", &read(&(aside(&diffuse("0.6, 0.4, 0.3")) + &pane)), ALL);
}

#[test]
fn rough_glass() {
    let material = rough("roughdielectric", &(float("int_ior", 1.5) + &float("alpha", 0.4)));
    agree("rough_glass", &read(&with_ball(&material)), ALL);
}

#[test]
fn rough_glass_beckmann_inside_out() {
    let material = bsdf(
        "roughdielectric",
        &(float("int_ior", 1.0) + &float("ext_ior", 1.4) + &float("alpha", 0.5) + r#"<string name="distribution" value="beckmann"/>"#),
    );
    agree("rough_glass_beckmann", &read(&with_ball(&material)), ALL);
}

/// Light tracing sees the plastic's base but not its coat's mirror image; out of sight it needs neither.
#[test]
fn plastic() {
    agree_after(8, "plastic", &read(&with_ball(&bsdf("plastic", &rgb("diffuse_reflectance", "0.6, 0.2, 0.1")))), NOT_LIGHT);
}

#[test]
fn plastic_out_of_sight() {
    let nonlinear = rgb("diffuse_reflectance", "0.6, 0.2, 0.1") + r#"<boolean name="nonlinear" value="true"/>"#;
    agree("plastic_aside", &read(&aside(&bsdf("plastic", &nonlinear))), ALL);
}

/// A sheet that the camera sees from both sides in turn: matt red in front, rough metal behind.
#[test]
fn a_sheet_with_two_sides() {
    let sides = bsdf("twosided", &(diffuse("0.7, 0.2, 0.2") + &rough("roughconductor", &float("alpha", 0.4))));
    let sheet = |angle: f64, x: f64| {
        let transform = format!(r#"<scale value="0.5"/><rotate y="1" angle="{angle}"/><translate value="{x}, 0.7, 0.2"/>"#);
        shape("rectangle", &transform, &sides)
    };
    agree("two_sides", &read(&[depth(7), pinhole(), room(), sheet(40.0, -0.6), sheet(200.0, 0.6), panel()].concat()), ALL);
}

/// A sheet that is diffuse on one side and a mirror on the other has both kinds of lobe.
#[test]
fn a_sheet_with_a_mirror_behind() {
    let sides = bsdf("twosided", &(diffuse("0.7, 0.2, 0.2") + &bsdf("conductor", "")));
    let sheet = shape("rectangle", r#"<scale value="0.7"/><rotate y="1" angle="20"/><translate value="0, 0.8, 0.2"/>"#, &sides);
    agree("mirror_behind", &read(&[depth(7), pinhole(), room(), sheet, panel()].concat()), ALL);
}

/// A null ball around the matt one: each crossing counts, so paths of up to 7 segments lose their last ones inside.
#[test]
fn a_shell_of_nothing() {
    let shell = shape("sphere", r#"<scale value="0.9"/><translate value="0, 0.95, 0"/>"#, &bsdf("null", ""));
    agree_after(2, "null_shell", &read(&(with_ball(&diffuse("0.6, 0.4, 0.3")) + &shell)), NOT_LIGHT);
}

#[test]
fn a_shell_of_nothing_out_of_sight() {
    let shell = shape("sphere", r#"<scale value="0.9"/><translate value="0, 0.95, 0"/>"#, &bsdf("null", ""));
    agree("null_shell_aside", &read(&(aside(&diffuse("0.6, 0.4, 0.3")) + &shell)), ALL);
}

fn octahedron(material: &str) -> super::Subject {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("octahedron.obj"), OCTAHEDRON).expect("a mesh");
    let mesh = format!(r#"<string name="filename" value="octahedron.obj"/>{material}"#);
    let shape = shape("obj", r#"<scale value="0.9"/><rotate y="1" angle="20"/><translate value="0, 0.9, 0"/>"#, &mesh);
    read_beside(&[depth(7), pinhole(), room(), shape, panel()].concat(), Some(folder.path()))
}

/// The adjoint factor (methods §4): without it, light tracing shows the facets.
#[test]
fn smooth_normals_on_a_coarse_mesh() {
    agree("smooth_normals", &octahedron(&diffuse("0.7, 0.7, 0.7")), ALL);
}

#[test]
fn smooth_normals_on_a_coarse_glossy_mesh() {
    agree("smooth_glossy_normals", &octahedron(&rough("roughconductor", &float("alpha", 0.4))), ALL);
}

#[test]
fn smooth_normals_on_a_coarse_rough_glass_mesh() {
    agree("smooth_rough_glass_normals", &octahedron(&rough("roughdielectric", &float("alpha", 0.4))), ALL);
}

#[test]
fn textures() {
    let folder = tempfile::tempdir().expect("a folder");
    let pixels = (0..64).map(|i| [0.1 + 0.01 * i as f32, 0.9 - 0.01 * i as f32, if i % 3 == 0 { 0.8 } else { 0.2 }]).collect();
    write::write(&folder.path().join("cloth.exr"), &(&Image { width: 8, height: 8, pixels }).into()).expect("an image");
    let bitmap = r#"<bsdf type="diffuse"><texture type="bitmap" name="reflectance"><string name="filename" value="cloth.exr"/><boolean name="raw" value="true"/></texture></bsdf>"#;
    let checks = r#"<bsdf type="roughconductor"><texture type="checkerboard" name="alpha"><rgb name="color0" value="0.2"/><rgb name="color1" value="0.5"/><transform name="to_uv"><scale value="4"/></transform></texture></bsdf>"#;
    let sheet = shape("rectangle", r#"<scale value="0.5"/><rotate y="1" angle="30"/><translate value="1.2, 0.7, 0"/>"#, bitmap);
    agree_after(2, "textures", &read_beside(&(with_ball(checks) + &sheet), Some(folder.path())), ALL);
}
