//! Every kind of light over a matt room with a matt ball.

use std::fs;

use bidir::image::{Image, write};

use super::{ALL, NOT_PATH, agree, agree_after};
use crate::scenes::*;

fn lit_by(lights: &str) -> String {
    [depth(6), pinhole(), room(), ball(&diffuse("0.6, 0.4, 0.3")), lights.to_owned()].concat()
}

#[test]
fn a_rectangle() {
    agree("rectangle_light", &read(&lit_by(&panel())), ALL);
}

#[test]
fn a_disk_squashed_to_an_ellipse() {
    let transform = r#"<scale value="0.8, 0.3, 1"/><rotate x="1" angle="70"/><translate value="0.3, 2.4, 0.8"/>"#;
    agree("disk_light", &read(&lit_by(&shape("disk", transform, &area(14.0)))), ALL);
}

#[test]
fn a_sphere() {
    let light = shape("sphere", r#"<scale value="0.3"/><translate value="1, 1.4, 0.6"/>"#, &area(10.0));
    agree("sphere_light", &read(&lit_by(&light)), ALL);
}

#[test]
fn a_sphere_around_everything() {
    let light = shape("sphere", r#"<scale value="9"/>"#, &format!(r#"<boolean name="flip_normals" value="true"/>{}"#, area(1.0)));
    agree_after(3, "sphere_around", &read(&lit_by(&light)), ALL);
}

#[test]
fn a_cylinder() {
    let light = r#"<shape type="cylinder"><point name="p0" value="-1, 2, 0.5"/><point name="p1" value="1, 2.3, 0"/><float name="radius" value="0.1"/>"#;
    agree("cylinder_light", &read(&lit_by(&format!("{light}{}</shape>", area(10.0)))), ALL);
}

#[test]
fn a_cube_of_triangles() {
    let light = shape("cube", r#"<scale value="0.2, 0.3, 0.2"/><rotate y="1" angle="30"/><translate value="1, 1.6, 0.7"/>"#, &area(8.0));
    agree("mesh_light", &read(&lit_by(&light)), ALL);
}

#[test]
fn a_mesh_with_smooth_normals() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("octahedron.obj"), OCTAHEDRON).expect("a mesh");
    let mesh = r#"<string name="filename" value="octahedron.obj"/>"#;
    let light = shape("obj", r#"<scale value="0.4"/><translate value="1, 1.5, 0.7"/>"#, &(mesh.to_owned() + &area(9.0)));
    agree("smooth_mesh_light", &read_beside(&lit_by(&light), Some(folder.path())), ALL);
}

#[test]
fn a_mirrored_and_stretched_panel() {
    let transform = r#"<scale value="-0.9, 0.4, 1"/><rotate x="1" angle="90"/><translate value="0, 2.5, 0.4"/>"#;
    agree("mirrored_light", &read(&lit_by(&shape("rectangle", transform, &area(10.0)))), ALL);
}

#[test]
fn a_point() {
    let light = emitter("point", &(rgb("intensity", "9, 8, 6") + r#"<point name="position" value="0.8, 2.2, 1"/>"#));
    agree("point_light", &read(&lit_by(&light)), ALL);
}

#[test]
fn a_spot() {
    let aim = r#"<transform name="to_world"><lookat origin="1, 2.5, 1.5" target="0, 0.4, 0" up="0, 1, 0"/></transform>"#;
    let light = emitter("spot", &(rgb("intensity", "40, 38, 30") + &float("cutoff_angle", 28.0) + aim));
    agree("spot_light", &read(&lit_by(&light)), ALL);
}

#[test]
fn a_directional_one() {
    let light = emitter("directional", &(rgb("irradiance", "3, 3, 2") + r#"<vector name="direction" value="-1, -2, -0.7"/>"#));
    agree("directional_light", &read(&lit_by(&light)), ALL);
}

#[test]
fn a_constant_environment() {
    agree("constant_environment", &read(&lit_by(&emitter("constant", &rgb("radiance", "0.8, 0.9, 1")))), ALL);
}

/// A bright patch on a gradient; turned, so that image and world differ.
#[test]
fn an_image_as_environment() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut image = Image::black(16, 8);
    for (i, pixel) in image.pixels.iter_mut().enumerate() {
        let (x, y) = (i % 16, i / 16);
        let patch = if (4..6).contains(&x) && (1..3).contains(&y) { 12.0 } else { 0.0 };
        *pixel = [0.2 + 0.05 * x as f32 + patch, 0.3 + 0.1 * y as f32 + patch, 0.5 + patch];
    }
    write::write(&folder.path().join("sky.exr"), &(&image).into()).expect("an image");
    let turn = r#"<transform name="to_world"><rotate y="1" angle="50"/><rotate x="1" angle="10"/></transform>"#;
    let light = emitter("envmap", &(r#"<string name="filename" value="sky.exr"/>"#.to_owned() + &float("scale", 0.7) + turn));
    agree("image_environment", &read_beside(&lit_by(&light), Some(folder.path())), ALL);
}

/// Many kinds at once, so that the choice among them matters.
#[test]
fn all_kinds_together() {
    let point = emitter("point", &(rgb("intensity", "2, 1, 1") + r#"<point name="position" value="-1, 2, 1"/>"#));
    let sun = emitter("directional", &(rgb("irradiance", "0.5, 0.5, 1") + r#"<vector name="direction" value="-1, -2, -0.7"/>"#));
    let sky = emitter("constant", &rgb("radiance", "0.1, 0.2, 0.1"));
    let bulb = shape("sphere", r#"<scale value="0.2"/><translate value="1, 1.4, 0.6"/>"#, &area(6.0));
    agree("all_lights", &read(&lit_by(&[panel(), point, sun, sky, bulb].concat())), ALL);
}

/// More lights than next event looks at one by one.
#[test]
fn forty_of_them() {
    let lights: String = (0..40)
        .map(|i| {
            let (x, z) = (f64::from(i % 8) * 0.4 - 1.4, f64::from(i / 8) * 0.5 - 1.0);
            let transform = format!(r#"<scale value="0.1"/><rotate x="1" angle="90"/><translate value="{x}, 2.4, {z}"/>"#);
            shape("disk", &transform, &area(3.0 + f64::from(i % 5) * 6.0))
        })
        .collect();
    agree("forty_lights", &read(&lit_by(&lights)), ALL);
}

/// Two hundred of every kind above the ball, with powers over two decades, some turned away from everything; beside them a ceiling that
/// shines, a sky and a sun.
#[test]
fn two_hundred_of_all_kinds() {
    let mut lights: String = (0..200)
        .map(|i| {
            let along = |step: f64| (f64::from(i) * step).fract();
            let (x, y, z) = (3.0 * along(0.754_877_7) - 1.5, 1.45 + 1.2 * along(0.569_840_3), 2.4 * along(0.362_651_9) - 1.0);
            let level = 100_f64.powf(along(0.618_034));
            let place = format!(r#"<rotate x="1" angle="{}"/><translate value="{x}, {y}, {z}"/>"#, 360.0 * along(0.414_213_6));
            let at = format!(r#"<point name="position" value="{x}, {y}, {z}"/>"#);
            let intensity = rgb("intensity", &format!("{0}, {0}, {1}", 0.004 * level, 0.003 * level));
            match i % 6 {
                0 => shape("disk", &format!(r#"<scale value="0.03"/>{place}"#), &area(level)),
                1 => shape("rectangle", &format!(r#"<scale value="0.02, 0.05, 1"/>{place}"#), &area(level)),
                2 => shape("sphere", &format!(r#"<scale value="0.02"/>{place}"#), &area(level)),
                3 => shape("cube", &format!(r#"<scale value="0.02, 0.01, 0.03"/>{place}"#), &area(level)),
                4 => emitter(
                    "spot",
                    &(intensity + &float("cutoff_angle", 40.0) + &format!(r#"<transform name="to_world">{place}</transform>"#)),
                ),
                _ => emitter("point", &(intensity + &at)),
            }
        })
        .collect();
    lights += &emitter("constant", &rgb("radiance", "0.02, 0.02, 0.03"));
    lights += &emitter("directional", &(rgb("irradiance", "0.1, 0.1, 0.08") + r#"<vector name="direction" value="-1, -2, -0.7"/>"#));
    lights += &shape("rectangle", r#"<rotate x="1" angle="90"/><translate value="0, 2.8, 0"/>"#, &area(0.2));
    agree_after(4, "two_hundred_lights", &read(&lit_by(&lights)), ALL);
}

/// Nothing but a light walk or a join of two finds light inside glass: a point light in a glass ball.
#[test]
fn a_point_inside_glass() {
    let light = emitter("point", &(rgb("intensity", "9, 8, 6") + r#"<point name="position" value="0.2, 0.7, 0.1"/>"#));
    let glass = ball(&bsdf("dielectric", &float("int_ior", 1.5)));
    let scene = [depth(8), camera("perspective", &film(16)), room(), glass, light].concat();
    // The camera looks past the ball, which light tracing cannot see.
    let aside = scene.replace(r#"target="0, 0.8, 0""#, r#"target="-3.2, 0.6, 0""#);
    agree_after(2, "point_inside_glass", &read(&aside), NOT_PATH);
}
