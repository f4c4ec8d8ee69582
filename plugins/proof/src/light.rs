//! What binds a light's samples, densities and radiances together.

use bidir_sdk::{Emitted, Profile, Real, Spectrum, Vec2, Vec3, math::dot, real::PI};

use crate::{
    chi_square::{Histogram, masses},
    close, corners, direction, edges, numbers,
};

/// Directions fall where the pdf says, and it integrates to 1. Lobes far narrower than 0.05 slip through the bins
/// and the quadrature: test those otherwise.
pub fn emission_follows_the_pdf(name: &str, profile: &dyn Profile) {
    // A dozen tests per plugin at 0.1 % in all: 4 standard deviations.
    let (samples, threshold) = (100_000, 4.2);
    let mut histogram = Histogram::new();
    for index in 0..samples {
        let u = numbers(17, index);
        histogram.add(profile.emit(Vec2::ZERO, [u[0], u[1]]).map(|e| e.direction));
    }
    let masses = masses(&|w| profile.eval(Vec2::ZERO, w).pdf.0);
    let (mass, share, deviation) = (masses.iter().sum::<f64>(), histogram.share(), histogram.deviation(&masses));
    assert!((mass - 1.0).abs() < 3e-3, "{name}: the pdf integrates to {mass}");
    assert!(share > 0.999, "{name}: {share} of the samples have a direction");
    assert!(deviation < threshold, "{name}: {deviation} of {threshold} with {samples} samples");
}

/// `emit` says of its direction what `eval` says of it.
pub fn samples_agree_with_eval(name: &str, profile: &dyn Profile) {
    for index in 0..5_000 {
        let u = numbers(19, index);
        let Some(Emitted { direction, profiled }) = profile.emit(Vec2::ZERO, [u[0], u[1]]) else { continue };
        assert!((dot(direction, direction) - 1.0).abs() < 1e-5, "{name}, {u:?}: {direction}");
        let eval = profile.eval(Vec2::ZERO, direction);
        let agree = (0..3).all(|band| close(eval.radiance[band], profiled.radiance[band], 1e-3)) && close(eval.pdf.0, profiled.pdf.0, 1e-3);
        assert!(agree, "{name}, {u:?}: {profiled:?} against {eval:?}");
    }
}

fn sound(radiance: Spectrum, pdf: Real) -> bool {
    radiance.0.into_iter().chain([pdf]).all(|x| x.is_finite() && x >= 0.0)
}

/// Radiance is never negative, and above 0 only where the pdf is.
pub fn nothing_shines_that_is_never_sampled(name: &str, profile: &dyn Profile) {
    for index in 0..20_000 {
        let u = numbers(23, index);
        let w = direction(2.0 * u[0] - 1.0, 2.0 * PI * u[1]);
        let eval = profile.eval(Vec2::ZERO, w);
        assert!(sound(eval.radiance, eval.pdf.0) && (eval.radiance.is_black() || eval.pdf.0 > 0.0), "{name}, {w}: {eval:?}");
    }
}

/// No infinity and no NaN leaves along an axis, or with numbers from the edges.
pub fn all_is_finite_at_corners(name: &str, profile: &dyn Profile) {
    for u in corners() {
        let Some(emitted) = profile.emit(Vec2::ZERO, [u[0], u[1]]) else { continue };
        let Emitted { direction, profiled } = emitted;
        let finite = direction.is_finite() && sound(profiled.radiance, profiled.pdf.0) && profiled.pdf.0 > 0.0;
        assert!(finite && (profiled.radiance / profiled.pdf.0).is_finite(), "{name}, {u:?}: {emitted:?}");
    }
    let axes = [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z];
    for w in axes.into_iter().chain(edges()) {
        let eval = profile.eval(Vec2::ZERO, w);
        assert!(sound(eval.radiance, eval.pdf.0), "{name}, {w}: {eval:?}");
    }
}
