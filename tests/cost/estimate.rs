//! The error that a render estimates of itself, against the one that a reference tells.

use std::path::Path;

use bidir::{
    cost::reference::Reference,
    film::Film,
    plan::Stage,
    render::{self, Target},
};
use bidir_kernel::Techniques;

use super::{never, of_example};

/// Renders, of which each estimates its own error.
const SEEDS: u64 = 2;

/// The mean of estimates over that of errors.
fn ratio(name: &str, stage: &Stage, samples: u32) -> f64 {
    let subject = of_example(name, 128);
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/scenes").join(name);
    let reference = Reference::given(&["reference.a.exr", "reference.b.exr"].map(|file| folder.join(file))).expect("a reference");
    let manner = subject.manner(stage);
    let (mut estimated, mut found) = (0.0, 0.0);
    for seed in 0..SEEDS {
        let film = Film::new(&subject.description.film).expect("a film");
        render::render(&subject.scene, &film, &subject.job(&manner, seed, Target::Samples(samples)), &never(), |_| None);
        estimated += film.noise().expect("two samples").relmse;
        found += reference.errors(&film.develop()).expect("one size").trimmed;
    }
    println!("{name}: {:.3e} estimated, {:.3e} found: {:.3}", estimated / SEEDS as f64, found / SEEDS as f64, estimated / found);
    estimated / found
}

#[test]
fn the_estimated_error_is_right_within_a_quarter() {
    let bdpt = Stage::BIDIRECTIONAL;
    let path = Stage::of(&Techniques::PATH);
    let ratios = [
        ("cornell", bdpt),
        ("cornell", path),
        ("veach_mis", bdpt),
        ("veach_mis", path),
        ("dof_glossy", bdpt),
        ("env_glossy", bdpt),
        ("torchiere", bdpt),
        ("caustic_sphere", bdpt),
    ]
    .map(|(name, stage)| (name, ratio(name, &stage, 32)));
    assert!(ratios.iter().all(|(_, ratio)| (0.75..1.25).contains(ratio)), "{ratios:?}");
}
