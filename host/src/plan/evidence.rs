//! What a pilot saw, and how noisy it says other plans would be.
//!
//! The pilot samples every technique once per camera path and keeps, with each contribution X, how the balance heuristic shared its path
//! among the kinds of join, w_j. Under counts c_j the same path is made Σ c_j w_j times as densely, so its second moment is X² over
//! that: every sample speaks for every plan, those of rare paths too, which the plan in question would hardly ever
//! make (Grittmann, Yazici, Georgiev & Křivánek 2022, "Efficiency-Aware Multiple Importance Sampling for Bidirectional Rendering
//! Algorithms").
//!
//! That is needed of paths which a plan makes so seldom that it would not have met one itself in the time of a pilot. What it makes often
//! is seen rather than told: each pixel that is looked at has two independent runs of the render's own samples, stratified as they are
//! there, and half the square of their difference is what such a run varies by. Shorter parts of the runs tell how much the
//! samples' distance from each other helps, and by how much it will help a render of many more. Splats of all pixels' walks fall
//! where they like: each for itself.

mod grid;
mod moments;
mod record;
mod spread;

use std::ops::Range;

use bidir_kernel::{Join, Technique};

pub use self::{grid::Grid, record::Record};
use self::{moments::Moments, spread::Spread};
use super::Stage;
use crate::image::Image;

/// Keeps a relative squared error finite in black pixels; relMSE's usual ε.
const EPSILON: f64 = 0.01;

/// Contributions of which the pilot would have fewer than this by the plan itself are rare.
const ENOUGH: f64 = 16.0;

/// Contributions are elusive which a plan makes less than so many times as densely as the pilot. Where the render's own are watched,
/// all are, whatever the plan: what is told from a hundred times as many samples need not be told from the pilot's.
const ELUSIVE: f64 = 0.6;

/// A contribution of the pilot.
#[derive(Clone, Copy, Debug)]
pub struct Brought {
    /// Mean of the bands, weighted.
    pub value: f64,
    /// What made it.
    pub technique: Technique,
    /// How its path was shared among the kinds of join; they add up to 1.
    pub shares: [f64; Join::COUNT],
}

/// All that a pilot brought.
#[derive(Clone, Debug)]
pub struct Evidence {
    grid: Grid,
    /// Of each cell, where a picture told it; until then the pixels of a block are taken to be about equally bright.
    brightness: Option<Vec<f32>>,
    places: Vec<Place>,
    /// Where the contributions of each camera path end in `camera`.
    ends: Vec<usize>,
    camera: Vec<Brought>,
    /// With the cell each fell on.
    splats: Vec<(u32, Brought)>,
}

/// A pixel that was looked at.
#[derive(Clone, Copy, Debug)]
struct Place {
    cell: u32,
    /// Where its camera paths end in `ends`: those of even and of odd number are the two runs.
    end: usize,
    /// Where what its light paths brought ends in `splats`.
    splats: usize,
}

impl Evidence {
    /// Nothing yet.
    pub fn new(grid: Grid) -> Self {
        Self { grid, brightness: None, places: Vec::new(), ends: Vec::new(), camera: Vec::new(), splats: Vec::new() }
    }

    /// Where contributions fall.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// How bright the image is, as far as a noisy picture of it tells.
    pub fn see(&mut self, image: &Image) {
        self.brightness = Some(self.grid.brightness(image));
    }

    /// A contribution of the camera path under way.
    pub fn add(&mut self, brought: Brought) {
        self.camera.push(brought);
    }

    /// A contribution of a light path to a cell of the image.
    pub fn splat(&mut self, cell: u32, brought: Brought) {
        self.splats.push((cell, brought));
    }

    /// How many contributions camera paths have brought.
    pub fn len(&self) -> usize {
        self.camera.len()
    }

    /// Whether camera paths have brought nothing.
    pub fn is_empty(&self) -> bool {
        self.camera.is_empty()
    }

    /// A camera path and its light path are done.
    pub fn end_sample(&mut self) {
        self.ends.push(self.camera.len());
    }

    /// All camera paths of a pixel in this cell are done, the two runs in turn.
    pub fn end_place(&mut self, cell: u32) {
        self.places.push(Place { cell, end: self.ends.len(), splats: self.splats.len() });
    }

    /// Camera paths.
    pub fn samples(&self) -> usize {
        self.ends.len()
    }

    /// Takes in what another thread brought.
    pub fn merge(&mut self, other: Self) {
        let (camera, ends, splats) = (self.camera.len(), self.ends.len(), self.splats.len());
        let after = |place: Place| Place { end: place.end + ends, splats: place.splats + splats, ..place };
        self.places.extend(other.places.into_iter().map(after));
        self.ends.extend(other.ends.into_iter().map(|end| end + camera));
        self.camera.extend(other.camera);
        self.splats.extend(other.splats);
    }

    /// Forgets every other pixel, and with it what its light paths brought: room for what is seen from now on.
    pub fn thin(&mut self) {
        let all = std::mem::replace(self, Self::new(self.grid));
        *self = Self { brightness: all.brightness, ..Self::new(all.grid) };
        let (mut first, mut first_splat) = (0_usize, 0);
        for (turn, place) in all.places.iter().enumerate() {
            if turn % 2 == 1 {
                let start = first.checked_sub(1).map_or(0, |before| all.ends[before]);
                let ends = &all.ends[first..place.end];
                let moved = self.camera.len();
                self.camera.extend_from_slice(&all.camera[start..ends.last().copied().unwrap_or(start)]);
                self.ends.extend(ends.iter().map(|end| end - start + moved));
                self.splats.extend_from_slice(&all.splats[first_splat..place.splats]);
                self.end_place(place.cell);
            }
            (first, first_splat) = (place.end, place.splats);
        }
    }

    /// Each pixel that was looked at, with where in `camera` the contributions of each of its paths are.
    fn places(&self) -> impl Iterator<Item = (u32, impl Iterator<Item = Range<usize>>)> {
        let starts = std::iter::once(0).chain(self.places.iter().map(|place| place.end));
        self.places.iter().zip(starts).map(|(place, start)| {
            let first = start.checked_sub(1).map_or(0, |before| self.ends[before]);
            let ends = &self.ends[start..place.end];
            let starts = std::iter::once(first).chain(ends.iter().copied());
            (place.cell, starts.zip(ends).map(|(start, &end)| start..end))
        })
    }

    /// All contributions, with the cell each fell on: those of camera paths, then splats.
    fn all(&self) -> impl Iterator<Item = (u32, &Brought)> {
        let camera = self.places().flat_map(move |(cell, paths)| paths.flatten().map(move |at| (cell, &self.camera[at])));
        camera.chain(self.splats.iter().map(|(cell, brought)| (*cell, brought)))
    }

    /// What a squared error counts in each cell: 1 / (mean² + ε).
    pub(super) fn importance(&self) -> Vec<f64> {
        let counts = |mean: f64| 1.0 / (mean * mean + EPSILON);
        if let Some(brightness) = &self.brightness {
            return brightness.iter().map(|mean| counts(f64::from(*mean))).collect();
        }
        let blocks = self.grid.blocks().iter().product();
        let (mut sums, mut samples) = (vec![0.0; blocks], vec![0.0; blocks]);
        for (cell, paths) in self.places() {
            let block = self.grid.block(cell as usize);
            for path in paths {
                samples[block] += 1.0;
                sums[block] += self.camera[path].iter().map(|brought| brought.value).sum::<f64>();
            }
        }
        let mut means: Vec<f64> = (0..blocks).map(|block| self.around(block, &sums, &samples)).collect();
        for (cell, brought) in &self.splats {
            let block = self.grid.block(*cell as usize);
            // Every walk may land anywhere; the image has one per pixel.
            means[block] += brought.value * self.grid.pixels() / (self.samples() as f64 * self.grid.size(block));
        }
        (0..self.grid.cells()).map(|cell| counts(means[self.grid.block(cell)])).collect()
    }

    /// Σ sums / Σ samples of a block, or of those nearest to it that have samples.
    fn around(&self, block: usize, sums: &[f64], samples: &[f64]) -> f64 {
        let [rows, columns] = self.grid.blocks();
        let near = |at: usize, radius: usize, end: usize| at.saturating_sub(radius)..(at + radius + 1).min(end);
        for radius in 0..columns.max(rows) {
            let window =
                near(block / columns, radius, rows).flat_map(|y| near(block % columns, radius, columns).map(move |x| y * columns + x));
            let (sum, n) = window.fold((0.0, 0.0), |(sum, n), block| (sum + sums[block], n + samples[block]));
            if n > 0.0 {
                return sum / n;
            }
        }
        0.0
    }

    /// A record for samples by `under_way` of what is rare in these plans.
    pub fn record(&self, under_way: &Stage, plans: &[Stage]) -> Record {
        let importance = self.importance();
        let mut made = Vec::with_capacity(self.camera.len() + self.splats.len());
        let mut rare = |stage: &Stage| Some((*stage, self.make(&Counts::of(stage), &importance, f64::INFINITY, &mut made)?.0));
        let plans: Vec<_> = plans.iter().filter_map(&mut rare).collect();
        Record::new(under_way, plans.into_iter(), importance)
    }

    /// The relMSE of renders by these plans that have so many samples per pixel, times their number;
    /// infinite where a plan cannot make what was seen, by the pilot or, if it has a record, the render.
    pub fn errors(&self, plans: &[(Stage, f64)], record: Option<&Record>) -> Vec<f64> {
        let importance = self.importance();
        let mut made = Vec::with_capacity(self.camera.len() + self.splats.len());
        let mut error =
            |(stage, samples): &(Stage, f64)| self.error(stage, *samples, &importance, record, &mut made).unwrap_or(f64::INFINITY);
        plans.iter().map(&mut error).collect()
    }

    /// `made` is room for what the plan makes of each contribution; `None` where there is one that it cannot make.
    fn error(&self, stage: &Stage, samples: f64, importance: &[f64], record: Option<&Record>, made: &mut Vec<Made>) -> Option<f64> {
        let counts = Counts::of(stage);
        let recorded = record.and_then(|record| record.of(stage, samples));
        let (rare, moments) = self.make(&counts, importance, if recorded.is_some() { f64::INFINITY } else { ELUSIVE }, made)?;
        let (rare, squares) = recorded.unwrap_or_else(|| (rare, moments.squares(rare, f64::INFINITY, 1.0, 0.0)));
        let (camera, splats) = made.split_at(self.camera.len());
        let mut spread = Spread::default();
        for (cell, paths) in self.places() {
            spread.place(&counts, paths.map(|path| &camera[path]), importance[cell as usize], rare);
        }
        let often = splats.iter().zip(&self.splats).filter(|(made, _)| !made.rare(rare));
        let splats: f64 = often.map(|(made, (cell, _))| made.count * made.value * made.value * importance[*cell as usize]).sum();
        Some(spread.at(samples) + splats / self.samples().max(1) as f64 + squares)
    }

    /// All contributions as a plan makes them; those that it makes less than `elusive` times as densely as the pilot are told by size, and
    /// rare from that bin on.
    fn make(&self, counts: &Counts, importance: &[f64], elusive: f64, made: &mut Vec<Made>) -> Option<(usize, Moments)> {
        let per_sample = 1.0 / self.samples().max(1) as f64;
        let mut moments = Moments::default();
        made.clear();
        for (cell, brought) in self.all() {
            made.push(counts.made(brought, importance[cell as usize], per_sample, elusive, &mut moments)?);
        }
        Some((moments.rarest(ENOUGH * per_sample), moments))
    }
}

/// The counts of a plan.
struct Counts {
    of: [f64; Join::COUNT],
    /// How often two pairs of vertices of the same two walks are both connected.
    both_connected: f64,
}

/// A contribution of the pilot, as a plan makes it.
#[derive(Clone, Copy, Debug)]
struct Made {
    value: f64,
    /// Of its kind of join.
    count: f64,
    connection: bool,
    /// Its size among the moments, if it is elusive.
    bin: Option<u8>,
}

impl Made {
    /// Whether it is elusive and at least as large as those of that bin.
    fn rare(&self, rare: usize) -> bool {
        self.bin.is_some_and(|bin| usize::from(bin) >= rare)
    }
}

impl Counts {
    fn of(stage: &Stage) -> Self {
        let walks = stage.techniques().light_walks();
        let chance = if walks > 0.0 { stage.connection / walks } else { 0.0 };
        Self { of: Join::ALL.map(|join| stage.effort(join)), both_connected: walks * chance * chance }
    }

    /// How much more densely a path is made than it was by the pilot, which made each kind of join once.
    fn density(&self, brought: &Brought) -> f64 {
        brought.shares.iter().zip(self.of).map(|(share, count)| share * count).sum()
    }

    /// A contribution as the plan makes it, if it does. `moments` take it, `per_sample` being 1 over the pilot's samples, if it is elusive:
    /// where the plan makes such a path so much more seldom than the pilot did that it may never have seen one itself. What the lens sees
    /// directly it sees with every sample.
    fn made(&self, brought: &Brought, importance: f64, per_sample: f64, elusive: f64, moments: &mut Moments) -> Option<Made> {
        let density = self.density(brought);
        let value = brought.value / density;
        let elusive = brought.technique.length() > 1 && density < elusive;
        let bin = elusive.then(|| moments.take(density, value * value * importance, per_sample));
        let join = brought.technique.join();
        (density > 0.0).then_some(Made { value, count: self.of[join as usize], connection: join == Join::Connection, bin })
    }
}

/// The shares of the kinds of join in a contribution that was weighed own / (own + rivals).
pub fn shares(technique: Technique, own: f64, rivals: impl Fn(Join) -> f64) -> [f64; Join::COUNT] {
    let mut efforts = Join::ALL.map(rivals);
    efforts[technique.join() as usize] += own;
    let all: f64 = efforts.iter().sum();
    // Where a rival is beyond all numbers, the path is its.
    efforts.map(|effort| if effort.is_infinite() { 1.0 } else { effort / all })
}

#[cfg(test)]
mod tests {
    use bidir_kernel::Techniques;

    use super::{spread::SLOPE, *};
    use crate::scene::description::Crop;

    fn one_block() -> Evidence {
        Evidence::new(Grid::new(Crop { x: 0, y: 0, width: 1, height: 1 }))
    }

    fn brought(value: f64, s: u32, t: u32, shares: [f64; 5]) -> Brought {
        Brought { value, technique: Technique { s, t }, shares }
    }

    const HALF: [f64; 5] = [0.5, 0.5, 0.0, 0.0, 0.0];

    #[test]
    fn what_never_varies_has_no_error() {
        let mut evidence = one_block();
        for _ in 0..10 {
            for _ in 0..4 {
                evidence.add(brought(1.0, 0, 3, HALF));
                evidence.add(brought(1.0, 1, 2, HALF));
                evidence.end_sample();
            }
            evidence.end_place(0);
        }
        let errors = evidence.errors(&[(Stage::of(&Techniques::PATH), 64.0)], None);
        assert!(errors[0].abs() < 1e-12, "{errors:?}");
    }

    #[test]
    fn a_run_that_is_stratified_has_the_error_of_the_run() {
        let of = |values: &[f64]| {
            let mut evidence = one_block();
            for _ in 0..10 {
                for value in values {
                    evidence.add(brought(*value, 0, 2, [1.0, 0.0, 0.0, 0.0, 0.0]));
                    evidence.end_sample();
                }
                evidence.end_place(0);
            }
            [2.0, 4.0].map(|samples| evidence.errors(&[(Stage::of(&Techniques::PATH), samples)], None)[0] * 1.01)
        };
        let close = |errors: [f64; 2], expected: [f64; 2]| {
            assert!(errors.iter().zip(expected).all(|(error, expected)| (error - expected).abs() < 1e-9), "{errors:?}");
        };
        // Two runs of two samples, each with a bright and a dark one, or one with both bright ones. A render of two has one of each run.
        close(of(&[2.0, 2.0, 0.0, 0.0]), [1.0, 0.0]);
        close(of(&[2.0, 0.0, 2.0, 0.0]), [2.0, 4.0]);
    }

    #[test]
    fn many_samples_go_on_getting_better_as_few_did() {
        let mut evidence = one_block();
        for value in [2.0, 2.0, 0.0, 0.0, 2.0, 2.0, 0.0, 0.0, 3.0, 3.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0] {
            evidence.add(brought(value, 0, 2, [1.0, 0.0, 0.0, 0.0, 0.0]));
            evidence.end_sample();
        }
        evidence.end_place(0);
        let of = |samples: f64| evidence.errors(&[(Stage::of(&Techniques::PATH), samples)], None)[0];
        assert!(of(2.0) > of(4.0) && of(4.0) > of(8.0) && of(16.0) <= of(8.0));
        assert!(of(64.0) <= of(16.0) && of(64.0) >= of(16.0) * SLOPE.powi(2));
    }

    #[test]
    fn connections_that_are_made_seldom_vary_more() {
        let mut evidence = one_block();
        for _ in 0..10 {
            for _ in 0..4 {
                evidence.add(brought(0.5, 2, 2, [0.0, 0.0, 1.0, 0.0, 0.0]));
                evidence.add(brought(0.5, 2, 3, [0.0, 0.0, 1.0, 0.0, 0.0]));
                evidence.end_sample();
            }
            evidence.end_place(0);
        }
        let with = |walks: f64, connection: f64| Stage::of(&Techniques { connection, lens_splat: walks, ..Techniques::NONE });
        let errors = evidence.errors(&[with(1.0, 1.0), with(0.25, 0.25), with(1.0, 0.5)].map(|stage| (stage, 1e6)), None);
        assert!(errors[0].abs() < 1e-12, "{errors:?}");
        // All four times as bright in every fourth sample: 4 − 1; each of two halves twice as bright in every other: (1 + ½) − 1.
        assert!((errors[1] - 3.0 / 1.01).abs() < 1e-9 && (errors[2] - 0.5 / 1.01).abs() < 1e-9, "{errors:?}");
    }

    #[test]
    fn the_error_of_a_rare_path_falls_with_its_density() {
        let mut evidence = one_block();
        let shares = [0.01, 0.0, 0.0, 0.99, 0.0];
        for i in 0..10 {
            if i == 0 {
                evidence.splat(0, brought(1.0, 3, 1, shares));
            }
            evidence.end_sample();
            evidence.end_sample();
            evidence.end_place(0);
        }
        let counts = |light_hit: f64, lens_splat: f64| Stage::of(&Techniques { light_hit, lens_splat, ..Techniques::NONE });
        let plans = [counts(1.0, 1.0), counts(1.0, 0.0), counts(0.0, 0.0), counts(1.0, 2.0)];
        let errors = evidence.errors(&plans.map(|stage| (stage, 64.0)), None);
        assert!((errors[1] / errors[0] - 100.0).abs() < 1e-6, "{errors:?}");
        assert!(errors[2].is_infinite());
        // Two splats of each walk's, of which the pilot saw none that the camera found.
        assert!((errors[0] / errors[3] - 1.99 * 1.99 / 2.0).abs() < 1e-6, "{errors:?}");
    }

    #[test]
    fn parts_of_two_threads_are_one() {
        let part = |value: f64| {
            let mut evidence = one_block();
            evidence.add(brought(value, 0, 2, HALF));
            evidence.end_sample();
            evidence.end_sample();
            evidence.end_place(0);
            evidence
        };
        let (mut ab, mut ba) = (part(1.0), part(3.0));
        ab.merge(part(3.0));
        ba.merge(part(1.0));
        let stage = [(Stage::of(&Techniques::PATH), 64.0)];
        assert_eq!(ab.errors(&stage, None), ba.errors(&stage, None));
        assert_eq!(ab.samples(), 4);
    }

    #[test]
    fn every_other_pixel_is_forgotten() {
        let of = |turns: &[u32]| {
            let mut evidence = one_block();
            for &turn in turns {
                for i in 0..turn {
                    evidence.add(brought(f64::from(turn * i), 0, 2, HALF));
                    evidence.splat(0, brought(1.0, 3, 1, HALF));
                    evidence.end_sample();
                }
                evidence.end_place(0);
            }
            evidence
        };
        let mut evidence = of(&[2, 4, 3, 6, 5]);
        evidence.thin();
        let expected = of(&[4, 6]);
        assert_eq!((evidence.samples(), evidence.len(), evidence.splats.len()), (10, 10, 10));
        let plan = [(Stage::of(&Techniques::BIDIRECTIONAL), 64.0)];
        assert_eq!(evidence.errors(&plan, None), expected.errors(&plan, None));
    }
}
