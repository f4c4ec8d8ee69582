//! What lights send where.

use std::{boxed::Box, string::String, vec, vec::Vec};

use bidir_sdk::{
    Emitted, EndDensity, Light, Point, Profile, Real, Spectrum, Vec2, Vec3,
    math::dot,
    real::{ONE_MINUS_EPSILON, PI},
};

use super::{
    chi_square::{Histogram, masses},
    close, direction, numbers,
};
use crate::*;

const WARM: Spectrum = Spectrum([3.0, 2.0, 1.0]);

/// An image and its filled tables.
struct Image {
    width: usize,
    height: usize,
    texels: Vec<Spectrum>,
    rows: Vec<Real>,
    columns: Vec<Real>,
}

impl Image {
    fn new(width: usize, height: usize, texel: impl Fn(usize) -> Spectrum) -> Self {
        let texels: Vec<Spectrum> = (0..width * height).map(texel).collect();
        let sizes = Envmap::sizes(width, height);
        let (mut rows, mut columns) = (vec![0.0; sizes.rows], vec![0.0; sizes.columns]);
        assert!(Envmap::fill(width, height, &texels, &mut rows, &mut columns));
        Self { width, height, texels, rows, columns }
    }

    fn envmap(&self) -> Envmap<'_> {
        Envmap::new(self.width, self.height, &self.texels, &self.rows, &self.columns).expect("the tables fit")
    }
}

fn images() -> Vec<(&'static str, Image)> {
    let random = |i: usize| Spectrum(numbers(13, i as u64));
    vec![
        ("random", Image::new(8, 4, random)),
        ("random, large", Image::new(64, 33, random)),
        ("one texel of 1e6", Image::new(32, 16, |i| if i == 200 { Spectrum::splat(1e6) } else { Spectrum::splat(1e-3) })),
        ("one texel of 1e6 on black, at the pole", Image::new(16, 8, |i| if i == 3 { Spectrum::splat(1e6) } else { Spectrum::BLACK })),
        ("one texel", Image::new(1, 1, |_| WARM)),
        ("one row", Image::new(5, 1, random)),
        ("one column", Image::new(1, 5, random)),
    ]
}

fn plain() -> Vec<(String, Box<dyn Profile>)> {
    let mut out: Vec<(String, Box<dyn Profile>)> = vec![
        ("area".into(), Box::new(Area { radiance: WARM })),
        ("isotropic".into(), Box::new(Isotropic { intensity: WARM })),
        ("constant".into(), Box::new(Constant { radiance: WARM })),
    ];
    // Cones that end where the bins of the χ² test do.
    let cone = bidir_sdk::math::acos;
    let half_turn = super::HALF_TURN;
    for (cutoff, beam_width) in
        [(cone(0.875), 0.3), (cone(0.875), 1.0), (cone(0.5), 0.0), (cone(-0.75), 1.0), (half_turn, 1.0), (half_turn, half_turn)]
    {
        out.push((std::format!("spot {cutoff} {beam_width}"), Box::new(Spot { intensity: WARM, cutoff, beam_width })));
    }
    out
}

fn for_every_profile(check: impl Fn(&str, &dyn Profile)) {
    plain().iter().for_each(|(name, profile)| check(name, &**profile));
    images().iter().for_each(|(name, image)| check(name, &image.envmap()));
}

#[test]
fn emission_follows_the_pdf() {
    // 16 tests at 1 % in all: 3.3 standard deviations.
    let (samples, threshold) = (100_000, 4.0);
    for_every_profile(|name, profile| {
        let mut histogram = Histogram::new();
        for index in 0..samples {
            let u = numbers(17, index);
            histogram.add(profile.emit(Vec2::ZERO, [u[0], u[1]]).map(|e| e.direction));
        }
        let masses = masses(&|w| profile.eval(Vec2::ZERO, w).pdf.0);
        let (mass, deviation) = (masses.iter().sum::<f64>(), histogram.deviation(&masses));
        assert!((mass - 1.0).abs() < 2e-3, "{name}: the pdf integrates to {mass}");
        assert!(deviation < threshold, "{name}: {deviation} of {threshold} with {samples} samples");
    });
}

fn agree(name: &str, emitted: Emitted, profile: &dyn Profile) {
    let eval = profile.eval(Vec2::ZERO, emitted.direction);
    let sampled = emitted.profiled;
    let tolerance = 2e-3 * sampled.radiance.max() + 1e-4;
    assert!((0..3).all(|band| (eval.radiance[band] - sampled.radiance[band]).abs() < tolerance), "{name}: {emitted:?} against {eval:?}");
    assert!(close(eval.pdf.0, sampled.pdf.0, 2e-2), "{name}: {emitted:?} against {eval:?}");
}

#[test]
fn samples_agree_with_what_is_asked_afterwards() {
    for_every_profile(|name, profile| {
        for index in 0..2_000 {
            let u = numbers(19, index);
            let emitted = profile.emit(Vec2::ZERO, [u[0], u[1]]).expect("these lights shine");
            assert!((dot(emitted.direction, emitted.direction) - 1.0).abs() < 1e-5);
            // A density goes to 0 at the edges of a dark cell, where one rounding changes all of it.
            if u[0].min(u[1]).min(1.0 - u[0]).min(1.0 - u[1]) > 1e-2 {
                agree(name, emitted, profile);
            }
        }
    });
}

#[test]
fn nothing_shines_that_is_never_sampled_and_all_is_finite() {
    let ends = [0.0, 0.25, 0.5, ONE_MINUS_EPSILON];
    for_every_profile(|name, profile| {
        for index in 0..20_000 {
            let u = numbers(23, index);
            let w = direction(2.0 * u[0] - 1.0, 6.3 * u[1]);
            let eval = profile.eval(Vec2::ZERO, w);
            assert!(eval.radiance.is_black() || eval.pdf.0 > 0.0, "{name}, {w}: {eval:?}");
        }
        for u in ends.iter().flat_map(|&x| ends.iter().map(move |&y| [x, y])) {
            if let Some(emitted) = profile.emit(Vec2::ZERO, u) {
                let Emitted { direction, profiled } = emitted;
                assert!(direction.is_finite() && profiled.radiance.is_finite() && profiled.pdf.0 > 0.0, "{name}, {u:?}: {emitted:?}");
                assert!((profiled.radiance / profiled.pdf.0).is_finite(), "{name}, {u:?}: {emitted:?}");
            }
        }
        for w in [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z] {
            let eval = profile.eval(Vec2::ZERO, w);
            assert!(eval.radiance.is_finite() && eval.pdf.0.is_finite(), "{name}, {w}: {eval:?}");
        }
    });
}

#[test]
fn black_images_and_closed_cones_send_nothing() {
    let image = Image::new(4, 4, |_| Spectrum::BLACK);
    assert!(image.envmap().emit(Vec2::ZERO, [0.5, 0.5]).is_none());
    assert_eq!(image.envmap().eval(Vec2::ZERO, Vec3::X).pdf.0, 0.0);
    let spot = Spot { intensity: WARM, cutoff: 0.0, beam_width: 0.0 };
    assert!(spot.emit(Vec2::ZERO, [0.5, 0.5]).is_none() && spot.eval(Vec2::ZERO, Vec3::Z).radiance.is_black());
}

#[test]
fn narrow_cones_keep_their_power() {
    for cutoff in [1e-1, 1e-2, 1e-3, 1e-4] {
        let spot = Spot { intensity: WARM, cutoff, beam_width: 0.5 * cutoff };
        // 2π ∫ falloff θ dθ with sin θ ≈ θ: half the cone in full, then linearly less: 2π cutoff² (1/8 + 1/6).
        let expected = 2.0 * f64::from(super::HALF_TURN * cutoff * cutoff) * (0.125 + 1.0 / 6.0) * 2.0;
        let one = |index| {
            let u = numbers(29, index);
            spot.emit(Vec2::ZERO, [u[0], u[1]]).map_or(0.0, |e| f64::from(e.profiled.radiance.mean() / e.profiled.pdf.0))
        };
        let power = (0..40_000).map(one).sum::<f64>() / 40_000.0;
        assert!((power / expected - 1.0).abs() < 1e-2, "cutoff {cutoff}: {power} against {expected}");
    }
}

#[test]
fn parallel_light_fills_the_disk_with_its_irradiance() {
    let direction = direction(-0.6, 0.3);
    let sun = Directional { direction, irradiance: WARM, center: Vec3::new(1.0, 2.0, 3.0), radius: 2.0 };
    for index in 0..1_000 {
        let u = numbers(31, index);
        let emission = sun.emit([u[0], u[1], 0.0, 0.0]).expect("the sun shines");
        let offset = emission.point.position - sun.center;
        assert!((offset.length_squared() - dot(offset, direction).powi(2)).sqrt() <= 2.0 + 1e-5);
        assert!((dot(offset, direction) + 2.0).abs() < 1e-5);
        let density = emission.exit.end.value() * emission.exit.spread.value();
        assert!(close(emission.weight.mean() * density, WARM.mean(), 1e-6));
    }
    let lit = Point::free(Vec3::ZERO);
    let seen = sun.illuminate(&lit, [0.5, 0.5]).expect("nothing hides it");
    assert_eq!((seen.direction, seen.weight), (-direction, WARM));
    assert!(matches!(sun.next_event_density(&seen.point, &lit), EndDensity::Chance(_)));
}

#[test]
fn a_spot_without_a_beam_width_falls_off_from_three_quarters_of_its_angle_on() {
    let absent = Spot::from_degrees(WARM, 180.0, -1.0);
    assert_eq!((absent.cutoff, absent.beam_width), (PI, 0.75 * PI));
    assert_eq!(Spot::from_degrees(WARM, 180.0, 0.0).beam_width, 0.0);
}
