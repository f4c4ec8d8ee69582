//! What a pilot saw, and how noisy it says other plans would be.
//!
//! The pilot samples every technique once per camera path and keeps, with each contribution X, how the balance heuristic shared its path
//! among the kinds of join, w_j. Under counts c_j the same path is made Σ c_j w_j times as densely, so its second moment is X² over
//! that: every sample speaks for every plan, those of rare paths too, which the plan in question would hardly ever
//! make (Grittmann, Yazici, Georgiev & Křivánek 2022, "Efficiency-Aware Multiple Importance Sampling for Bidirectional Rendering
//! Algorithms").
//!
//! What is left of a plan's error is seen rather than told: each pixel that is looked at has two independent runs of a few of the render's
//! own samples, stratified as they are there, and half the square of their difference is what such a run varies by. Of the paths that the
//! plan makes itself, this takes the place of their second moments.

use bidir_kernel::{Join, Technique};

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

    /// The relMSE of one sample per pixel under each of these plans, about; infinite where a plan cannot make what the pilot saw.
    pub fn errors(&self, stages: &[Stage]) -> Vec<f64> {
        let importance = self.importance();
        stages.iter().map(|stage| self.error(stage, &importance)).collect()
    }

    fn error(&self, stage: &Stage, importance: &[f64]) -> f64 {
        let counts = Counts::of(stage);
        let mut camera = 0.0;
        for (block, paths) in self.places() {
            let mut runs = [Run::default(); 2];
            for (number, path) in paths.enumerate() {
                counts.sample(path, &mut runs[number % 2]);
            }
            camera += Run::variance(&runs) * importance[block as usize];
        }
        let splats: f64 = self.splats.iter().map(|(block, brought)| counts.moment(brought) * importance[*block as usize]).sum();
        camera / self.places.len().max(1) as f64 + splats / self.walks.max(1.0)
    }
}

/// The counts of a plan.
struct Counts {
    of: [f64; Join::COUNT],
    /// How often two pairs of vertices of the same two walks are both connected.
    both_connected: f64,
}

/// What a run of camera paths would have brought.
#[derive(Clone, Copy, Debug, Default)]
struct Run {
    samples: f64,
    total: f64,
    /// What the second moments of single paths, by all that the pilot saw, exceed those of the plan's own samples by.
    unseen: f64,
    /// What making only some of the connections adds.
    rationed: f64,
}

impl Run {
    /// Of one camera path.
    fn variance([a, b]: &[Self; 2]) -> f64 {
        if a.samples == 0.0 || b.samples == 0.0 {
            return 0.0;
        }
        let samples = a.samples + b.samples;
        let apart = a.total / a.samples - b.total / b.samples;
        // Var(a − b) = σ² (1/m + 1/n).
        let seen = apart * apart * a.samples * b.samples / samples;
        seen + (a.unseen + b.unseen + a.rationed + b.rationed) / samples
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

    fn moment(&self, brought: &Brought) -> f64 {
        if brought.value == 0.0 { 0.0 } else { brought.value * brought.value / self.density(brought) }
    }

    /// One more camera path.
    fn sample(&self, path: &[Brought], run: &mut Run) {
        let (mut connected, mut squares) = (0.0, 0.0);
        for one in path {
            let join = one.technique.join();
            let count = self.of[join as usize];
            run.unseen += self.moment(one);
            if count == 0.0 {
                continue;
            }
            let value = one.value / self.density(one);
            run.total += count * value;
            run.unseen -= count * value * value;
            if join == Join::Connection {
                connected += value;
                squares += value * value;
            }
        }
        let count = self.of[Join::Connection as usize];
        run.rationed += self.both_connected * (connected * connected - squares) + count * squares - count * count * connected * connected;
        run.samples += 1.0;
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
