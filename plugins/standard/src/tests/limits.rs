//! Corners, grazing, and the smooth limits.

use std::vec::Vec;

use bidir_sdk::{Bsdf, Carried, Lobe, Made, Real, Scattered, Vec3, math::dot, real::ONE_MINUS_EPSILON};

use super::{
    direction, numbers,
    surfaces::{all, gold, microfacets, rough_glass, rough_mirror},
};
use crate::{Dielectric, Distribution, Microfacet, RoughDielectric};

fn finite(sample: &Scattered) -> bool {
    let made = match sample.made {
        Made::Smooth { pdf, pdf_rev } => pdf.0.is_finite() && pdf.0 > 0.0 && pdf_rev.0.is_finite(),
        Made::Delta { chance, chance_rev } => chance.0 > 0.0 && chance.0 <= 1.0 && chance_rev.0 > 0.0 && chance_rev.0 <= 1.0,
    };
    made && sample.weight.is_finite() && sample.wi.is_finite() && sample.eta.is_finite()
}

fn corners() -> Vec<[Real; 3]> {
    let ends = [0.0, 0.5, ONE_MINUS_EPSILON];
    let pairs = ends.iter().flat_map(|&x| ends.iter().map(move |&y| (x, y)));
    pairs.flat_map(|(x, y)| ends.iter().map(move |&z| [x, y, z])).collect()
}

fn edges() -> Vec<Vec3> {
    let cosines = [1.0, 0.5, 1e-3, 1e-7, 1e-12, 0.0, -0.0, -1e-12, -1e-7, -1e-3, -0.5, -1.0];
    cosines.iter().flat_map(|&cos| [direction(cos, 0.3), direction(cos, 0.3 + crate::tests::HALF_TURN)]).collect()
}

#[test]
fn everything_is_finite_at_corners_and_grazing() {
    let mut surfaces: Vec<(std::string::String, std::boxed::Box<dyn Bsdf>)> = all().into_iter().map(|s| (s.name, s.bsdf)).collect();
    for m in microfacets(&[(1e-4, 1e-4), (6e-5, 0.5), (0.0, 0.3), (1e-4, 1.0)]) {
        surfaces.push((std::format!("rough conductor {m:?}"), std::boxed::Box::new(gold(m))));
        surfaces.push((std::format!("rough dielectric {m:?}"), std::boxed::Box::new(rough_glass(1.5, m))));
    }
    for (name, bsdf) in surfaces {
        for wo in edges() {
            for carried in [Carried::Radiance, Carried::Importance] {
                for u in corners() {
                    if let Some(sample) = bsdf.sample(wo, u, carried) {
                        assert!(finite(&sample), "{name}, wo {wo}, u {u:?}: {sample:?}");
                        assert!(sample.lobe == Lobe::DELTA_TRANSMISSION || sample.wi.z != 0.0, "{name}, wo {wo}, u {u:?}: {sample:?}");
                    }
                }
                for wi in edges().into_iter().chain([wo, -wo]) {
                    let scatter = bsdf.eval(wo, wi, carried);
                    assert!(
                        scatter.value.is_finite() && scatter.pdf.0.is_finite() && scatter.pdf_rev.0.is_finite(),
                        "{name}, {wo} {wi}: {scatter:?}"
                    );
                    assert!(scatter.value.is_black() || scatter.pdf.0 > 0.0, "{name}, {wo} {wi}: {scatter:?}");
                }
            }
        }
    }
}

/// Mean distance of sampled directions, and of their throughput, from those of the mirror.
fn distance_to_mirror(m: Microfacet, wo: Vec3) -> Real {
    let mirrored = Vec3::new(-wo.x, -wo.y, wo.z);
    let samples = 2_000;
    let sum: Real = (0..samples)
        .map(|i| match rough_mirror(m).sample(wo, numbers(7, i), Carried::Radiance) {
            Some(s) => (s.wi - mirrored).length() + (1.0 - s.weight.mean()).abs(),
            None => 2.0,
        })
        .sum();
    sum / samples as Real
}

#[test]
fn roughness_goes_to_the_mirror_monotonically() {
    for distribution in [Distribution::Ggx, Distribution::Beckmann] {
        for wo in [direction(0.9, 0.2), direction(0.2, 1.0)] {
            let alphas = [0.3, 0.1, 0.03, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 0.0];
            let distances: Vec<Real> =
                alphas.iter().map(|&a| distance_to_mirror(Microfacet { distribution, alpha_u: a, alpha_v: a }, wo)).collect();
            assert!(distances.windows(2).all(|pair| pair[1] <= pair[0]), "{distribution:?}, wo {wo}: {distances:?}");
            assert_eq!(distances[alphas.len() - 1], 0.0);
            assert_eq!(distances[alphas.len() - 2], 0.0);
        }
    }
}

#[test]
fn the_density_of_narrow_lobes_integrates_to_one() {
    // Over microfacet slopes (α r cos φ, α r sin φ), r = tan θ/α: dω_i = 4 ω_o·m dω_m, dω_m = cos³ α² r dr dφ.
    let alpha = 1e-4;
    for distribution in [Distribution::Ggx, Distribution::Beckmann] {
        let metal = rough_mirror(Microfacet { distribution, alpha_u: alpha, alpha_v: alpha });
        for wo in [direction(1.0, 0.0), direction(0.5, 0.3), direction(0.05, 2.0)] {
            let (steps, turns) = (2_000, 32);
            let mut sum = 0.0;
            for i in 0..steps {
                // r = x/(1 − x) reaches all slopes.
                let x = (i as f64 + 0.5) / steps as f64;
                let (r, dr) = (x / (1.0 - x), 1.0 / ((1.0 - x) * (1.0 - x)) / steps as f64);
                for j in 0..turns {
                    let phi = crate::tests::HALF_TURN * 2.0 * (j as Real + 0.5) / turns as Real;
                    let tan = alpha * r as Real;
                    let m = Vec3::new(tan * phi.cos(), tan * phi.sin(), 1.0).normalize();
                    let wi = m * (2.0 * dot(wo, m)) - wo;
                    let solid = 4.0 * f64::from(dot(wo, m).max(0.0) * m.z * m.z * m.z) * f64::from(alpha * alpha) * r * dr;
                    sum += f64::from(metal.eval(wo, wi, Carried::Radiance).pdf.0) * solid * core::f64::consts::TAU / f64::from(turns);
                }
            }
            // A half vector rounded by 6e-8 moves the density by about 0.1 %.
            assert!((sum - 1.0).abs() < 5e-3, "{distribution:?}, wo {wo}: {sum}");
        }
    }
}

#[test]
fn the_density_of_weak_refraction_integrates_to_its_share() {
    // In rings about −ω_o, crowded towards it: θ = π x³.
    let glass = rough_glass(1.05, Microfacet { distribution: Distribution::Ggx, alpha_u: 1.0, alpha_v: 1.0 });
    let wo = direction(0.1, 0.0);
    let (about, steps) = (bidir_sdk::Frame::from_z(-wo), 800);
    let mut mass = 0.0;
    for i in 0..steps {
        let x = (f64::from(i) + 0.5) / f64::from(steps);
        let (theta, width) = (core::f64::consts::PI * x.powi(3), 3.0 * core::f64::consts::PI * x * x / f64::from(steps));
        for j in 0..steps {
            let (sin_phi, cos_phi) = (core::f64::consts::TAU * (f64::from(j) + 0.5) / f64::from(steps)).sin_cos();
            let wi = Vec3::new((theta.sin() * cos_phi) as Real, (theta.sin() * sin_phi) as Real, theta.cos() as Real);
            mass += f64::from(glass.eval(wo, about.to_world(wi), Carried::Radiance).pdf.0) * theta.sin() * width;
        }
    }
    mass *= core::f64::consts::TAU / f64::from(steps);
    let samples = 200_000;
    let share = (0..samples).filter(|&i| glass.sample(wo, numbers(37, i), Carried::Radiance).is_some()).count() as f64 / samples as f64;
    // Four standard deviations of a share of 0.9958 are 6e-4.
    assert!((mass - share).abs() < 1.2e-3, "{mass} against {share}");
}

#[test]
fn equal_indices_pass_straight_through() {
    for m in microfacets(&[(0.0, 0.0), (0.5, 0.5)]) {
        for wo in edges().into_iter().filter(|wo| wo.z != 0.0) {
            for u in corners() {
                let sample = rough_glass(1.0, m).sample(wo, u, Carried::Radiance).expect("glass of index 1 absorbs nothing");
                assert_eq!((sample.wi, sample.weight, sample.eta), (-wo, bidir_sdk::Spectrum::ONE, 1.0));
            }
        }
    }
}

/// Mean |ω_i + ω_o| + |1 − weight| over samples: what glass does to light beyond letting it pass.
fn disturbance(glass: RoughDielectric, wo: Vec3) -> Real {
    let samples = 4_000;
    let one = |i| {
        let sample = glass.sample(wo, numbers(9, i), Carried::Importance);
        sample.map_or(2.0, |s| (s.wi + wo).length() + (1.0 - s.weight.mean()).abs())
    };
    (0..samples).map(one).sum::<Real>() / samples as Real
}

#[test]
fn glass_is_continuous_where_the_indices_are_equal() {
    for m in microfacets(&[(0.3, 0.3), (0.05, 0.05), (0.0, 0.0)]) {
        for wo in [direction(0.7, 0.1), direction(-0.7, 0.1)] {
            for side in [-1.0, 1.0] {
                let steps = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 0.0];
                let found: Vec<Real> = steps.iter().map(|step| disturbance(rough_glass(1.0 + side * step, m), wo)).collect();
                assert!(found.windows(2).all(|pair| pair[1] <= pair[0] * 1.05 + 1e-6), "{m:?}, wo {wo}: {found:?}");
                assert!(found[3] < 1e-3 && found[6] == 0.0, "{m:?}, wo {wo}: {found:?}");
            }
        }
    }
}

#[test]
fn rough_glass_agrees_with_smooth_glass_at_little_roughness() {
    let smooth = Dielectric { eta: 1.5, specular_reflectance: bidir_sdk::Spectrum::ONE, specular_transmittance: bidir_sdk::Spectrum::ONE };
    for m in microfacets(&[(1e-4, 1e-4)]) {
        for wo in [direction(0.8, 0.4), direction(-0.9, 0.4)] {
            for index in 0..1_000 {
                let u = numbers(11, index);
                let (a, b) = (rough_glass(1.5, m).sample(wo, u, Carried::Radiance), smooth.sample(wo, u, Carried::Radiance));
                let (Some(a), Some(b)) = (a, b) else { panic!("{m:?}, wo {wo}: {a:?} {b:?}") };
                if a.eta == b.eta {
                    // GGX has long tails: one sample in a thousand is 30 α away.
                    assert!((a.wi - b.wi).length() < 2e-2 && (a.weight.mean() - b.weight.mean()).abs() < 2e-2, "{m:?}: {a:?} {b:?}");
                }
            }
        }
    }
}
