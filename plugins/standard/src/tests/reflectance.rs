//! Energy: Fresnel's equations and albedos.

use bidir_sdk::{Bsdf, Carried, Real, Spectrum};

use super::{
    direction, directions, numbers,
    surfaces::{all, microfacets, rough_glass},
};
use crate::{Conductor, Dielectric, Diffuse, Plastic, ThinDielectric, fresnel, rough_plastic::Coat};

fn reflect(cos: Real, eta: Real) -> fresnel::Boundary {
    fresnel::dielectric(cos, fresnel::RelativeIndex::seen_from(eta, 1.0))
}

/// Fresnel's equations as a textbook has them, in f64.
fn textbook(cos: f64, eta: f64) -> f64 {
    let sin2 = (1.0 - cos * cos) / (eta * eta);
    if sin2 >= 1.0 {
        return 1.0;
    }
    let cos_t = (1.0 - sin2).sqrt();
    let s = (cos - eta * cos_t) / (cos + eta * cos_t);
    let p = (eta * cos - cos_t) / (eta * cos + cos_t);
    0.5 * (s * s + p * p)
}

#[test]
fn dielectrics_reflect_what_the_textbook_says() {
    for eta in [1.5, 1.0 / 1.5, 1.01, 0.99, 2.4, 1.0 / 2.4] {
        for step in 1..=1_000 {
            let cos = step as Real / 1_000.0;
            let (ours, exact) = (f64::from(reflect(cos, eta).reflectance), textbook(f64::from(cos), f64::from(eta)));
            // Near the critical angle the reflectance has a vertical tangent: compare within one rounding of the cosine.
            let step = 2.0 * f64::from(Real::EPSILON);
            let around = [textbook(f64::from(cos) - step, f64::from(eta)), textbook((f64::from(cos) + step).min(1.0), f64::from(eta))];
            let slack = 2e-6 + (around[0] - around[1]).abs();
            assert!((ours - exact).abs() < slack, "cos {cos}, eta {eta}: {ours} against {exact}");
        }
    }
}

#[test]
fn total_reflection_begins_continuously() {
    for eta in [1.0 / 1.5, 0.9, 0.999] {
        let critical = (1.0 - eta * eta as Real).sqrt();
        assert_eq!(reflect(critical * 0.999_9, eta).reflectance, 1.0);
        let mut last = 0.0;
        for step in [1e-2, 1e-3, 1e-4, 1e-5, 1e-6] {
            let reflectance = reflect(critical * (1.0 + step), eta).reflectance;
            assert!(reflectance > last && reflectance <= 1.0, "eta {eta}, step {step}: {reflectance}");
            last = reflectance;
        }
        assert!(last > 0.98, "eta {eta}: {last}");
    }
}

#[test]
fn weak_boundaries_reflect_by_the_square_of_their_strength() {
    // At normal incidence R = ((η − 1)/(η + 1))², and nothing at η = 1, however grazing.
    for e in [1e-2, 1e-4, 1e-6] {
        let eta = 1.0 + e as Real;
        let exact = ((eta - 1.0) / (eta + 1.0)).powi(2);
        assert!((reflect(1.0, eta).reflectance / exact - 1.0).abs() < 1e-4);
    }
    for cos in [1.0, 1e-3, 1e-7, 0.0] {
        assert_eq!(reflect(cos, 1.0), fresnel::Boundary { reflectance: 0.0, cos_refracted: cos });
    }
}

#[test]
fn the_diffuse_reflectance_is_the_mean_of_the_reflectance() {
    for eta in [1.000_1, 1.003, 1.009, 1.011, 1.05, 1.3, 1.5, 2.4, 1.0 / 1.000_1, 1.0 / 1.3, 1.0 / 1.5, 1.0 / 2.4] {
        let steps = 400_000;
        // c = x² crowds the steps where the reflectance is steep: ∫ 2 R c dc = ∫ 4 R x³ dx.
        let term = |i: u32| {
            let x = (f64::from(i) + 0.5) / f64::from(steps);
            4.0 * textbook(x * x, eta) * x.powi(3)
        };
        let exact = (0..steps).map(term).sum::<f64>() / f64::from(steps);
        let ours = f64::from(fresnel::diffuse(eta as Real));
        assert!((ours - exact).abs() < 4e-5, "eta {eta}: {ours} against {exact}");
    }
}

/// The mean weight, and its standard error.
fn albedo(bsdf: &dyn Bsdf, wo: bidir_sdk::Vec3, samples: u64) -> (f64, f64) {
    let (mut sum, mut squares) = (0.0, 0.0);
    for index in 0..samples {
        let weight = bsdf.sample(wo, numbers(5, index), Carried::Importance).map_or(0.0, |s| f64::from(s.weight.max()));
        sum += weight;
        squares += weight * weight;
    }
    let mean = sum / samples as f64;
    (mean, ((squares / samples as f64 - mean * mean).max(0.0) / samples as f64).sqrt())
}

#[test]
fn nothing_gives_more_than_it_gets() {
    for surface in all() {
        for wo in directions() {
            let (mean, error) = albedo(&*surface.bsdf, wo, 4_000);
            // Burley's surface adds its reflection to a base that is not dimmed by it.
            let most = if surface.name.starts_with("principled") { 1.5 } else { 1.0 };
            assert!(mean < most + 1e-5 + 4.5 * error, "{}, wo {wo}: {mean} ± {error}", surface.name);
        }
    }
}

#[test]
fn what_loses_nothing_gives_everything_back() {
    let white = Spectrum::ONE;
    for cos in [1.0, 0.7, 0.2, 0.01] {
        let above = direction(cos, 0.5);
        for eta in [1.5, 1.1, 2.4] {
            let glass = Dielectric { eta, specular_reflectance: white, specular_transmittance: white };
            let slab = ThinDielectric { eta, specular_reflectance: white, specular_transmittance: white };
            let both: [&dyn Bsdf; 2] = [&glass, &slab];
            for bsdf in both {
                assert!((albedo(bsdf, above, 200).0 - 1.0).abs() < 1e-6 && (albedo(bsdf, -above, 200).0 - 1.0).abs() < 1e-6);
            }
            let (mean, error) = albedo(&Plastic::new(eta, white, white, false), above, 100_000);
            assert!((mean - 1.0).abs() < 4.5 * error + 1e-5, "plastic {eta} at {cos}: {mean} ± {error}");
        }
        assert_eq!(albedo(&Diffuse { reflectance: white }, above, 200).0, 1.0);
        assert_eq!(albedo(&Conductor { eta: Spectrum::BLACK, k: white, specular_reflectance: white }, above, 200).0, 1.0);
    }
}

#[test]
fn refraction_scales_radiance_alone() {
    let glass = Dielectric { eta: 1.5, specular_reflectance: Spectrum::ONE, specular_transmittance: Spectrum::ONE };
    for (wo, eta) in [(direction(0.8, 0.1), 1.5), (direction(-0.9, 0.1), 1.0 / 1.5)] {
        let sample = |carried| glass.sample(wo, [0.5, 0.5, 0.9], carried).expect("below the critical angle");
        let (radiance, importance) = (sample(Carried::Radiance), sample(Carried::Importance));
        assert!((radiance.weight.mean() * eta * eta - 1.0 as Real).abs() < 1e-6);
        assert!((importance.weight.mean() - 1.0).abs() < 1e-6 && (importance.eta - eta).abs() < 1e-6);
    }
}

#[test]
fn the_table_of_a_rough_coat_is_what_the_boundary_lets_through() {
    for microfacet in microfacets(&[(0.05, 0.05), (0.2, 0.2), (0.6, 0.6)]) {
        let (glass, coat) = (rough_glass(1.5, microfacet), Coat::new(&microfacet, 1.5));
        for cos in [1.0, 0.83, 0.47, 0.21, 0.08] {
            let count = 100_000;
            let passed = |i| {
                let sample = glass.sample(direction(cos, 0.3), numbers(7, i), Carried::Importance);
                sample.filter(|sample| sample.wi.z < 0.0).map_or(0.0, |sample| f64::from(sample.weight[0]))
            };
            let sampled = (0..count).map(passed).sum::<f64>() / count as f64;
            let table = f64::from(coat.transmittance(cos));
            assert!((sampled - table).abs() < 5e-3, "{microfacet:?}, cos {cos}: {sampled} against {table}");
        }
    }
}
