//! Lights over a plane: irradiance in closed form, pixel by pixel.

use std::f64::consts::PI;

use super::{ESTIMATORS, Estimator};
use crate::{scenes::*, statistics::assert_is};

const SIZE: u32 = 6;

/// The floor seen straight from above, x and z from −1 to 1, from below the light.
fn floor_under(light: &str) -> String {
    let to_world = r#"<transform name="to_world"><lookat origin="0, 0.5, 0" target="0, 0, 0" up="0, 0, 1"/></transform>"#;
    let sensor = format!(r#"<sensor type="orthographic">{}{to_world}</sensor>"#, film(SIZE));
    let floor = shape("rectangle", r#"<scale value="3"/><rotate x="1" angle="-90"/>"#, &diffuse("0.5, 0.5, 0.5"));
    [depth(2), sensor, floor, light.to_owned()].concat()
}

/// Holds every pixel against ρ/π times the irradiance at a distance from the axis, averaged over the pixel.
fn holds(name: &str, light: &str, samples: u32, irradiance: impl Fn(f64) -> f64) {
    const STEPS: u32 = 32;
    let albedo = 0.5;
    let subject = read(&floor_under(light));
    let at = |i: u32| (f64::from(i) + 0.5) / f64::from(SIZE * STEPS) * 2.0 - 1.0;
    let average = |x: u32, y: u32| {
        let sum: f64 = (0..STEPS * STEPS).map(|i| irradiance(at(x * STEPS + i % STEPS).hypot(at(y * STEPS + i / STEPS)))).sum();
        sum / f64::from(STEPS * STEPS)
    };
    let comparisons = ESTIMATORS.len() * (SIZE * SIZE + 1) as usize;
    for Estimator { name: estimator, techniques, heuristic, effort, within } in ESTIMATORS {
        let found = subject.pictures(subject.strategy(techniques, heuristic), samples * effort, 1);
        let mut sum = 0.0;
        for (x, y) in (0..SIZE * SIZE).map(|i| (i % SIZE, i / SIZE)) {
            let wanted = albedo / PI * average(x, y);
            sum += wanted;
            // A single pixel is noisier than the whole.
            assert_is(
                &format!("{name}, {estimator} at ({x}, {y})"),
                &found.mean([x, y, 1, 1], &[0, 1, 2]),
                wanted,
                comparisons,
                10.0 * within,
            );
        }
        let wanted = sum / f64::from(SIZE * SIZE);
        assert_is(&format!("{name}, {estimator}, whole"), &found.mean(found.whole(), &[0, 1, 2]), wanted, comparisons, 2.0 * within);
    }
}

/// Radius R, height h, distance x from the axis: E = π L/2 (1 − (x² + h² − R²) / √((x² + h² + R²)² − 4 R² x²)).
#[test]
fn a_disk() {
    let (radius, height): (f64, f64) = (0.7, 1.0);
    let transform = r#"<scale value="0.7"/><rotate x="1" angle="90"/><translate value="0, 1, 0"/>"#;
    let light = shape("disk", transform, &emitter("area", &rgb("radiance", "2, 2, 2")));
    holds("disk", &light, 256, |x| {
        let (x2, h2, r2) = (x * x, height * height, radius * radius);
        let sum = x2 + h2 + r2;
        PI * 2.0 / 2.0 * (1.0 - (x2 + h2 - r2) / (sum * sum - 4.0 * r2 * x2).sqrt())
    });
}

/// A sphere of radius r in full view: E = π L r² cos θ / d².
#[test]
fn a_ball() {
    let light = shape("sphere", r#"<scale value="0.3"/><translate value="0, 1, 0"/>"#, &emitter("area", &rgb("radiance", "2, 2, 2")));
    holds("ball", &light, 256, |x| PI * 2.0 * 0.09 / (1.0 + x * x).powf(1.5));
}

/// E = I cos θ / d².
#[test]
fn a_point() {
    let light = emitter("point", &(rgb("intensity", "3, 3, 3") + r#"<point name="position" value="0, 1, 0"/>"#));
    holds("point", &light, 256, |x| 3.0 / (1.0 + x * x).powf(1.5));
}

/// Linear in the angle between beam_width and cutoff_angle, as Mitsuba has it.
#[test]
fn a_spot() {
    let aim = r#"<transform name="to_world"><lookat origin="0, 1, 0" target="0, 0, 0" up="0, 0, 1"/></transform>"#;
    let content = rgb("intensity", "3, 3, 3") + &float("cutoff_angle", 60.0) + &float("beam_width", 20.0) + aim;
    holds("spot", &emitter("spot", &content), 512, |x| {
        let falloff = ((60.0 - x.atan().to_degrees()) / 40.0).clamp(0.0, 1.0);
        3.0 * falloff / (1.0 + x * x).powf(1.5)
    });
}

/// E = irradiance · cos θ.
#[test]
fn the_sun() {
    let light = emitter("directional", &(rgb("irradiance", "3, 3, 3") + r#"<vector name="direction" value="3, -4, 0"/>"#));
    holds("sun", &light, 256, |_| 3.0 * 0.8);
}

/// E = π L.
#[test]
fn the_sky() {
    holds("sky", &emitter("constant", &rgb("radiance", "2, 2, 2")), 256, |_| 2.0 * PI);
}
