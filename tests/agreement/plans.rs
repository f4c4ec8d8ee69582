//! Every plan that `auto` may choose makes the same picture.

use bidir_kernel::{Heuristic, Techniques};

use super::agree;
use crate::{
    estimators::{Estimator, estimator},
    pictures::BDPT,
    scenes::*,
};

const fn plan(name: &'static str, next_event: f64, walks: f64, connection: f64) -> Estimator {
    let techniques = Techniques { light_hit: 1.0, next_event, connection, lens_splat: walks, lens_hit: walks };
    estimator(name, techniques, Heuristic::Balance, 24)
}

const PLANS: &[Estimator] = &[
    estimator("bdpt", BDPT, Heuristic::Balance, 12),
    plan("no next event", 0.0, 1.0, 1.0),
    plan("two next events, a quarter of the light paths", 2.0, 0.25, 0.25),
    plan("light paths without connections", 1.0, 0.5, 0.0),
    plan("a quarter of the connections", 1.0, 1.0, 0.25),
    plan("two light paths", 1.0, 2.0, 2.0),
    plan("three light paths in two samples, few connections", 1.0, 1.5, 0.3),
    estimator("connections alone", Techniques { lens_splat: 0.0, lens_hit: 0.0, ..BDPT }, Heuristic::Power, 24),
    estimator("light paths, half as many", Techniques { lens_splat: 0.5, lens_hit: 0.5, ..Techniques::NONE }, Heuristic::Balance, 64),
];

fn room_with(material: &str, camera: &str, light: &str) -> String {
    [depth(6), camera.to_owned(), room(), ball(material), light.to_owned()].concat()
}

#[test]
fn plans_of_a_matt_room() {
    agree("plans_matt", &read(&room_with(&diffuse("0.6, 0.4, 0.3"), &pinhole(), &panel())), PLANS);
}

#[test]
fn plans_of_a_glossy_room_through_a_lens() {
    let plastic = bsdf("roughconductor", &float("alpha", 0.3));
    agree("plans_glossy", &read(&room_with(&plastic, &lens(0.2), &panel())), PLANS);
}

#[test]
fn plans_under_point_lights_and_sky() {
    let point = emitter("point", &(rgb("intensity", "3, 2, 1") + r#"<point name="position" x="0.5" y="1.5" z="0.3"/>"#));
    let lights = [point, emitter("constant", &rgb("radiance", "0.3, 0.4, 0.5"))].concat();
    agree("plans_point_and_sky", &read(&room_with(&diffuse("0.6, 0.4, 0.3"), &pinhole(), &lights)), PLANS);
}
