//! Who says what is sampled next: a plan that is given, or one that a pilot finds and looks after.

use std::time::{Duration, Instant};

use bidir_kernel::Strategy;

use super::{Job, Status, Target, Told, pilot::Pilot, watch::Watch};
use crate::{
    plan::{
        Plan, Stage,
        choice::{Choice, Known, Seen, Until, broadest, choose, is_full, open},
        effects::Effects,
    },
    scene::{
        Scene,
        description::{Description, Integrator},
    },
};

/// What comes next.
#[derive(Clone, Debug)]
pub struct Leg {
    /// How samples are taken.
    pub strategy: Strategy,
    /// How much each of them counts in the image.
    pub weight: f64,
    /// The first sample of every pixel that is not taken so.
    pub end: u32,
    /// What of them the director wants to see.
    pub watch: Option<Watch>,
}

/// Says between passes what comes next.
pub trait Director {
    /// From the sample on that stands in `status`; `film` tells of what is on it.
    fn next(&mut self, scene: &Scene, job: &Job, status: &Status, film: &dyn Told) -> Leg;

    /// What it wanted to see, after the pass.
    fn watched(&mut self, watch: Watch) {
        let _ = watch;
    }
}

/// The job's own strategy from beginning to end.
#[derive(Clone, Copy, Debug)]
pub struct Always;

impl Director for Always {
    fn next(&mut self, _: &Scene, job: &Job, _: &Status, _: &dyn Told) -> Leg {
        Leg { strategy: job.strategy, weight: 1.0, end: u32::MAX, watch: None }
    }
}

/// A plan that is given.
#[derive(Clone, Debug)]
pub struct Given {
    /// The plan.
    pub plan: Plan,
    /// How far paths go.
    pub integrator: Integrator,
}

impl Director for Given {
    fn next(&mut self, _: &Scene, job: &Job, status: &Status, _: &dyn Told) -> Leg {
        match self.plan.at(status.samples) {
            Some((stage, end)) => Leg { strategy: stage.strategy(&self.integrator), weight: stage.weight, end, watch: None },
            None => Leg { strategy: job.strategy, weight: 1.0, end: u32::MAX, watch: None },
        }
    }
}

/// The share of a render's time that pilots may take.
const SHARE: f64 = 0.01;

/// Of that, what they look for; the rest is for choosing.
const LOOKING: f64 = 0.9;

/// Pixels that the first pilot looks at, at least and at most.
const FIRST: [u64; 2] = [32, 1_024];

/// Where the share is not used up by the fewest pixels, the pilot looks on if so many times as long as they took is left.
const WORTH_MORE: f64 = 0.25;

/// Samples per pixel that a render is taken to need where nobody knows.
const UNKNOWN: f64 = 256.0;

/// What the render itself saw is held against the pilot when it has taken so many times as long as the pilot, and then whenever it has
/// taken `AGAIN` times as long. Until the second time it is watched.
const LOOKS: [f64; 2] = [5.0, 15.0];

/// Before it was watched for so long, a plan is left only for one that is so many times as good.
const SURE: f64 = 1.25;

/// How many of the largest contributions that were watched are not taken for frequent: to be sure, and else.
const SPARED: [f64; 2] = [4.0, 0.5];

/// From so many samples per pixel on the film tells how bright the image is, and samples are watched.
const BRIGHT: u32 = 2;

/// Plans with less than this share of the efficiency of what the pilot would choose are not watched for.
const HOPELESS: f64 = 0.2;

/// A plan that makes every kind of join, and so shows what other plans would bring, is watched first, if the pilot takes it to be at least
/// so good as the one that it would choose.
const WATCHED: f64 = 0.5;

/// Samples per pixel from which a film tells its error.
const TELLING: u32 = 8;

/// Pilots come again when a render has taken so many times as long as when the last one came.
const AGAIN: f64 = 4.0;

/// A plan that a pilot finds before the first sample, and looks after as the render goes on.
#[derive(Debug)]
pub struct Auto {
    open: Vec<Stage>,
    pilot: Pilot,
    plan: Plan,
    choice: Option<Choice>,
    integrator: Integrator,
    /// Pixels of the image.
    pixels: f64,
    /// When the next pilot comes, in time that the render took.
    again: Duration,
    /// When what the render saw is held against the pilot next.
    held_against: Duration,
    /// What its first samples brought, if they can be watched.
    watch: Option<Watch>,
    /// Whether they are.
    watching: bool,
    /// When that began, in time that the render took, and whether what they brought was held against the pilot once.
    watched_from: Duration,
    looked_once: bool,
    /// What the first pilot took.
    first: Duration,
    /// Whether nobody has held it against the film yet, where nothing is watched.
    doubtful: bool,
    /// What the render said of its error, while it had one stage.
    seen: Option<Seen>,
    /// How many times as noisy as told it was while it was watched.
    before: f64,
    /// Wall-clock time of all pilots, and of looking at what the render brought.
    pub elapsed: Duration,
}

impl Auto {
    /// For a scene with these effects.
    pub fn new(description: &Description, effects: &Effects) -> Self {
        let crop = description.film.crop;
        let max_depth = description.integrator.max_depth;
        Self {
            open: open(effects, max_depth),
            pilot: Pilot::new(&description.film, effects, max_depth),
            plan: Plan { stages: Vec::new() },
            choice: None,
            integrator: description.integrator.clone(),
            pixels: f64::from(crop.width) * f64::from(crop.height),
            again: Duration::MAX,
            held_against: Duration::MAX,
            watch: None,
            watching: false,
            watched_from: Duration::ZERO,
            looked_once: false,
            first: Duration::ZERO,
            doubtful: false,
            seen: None,
            before: 1.0,
            elapsed: Duration::ZERO,
        }
    }

    /// The plan so far: what `--plan` repeats.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// The last choice, if there was one to make.
    pub fn choice(&self) -> Option<&Choice> {
        self.choice.as_ref()
    }

    /// Looks, and chooses; `from` is the first sample of the stage that may begin.
    pub fn look(&mut self, scene: &Scene, job: &Job, time: Duration, pixels: u64, from: u32) {
        let start = Instant::now();
        if self.open.len() > 1 {
            self.pilot.look(scene, job, time.mul_f64(LOOKING), pixels);
        }
        self.choose(job, from);
        self.elapsed += start.elapsed();
    }

    /// Chooses by what was seen so far.
    fn choose(&mut self, job: &Job, from: u32) {
        self.choice = self.found(job, 1.0);
        self.go_on(job, from);
    }

    /// The best plan by what was seen so far; the one under way, unless another is so many times as good.
    fn found(&self, job: &Job, sure: f64) -> Option<Choice> {
        if self.open.len() == 1 {
            return None;
        }
        let (evidence, costs, record) = (self.pilot.evidence(), &self.pilot.costs(), self.watch.as_ref().map(|watch| &watch.record));
        let known = Known { evidence, costs, record, seen: self.seen.as_ref(), sure };
        // Where nothing varies that was seen, there may be something that was not.
        choose(&self.open, &known, self.until(job), self.plan.last())
            .filter(|choice| choice.chosen.error.is_some_and(|error| error > 0.0))
            .map(|choice| choice.with_plugins(&self.pilot.plugins()))
    }

    /// Goes on as was chosen, or if there was nothing to choose by, with what has the most ways to make a path.
    fn go_on(&mut self, job: &Job, from: u32) {
        let under_way = self.plan.last().copied();
        let chosen = match &self.choice {
            Some(choice) => choice.chosen.stage,
            None => broadest(&self.open).unwrap_or(Stage::of(&job.strategy.techniques)),
        };
        if under_way.is_none_or(|stage| stage.techniques() != chosen.techniques()) {
            let weight = under_way.map_or(1.0, |before| before.weight * self.choice.as_ref().map_or(1.0, |choice| choice.worth(&before)));
            self.plan.stages.push(Stage { from, weight, ..chosen });
            // What was watched for was told of samples by the stage before.
            self.watching = false;
        }
    }

    /// Goes on as what was watched so far says, if it is clear: however few the largest contributions are taken to be.
    fn go_on_if_sure(&mut self, job: &Job, from: u32) {
        let mut found = SPARED.map(|spared| {
            if let Some(watch) = &mut self.watch {
                watch.record.spare(spared);
            }
            self.found(job, SURE)
        });
        let stages = found.each_ref().map(|choice| choice.as_ref().map(|choice| choice.chosen.stage.techniques()));
        if stages[0] == stages[1] {
            self.choice = found[1].take();
            self.go_on(job, from);
        }
    }

    /// Whether the plan under way makes every kind of join.
    fn is_full(&self) -> bool {
        self.plan.last().is_some_and(|stage| is_full(stage, &self.open))
    }

    /// Whether what was seen of a plan that leaves some kind of join out may be a reason to leave it.
    fn is_doubted(&self) -> bool {
        let times = self.seen.as_ref().map(|seen| seen.times(self.pilot.evidence(), None));
        self.choice.as_ref().zip(times).is_some_and(|(choice, times)| choice.is_doubted(times, &self.open))
    }

    /// Begins with a plan that can be watched, if there is one that is not much worse than what was chosen; where no light paths are worth
    /// their price, nothing is tried.
    fn watch(&mut self) {
        let Some(stage) = self.plan.stages.last_mut() else { return };
        if stage.techniques().light_walks() == 0.0 {
            return;
        }
        let full = |stage: &Stage| is_full(stage, &self.open);
        if let Some(choice) = self.choice.as_ref().filter(|_| !full(stage)) {
            let best = choice.candidates.iter().find(|candidate| full(&candidate.stage));
            if let Some(best) = best.filter(|best| best.efficiency() >= WATCHED * choice.chosen.efficiency()) {
                *stage = Stage { from: stage.from, ..best.stage };
            }
        }
        self.watching = full(stage);
    }

    /// What the next samples are watched for.
    fn watch_for(&mut self, film: &dyn Told) -> Option<Watch> {
        let start = Instant::now();
        self.pilot.see(&film.picture()?);
        let stage = self.plan.stages.last()?;
        let watch = match &mut self.watch {
            Some(watch) => watch,
            none => {
                let hopeful = |choice: &Choice| -> Vec<Stage> {
                    let least = HOPELESS * choice.chosen.efficiency();
                    choice.candidates.iter().filter(|candidate| candidate.efficiency() >= least).map(|candidate| candidate.stage).collect()
                };
                let plans = self.choice.as_ref().map_or_else(|| self.open.clone(), hopeful);
                none.insert(self.pilot.watch(stage, &plans))
            }
        };
        watch.record.see(self.pilot.evidence());
        watch.record.spare(SPARED[1]);
        let watch = watch.blank();
        self.elapsed += start.elapsed();
        Some(watch)
    }

    /// Holds what the render saw against the pilot. Of a film with several stages nobody knows which it owes its noise to.
    fn hold_against(&mut self, job: &Job, status: &Status, film: &dyn Told) {
        let start = Instant::now();
        if let [stage] = *self.plan.stages.as_slice() {
            if let Some(picture) = film.picture() {
                self.pilot.see(&picture);
            }
            let error = if status.samples >= TELLING { film.error() } else { None };
            let mut seen = error.map(|error| Seen { stage, samples: f64::from(status.samples), error, before: self.before });
            if let Some((seen, watch)) = seen.as_mut().zip(self.watch.as_ref().filter(|_| self.watching)) {
                // All that is on the film was watched, or about: what it is noisier than told is so whatever the plan.
                seen.before = seen.times(self.pilot.evidence(), Some(&watch.record));
                self.before = seen.before;
            }
            self.seen = seen;
        }
        let (full, stages) = (self.is_full(), self.plan.stages.len());
        let early = self.watching && !self.looked_once;
        if early {
            // Of what nobody has seen yet there is nothing to be sure of.
            if self.watch.as_ref().is_some_and(|watch| watch.record.samples() > 0) {
                self.go_on_if_sure(job, status.samples);
            }
        } else if self.watching || stages == 1 && (full || self.is_doubted()) {
            self.choose(job, status.samples);
        }
        if early && self.plan.stages.len() == stages {
            self.looked_once = true;
            self.held_against = self.watched_from + self.first.mul_f64(LOOKS[1]);
        } else if !full && self.is_full() {
            // One that leaves some kind of join out was noisier than the pilot knew: it knew too little.
            self.watch = None;
            self.watching = true;
            self.watched_from = status.elapsed;
            self.looked_once = false;
            self.held_against = self.watched_from + self.first.mul_f64(LOOKS[0]);
        } else {
            self.watching = false;
            self.held_against = status.elapsed.mul_f64(AGAIN);
        }
        self.elapsed += start.elapsed();
    }

    /// How long the render goes on, as far as that is known.
    fn until(&self, job: &Job) -> Until {
        match job.target {
            Target::Samples(samples) => Until::Samples(f64::from(samples)),
            Target::Time(time) => Until::Nanoseconds(time.as_nanos() as f64 * job.threads.max(1) as f64 / self.pixels),
            Target::Error(_) => Until::Samples(UNKNOWN),
        }
    }

    /// Seconds that the render is likely to take.
    fn lasts(&self, job: &Job) -> f64 {
        let per_pixel = match self.until(job) {
            Until::Samples(samples) => samples * self.plan.last().map_or(0.0, |stage| self.pilot.costs().of(stage).max(0.0)),
            Until::Nanoseconds(time) => time,
        };
        1e-9 * per_pixel * self.pixels / job.threads.max(1) as f64
    }

    /// Looks for the first time, for about as long as a render with this target should.
    pub fn begin(&mut self, scene: &Scene, job: &Job) {
        match job.target {
            Target::Time(time) => self.look(scene, job, time.mul_f64(SHARE), FIRST[1], 0),
            Target::Samples(_) | Target::Error(_) => {
                // A few pixels tell how long it will take.
                self.look(scene, job, Duration::MAX, FIRST[0], 0);
                let left = Duration::try_from_secs_f64(SHARE * self.lasts(job)).unwrap_or_default().saturating_sub(self.elapsed);
                if self.open.len() > 1 && left > self.elapsed.mul_f64(WORTH_MORE) {
                    self.plan.stages.clear();
                    self.look(scene, job, left, FIRST[1] - FIRST[0], 0);
                }
            }
        }
        self.first = self.elapsed;
        self.again = self.elapsed.mul_f64(2.0 / SHARE);
        self.held_against = self.elapsed.mul_f64(LOOKS[0]);
        // What ends sooner would have nothing of it.
        if self.open.len() > 1 && self.lasts(job) > 2.0 * LOOKS[1] * self.first.as_secs_f64() {
            self.watch();
            self.doubtful = !self.watching;
        }
    }
}

impl Director for Auto {
    fn next(&mut self, scene: &Scene, job: &Job, status: &Status, film: &dyn Told) -> Leg {
        if self.plan.stages.is_empty() {
            self.begin(scene, job);
        } else if self.open.len() > 1 {
            let stages = self.plan.stages.len();
            if self.doubtful && status.samples >= TELLING {
                self.hold_against(job, status, film);
                self.doubtful = false;
            } else if status.elapsed >= self.held_against {
                self.hold_against(job, status, film);
            }
            // Of a stage that has not begun there is nothing to say.
            if self.plan.stages.len() == stages && status.elapsed >= self.again {
                let time = status.elapsed.mul_f64(SHARE).saturating_sub(self.elapsed);
                self.look(scene, job, time, u64::MAX / 2, status.samples);
                self.again = status.elapsed.mul_f64(AGAIN);
            }
        }
        let stage = self.plan.last().copied().unwrap_or(Stage::of(&job.strategy.techniques));
        let watch = if self.watching && status.samples >= BRIGHT { self.watch_for(film) } else { None };
        Leg { strategy: stage.strategy(&self.integrator), weight: stage.weight, end: u32::MAX, watch }
    }

    fn watched(&mut self, watch: Watch) {
        if let Some(all) = &mut self.watch {
            all.record.merge(&watch.record);
        }
    }
}
