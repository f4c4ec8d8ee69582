//! The film: it adds up what camera and light walks bring, with the same bits at any thread count and for any division into passes.
//!
//! Work comes in [`Unit`]s, one sample of each pixel of a tile. A thread claims the next one, exposes its buffer, commits it:
//!
//! ```
//! # use bidir::{film::{Exposure, Film, Store}, scene::description::{Crop, FilmSettings, Filter}};
//! # use bidir_kernel::{Contribution, Film as _, Spectrum, Technique, Vec2};
//! # fn radiance(_: Vec2) -> Contribution { Contribution { value: Spectrum::ONE, weight: 1.0, technique: Technique { s: 0, t: 2 } } }
//! # let crop = Crop { x: 0, y: 0, width: 20, height: 20 };
//! # let film = Film::new(&FilmSettings { width: 20, height: 20, crop, filter: Filter::Gaussian { stddev: 0.5 } })?;
//! std::thread::scope(|scope| {
//!     for _ in 0..2 {
//!         scope.spawn(|| {
//!             while let Some(mut buffer) = film.claim(4) {
//!                 let unit = buffer.unit();
//!                 for (x, y) in film.pixels(&unit) {
//!                     let raster = Vec2::new(x as f32 + 0.5, y as f32 + 0.5); // by the sampler, from (x, y) and unit.sample
//!                     buffer.begin(raster);
//!                     buffer.add(radiance(raster)); // by the kernel
//!                     buffer.end();
//!                 }
//!                 film.commit(buffer);
//!             }
//!         });
//!     }
//! });
//! assert!(film.develop().pixels.iter().all(|&pixel| pixel == [1.0; 3]));
//! # Ok::<(), bidir::error::Error>(())
//! ```
//!
//! A pixel is Σ h f / Σ h over camera samples plus Σ h f · pixels / N over splats, h the filter (normalised for splats), N the number
//! of all samples, pixels those of the crop window; one that counts w times ([`Exposure::weigh`]) is w samples. At the window's border
//! the part of h outside never arrives: splats are divided by h's mass inside.

mod band;
mod both;
mod buffer;
mod develop;
pub mod filter;
mod layout;
pub mod picture;
mod pyramid;
mod sequencer;
mod unit;

use std::sync::{Arc, Mutex};

use crate::{error::Result, scene::description::FilmSettings};

pub use both::{Both, BothBuffers};
pub use buffer::{Exposure, TileBuffer};
pub use develop::Noise;
pub use pyramid::{Pyramid, PyramidBuffer};
pub use unit::{TILE, Unit, WINDOW};

use band::Band;
use layout::Layout;
use sequencer::Sequencer;
use unit::{Dispatch, lock};

/// What render threads share: units to claim, and a place to commit them.
pub trait Store: Sync {
    /// Where one unit's contributions go.
    type Buffer: Exposure + Send;

    /// The next unit whose sample's number is below `end`, with an empty buffer; `None` when there is none left, or after
    /// [`Store::abandon`]. Waits while the oldest unit not yet committed is [`WINDOW`] units behind, so a thread holds one at a time.
    fn claim(&self, end: u32) -> Option<Self::Buffer>;

    /// Adds a claimed buffer to the film when its turn comes. Every claimed one must be committed: those after a gap never arrive.
    fn commit(&self, buffer: Self::Buffer);

    /// Ends the render for every thread, where a unit cannot be finished. What was committed before that unit stays.
    fn abandon(&self);

    /// The pixels of a unit, in pixels of the whole image, row by row.
    fn pixels(&self, unit: &Unit) -> impl Iterator<Item = (u32, u32)> + use<Self>
    where
        Self: Sized;
}

/// The film of an ordinary render.
#[derive(Debug)]
pub struct Film {
    layout: Layout,
    dispatch: Dispatch,
    bands: Vec<Strip>,
    pool: Mutex<Vec<TileBuffer>>,
    tally: Mutex<Tally>,
}

#[derive(Debug)]
struct Strip {
    order: Sequencer<Arc<TileBuffer>>,
    sums: Mutex<Band>,
}

/// How much is on the film.
#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    samples: u64,
    refused: u64,
}

impl Film {
    /// Black; stores the crop window only, 64 bytes per pixel, 112 once splats come.
    pub fn new(settings: &FilmSettings) -> Result<Self> {
        let layout = Layout::new(settings)?;
        let strip = |index| Strip { order: Sequencer::new(), sums: Mutex::new(Band::new(layout.band(index))) };
        Ok(Self {
            dispatch: Dispatch::new(layout.crop.width, layout.crop.height),
            bands: (0..layout.bands()).map(strip).collect(),
            pool: Mutex::default(),
            tally: Mutex::default(),
            layout,
        })
    }

    /// Camera samples on the film, over all pixels. Like all that reads the film, it is exact while no thread holds a buffer.
    pub fn samples(&self) -> u64 {
        lock(&self.tally).samples
    }

    /// Contributions that were refused: not finite, or splats outside the window. Their samples still count.
    pub fn refused(&self) -> u64 {
        lock(&self.tally).refused
    }

    /// A buffer arrived in every band.
    fn recycle(&self, buffer: TileBuffer) {
        let mut tally = lock(&self.tally);
        tally.samples += buffer.samples;
        tally.refused += buffer.refused;
        drop(tally);
        let index = buffer.unit.index;
        lock(&self.pool).push(buffer);
        self.dispatch.settle(index);
    }
}

impl Store for Film {
    type Buffer = TileBuffer;

    fn claim(&self, end: u32) -> Option<TileBuffer> {
        let unit = self.dispatch.claim(end)?;
        let recycled = lock(&self.pool).pop();
        Some(match recycled {
            Some(mut buffer) => {
                buffer.reset(unit);
                buffer
            }
            None => TileBuffer::new(&self.layout, unit),
        })
    }

    fn commit(&self, buffer: TileBuffer) {
        let arrived = |buffer| {
            if let Some(buffer) = Arc::into_inner(buffer) {
                self.recycle(buffer);
            }
        };
        // Threads that commit at the same time start at different bands.
        let first = buffer.unit.index as usize;
        let buffer = Arc::new(buffer);
        for i in 0..self.bands.len() {
            let index = (first + i) % self.bands.len();
            let strip = &self.bands[index];
            strip.order.submit(buffer.unit.index, Arc::clone(&buffer), |buffer| {
                lock(&strip.sums).add(index, &buffer, &self.layout.profile);
                arrived(buffer);
            });
        }
        arrived(buffer);
    }

    fn abandon(&self) {
        self.dispatch.abandon();
    }

    fn pixels(&self, unit: &Unit) -> impl Iterator<Item = (u32, u32)> + use<> {
        self.layout.pixels_of(unit)
    }
}

#[cfg(test)]
mod tests;
