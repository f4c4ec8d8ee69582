//! What samples take on a machine that has no other work.
//!
//! Other work makes everything half as slow again, for seconds or minutes at a time. So renders are cut into short passes, with a
//! yardstick between them: a small render, always the same. A plan's samples take as many yardsticks as in the median of its passes, and a
//! yardstick what it takes when the machine is quick: in the quickest hundredth of all.

use std::{
    cell::RefCell,
    sync::atomic::AtomicBool,
    time::{Duration, Instant},
};

use bidir_kernel::Techniques;
use cpu_time::ProcessTime;
use serde::{Deserialize, Serialize};

use super::subject::{Snapshot, Subject};
use crate::{
    film::Film,
    plan::Stage,
    render::{Director, Job, Leg, Status, Target, Told, Watch, render},
    scene::{
        Scene,
        description::{Crop, FilmSettings},
    },
};

/// About how many wall-clock seconds a pass takes.
const SHORT: f64 = 0.06;
/// Of passes that take less CPU time, little can be told.
const LEAST: f64 = 0.25 * SHORT;
/// The share of yardsticks that are quick.
const QUICK: f64 = 0.01;
/// Edge of the yardstick's image, in pixels.
const YARD: u32 = 32;

/// Some samples of every pixel, one after the other.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pass {
    /// How they were taken, as if from the first sample on.
    pub stage: Stage,
    /// The first sample that is not one of them.
    pub end: u32,
    /// How many they are.
    pub samples: u32,
    /// CPU seconds.
    pub cpu: f64,
    /// Wall-clock seconds.
    pub wall: f64,
    /// CPU seconds of a yardstick, in the mean of those before and after.
    pub yard: f64,
}

/// What a yardstick takes on a quick machine, by all these passes: CPU seconds.
pub fn yard<'a>(passes: impl IntoIterator<Item = &'a Pass>) -> Option<f64> {
    quantile(passes.into_iter().map(|pass| pass.yard).collect(), QUICK)
}

/// What a sample of each plan takes: CPU and wall-clock seconds.
#[derive(Clone, Debug)]
pub struct Paces {
    yard: f64,
    stages: Vec<(Stage, [f64; 2])>,
}

impl Paces {
    /// Told from all these passes, where a yardstick takes so long.
    pub fn of<'a>(passes: impl IntoIterator<Item = &'a Pass>, yard: f64) -> Self {
        let mut stages: Vec<(Stage, Vec<&Pass>)> = Vec::new();
        for pass in passes {
            match stages.iter_mut().find(|(stage, _)| *stage == pass.stage) {
                Some((_, all)) => all.push(pass),
                None => stages.push((pass.stage, vec![pass])),
            }
        }
        Self { yard, stages: stages.into_iter().map(|(stage, all)| (stage, pace(&all, yard))).collect() }
    }

    /// The same moments of a render on a quick machine. What is not samples, a pilot, was done at the pace of the first pass.
    pub fn kept(&self, snapshots: &[Snapshot], passes: &[Pass]) -> Vec<Snapshot> {
        let of = |pass: &Pass| {
            let pace = self.stages.iter().find(|(stage, _)| *stage == pass.stage).map_or([0.0; 2], |(_, pace)| *pace);
            pace.map(|pace| pace * f64::from(pass.samples))
        };
        let quicker = passes.first().map_or(1.0, |pass| self.yard / pass.yard);
        let at = |snapshot: &Snapshot| {
            let before = || passes.iter().filter(|pass| pass.end <= snapshot.spp);
            let time = |all: f64, measured: fn(&Pass) -> f64, clock: usize| {
                let pilots = (all - before().map(measured).sum::<f64>()).max(0.0);
                before().map(|pass| of(pass)[clock]).sum::<f64>() + quicker * pilots
            };
            Snapshot { cpu: time(snapshot.cpu, |pass| pass.cpu, 0), wall: time(snapshot.wall, |pass| pass.wall, 1), ..*snapshot }
        };
        snapshots.iter().map(at).collect()
    }
}

/// Seconds of a sample by these passes.
fn pace(passes: &[&Pass], yard: f64) -> [f64; 2] {
    let long: Vec<&Pass> = passes.iter().copied().filter(|pass| pass.cpu >= LEAST).collect();
    let told = if long.is_empty() { passes } else { &long };
    [|pass: &Pass| pass.cpu, |pass: &Pass| pass.wall].map(|time| {
        let yards = |pass: &&Pass| time(pass) / (f64::from(pass.samples.max(1)) * pass.yard);
        yard * quantile(told.iter().map(yards).collect(), 0.5).unwrap_or(0.0)
    })
}

fn quantile(mut values: Vec<f64>, at: f64) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get((at * values.len() as f64) as usize).copied()
}

/// A small render of a scene by path tracing, on one thread.
pub(super) struct Yardstick<'a> {
    subject: &'a Subject,
    settings: FilmSettings,
    job: Job,
}

impl<'a> Yardstick<'a> {
    /// Of the middle of the image.
    pub(super) fn of(subject: &'a Subject) -> Self {
        let settings = &subject.description.film;
        let Crop { x, y, width, height } = settings.crop;
        let [w, h] = [width, height].map(|length| length.min(YARD));
        let crop = Crop { x: x + (width - w) / 2, y: y + (height - h) / 2, width: w, height: h };
        let job = subject.job(&subject.manner(&Stage::of(&Techniques::PATH)), 0, Target::Samples(1));
        Self { subject, settings: FilmSettings { crop, ..settings.clone() }, job: Job { threads: 1, ..job } }
    }

    /// How long it takes now, in CPU seconds.
    fn take(&self) -> f64 {
        let Ok(film) = Film::new(&self.settings) else { return 1.0 };
        let clock = ProcessTime::now();
        render(&self.subject.scene, &film, &self.job, &AtomicBool::new(false), |_| None);
        clock.elapsed().as_secs_f64().max(1e-6)
    }
}

/// CPU and wall-clock time of this process, less what is not to count.
#[derive(Debug)]
pub(super) struct Clock {
    cpu: ProcessTime,
    wall: Instant,
    forgotten: [Duration; 2],
}

impl Clock {
    pub(super) fn start() -> Self {
        Self { cpu: ProcessTime::now(), wall: Instant::now(), forgotten: [Duration::ZERO; 2] }
    }

    /// Seconds: CPU, wall-clock.
    pub(super) fn read(&self) -> [f64; 2] {
        let [cpu, wall] = self.forgotten;
        [self.cpu.elapsed().saturating_sub(cpu), self.wall.elapsed().saturating_sub(wall)].map(|time| time.as_secs_f64())
    }

    /// What has passed since it was read does not count.
    pub(super) fn forget(&mut self, read: [f64; 2]) {
        let now = self.read();
        for (all, (now, then)) in self.forgotten.iter_mut().zip(now.into_iter().zip(read)) {
            *all += Duration::from_secs_f64((now - then).max(0.0));
        }
    }
}

/// Times a render pass by pass.
pub(super) struct Stopwatch<'a> {
    pub(super) clock: Clock,
    yardstick: Yardstick<'a>,
    /// What the yardstick took last.
    yard: f64,
    /// How the pass under way samples, its first sample, and when it began.
    under_way: Option<(Stage, u32, [f64; 2])>,
    pub(super) passes: Vec<Pass>,
}

impl<'a> Stopwatch<'a> {
    pub(super) fn start(yardstick: Yardstick<'a>) -> Self {
        let yard = yardstick.take();
        Self { clock: Clock::start(), yardstick, yard, under_way: None, passes: Vec::new() }
    }

    /// The pass under way ended with so many samples of every pixel.
    pub(super) fn end(&mut self, end: u32) {
        let Some((stage, from, begun)) = self.under_way.take().filter(|(_, from, _)| end > *from) else { return };
        let now = self.clock.read();
        let before = std::mem::replace(&mut self.yard, self.yardstick.take());
        self.clock.forget(now);
        let yard = 0.5 * (before + self.yard);
        self.passes.push(Pass { stage, end, samples: end - from, cpu: now[0] - begun[0], wall: now[1] - begun[1], yard });
    }

    /// How many samples of every pixel a short pass has.
    fn few(&self) -> u32 {
        let Some(last) = self.passes.last() else { return 1 };
        (SHORT * f64::from(last.samples) / last.wall.max(1e-9)).clamp(1.0, 1e9) as u32
    }
}

/// A director whose legs are cut into short passes; looking back and ahead, a pilot's work, is within none of them.
pub(super) struct Cut<'a, 's, D> {
    pub(super) director: &'a mut D,
    pub(super) stopwatch: &'a RefCell<Stopwatch<'s>>,
}

impl<D: Director> Director for Cut<'_, '_, D> {
    fn next(&mut self, scene: &Scene, job: &Job, status: &Status, film: &dyn Told) -> Leg {
        let leg = self.director.next(scene, job, status, film);
        let mut stopwatch = self.stopwatch.borrow_mut();
        let begun = stopwatch.clock.read();
        stopwatch.under_way = Some((Stage::of(&leg.strategy.techniques), status.samples, begun));
        Leg { end: leg.end.min(status.samples.saturating_add(stopwatch.few())), ..leg }
    }

    fn watched(&mut self, watch: Watch) {
        self.director.watched(watch);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cost::reference::Errors;

    const ERRORS: Errors = Errors { relmse: 0.1, trimmed: 0.1, smape: 0.1, bias: 0.0, fireflies: 0.0 };

    /// Passes of two samples each, and what a yardstick takes beside them.
    fn passes(stage: Stage, times: &[[f64; 2]]) -> Vec<Pass> {
        (1..).zip(times).map(|(i, &[cpu, yard])| Pass { stage, end: 2 * i, samples: 2, cpu, wall: 0.5 * cpu, yard }).collect()
    }

    /// A render whose second half was twice as slow, as was everything then, behind a pilot of a second.
    #[test]
    fn what_else_the_machine_does_is_in_no_time() {
        let passes = passes(Stage::BIDIRECTIONAL, &[[1.0, 0.1], [1.0, 0.1], [2.0, 0.2], [2.0, 0.2]]);
        let snapshot = |(spp, cpu): (u32, f64)| Snapshot { spp, cpu, wall: 0.5 * cpu, errors: ERRORS };
        let snapshots = [(2, 2.0), (4, 3.0), (8, 7.0)].map(snapshot);
        let yard = yard(&passes).unwrap();
        let close = |kept: &[Snapshot], wanted: [f64; 3]| {
            assert!(kept.iter().zip(wanted).all(|(at, cpu)| (at.cpu - cpu).abs() < 1e-9 && (at.wall - 0.5 * cpu).abs() < 1e-9), "{kept:?}");
        };
        close(&Paces::of(&passes, yard).kept(&snapshots, &passes), [2.0, 3.0, 5.0]);
        // On a machine that was never quick, and was at some other time.
        close(&Paces::of(&passes, 0.5 * yard).kept(&snapshots, &passes), [1.0, 1.5, 2.5]);
        // Renders of other plans do not tell what this one's samples take.
        let other = Pass { cpu: 0.1, stage: Stage { connection: 0.5, ..Stage::BIDIRECTIONAL }, ..passes[0] };
        close(&Paces::of(passes.iter().chain([&other, &other, &other, &other, &other]), yard).kept(&snapshots, &passes), [2.0, 3.0, 5.0]);
    }

    #[test]
    fn passes_too_short_for_the_clock_tell_nothing_where_there_are_others() {
        let passes = passes(Stage::BIDIRECTIONAL, &[[1e-6, 0.1], [1e-6, 0.1], [1e-6, 0.1], [1.0, 0.1]]);
        assert_eq!(Paces::of(&passes, 0.1).stages[0].1, [0.5, 0.25]);
        assert_eq!(Paces::of(&passes[..1], 0.1).stages[0].1, [5e-7, 2.5e-7]);
    }
}
