//! What binds a surface's samples, densities and values together.

use bidir_sdk::{Bsdf, Carried, Lobe, Made, Real, Scattered, Vec3, math::dot};

use crate::{
    chi_square::{Histogram, masses},
    close, corners, directions, edges, numbers,
};

const EITHER: [Carried; 2] = [Carried::Radiance, Carried::Importance];

/// Smooth samples fall where the pdf says, and as many are made as it integrates to. Lobes far narrower than 0.05
/// slip through the bins and the quadrature: test those otherwise.
pub fn samples_follow_the_pdf(name: &str, bsdf: &dyn Bsdf) {
    // 20 tests per plugin at 0.1 % in all: 4.1 standard deviations.
    let (samples, threshold) = (60_000, 4.2);
    for wo in directions() {
        let mut histogram = Histogram::new();
        for index in 0..samples {
            let sample = bsdf.sample(wo, numbers(1, index), Carried::Radiance);
            histogram.add(sample.filter(|s| matches!(s.made, Made::Smooth { .. })).map(|s| s.wi));
        }
        let masses = masses(&|wi| bsdf.eval(wo, wi, Carried::Radiance).pdf.0);
        let (mass, share) = (masses.iter().sum::<f64>(), histogram.share());
        let slack = 5.0 * (share * (1.0 - share) / f64::from(histogram.samples)).sqrt() + 2e-3;
        assert!((mass - share).abs() < slack, "{name}, wo {wo}: the pdf integrates to {mass}, samples to {share}");
        if share > 0.0 {
            let deviation = histogram.deviation(&masses);
            assert!(deviation < threshold, "{name}, wo {wo}: {deviation} of {threshold} with {samples} samples");
        }
    }
}

/// Calls `check` with samples of every direction, none of them right at an edge of the numbers.
fn for_samples(bsdf: &dyn Bsdf, check: impl Fn(Vec3, Carried, Scattered)) {
    for wo in directions() {
        for carried in EITHER {
            for index in 0..1_000 {
                if let Some(sample) = bsdf.sample(wo, numbers(3, index), carried) {
                    check(wo, carried, sample);
                }
            }
        }
    }
}

/// A smooth sample carries the densities that `eval` gives; a delta has none there. Its one lobe is one of the declared.
pub fn samples_agree_with_eval(name: &str, bsdf: &dyn Bsdf) {
    for_samples(bsdf, |wo, carried, sample| {
        assert!(sample.lobe.0.is_power_of_two() && bsdf.lobes().contains(sample.lobe), "{name}, wo {wo}: {sample:?}");
        assert!((dot(sample.wi, sample.wi) - 1.0).abs() < 1e-5, "{name}, wo {wo}: {sample:?}");
        let Made::Smooth { pdf, pdf_rev } = sample.made else {
            assert!(Lobe::DELTA.contains(sample.lobe), "{name}, wo {wo}: {sample:?}");
            return;
        };
        let scatter = bsdf.eval(wo, sample.wi, carried);
        let agree = close(scatter.pdf.0, pdf.0, 2e-3) && close(scatter.pdf_rev.0, pdf_rev.0, 2e-3);
        assert!(agree, "{name}, wo {wo}: {sample:?} against {scatter:?}");
    });
}

/// weight · pdf = value.
pub fn weights_are_value_over_pdf(name: &str, bsdf: &dyn Bsdf) {
    for_samples(bsdf, |wo, carried, sample| {
        let Made::Smooth { pdf, .. } = sample.made else { return };
        let value = bsdf.eval(wo, sample.wi, carried).value;
        let product = sample.weight * pdf.0;
        assert!((0..3).all(|band| close(product[band], value[band], 3e-3)), "{name}, wo {wo}: {product:?} against {value:?}");
    });
}

/// pdf_rev(ω_o, ω_i) = pdf(ω_i, ω_o), and the chance of a delta the other way is the one it says.
pub fn reverse_densities_are_those_of_the_way_back(name: &str, bsdf: &dyn Bsdf) {
    for_samples(bsdf, |wo, carried, sample| match sample.made {
        Made::Smooth { .. } => {
            let (there, back) = (bsdf.eval(wo, sample.wi, carried), bsdf.eval(sample.wi, wo, carried));
            let agree = close(there.pdf_rev.0, back.pdf.0, 1e-3) && close(there.pdf.0, back.pdf_rev.0, 1e-3);
            assert!(agree, "{name}, {wo} {}: {there:?} against {back:?}", sample.wi);
        }
        Made::Delta { chance_rev, .. } => {
            let found = (0..64).find_map(|index| {
                let back = bsdf.sample(sample.wi, numbers(7, index), carried)?;
                match back.made {
                    Made::Delta { chance, .. } if back.lobe == sample.lobe => Some((chance, back.wi)),
                    _ => None,
                }
            });
            // A chance below 1/64 may find nothing; one that is found must be right.
            let Some((chance, wi)) = found else { return };
            assert!(close(chance.0, chance_rev.0, 1e-3) && (wi - wo).length() < 1e-3, "{name}, wo {wo}: {sample:?} against {chance:?}");
        }
    });
}

/// f(ω_o, ω_i) = f(ω_i, ω_o).
pub fn the_bsdf_is_reciprocal(name: &str, bsdf: &dyn Bsdf) {
    for_samples(bsdf, |wo, carried, sample| {
        let there = bsdf.eval(wo, sample.wi, carried).value / sample.wi.z.abs();
        let back = bsdf.eval(sample.wi, wo, carried).value / wo.z.abs();
        assert!((0..3).all(|band| close(there[band], back[band], 1e-3)), "{name}, {wo} {}: {there:?} against {back:?}", sample.wi);
    });
}

/// The mean weight in the strongest band, and its standard error.
pub fn albedo(bsdf: &dyn Bsdf, wo: Vec3, samples: u64) -> (f64, f64) {
    let mut bands = [(0.0, 0.0); 3];
    for index in 0..samples {
        if let Some(sample) = bsdf.sample(wo, numbers(5, index), Carried::Importance) {
            for (band, (sum, squares)) in bands.iter_mut().enumerate() {
                let weight = f64::from(sample.weight[band]);
                (*sum, *squares) = (*sum + weight, *squares + weight * weight);
            }
        }
    }
    let n = samples as f64;
    let moments = bands.map(|(sum, squares)| (sum / n, ((squares / n - sum * sum / n / n).max(0.0) / n).sqrt()));
    moments.into_iter().fold((0.0, 0.0), |a, b| if b.0 > a.0 { b } else { a })
}

/// The albedo is at most 1 in every band.
pub fn nothing_gives_more_than_it_gets(name: &str, bsdf: &dyn Bsdf) {
    for wo in directions() {
        let (mean, error) = albedo(bsdf, wo, 20_000);
        assert!(mean < 1.0 + 1e-5 + 4.5 * error, "{name}, wo {wo}: {mean} ± {error}");
    }
}

fn finite(sample: &Scattered) -> bool {
    let made = match sample.made {
        Made::Smooth { pdf, pdf_rev } => pdf.0.is_finite() && pdf.0 > 0.0 && pdf_rev.0.is_finite(),
        Made::Delta { chance, chance_rev } => chance.0 > 0.0 && chance.0 <= 1.0 && chance_rev.0 > 0.0 && chance_rev.0 <= 1.0,
    };
    let sound = |weight: Real| weight.is_finite() && weight >= 0.0;
    made && sample.weight.0.into_iter().all(sound) && sample.wi.is_finite() && sample.eta.is_finite() && sample.wi.z != 0.0
}

/// No infinity, no NaN and no negative number leaves, however close to grazing and with numbers from the edges.
pub fn all_is_finite_at_corners_and_grazing(name: &str, bsdf: &dyn Bsdf) {
    for wo in edges() {
        for carried in EITHER {
            for u in corners() {
                if let Some(sample) = bsdf.sample(wo, u, carried) {
                    assert!(finite(&sample), "{name}, wo {wo}, u {u:?}: {sample:?}");
                }
            }
            for wi in edges().into_iter().chain([wo, -wo]) {
                let scatter = bsdf.eval(wo, wi, carried);
                let sound = |x: Real| x.is_finite() && x >= 0.0;
                let all = scatter.value.0.into_iter().chain([scatter.pdf.0, scatter.pdf_rev.0]).all(sound);
                assert!(all && (scatter.value.is_black() || scatter.pdf.0 > 0.0), "{name}, {wo} {wi}: {scatter:?}");
            }
        }
    }
}
