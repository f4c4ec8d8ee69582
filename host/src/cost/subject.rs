//! The scene whose cost is asked for, and one render of it with its errors on the way.

use std::{
    cell::RefCell,
    sync::{Arc, atomic::AtomicBool},
};

use bidir_kernel::Strategy;
use serde::{Deserialize, Serialize};

use super::{
    pace::{Cut, Pass, Stopwatch, Yardstick},
    reference::{Errors, Reference},
};
use crate::{
    error::{Error, Result},
    film::Film,
    image::Image,
    plan::{Stage, effects::Effects, gaps::gaps},
    plugin::Strictness,
    render::{self, Director, Job, Numbers, Status, Target},
    scene::{Scene, description::Description},
};

/// A scene, and how it is to be rendered.
#[derive(Debug)]
pub struct Subject {
    /// What it is called.
    pub name: String,
    /// As it was read.
    pub description: Description,
    /// Built from that.
    pub scene: Scene,
    /// What can happen to light in it.
    pub effects: Effects,
    /// Render threads.
    pub threads: usize,
    /// The first of the seeds.
    pub seed: u64,
    /// What a plugin's bad answer does.
    pub strictness: Strictness,
}

/// How a render differs from an ordinary one of the subject.
#[derive(Clone, Copy, Debug)]
pub struct Manner<'a> {
    /// The scene itself, or one that was built otherwise.
    pub scene: &'a Scene,
    /// Its description.
    pub description: &'a Description,
    /// Depth and roulette; the director says which techniques.
    pub strategy: Strategy,
    /// Which random numbers.
    pub numbers: Numbers,
}

/// The errors of a render at some moment of it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    /// Samples per pixel.
    pub spp: u32,
    /// CPU seconds until then, of everything: pilots too.
    pub cpu: f64,
    /// Wall-clock seconds.
    pub wall: f64,
    /// How far the picture is from the reference then.
    #[serde(flatten)]
    pub errors: Errors,
}

/// A render that was watched.
#[derive(Debug)]
pub struct Run {
    /// After 1, 2, 4 … samples per pixel, or what passes there are, and at the end.
    pub snapshots: Vec<Snapshot>,
    /// All its passes.
    pub passes: Vec<Pass>,
    /// The picture at the end.
    pub image: Image,
    /// How it ended.
    pub status: Status,
}

impl Subject {
    /// As the scene is.
    pub fn manner(&self, stage: &Stage) -> Manner<'_> {
        Manner {
            scene: &self.scene,
            description: &self.description,
            strategy: stage.strategy(&self.description.integrator),
            numbers: Numbers::default(),
        }
    }

    /// A job of this manner.
    pub fn job(&self, manner: &Manner, seed: u64, target: Target) -> Job {
        Job {
            strategy: manner.strategy,
            seed: self.seed.wrapping_add(seed),
            numbers: manner.numbers,
            threads: self.threads,
            target,
            width: self.description.film.width,
            strictness: self.strictness,
        }
    }

    /// Renders a plan as the scene is.
    ///
    /// # Errors
    /// If the film cannot be made, or a plugin broke off.
    pub fn render(&self, stage: &Stage, seed: u64, target: Target, interrupt: &Arc<AtomicBool>) -> Result<(Image, Status)> {
        let film = Film::new(&self.description.film)?;
        let job = self.job(&self.manner(stage), seed, target);
        let status = render::render(&self.scene, &film, &job, interrupt, |_| None);
        whole(&status)?;
        Ok((film.develop(), status))
    }

    /// What a plan is known to miss in the scene.
    pub fn missed(&self, stage: &Stage) -> Option<String> {
        let gaps = gaps(&self.effects, stage, self.description.integrator.max_depth);
        gaps.first().map(|gap| format!("it never finds {} from {}: {}", gap.class, gap.lights, gap.what))
    }

    /// Renders, and looks at the picture whenever its samples have doubled; what looking takes is in no time.
    ///
    /// # Errors
    /// If the film cannot be made, the reference is of another size, or a plugin broke off.
    pub fn watch(
        &self,
        manner: &Manner,
        director: &mut impl Director,
        seed: u64,
        target: Target,
        reference: &Reference,
        interrupt: &Arc<AtomicBool>,
    ) -> Result<Run> {
        let film = Film::new(&manner.description.film)?;
        let stopwatch = RefCell::new(Stopwatch::start(Yardstick::of(self)));
        let mut snapshots: Vec<Snapshot> = Vec::new();
        let mut failed = None;
        let mut look = |samples: u32| {
            let clock = &mut stopwatch.borrow_mut().clock;
            let [cpu, wall] = clock.read();
            match reference.errors(&film.develop()) {
                Ok(errors) => snapshots.push(Snapshot { spp: samples, cpu, wall, errors }),
                Err(error) => failed = Some(error),
            }
            clock.forget([cpu, wall]);
        };
        let mut looked = 0;
        let mut cut = Cut { director, stopwatch: &stopwatch };
        let status = render::directed(manner.scene, &film, &self.job(manner, seed, target), &mut cut, interrupt, |status| {
            stopwatch.borrow_mut().end(status.samples);
            if status.samples >= 2 * looked && status.samples > 0 {
                look(status.samples);
                looked = status.samples;
            }
            None
        });
        if status.samples > looked && status.fault.is_none() {
            look(status.samples);
        }
        whole(&status)?;
        match failed {
            Some(error) => Err(error),
            None => Ok(Run { snapshots, passes: stopwatch.into_inner().passes, image: film.develop(), status }),
        }
    }
}

/// An error if a plugin broke off, or a render thread broke down.
pub(super) fn whole(status: &Status) -> Result<()> {
    match &status.fault {
        Some(fault) => Err(fault.clone().into()),
        None if status.failed => Err(Error::new("a render thread broke down", "this is a bug; please report it")),
        None => Ok(()),
    }
}
