//! How noisy the contributions of a plan are, told by size: the largest may be so rare that the plan itself would not have been seen to
//! make them, or that they are left out of a trimmed error.

use crate::image::trim::TRIM;

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

    /// The second moments from that bin on, as a render of so many samples per pixel has them when its error is trimmed: without the
    /// largest contributions, as many as fall on pixels that are left out, and so many more. Of numbers and squares, a sample has one in so
    /// many.
    pub(super) fn squares(&self, from: usize, samples: f64, one_in: f64, spared: f64) -> f64 {
        let mut left_out = TRIM * one_in / samples + spared;
        let kept = self.bins[from..].iter().rev().map(|bin| {
            let out = left_out.min(bin.number);
            left_out -= out;
            if out < bin.number { bin.squares * (1.0 - out / bin.number) } else { 0.0 }
        });
        kept.sum::<f64>() / one_in
    }

    /// Takes in others.
    pub(super) fn merge(&mut self, other: &Self) {
        for (own, other) in self.bins.iter_mut().zip(&other.bins) {
            own.number += other.number;
            own.squares += other.squares;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_in_few_pixels_is_trimmed() {
        let mut moments = Moments::default();
        // In a thousand samples: one of 4096, two of 64, four of 1.
        for (number, square) in [(1, 4096.0), (2, 64.0), (4, 1.0)] {
            (0..number).for_each(|_| _ = moments.take(1.0, square, 1.0));
        }
        let of = |samples: f64| moments.squares(0, samples, 1000.0, 0.0) * 1000.0;
        // Of a sample per pixel, a thousandth of the pixels has the largest one; of two, half as much of it is left out.
        let expected = [(1.0, 132.0), (2.0, 2048.0 + 132.0), (0.5, 68.0), (1e9, 4228.0)];
        assert!(expected.iter().all(|&(samples, squares)| (of(samples) - squares).abs() < 1e-2), "{:?}", expected.map(|(n, _)| of(n)));
        assert_eq!(moments.squares(0, f64::INFINITY, 1000.0, 0.0), 4.228);
    }
}
