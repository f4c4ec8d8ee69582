//! Answers that cannot be (rows 58 and 66): left out, counted, named; one is a fault where none may be.

use bidir::plugin::{Cause, Quarantine, Strictness};
use bidir_kernel::{Bsdf, Carried, Profile, Vec2, Vec3};

use super::{load, sandbox};

const ECHO: &str = include_str!("modules/echo.wat");
const ECHO_LIGHT: &str = include_str!("modules/echo_light.wat");

const WO: Vec3 = Vec3::new(0.6, 0.0, 0.8);

fn bytes(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

fn bits(lobe: u32) -> f32 {
    f32::from_bits(lobe)
}

const EVAL: [f32; 5] = [0.2, 0.2, 0.2, 0.3, 0.3];

/// ω_i, weight, pdf, pdf_rev, lobe, η.
fn sample() -> [f32; 10] {
    [0.6, 0.0, 0.8, 0.5, 0.5, 0.5, 0.3, 0.3, bits(1), 1.0]
}

/// A good answer with one number changed.
fn with<const N: usize>(mut answer: [f32; N], at: usize, number: f32) -> [f32; N] {
    answer[at] = number;
    answer
}

/// What became of the answers to one question to each of the two exports.
fn asked(eval: [f32; 5], sample: [f32; 10]) -> Quarantine {
    let echo = load(ECHO).expect("a good module");
    let (sandbox, shader) = sandbox(&echo, &[bytes(&eval), bytes(&sample)].concat(), Strictness::Lenient);
    let scatter = sandbox.bsdf(shader).eval(WO, Vec3::Z, Carried::Radiance);
    let scattered = sandbox.bsdf(shader).sample(WO, [0.5; 3], Carried::Radiance);
    let quarantine = sandbox.quarantine();
    assert_eq!(sandbox.fault(), None);
    let held = |export| quarantine.0.iter().any(|entry| entry.asked.export() == export);
    assert_eq!(held("bsdf_eval"), scatter.value.is_black(), "a bad answer got through, or a good one did not");
    assert_eq!(held("bsdf_sample"), scattered.is_none(), "a bad answer got through, or a good one did not");
    quarantine
}

fn quarantines(quarantine: &Quarantine, words: &[&str]) {
    assert_eq!(quarantine.count(), 1, "{words:?}");
    let said = quarantine.0[0].to_string();
    for word in ["hostile.wasm", "1 bad answer was left out"].iter().chain(words) {
        assert!(said.contains(word), "\"{word}\" is not in: {said}");
    }
}

/// NaNs of both signs and with a payload: none gets in, so none can differ from processor to processor in an image.
fn no_numbers() -> [f32; 7] {
    [f32::NAN, f32::from_bits(0xffff_ffff), f32::from_bits(0x7f80_0001), f32::INFINITY, f32::NEG_INFINITY, -1.0, 1e38]
}

#[test]
fn good_answers_are_taken() {
    assert_eq!(asked(EVAL, sample()).count(), 0);
}

#[test]
fn nan_infinity_negative_and_huge_values_are_quarantined() {
    for number in no_numbers() {
        for at in 0..5 {
            quarantines(&asked(with(EVAL, at, number), sample()), &["bsdf_eval", "must lie within 0 … 1e30", "wo = [0.6, 0.0, 0.8]"]);
        }
        for at in [3, 4, 5, 6, 7, 9] {
            quarantines(&asked(EVAL, with(sample(), at, number)), &["bsdf_sample", "must lie within 0 … 1e30", "u = [0.5, 0.5, 0.5]"]);
        }
    }
}

#[test]
fn light_where_the_density_is_zero_is_quarantined() {
    quarantines(&asked(with(EVAL, 3, 0.0), sample()), &["bsdf_eval", "the value is above 0 where the density is 0"]);
    quarantines(&asked(EVAL, with(sample(), 6, 0.0)), &["bsdf_sample", "above 0 where the density is 0"]);
}

#[test]
fn a_direction_that_is_not_unit_is_quarantined() {
    for z in [0.0, 0.9, 2.0, f32::NAN, f32::INFINITY] {
        quarantines(&asked(EVAL, with(sample(), 2, z)), &["bsdf_sample", "the direction has the length"]);
    }
}

#[test]
fn a_reflection_below_the_surface_is_quarantined() {
    quarantines(&asked(EVAL, with(sample(), 2, -0.8)), &["bsdf_sample", "the direction lies on the other side of the surface"]);
}

#[test]
fn a_lobe_that_is_undeclared_or_none_is_quarantined() {
    quarantines(&asked(EVAL, with(sample(), 8, bits(2))), &["bsdf_sample", "glossy_reflection, which the manifest does not name"]);
    for lobe in [5, 64, 1 << 31, u32::MAX] {
        quarantines(&asked(EVAL, with(sample(), 8, bits(lobe))), &["bsdf_sample", "and must be one of 1, 2, 4, 8, 16, 32"]);
    }
}

#[test]
fn a_chance_above_one_is_quarantined() {
    quarantines(&asked(EVAL, with(with(sample(), 8, bits(4)), 6, 1.5)), &["bsdf_sample", "the chance of a delta lobe is 1.5"]);
}

#[test]
fn bad_answers_of_lights_are_quarantined() {
    let echo = load(ECHO_LIGHT).expect("a good module");
    let (eval, emit) = ([1.0, 1.0, 1.0, 0.3], [0.6, 0.0, 0.8, 1.0, 1.0, 1.0, 0.3]);
    let asked = |eval: [f32; 4], emit: [f32; 7]| {
        let (sandbox, shader) = sandbox(&echo, &[bytes(&eval), bytes(&emit)].concat(), Strictness::Lenient);
        let profiled = sandbox.profile(shader).eval(Vec2::new(0.5, 0.5), Vec3::Z);
        let emitted = sandbox.profile(shader).emit(Vec2::new(0.5, 0.5), [0.5; 2]);
        (sandbox.quarantine(), profiled.radiance.is_black(), emitted.is_none())
    };
    assert_eq!(asked(eval, emit), (Quarantine::default(), false, false));
    for number in no_numbers() {
        for at in 0..4 {
            let (quarantine, black, _) = asked(with(eval, at, number), emit);
            assert!(black);
            quarantines(&quarantine, &["light_eval", "must lie within 0 … 1e30"]);
        }
        for at in 3..7 {
            let (quarantine, _, none) = asked(eval, with(emit, at, number));
            assert!(none);
            quarantines(&quarantine, &["light_emit", "must lie within 0 … 1e30"]);
        }
    }
    quarantines(&asked(with(eval, 3, 0.0), emit).0, &["light_eval", "the radiance is above 0 where the density is 0"]);
    quarantines(&asked(eval, with(emit, 2, 0.9)).0, &["light_emit", "the direction has the length"]);
}

#[test]
fn a_bad_answer_is_a_fault_where_none_may_be() {
    let echo = load(ECHO).expect("a good module");
    let (sandbox, shader) = sandbox(&echo, &bytes(&with(EVAL, 0, f32::NAN)), Strictness::Strict);
    assert!(sandbox.bsdf(shader).eval(WO, Vec3::Z, Carried::Radiance).value.is_black());
    let fault = sandbox.fault().expect("a fault");
    assert_eq!((fault.file.to_str(), fault.export), (Some("hostile.wasm"), "bsdf_eval"));
    assert!(matches!(&fault.cause, Cause::Refused(why) if why.contains("NaN")), "{fault}");
}
