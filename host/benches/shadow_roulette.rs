//! What roulette on shadow rays is worth: `cargo bench -p bidir --bench shadow_roulette [-- cornell bdpt 0.03 8]`.
//!
//! Each scene of `examples/scenes` at 128×128, by path tracing, light tracing and all techniques, with a few shares of a pixel's mean as δ, one after the other
//! under each seed. Efficiency is 1/(trimmed relMSE · CPU seconds of one thread), against the two halves of the reference; figures are
//! medians over seeds, the last two are relative to 0, no roulette. Words choose scenes and plans, numbers below 1 shares, and
//! those above how many seeds there are.

use std::{
    path::{Path, PathBuf},
    sync::atomic::AtomicBool,
};

use bidir::{
    compare::against_halves,
    film::Film,
    image::{Image, read},
    load,
    plan::{Plan, Stage},
    plugin::{Library, Strictness},
    render::{self, Given, Job, Numbers, Target},
    scene::{Scene, description::Description},
};
use bidir_kernel::Techniques;

const SCENES: [&str; 6] = ["cornell", "torchiere", "caustic_sphere", "veach_mis", "env_glossy", "dof_glossy"];
const PLANS: [(&str, Techniques); 3] = [("path", Techniques::PATH), ("light", Techniques::LIGHT), ("bdpt", Techniques::BIDIRECTIONAL)];
const SHARES: [f64; 5] = [0.0, 0.01, 0.03, 0.1, 0.3];
const SAMPLES: u32 = 64;
const SEEDS: u64 = 5;

/// Of one render: CPU seconds, trimmed relMSE, shadow rays per camera path, mean over the reference's.
type Figures = [f64; 4];

fn main() {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    let numbers: Vec<f64> = words.iter().filter_map(|word| word.parse().ok()).collect();
    let named =
        |names: &[&str], name: &str| !words.iter().any(|word| names.contains(&word.as_str())) || words.iter().any(|word| word == name);
    let mut shares: Vec<f64> = numbers.iter().copied().filter(|&number| number < 1.0).collect();
    if shares.is_empty() {
        shares = SHARES.to_vec();
    }
    let seeds = numbers.iter().copied().find(|&number| number >= 1.0).map_or(SEEDS, |number| number as u64);
    let plans = PLANS.map(|(name, _)| name);
    println!(
        "{:<16}{:<6}{:>7}{:>9}{:>11}{:>11}{:>9}{:>9}{:>12}",
        "", "", "share", "s", "relMSE", "rays/path", "mean", "time", "efficiency"
    );
    let mut gains = vec![[const { Vec::new() }; PLANS.len()]; shares.len()];
    for scene in SCENES.into_iter().filter(|scene| named(&SCENES, scene)) {
        let subject = Subject::read(scene);
        for (index, (plan, techniques)) in PLANS.iter().enumerate().filter(|(_, (plan, _))| named(&plans, plan)) {
            let mut found = vec![Vec::new(); shares.len()];
            for seed in 0..seeds {
                for (share, figures) in shares.iter().zip(&mut found) {
                    figures.push(subject.figures(&Stage { shadow_roulette: *share, ..Stage::of(techniques) }, seed));
                }
            }
            for (i, (share, figures)) in shares.iter().zip(&found).enumerate() {
                let of = |k: usize| median(figures.iter().map(|figures: &Figures| figures[k]).collect());
                let against = |value: &dyn Fn(&Figures) -> f64| {
                    median(figures.iter().zip(&found[0]).map(|(own, first)| value(own) / value(first)).collect())
                };
                let (time, efficiency) = (against(&|f| f[0]), against(&|f| 1.0 / (f[0] * f[1])));
                print!("{scene:<16}{plan:<6}{share:>7}{:>9.3}{:>11.3e}{:>11.3}{:>9.4}", of(0), of(1), of(2), of(3));
                println!("{time:>9.3}{efficiency:>12.3}");
                gains[i][index].push(efficiency);
            }
        }
    }
    for (share, gains) in shares.iter().zip(&gains) {
        for (plan, gains) in plans.iter().zip(gains).filter(|(_, gains)| !gains.is_empty()) {
            let mean = (gains.iter().map(|gain| gain.ln()).sum::<f64>() / gains.len() as f64).exp();
            println!("{plan:<6} with {share:<6} has {mean:.3} × the efficiency, in geometric mean");
        }
    }
}

struct Subject {
    description: Description,
    scene: Scene,
    halves: [Image; 2],
}

impl Subject {
    fn read(name: &str) -> Self {
        let folder: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/scenes").join(name);
        let size = ("res".to_owned(), "128".to_owned());
        let description = load::load(&folder.join("scene.xml"), &[size], &Library::default()).expect("a scene").description;
        let scene = Scene::new(&description).expect("a scene");
        let halves = ["a", "b"].map(|half| {
            let pixels = read::read(&folder.join(format!("reference.{half}.exr")), read::Encoding::Linear).expect("a reference");
            Image { width: pixels.width, height: pixels.height, pixels: pixels.values.iter().map(|value| value.0).collect() }
        });
        Self { description, scene, halves }
    }

    fn figures(&self, stage: &Stage, seed: u64) -> Figures {
        let film = Film::new(&self.description.film).expect("a film");
        let job = Job {
            strategy: stage.strategy(&self.description.integrator),
            seed,
            numbers: Numbers::default(),
            threads: 1,
            target: Target::Samples(SAMPLES),
            width: self.description.film.width,
            strictness: Strictness::Strict,
        };
        let mut director = Given { plan: Plan::fixed(*stage), integrator: self.description.integrator.clone() };
        let status = render::directed(&self.scene, &film, &job, &mut director, &AtomicBool::new(false), |_| None);
        assert!(status.fault.is_none() && status.samples == SAMPLES, "{:?}", status.fault);
        let compared = against_halves(&film.develop(), [&self.halves[0], &self.halves[1]]).expect("one size");
        let paths = f64::from(SAMPLES) * self.halves[0].pixels.len() as f64;
        [status.cpu.as_secs_f64(), compared.relmse_trimmed, status.rays.any as f64 / paths, compared.mean_ratio]
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
