//! How often plugins are called in each part that a sample is made of, and what of its time that takes.
//!
//! A look at the clock before and after each call is as dear as a short call. So these are samples of their own: neither a render nor the
//! samples that its costs are measured with look at a clock in between.

use std::{
    path::Path,
    time::{Duration, Instant},
};

use bidir_kernel::{Contribution, Film, Strategy, Together, Vec2, sample};
use cpu_time::ThreadTime;

use super::{
    begun,
    ways::{WAYS, Ways},
};
use crate::{
    plan::plugins::{Calls, Measured},
    plugin::{Metered, Sandbox},
    render::{numbers::Source, storage},
    scene::view::View,
};

/// Samples of each pixel that calls are metered in.
pub(super) const SAMPLES: usize = 2;

/// Lets go what samples bring.
pub(crate) struct Nobody;

impl Film for Nobody {
    type Rivals = Together;

    fn add(&mut self, _: Contribution) {}

    fn splat(&mut self, _: Vec2, _: Contribution) {}
}

/// What plugins were asked so far, by way of sampling.
#[derive(Debug, Default)]
pub(super) struct Metering {
    modules: Vec<Module>,
    /// Nanoseconds between calls, weighted.
    between: [f64; WAYS],
    samples: f64,
}

/// What one of them was asked, by way of sampling.
#[derive(Debug)]
struct Module {
    name: String,
    calls: [f64; WAYS],
    /// Nanoseconds in calls, weighted, and the calls with the same weights.
    nanoseconds: [f64; WAYS],
    weighted: [f64; WAYS],
}

impl Metering {
    /// Of the plugins of a sandbox, nothing asked yet.
    pub(super) fn of(sandbox: &Sandbox) -> Self {
        let name = |file: &Path| file.file_name().unwrap_or(file.as_os_str()).to_string_lossy().into_owned();
        let module = |file| Module { name: name(file), calls: [0.0; WAYS], nanoseconds: [0.0; WAYS], weighted: [0.0; WAYS] };
        Self { modules: sandbox.files().map(module).collect(), ..Self::default() }
    }

    /// Samples these pixels in each of the ways that costs are told from, if there is any plugin.
    pub(super) fn round<N: Source>(&mut self, view: &View, all: &Strategy, ways: &Ways, places: &[[u32; 2]], sources: &[N]) {
        if self.modules.is_empty() {
            return;
        }
        for (way, techniques) in ways.measured() {
            let strategy = Strategy { techniques, ..*all };
            let (mut camera_path, mut light_path) = (storage(&strategy), storage(&strategy));
            for (&place, source) in places.iter().flat_map(|place| sources.iter().map(move |source| (place, source))) {
                let (mut numbers, raster) = begun(source, place);
                let cpu = ThreadTime::now();
                let (wall, metered) = view.sandbox().metered(|| {
                    let start = Instant::now();
                    sample(view, &strategy, &mut numbers, raster, &mut camera_path, &mut light_path, &mut Nobody);
                    start.elapsed()
                });
                self.add(way, wall, cpu.elapsed(), &metered);
            }
        }
        self.samples += (places.len() * sources.len()) as f64;
    }

    /// One more sample of a way.
    fn add(&mut self, way: usize, wall: Duration, cpu: Duration, metered: &[Metered]) {
        // Of time that another process took meanwhile nobody knows whether it was within a call. The less of a sample's time is its own,
        // the less it counts.
        let own = if cpu.is_zero() { 1.0 } else { (cpu.as_secs_f64() / wall.as_secs_f64()).min(1.0) };
        let mut between = wall.as_nanos() as f64;
        for (module, metered) in self.modules.iter_mut().zip(metered) {
            module.calls[way] += metered.calls as f64;
            module.weighted[way] += own * metered.calls as f64;
            module.nanoseconds[way] += own * own * metered.nanoseconds;
            between -= metered.nanoseconds + metered.telling;
        }
        self.between[way] += own * own * between.max(0.0);
    }

    /// Takes in what another thread's plugins were asked.
    pub(super) fn merge(&mut self, other: Self) {
        if self.modules.is_empty() {
            *self = other;
            return;
        }
        let add = |all: &mut [f64; WAYS], more: [f64; WAYS]| all.iter_mut().zip(more).for_each(|(all, more)| *all += more);
        for (all, one) in self.modules.iter_mut().zip(other.modules) {
            add(&mut all.calls, one.calls);
            add(&mut all.nanoseconds, one.nanoseconds);
            add(&mut all.weighted, one.weighted);
        }
        add(&mut self.between, other.between);
        self.samples += other.samples;
    }

    /// What that comes to where a sample of each way costs so many nanoseconds.
    pub(super) fn measured(&self, ways: &Ways, each: [f64; WAYS]) -> Measured {
        let samples = self.samples.max(1.0);
        let calls = |module: &Module| {
            let calls = module.calls.map(|calls| calls / samples);
            let each = |way: usize| if module.weighted[way] > 0.0 { module.nanoseconds[way] / module.weighted[way] } else { 0.0 };
            let time = std::array::from_fn(|way| calls[way] * each(way));
            Calls { module: module.name.clone(), calls: ways.parts(calls), time: ways.parts(time) }
        };
        // What is left is measured itself: the difference of two large numbers would be mostly noise.
        let left = std::array::from_fn(|way| {
            let called: f64 = self.modules.iter().map(|module| module.nanoseconds[way]).sum();
            let all = called + self.between[way];
            each[way] * if all > 0.0 { self.between[way] / all } else { 1.0 }
        });
        Measured { modules: self.modules.iter().map(calls).collect(), without: ways.parts(left) }
    }
}
