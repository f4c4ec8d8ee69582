//! Who says what is sampled next: a plan that is given, or one that a pilot finds and looks after.

use std::time::{Duration, Instant};

use bidir_kernel::{Join, Strategy};

use super::{Job, Status, Target, pilot::Pilot};
use crate::{
    plan::{
        Plan, Stage,
        choice::{Choice, Seen, Until, broadest, choose, open},
        effects::Effects,
    },
    scene::{
        Scene,
        description::{Description, Integrator},
    },
};

/// What comes next.
#[derive(Clone, Copy, Debug)]
pub struct Leg {
    /// How samples are taken.
    pub strategy: Strategy,
    /// The first sample of every pixel that is not taken so.
    pub end: u32,
}

/// Says between passes what comes next.
pub trait Director {
    /// From the sample on that stands in `status`; `error` estimates the relMSE of what is on the film.
    fn next(&mut self, scene: &Scene, job: &Job, status: &Status, error: &dyn Fn() -> Option<f64>) -> Leg;
}

/// The job's own strategy from beginning to end.
#[derive(Clone, Copy, Debug)]
pub struct Always;

impl Director for Always {
    fn next(&mut self, _: &Scene, job: &Job, _: &Status, _: &dyn Fn() -> Option<f64>) -> Leg {
        Leg { strategy: job.strategy, end: u32::MAX }
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
    fn next(&mut self, _: &Scene, job: &Job, status: &Status, _: &dyn Fn() -> Option<f64>) -> Leg {
        match self.plan.at(status.samples) {
            Some((stage, end)) => Leg { strategy: stage.strategy(&self.integrator), end },
            None => Leg { strategy: job.strategy, end: u32::MAX },
        }
    }
}

/// The share of a render's time that pilots may take.
const SHARE: f64 = 0.02;

/// Of that, what they look for; the rest is for choosing.
const LOOKING: f64 = 0.75;

/// Pixels that the first pilot looks at, at least and at most.
const FIRST: [f64; 2] = [32.0, 1_024.0];

/// About how many camera paths one of the pilot's pixels costs.
const PATHS_PER_PIXEL: f64 = 150.0;

/// Samples per pixel that a render is taken to need where nobody knows.
const UNKNOWN: f64 = 256.0;

/// What the render itself saw is held against the pilot when it has taken so many times as long as the pilot, and then whenever it has
/// taken `AGAIN` times as long.
const HELD_AGAINST: f64 = 5.0;

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
    /// What the render saw, while it had one stage.
    seen: Option<Seen>,
    /// Wall-clock time of all pilots.
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
            seen: None,
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
        let under_way = self.plan.last().copied();
        if self.open.len() > 1 {
            let (evidence, costs) = (self.pilot.evidence(), self.pilot.costs());
            // Where nothing varies that was seen, there may be something that was not.
            self.choice = choose(&self.open, evidence, &costs, self.until(job), under_way.as_ref(), self.seen.as_ref())
                .filter(|choice| choice.chosen.error.is_some_and(|error| error > 0.0))
                .map(|choice| choice.with_plugins(&self.pilot.plugins()));
        }
        let chosen = match &self.choice {
            Some(choice) => choice.chosen.stage,
            None => broadest(&self.open).unwrap_or(Stage::of(&job.strategy.techniques)),
        };
        if under_way.is_none_or(|stage| stage.techniques() != chosen.techniques()) {
            self.plan.stages.push(Stage { from, ..chosen });
        }
    }

    /// Holds what the render saw against the pilot. Of a film with several stages nobody knows which it owes its noise to; and where some
    /// kind of join is not made, the noise may be what that would take away.
    fn hold_against(&mut self, job: &Job, status: &Status, error: &dyn Fn() -> Option<f64>) {
        let start = Instant::now();
        if let [stage] = *self.plan.stages.as_slice()
            && Join::ALL.iter().all(|&join| stage.effort(join) > 0.0 || self.open.iter().all(|open| open.effort(join) == 0.0))
            && let Some(error) = error()
        {
            self.seen = Some(Seen { stage, samples: f64::from(status.samples), error });
            self.choose(job, status.samples);
        }
        self.held_against = status.elapsed.mul_f64(AGAIN);
        self.elapsed += start.elapsed();
    }

    /// How long the render goes on, as far as that is known.
    fn until(&self, job: &Job) -> Until {
        match job.target {
            Target::Samples(samples) => Until::Samples(f64::from(samples)),
            Target::Time(time) => Until::Nanoseconds(time.as_nanos() as f64 * job.threads as f64 / self.pixels),
            Target::Error(_) => Until::Samples(UNKNOWN),
        }
    }

    /// Looks for the first time, for about as long as a render with this target should.
    pub fn begin(&mut self, scene: &Scene, job: &Job) {
        let (time, pixels) = self.first(job.target);
        self.look(scene, job, time, pixels, 0);
        self.again = self.elapsed.mul_f64(2.0 / SHARE);
        self.held_against = self.elapsed.mul_f64(HELD_AGAINST);
    }

    /// How long the first pilot may take on each thread, and how many pixels it may look at.
    fn first(&self, target: Target) -> (Duration, u64) {
        let some = |pixels: f64| pixels.clamp(FIRST[0], FIRST[1]) as u64;
        match target {
            Target::Samples(samples) => (Duration::MAX, some(SHARE * f64::from(samples) * self.pixels / PATHS_PER_PIXEL)),
            Target::Time(time) => (time.mul_f64(SHARE), FIRST[1] as u64),
            Target::Error(_) => (Duration::MAX, 4 * FIRST[0] as u64),
        }
    }
}

impl Director for Auto {
    fn next(&mut self, scene: &Scene, job: &Job, status: &Status, error: &dyn Fn() -> Option<f64>) -> Leg {
        if self.plan.stages.is_empty() {
            self.begin(scene, job);
        } else if self.open.len() > 1 {
            if status.elapsed >= self.held_against && status.samples >= TELLING {
                self.hold_against(job, status, error);
            }
            if status.elapsed >= self.again {
                let time = status.elapsed.mul_f64(SHARE).saturating_sub(self.elapsed);
                self.look(scene, job, time, u64::MAX / 2, status.samples);
                self.again = status.elapsed.mul_f64(AGAIN);
            }
        }
        let stage = self.plan.last().copied().unwrap_or(Stage::of(&job.strategy.techniques));
        Leg { strategy: stage.strategy(&self.integrator), end: u32::MAX }
    }
}
