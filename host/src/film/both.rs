//! Two films at once: every unit of work is done on both.

use std::sync::Mutex;

use bidir_kernel::{Contribution, Together, Vec2};

use super::{Exposure, Film, Pyramid, PyramidBuffer, Store, TileBuffer, Unit, unit::lock};

/// An ordinary film and one that keeps techniques apart, of the same size; both get every sample.
#[derive(Debug)]
pub struct Both<'a> {
    /// The picture.
    pub film: &'a Film,
    /// What each technique brings to it.
    pub pyramid: &'a Pyramid,
    /// Both are claimed from by one thread at a time, so that their units stay the same.
    turn: Mutex<()>,
}

impl<'a> Both<'a> {
    /// Of two films that nothing is on yet, of the same settings.
    pub fn new(film: &'a Film, pyramid: &'a Pyramid) -> Self {
        Self { film, pyramid, turn: Mutex::default() }
    }
}

/// The [`Exposure`] of [`Both`].
#[derive(Debug)]
pub struct BothBuffers(TileBuffer, PyramidBuffer);

impl<'a> Store for Both<'a> {
    type Buffer = BothBuffers;

    fn claim(&self, end: u32) -> Option<BothBuffers> {
        let _turn = lock(&self.turn);
        Some(BothBuffers(self.film.claim(end)?, self.pyramid.claim(end)?))
    }

    fn commit(&self, BothBuffers(tile, list): BothBuffers) {
        self.film.commit(tile);
        self.pyramid.commit(list);
    }

    fn abandon(&self) {
        self.film.abandon();
        self.pyramid.abandon();
    }

    fn pixels(&self, unit: &Unit) -> impl Iterator<Item = (u32, u32)> + use<'a> {
        self.film.pixels(unit)
    }
}

impl Exposure for BothBuffers {
    fn unit(&self) -> Unit {
        self.0.unit()
    }

    fn begin(&mut self, raster: Vec2) {
        self.0.begin(raster);
        self.1.begin(raster);
    }

    fn end(&mut self) {
        self.0.end();
        self.1.end();
    }

    fn clear(&mut self) {
        self.0.clear();
        self.1.clear();
    }

    fn weigh(&mut self, weight: f64) {
        self.0.weigh(weight);
        self.1.weigh(weight);
    }
}

impl bidir_kernel::Film for BothBuffers {
    type Rivals = Together;

    fn add(&mut self, contribution: Contribution) {
        self.0.add(contribution);
        self.1.add(contribution);
    }

    fn splat(&mut self, raster: Vec2, contribution: Contribution) {
        self.0.splat(raster, contribution);
        self.1.splat(raster, contribution);
    }
}
