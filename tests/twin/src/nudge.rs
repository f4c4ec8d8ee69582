//! Rounding as an experiment: f64 numbers moved by what f32 would have rounded away.

use std::cell::Cell;

/// A stream of small moves; none at all for the runs that are compared.
#[derive(Debug)]
pub struct Nudge {
    state: Cell<u64>,
    active: bool,
}

/// An f32 number is rounded by half of this, relatively; each of the numbers moved here is the result of several roundings.
const STEP: f64 = f32::EPSILON as f64;

impl Nudge {
    /// Moves by the stream of this seed, or not at all.
    pub fn new(seed: Option<u64>) -> Self {
        Self { state: Cell::new(seed.unwrap_or(0).wrapping_mul(0xd134_2543_de82_ef95)), active: seed.is_some() }
    }

    /// Whether anything is moved.
    pub fn active(&self) -> bool {
        self.active
    }

    /// `x` moved by up to one step of f32 at a number as large as `size`.
    pub fn about(&self, x: f64, size: f64) -> f64 {
        if self.active { x + STEP * size * self.next() } else { x }
    }

    /// `x` moved relatively.
    pub fn number(&self, x: f64) -> f64 {
        self.about(x, x.abs())
    }

    /// Each component moved by a step at `size`.
    pub fn vector(&self, v: [f64; 3], size: f64) -> [f64; 3] {
        v.map(|x| self.about(x, size))
    }

    /// A random number in [0, 1), moved and still there: what leaves at an end comes back.
    pub fn random(&self, u: f64) -> f64 {
        if !self.active {
            return u;
        }
        let moved = self.about(u, 1.0).abs();
        if moved < 1.0 { moved } else { 2.0 - moved - STEP / 4.0 }
    }

    /// −1 … 1.
    fn next(&self) -> f64 {
        let state = self.state.get().wrapping_add(0x9e37_79b9_7f4a_7c15);
        self.state.set(state);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 * (2.0 / 9_007_199_254_740_992.0) - 1.0
    }
}
