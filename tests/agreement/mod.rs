//! Estimators agree: path tracing, light tracing and both heuristics of bidirectional path tracing make one picture.
//!
//! Each is rendered [`BATCHES`](crate::pictures::BATCHES) times. The whole picture, band by band, and each block of 8×8 pixels must not
//! differ by more standard errors than chance explains, and the means' errors must be small enough for that to say something.

mod cameras;
mod lights;
mod surfaces;

use bidir_kernel::{Heuristic, Techniques};

use crate::{
    pictures::{BATCHES, BDPT, LIGHT, PATH, Pictures, Subject, leave},
    statistics::threshold,
};

/// What may be left of doubt about a mean, as a share of it.
const DOUBT: f64 = 0.01;

/// An estimator that is held against the others, with samples per pixel and batch.
pub struct Estimator {
    name: &'static str,
    techniques: Techniques,
    heuristic: Heuristic,
    samples: u32,
}

const fn estimator(name: &'static str, techniques: Techniques, heuristic: Heuristic, samples: u32) -> Estimator {
    Estimator { name, techniques, heuristic, samples }
}

const BALANCE: Estimator = estimator("bdpt", BDPT, Heuristic::Balance, 8);
const POWER: Estimator = estimator("bdpt_power", BDPT, Heuristic::Power, 8);
const CAMERA: Estimator = estimator("path", PATH, Heuristic::Balance, 32);
const LIGHTS: Estimator = estimator("light", LIGHT, Heuristic::Balance, 32);

/// For scenes that every estimator can render.
pub const ALL: &[Estimator] = &[BALANCE, POWER, CAMERA, LIGHTS];
/// For scenes where a mirror or glass hides something from light tracing.
pub const NOT_LIGHT: &[Estimator] = &[BALANCE, POWER, CAMERA];
/// For scenes where a mirror or glass hides something from path tracing.
const NOT_PATH: &[Estimator] = &[BALANCE, POWER, LIGHTS];

/// Holds all estimators against the first one.
pub fn agree(name: &str, subject: &Subject, estimators: &[Estimator]) {
    agree_after(1, name, subject, estimators);
}

/// The same with so many times the samples, for noisy scenes.
pub fn agree_after(effort: u32, name: &str, subject: &Subject, estimators: &[Estimator]) {
    let pictures: Vec<_> = estimators
        .iter()
        .zip(1..)
        .map(|(e, seed)| (e, subject.pictures(subject.strategy(e.techniques, e.heuristic), e.samples * effort, seed)))
        .collect();
    let (first, reference) = &pictures[0];
    let mut failures = Vec::new();
    for (other, picture) in &pictures[1..] {
        let found = difference(picture, reference);
        let line = format!("{name}: {} − {} over {BATCHES} batches: {found}", other.name, first.name);
        println!("{line}");
        if found.deviation > found.threshold {
            failures.push(line);
            leave(name, &[(other.name, &picture.average()), (first.name, &reference.average())]);
        }
    }
    for (estimator, picture) in &pictures {
        let mean = picture.mean(picture.whole(), &[0, 1, 2]);
        assert!(mean.mean > 0.0, "{name}: {} is black", estimator.name);
        let doubt = mean.error / mean.mean;
        println!(
            "{name}: {} {:.4} ± {:.2} %, {} samples per pixel",
            estimator.name,
            mean.mean,
            100.0 * doubt,
            estimator.samples * effort * BATCHES
        );
        assert!(doubt < DOUBT, "{name}: {} says {:.4} ± {:.2} %, too little to compare with", estimator.name, mean.mean, 100.0 * doubt);
    }
    let folder = std::env::temp_dir().join("bidir-tests").join(name);
    assert!(failures.is_empty(), "{}\npictures are in {}", failures.join("\n"), folder.display());
}

/// The largest deviation between two pictures.
struct Difference {
    whole: f64,
    place: String,
    deviation: f64,
    threshold: f64,
}

impl std::fmt::Display for Difference {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { whole, place, deviation, threshold } = self;
        write!(f, "mean {:+.3} %, worst {deviation:.2} σ of {threshold:.2} at {place}", 100.0 * whole)
    }
}

fn difference(a: &Pictures, b: &Pictures) -> Difference {
    let bands = [0, 1, 2].map(|band| (a.whole(), vec![band]));
    let blocks = a.blocks().into_iter().map(|block| (block, vec![0, 1, 2]));
    let places: Vec<_> = bands.into_iter().chain(blocks).collect();
    let mean = |pictures: &Pictures| pictures.mean(pictures.whole(), &[0, 1, 2]).mean;
    let mut worst = Difference { whole: mean(a) / mean(b) - 1.0, place: "no place".into(), deviation: 0.0, threshold: f64::INFINITY };
    for (region, bands) in &places {
        let (x, y) = (a.mean(*region, bands), b.mean(*region, bands));
        let apart = x.minus(&y);
        let (deviation, threshold) = (apart.deviation(x.mean), threshold(places.len(), apart.degrees));
        if deviation / threshold > worst.deviation / worst.threshold {
            worst = Difference { place: format!("{region:?} bands {bands:?}"), deviation, threshold, ..worst };
        }
    }
    worst
}
