//! Every plan that a scene leaves open makes the same picture of it, whatever the scene: those of `examples/scenes`, and each plugin's.
//!
//! A plan may hardly ever make what carries much of the light, and then its own batches do not know how far off they are. So each is taken to
//! be at least as noisy as the bidirectional plan says, whose samples make these paths: second moments, as a pilot tells them.
//! What a plan cannot make at all has to be among the gaps that `explain` shows.

use std::path::Path;

use bidir::{
    image::Image,
    load,
    plan::{Named, Stage, choice::open, effects::Effects, evidence::shares, gaps::gaps, words},
    plugin::{Library, Strictness},
    scene::{Scene, view::View},
};
use bidir_kernel::{ByJoin, Contribution, Film, Heuristic, Join, Rivals, Sampler, Vec2, Walk, WalkVertex, sample, sampler::Independent};

use crate::{
    pictures::{BATCHES, Pictures, Region, Subject, leave},
    statistics::{Estimate, threshold, worse},
};

/// Pixels in a row.
const SIZE: u32 = 24;
/// Samples per pixel and batch.
const SAMPLES: u32 = 2;
/// Samples per pixel that second moments are told from.
const TOLD: u32 = 32;
/// The longest path that is connected there.
const LONGEST: usize = 64;

/// Which region each pixel is in, beside the whole; and what each plan's samples bring there, squared.
struct Told<'a> {
    plans: &'a [Stage],
    regions: &'a [Region],
    raster: Vec2,
    weighed: (f64, ByJoin),
    /// Plan by plan, region by region.
    squares: Vec<Vec<f64>>,
    /// Plans that cannot make some path.
    missing: Vec<bool>,
}

impl Told<'_> {
    fn take(&mut self, raster: Vec2, contribution: &Contribution) {
        let value = f64::from(contribution.value.mean()) * f64::from(contribution.weight);
        let shares = shares(contribution.technique, self.weighed.0, |join| self.weighed.1.of(join));
        let within = |&[x, y, width, height]: &Region| {
            let inside = |at: f32, first: u32, length: u32| at >= first as f32 && at < (first + length) as f32;
            inside(raster.x, x, width) && inside(raster.y, y, height)
        };
        if value == 0.0 || !within(&self.regions[0]) {
            return;
        }
        for ((plan, squares), missing) in self.plans.iter().zip(&mut self.squares).zip(&mut self.missing) {
            let density: f64 = Join::ALL.iter().zip(shares).map(|(&join, share)| share * plan.effort(join)).sum();
            *missing |= density == 0.0;
            for (square, _) in squares.iter_mut().zip(self.regions).filter(|(_, region)| within(region)) {
                *square += value * value / density;
            }
        }
    }
}

impl Film for Told<'_> {
    type Rivals = ByJoin;

    fn weighed(&mut self, own: f64, others: ByJoin) {
        self.weighed = (own, others);
    }

    fn add(&mut self, contribution: Contribution) {
        self.take(self.raster, &contribution);
    }

    fn splat(&mut self, raster: Vec2, contribution: Contribution) {
        self.take(raster, &contribution);
    }
}

/// What the bidirectional plan tells of others.
fn told<'a>(subject: &Subject, plans: &'a [Stage], regions: &'a [Region]) -> Told<'a> {
    let (squares, missing) = (vec![vec![0.0; regions.len()]; plans.len()], vec![false; plans.len()]);
    let mut told = Told { plans, regions, raster: Vec2::ZERO, weighed: (1.0, ByJoin::NONE), squares, missing };
    let view: View = View::new(&subject.scene, Strictness::Strict);
    let strategy = subject.strategy(Stage::BIDIRECTIONAL.techniques(), Heuristic::Balance);
    let length = LONGEST.min(strategy.max_depth as usize);
    let storage = || -> Vec<Option<WalkVertex<'_, View, ByJoin>>> { (1..length).map(|_| None).collect() };
    let (mut camera_path, mut light_path) = (storage(), storage());
    for index in 0..TOLD {
        for pixel in 0..SIZE * SIZE {
            let mut numbers = Independent::new(77, u64::from(pixel), u64::from(index));
            numbers.seek(Walk::Camera, 0);
            let [dx, dy] = numbers.next_pair();
            told.raster = Vec2::new((pixel % SIZE) as f32 + dx, (pixel / SIZE) as f32 + dy);
            sample(&view, &strategy, &mut numbers, told.raster, &mut camera_path, &mut light_path, &mut told);
        }
    }
    told
}

/// The mean of a region, at least as noisy as is told of so many samples of every pixel.
fn mean(pictures: &Pictures, region: Region, squares: f64, samples: u32) -> Estimate {
    let found = pictures.mean(region, &[0, 1, 2]);
    let pixels = f64::from(region[2] * region[3]);
    let error = (squares / (f64::from(TOLD) * f64::from(samples * BATCHES))).sqrt() / pixels;
    Estimate { error: found.error.max(error), ..found }
}

/// Holds every plan against the bidirectional one, but for those that are said to miss something.
fn every_plan_agrees(file: &str) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let defines = [("res".to_owned(), SIZE.to_string())];
    let library = Library::new(vec![root.join("plugins/prebuilt")]);
    let description = load::load(&root.join(file), &defines, &library).expect("a scene").description;
    let subject = Subject { scene: Scene::new(&description).expect("a scene"), description };
    let effects = Effects::of(&subject.description, &subject.scene);
    presets_make_one_image(file, &subject);
    let max_depth = subject.description.integrator.max_depth;
    let mut plans = vec![Stage::BIDIRECTIONAL];
    plans.extend(open(&effects, max_depth));
    plans.extend([Named::Path, Named::Light].into_iter().filter_map(Named::stage));
    let pictures = |stage: &Stage, seed: u64, samples: u32| -> Pictures {
        subject.pictures(subject.strategy(stage.techniques(), Heuristic::Balance), samples, seed)
    };
    let reference = pictures(&plans[0], 1, 2 * SAMPLES);
    let regions: Vec<Region> = [reference.whole()].into_iter().chain(reference.blocks()).collect();
    let told = told(&subject, &plans, &regions);
    let missed = |stage: &Stage| gaps(&effects, stage, max_depth).into_iter().map(|gap| (gap.class, gap.lights)).collect::<Vec<_>>();
    let out_of_reach = missed(&plans[0]);
    let (mut compared, mut failures) = (0, Vec::new());
    for (i, stage) in plans.iter().enumerate().skip(1) {
        let name = words::stage(stage);
        if told.missing[i] {
            let said = missed(stage).iter().any(|class| !out_of_reach.contains(class));
            assert!(said, "{file}: {name} misses something, and nobody says so");
            println!("{file}: {name} misses something");
            continue;
        }
        compared += 1;
        let found = pictures(stage, 2 + i as u64, SAMPLES);
        let mut worst = (0.0, String::new());
        for (at, &region) in regions.iter().enumerate() {
            let (a, b) = (mean(&found, region, told.squares[i][at], SAMPLES), mean(&reference, region, told.squares[0][at], 2 * SAMPLES));
            let apart = a.minus(&b);
            let share = apart.deviation(a.mean) / threshold(regions.len(), apart.degrees);
            if worse(worst.0, share) != worst.0 {
                let [difference, doubt] = [apart.mean, apart.error].map(|x| 100.0 * x / b.mean);
                worst = (share, format!("{difference:+.2} % ± {doubt:.2} % in {region:?}, {share:.2} of what chance explains"));
            }
        }
        let line = format!("{file}: {name}: {}", worst.1);
        println!("{line}");
        if worst.0.is_nan() || worst.0 > 1.0 {
            leave(&file.replace('/', "_"), &[(&format!("plan_{i}"), &found.average()), ("bdpt", &reference.average())]);
            failures.push(line);
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    assert!(compared > 0, "{file}: no plan to compare");
}

/// The preset that a render takes and the one for any scene, bit for bit.
fn presets_make_one_image(file: &str, subject: &Subject) {
    let scene = Scene::new(&subject.description).expect("a scene").with_effects(bidir_kernel::Effects::ALL);
    let full = Subject { scene, description: subject.description.clone() };
    for named in [Named::Path, Named::Light, Named::Bdpt] {
        let techniques = named.stage().expect("a plan").techniques();
        let [chosen, full] =
            [subject, &full].map(|subject| subject.image(&subject.job(subject.strategy(techniques, Heuristic::Balance), 1, 9)));
        let bits = |image: &Image| image.pixels.iter().flatten().map(|value| value.to_bits()).collect::<Vec<_>>();
        assert!(bits(&chosen) == bits(&full), "{file}: {}", named.name());
    }
}

macro_rules! scenes {
    ($($name:ident: $file:literal,)*) => {
        $(
            #[test]
            fn $name() {
                every_plan_agrees($file);
            }
        )*
    };
}

scenes! {
    ajar: "examples/scenes/ajar.xml",
    bulb: "examples/scenes/bulb.xml",
    caustic_sphere: "examples/scenes/caustic_sphere/scene.xml",
    coated_mirror: "plugins/coated_mirror/scene.xml",
    cornell: "examples/scenes/cornell/scene.xml",
    cove: "examples/scenes/cove.xml",
    dof_glossy: "examples/scenes/dof_glossy/scene.xml",
    env_glossy: "examples/scenes/env_glossy/scene.xml",
    gobo: "plugins/gobo/scene.xml",
    ies_spot: "plugins/ies_spot/scene.xml",
    lantern: "examples/scenes/lantern.xml",
    leaf: "plugins/leaf/scene.xml",
    ring: "examples/scenes/ring.xml",
    sky: "plugins/sky/scene.xml",
    tank: "examples/scenes/tank.xml",
    thin_film: "plugins/thin_film/scene.xml",
    torchiere: "examples/scenes/torchiere/scene.xml",
    veach_mis: "examples/scenes/veach_mis/scene.xml",
    velvet: "plugins/velvet/scene.xml",
    welcome: "examples/scenes/welcome.xml",
}
