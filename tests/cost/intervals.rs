//! How sure a bias is said to be, and how often that is right.

use bidir::{
    cost::{interval::Interval, reference::Reference, subject::Subject},
    image::Image,
    plan::Stage,
    render::Target,
};
use bidir_kernel::Techniques;

use super::{never, of_text};

/// Renders of which each interval is.
const SEEDS: u64 = 4;
/// Intervals.
const RUNS: u64 = 100;

/// A matt floor under a sky of radiance 1, as wide as the picture: every pixel is 0.5.
const FLOOR: &str = r#"<scene version="3.0.0">
    <integrator type="path"><integer name="max_depth" value="2"/></integrator>
    <sensor type="perspective">
        <float name="fov" value="40"/>
        <transform name="to_world"><lookat origin="0, 0, 3" target="0, 0, 0" up="0, 1, 0"/></transform>
        <film type="hdrfilm"><integer name="width" value="16"/><integer name="height" value="16"/><rfilter type="box"/></film>
    </sensor>
    <shape type="rectangle"><transform name="to_world"><scale value="9"/></transform>
        <bsdf type="diffuse"><rgb name="reflectance" value="0.5"/></bsdf></shape>
    <emitter type="constant"><rgb name="radiance" value="1"/></emitter>
    </scene>"#;

/// A lamp over two balls, of which nobody knows the picture.
const BALLS: &str = r#"<scene version="3.0.0">
    <integrator type="path"><integer name="max_depth" value="4"/></integrator>
    <sensor type="perspective">
        <float name="fov" value="40"/>
        <transform name="to_world"><lookat origin="0, 1, 6" target="0, 0, 0" up="0, 1, 0"/></transform>
        <film type="hdrfilm"><integer name="width" value="24"/><integer name="height" value="24"/><rfilter type="box"/></film>
    </sensor>
    <shape type="rectangle"><transform name="to_world"><rotate x="1" angle="-90"/><scale value="9"/><translate y="-1"/></transform>
        <bsdf type="diffuse"/></shape>
    <shape type="sphere"><point name="center" value="-1, 0, 0"/><bsdf type="diffuse"/></shape>
    <shape type="sphere"><point name="center" value="1.2, 0, 0"/><bsdf type="roughconductor"><float name="alpha" value="0.3"/></bsdf></shape>
    <shape type="rectangle"><transform name="to_world"><rotate x="1" angle="90"/><translate y="4"/></transform>
        <emitter type="area"><rgb name="radiance" value="8"/></emitter></shape>
    </scene>"#;

fn picture(subject: &Subject, seed: u64, samples: u32) -> Image {
    subject.render(&Stage::of(&Techniques::PATH), seed, Target::Samples(samples), &never()).expect("a picture").0
}

fn brighter(image: &Image, factor: f32) -> Image {
    Image { pixels: image.pixels.iter().map(|pixel| pixel.map(|value| value * factor)).collect(), ..*image }
}

/// The interval of renders from that seed on, of pictures that much too bright.
fn interval(subject: &Subject, reference: &Reference, seed: u64, factor: f32, samples: u32) -> Interval {
    let bias = |seed| reference.errors(&brighter(&picture(subject, seed, samples), factor)).expect("one size").bias;
    let biases: Vec<f64> = (seed..seed + SEEDS).map(bias).collect();
    reference.interval(&biases, samples)
}

#[test]
fn of_a_known_picture_intervals_hold_no_bias_in_nine_of_ten_runs() {
    let subject = of_text("floor", FLOOR);
    let known = Image { width: 16, height: 16, pixels: vec![[0.5; 3]; 256] };
    let reference = Reference::rendered([known.clone(), known], 1, "known".to_owned());
    let right = (0..RUNS).filter(|run| !interval(&subject, &reference, 1000 + run * SEEDS, 1.0, 4).excludes(0.0)).count();
    println!("{right} of {RUNS} intervals hold 0");
    assert!(right >= 90, "{right}");
    let found = interval(&subject, &reference, 1, 1.01, 64);
    println!("planted 1 %: {found:?}");
    assert!(found.excludes(0.0) && !found.excludes(0.01), "{found:?}");
}

/// Each run has a reference of its own: one that all share would be off in the same way for all of them.
#[test]
fn against_two_halves_they_do_too() {
    let subject = of_text("balls", BALLS);
    let reference =
        |seed: u64, samples| Reference::rendered([seed, seed + 1].map(|seed| picture(&subject, seed, samples)), samples, String::new());
    let one = |run: u64| interval(&subject, &reference(1_000_000 + 2 * run, 32), 1000 + run * SEEDS, 1.0, 16);
    let right = (0..RUNS).filter(|&run| !one(run).excludes(0.0)).count();
    println!("{right} of {RUNS} intervals hold 0");
    assert!(right >= 90, "{right}");
    let found = interval(&subject, &reference(7_000_000, 2048), 1, 1.01, 1024);
    println!("planted 1 %: {found:?}");
    assert!(found.excludes(0.0) && !found.excludes(0.01), "{found:?}");
}
