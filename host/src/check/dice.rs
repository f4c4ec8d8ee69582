//! The numbers that questions are made of.

use bidir_kernel::{Real, Vec3};

/// Random numbers (SplitMix64; Steele, Lea & Flood 2014): the same for the same stream, on every machine.
#[derive(Clone, Debug)]
pub(super) struct Dice(u64);

const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

fn mix(z: u64) -> u64 {
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// The number of stream `index` under `seed`.
pub(super) fn stream(seed: u64, index: u64) -> u64 {
    mix(mix(seed ^ GOLDEN).wrapping_add(index.wrapping_mul(GOLDEN)))
}

impl Dice {
    pub(super) fn new(stream: u64) -> Self {
        Self(mix(stream))
    }

    pub(super) fn roll(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(GOLDEN);
        mix(self.0)
    }

    pub(super) fn below(&mut self, end: usize) -> usize {
        (self.roll() % end.max(1) as u64) as usize
    }

    /// In [0, 1), as samplers give it: 24 bits fill an f32.
    pub(super) fn real(&mut self) -> Real {
        (self.roll() >> 40) as Real * (1.0 / 16_777_216.0)
    }

    /// In [0, 1), with all the digits there are.
    pub(super) fn exact(&mut self) -> f64 {
        (self.roll() >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0)
    }

    pub(super) fn pair(&mut self) -> [Real; 2] {
        [self.real(), self.real()]
    }

    pub(super) fn three(&mut self) -> [Real; 3] {
        [self.real(), self.real(), self.real()]
    }

    /// Uniform over the sphere.
    pub(super) fn direction(&mut self) -> Vec3 {
        let (z, phi) = (2.0 * self.exact() - 1.0, core::f64::consts::TAU * self.exact());
        let r = (1.0 - z * z).max(0.0).sqrt();
        Vec3::new((r * phi.cos()) as Real, (r * phi.sin()) as Real, z as Real)
    }

    /// `w`, off by as much as rounding may move any of its coordinates, and a little more.
    pub(super) fn nudged(&mut self, w: Vec3) -> Vec3 {
        let bits = self.roll();
        let step = |bit: u64| if bits >> bit & 1 == 0 { NUDGE } else { -NUDGE };
        w + Vec3::new(step(0), step(1), step(2))
    }
}

/// Two units in the last place of a number just below 1, twice over.
const NUDGE: Real = 2.0 * Real::EPSILON;
