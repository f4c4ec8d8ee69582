//! Path tracing, light tracing and both heuristics of bidirectional path tracing, held against each other.
//!
//! Each is rendered [`BATCHES`] times. The whole picture, band by band, and each block of 8×8 pixels must not
//! differ by more standard errors than chance explains, and the means' errors must be small enough for that to say something.

use bidir_kernel::{Heuristic, Techniques};

use crate::{
    pictures::{BATCHES, BDPT, LIGHT, PATH, Pictures, Subject, leave},
    statistics::worse,
    statistics::{Estimate, threshold},
};

/// What may be left of doubt about a mean, as a share of it.
pub const DOUBT: f64 = 0.01;

/// An estimator that is held against the others, with samples per pixel and batch.
pub struct Estimator {
    name: &'static str,
    techniques: Techniques,
    heuristic: Heuristic,
    samples: u32,
}

/// One of them.
pub const fn estimator(name: &'static str, techniques: Techniques, heuristic: Heuristic, samples: u32) -> Estimator {
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
pub const NOT_PATH: &[Estimator] = &[BALANCE, POWER, LIGHTS];

/// What holding estimators against the first one found.
pub struct Agreement {
    /// The others' pictures, each with its difference from the first.
    pub differences: Vec<(&'static str, Difference)>,
    /// Each one's mean, with its error.
    pub means: Vec<(&'static str, Estimate)>,
    pictures: Vec<(&'static str, Pictures)>,
}

impl Agreement {
    /// Renders with all estimators, with `effort` times their samples.
    pub fn of(subject: &Subject, estimators: &[Estimator], effort: u32) -> Self {
        let picture = |(e, seed): (&Estimator, u64)| {
            (e.name, subject.pictures(subject.strategy(e.techniques, e.heuristic), e.samples * effort, seed))
        };
        let pictures: Vec<_> = estimators.iter().zip(1..).map(picture).collect();
        let (_, first) = &pictures[0];
        let differences = pictures[1..].iter().map(|(name, picture)| (*name, difference(picture, first))).collect();
        let means = pictures.iter().map(|(name, picture)| (*name, picture.mean(picture.whole(), &[0, 1, 2]))).collect();
        Self { differences, means, pictures }
    }

    /// The largest deviation, as a share of what chance explains.
    pub fn worst(&self) -> f64 {
        self.differences.iter().map(|(_, difference)| difference.deviation / difference.threshold).fold(0.0, worse)
    }

    /// The largest doubt about a mean, as a share of it; infinite for a black picture.
    pub fn doubt(&self) -> f64 {
        self.means.iter().map(|(_, mean)| if mean.mean > 0.0 { mean.error / mean.mean } else { f64::INFINITY }).fold(0.0, worse)
    }

    /// The largest difference of two means, as a share of them.
    pub fn apart(&self) -> f64 {
        self.differences.iter().map(|(_, difference)| difference.whole.abs()).fold(0.0, worse)
    }
}

/// Holds all estimators against the first one.
pub fn agree(name: &str, subject: &Subject, estimators: &[Estimator]) {
    agree_after(1, name, subject, estimators);
}

/// The same with so many times the samples, for noisy scenes.
pub fn agree_after(effort: u32, name: &str, subject: &Subject, estimators: &[Estimator]) {
    let agreement = Agreement::of(subject, estimators, effort);
    let (first, reference) = &agreement.pictures[0];
    let mut failures = Vec::new();
    for ((other, found), (_, picture)) in agreement.differences.iter().zip(&agreement.pictures[1..]) {
        let line = format!("{name}: {other} − {first} over {BATCHES} batches: {found}");
        println!("{line}");
        if worse(found.deviation, found.threshold) != found.threshold {
            failures.push(line);
            leave(name, &[(other, &picture.average()), (first, &reference.average())]);
        }
    }
    for ((estimator, mean), e) in agreement.means.iter().zip(estimators) {
        assert!(mean.mean > 0.0, "{name}: {estimator} is black");
        let (doubt, samples) = (mean.error / mean.mean, e.samples * effort * BATCHES);
        println!("{name}: {estimator} {:.4} ± {:.2} %, {samples} samples per pixel", mean.mean, 100.0 * doubt);
        assert!(doubt < DOUBT, "{name}: {estimator} says {:.4} ± {:.2} %, too little to compare with", mean.mean, 100.0 * doubt);
    }
    let folder = std::env::temp_dir().join("bidir-tests").join(name);
    assert!(failures.is_empty(), "{}\npictures are in {}", failures.join("\n"), folder.display());
}

/// The largest deviation between two pictures.
pub struct Difference {
    /// Of the means, relatively.
    pub whole: f64,
    /// Where it is.
    pub place: String,
    /// In standard errors,
    pub deviation: f64,
    /// and how many of them chance explains.
    pub threshold: f64,
}

impl std::fmt::Display for Difference {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { whole, place, deviation, threshold } = self;
        write!(f, "mean {:+.3} %, worst {deviation:.2} σ of {threshold:.2} at {place}", 100.0 * whole)
    }
}

/// The largest deviation, band by band over the whole picture, and block by block.
pub fn difference(a: &Pictures, b: &Pictures) -> Difference {
    let bands = [0, 1, 2].map(|band| (a.whole(), vec![band]));
    let blocks = a.blocks().into_iter().map(|block| (block, vec![0, 1, 2]));
    let places: Vec<_> = bands.into_iter().chain(blocks).collect();
    let mean = |pictures: &Pictures| pictures.mean(pictures.whole(), &[0, 1, 2]).mean;
    let mut worst = Difference { whole: mean(a) / mean(b) - 1.0, place: "no place".into(), deviation: 0.0, threshold: f64::INFINITY };
    for (region, bands) in &places {
        let (x, y) = (a.mean(*region, bands), b.mean(*region, bands));
        let apart = x.minus(&y);
        let (deviation, threshold) = (apart.deviation(x.mean), threshold(places.len(), apart.degrees));
        let (found, known) = (deviation / threshold, worst.deviation / worst.threshold);
        if worse(known, found).to_bits() != known.to_bits() {
            worst = Difference { place: format!("{region:?} bands {bands:?}"), deviation, threshold, ..worst };
        }
    }
    worst
}
