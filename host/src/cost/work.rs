//! Everything that is measured, one after the other, within the budget.

use std::{
    path::{Path, PathBuf},
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    time::{Duration, Instant},
};

use super::{
    Settings,
    curve::{self, Bias, Method},
    journal::{Entry, Header, Journal},
    knobs::{self, Knob},
    pace::{self, Paces, Pass},
    reference::Reference,
    report::{Held, Report, Shown},
    spent::{self, Spent},
    subject::{self, Snapshot, Subject},
    techniques::{self, Techniques},
};
use crate::{
    error::{Error, Result},
    image::{
        Image,
        read::picture,
        write::{self, Layers},
    },
    plan::{Named, Plan, Stage, words},
    render::{Always, Auto, Director, Given, Target},
    scene::{Scene, description::Description},
};

/// What parts of the budget are for: both halves of the reference, the methods, the knobs; the rest is for what is looked at once.
const REFERENCE: f64 = 0.35;
const METHODS: f64 = 0.35;
const KNOBS: f64 = 0.2;
/// Of the rest, what the pilot that finds the plan may take, and the render that is taken apart.
const PILOT: f64 = 0.015;
const APART: f64 = 0.03;

/// Renders of each method, at least and at most.
const SEEDS: [f64; 2] = [2.0, 4.0];
/// A method's render has so many samples per pixel at least, before there are more renders of it.
const SAMPLES: f64 = 8.0;
/// Renders of each setting of a knob.
const SETTING_SEEDS: u64 = 4;
/// A setting takes about so many times as long as the base, in the mean.
const DEARER: f64 = 2.2;
/// Seeds of the reference's halves and of what is measured, far from each other and from those that a reference is rendered with by hand.
const HALVES: u64 = 1 << 40;
const MEASURED: u64 = 1 << 41;

/// Measures what there is time for. What was measured before in the same folder, for the same scene and budget, is not measured again.
/// `progress` is told what comes next, and which share of the budget is spent.
///
/// # Errors
/// If files cannot be read or written, a reference is of another size, or a plugin broke off where nothing can be measured without it: in
/// the reference, or in a first look at every technique. What was measured before is kept, and what fails later is left out and said.
pub fn measure(
    subject: &Subject,
    sandboxed: Option<(Description, Scene)>,
    settings: &Settings,
    interrupt: &Arc<AtomicBool>,
    progress: &mut dyn FnMut(&str, f64),
) -> Result<Report> {
    let crop = subject.description.film.crop;
    let header = Header {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        scene: settings.digest.clone(),
        size: [crop.width, crop.height],
        threads: subject.threads,
        seed: subject.seed,
        budget: settings.budget.as_secs_f64(),
        references: settings.references.clone(),
    };
    let journal = Journal::open(&settings.folder, &header)?;
    let before = journal.spent();
    let mut work =
        Work { subject, settings, interrupt, progress, journal, start: Instant::now(), before, cut_off: false, out_of_time: false };
    let result = work.everything(sandboxed);
    let spent = work.start.elapsed().as_secs_f64();
    work.journal.add(Entry::Spent(spent))?;
    result
}

/// What is under way.
struct Work<'a> {
    subject: &'a Subject,
    settings: &'a Settings,
    interrupt: &'a Arc<AtomicBool>,
    progress: &'a mut dyn FnMut(&str, f64),
    journal: Journal,
    start: Instant,
    /// Seconds that were spent before.
    before: f64,
    /// Whether something is missing that the same command would go on with.
    cut_off: bool,
    /// Whether there was no time for something.
    out_of_time: bool,
}

impl Work<'_> {
    fn budget(&self) -> f64 {
        self.settings.budget.as_secs_f64()
    }

    fn spent(&self) -> f64 {
        self.before + self.start.elapsed().as_secs_f64()
    }

    /// Whether there is still time for something that takes about so many seconds; half of it at least.
    fn begin(&mut self, what: &str, seconds: f64) -> bool {
        let may = !self.interrupt.load(Ordering::Relaxed) && self.spent() + 0.5 * seconds <= self.budget();
        if may {
            let share = self.spent() / self.budget();
            (self.progress)(what, share);
        } else if self.interrupt.load(Ordering::Relaxed) {
            self.cut_off = true;
        } else {
            self.out_of_time = true;
        }
        may
    }

    /// What came of something that is left out of the report where it fails: a plugin may break off in one render and not in another.
    fn unless_failed<T>(&mut self, what: &str, result: Result<T>) -> Result<Option<T>> {
        let failed = result.map_err(|error| format!("{what}: {error}"));
        if let Err(words) = &failed {
            self.journal.add(Entry::Failed { what: what.to_owned(), words: words.clone() })?;
        }
        Ok(failed.ok())
    }

    /// Whether that failed before.
    fn failed(&self, what: &str) -> bool {
        self.journal.entries().iter().any(|entry| matches!(entry, Entry::Failed { what: known, .. } if known == what))
    }

    /// What there is time for, and whether that was all.
    fn everything(&mut self, sandboxed: Option<(Description, Scene)>) -> Result<Report> {
        let mut report = Report::blank(self.subject, self.budget());
        self.fill(&mut report, sandboxed)?;
        (report.interrupted, report.out_of_time) = (self.cut_off, self.out_of_time);
        let failed = |entry: &Entry| if let Entry::Failed { words, .. } = entry { Some(words.clone()) } else { None };
        report.left_out = self.journal.entries().iter().filter_map(failed).collect();
        report.spent = self.spent();
        Ok(report)
    }

    fn fill(&mut self, report: &mut Report, sandboxed: Option<(Description, Scene)>) -> Result<()> {
        let Some(reference) = self.reference()? else { return Ok(()) };
        let [width, height] = reference.size();
        if (report.width, report.height) != (width, height) {
            let thing = format!("the reference has {width}×{height} pixels, and the scene's film {}×{}", report.width, report.height);
            return Err(Error::new(thing, "render both at one size"));
        }
        report.reference = Some(Held { words: reference.words.clone(), given: reference.given, relmse: reference.relmse() });
        self.save("reference", &reference.image())?;
        report.images = self.images(&[], &reference);
        let Some((stage, card, pace)) = self.plan()? else { return Ok(()) };
        report.plan = card;
        let slice = self.budget() * METHODS / f64::from(METHOD_NAMES.len() as u32);
        report.seeds = (slice / (SAMPLES * pace)).clamp(SEEDS[0], SEEDS[1]) as u64;
        report.methods = self.methods(&reference, report.seeds, slice / report.seeds as f64)?;
        report.prices = report.methods.iter().map(Method::prices).collect();
        report.crossings = curve::crossings(&report.methods);
        let time = self.time(&stage, pace);
        report.time = self.unless_failed("where the time goes", time)?.flatten();
        let pyramid = self.techniques(pace);
        report.pyramid = self.unless_failed("the techniques apart", pyramid)?.flatten();
        report.knobs = self.knobs(&reference, &stage, sandboxed)?;
        report.images = self.images(&report.methods, &reference);
        Ok(())
    }

    /// The reference that is given, or the two halves, rendered if they are not there; `None` if there was no time for them.
    fn reference(&mut self) -> Result<Option<Reference>> {
        if !self.settings.references.is_empty() {
            return Reference::given(&self.settings.references).map(Some);
        }
        let slice = 0.5 * REFERENCE * self.budget();
        let mut samples = None;
        for half in 0..2 {
            let known = self.journal.find(|entry| match entry {
                Entry::Half { half: known, spp, .. } if *known == half && half_file(&self.settings.folder, half).is_file() => Some(*spp),
                _ => None,
            });
            if let Some(known) = known {
                samples = Some(known);
                continue;
            }
            let name = if half == 0 { "the reference, first half" } else { "the reference, second half" };
            if !self.begin(name, 0.0) {
                return Ok(None);
            }
            let target = samples.map_or(Target::Time(Duration::from_secs_f64(slice)), Target::Samples);
            let (image, status) = self.subject.render(&Stage::BIDIRECTIONAL, HALVES + half as u64, target, self.interrupt)?;
            if status.interrupted {
                self.cut_off = true;
                return Ok(None);
            }
            samples = Some(status.samples);
            self.save_as(&half_file(&self.settings.folder, half), &image)?;
            self.journal.add(Entry::Half { half, spp: status.samples, seconds: status.elapsed.as_secs_f64() })?;
        }
        let halves = [picture(&half_file(&self.settings.folder, 0))?, picture(&half_file(&self.settings.folder, 1))?];
        let words = format!("two halves by bdpt, {} samples per pixel each", samples.unwrap_or(0));
        Ok(Some(Reference::rendered(halves, samples.unwrap_or(0), words)))
    }

    /// What `auto` chooses, its card, and the wall-clock seconds of a sample of every technique for all pixels.
    fn plan(&mut self) -> Result<Option<(Stage, Vec<String>, f64)>> {
        let known = self.journal.find(|entry| match entry {
            Entry::Plan { stage, card, pace } => Some((*stage, card.clone(), *pace)),
            _ => None,
        });
        if known.is_some() {
            return Ok(known);
        }
        if !self.begin("the plan", 0.0) {
            return Ok(None);
        }
        let mut auto = Auto::new(&self.subject.description, &self.subject.effects);
        let manner = self.subject.manner(&Stage::BIDIRECTIONAL);
        let slice = METHODS * self.budget() / METHOD_NAMES.len() as f64 / SEEDS[1];
        let job = self.subject.job(&manner, 0, Target::Time(Duration::from_secs_f64(slice)));
        auto.look(&self.subject.scene, &job, Duration::from_secs_f64(PILOT * self.budget()), u64::MAX / 2, 0);
        let stage = auto.plan().last().copied().unwrap_or(Stage::BIDIRECTIONAL);
        let card = auto.choice().map_or_else(|| vec![format!("auto: {}", words::stage(&stage))], words::card);
        let (_, status) = self.subject.render(&Stage::BIDIRECTIONAL, 0, Target::Samples(2), self.interrupt)?;
        if status.interrupted {
            self.cut_off = true;
            return Ok(None);
        }
        let pace = status.elapsed.as_secs_f64().max(1e-9) / f64::from(status.samples.max(1));
        self.journal.add(Entry::Plan { stage, card: card.clone(), pace })?;
        Ok(Some((stage, card, pace)))
    }

    /// All methods, all seeds: each seed of every method before the next.
    fn methods(&mut self, reference: &Reference, seeds: u64, slice: f64) -> Result<Vec<Method>> {
        for seed in 0..seeds {
            for name in METHOD_NAMES {
                let known = self.of_method(name.name());
                if known.iter().any(|run| run.seed == seed)
                    || self.failed(&render_of(name, seed))
                    || !self.begin(&format!("{} of {seeds}", render_of(name, seed)), slice)
                {
                    continue;
                }
                // All of a method's have as many samples as the first had time for.
                let samples = known.iter().find_map(|run| run.snapshots.last()).map(|last| last.spp);
                let target = samples.map_or(Target::Time(Duration::from_secs_f64(slice)), Target::Samples);
                self.method(name, seed, target, reference)?;
            }
        }
        let all = METHOD_NAMES.map(|name| (name, self.of_method(name.name())));
        let passes = || all.iter().flat_map(|(_, runs)| runs).flat_map(|run| &run.passes);
        let paces = Paces::of(passes(), self.yard().unwrap_or(0.0));
        let methods = all.into_iter().filter_map(|(name, runs)| {
            let words = runs.first()?.words.clone();
            let lasts: Vec<&Snapshot> = runs.iter().filter_map(|run| run.snapshots.last()).collect();
            let biases: Vec<f64> = lasts.iter().map(|last| last.errors.bias).collect();
            let declared = name.stage().and_then(|stage| self.subject.missed(&stage));
            let samples = lasts.iter().map(|last| last.spp).min().unwrap_or(0);
            let kept = |run: &Measured| (run.seed, paces.kept(&run.snapshots, &run.passes));
            let points = curve::points(&runs.iter().map(kept).collect::<Vec<_>>());
            let bias = Bias { interval: reference.interval(&biases, samples), declared };
            Some(Method { name: name.name(), words, points, bias })
        });
        Ok(methods.collect())
    }

    fn method(&mut self, name: Named, seed: u64, target: Target, reference: &Reference) -> Result<()> {
        let subject = self.subject;
        let mut auto = Auto::new(&subject.description, &subject.effects);
        let run = match name.stage() {
            Some(stage) => {
                let mut given = Given { plan: Plan::fixed(stage), integrator: subject.description.integrator.clone() };
                self.watched(&mut given, &stage, seed, target, reference)
            }
            None => self.watched(&mut auto, &Stage::BIDIRECTIONAL, seed, target, reference),
        };
        let Some(run) = self.unless_failed(&render_of(name, seed), run)?.flatten() else { return Ok(()) };
        let words = match name.stage() {
            Some(stage) => words::stage(&stage),
            None => auto.plan().stages.iter().map(words::stage).collect::<Vec<_>>().join("; then "),
        };
        if seed == 0 {
            self.save(name.name(), &run.image)?;
        }
        self.journal.add(Entry::Run { method: name.name().to_owned(), seed, snapshots: run.snapshots, passes: run.passes, words })
    }

    /// A render to its end; `None` if it was interrupted.
    fn watched(
        &mut self,
        director: &mut impl Director,
        stage: &Stage,
        seed: u64,
        target: Target,
        reference: &Reference,
    ) -> Result<Option<subject::Run>> {
        let run = self.subject.watch(&self.subject.manner(stage), director, MEASURED + seed, target, reference, self.interrupt)?;
        self.cut_off |= run.status.interrupted;
        Ok((!run.status.interrupted).then_some(run))
    }

    fn of_method(&self, name: &str) -> Vec<Measured> {
        let of = |entry: &Entry| match entry {
            Entry::Run { method, seed, snapshots, passes, words } if method == name => {
                Some(Measured { seed: *seed, snapshots: snapshots.clone(), passes: passes.clone(), words: words.clone() })
            }
            _ => None,
        };
        self.journal.entries().iter().filter_map(of).collect()
    }

    /// What a yardstick takes on a quick machine, as far as methods' renders tell.
    fn yard(&self) -> Option<f64> {
        let of = |entry: &Entry| if let Entry::Run { passes, .. } = entry { passes.clone() } else { Vec::new() };
        pace::yard(&self.journal.entries().iter().flat_map(of).collect::<Vec<_>>())
    }

    /// A render of the plan, taken apart.
    fn time(&mut self, stage: &Stage, pace: f64) -> Result<Option<Spent>> {
        let known = self.journal.find(|entry| if let Entry::Time(time) = entry { Some(time.clone()) } else { None });
        if known.is_some() || self.failed("where the time goes") || !self.begin("where the time goes", 0.0) {
            return Ok(known);
        }
        let samples = (APART * self.budget() / (spent::RENDERS * pace)).clamp(1.0, 4096.0) as u32;
        let time = spent::spent(self.subject, stage, samples, self.interrupt)?;
        if self.interrupt.load(Ordering::Relaxed) {
            self.cut_off = true;
            return Ok(None);
        }
        self.journal.add(Entry::Time(time.clone()))?;
        Ok(Some(time))
    }

    fn techniques(&mut self, pace: f64) -> Result<Option<Techniques>> {
        let known = self.journal.find(|entry| if let Entry::Techniques(all) = entry { Some(all.clone()) } else { None });
        if let Some(known) = known {
            return Ok(known);
        }
        if self.failed("the techniques apart") || !self.begin("the techniques apart", 0.0) {
            return Ok(None);
        }
        let samples = (APART * self.budget() / pace).clamp(1.0, 256.0) as u32;
        let all = techniques::apart(self.subject, samples, self.interrupt)?;
        if self.interrupt.load(Ordering::Relaxed) {
            self.cut_off = true;
            return Ok(None);
        }
        self.journal.add(Entry::Techniques(all.clone()))?;
        Ok(all)
    }

    /// Every setting of every knob, each with as many samples per pixel as the base has time for.
    fn knobs(&mut self, reference: &Reference, base: &Stage, sandboxed: Option<(Description, Scene)>) -> Result<Vec<Knob>> {
        let turns = knobs::turns(self.subject, base, sandboxed);
        let slice = KNOBS * self.budget() / (turns.len() as f64 * SETTING_SEEDS as f64);
        let mut samples = self.journal.find(|entry| match entry {
            Entry::Setting { runs, .. } => runs.first().map(|run| run.spp),
            _ => None,
        });
        let mut settings = Vec::new();
        // The base of every knob is the same.
        let mut base_runs: Option<Vec<Snapshot>> = None;
        for turn in &turns {
            let known = self.journal.find(|entry| match entry {
                Entry::Setting { knob, setting, runs } if knob == turn.knob && *setting == turn.setting => Some(runs.clone()),
                _ => None,
            });
            let known = known.or_else(|| base_runs.clone().filter(|_| turn.base));
            let runs = match known {
                Some(runs) => runs,
                None => {
                    let what = format!("{}: {}", turn.knob, turn.setting);
                    if self.failed(&what) || !self.begin(&what, 0.0) {
                        continue;
                    }
                    if samples.is_none() {
                        let found = self.samples_for(base, slice / DEARER);
                        samples = self.unless_failed(&what, found)?;
                    }
                    let Some(samples) = samples else { continue };
                    let Some(runs) = self.setting(turn, samples, reference)? else { continue };
                    self.journal.add(Entry::Setting { knob: turn.knob.to_owned(), setting: turn.setting.clone(), runs: runs.clone() })?;
                    runs
                }
            };
            if turn.base {
                base_runs = Some(runs.clone());
            }
            settings.extend(knobs::setting(turn, &runs, reference).map(|setting| (turn.knob, setting)));
        }
        Ok(knobs::together(settings))
    }

    fn setting(&mut self, turn: &knobs::Turn, samples: u32, reference: &Reference) -> Result<Option<Vec<Snapshot>>> {
        let (subject, interrupt, yard) = (self.subject, self.interrupt, self.yard());
        let runs = turn.render(subject, |manner| {
            let mut runs = Vec::new();
            for seed in 0..SETTING_SEEDS {
                let run = subject.watch(manner, &mut Always, MEASURED + seed, Target::Samples(samples), reference, interrupt)?;
                runs.extend(Some(run).filter(|run| !run.status.interrupted));
            }
            let passes = || runs.iter().flat_map(|run| &run.passes);
            let paces = Paces::of(passes(), yard.or_else(|| pace::yard(passes())).unwrap_or(0.0));
            let last = |run: &subject::Run| paces.kept(&run.snapshots, &run.passes).last().copied();
            Ok(runs.iter().filter_map(last).collect::<Vec<_>>())
        });
        let Some(runs) = self.unless_failed(&format!("{}: {}", turn.knob, turn.setting), runs)? else { return Ok(None) };
        let whole = runs.len() as u64 == SETTING_SEEDS;
        self.cut_off |= !whole;
        Ok(whole.then_some(runs))
    }

    /// How many samples per pixel take about so many wall-clock seconds.
    fn samples_for(&self, stage: &Stage, seconds: f64) -> Result<u32> {
        let (_, status) = self.subject.render(stage, 0, Target::Time(Duration::from_secs_f64(0.5 * seconds)), self.interrupt)?;
        let pace = status.elapsed.as_secs_f64() / f64::from(status.samples.max(1));
        Ok((seconds / pace.max(1e-9)).clamp(1.0, 1e6) as u32)
    }

    fn images(&self, methods: &[Method], reference: &Reference) -> Vec<Shown> {
        let shown = |name: &str, words: String| Shown { name: name.to_owned(), words, file: image_file(&self.settings.folder, name) };
        let mut all = vec![shown("reference", reference.words.clone())];
        for method in methods {
            let last = self.of_method(method.name).into_iter().find(|run| run.seed == 0).and_then(|run| run.snapshots.last().copied());
            all.extend(last.map(|last| shown(method.name, format!("{} samples per pixel, {}", last.spp, curve::seconds(last.wall)))));
        }
        all.retain(|shown| shown.file.is_file());
        all
    }

    fn save(&self, name: &str, image: &Image) -> Result<()> {
        self.save_as(&image_file(&self.settings.folder, name), image)
    }

    fn save_as(&self, file: &Path, image: &Image) -> Result<()> {
        write::write(file, &Layers::from(image))
    }
}

/// A render of a method.
struct Measured {
    seed: u64,
    snapshots: Vec<Snapshot>,
    passes: Vec<Pass>,
    words: String,
}

/// The methods that are held against each other.
const METHOD_NAMES: [Named; 4] = [Named::Path, Named::Light, Named::Bdpt, Named::Auto];

fn render_of(name: Named, seed: u64) -> String {
    format!("{}, render {}", name.name(), seed + 1)
}

fn image_file(folder: &Path, name: &str) -> PathBuf {
    folder.join(format!("{name}.exr"))
}

fn half_file(folder: &Path, half: usize) -> PathBuf {
    folder.join(if half == 0 { "reference.a.exr" } else { "reference.b.exr" })
}
