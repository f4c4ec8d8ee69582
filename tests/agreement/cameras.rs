//! Every kind of camera and film on a matt room.

use bidir_kernel::Heuristic;

use super::{ALL, NOT_LIGHT, agree};
use crate::{
    pictures::{BDPT, LIGHT, PATH},
    scenes::*,
};

fn seen_by(camera: &str) -> String {
    [depth(6), camera.to_owned(), room(), ball(&diffuse("0.6, 0.4, 0.3")), panel()].concat()
}

fn filmed(content: &str) -> String {
    seen_by(&camera("perspective", &film_with(16, 16, content)))
}

fn hidden(integrator: &str) -> String {
    integrator.replace("</integrator>", r#"<boolean name="hide_emitters" value="true"/></integrator>"#)
}

#[test]
fn a_thin_lens() {
    agree("thin_lens", &read(&seen_by(&lens(0.1))), ALL);
}

#[test]
fn a_lens_as_wide_as_a_window() {
    agree("wide_lens", &read(&seen_by(&lens(0.8))), ALL);
}

#[test]
fn an_orthographic_camera() {
    agree("orthographic", &read(&seen_by(&camera("orthographic", &film(16)))), ALL);
}

#[test]
fn a_camera_with_parallel_rays_under_the_sun() {
    let sun = emitter("directional", &(rgb("irradiance", "3, 3, 2") + r#"<vector name="direction" value="-1, -2, -0.7"/>"#));
    let scene = [depth(6), camera("orthographic", &film(16)), room(), ball(&diffuse("0.6, 0.4, 0.3")), sun].concat();
    agree("orthographic_sun", &read(&scene), ALL);
}

#[test]
fn a_wide_angle_with_an_off_centre_axis() {
    let camera = camera("perspective", &film_with(24, 16, ""))
        .replace(r#"value="45""#, r#"value="100""#)
        .replace("<film", &(float("principal_point_offset_x", 0.1) + &float("principal_point_offset_y", -0.2) + "<film"));
    agree("wide_angle", &read(&seen_by(&camera)), ALL);
}

#[test]
fn a_clipped_view() {
    let clips = float("near_clip", 3.2) + &float("far_clip", 6.0);
    agree("clipped", &read(&seen_by(&camera("perspective", &(clips + &film(16))))), ALL);
}

/// A lens that sees only so far is never shown the sky by a light walk: path tracing alone finds what it sees directly.
#[test]
fn a_clipped_view_of_the_sky() {
    let clips = float("near_clip", 3.2) + &float("far_clip", 6.0);
    let sky = emitter("constant", &rgb("radiance", "0.8, 0.9, 1"));
    agree("clipped_sky", &read(&(seen_by(&camera("perspective", &(clips + &film(16)))) + &sky)), NOT_LIGHT);
}

#[test]
fn a_crop_window() {
    let crop = r#"<integer name="crop_offset_x" value="13"/><integer name="crop_offset_y" value="6"/><integer name="crop_width" value="16"/><integer name="crop_height" value="24"/>"#;
    agree("crop", &read(&seen_by(&camera("perspective", &film_with(40, 32, crop)))), ALL);
}

#[test]
fn a_gaussian_filter() {
    agree("gaussian", &read(&filmed(r#"<rfilter type="gaussian"/>"#)), ALL);
}

#[test]
fn a_wide_gaussian_filter_with_a_crop_window() {
    let crop = r#"<integer name="crop_offset_x" value="3"/><integer name="crop_offset_y" value="6"/><integer name="crop_width" value="16"/><integer name="crop_height" value="16"/>"#;
    let filter = r#"<rfilter type="gaussian"><float name="stddev" value="1.2"/></rfilter>"#;
    agree("gaussian_crop", &read(&seen_by(&camera("perspective", &film_with(24, 24, &format!("{crop}{filter}"))))), ALL);
}

#[test]
fn a_tent_filter() {
    agree("tent", &read(&filmed(r#"<rfilter type="tent"/>"#)), ALL);
}

/// The panel hangs low enough to be seen, were it not hidden; it reflects too.
fn low_panel(camera: &str) -> String {
    let transform = r#"<scale value="0.6"/><rotate x="1" angle="60"/><translate value="0.3, 1.6, -0.5"/>"#;
    let light = shape("rectangle", transform, &(bsdf("twosided", &diffuse("0.8, 0.8, 0.8")) + &area(6.0)));
    [hidden(&depth(6)), camera.to_owned(), room(), ball(&diffuse("0.6, 0.4, 0.3")), light].concat()
}

#[test]
fn hidden_emitters() {
    agree("hidden_emitters", &read(&low_panel(&pinhole())), ALL);
}

/// A light walk that leaves a hidden emitter's own surface must not land on the lens either.
#[test]
fn hidden_emitters_before_a_lens() {
    agree("hidden_emitters_lens", &read(&low_panel(&lens(0.8))), ALL);
}

/// Nothing but the panel stands where the camera looks; a floor behind the camera lights its front.
#[test]
fn a_hidden_emitter_is_never_seen() {
    let panel = shape("rectangle", r#"<translate value="0, 0.8, 0"/>"#, &(diffuse("0.8, 0.8, 0.8") + &area(1.0)));
    let behind =
        shape("rectangle", r#"<scale value="9"/><rotate x="1" angle="180"/><translate value="0, 0, 5"/>"#, &diffuse("0.9, 0.9, 0.9"));
    let scene = read(&[hidden(&depth(4)), lens(0.8), panel, behind].concat());
    for techniques in [PATH, LIGHT, BDPT] {
        let image = scene.image(&scene.job(scene.strategy(techniques, Heuristic::Balance), 256, 1));
        assert!(image.pixels.iter().all(|&pixel| pixel == [0.0; 3]), "{techniques:?}");
    }
}

#[test]
fn a_hidden_environment() {
    let sky = emitter("constant", &rgb("radiance", "0.8, 0.9, 1"));
    let scene = [hidden(&depth(6)), lens(0.4), shape("rectangle", r#"<scale value="2"/><rotate x="1" angle="-90"/>"#, ""), sky].concat();
    agree("hidden_environment", &read(&scene), ALL);
}

/// The lens stands outside the sphere about the geometry that environments send their light through.
#[test]
fn a_lens_far_from_everything_under_an_open_sky() {
    let sky = emitter("constant", &rgb("radiance", "0.8, 0.9, 1"));
    let scene = [depth(5), lens(0.8), ball(&diffuse("0.6, 0.4, 0.3")), sky].concat();
    agree("lens_under_sky", &read(&scene), ALL);
}

#[test]
fn a_lens_inside_a_closed_room_of_light() {
    let walls = shape("cube", r#"<scale value="5"/>"#, &(r#"<boolean name="flip_normals" value="true"/>"#.to_owned() + &area(0.5)));
    agree("lens_in_light", &read(&(seen_by(&lens(0.8)) + &walls)), ALL);
}
