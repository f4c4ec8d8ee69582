//! What a pilot saw, and how noisy it says other plans would be.
//!
//! The pilot samples every technique, c_j times per camera path, and keeps, with each contribution X, how the balance heuristic shared its
//! path among the kinds of join, w_j. Under counts c'_j the same path is made Σ c'_j/c_j w_j times as densely, so its second moment is
//! X² over that: every sample speaks for every plan, those of rare paths too, which the plan in question would hardly ever
//! make (Grittmann, Yazici, Georgiev & Křivánek 2022, "Efficiency-Aware Multiple Importance Sampling for Bidirectional Rendering
//! Algorithms"). The square of the mean comes from pairs of samples of the same pixel; what the contributions of one camera path have
//! in common comes from their products, which count as often as both are made together.

use bidir_kernel::{Join, Technique, Techniques};

use super::Stage;

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
    /// The pilot's counts.
    counts: [f64; Join::COUNT],
    /// Pixels of the image.
    pixels: f64,
    /// Pixels of each block.
    sizes: Vec<f64>,
    /// Two samples of one pixel each.
    pairs: Vec<Pair>,
    camera: Vec<Brought>,
    splats: Vec<(u32, Brought)>,
    /// Light walks.
    walks: f64,
}

#[derive(Clone, Copy, Debug)]
struct Pair {
    block: u32,
    /// Where each sample's contributions end in `camera`.
    ends: [usize; 2],
}

impl Evidence {
    /// Nothing yet, of an image whose blocks have that many pixels, sampled with these counts. Next event is sampled twice, so that it shows
    /// what its samples at one vertex have in common.
    pub fn new(sizes: Vec<f64>, counts: &Techniques) -> Self {
        let counts = Join::ALL.map(|join| counts.effort(join));
        Self { counts, pixels: sizes.iter().sum(), sizes, ..Self::default() }
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

    /// Two samples of a pixel of this block are done, each with its light walk; the first one's contributions end at `middle`.
    pub fn end_pair(&mut self, block: u32, middle: usize) {
        self.pairs.push(Pair { block, ends: [middle, self.camera.len()] });
        self.walks += 2.0;
    }

    /// Pairs of samples.
    pub fn pairs(&self) -> usize {
        self.pairs.len()
    }

    /// Takes in what another thread brought.
    pub fn merge(&mut self, other: Self) {
        let first = self.camera.len();
        self.pairs.extend(other.pairs.into_iter().map(|pair| Pair { ends: pair.ends.map(|end| end + first), ..pair }));
        self.camera.extend(other.camera);
        self.splats.extend(other.splats);
        self.walks += other.walks;
    }

    /// What a squared error counts in each block: 1 / (mean² + ε).
    fn importance(&self) -> Vec<f64> {
        let (mut sums, mut samples) = (vec![0.0; self.sizes.len()], vec![0.0; self.sizes.len()]);
        let mut start = 0;
        for pair in &self.pairs {
            let block = pair.block as usize;
            samples[block] += 2.0;
            sums[block] += self.camera[start..pair.ends[1]].iter().map(|brought| brought.value).sum::<f64>();
            start = pair.ends[1];
        }
        let mut means: Vec<f64> = sums.iter().zip(&samples).map(|(sum, n)| if *n > 0.0 { sum / n } else { 0.0 }).collect();
        for (block, brought) in &self.splats {
            // Every walk may land anywhere; the image has one per pixel.
            means[*block as usize] += brought.value * self.pixels / (self.walks * self.sizes[*block as usize]);
        }
        means.into_iter().map(|mean| 1.0 / (mean * mean + EPSILON)).collect()
    }

    /// The relMSE of one sample per pixel under each of these plans, about; infinite where a plan cannot make what the pilot saw.
    pub fn errors(&self, stages: &[Stage]) -> Vec<f64> {
        let importance = self.importance();
        stages.iter().map(|stage| self.error(stage, &importance)).collect()
    }

    fn error(&self, stage: &Stage, importance: &[f64]) -> f64 {
        let counts = Counts::of(stage, &self.counts);
        let (mut sum, mut start) = (0.0, 0);
        for pair in &self.pairs {
            let (a, b) = (counts.sampled(&self.camera[start..pair.ends[0]]), counts.sampled(&self.camera[pair.ends[0]..pair.ends[1]]));
            start = pair.ends[1];
            let variance = 0.5 * (a.moment + b.moment + a.common + b.common) - a.total * b.total;
            sum += variance * importance[pair.block as usize];
        }
        let camera = sum / self.pairs.len().max(1) as f64;
        let splats: f64 = self.splats.iter().map(|(block, brought)| counts.moment(brought) * importance[*block as usize]).sum();
        camera + splats / self.walks.max(1.0)
    }
}

/// The counts of a plan as the pilot's samples see them.
struct Counts {
    /// Over the pilot's.
    ratios: [f64; Join::COUNT],
    next_event: f64,
    connection: f64,
    /// How often two pairs of vertices of the same two walks are both connected.
    both_connected: f64,
}

/// What one camera path would have brought.
#[derive(Clone, Copy, Debug, Default)]
struct Sampled {
    /// Σ over its paths of their second moments.
    moment: f64,
    /// The mean of all its contributions together.
    total: f64,
    /// Σ of the products of different ones.
    common: f64,
}

impl Counts {
    fn of(stage: &Stage, pilot: &[f64; Join::COUNT]) -> Self {
        let mut ratios = Join::ALL.map(|join| stage.effort(join));
        ratios.iter_mut().zip(pilot).filter(|(_, count)| **count > 0.0).for_each(|(ratio, count)| *ratio /= count);
        let walks = stage.techniques().light_walks();
        let chance = if walks > 0.0 { stage.connection / walks } else { 0.0 };
        Self { ratios, next_event: stage.next_event, connection: stage.connection, both_connected: walks * chance * chance }
    }

    /// How much more densely a path is made than it was by the pilot.
    fn density(&self, brought: &Brought) -> f64 {
        brought.shares.iter().zip(self.ratios).map(|(share, ratio)| share * ratio).sum()
    }

    fn moment(&self, brought: &Brought) -> f64 {
        if brought.value == 0.0 { 0.0 } else { brought.value * brought.value / self.density(brought) }
    }

    fn sampled(&self, brought: &[Brought]) -> Sampled {
        let mut sampled = Sampled::default();
        // What is made once or not at all; connections; and, by path length, next event.
        let (mut squares, mut connected, mut lit) = (0.0, Sums::default(), [Sums::default(); LONGEST]);
        for one in brought {
            sampled.moment += self.moment(one);
            let join = one.technique.join();
            if self.ratios[join as usize] == 0.0 {
                continue;
            }
            let value = one.value / self.density(one);
            match join {
                Join::Connection => connected.add(value),
                Join::NextEvent => lit[(one.technique.t as usize).min(LONGEST - 1)].add(value),
                Join::LightHit | Join::LensSplat | Join::LensHit => {
                    sampled.total += value;
                    squares += value * value;
                }
            }
        }
        let count = self.next_event;
        for lit in &lit {
            // The pilot's two.
            let mean = 0.5 * lit.sum;
            sampled.total += count * mean;
            squares += count * count * mean * mean - count * (count - 1.0) * 0.5 * lit.products();
        }
        sampled.total += self.connection * connected.sum;
        squares += self.connection * self.connection * connected.sum * connected.sum - self.both_connected * connected.products();
        sampled.common = sampled.total * sampled.total - squares;
        sampled
    }
}

/// Next event at later vertices than this is taken together.
const LONGEST: usize = 16;

#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    sum: f64,
    squares: f64,
}

impl Sums {
    fn add(&mut self, value: f64) {
        self.sum += value;
        self.squares += value * value;
    }

    /// Σ of the products of different ones.
    fn products(&self) -> f64 {
        self.sum * self.sum - self.squares
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
    use super::*;

    const PILOT: Techniques = Techniques { next_event: 2.0, ..Techniques::BIDIRECTIONAL };

    fn one_block() -> Evidence {
        Evidence::new(vec![1.0], &PILOT)
    }

    fn brought(value: f64, s: u32, t: u32, shares: [f64; 5]) -> Brought {
        Brought { value, technique: Technique { s, t }, shares }
    }

    const HALF: [f64; 5] = [0.5, 0.5, 0.0, 0.0, 0.0];

    #[test]
    fn what_never_varies_has_no_error() {
        let mut evidence = one_block();
        for _ in 0..10 {
            // Paths of two segments that landing brings half of and each of the two points of a light a quarter.
            for half in 0..2 {
                evidence.add(brought(1.0, 0, 3, HALF));
                evidence.add(brought(0.5, 1, 2, HALF));
                evidence.add(brought(0.5, 1, 2, HALF));
                if half == 1 {
                    evidence.end_pair(0, evidence.len() - 3);
                }
            }
        }
        let pilot = Stage::of(&Techniques { next_event: 2.0, ..Techniques::PATH });
        let errors = evidence.errors(&[pilot]);
        assert!(errors[0].abs() < 1e-12, "{errors:?}");
    }

    /// Next event at a vertex whose own brightness varies: more points of lights do not help.
    #[test]
    fn what_samples_have_in_common_does_not_average_out() {
        let mut evidence = one_block();
        for i in 0..100 {
            for half in 0..2 {
                let value = if (i + half) % 2 == 0 { 2.0 } else { 0.0 };
                let middle = evidence.len();
                evidence.add(brought(0.5 * value, 1, 2, [0.0, 1.0, 0.0, 0.0, 0.0]));
                evidence.add(brought(0.5 * value, 1, 2, [0.0, 1.0, 0.0, 0.0, 0.0]));
                if half == 1 {
                    evidence.end_pair(0, middle);
                }
            }
        }
        let with = |next_event: f64| Stage::of(&Techniques { next_event, ..Techniques::PATH });
        let errors = evidence.errors(&[with(1.0), with(2.0), with(4.0)]);
        // Every pair has one bright sample and one dark one: (2 − 0)² / 2 over 1 + ε.
        assert!(errors.iter().all(|error| (error - 2.0 / 1.01).abs() < 1e-9), "{errors:?}");
    }

    #[test]
    fn the_error_of_a_rare_path_falls_with_its_density() {
        let mut evidence = one_block();
        let shares = [0.01, 0.0, 0.0, 0.99, 0.0];
        for i in 0..10 {
            if i == 0 {
                evidence.splat(0, brought(1.0, 3, 1, shares));
            }
            evidence.end_pair(0, 0);
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
            evidence.end_pair(0, 0);
            evidence
        };
        let (mut ab, mut ba) = (part(1.0), part(3.0));
        ab.merge(part(3.0));
        ba.merge(part(1.0));
        let stage = [Stage::of(&Techniques::PATH)];
        assert_eq!(ab.errors(&stage), ba.errors(&stage));
        assert_eq!(ab.pairs(), 2);
    }
}
