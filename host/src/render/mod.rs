//! Rendering: samples of a scene onto a film, pass by pass.
//!
//! A pass is a whole number of samples for every pixel. What is decided while rendering (to stop, to report) is decided between passes,
//! so that an image depends on scene, seed, samples and plan alone.

mod director;
mod features;
mod numbers;
mod passes;
mod pilot;
mod share;
mod watch;

use std::{
    sync::atomic::{AtomicBool, Ordering},
    time::{Duration, Instant},
};

use bidir_kernel::{Strategy, WalkVertex};

use crate::{
    plugin::{Fault, Quarantine, Strictness},
    scene::{Scene, view::RayCounts},
};

pub use director::{Always, Auto, Director, Given, Leg};
pub use features::features;
pub use numbers::{Numbers, Scrambled, Sobol, Source};
pub use passes::pass_end;
pub(crate) use pilot::{Nobody, scattered};
pub use share::{Canvas, Told};
pub use watch::Watch;

use share::{Share, Stop, Worked};

/// The longest path that stored light vertices are kept for where the scene sets no limit; longer ones are left to s = 0 and s = 1.
pub const LONGEST_JOINED: u32 = 64;

/// When a render is done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// After this many samples per pixel.
    Samples(u32),
    /// After this much wall-clock time, at the end of a pass.
    Time(Duration),
    /// Once the estimated relMSE is at most this.
    Error(f64),
}

/// What to do.
#[derive(Clone, Copy, Debug)]
pub struct Job {
    /// Techniques and depths.
    pub strategy: Strategy,
    /// Of the random numbers.
    pub seed: u64,
    /// Which random numbers.
    pub numbers: Numbers,
    /// At least 1.
    pub threads: usize,
    /// When to stop.
    pub target: Target,
    /// Pixels in a row of the whole image: a pixel's numbers do not depend on the crop window.
    pub width: u32,
    /// What a plugin's bad answer does.
    pub strictness: Strictness,
}

/// Where a render stands, or ended.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Status {
    /// Samples of every pixel that are on the film.
    pub samples: u32,
    /// Wall-clock time spent.
    pub elapsed: Duration,
    /// CPU time of the render threads, added up.
    pub cpu: Duration,
    /// Rays cast.
    pub rays: RayCounts,
    /// Whether it was interrupted.
    pub interrupted: bool,
    /// Whether a render thread broke down; what was on the film before stays.
    pub failed: bool,
    /// What plugins answered that could not be.
    pub quarantine: Quarantine,
    /// The plugin that broke off, and so ended the render; what was on the film before stays, and so do the tiles under way elsewhere.
    pub fault: Option<Fault>,
}

/// Renders onto an empty `film`. After each pass, `report` is told where the render stands and answers the estimated error,
/// where it knows one; raising `interrupt` ends the render after the sample under way.
pub fn render<S: Canvas>(scene: &Scene, film: &S, job: &Job, interrupt: &AtomicBool, report: impl FnMut(&Status) -> Option<f64>) -> Status {
    directed(scene, film, job, &mut Always, interrupt, report)
}

/// [`render`] with a director, who says between passes what is sampled next.
pub fn directed<S: Canvas>(
    scene: &Scene,
    film: &S,
    job: &Job,
    director: &mut impl Director,
    interrupt: &AtomicBool,
    mut report: impl FnMut(&Status) -> Option<f64>,
) -> Status {
    let start = Instant::now();
    let mut status = Status::default();
    // Seconds per sample of the last pass.
    let mut pace = None;
    let last = match job.target {
        Target::Samples(samples) => samples,
        Target::Time(_) | Target::Error(_) => u32::MAX,
    };
    while status.samples < last {
        let mut leg = director.next(scene, job, &status, film);
        status.elapsed = start.elapsed();
        let job = &Job { strategy: leg.strategy, ..*job };
        let end = pass_end(status.samples).min(last).min(leg.end).min(affordable(&status, job.target, pace));
        let before = (status.samples, status.elapsed);
        let Some(claimed) = run(scene, film, job, &mut leg, end, Some(interrupt), &mut status) else {
            status.failed = true;
            return status;
        };
        if status.fault.is_some() {
            status.elapsed = start.elapsed();
            report(&status);
            return status;
        }
        if claimed < end || interrupt.load(Ordering::Relaxed) {
            // Finish the sample that some pixels have already.
            run(scene, film, job, &mut leg, claimed, None, &mut status);
            status.samples = if status.fault.is_some() { status.samples } else { claimed };
            status.interrupted = true;
        } else {
            status.samples = end;
        }
        if let Some(watch) = leg.watch {
            director.watched(watch);
        }
        status.elapsed = start.elapsed();
        pace = Some((status.elapsed - before.1).as_secs_f64() / f64::from((status.samples - before.0).max(1)));
        let error = report(&status);
        let done = match job.target {
            Target::Samples(_) => false,
            Target::Time(limit) => status.elapsed.as_secs_f64() + 0.5 * pace.unwrap_or(0.0) >= limit.as_secs_f64(),
            Target::Error(goal) => error.is_some_and(|error| error <= goal),
        };
        if done || status.interrupted {
            break;
        }
    }
    status
}

/// How many samples will be on the film when the time is up, at the last pass's pace; at least one more.
fn affordable(status: &Status, target: Target, pace: Option<f64>) -> u32 {
    match (target, pace) {
        (Target::Time(limit), Some(pace)) => {
            let more = (limit.saturating_sub(status.elapsed).as_secs_f64() / pace) as u32;
            status.samples.saturating_add(more.max(1))
        }
        _ => u32::MAX,
    }
}

/// Renders every unit whose sample is below `end`; returns the samples of which a unit was begun. `None` if no thread could do any work.
/// The leg's watch takes what the samples bring, if the canvas can tell.
fn run<S: Canvas>(
    scene: &Scene,
    film: &S,
    job: &Job,
    leg: &mut Leg,
    end: u32,
    interrupt: Option<&AtomicBool>,
    status: &mut Status,
) -> Option<u32> {
    let faulted = AtomicBool::new(false);
    let stop = Stop { interrupt, faulted: &faulted };
    let share = Share { scene, film, job, weight: leg.weight, end, stop, watch: leg.watch.as_ref() };
    let workers: Vec<Option<Worked>> = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..job.threads.max(1)).map(|_| scope.spawn(|| S::share(share))).collect();
        workers.into_iter().map(|worker| worker.join().ok()).collect()
    });
    let mut begun = status.samples;
    for worked in workers {
        let worked = worked?;
        begun = begun.max(worked.begun);
        status.cpu += worked.cpu;
        status.rays += worked.rays;
        status.quarantine.merge(worked.quarantine);
        status.fault = status.fault.take().or(worked.fault);
        if let Some((all, one)) = leg.watch.as_mut().zip(worked.watch) {
            all.record.merge(&one.record);
        }
    }
    Some(begun)
}

/// Storage for one walk's vertices: enough for the longest path that is joined.
pub(crate) fn storage<'s, V: bidir_kernel::Scene, R>(strategy: &Strategy) -> Vec<Option<WalkVertex<'s, V, R>>> {
    let length = strategy.max_depth.min(LONGEST_JOINED).saturating_sub(1);
    (0..length).map(|_| None).collect()
}
