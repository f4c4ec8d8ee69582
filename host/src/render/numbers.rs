//! Where a sample's random numbers come from.

use bidir_kernel::{
    Effects, Sampler, Walk,
    sampler::{DIMENSIONS_PER_VERTEX, Independent},
};
use serde::Serialize;
use sobol_burley::parts;

use crate::scene::{
    Scene,
    preset::{Full, Task},
};

/// Kinds of random numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Numbers {
    /// Owen-scrambled Sobol' points: the samples of a pixel keep their distance from each other.
    #[default]
    Sobol,
    /// Each number for itself.
    Independent,
}

/// The random numbers of one sample of every pixel.
pub trait Source {
    /// Those of one pixel.
    type OfPixel<'a>: Sampler
    where
        Self: 'a;

    /// Sample `index` under `seed`.
    fn new(seed: u64, index: u32) -> Self;

    /// The numbers of a pixel.
    fn pixel(&self, pixel: u64) -> Self::OfPixel<'_>;

    /// Does a task with a preset that covers the scene and what else is `needed`.
    fn with_preset<T: Task>(scene: &Scene, needed: Effects, task: T) -> T::Output;

    /// The same, with one that has light walks.
    fn with_light_walks<T: Task>(scene: &Scene, needed: Effects, task: T) -> T::Output;
}

/// [`Numbers::Independent`].
pub struct Apart {
    seed: u64,
    index: u32,
}

impl Source for Apart {
    type OfPixel<'a> = Independent;

    fn new(seed: u64, index: u32) -> Self {
        Self { seed, index }
    }

    fn pixel(&self, pixel: u64) -> Independent {
        Independent::new(self.seed, pixel, u64::from(self.index))
    }

    /// The one for any scene: these numbers are there to be compared with, and not compiled for every preset.
    fn with_preset<T: Task>(_: &Scene, _: Effects, task: T) -> T::Output {
        task.run(Full {})
    }

    fn with_light_walks<T: Task>(_: &Scene, _: Effects, task: T) -> T::Output {
        task.run(Full {})
    }
}

/// How many vertices of a walk, its start included, get Sobol' points; what comes later is independent: there, little is left to gain.
const STRATIFIED_VERTICES: u32 = 6;
/// Dimensions of each walk that get Sobol' points.
const STRATIFIED: u32 = STRATIFIED_VERTICES * DIMENSIONS_PER_VERTEX;
/// How long the sequence is; then it begins again, scrambled anew.
const LENGTH: u32 = 1 << 16;

/// Points of the Sobol' sequence for the first vertices of each walk, scrambled apart for each pixel (Burley 2020, "Practical Hash-based
/// Owen Scrambling"). Samples of even and of odd number each go through the sequence under a scramble of their own: the two
/// halves of a render stay independent, and with them its estimate of its own error.
pub struct Sobol {
    apart: Apart,
    seed: u32,
    /// The unscrambled point, its bits reversed: the camera walk's dimensions, then the light walk's. All pixels share it.
    point: [u32; 2 * STRATIFIED as usize],
}

/// The Sobol' points of one pixel's sample.
#[derive(Clone, Copy)]
pub struct Scrambled<'a> {
    point: &'a [u32; 2 * STRATIFIED as usize],
    seed: u32,
    /// Into `point`; at its end or beyond, numbers come from `rest`.
    next: u32,
    rest: Independent,
}

impl Source for Sobol {
    type OfPixel<'a> = Scrambled<'a>;

    fn new(seed: u64, index: u32) -> Self {
        let (half, turn) = (index % 2, index / 2);
        let words = [seed as u32, (seed >> 32) as u32, half, turn / LENGTH];
        let reversed = (turn % LENGTH).reverse_bits();
        Self {
            apart: Apart { seed, index },
            seed: words.into_iter().fold(0, |hashed, word| parts::hash(hashed.wrapping_add(0x9e37_79b9) ^ word)),
            point: std::array::from_fn(|dimension| parts::sobol_rev(reversed, dimension as u32)),
        }
    }

    #[inline]
    fn pixel(&self, pixel: u64) -> Scrambled<'_> {
        let seed = parts::hash(parts::hash(self.seed ^ pixel as u32) ^ (pixel >> 32) as u32);
        Scrambled { point: &self.point, seed, next: 0, rest: self.apart.pixel(pixel) }
    }

    fn with_preset<T: Task>(scene: &Scene, needed: Effects, task: T) -> T::Output {
        scene.with_smallest_preset(needed, task)
    }

    fn with_light_walks<T: Task>(scene: &Scene, needed: Effects, task: T) -> T::Output {
        scene.with_light_walks(needed, task)
    }
}

impl Sampler for Scrambled<'_> {
    #[inline(always)]
    fn seek(&mut self, walk: Walk, dimension: u32) {
        if dimension < STRATIFIED {
            self.next = walk as u32 * STRATIFIED + dimension;
        } else {
            self.next = u32::MAX;
            self.rest.seek(walk, dimension);
        }
    }

    #[inline(always)]
    fn next(&mut self) -> f32 {
        let Some(&point) = self.point.get(self.next as usize) else { return further(&mut self.rest) };
        let scramble = parts::hash(self.seed.wrapping_add(self.next.wrapping_mul(0x9e37_79b9)));
        self.next += 1;
        // The upper 24 bits fill an f32 exactly.
        (parts::owen_scramble_rev(point, scramble).reverse_bits() >> 8) as f32 * (1.0 / 16_777_216.0)
    }
}

/// What comes after the Sobol' points.
#[inline(never)]
fn further(rest: &mut Independent) -> f32 {
    rest.next()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(walk: Walk, dimension: u32, samples: u32) -> Vec<f32> {
        let number = |index| {
            let source = Sobol::new(1, index);
            let mut sobol = source.pixel(7);
            sobol.seek(walk, dimension);
            sobol.next()
        };
        (0..samples).map(number).collect()
    }

    #[test]
    fn each_half_of_the_samples_puts_one_number_into_each_stratum() {
        for (walk, dimension) in [(Walk::Camera, 0), (Walk::Camera, 12), (Walk::Light, 5), (Walk::Light, 40)] {
            let all = numbers(walk, dimension, 128);
            for half in [0, 1] {
                let mut strata: Vec<_> = all.iter().skip(half).step_by(2).map(|u| (u * 64.0) as usize).collect();
                strata.sort_unstable();
                assert_eq!(strata, (0..64).collect::<Vec<_>>());
            }
        }
    }

    #[test]
    fn walks_and_halves_do_not_know_of_each_other() {
        let number = |pixel, index, walk| {
            let source = Sobol::new(1, index);
            let mut sobol = source.pixel(pixel);
            sobol.seek(walk, 4);
            sobol.next() - 0.5
        };
        // Over scrambles, a product of two independent numbers, each scaled to variance 1, has mean 0 and variance 1.
        let pixels = 16_384;
        let correlation = |a: (u32, Walk), b: (u32, Walk)| {
            let product = |pixel| 12.0 * number(pixel, a.0, a.1) * number(pixel, b.0, b.1);
            (0..pixels).map(product).sum::<f32>() / pixels as f32
        };
        // Four standard deviations: by chance once in 16,000.
        let threshold = 4.0 / (pixels as f32).sqrt();
        let (camera, light) = (Walk::Camera, Walk::Light);
        for (a, b) in [((6, camera), (6, light)), ((6, camera), (7, camera)), ((6, light), (7, light)), ((6, camera), (7, light))] {
            let correlation = correlation(a, b);
            assert!(correlation.abs() < threshold, "{a:?} and {b:?}: {correlation}, threshold {threshold}");
        }
    }

    #[test]
    fn numbers_do_not_depend_on_what_was_asked_before() {
        let source = Sobol::new(3, 9);
        let mut sobol = source.pixel(5);
        sobol.seek(Walk::Camera, 9);
        let first = sobol.next();
        sobol.seek(Walk::Light, 1 << 20);
        let far = sobol.next();
        sobol.seek(Walk::Camera, 8);
        let pair = sobol.next_pair();
        sobol.seek(Walk::Light, 1 << 20);
        assert_eq!((first, far), (pair[1], sobol.next()));
    }
}
