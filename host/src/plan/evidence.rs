//! What a pilot saw, and how noisy it says other plans would be.
//!
//! The pilot samples every technique once per camera path and keeps, with each contribution X, how the balance heuristic shared its path
//! among the kinds of join, w_j. Under counts c_j the same path is made Σ c_j w_j times as densely, so its second moment is X² over
//! that: every sample speaks for every plan, those of rare paths too, which the plan in question would hardly ever
//! make (Grittmann, Yazici, Georgiev & Křivánek 2022, "Efficiency-Aware Multiple Importance Sampling for Bidirectional Rendering
//! Algorithms").
//!
//! What is left of a plan's error is seen rather than told: each pixel that is looked at has two independent runs of the render's
//! own samples, stratified as they are there, and half the square of their difference is what such a run varies by. Shorter parts of the
//! runs tell how much the samples' distance from each other helps, and by how much it will help a render of many more. Of the paths that
//! the plan makes itself, this takes the place of their second moments.
//!
//! A render's error is trimmed, and what a plan makes so seldom that it would be on fewer pixels than are trimmed is left out here too.

use std::cmp::Ordering;

use bidir_kernel::{Join, Technique};

use super::Stage;
use crate::image::trim::TRIM;

/// Keeps a relative squared error finite in black pixels; relMSE's usual ε.
const EPSILON: f64 = 0.01;

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

/// All that a pilot brought. Blocks are parts of the image whose pixels are taken to be about equally bright.
#[derive(Clone, Debug, Default)]
pub struct Evidence {
    /// Pixels of the image.
    pixels: f64,
    /// Pixels of each block.
    sizes: Vec<f64>,
    places: Vec<Place>,
    /// Where the contributions of each camera path end in `camera`.
    ends: Vec<usize>,
    camera: Vec<Brought>,
    splats: Vec<(u32, Brought)>,
    /// Light walks.
    walks: f64,
}

/// A pixel that was looked at.
#[derive(Clone, Copy, Debug)]
struct Place {
    block: u32,
    /// Where its camera paths end in `ends`: those of even and of odd number are the two runs.
    end: usize,
}

impl Evidence {
    /// Nothing yet, of an image whose blocks have that many pixels.
    pub fn new(sizes: Vec<f64>) -> Self {
        Self { pixels: sizes.iter().sum(), sizes, ..Self::default() }
    }

    /// A contribution of the camera path under way.
    pub fn add(&mut self, brought: Brought) {
        self.camera.push(brought);
    }

    /// A contribution of a light path to a block of the image.
    pub fn splat(&mut self, block: u32, brought: Brought) {
        self.splats.push((block, brought));
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
        self.walks += 1.0;
    }

    /// All camera paths of a pixel of this block are done, the two runs in turn.
    pub fn end_place(&mut self, block: u32) {
        self.places.push(Place { block, end: self.ends.len() });
    }

    /// Camera paths.
    pub fn samples(&self) -> usize {
        self.ends.len()
    }

    /// Takes in what another thread brought.
    pub fn merge(&mut self, other: Self) {
        let (camera, ends) = (self.camera.len(), self.ends.len());
        self.places.extend(other.places.into_iter().map(|place| Place { end: place.end + ends, ..place }));
        self.ends.extend(other.ends.into_iter().map(|end| end + camera));
        self.camera.extend(other.camera);
        self.splats.extend(other.splats);
        self.walks += other.walks;
    }

    /// Each pixel that was looked at, with its camera paths' contributions.
    fn places(&self) -> impl Iterator<Item = (u32, impl Iterator<Item = &[Brought]>)> {
        let starts = std::iter::once(0).chain(self.places.iter().map(|place| place.end));
        self.places.iter().zip(starts).map(|(place, start)| {
            let first = start.checked_sub(1).map_or(0, |before| self.ends[before]);
            let ends = &self.ends[start..place.end];
            let starts = std::iter::once(first).chain(ends.iter().copied());
            (place.block, starts.zip(ends).map(|(start, &end)| &self.camera[start..end]))
        })
    }

    /// What a squared error counts in each block: 1 / (mean² + ε).
    fn importance(&self) -> Vec<f64> {
        let (mut sums, mut samples) = (vec![0.0; self.sizes.len()], vec![0.0; self.sizes.len()]);
        for (block, paths) in self.places() {
            for path in paths {
                samples[block as usize] += 1.0;
                sums[block as usize] += path.iter().map(|brought| brought.value).sum::<f64>();
            }
        }
        let mut means: Vec<f64> = sums.iter().zip(&samples).map(|(sum, n)| if *n > 0.0 { sum / n } else { 0.0 }).collect();
        for (block, brought) in &self.splats {
            // Every walk may land anywhere; the image has one per pixel.
            means[*block as usize] += brought.value * self.pixels / (self.walks * self.sizes[*block as usize]);
        }
        means.into_iter().map(|mean| 1.0 / (mean * mean + EPSILON)).collect()
    }

    /// The relMSE, trimmed, of renders by these plans that have so many samples per pixel, times their number;
    /// infinite where a plan cannot make what the pilot saw.
    pub fn errors(&self, plans: &[(Stage, f64)]) -> Vec<f64> {
        let importance = self.importance();
        plans.iter().map(|(stage, samples)| self.error(stage, *samples, &importance)).collect()
    }

    fn error(&self, stage: &Stage, samples: f64, importance: &[f64]) -> f64 {
        let counts = Counts::of(stage);
        let mut moments = Moments::default();
        let mut spread = Spread::default();
        let (per_path, per_walk) = (1.0 / self.samples().max(1) as f64, 1.0 / self.walks.max(1.0));
        for (block, paths) in self.places() {
            spread.place(&counts, paths, importance[block as usize], |brought| {
                moments.take(&counts, brought, importance[block as usize], (CAMERA, per_path));
            });
        }
        for (block, brought) in &self.splats {
            moments.take(&counts, brought, importance[*block as usize], (SPLATS, per_walk));
        }
        if moments.missed {
            return f64::INFINITY;
        }
        let (kept, cut) = moments.trimmed(samples);
        if std::env::var("DBG").is_ok() {
            let sum = |from: usize| moments.bins[from].iter().map(|bin| bin[1]).sum::<f64>();
            eprintln!("DBG {:?} n {samples:.0} pooled {:.4} {:.4} kept {:.4} {:.4} left {:.4} all {:.4} lengths {:?} at {:.4} samples {} walks {}", counts.of, sum(0), sum(1), kept[0], kept[1], samples*self.left_out(&counts, &cut, importance), spread.all / spread.places, spread.lengths.map(|x| (1e4 * x / spread.places).round() / 1e4), spread.at(kept[CAMERA], samples), self.samples(), self.walks);
            let top: Vec<_> = (0..Moments::BINS).filter(|&bin| moments.bins[0][bin][1] + moments.bins[1][bin][1] > 0.003).map(|bin| (bin as i32 - 64, [0, 1].map(|f| moments.bins[f][bin].map(|x| (x * 1e5).round() / 1e5)))).collect();
            eprintln!("DBG {top:?}");
        }
        spread.at(kept[CAMERA], samples) + kept[SPLATS] + samples * self.left_out(&counts, &cut, importance)
    }

    /// What is missing from the pixels where nothing came of what is trimmed: the mean square of it.
    fn left_out(&self, counts: &Counts, cut: &Cut, importance: &[f64]) -> f64 {
        if cut.nothing() {
            return 0.0;
        }
        let mut missing = vec![0.0; self.sizes.len()];
        let mut paths_of = vec![0.0_f64; self.sizes.len()];
        for (block, paths) in self.places() {
            let at = block as usize;
            for path in paths {
                paths_of[at] += 1.0;
                missing[at] += path.iter().map(|brought| brought.value * cut.share(counts.square(brought, importance[at]))).sum::<f64>();
            }
        }
        missing.iter_mut().zip(paths_of).for_each(|(missing, paths)| *missing /= paths.max(1.0));
        for (block, brought) in &self.splats {
            let at = *block as usize;
            let share = cut.share(counts.square(brought, importance[at]));
            missing[at] += share * brought.value * self.pixels / (self.walks * self.sizes[at]);
        }
        let weighed =
            missing.iter().zip(importance).zip(&self.sizes).map(|((missing, importance), size)| missing * missing * importance * size);
        weighed.sum::<f64>() / self.pixels
    }
}

/// The counts of a plan.
struct Counts {
    of: [f64; Join::COUNT],
    /// How often two pairs of vertices of the same two walks are both connected.
    both_connected: f64,
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

    /// The square of what such a path brings.
    fn square(&self, brought: &Brought, importance: f64) -> f64 {
        let value = brought.value / self.density(brought);
        value * value * importance
    }
}

/// What comes from camera walks, and what from light walks alone.
const CAMERA: usize = 0;
const SPLATS: usize = 1;

/// Second moments of contributions, by how large each one is: a power of two each.
#[derive(Clone, Debug)]
struct Moments {
    /// Of how many such contributions a sample has, and of the sum of their squares.
    bins: [[[f64; 2]; Self::BINS]; 2],
    /// Whether there is one that the plan never makes.
    missed: bool,
}

impl Default for Moments {
    fn default() -> Self {
        Self { bins: [[[0.0; 2]; Self::BINS]; 2], missed: false }
    }
}

impl Moments {
    /// From 2^−64 to 2^64; what is beyond is with the last ones.
    const BINS: usize = 128;

    fn bin(square: f64) -> usize {
        let exponent = (square.to_bits() >> 52 & 0x7ff) as i32 - 1023;
        (exponent + Self::BINS as i32 / 2).clamp(0, Self::BINS as i32 - 1) as usize
    }

    /// A contribution of the pilot, as the plan would make it: `per` sample.
    fn take(&mut self, counts: &Counts, brought: &Brought, importance: f64, (from, per): (usize, f64)) {
        let density = counts.density(brought);
        if density == 0.0 {
            self.missed = true;
            return;
        }
        let square = counts.square(brought, importance);
        let [number, squares] = &mut self.bins[from][Self::bin(square)];
        *number += density * per;
        *squares += density * square * per;
    }

    /// The moments of what would be on more pixels than are trimmed, and where it is cut.
    fn trimmed(&self, samples: f64) -> ([f64; 2], Cut) {
        let mut spare = TRIM / samples.max(1.0);
        let mut cut = Cut { bin: Self::BINS, share: 0.0 };
        let mut kept = [0.0; 2];
        for bin in (0..Self::BINS).rev() {
            let number = self.bins[CAMERA][bin][0] + self.bins[SPLATS][bin][0];
            let share = if spare == 0.0 || number == 0.0 { 0.0 } else { (spare / number).min(1.0) };
            if share > 0.0 {
                cut = Cut { bin, share };
            }
            spare = (spare - number).max(0.0);
            for (kept, bins) in kept.iter_mut().zip(&self.bins) {
                *kept += (1.0 - share) * bins[bin][1];
            }
        }
        (kept, cut)
    }
}

/// What is trimmed: every contribution larger than those of this bin, and some of its.
struct Cut {
    bin: usize,
    share: f64,
}

impl Cut {
    fn nothing(&self) -> bool {
        self.bin == Moments::BINS
    }

    /// How much of such contributions is trimmed.
    fn share(&self, square: f64) -> f64 {
        match Moments::bin(square).cmp(&self.bin) {
            Ordering::Less => 0.0,
            Ordering::Equal => self.share,
            Ordering::Greater => 1.0,
        }
    }
}

/// What runs of camera paths vary by, beyond the second moments of their contributions: by their length, which doubles from 1 on.
#[derive(Clone, Copy, Debug, Default)]
struct Spread {
    lengths: [f64; Self::LENGTHS],
    /// Of all lengths: what making only some of the connections adds, less the second moments of the plan's own samples.
    all: f64,
    /// How many lengths the runs had.
    known: usize,
    places: f64,
}

impl Spread {
    /// Runs of up to 32 samples.
    const LENGTHS: usize = 6;

    /// A pixel that was looked at, with its two runs in turn.
    fn place<'a>(&mut self, counts: &Counts, paths: impl Iterator<Item = &'a [Brought]>, importance: f64, mut each: impl FnMut(&Brought)) {
        let mut runs = [[0.0; 1 << (Self::LENGTHS - 1)]; 2];
        let (mut number, mut all) = (0, 0.0);
        for path in paths {
            let mut one = Sample::default();
            for brought in path {
                each(brought);
                one.add(counts, brought);
            }
            if let Some(slot) = runs[number % 2].get_mut(number / 2) {
                *slot = one.total;
                all += one.rationed(counts) - one.own;
                number += 1;
            }
        }
        let mut length = number / 2;
        if length == 0 {
            return;
        }
        self.known = length.ilog2() as usize + 1;
        self.places += 1.0;
        self.all += all * importance / number as f64;
        for level in 0..self.known {
            // Var(a − b) = 2 σ²/m for runs of m samples; all pairs of parts of the two runs are independent.
            let parts = runs.each_ref().map(|run| {
                let sums = run[..length].iter().fold([0.0; 2], |[sum, squares], x| [sum + x, squares + x * x]);
                sums.map(|sum| sum / length as f64)
            });
            let [a, b] = parts;
            self.lengths[level] += importance * f64::from(1 << level) * (0.5 * (a[1] + b[1]) - a[0] * b[0]);
            length /= 2;
            for run in &mut runs {
                for i in 0..length {
                    run[i] = 0.5 * (run[2 * i] + run[2 * i + 1]);
                }
            }
        }
    }

    /// The error of one of so many samples per pixel, whose second moment is `moment`.
    fn at(&self, moment: f64, samples: f64) -> f64 {
        if self.places == 0.0 || moment.is_infinite() {
            return moment;
        }
        let of = |level: usize| (moment + (self.lengths[level] + self.all) / self.places).max(0.0);
        let last = self.known - 1;
        // Samples of even and of odd number are two runs.
        let level = (0.5 * samples).max(1.0).log2();
        if level <= last as f64 {
            let (below, part) = (level as usize, level.fract());
            return of(below) + part * (of((below + 1).min(last)) - of(below));
        }
        // Beyond, it is taken to go on falling as it did.
        let (before, reached) = (of(last.saturating_sub(2)), of(last));
        let slope = if before > 0.0 { (reached / before).sqrt().clamp(SLOPE, 1.0) } else { 1.0 };
        reached * slope.powf((level - last as f64).min(FARTHEST))
    }
}

/// The least that twice the samples leave of an error beyond half of it.
const SLOPE: f64 = 0.75;
/// Doublings for which an error may fall so.
const FARTHEST: f64 = 6.0;

/// What a camera path and its light path would have brought.
#[derive(Clone, Copy, Debug, Default)]
struct Sample {
    total: f64,
    /// Σ of squares, as often as the plan makes each.
    own: f64,
    connected: f64,
    squares: f64,
}

impl Sample {
    fn add(&mut self, counts: &Counts, brought: &Brought) {
        let join = brought.technique.join();
        let count = counts.of[join as usize];
        if count == 0.0 {
            return;
        }
        let value = brought.value / counts.density(brought);
        self.total += count * value;
        self.own += count * value * value;
        if join == Join::Connection {
            self.connected += value;
            self.squares += value * value;
        }
    }

    /// What making only some of the connections adds.
    fn rationed(&self, counts: &Counts) -> f64 {
        let count = counts.of[Join::Connection as usize];
        let Self { connected, squares, .. } = self;
        counts.both_connected * (connected * connected - squares) + count * squares - count * count * connected * connected
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

    use super::*;

    fn one_block() -> Evidence {
        Evidence::new(vec![1.0])
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
        let errors = evidence.errors(&[Stage::of(&Techniques::PATH)]);
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
            evidence.errors(&[Stage::of(&Techniques::PATH)])[0]
        };
        // Of two runs of two samples, each with a bright and a dark one, or one with both bright ones.
        assert!(of(&[2.0, 2.0, 0.0, 0.0]).abs() < 1e-12);
        assert!((of(&[2.0, 0.0, 2.0, 0.0]) - 4.0 / 1.01).abs() < 1e-9);
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
        let errors = evidence.errors(&[with(1.0, 1.0), with(0.25, 0.25), with(1.0, 0.5)]);
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
        let errors = evidence.errors(&[counts(1.0, 1.0), counts(1.0, 0.0), counts(0.0, 0.0), counts(1.0, 2.0)]);
        assert!((errors[1] / errors[0] - 100.0).abs() < 1e-9, "{errors:?}");
        assert!(errors[2].is_infinite());
        assert!((errors[0] / errors[3] - 1.99).abs() < 1e-9, "{errors:?}");
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
        let stage = [Stage::of(&Techniques::PATH)];
        assert_eq!(ab.errors(&stage), ba.errors(&stage));
        assert_eq!(ab.samples(), 4);
    }
}
