//! Glass passes what Fresnel says. m parallel surfaces of reflectance R pass (1 − R) / (1 + (m − 1) R), all inner reflections added up.

use std::f64::consts::PI;

use bidir_kernel::Heuristic;

use super::{WITHIN, WITHIN_NOISE};
use crate::{
    pictures::{BDPT, LIGHT, PATH},
    scenes::*,
    statistics::assert_is,
};

const ETA: f64 = 1.5;

/// Unpolarised reflectance of one surface.
fn reflectance(cos: f64) -> f64 {
    let inner = (1.0 - (1.0 - cos * cos) / (ETA * ETA)).sqrt();
    let (s, p) = ((cos - ETA * inner) / (cos + ETA * inner), (ETA * cos - inner) / (ETA * cos + inner));
    0.5 * (s * s + p * p)
}

fn passed(cos: f64, surfaces: u32) -> f64 {
    let r = reflectance(cos);
    (1.0 - r) / (1.0 + f64::from(surfaces - 1) * r)
}

fn index() -> String {
    float("int_ior", ETA) + &float("ext_ior", 1.0)
}

/// So many blocks of glass across the z axis, from z = 1 on.
fn blocks(count: u32) -> String {
    let block = |i: u32| {
        let transform = format!(r#"<scale value="6, 6, 0.1"/><translate value="0, 0, {}"/>"#, 1.0 + 0.5 * f64::from(i));
        shape("cube", &transform, &bsdf("dielectric", &index()))
    };
    (0..count).map(block).collect()
}

fn panes(count: u32) -> String {
    let pane = |i: u32| {
        let transform = format!(r#"<scale value="6"/><translate value="0, 0, {}"/>"#, 1.0 + 0.5 * f64::from(i));
        shape("rectangle", &transform, &bsdf("thindielectric", &index()))
    };
    (0..count).map(pane).collect()
}

/// Seen through glass at an angle whose cosine is 0.8, before a wall of light that reflects nothing.
fn through(glass: &str) -> String {
    let to_world = r#"<transform name="to_world"><scale value="0.1"/><lookat origin="0, 3, 5" target="0, 0, 1" up="0, 1, 0"/></transform>"#;
    let sensor = format!(r#"<sensor type="orthographic">{}{to_world}</sensor>"#, film(2));
    let wall = shape("rectangle", r#"<scale value="6"/>"#, &(diffuse("0, 0, 0") + &emitter("area", &rgb("radiance", "2, 2, 2"))));
    [depth(-1), sensor, glass.to_owned(), wall].concat()
}

#[test]
fn one_two_and_three_blocks_dim_what_is_behind_as_fresnel_says() {
    for count in 1..=3 {
        for (kind, glass) in [("blocks", blocks(count)), ("panes", panes(count))] {
            let subject = read(&through(&glass));
            for (estimator, techniques) in [("path", PATH), ("bdpt", BDPT)] {
                let found = subject.pictures(subject.strategy(techniques, Heuristic::Balance), 3072, 1);
                let wanted = 2.0 * passed(0.8, 2 * count);
                assert_is(&format!("{count} {kind}, {estimator}"), &found.mean(found.whole(), &[0, 1, 2]), wanted, 12, WITHIN);
            }
        }
    }
}

/// The sun through glass on a floor so dark that what it throws back does not matter: only light walks find it (LuxCore, issue 678).
#[test]
fn one_two_and_three_blocks_dim_the_sun_as_fresnel_says() {
    let sun = emitter("directional", &(rgb("irradiance", "1000, 1000, 1000") + r#"<vector name="direction" value="0, -3, -4"/>"#));
    let to_world = r#"<transform name="to_world"><scale value="4"/><lookat origin="0, 0, 0.5" target="0, 0, 0" up="0, 1, 0"/></transform>"#;
    let sensor = format!(r#"<sensor type="orthographic">{}{to_world}</sensor>"#, film(2));
    let floor = shape("rectangle", r#"<scale value="6"/>"#, &diffuse("0.001, 0.001, 0.001"));
    for count in 1..=3 {
        for (kind, glass) in [("blocks", blocks(count)), ("panes", panes(count))] {
            let subject = read(&[depth(-1), sensor.clone(), floor.clone(), glass, sun.clone()].concat());
            for (estimator, techniques) in [("light", LIGHT), ("bdpt", BDPT)] {
                let found = subject.pictures(subject.strategy(techniques, Heuristic::Balance), 1024, 1);
                let wanted = 1000.0 * 0.8 * passed(0.8, 2 * count) * 0.001 / PI;
                assert_is(&format!("sun, {count} {kind}, {estimator}"), &found.mean(found.whole(), &[0, 1, 2]), wanted, 12, WITHIN_NOISE);
            }
        }
    }
}
