//! What a plan's own runs vary by, and will at the end of a longer render.

use bidir_kernel::Join;

use super::{Counts, Made};

/// What runs of camera paths vary by, beyond the second moments of their contributions: by their length, which doubles from 1 on.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Spread {
    lengths: [f64; Self::LENGTHS],
    /// What making only some of the connections adds to all lengths.
    all: f64,
    /// How many lengths the runs had.
    known: usize,
    places: f64,
}

impl Spread {
    /// Runs of up to 32 samples.
    const LENGTHS: usize = 6;

    /// A pixel that was looked at, with its two runs in turn; what is rare is left out of them.
    pub(super) fn place<'a>(&mut self, counts: &Counts, paths: impl Iterator<Item = &'a [Made]>, importance: f64, rare: usize) {
        let mut runs = [[0.0; 1 << (Self::LENGTHS - 1)]; 2];
        let (mut number, mut all) = (0, 0.0);
        for path in paths {
            let mut one = Sample::default();
            for made in path.iter().filter(|made| !made.rare(rare)) {
                one.add(made);
            }
            if let Some(slot) = runs[number % 2].get_mut(number / 2) {
                *slot = one.total;
                all += one.rationed(counts);
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

    /// Of one of so many samples per pixel.
    pub(super) fn at(&self, samples: f64) -> f64 {
        if self.places == 0.0 {
            return 0.0;
        }
        let of = |level: usize| ((self.lengths[level] + self.all) / self.places).max(0.0);
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
pub(super) const SLOPE: f64 = 0.75;
/// Doublings for which an error may fall so.
const FARTHEST: f64 = 2.0;

/// What a camera path and its light path would have brought.
#[derive(Clone, Copy, Debug, Default)]
struct Sample {
    total: f64,
    connected: f64,
    squares: f64,
}

impl Sample {
    fn add(&mut self, made: &Made) {
        self.total += made.count * made.value;
        if made.connection {
            self.connected += made.value;
            self.squares += made.value * made.value;
        }
    }

    /// What making only some of the connections adds.
    fn rationed(&self, counts: &Counts) -> f64 {
        let count = counts.of[Join::Connection as usize];
        let Self { connected, squares, .. } = self;
        counts.both_connected * (connected * connected - squares) + count * squares - count * count * connected * connected
    }
}
