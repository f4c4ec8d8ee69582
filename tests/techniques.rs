//! Every technique (s,t) alone makes the same picture, and exactly those exist that should.
//!
//! Inside a ball that shines everywhere, cos θ cos θ'/d² between any two of its points is 1/4R²: techniques that only differ in how they
//! choose points of the ball are nearly free of noise there, and means can be held to 0.3 %. Only what reaches the lens by chance (t = 0)
//! is noisier. A box keeps what the ball's symmetry could hide in view, at its own noise.

use bidir_kernel::{Heuristic, Technique, Techniques};

use crate::{
    pictures::{BDPT, Pyramids, Subject},
    scenes::*,
    statistics::threshold,
};

const LONGEST: u32 = 4;

/// A camera that sees much, and that walks find.
pub fn wide_lens(origin: &str) -> String {
    let content = float("fov", 90.0) + &float("aperture_radius", 0.8) + &float("focus_distance", 1.0) + &film(2);
    format!(
        r#"<sensor type="thinlens">{content}<transform name="to_world"><lookat origin="{origin}" target="0, 0, 0" up="0, 1, 0"/></transform></sensor>"#
    )
}

const INWARDS: &str = r#"<boolean name="flip_normals" value="true"/>"#;

/// A ball of radius 1, seen from within through a wide lens; its albedo is checkered.
fn ball_of_light() -> Subject {
    let checks = r#"<bsdf type="diffuse"><texture type="checkerboard" name="reflectance"><rgb name="color0" value="0.9"/><rgb name="color1" value="0.6"/><transform name="to_uv"><scale value="4, 2, 1"/></transform></texture></bsdf>"#;
    let ball = shape("sphere", "", &[INWARDS, checks, &area(1.0)].concat());
    read(&[depth(LONGEST as i32), wide_lens("0.1, 0, 0.4"), ball].concat())
}

/// A flat box with a panel of light, seen through most of one wall.
fn box_with_a_panel() -> Subject {
    let white = diffuse("0.8, 0.8, 0.8");
    let walls = shape("cube", r#"<scale value="1, 1, 0.4"/>"#, &(INWARDS.to_owned() + &white));
    let panel = r#"<scale value="0.8, 0.3, 1"/><rotate x="1" angle="30"/><translate value="0, 0.3, -0.2"/>"#;
    read(&[depth(LONGEST as i32), wide_lens("0, 0, 0.35"), walls, shape("rectangle", panel, &(white + &area(1.0)))].concat())
}

/// The techniques that make paths of `length` segments.
pub fn techniques_of(length: u32) -> impl Iterator<Item = Technique> {
    (0..=length + 1).map(move |s| Technique { s, t: length + 1 - s })
}

/// Holds each technique, unweighted, against the steadiest one of its length. `doubt` bounds what chance may hide, for t > 0 and t = 0.
fn alone_all_agree(name: &str, pyramids: &Pyramids, doubt: [f64; 2]) {
    let comparisons = (1..=LONGEST).map(|k| k as usize + 1).sum();
    for length in 1..=LONGEST {
        let alone: Vec<_> = techniques_of(length).map(|q| (q, pyramids.technique(q, 1))).collect();
        let (best, reference) = alone.iter().min_by(|(_, a), (_, b)| a.error.total_cmp(&b.error)).expect("techniques");
        for (technique, estimate) in alone.iter().filter(|(technique, _)| technique != best) {
            let apart = estimate.minus(reference);
            let (share, error) = (apart.mean / reference.mean, apart.error / reference.mean);
            let (deviation, limit) = (apart.deviation(reference.mean), threshold(comparisons, apart.degrees));
            let what = format!(
                "{name}, length {length}: {technique:?} − {best:?} {:+.3} % ± {:.3} %, {deviation:.2} σ of {limit:.2}",
                100.0 * share,
                100.0 * error
            );
            println!("{what}");
            let [others, lens_hit] = doubt;
            assert!(error < if technique.t == 0 { lens_hit } else { others }, "too little to compare with: {what}");
            assert!(deviation < limit && share.abs() < 3.0 * if technique.t == 0 { lens_hit } else { others }, "{what}");
        }
    }
}

#[test]
fn each_alone_makes_the_same_picture_in_a_ball_of_light() {
    let ball = ball_of_light();
    let pyramids = ball.pyramids(ball.strategy(BDPT, Heuristic::Balance), 3 << 14, 1, LONGEST);
    alone_all_agree("ball of light", &pyramids, [0.0015, 0.005]);
}

#[test]
fn each_alone_makes_the_same_picture_in_a_box() {
    let subject = box_with_a_panel();
    let pyramids = subject.pyramids(subject.strategy(BDPT, Heuristic::Balance), 1 << 12, 1, LONGEST);
    alone_all_agree("box", &pyramids, [0.02, 0.02]);
}

/// Joins as the bits of `set` say.
pub fn switched(set: u32) -> Techniques {
    let on = |bit: u32| f64::from(set >> bit & 1);
    Techniques { light_hit: on(0), next_event: on(1), connection: on(2), lens_splat: on(3), lens_hit: on(4) }
}

/// Each of the 31 sets of joins, with either heuristic: a length that any of its techniques makes has its whole light.
#[test]
fn every_set_of_joins_makes_the_same_picture_of_each_length() {
    let ball = ball_of_light();
    let render = |set, heuristic, samples| ball.pyramids(ball.strategy(switched(set), heuristic), samples, u64::from(set), LONGEST);
    let reference = render(0b00111, Heuristic::Balance, 2048);
    let cases: Vec<_> = (1..32).flat_map(|set| [Heuristic::Balance, Heuristic::Power].map(|heuristic| (set, heuristic))).collect();
    let comparisons = cases.len() * LONGEST as usize;
    let mut worst: (f64, String) = (0.0, String::new());
    for (set, heuristic) in cases {
        let found = render(set, heuristic, 256);
        for length in 1..=LONGEST {
            let estimate = found.length(length);
            if !techniques_of(length).any(|technique| switched(set).uses(technique.join())) {
                assert_eq!(estimate.mean, 0.0);
                continue;
            }
            let apart = estimate.minus(&reference.length(length));
            let (deviation, limit) = (apart.deviation(estimate.mean), threshold(comparisons, apart.degrees));
            let what = format!("{:?} {heuristic:?}, length {length}: {deviation:.2} σ of {limit:.2}", switched(set));
            assert!(deviation < limit, "{what}");
            if deviation / limit > worst.0 {
                worst = (deviation / limit, what);
            }
        }
    }
    println!("{comparisons} comparisons, worst {}", worst.1);
}

/// The ends of a path, and whether a path from the other side can land on them.
const CAMERAS: [(&str, bool); 3] = [("perspective", false), ("thinlens", true), ("orthographic", false)];
const LIGHTS: [(&str, bool); 4] = [("area", true), ("point", false), ("directional", false), ("constant", true)];

fn ended(camera_kind: &str, light: &str) -> Subject {
    let light = match light {
        "point" => emitter("point", r#"<point name="position" value="0.5, 1.6, 0.5"/>"#),
        "directional" => emitter("directional", r#"<vector name="direction" value="-1, -2, -0.7"/>"#),
        "constant" => emitter("constant", ""),
        _ => shape("sphere", r#"<scale value="0.5"/><translate value="0.5, 1.6, -0.5"/>"#, &area(1.0)),
    };
    let lens = if camera_kind == "thinlens" { float("aperture_radius", 1.0) + &float("focus_distance", 4.0) } else { String::new() };
    // Wide enough that the camera sees the sky past the room.
    let camera = camera(camera_kind, &(lens + &film(4))).replace(r#"value="45""#, r#"value="80""#).replace("1.3", "2.6");
    read(&[depth(3), camera, room(), light].concat())
}

/// In a matt scene a length k has k + 2 techniques, less those that would have to land on a point or a direction, less those switched off.
/// (1,1) shows the light itself to the lens, so it must be able to be seen; a direction is not seen by a camera that is itself one.
#[test]
fn exactly_the_techniques_exist_that_should() {
    for (camera, lens) in CAMERAS {
        for (light, shines_back) in LIGHTS {
            let subject = ended(camera, light);
            for set in 1..32 {
                let techniques = switched(set);
                // Rarest are light walks that land on the lens.
                let samples = if techniques.lens_hit > 0.0 && lens { 32 } else { 8 };
                let pyramids = subject.pyramids(subject.strategy(techniques, Heuristic::Balance), samples, u64::from(set), 3);
                for technique in (1..=3).flat_map(techniques_of) {
                    let Technique { s, t } = technique;
                    let exists = match (s, t) {
                        (0, _) => shines_back,
                        (_, 0) => lens && (s > 2 || shines_back),
                        (1, 1) => shines_back && !(camera == "orthographic" && light == "constant"),
                        _ => true,
                    };
                    let found = pyramids.technique(technique, 0).mean > 0.0;
                    assert_eq!(
                        found,
                        exists && techniques.uses(technique.join()),
                        "{camera}, {light} light, {techniques:?}: {technique:?}"
                    );
                }
            }
        }
    }
}
