//! How noisy the contributions of a plan are, told by size: the largest may be so rare that the plan itself would not have been seen to
//! make them.

/// Second moments of contributions, by how large each one is: a power of two each.
#[derive(Clone, Debug)]
pub(super) struct Moments {
    bins: [Bin; Self::BINS],
}

/// Elusive contributions of one size.
#[derive(Clone, Copy, Debug, Default)]
struct Bin {
    /// How many a sample has.
    number: f64,
    /// The sum of their squares.
    squares: f64,
}

impl Default for Moments {
    fn default() -> Self {
        Self { bins: [Bin::default(); Self::BINS] }
    }
}

impl Moments {
    /// From 2^−64 to 2^64; what is beyond is with the last ones.
    const BINS: usize = 128;

    fn bin(square: f64) -> usize {
        let exponent = (square.to_bits() >> 52 & 0x7ff) as i32 - 1023;
        (exponent + Self::BINS as i32 / 2).clamp(0, Self::BINS as i32 - 1) as usize
    }

    /// The least square in a bin.
    pub(super) fn least(bin: usize) -> f64 {
        2.0_f64.powi(bin as i32 - Self::BINS as i32 / 2)
    }

    /// An elusive contribution: its square, and how much more densely the plan makes it than the pilot did. Returns its bin.
    pub(super) fn take(&mut self, density: f64, square: f64, per_sample: f64) -> u8 {
        let at = Self::bin(square);
        let bin = &mut self.bins[at];
        bin.number += density * per_sample;
        bin.squares += density * square * per_sample;
        at as u8
    }

    /// The first bin of those largest contributions that a sample has less than so many of.
    pub(super) fn rarest(&self, number: f64) -> usize {
        let mut sum = 0.0;
        let past = self.bins.iter().rposition(|bin| {
            sum += bin.number;
            sum > number
        });
        past.map_or(0, |bin| bin + 1)
    }

    /// The second moments from that bin on.
    pub(super) fn squares(&self, from: usize) -> f64 {
        self.bins[from..].iter().map(|bin| bin.squares).sum()
    }
}
