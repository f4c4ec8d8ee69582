//! How good the plans are that `auto` chooses: `cargo bench -p bidir --bench plans [-- SCENE]... [seconds=4] [seeds=8]`.
//!
//! Every plan that a scene leaves open, and `path`, `light` and `bdpt`, render it for about the same CPU time on one thread, in turn, and
//! so does `auto`, whose pilots are within its time. Efficiency is 1/(relMSE · CPU seconds), the error against a reference in two halves;
//! all of it twice, with the whole error and with the error trimmed by 0.1 %, which forgives fireflies. What a sample takes is told by many
//! short renders, all plans in turn, each held against a yardstick beside it, a still shorter render that is always the same: other work
//! makes everything slower by half, for seconds at a time. All times are those of a machine where the yardstick is as quick as it ever was.
//! The best fixed plan is chosen by one half of the seeds and scored by the other, both ways: chosen and scored by the same ones it would be
//! the luckiest. Plans that are far behind after a few short renders, or after two whole ones, are not rendered on. Behind the measured
//! figures of each plan stands what `auto`'s last pilot of the first seed predicted.

use std::{
    cell::Cell,
    path::Path,
    sync::atomic::{AtomicBool, Ordering},
    time::Duration,
};

use bidir::{
    compare::against_halves,
    film::Film,
    image::{Image, read},
    load,
    plan::{
        Named, Stage,
        choice::{Candidate, Choice, open},
        effects::Effects,
        words,
    },
    plugin::{Library, Strictness},
    render::{self, Always, Auto, Director, Job, Leg, Numbers, Status, Target, Told, Watch},
    scene::{Scene, description::Description},
};
use cpu_time::ProcessTime;

/// Scenes of `examples/scenes` with references from elsewhere, at 128×128 pixels.
const REFERENCED: [&str; 6] = ["cornell", "torchiere", "caustic_sphere", "veach_mis", "env_glossy", "dof_glossy"];
/// Scenes that are rendered for long, at 64×64 pixels.
const OWN: [&str; 14] = [
    "examples/scenes/ajar.xml",
    "examples/scenes/bulb.xml",
    "examples/scenes/cove.xml",
    "examples/scenes/lantern.xml",
    "examples/scenes/ring.xml",
    "examples/scenes/tank.xml",
    "examples/scenes/welcome.xml",
    "plugins/velvet/scene.xml",
    "plugins/thin_film/scene.xml",
    "plugins/coated_mirror/scene.xml",
    "plugins/leaf/scene.xml",
    "plugins/sky/scene.xml",
    "plugins/gobo/scene.xml",
    "plugins/ies_spot/scene.xml",
];
/// How many times as long as one picture each half of a reference of these takes.
const LONG: f64 = 12.0;
/// Samples per pixel of a render that is short, and how many of them every plan has with each seed.
const SHORT: u32 = 4;
const TURNS: usize = 3;
/// Samples per pixel of the yardstick.
const YARD: u32 = 2;
/// Plans that have less than this share of the best one's efficiency after a first look are not looked at again, and those that have less
/// than that after a second one no further.
const HOPELESS: [f64; 2] = [0.7, 0.85];
/// Seeds that the second look is at.
const SECOND: u64 = 2;
/// The errors that plans are scored by.
const ERRORS: [&str; 2] = ["relMSE", "trimmed relMSE"];
/// Times that seeds are drawn anew for the intervals.
const DRAWS: u64 = 1000;

fn main() {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    let number = |name: &str, usual: f64| {
        let given = words.iter().find_map(|word| word.strip_prefix(name)?.strip_prefix('='));
        given.map_or(usual, |value| value.parse().expect("a number"))
    };
    let (seconds, seeds) = (number("seconds", 4.0), number("seeds", 8.0) as u64);
    let names: Vec<&String> = words.iter().filter(|word| !word.contains('=')).collect();
    let wanted = |name: &str| names.is_empty() || names.iter().any(|part| name.contains(part.as_str()));
    let mut found = Vec::new();
    for name in REFERENCED.into_iter().chain(OWN).filter(|name| wanted(name)) {
        found.push(Subject::new(name, seconds).measure(seconds, seeds));
    }
    for (by, error) in ERRORS.into_iter().enumerate() {
        println!("\n{:<34}{:>10}{:>18}{:>12}{:>12}", format!("auto, by {error}, over"), "best", "90 %", "path", "bdpt");
        for Found { name, scores } in &found {
            let Score { best, over } = scores[by];
            println!("{name:<34}{:>10.3}{:>9.3} – {:.3}{:>12.2}{:>12.2}", best[1], best[0], best[2], over[0], over[1]);
        }
        let mean = |of: &dyn Fn(&Score) -> f64| (found.iter().map(|one| of(&one.scores[by]).ln()).sum::<f64>() / found.len() as f64).exp();
        let [best, path, bdpt] = [mean(&|f| f.best[1]), mean(&|f| f.over[0]), mean(&|f| f.over[1])];
        println!("{:<34}{best:>10.3}{:>18}{path:>12.2}{bdpt:>12.2}", "geometric mean", "");
    }
}

struct Subject {
    name: &'static str,
    description: Description,
    scene: Scene,
    effects: Effects,
    halves: [Image; 2],
    /// CPU seconds of the quickest yardstick.
    yard: Cell<f64>,
}

/// What came out for a scene.
struct Found {
    name: &'static str,
    /// By each error.
    scores: [Score; ERRORS.len()],
}

struct Score {
    /// `auto`'s efficiency over that of the best fixed plan: the lower end of the interval, the figure, the upper end.
    best: [f64; 3],
    /// Over that of path and of bdpt.
    over: [f64; 2],
}

/// One picture.
#[derive(Clone, Copy)]
struct Run {
    errors: [f64; ERRORS.len()],
    samples: u32,
}

/// The pictures of one plan, seed by seed.
struct Entrant {
    stage: Stage,
    /// What a sample took in each of its short renders, in yardsticks.
    paces: Vec<f64>,
    /// CPU seconds of a sample, by all of them.
    time: f64,
    runs: Vec<Run>,
    /// Whether it is still in the running, and whether `auto` chose it.
    hopeful: bool,
    chosen: bool,
}

/// A picture by the plan that `auto` chose.
struct Chosen {
    run: Run,
    stages: Vec<Stage>,
    /// CPU seconds of its first pilot, and of all that came after it beside samples.
    pilots: f64,
    choice: Option<Choice>,
}

impl Subject {
    fn new(name: &'static str, seconds: f64) -> Self {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let referenced = REFERENCED.contains(&name);
        let file = if referenced { root.join("examples/scenes").join(name).join("scene.xml") } else { root.join(name) };
        let defines = [("res".to_owned(), if referenced { "128" } else { "64" }.to_owned())];
        let library = Library::new(vec![root.join("plugins/prebuilt")]);
        let description = load::load(&file, &defines, &library).expect("a scene").description;
        let scene = Scene::new(&description).expect("a scene");
        let effects = Effects::of(&description, &scene);
        let mut subject =
            Self { name, description, scene, effects, halves: [1, 2].map(|_| Image::black(1, 1)), yard: Cell::new(f64::INFINITY) };
        subject.halves = if referenced {
            ["reference.a.exr", "reference.b.exr"].map(|half| picture(&file.with_file_name(half)))
        } else {
            [1, 2].map(|half| subject.long(LONG * seconds, half << 32))
        };
        subject
    }

    /// Half a reference: the broadest plan, which leaves nothing rare.
    fn long(&self, seconds: f64, seed: u64) -> Image {
        let target = Target::Time(Duration::from_secs_f64(seconds));
        self.render(&mut Always, &self.job(&Stage::BIDIRECTIONAL, seed, target), &AtomicBool::new(false)).0
    }

    fn job(&self, stage: &Stage, seed: u64, target: Target) -> Job {
        Job {
            strategy: stage.strategy(&self.description.integrator),
            seed,
            numbers: Numbers::default(),
            threads: 1,
            target,
            width: self.description.film.width,
            strictness: Strictness::Strict,
        }
    }

    fn render(&self, director: &mut impl Director, job: &Job, interrupt: &AtomicBool) -> (Image, f64, u32) {
        let film = Film::new(&self.description.film).expect("a film");
        let clock = ProcessTime::now();
        let status = render::directed(&self.scene, &film, job, director, interrupt, |_| None);
        assert!(status.fault.is_none(), "{:?}", status.fault);
        (film.develop(), clock.elapsed().as_secs_f64(), status.samples)
    }

    fn run(&self, director: &mut impl Director, job: &Job, interrupt: &AtomicBool) -> Run {
        let (image, _, samples) = self.render(director, job, interrupt);
        let halves = [&self.halves[0], &self.halves[1]];
        let found = against_halves(&image, halves).expect("one size");
        Run { errors: [found.relmse, found.relmse_trimmed].map(|error| error.max(f64::MIN_POSITIVE)), samples }
    }

    /// A fixed plan, with as many samples as take about so long at that pace.
    fn fixed(&self, entrant: &Entrant, seed: u64, seconds: f64) -> Run {
        self.run(&mut Always, &self.job(&entrant.stage, seed, Target::Samples(samples(seconds, entrant.time))), &AtomicBool::new(false))
    }

    /// How long the yardstick takes now.
    fn yardstick(&self) -> f64 {
        let path = Named::Path.stage().expect("a plan");
        let (_, seconds, _) = self.render(&mut Always, &self.job(&path, 0, Target::Samples(YARD)), &AtomicBool::new(false));
        self.yard.set(self.yard.get().min(seconds));
        seconds
    }

    /// Short renders of all these, in turn.
    fn pace(&self, entrants: &mut [Entrant]) {
        for turn in 0..TURNS {
            for Entrant { stage, paces, .. } in entrants.iter_mut().filter(|entrant| entrant.hopeful || entrant.chosen) {
                let before = self.yardstick();
                let (_, seconds, samples) =
                    self.render(&mut Always, &self.job(stage, turn as u64, Target::Samples(SHORT)), &AtomicBool::new(false));
                paces.push(seconds / f64::from(samples) / (0.5 * (before + self.yardstick())));
            }
        }
        for Entrant { paces, time, .. } in entrants {
            paces.sort_by(f64::total_cmp);
            *time = self.yard.get() * paces[paces.len() / 2];
        }
    }

    /// Looks, and renders with what is left of the time.
    fn auto(&self, entrants: &[Entrant], seed: u64, seconds: f64) -> Chosen {
        let mut auto = Auto::new(&self.description, &self.effects);
        let job = self.job(&Stage::BIDIRECTIONAL, seed, Target::Time(Duration::from_secs_f64(seconds)));
        let (before, clock) = (self.yardstick(), ProcessTime::now());
        auto.begin(&self.scene, &job);
        let pilot = clock.elapsed().as_secs_f64();
        let pilot = pilot * self.yard.get() / (0.5 * (before + self.yardstick()));
        let stage = *auto.plan().last().expect("a plan");
        let interrupt = AtomicBool::new(false);
        let mut budgeted =
            Budgeted { auto: &mut auto, subject: self, entrants, seconds: seconds - pilot, more: 0.0, begun: None, interrupt: &interrupt };
        let run = self.run(&mut budgeted, &Job { strategy: stage.strategy(&self.description.integrator), ..job }, &interrupt);
        let more = budgeted.more;
        let stages = auto.plan().stages.clone();
        let words: Vec<_> = stages.iter().map(|stage| format!("{} from {}", words::stage(stage), stage.from)).collect();
        println!("  seed {seed}: {} after {:.0} ms, watching {:.0} ms", words.join("; then "), 1e3 * pilot, 1e3 * more);
        Chosen { run, stages, pilots: pilot + more, choice: auto.choice().cloned() }
    }

    fn measure(&self, seconds: f64, seeds: u64) -> Found {
        println!("\n{}", self.name);
        let named = [Named::Path, Named::Bdpt, Named::Light].map(|named| named.stage().expect("a plan"));
        let mut stages = open(&self.effects, self.description.integrator.max_depth);
        stages.extend(named);
        let mut number = 0;
        let all = stages.clone();
        stages.retain(|stage| {
            number += 1;
            !all[number..].iter().any(|later| same(stage, later))
        });
        let mut entrants: Vec<Entrant> = stages
            .into_iter()
            .map(|stage| Entrant { stage, paces: Vec::new(), time: 0.0, runs: Vec::new(), hopeful: true, chosen: false })
            .collect();
        self.pace(&mut entrants);
        for seed in [101, 102] {
            entrants.iter_mut().for_each(|entrant| entrant.runs.push(self.fixed(entrant, seed, seconds / 4.0)));
        }
        drop_the_hopeless(&mut entrants, HOPELESS[0]);
        let auto: Vec<Chosen> = (0..seeds).map(|seed| self.auto(&entrants, seed, seconds)).collect();
        for entrant in &mut entrants {
            entrant.runs.clear();
            entrant.chosen = auto.iter().any(|chosen| chosen.stages.iter().any(|stage| same(stage, &entrant.stage)));
            entrant.hopeful |= entrant.chosen || named[..2].contains(&entrant.stage);
        }
        entrants.retain(|entrant| entrant.hopeful);
        for seed in 0..seeds {
            if seed == SECOND {
                drop_the_hopeless(&mut entrants, HOPELESS[1]);
            }
            for entrant in entrants.iter_mut().filter(|entrant| entrant.hopeful) {
                entrant.runs.push(self.fixed(entrant, seed, seconds));
            }
            self.pace(&mut entrants);
        }
        self.report(&entrants, &auto, &named)
    }

    fn report(&self, entrants: &[Entrant], auto: &[Chosen], named: &[Stage]) -> Found {
        let all: Vec<usize> = (0..auto.len()).collect();
        let auto = &Judged { entrants, chosen: auto };
        let mut order: Vec<&Entrant> = entrants.iter().collect();
        order.sort_by(|a, b| b.efficiency(0, &all).total_cmp(&a.efficiency(0, &all)));
        println!("  {:<72}{:>12}{:>12}{:>9}{:>9}{:>12}", "", "efficiency", "trimmed", "error·n", "trimmed", "cost");
        let pixels = f64::from(self.description.film.crop.width) * f64::from(self.description.film.crop.height);
        println!("  {:<72}{:>12.4e}{:>12.4e}", "auto", auto.efficiency(0, &all), auto.efficiency(1, &all));
        for entrant in order {
            let predicted =
                auto.chosen[0].choice.as_ref().and_then(|choice| choice.candidates.iter().find(|other| same(&other.stage, &entrant.stage)));
            let of = |value: &dyn Fn(&Candidate) -> f64| predicted.map_or(f64::NAN, value);
            println!(
                "  {:<72}{:>12.4e}{:>12.4e}{:>9.4}{:>9.4}{:>9.0} ns, predicted{:>12.4e}{:>9.4}{:>9.0} ns",
                words::stage(&entrant.stage) + if entrant.stage.next_event == 0.0 { " (no next event)" } else { "" },
                entrant.efficiency(0, &all),
                entrant.efficiency(1, &all),
                entrant.error(0, &all),
                entrant.error(1, &all),
                1e9 * entrant.time / pixels,
                of(&|c| 1e9 / pixels * c.efficiency()),
                of(&|c| c.error.unwrap_or(f64::INFINITY)),
                of(&|c| c.cost),
            );
        }
        Found { name: self.name, scores: std::array::from_fn(|by| auto.score(by, &all, named)) }
    }
}

/// `auto` with as many samples as take about so long, each at the pace of the plan it is taken by.
struct Budgeted<'a> {
    auto: &'a mut Auto,
    subject: &'a Subject,
    entrants: &'a [Entrant],
    /// For all samples.
    seconds: f64,
    /// What watched ones took more than others, and looking back at them took, by the clock.
    more: f64,
    /// When watched samples were begun, with which, by which pace, beside what yardstick.
    begun: Option<(ProcessTime, u32, f64, f64)>,
    interrupt: &'a AtomicBool,
}

impl Director for Budgeted<'_> {
    fn next(&mut self, scene: &Scene, job: &Job, status: &Status, film: &dyn Told) -> Leg {
        if let Some((clock, from, pace, before)) = self.begun.take() {
            let seconds = clock.elapsed().as_secs_f64();
            let seconds = seconds * self.subject.yard.get() / (0.5 * (before + self.subject.yardstick()));
            self.more += seconds - f64::from(status.samples - from) * pace;
        }
        let clock = ProcessTime::now();
        let leg = self.auto.next(scene, job, status, film);
        self.more += clock.elapsed().as_secs_f64();
        let stages = &self.auto.plan().stages;
        let left = self.seconds - self.more - spent(stages, status.samples, self.entrants);
        let pace = stages.last().map_or(f64::INFINITY, |stage| pace(stage, self.entrants));
        let more = (left / pace).round().max(0.0) as u32;
        self.interrupt.store(more == 0, Ordering::Relaxed);
        if leg.watch.is_some() {
            let yardstick = self.subject.yardstick();
            self.begun = Some((ProcessTime::now(), status.samples, pace, yardstick));
        }
        Leg { end: leg.end.min(status.samples + more.max(1)), ..leg }
    }

    fn watched(&mut self, watch: Watch) {
        self.auto.watched(watch);
    }
}

/// CPU seconds of a sample by a plan.
fn pace(stage: &Stage, entrants: &[Entrant]) -> f64 {
    entrants.iter().find(|entrant| same(&entrant.stage, stage)).expect("an open plan").time
}

/// CPU seconds of so many samples by these stages.
fn spent(stages: &[Stage], samples: u32, entrants: &[Entrant]) -> f64 {
    let ends = stages.iter().skip(1).map(|stage| stage.from).chain([samples]);
    stages.iter().zip(ends).map(|(stage, end)| f64::from(end - stage.from) * pace(stage, entrants)).sum()
}

/// `auto`'s pictures, each at the price of its plan.
struct Judged<'a> {
    entrants: &'a [Entrant],
    chosen: &'a [Chosen],
}

impl Judged<'_> {
    fn score(&self, by: usize, all: &[usize], named: &[Stage]) -> Score {
        let efficiency = self.efficiency(by, all);
        let against = |name: &Stage| {
            let other = self.entrants.iter().find(|entrant| same(&entrant.stage, name));
            efficiency / other.map_or(f64::NAN, |other| other.efficiency(by, all))
        };
        let mut random = Random(3);
        let halves = [0, 1].map(|first| all.iter().copied().skip(first).step_by(2).collect::<Vec<_>>());
        let mut drawn: Vec<f64> = (0..DRAWS)
            .map(|_| self.over_best(by, &halves, &mut |half| half.iter().map(|_| half[random.below(half.len())]).collect()))
            .collect();
        drawn.sort_by(f64::total_cmp);
        let at = |share: f64| drawn[(share * (drawn.len() - 1) as f64) as usize];
        let best = [at(0.05), self.over_best(by, &halves, &mut |half| half.to_vec()), at(0.95)];
        let score = Score { best, over: [against(&named[0]), against(&named[1])] };
        println!(
            "  by {}, auto over the best fixed plan {:.3} ({:.3} – {:.3}), over path {:.2}, over bdpt {:.2}",
            ERRORS[by], best[1], best[0], best[2], score.over[0], score.over[1]
        );
        score
    }

    /// `auto` over the fixed plan that is best by one half of the seeds, scored by the other; the geometric mean of both ways.
    fn over_best(&self, by: usize, halves: &[Vec<usize>; 2], draw: &mut dyn FnMut(&[usize]) -> Vec<usize>) -> f64 {
        let mut one = |chosen_by: &[usize], scored_by: &[usize]| {
            let to_the_end = self.entrants.iter().filter(|entrant| entrant.hopeful);
            let best = to_the_end.max_by(|a, b| a.efficiency(by, chosen_by).total_cmp(&b.efficiency(by, chosen_by)));
            let seeds = draw(scored_by);
            best.map_or(f64::NAN, |best| self.efficiency(by, &seeds) / best.efficiency(by, &seeds))
        };
        (one(&halves[0], &halves[1]) * one(&halves[1], &halves[0])).sqrt()
    }

    /// Of its plans' samples and its pilots. Samples are taken to cost what they did when the same plan was fixed: the other half of
    /// what two renders differ in would be what else the machine did.
    fn efficiency(&self, by: usize, seeds: &[usize]) -> f64 {
        let products = seeds.iter().map(|&seed| {
            let Chosen { run, stages, pilots, .. } = &self.chosen[seed];
            run.errors[by] * (pilots + spent(stages, run.samples, self.entrants))
        });
        seeds.len() as f64 / products.sum::<f64>()
    }
}

impl Entrant {
    /// An error times samples, in the mean of those seeds that it was looked at with.
    fn error(&self, by: usize, seeds: &[usize]) -> f64 {
        let products = seeds.iter().filter_map(|&seed| self.runs.get(seed)).map(|run| run.errors[by] * f64::from(run.samples));
        let (sum, number) = products.fold((0.0, 0), |(sum, number), product| (sum + product, number + 1));
        sum / f64::from(number)
    }

    fn efficiency(&self, by: usize, seeds: &[usize]) -> f64 {
        1.0 / (self.error(by, seeds) * self.time)
    }
}

/// Whether two stages differ only in what a pinhole cannot do.
fn same(a: &Stage, b: &Stage) -> bool {
    let counts = |stage: &Stage| [stage.next_event, stage.connection, stage.lens_splat];
    counts(a) == counts(b) && (a.light_hit == b.light_hit || a.techniques().camera_walk() == b.techniques().camera_walk())
}

/// Those are hopeless that have less than that share of the efficiency of the best one, by either error.
fn drop_the_hopeless(entrants: &mut [Entrant], share: f64) {
    let looks: Vec<_> = entrants
        .iter()
        .map(|entrant| {
            let all: Vec<usize> = (0..entrant.runs.len()).collect();
            [0, 1].map(|by| entrant.efficiency(by, &all))
        })
        .collect();
    let best = looks.iter().fold([0.0_f64; 2], |best, look| [0, 1].map(|by| best[by].max(look[by])));
    for (entrant, look) in entrants.iter_mut().zip(looks) {
        entrant.hopeful = look.iter().zip(best).any(|(look, best)| *look >= share * best);
    }
}

/// How many samples take about so many seconds.
fn samples(seconds: f64, pace: f64) -> u32 {
    (seconds / pace).round().max(2.0) as u32
}

fn picture(file: &Path) -> Image {
    read::picture(file).expect("a reference")
}

struct Random(u64);

impl Random {
    fn below(&mut self, count: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % count
    }
}
