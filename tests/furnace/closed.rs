//! Closed spaces, split by path length: a technique that is counted and not sampled darkens some lengths at once.

use super::{ESTIMATORS, Estimator};
use crate::{scenes::*, statistics::assert_is};

const INWARDS: &str = r#"<boolean name="flip_normals" value="true"/>"#;
const LONGEST: u32 = 5;

fn inside(camera: &str, content: &str) -> String {
    let lens = if camera == "thinlens" { float("aperture_radius", 0.3) + &float("focus_distance", 1.0) } else { String::new() };
    let transform = r#"<transform name="to_world"><lookat origin="0.4, 0.1, 0.2" target="1, 0.2, 0.3" up="0, 1, 0"/></transform>"#;
    format!(r#"{}<sensor type="{camera}">{}{lens}{}{transform}</sensor>{content}"#, depth(LONGEST as i32), float("fov", 100.0), film(2))
}

/// Radiance L from every wall of albedo ρ: paths of length k bring L ρ^(k−1).
fn furnace(name: &str, camera: &str, samples: u32) {
    let albedo: f64 = 0.5;
    let walls = format!("{INWARDS}{}{}", diffuse("0.5, 0.5, 0.5"), emitter("area", &rgb("radiance", "2, 2, 2")));
    let subject = read(&inside(camera, &shape(name, "", &walls)));
    for Estimator { name: estimator, techniques, heuristic, effort, within } in ESTIMATORS {
        let found = subject.pyramids(subject.strategy(techniques, heuristic), samples * effort, 1, LONGEST);
        for length in 1..=LONGEST {
            let wanted = 2.0 * albedo.powi(length as i32 - 1);
            let what = format!("{name}, {camera}, {estimator}, length {length}");
            assert_is(&what, &found.length(length), wanted, LONGEST as usize * ESTIMATORS.len(), within);
        }
    }
}

#[test]
fn a_shining_ball_brings_l_rho_to_the_k_minus_1() {
    furnace("sphere", "perspective", 1024);
}

#[test]
fn a_shining_ball_before_a_lens_does_too() {
    furnace("sphere", "thinlens", 1024);
}

#[test]
fn a_shining_box_does_too() {
    furnace("cube", "perspective", 1024);
}

/// A black bulb of radius r in the middle of a ball of radius 1 and albedo ρ: the wall gets π L r² directly, everywhere alike, and each
/// reflection brings ρ (1 − r²) of the one before, since r² of what leaves the wall ends on the bulb (reciprocity of form factors).
#[test]
fn an_integrating_sphere_adds_up_rho_by_1_minus_rho() {
    let (albedo, r, radiance) = (0.8, 0.2, 5.0);
    let wall = shape("sphere", "", &(INWARDS.to_owned() + &diffuse("0.8, 0.8, 0.8")));
    let light = diffuse("0, 0, 0") + &emitter("area", &rgb("radiance", "5, 5, 5"));
    let bulb = shape("sphere", r#"<scale value="0.2"/>"#, &light);
    let scene = inside("perspective", &(wall + &bulb));
    let by_length = read(&scene);
    let first: f64 = radiance * r * r * albedo;
    let again = albedo * (1.0 - r * r);
    for Estimator { name: estimator, techniques, heuristic, effort, within } in ESTIMATORS {
        let found = by_length.pyramids(by_length.strategy(techniques, heuristic), 768 * effort, 1, LONGEST);
        for length in 2..=LONGEST {
            let wanted = first * again.powi(length as i32 - 2);
            assert_is(&format!("bulb, {estimator}, length {length}"), &found.length(length), wanted, 5 * ESTIMATORS.len(), within);
        }
    }
    let endless = read(&scene.replace(&depth(LONGEST as i32), &depth(-1)));
    for Estimator { name: estimator, techniques, heuristic, effort, within } in ESTIMATORS {
        let found = endless.pictures(endless.strategy(techniques, heuristic), 2560 * effort, 2);
        let mean = found.mean(found.whole(), &[0, 1, 2]);
        assert_is(&format!("bulb, {estimator}, all lengths"), &mean, first / (1.0 - again), 5 * ESTIMATORS.len(), within);
    }
}
