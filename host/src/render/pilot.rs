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
    watch::Watch,
};
use crate::{
    film::{Exposure, Film, Store, TileBuffer},
    image::Image,
    plan::{
        Stage,
        choice::Costs,
        effects::Effects,
        evidence::{Brought, Evidence, Grid, shares},
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
const SAMPLES: usize = 32;

/// Of these, how many costs are measured with, and in one of how many rounds: beside few samples, handing them to the film would seem
/// dearer than it is.
const TIMED: usize = 8;
const TIMED_ROUNDS: usize = 4;

/// Pixels of a round that are sampled before the clock is looked at.
const WARMING: usize = 2;

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
    crop: Crop,
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

impl Pilot {
    /// Nothing seen yet. Techniques that cannot make a path in the scene are left out.
    pub fn new(settings: &FilmSettings, effects: &Effects, max_depth: Option<u32>) -> Self {
        let techniques = possible(effects, max_depth, &Techniques::BIDIRECTIONAL);
        let crop = settings.crop;
        let part = Crop { width: crop.width.min(FILM), height: crop.height.min(FILM), ..crop };
        let small = FilmSettings { crop: part, ..settings.clone() };
        let ways = Ways::of(&techniques);
        let evidence = Evidence::new(Grid::new(crop));
        Self { evidence, spent: Spent::default(), calls: Metering::default(), crop, ways, small, rounds: 0 }
    }

    /// What was seen.
    pub fn evidence(&self) -> &Evidence {
        &self.evidence
    }

    /// How bright the image is, as far as a noisy picture of it tells.
    pub fn see(&mut self, image: &Image) {
        self.evidence.see(image);
    }

    /// What the render's own samples by the stage `under_way` are watched for, so that these plans are told apart.
    pub fn watch(&self, under_way: &Stage, plans: &[Stage]) -> Watch {
        Watch { record: self.evidence.record(under_way, plans), grid: *self.evidence.grid() }
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
        let grid = *self.evidence.grid();
        let mut kept = Kept { evidence: Evidence::new(grid), grid, weighed: (1.0, ByJoin::NONE) };
        let mut timing = Timing { spent: Spent::default(), film: Film::new(&self.small).ok()?, crop: self.small.crop };
        let mut calls = Metering::of(view.sandbox());
        // The render's own numbers, of a seed that is not the render's.
        let sources: Vec<N> = (0..SAMPLES).map(|index| N::new(!job.seed, index as u32)).collect();
        for (number, round) in rounds.enumerate() {
            view.sandbox().begin_tile(round);
            let places: Vec<_> = (0..ROUND).map(|i| scattered(round * u64::from(ROUND) + u64::from(i), self.crop)).collect();
            for &place in &places {
                for source in &sources {
                    let (mut numbers, raster) = begun(source, place);
                    sample(&view, &strategy, &mut numbers, raster, &mut camera_path, &mut light_path, &mut kept);
                    kept.evidence.end_sample();
                }
                let cell = grid.at(Vec2::new(place[0] as f32 + 0.5, place[1] as f32 + 0.5)).unwrap_or(0);
                kept.evidence.end_place(cell);
            }
            if number % TIMED_ROUNDS == 0 {
                timing.round(&view, &strategy, &self.ways, &places, &sources[..TIMED]);
            }
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
    grid: Grid,
    /// How the next contribution was weighed.
    weighed: (f64, ByJoin),
}

/// A contribution that was weighed so, if it brings something.
pub(super) fn brought(contribution: &Contribution, (own, rivals): &(f64, ByJoin)) -> Option<Brought> {
    let Contribution { value, weight, technique } = *contribution;
    let value = f64::from(value.mean()) * f64::from(weight);
    let shares = shares(technique, *own, |join| rivals.of(join));
    let whole = value.is_finite() && value != 0.0 && shares.iter().all(|share| share.is_finite());
    whole.then_some(Brought { value, technique, shares })
}

impl bidir_kernel::Film for Kept {
    type Rivals = ByJoin;

    fn weighed(&mut self, own: f64, others: ByJoin) {
        self.weighed = (own, others);
    }

    fn add(&mut self, contribution: Contribution) {
        if let Some(brought) = brought(&contribution, &self.weighed) {
            self.evidence.add(brought);
        }
    }

    fn splat(&mut self, raster: Vec2, contribution: Contribution) {
        if let (Some(brought), Some(cell)) = (brought(&contribution, &self.weighed), self.grid.at(raster)) {
            self.evidence.splat(cell, brought);
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
