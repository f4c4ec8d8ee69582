//! Keeps what a sample does, in order.

use std::cell::{Cell, RefCell};

use super::super::kernel::{
    Bsdf, Carried, Contribution, Film, Lobe, Real, Sampler, Scatter, Scattered, Together, Vec2, Vec3, Walk, sampler::Independent,
};
use super::surface::Surface;
use crate::{
    nudge::Nudge,
    tape::{Event, Given, Tape},
};

/// The tape that is running, and the walk under way.
#[derive(Debug)]
pub struct Recorder {
    tape: RefCell<Tape>,
    walk: Cell<Walk>,
}

impl Recorder {
    pub fn new() -> Self {
        Self { tape: RefCell::default(), walk: Cell::new(Walk::Camera) }
    }

    pub fn note(&self, event: Event) {
        self.tape.borrow_mut().walks[self.walk.get() as usize].push(event);
    }

    pub fn done(self) -> Tape {
        self.tape.into_inner()
    }
}

/// The walk that asks for numbers is the one under way.
pub struct Told<'a> {
    pub numbers: Independent,
    pub recorder: &'a Recorder,
}

impl Sampler for Told<'_> {
    fn seek(&mut self, walk: Walk, dimension: u32) {
        self.recorder.walk.set(walk);
        self.numbers.seek(walk, dimension);
    }

    fn next(&mut self) -> Real {
        self.numbers.next()
    }
}

/// A surface that tells how it sent a walk on.
#[derive(Clone, Copy, Debug)]
pub struct Watched<'a> {
    pub surface: Surface,
    pub nudge: &'a Nudge,
    pub recorder: &'a Recorder,
}

impl Bsdf for Watched<'_> {
    fn eval(&self, wo: Vec3, wi: Vec3, carried: Carried) -> Scatter {
        self.surface.eval(self.nudge, wo, wi, carried)
    }

    fn sample(&self, wo: Vec3, u: [Real; 3], carried: Carried) -> Option<Scattered> {
        let sampled = self.surface.sample(self.nudge, wo, u, carried);
        self.recorder.note(Event::Left { lobe: sampled.map_or(0, |sampled| sampled.lobe.0) });
        sampled
    }

    fn lobes(&self) -> Lobe {
        self.surface.lobes()
    }
}

/// A film that keeps every contribution apart.
pub struct Kept<'a> {
    pub recorder: &'a Recorder,
    pub scale: f64,
}

impl Film for Kept<'_> {
    type Rivals = Together;

    fn add(&mut self, contribution: Contribution) {
        let Contribution { value, weight, technique } = contribution;
        let given = Given { s: technique.s, t: technique.t, value: value.0.map(f64::from), weight: f64::from(weight) };
        self.recorder.tape.borrow_mut().give(given, self.scale);
    }

    fn splat(&mut self, _: Vec2, contribution: Contribution) {
        self.add(contribution);
    }
}
