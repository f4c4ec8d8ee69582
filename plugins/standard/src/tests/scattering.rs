//! What binds a surface's samples, densities and values together.

use bidir_sdk::{Bsdf, Carried, Lobe, Made, Real, Scattered, Spectrum, Vec3, math::dot, real::ONE_MINUS_EPSILON};

use super::{
    chi_square::{Histogram, masses},
    close, direction, directions, numbers,
    surfaces::{Surface, all},
};

const CARRIED: [Carried; 2] = [Carried::Radiance, Carried::Importance];

fn smooth(sample: &Scattered) -> bool {
    matches!(sample.made, Made::Smooth { .. })
}

fn bands_close(a: Spectrum, b: Spectrum, tolerance: Real) -> bool {
    a.0.iter().zip(b.0).all(|(&a, b)| close(a, b, tolerance))
}

/// About 500 tests at 1 % in all: 2e-5 each, 4.1 standard deviations on one side; 4.5 leaves room for the approximation of the tail.
const DEVIATION: f64 = 4.5;
const SAMPLES: u64 = 60_000;

/// The longest test here, in two threads: when the others are done, a second core would have nothing to do.
#[test]
fn sampling_follows_the_pdf() {
    std::thread::scope(|scope| {
        for part in 0..2 {
            scope.spawn(move || sampling_follows_the_pdf_of(all().iter().skip(part).step_by(2)));
        }
    });
}

fn sampling_follows_the_pdf_of<'a>(surfaces: impl Iterator<Item = &'a Surface>) {
    for surface in surfaces.filter(|surface| surface.bsdf.lobes().intersects(Lobe::SMOOTH)) {
        for wo in directions() {
            let mut histogram = Histogram::new();
            for index in 0..SAMPLES {
                let sample = surface.bsdf.sample(wo, numbers(1, index), Carried::Radiance);
                histogram.add(sample.filter(smooth).map(|sample| sample.wi));
            }
            let masses = masses(&|wi| surface.bsdf.eval(wo, wi, Carried::Radiance).pdf.0);
            let (mass, share) = (masses.iter().sum::<f64>(), histogram.share());
            // Seen from grazing, refraction ends and reflection narrows within less than the smallest cells.
            let rule = if wo.z.abs() < 0.01 { 3e-3 } else { 5e-4 };
            // Four standard deviations of a share, and the error of the quadrature.
            let tolerance = rule + 4.0 * (share * (1.0 - share) / SAMPLES as f64).sqrt();
            assert!((mass - share).abs() < tolerance, "{}, wo {wo}: the pdf integrates to {mass}, {share} sampled", surface.name);
            let deviation = histogram.deviation(&masses);
            assert!(deviation < DEVIATION, "{}, wo {wo}: {deviation} of {DEVIATION} with {SAMPLES} samples", surface.name);
        }
    }
}

fn for_every_sample(count: u64, check: impl Fn(&str, &dyn Bsdf, Vec3, Carried, Scattered)) {
    for surface in all() {
        for wo in directions() {
            for carried in CARRIED {
                for index in 0..count {
                    if let Some(sample) = surface.bsdf.sample(wo, numbers(2, index), carried) {
                        check(&surface.name, &*surface.bsdf, wo, carried, sample);
                    }
                }
            }
        }
    }
}

#[test]
fn the_weight_is_the_value_over_the_pdf() {
    for_every_sample(200, |name, bsdf, wo, carried, sample| {
        let Made::Smooth { pdf, pdf_rev } = sample.made else { return };
        let scatter = bsdf.eval(wo, sample.wi, carried);
        assert!(bands_close(sample.weight * pdf.0, scatter.value, 1e-3), "{name}, wo {wo}: {sample:?} against {scatter:?}");
        assert!(close(pdf.0, scatter.pdf.0, 1e-3), "{name}, wo {wo}: {sample:?} against {scatter:?}");
        assert!(close(pdf_rev.0, scatter.pdf_rev.0, 1e-3), "{name}, wo {wo}: {sample:?} against {scatter:?}");
    });
}

#[test]
fn the_reverse_pdf_is_the_pdf_of_the_reverse() {
    for_every_sample(200, |name, bsdf, wo, carried, sample| {
        if let Made::Smooth { .. } = sample.made {
            let (forward, back) = (bsdf.eval(wo, sample.wi, carried), bsdf.eval(sample.wi, wo, carried));
            assert!(close(forward.pdf_rev.0, back.pdf.0, 1e-3), "{name}, wo {wo}: {forward:?} against {back:?}");
            assert!(close(forward.pdf.0, back.pdf_rev.0, 1e-3), "{name}, wo {wo}: {forward:?} against {back:?}");
        }
    });
}

#[test]
fn the_reverse_chance_is_the_chance_of_the_reverse() {
    for_every_sample(20, |name, bsdf, wo, carried, sample| {
        let Made::Delta { chance, chance_rev } = sample.made else { return };
        let again = (0..64).filter_map(|i| {
            bsdf.sample(sample.wi, [0.5, 0.5, if i == 63 { ONE_MINUS_EPSILON } else { (i * i * i) as Real / 250_047.0 }], carried)
        });
        let Some((back, chance_back, chance_back_rev)) = again
            .filter_map(|back| match back.made {
                Made::Delta { chance, chance_rev } if back.lobe == sample.lobe => Some((back, chance, chance_rev)),
                _ => None,
            })
            .next()
        else {
            panic!("{name}, wo {wo}: nothing leads back along {sample:?}");
        };
        // At 1e-3 from grazing a rounding of the refracted direction moves the reflectance by 1e-4.
        assert!((chance_rev.0 - chance_back.0).abs() < 5e-4, "{name}, wo {wo}: {sample:?} against {back:?}");
        assert!((chance.0 - chance_back_rev.0).abs() < 5e-4, "{name}, wo {wo}: {sample:?} against {back:?}");
        assert!((dot(back.wi, wo) - 1.0).abs() < 1e-4, "{name}: {wo} came back as {}", back.wi);
        assert!(close(back.eta * sample.eta, 1.0, 1e-5), "{name}: {sample:?} against {back:?}");
    });
}

#[test]
fn both_directions_scatter_alike() {
    // f(ω_o, ω_i)/η_o² is symmetric for radiance, and importance is radiance with its directions swapped.
    for surface in all() {
        for wo in directions() {
            for index in 0..200 {
                let u = numbers(3, index);
                let wi = direction(2.0 * u[0] - 1.0, 6.3 * u[1]);
                let f = |carried, wo: Vec3, wi: Vec3| surface.bsdf.eval(wo, wi, carried).value / wi.z.abs();
                let index_squared = |w: Vec3| if w.z > 0.0 { 1.0 } else { surface.eta * surface.eta };
                let (there, back) = (f(Carried::Radiance, wo, wi), f(Carried::Radiance, wi, wo));
                assert!(bands_close(there / index_squared(wo), back / index_squared(wi), 2e-3), "{}: {there:?} {back:?}", surface.name);
                let swapped = f(Carried::Importance, wi, wo);
                assert!(bands_close(there, swapped, 2e-3), "{}: {there:?} {swapped:?}", surface.name);
            }
        }
    }
}

#[test]
fn samples_name_one_declared_lobe_on_the_side_they_lie() {
    for_every_sample(100, |name, bsdf, wo, _, sample| {
        assert_eq!(sample.lobe.0.count_ones(), 1, "{name}: {sample:?}");
        assert!(bsdf.lobes().contains(sample.lobe), "{name}: {sample:?}");
        assert_eq!(sample.lobe.intersects(Lobe::SMOOTH), smooth(&sample), "{name}: {sample:?}");
        assert_eq!(sample.lobe.intersects(Lobe::REFLECTION), sample.wi.z * wo.z > 0.0, "{name}, wo {wo}: {sample:?}");
        assert!((dot(sample.wi, sample.wi) - 1.0).abs() < 1e-5, "{name}: {sample:?}");
    });
}
