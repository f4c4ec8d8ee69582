//! Rows 49 and 50: paths so long and densities so large that f32 loses them.

use super::{
    Held,
    single::oracle::{Numbers, Path, Sums, distances, sets},
};
use crate::statistics::worse;

/// Of a chain: how densely its surfaces send light on, and how far apart they lie.
#[derive(Clone, Copy, Debug)]
pub struct Chain {
    /// Decades of a direction's density, from and to.
    pub density: [f64; 2],
    /// What is a metre elsewhere,
    pub scale: f64,
    /// and how many decades nearer than that two vertices may lie: in a corner.
    pub nearer: f64,
}

/// 64 bounces off a surface with α = 1e-6: densities up to 1/(4π α²) = 8e10, and three decades less in the tails.
pub const SPECULAR: Chain = Chain { density: [8.0, 10.9], scale: 1.0, nearer: 0.5 };
/// 64 glossy bounces in a room a micrometre wide.
pub const GLOSSY: Chain = Chain { density: [-1.0, 2.0], scale: 1e-6, nearer: 3.0 };

impl Chain {
    fn path(&self, numbers: &mut Numbers) -> Path {
        let k = 65;
        let per_square = 1.0 / (self.scale * self.scale);
        let [low, high] = self.density;
        let mut many = |n: usize, low: f64, high: f64, factor: f64| (0..n).map(|_| factor * numbers.decades(low, high)).collect::<Vec<_>>();
        let (to_lens, to_light) = (many(k + 1, low, high, 1.0), many(k + 1, low, high, 1.0));
        let per_squares = many(k, 0.0, 2.0 * self.nearer, per_square);
        let mut with_cosines = || many(k, -1.0, 0.0, 1.0).iter().zip(&per_squares).map(|(cos, per_square)| cos * per_square).collect();
        let (forward, backward) = (with_cosines(), with_cosines());
        // A pinhole, which nothing lands on.
        let delta = (0..=k).map(|i| i == k).collect();
        Path { to_lens, to_light, forward, backward, delta, light_end: per_square, next_event_end: 2.0 * per_square, lens_end: 1.0 }
    }

    /// Over many such paths, and sets of joins: the weights against their definition, and their sum against 1.
    pub fn held<S: Sums>(&self) -> Vec<Held> {
        let mut numbers = Numbers(11);
        let (mut apart, mut from_one) = (0.0, 0.0);
        for _ in 0..100 {
            let path = self.path(&mut numbers);
            let found = distances::<S>(&path, &sets(&mut numbers));
            (apart, from_one) = (worse(apart, found.0), worse(from_one, found.1));
        }
        vec![Held::new("largest distance of a weight from its definition", apart, 1e-5), Held::new("|Σw − 1|", from_one, 1e-5)]
    }
}
