//! Things in an environment of radiance 1 that lose nothing cannot be seen.

use bidir_kernel::Heuristic;

use super::{ESTIMATORS, Estimator, WITHIN};
use crate::{
    pictures::{BDPT, PATH},
    scenes::*,
    statistics::assert_is,
};

fn sky() -> String {
    emitter("constant", &rgb("radiance", "1, 1, 1"))
}

/// A ball that fills most of the picture.
fn ball_of(material: &str) -> String {
    let camera = camera("perspective", &film(4)).replace("0, 1.2, 4", "0, 0.65, 3").replace("0, 0.8, 0", "0, 0.65, 0");
    [depth(-1), camera.replace(r#"value="45""#, r#"value="25""#), ball(material), sky()].concat()
}

/// Mitsuba 0.6, issue 80.
#[test]
fn nothing_but_the_sky_is_the_sky() {
    for camera_kind in ["perspective", "thinlens"] {
        let lens = if camera_kind == "thinlens" { float("aperture_radius", 0.5) } else { String::new() };
        let subject = read(&[depth(-1), camera(camera_kind, &(lens + &film(2))), sky()].concat());
        for Estimator { name: estimator, techniques, heuristic, effort, within } in ESTIMATORS {
            let found = subject.pictures(subject.strategy(techniques, heuristic), 1024 * effort, 1);
            let mean = found.mean(found.whole(), &[0, 1, 2]);
            assert_is(&format!("{camera_kind}, {estimator}"), &mean, 1.0, 2 * ESTIMATORS.len(), within);
        }
    }
}

#[test]
fn a_white_ball_is_the_sky() {
    let subject = read(&ball_of(&diffuse("1, 1, 1")));
    for Estimator { name: estimator, techniques, heuristic, effort, within } in ESTIMATORS {
        let found = subject.pictures(subject.strategy(techniques, heuristic), 1024 * effort, 1);
        assert_is(estimator, &found.mean(found.whole(), &[0, 1, 2]), 1.0, ESTIMATORS.len(), within);
    }
}

#[test]
fn whatever_loses_nothing_is_the_sky() {
    let metal = r#"<string name="material" value="none"/>"#;
    let materials = [
        ("mirror", bsdf("conductor", metal)),
        ("glass", bsdf("dielectric", &float("int_ior", 1.5))),
        ("bubble", bsdf("dielectric", &(float("int_ior", 1.0) + &float("ext_ior", 1.5)))),
        ("pane", bsdf("thindielectric", "")),
        ("nothing", bsdf("null", "")),
        // Single scattering loses the less the smoother a surface is.
        ("nearly smooth metal", bsdf("roughconductor", &(metal.to_owned() + &float("alpha", 0.005)))),
        ("nearly smooth glass", bsdf("roughdielectric", &float("alpha", 0.005))),
    ];
    for (name, material) in &materials {
        let subject = read(&ball_of(material));
        for (estimator, techniques) in [("path", PATH), ("bdpt", BDPT)] {
            let found = subject.pictures(subject.strategy(techniques, Heuristic::Balance), 256, 1);
            assert_is(&format!("{name}, {estimator}"), &found.mean(found.whole(), &[0, 1, 2]), 1.0, 2 * materials.len(), WITHIN);
        }
    }
}

/// No ray from near the middle of a ball is reflected totally, so everything comes from the sky, squeezed by η².
#[test]
fn inside_glass_the_sky_is_eta_squared() {
    let eta: f64 = 1.5;
    let camera = camera("perspective", &film(2)).replace("0, 1.2, 4", "0.1, 0.6, 0.1");
    let subject = read(&[depth(-1), camera, ball(&bsdf("dielectric", &(float("int_ior", eta) + &float("ext_ior", 1.0)))), sky()].concat());
    for (estimator, techniques) in [("path", PATH), ("bdpt", BDPT)] {
        let found = subject.pictures(subject.strategy(techniques, Heuristic::Balance), 1024, 1);
        assert_is(estimator, &found.mean(found.whole(), &[0, 1, 2]), eta * eta, 2, WITHIN);
    }
}

/// Lost light is never found again: no rough or coated ball outshines the sky.
#[test]
fn nothing_outshines_the_sky() {
    let metal = r#"<string name="material" value="none"/>"#;
    let materials = [
        ("rough metal", bsdf("roughconductor", &(metal.to_owned() + &float("alpha", 0.5)))),
        ("brushed metal", bsdf("roughconductor", &(metal.to_owned() + &float("alpha_u", 0.1) + &float("alpha_v", 0.6)))),
        ("rough glass", bsdf("roughdielectric", &float("alpha", 0.5))),
        ("plastic", bsdf("plastic", &rgb("diffuse_reflectance", "1, 1, 1"))),
    ];
    for (name, material) in &materials {
        let subject = read(&ball_of(material));
        let found = subject.pictures(subject.strategy(PATH, Heuristic::Balance), 512, 1);
        let mean = found.mean(found.whole(), &[0, 1, 2]);
        println!("{name}: {:.4} ± {:.4}", mean.mean, mean.error);
        assert!(mean.mean - 4.0 * mean.error < 1.0 && mean.mean > 0.7, "{name}: {mean:?}");
    }
}
