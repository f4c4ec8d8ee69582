//! The pilot: a few samples all over the image, by every technique, that tell plans apart. Nothing of them comes onto the film.

mod calls;
mod ways;

use std::time::Duration;

use bidir_kernel::{ByJoin, Contribution, Heuristic, Rivals, Sampler, Strategy, Techniques, Together, Vec2, Walk, sample};
use cpu_time::ThreadTime;

use self::calls::Metering;
pub(crate) use self::calls::Nobody;
use self::ways::{WAYS, Ways};
use super::{
    Job,
    numbers::{Apart, Numbers, Sobol, Source},
    storage,
};
use crate::{
    film::{Exposure, Film, Store, TileBuffer},
    plan::{
        choice::Costs,
        effects::Effects,
        evidence::{Brought, Evidence, shares},
        joins::possible,
        plugins::Measured,
    },
    scene::{
        Scene,
        description::{Crop, FilmSettings},
        preset::{Preset, Task},
        view::View,
    },
};

/// Pixels that one round looks at.
const ROUND: u32 = 16;

/// Samples of each of them, half of them in either run.
const SAMPLES: u32 = 32;

/// Of these, how many costs are measured with.
const TIMED: usize = 2;

/// Pixels of a round that are sampled before the clock is looked at.
const WARMING: usize = 1;

/// About how many blocks the image has.
const BLOCKS: f64 = 256.0;

/// The most contributions of camera paths that are kept: memory, and time to weigh plans by.
const MOST_KEPT: usize = 1 << 18;

/// The film that costs are measured with is no larger than this, in pixels.
const FILM: u32 = 64;

/// What a pilot has seen so far.
#[derive(Debug)]
pub struct Pilot {
    evidence: Evidence,
    spent: Spent,
    calls: Metering,
    blocks: Blocks,
    ways: Ways,
    small: FilmSettings,
    rounds: u64,
}

/// CPU time of each kind of sample, and how many there were.
#[derive(Clone, Copy, Debug, Default)]
struct Spent {
    nanoseconds: [f64; WAYS],
    samples: f64,
}

impl Spent {
    /// Nanoseconds of a sample of each kind.
    fn each(&self) -> [f64; WAYS] {
        self.nanoseconds.map(|ns| ns / self.samples.max(1.0))
    }
}

/// What one thread has seen.
struct Part {
    evidence: Evidence,
    spent: Spent,
    calls: Metering,
}

/// The image in blocks.
#[derive(Clone, Copy, Debug)]
struct Blocks {
    crop: Crop,
    edge: u32,
    columns: u32,
}

impl Blocks {
    fn new(crop: Crop) -> Self {
        let pixels = f64::from(crop.width) * f64::from(crop.height);
        let edge = (pixels / BLOCKS).sqrt().ceil().max(1.0) as u32;
        Self { crop, edge, columns: crop.width.div_ceil(edge) }
    }

    /// Evidence of an image in these blocks.
    fn evidence(&self) -> Evidence {
        let rows = self.crop.height.div_ceil(self.edge);
        let length = |index: u32, whole: u32| f64::from(self.edge.min(whole - index * self.edge));
        let of = |row, column| length(row, self.crop.height) * length(column, self.crop.width);
        let sizes = (0..rows).flat_map(|row| (0..self.columns).map(move |column| (row, column))).map(|(row, column)| of(row, column));
        Evidence::new(sizes.collect(), self.columns as usize)
    }

    /// The block of a raster position, if it is within the window.
    fn at(&self, raster: Vec2) -> Option<u32> {
        let (x, y) = (f64::from(raster.x) - f64::from(self.crop.x), f64::from(raster.y) - f64::from(self.crop.y));
        let inside = x >= 0.0 && y >= 0.0 && x < f64::from(self.crop.width) && y < f64::from(self.crop.height);
        inside.then(|| y as u32 / self.edge * self.columns + x as u32 / self.edge)
    }
}

impl Pilot {
    /// Nothing seen yet. Techniques that cannot make a path in the scene are left out.
    pub fn new(settings: &FilmSettings, effects: &Effects, max_depth: Option<u32>) -> Self {
        let techniques = possible(effects, max_depth, &Techniques::BIDIRECTIONAL);
        let blocks = Blocks::new(settings.crop);
        let Crop { x, y, width, height } = settings.crop;
        let crop = Crop { x, y, width: width.min(FILM), height: height.min(FILM) };
        let small = FilmSettings { crop, ..settings.clone() };
        let ways = Ways::of(&techniques);
        Self { evidence: blocks.evidence(), spent: Spent::default(), calls: Metering::default(), blocks, ways, small, rounds: 0 }
    }

    /// What was seen.
    pub fn evidence(&self) -> &Evidence {
        &self.evidence
    }

    /// Looks on, on all threads, until each has spent that much time or all together have looked at that many pixels; a round at least.
    /// How deep paths go is the job's.
    pub fn look(&mut self, scene: &Scene, job: &Job, time: Duration, pixels: u64) {
        let threads = job.threads.max(1) as u64;
        if self.evidence.len() >= MOST_KEPT / 2 {
            self.evidence.thin();
        }
        let rounds = pixels.div_ceil(u64::from(ROUND)).div_ceil(threads).max(1);
        let first = self.rounds;
        let this = &*self;
        let parts: Vec<_> = std::thread::scope(|scope| {
            let look = |thread| {
                let rounds = (0..rounds).map(move |i| first + i * threads + thread);
                move || match job.numbers {
                    Numbers::Sobol => this.part::<Sobol>(scene, job, rounds, time),
                    Numbers::Independent => this.part::<Apart>(scene, job, rounds, time),
                }
            };
            let workers: Vec<_> = (0..threads).map(|thread| scope.spawn(look(thread))).collect();
            workers.into_iter().filter_map(|worker| worker.join().ok().flatten()).collect()
        });
        self.rounds += rounds * threads;
        for Part { evidence, spent, calls } in parts {
            self.calls.merge(calls);
            self.evidence.merge(evidence);
            for (all, one) in self.spent.nanoseconds.iter_mut().zip(spent.nanoseconds) {
                *all += one;
            }
            self.spent.samples += spent.samples;
        }
    }

    /// One thread's part; `None` where a plugin broke off, which the render will meet as well.
    fn part<N: Source>(&self, scene: &Scene, job: &Job, rounds: impl Iterator<Item = u64>, time: Duration) -> Option<Part> {
        let clock = ThreadTime::now();
        let room = MOST_KEPT.saturating_sub(self.evidence.len());
        let view = View::new(scene, job.strictness);
        let strategy = Strategy { techniques: self.ways.all(), heuristic: Heuristic::Balance, ..job.strategy };
        let (mut camera_path, mut light_path) = (storage(&strategy), storage(&strategy));
        let mut kept = Kept { evidence: self.blocks.evidence(), blocks: self.blocks, weighed: (1.0, ByJoin::NONE) };
        let mut timing = Timing { spent: Spent::default(), film: Film::new(&self.small).ok()?, crop: self.small.crop };
        let mut calls = Metering::of(view.sandbox());
        // The render's own numbers, of a seed that is not the render's.
        let sources: Vec<N> = (0..SAMPLES).map(|index| N::new(!job.seed, index)).collect();
        for round in rounds {
            view.sandbox().begin_tile(round);
            let places: Vec<_> = (0..ROUND).map(|i| scattered(round * u64::from(ROUND) + u64::from(i), self.blocks.crop)).collect();
            for &place in &places {
                for source in &sources {
                    let (mut numbers, raster) = begun(source, place);
                    sample(&view, &strategy, &mut numbers, raster, &mut camera_path, &mut light_path, &mut kept);
                    kept.evidence.end_sample();
                }
                let block = self.blocks.at(Vec2::new(place[0] as f32 + 0.5, place[1] as f32 + 0.5)).unwrap_or(0);
                kept.evidence.end_place(block);
            }
            timing.round(&view, &strategy, &self.ways, &places, &sources[..TIMED]);
            calls.round(&view, &strategy, &self.ways, &places, &sources[..calls::SAMPLES]);
            if view.sandbox().faulted() {
                return None;
            }
            if clock.elapsed() >= time || kept.evidence.len() * job.threads.max(1) > room {
                break;
            }
        }
        Some(Part { evidence: kept.evidence, spent: timing.spent, calls })
    }

    /// What samples cost.
    pub fn costs(&self) -> Costs {
        self.ways.parts(self.spent.each())
    }

    /// What calls of plugins take of that.
    pub fn plugins(&self) -> Measured {
        self.calls.measured(&self.ways, self.spent.each())
    }
}

/// The pixel that is looked at in turn: everywhere alike, by the additive recurrence of the plastic number (Roberts 2018).
pub(crate) fn scattered(turn: u64, Crop { x, y, width, height }: Crop) -> [u32; 2] {
    let at = |step: f64, length: u32| ((0.5 + step * turn as f64).fract() * f64::from(length)) as u32;
    [x + at(0.754_877_666_246_692_7, width), y + at(0.569_840_290_998_053_3, height)]
}

/// Takes what the pilot's samples bring.
struct Kept {
    evidence: Evidence,
    blocks: Blocks,
    /// How the next contribution was weighed.
    weighed: (f64, ByJoin),
}

impl Kept {
    fn brought(&self, contribution: &Contribution) -> Option<Brought> {
        let Contribution { value, weight, technique } = *contribution;
        let value = f64::from(value.mean()) * f64::from(weight);
        let shares = shares(technique, self.weighed.0, |join| self.weighed.1.of(join));
        let whole = value.is_finite() && value != 0.0 && shares.iter().all(|share| share.is_finite());
        whole.then_some(Brought { value, technique, shares })
    }
}

impl bidir_kernel::Film for Kept {
    type Rivals = ByJoin;

    fn weighed(&mut self, own: f64, others: ByJoin) {
        self.weighed = (own, others);
    }

    fn add(&mut self, contribution: Contribution) {
        if let Some(brought) = self.brought(&contribution) {
            self.evidence.add(brought);
        }
    }

    fn splat(&mut self, raster: Vec2, contribution: Contribution) {
        if let (Some(brought), Some(block)) = (self.brought(&contribution), self.blocks.at(raster)) {
            self.evidence.splat(block, brought);
        }
    }
}

/// The numbers of a pixel, and where in it a camera path begins.
fn begun<N: Source>(source: &N, [x, y]: [u32; 2]) -> (N::OfPixel<'_>, Vec2) {
    let mut numbers = source.pixel(u64::from(y) << 32 | u64::from(x));
    numbers.seek(Walk::Camera, 0);
    let [dx, dy] = numbers.next_pair();
    (numbers, Vec2::new(x as f32 + dx, y as f32 + dy))
}

/// Measures what samples cost, as a render takes them: each with the preset that a render would take.
struct Timing {
    spent: Spent,
    film: Film,
    /// The film's.
    crop: Crop,
}

/// Samples of these pixels, taken in one way.
struct Timed<'a, N> {
    view: &'a View<'a>,
    strategy: Strategy,
    timing: &'a Timing,
    places: &'a [[u32; 2]],
    sources: &'a [N],
}

impl Timing {
    /// Samples these pixels in each of the ways that costs are told from.
    fn round<N: Source>(&mut self, view: &View, all: &Strategy, ways: &Ways, places: &[[u32; 2]], sources: &[N]) {
        for (way, techniques) in ways.measured() {
            let strategy = Strategy { techniques, ..*all };
            let timed = Timed { view, strategy, timing: self, places, sources };
            self.spent.nanoseconds[way] += N::with_preset(view.scene(), strategy.effects(), timed);
        }
        self.spent.samples += (places.len() * sources.len()) as f64;
    }
}

impl<N: Source> Task for Timed<'_, N> {
    /// In nanoseconds.
    type Output = f64;

    fn run<P: Preset>(self, preset: P) -> f64 {
        let Self { timing, strategy, places, sources, .. } = self;
        let view = self.view.with_preset(preset);
        let (mut camera_path, mut light_path) = (storage(&strategy), storage(&strategy));
        let Some(mut buffer) = timing.film.claim(u32::MAX) else { return 0.0 };
        let mut take = |places: &[[u32; 2]]| {
            for (&place, source) in places.iter().flat_map(|place| sources.iter().map(move |source| (place, source))) {
                let (mut numbers, raster) = begun(source, place);
                buffer.begin(raster);
                let mut film = Within { buffer: &mut buffer, crop: timing.crop };
                sample(&view, &strategy, &mut numbers, raster, &mut camera_path, &mut light_path, &mut film);
                buffer.end();
            }
        };
        // A render has had its code in the cache for long.
        take(&places[..WARMING]);
        let clock = ThreadTime::now();
        take(places);
        timing.film.commit(buffer);
        clock.elapsed().as_nanos() as f64
    }
}

/// A buffer of the small film, for splats from all over the image.
struct Within<'a> {
    buffer: &'a mut TileBuffer,
    crop: Crop,
}

impl bidir_kernel::Film for Within<'_> {
    type Rivals = Together;

    fn add(&mut self, contribution: Contribution) {
        self.buffer.add(contribution);
    }

    fn splat(&mut self, raster: Vec2, contribution: Contribution) {
        let fold = |at: f32, first: u32, length: u32| first as f32 + (at - first as f32).rem_euclid(length as f32);
        let Crop { x, y, width, height } = self.crop;
        self.buffer.splat(Vec2::new(fold(raster.x, x, width), fold(raster.y, y, height)), contribution);
    }
}
