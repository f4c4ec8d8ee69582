//! One random number for many decisions.

use bidir_kernel::{Point, Real};

/// A number in [0, 1) that decides again and again. Each decision leaves the place of the number within what it chose, which is as good
/// as new but has fewer digits. A sampler gives 24 bits; those after them are hashed from these and the receiver's position, and
/// once decisions of less than 2^−24 together are made, all of them are. So a chance however small is met as often as it says, over
/// receivers, while the sampler's own bits stay in order for the decisions that they can tell apart.
pub(super) struct Draw {
    u: f64,
    /// The chance of all that was decided with `u`.
    spent: f64,
    key: u64,
}

/// What a sampler's numbers are multiples of, and the least chance of a decision.
pub(super) const STEP: f64 = 1.0 / (1 << 24) as f64;

const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// SplitMix64's finaliser (Steele, Lea & Flood 2014).
fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

impl Draw {
    /// From a sampler's number, for a receiver.
    #[inline]
    pub fn new(u: Real, lit: &Point) -> Self {
        let words = |low: f32, high: f32| u64::from(low.to_bits()) | u64::from(high.to_bits()) << 32;
        let position = lit.position;
        let key = mix(mix(words(u, position.x) ^ GOLDEN).wrapping_add(words(position.y, position.z)));
        Self { u: f64::from(u) + (key >> 35) as f64 * (STEP / (1_u64 << 29) as f64), spent: 1.0, key }
    }

    /// True with this chance: 0, 1, or not less than [`STEP`] from either.
    #[inline]
    pub fn is_below(&mut self, chance: f64) -> bool {
        let below = self.u < chance;
        let (start, width) = if below { (0.0, chance) } else { (chance, 1.0 - chance) };
        self.spent *= width;
        if self.spent < STEP {
            self.key = mix(self.key.wrapping_add(GOLDEN));
            self.u = (self.key >> 11) as f64 * (1.0 / (1_u64 << 53) as f64);
            self.spent = 1.0;
        } else {
            self.u = ((self.u - start) / width).min(1.0 - f64::EPSILON / 2.0);
        }
        below
    }

    /// The number as it is now.
    #[inline]
    pub fn left(&self) -> f64 {
        self.u
    }
}
