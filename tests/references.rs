//! The six scenes of `examples/scenes` against what Mitsuba makes of them (see the README there).
//!
//! The whole mean must lie within the scene's tolerance, or 4 standard errors; each block of 16×16 pixels within 5 standard errors.
//! Where few bright paths carry the light, 64 samples that missed them do not know how far off they are: there a block's error is at least
//! that of as many samples of the reference, whose halves tell it.

use std::path::{Path, PathBuf};

use bidir::{
    compare,
    image::{Image, read},
    load,
    plugin::Library,
    scene::Scene,
};
use bidir_kernel::{Heuristic, Techniques};

use crate::{
    pictures::{BATCHES, BDPT, PATH, Pictures, Region, Subject, leave},
    statistics::Estimate,
};

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/scenes").join(name)
}

fn halves(name: &str) -> [Image; 2] {
    ["reference.a.exr", "reference.b.exr"].map(|file| read::picture(&folder(name).join(file)).expect("a reference"))
}

/// Blocks of 16×16.
fn blocks() -> impl Iterator<Item = Region> {
    (0..64).map(|i| [i % 8 * 16, i / 8 * 16, 16, 16])
}

/// A scene, and what its reference is good for.
struct Reference {
    name: &'static str,
    /// Of the whole mean.
    tolerance: f64,
    /// Samples per half, where rare bright paths matter.
    samples: Option<f64>,
}

fn matches(reference: &Reference, estimators: &[(&str, Techniques, u32)]) {
    let name = reference.name;
    let defines = [("res".to_owned(), "128".to_owned())];
    let description = load::load(&folder(name).join("scene.xml"), &defines, &Library::default()).expect("a scene").description;
    let subject = Subject { scene: Scene::new(&description).expect("a scene"), description };
    let halves = Pictures { batches: halves(name).to_vec() };
    let whole = halves.whole();
    for &(estimator, techniques, samples) in estimators {
        let found = subject.pictures(subject.strategy(techniques, Heuristic::Balance), samples, 1);
        let average = found.average();
        let comparison = compare::against_halves(&average, [&halves.batches[0], &halves.batches[1]]).expect("one size");
        let error = found.mean(whole, &[0, 1, 2]).error / halves.mean(whole, &[0, 1, 2]).mean;
        println!("{name}, {estimator}: bias {:+.3} % ± {:.3} %, relMSE {:.2e}", 100.0 * comparison.bias, 100.0 * error, comparison.relmse);
        let fewer = reference.samples.map_or(0.0, |reference| reference / f64::from(samples * BATCHES));
        let deviation = |block| deviation(&found, &halves, block, fewer);
        let worst = blocks().map(|block| (deviation(block), block)).max_by(|a, b| a.0.total_cmp(&b.0)).expect("blocks");
        println!("{name}, {estimator}: worst block {:.2} σ at {:?}", worst.0, worst.1);
        let good = comparison.nonfinite == 0 && comparison.bias.abs() < reference.tolerance.max(4.0 * error) && worst.0 < 5.0;
        if !good {
            let folder = leave(&format!("{name}_{estimator}"), &[(estimator, &average), ("reference", &halves.average())]);
            panic!("{name}, {estimator}: {comparison}\nworst block {worst:?}; pictures are in {}", folder.display());
        }
    }
}

/// How many standard errors a block is off; `fewer` is how many times fewer samples it has than a half of the reference.
fn deviation(found: &Pictures, halves: &Pictures, block: Region, fewer: f64) -> f64 {
    let (x, r) = (found.mean(block, &[0, 1, 2]), halves.mean(block, &[0, 1, 2]));
    let [left, top, width, height] = block;
    let pixels = (0..width * height).map(|i| (left + i % width, top + i / width));
    // (a − b)²/2 is the variance of a pixel of either half.
    let band_mean = |pixel: [f32; 3]| pixel.into_iter().map(f64::from).sum::<f64>() / 3.0;
    let between = |(x, y)| band_mean(halves.batches[0].at(x, y)) - band_mean(halves.batches[1].at(x, y));
    let variance: f64 = pixels.map(|at| between(at) * between(at) / 2.0).sum::<f64>();
    let of_reference = (variance * fewer).sqrt() / f64::from(width * height);
    let apart = x.minus(&r);
    Estimate { error: apart.error.max(of_reference), ..apart }.deviation(r.mean)
}

const BOTH: &[(&str, Techniques, u32)] = &[("path", PATH, 2), ("bdpt", BDPT, 2)];

#[test]
fn cornell() {
    matches(&Reference { name: "cornell", tolerance: 0.005, samples: None }, BOTH);
}

#[test]
fn torchiere() {
    matches(&Reference { name: "torchiere", tolerance: 0.005, samples: None }, BOTH);
}

/// Path tracing finds this caustic by chance alone: 64 samples of it say nothing.
#[test]
fn caustic_sphere() {
    matches(&Reference { name: "caustic_sphere", tolerance: 0.01, samples: Some(76_000.0) }, &[("bdpt", BDPT, 4)]);
}

#[test]
fn veach_mis() {
    matches(&Reference { name: "veach_mis", tolerance: 0.01, samples: Some(28_300.0) }, BOTH);
}

#[test]
fn env_glossy() {
    matches(&Reference { name: "env_glossy", tolerance: 0.01, samples: Some(47_400.0) }, BOTH);
}

#[test]
fn dof_glossy() {
    matches(&Reference { name: "dof_glossy", tolerance: 0.015, samples: Some(39_900.0) }, BOTH);
}
