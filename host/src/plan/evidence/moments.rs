//! How noisy the contributions of a plan are, told by size: which are so rare that the plan itself would not have been seen to make
//! them, and which rarer still, so that a trimmed error leaves them out.

use std::cmp::Ordering;

use super::{Brought, Counts};

/// Second moments of contributions, by how large each one is: a power of two each.
#[derive(Clone, Debug)]
pub(super) struct Moments {
    bins: [Bin; Self::BINS],
    /// Whether there is one that the plan never makes.
    pub(super) missed: bool,
}

/// Contributions of one size.
#[derive(Clone, Copy, Debug, Default)]
struct Bin {
    /// How many a sample has.
    all: f64,
    /// How many elusive ones.
    number: f64,
    /// The sum of their squares.
    squares: f64,
}

impl Default for Moments {
    fn default() -> Self {
        Self { bins: [Bin::default(); Self::BINS], missed: false }
    }
}

impl Moments {
    /// From 2^−64 to 2^64; what is beyond is with the last ones.
    const BINS: usize = 128;

    pub(super) fn bin(square: f64) -> usize {
        let exponent = (square.to_bits() >> 52 & 0x7ff) as i32 - 1023;
        (exponent + Self::BINS as i32 / 2).clamp(0, Self::BINS as i32 - 1) as usize
    }

    /// A contribution of the pilot, as the plan would make it: `per` sample.
    pub(super) fn take(&mut self, counts: &Counts, brought: &Brought, importance: f64, per: f64) {
        let density = counts.density(brought);
        if density == 0.0 {
            self.missed = true;
            return;
        }
        let square = counts.square(brought, importance);
        let Bin { all, number, squares } = &mut self.bins[Self::bin(square)];
        *all += density * per;
        if counts.elusive(brought) {
            *number += density * per;
            *squares += density * square * per;
        }
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

    /// Where to cut off so many of the largest.
    pub(super) fn cut(&self, mut spare: f64) -> Cut {
        let mut cut = Cut { bin: Self::BINS, share: 0.0 };
        for (bin, &Bin { all: number, .. }) in self.bins.iter().enumerate().rev().filter(|(_, bin)| bin.all > 0.0) {
            cut = Cut { bin, share: (spare / number).min(1.0) };
            spare -= number;
            if spare <= 0.0 {
                break;
            }
        }
        cut
    }

    /// The second moments from that bin on, but for what is cut off.
    pub(super) fn kept(&self, from: usize, cut: &Cut) -> f64 {
        self.bins.iter().enumerate().skip(from).map(|(bin, of)| of.squares * (1.0 - cut.share_of(bin))).sum()
    }
}

/// What is trimmed: every contribution larger than those of this bin, and some of its.
pub(super) struct Cut {
    bin: usize,
    share: f64,
}

impl Cut {
    /// What is missing where such a path is trimmed, if it is elusive.
    pub(super) fn left_of(&self, counts: &Counts, brought: &Brought, importance: f64) -> f64 {
        let share = self.share_of(Moments::bin(counts.square(brought, importance)));
        if share > 0.0 && counts.elusive(brought) { share * brought.value } else { 0.0 }
    }

    /// How much of a bin is trimmed.
    fn share_of(&self, bin: usize) -> f64 {
        match bin.cmp(&self.bin) {
            Ordering::Less => 0.0,
            Ordering::Equal => self.share,
            Ordering::Greater => 1.0,
        }
    }
}
