//! A reconstruction filter along one axis.

use bidir_kernel::math;

use crate::{
    error::{Error, Result},
    scene::description::Filter,
};

/// How many pixels a filter may touch along one axis.
pub const MAX_TAPS: usize = 32;

/// One axis of a separable filter h(x) h(y), in pixels. Its scale is arbitrary: whoever uses it divides by what
/// arrived (Σ h) or by what could have ([`Profile::integral`]).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Profile {
    filter: Filter,
    radius: f64,
    /// What a gaussian is lowered by, so that it ends at 0.
    edge: f64,
    /// exp(−1/σ²) of a gaussian.
    fall: f64,
}

impl Profile {
    /// Refuses filters that are empty or wider than [`MAX_TAPS`] pixels.
    pub fn new(filter: Filter) -> Result<Self> {
        let radius = match filter {
            Filter::Box => 0.5,
            Filter::Tent { radius } => radius,
            Filter::Gaussian { stddev } => 4.0 * stddev,
            Filter::Cubic { .. } => 2.0,
            Filter::Lanczos { lobes } => lobes,
        };
        let widest = (MAX_TAPS / 2 - 1) as f64;
        if !(radius > 0.0 && radius <= widest) {
            let thing = format!("a reconstruction filter with a radius of {radius} pixels is not supported");
            return Err(Error::new(thing, format!("choose a radius above 0 and up to {widest}; a gaussian's is 4 stddev")));
        }
        let (edge, fall) = match filter {
            Filter::Gaussian { stddev } => (bell(radius, stddev), exp(-1.0 / (stddev * stddev))),
            _ => (0.0, 0.0),
        };
        Ok(Self { filter, radius, edge, fall })
    }

    /// How many pixels beyond its own a sample can reach, along one axis.
    pub fn reach(&self) -> u32 {
        (self.radius - 0.5).ceil().max(0.0) as u32
    }

    /// h at a signed distance in pixels.
    #[inline]
    pub fn at(&self, distance: f64) -> f64 {
        match self.filter {
            Filter::Box => f64::from((-0.5..0.5).contains(&distance)),
            Filter::Tent { radius } => (1.0 - distance.abs() / radius).max(0.0),
            Filter::Gaussian { stddev } => (bell(distance, stddev) - self.edge).max(0.0),
            Filter::Cubic { .. } | Filter::Lanczos { .. } => ringing(&self.filter, distance.abs()),
        }
    }

    /// The pixels whose filters a sample at `raster` falls into, and the weights they give it.
    #[inline]
    pub fn taps(&self, raster: f64, taps: &mut Taps) {
        let (first, last) = self.span(raster);
        taps.first = first;
        taps.count = ((last - first + 1).max(0) as usize).min(MAX_TAPS);
        let distance = raster - (f64::from(first) + 0.5);
        let weights = &mut taps.weights[..taps.count];
        match self.filter {
            Filter::Box => weights.fill(1.0),
            Filter::Tent { .. } | Filter::Cubic { .. } | Filter::Lanczos { .. } => {
                weights.iter_mut().enumerate().for_each(|(i, w)| *w = self.at(distance - i as f64))
            }
            Filter::Gaussian { stddev } => {
                // g(x − 1) = g(x) r with r = exp((2x − 1)/2σ²), and r falls by exp(−1/σ²) with each step. No factor leaves
                // exp(−8) … exp(8): x starts at the radius, 4σ.
                let scale = 0.5 / (stddev * stddev);
                let mut value = bell(distance, stddev);
                let mut ratio = exp((2.0 * distance - 1.0) * scale);
                for weight in weights {
                    *weight = (value - self.edge).max(0.0);
                    value *= ratio;
                    ratio *= self.fall;
                }
            }
        }
    }

    /// The first and the last pixel of [`Profile::taps`].
    #[inline]
    pub fn span(&self, raster: f64) -> (i32, i32) {
        match self.filter {
            Filter::Box => (raster.floor() as i32, raster.floor() as i32),
            _ => ((raster - self.radius - 0.5).ceil() as i32, (raster + self.radius - 0.5).floor() as i32),
        }
    }

    /// ∫ h from `from` to `to`, distances in pixels.
    pub fn integral(&self, from: f64, to: f64) -> f64 {
        self.primitive(to) - self.primitive(from)
    }

    /// ∫ h from 0 to x; odd in x.
    fn primitive(&self, x: f64) -> f64 {
        let d = x.abs().min(self.radius);
        let half = match self.filter {
            Filter::Box => d,
            Filter::Tent { radius } => d - 0.5 * d * d / radius,
            Filter::Gaussian { stddev } => {
                let share = libm::erf(d / (stddev * std::f64::consts::SQRT_2));
                stddev * (0.5 * std::f64::consts::PI).sqrt() * share - d * self.edge
            }
            Filter::Cubic { b, c } => simpson(d, |x| cubic(x, b, c)),
            Filter::Lanczos { lobes } => simpson(d, |x| lanczos(x, lobes)),
        };
        half.copysign(x)
    }
}

/// A filter with negative lobes at x ≥ 0. Apart, so that the others stay short.
#[inline(never)]
fn ringing(filter: &Filter, x: f64) -> f64 {
    match *filter {
        Filter::Cubic { b, c } => cubic(x, b, c),
        Filter::Lanczos { lobes } => lanczos(x, lobes),
        _ => 0.0,
    }
}

/// At x ≥ 0.
fn cubic(x: f64, b: f64, c: f64) -> f64 {
    if x < 1.0 {
        ((12.0 - 9.0 * b - 6.0 * c) * x * x * x + (12.0 * b + 6.0 * c - 18.0) * x * x + 6.0 - 2.0 * b) / 6.0
    } else if x < 2.0 {
        ((-b - 6.0 * c) * x * x * x + (6.0 * b + 30.0 * c) * x * x - (12.0 * b + 48.0 * c) * x + 8.0 * b + 24.0 * c) / 6.0
    } else {
        0.0
    }
}

/// At x ≥ 0.
fn lanczos(x: f64, lobes: f64) -> f64 {
    let turn = std::f64::consts::PI * x;
    if x >= lobes {
        0.0
    } else if x < 1e-6 {
        1.0
    } else {
        libm::sin(turn) * libm::sin(turn / lobes) / (turn * turn / lobes)
    }
}

/// ∫ from 0 to `end` by Simpson's rule, piece by piece of 1: the error is below 1e-6, and 0 of cubics.
fn simpson(end: f64, f: impl Fn(f64) -> f64) -> f64 {
    const STEPS: u32 = 16;
    let pieces = end.ceil().max(0.0) as u32;
    let piece = |i: u32| {
        let from = f64::from(i);
        let step = (end.min(from + 1.0) - from) / f64::from(STEPS);
        let weight = |k: u32| if k == 0 || k == STEPS { 1.0 } else { 2.0 + 2.0 * f64::from(k % 2) };
        (0..=STEPS).map(|k| weight(k) * f(from + f64::from(k) * step)).sum::<f64>() * step / 3.0
    };
    (0..pieces).map(piece).sum()
}

/// exp(−x²/2σ²).
#[inline]
fn bell(x: f64, stddev: f64) -> f64 {
    exp(-0.5 * x * x / (stddev * stddev))
}

/// The kernel's, so that it has the same bits everywhere.
#[inline]
fn exp(x: f64) -> f64 {
    f64::from(math::exp(x as f32))
}

/// Consecutive pixels and their weights.
#[derive(Clone, Debug)]
pub struct Taps {
    /// The first pixel; may be outside the film.
    pub first: i32,
    count: usize,
    weights: [f64; MAX_TAPS],
}

impl Taps {
    /// Room for any filter's.
    pub const EMPTY: Self = Self { first: 0, count: 0, weights: [0.0; MAX_TAPS] };

    /// The part inside `start .. end`: its first pixel relative to `start`, and its weights.
    #[inline]
    pub fn within(&self, start: i32, end: i32) -> (usize, &[f64]) {
        let skipped = ((start - self.first).max(0) as usize).min(self.count);
        let kept = ((end - self.first).max(0) as usize).clamp(skipped, self.count);
        ((self.first + skipped as i32 - start).max(0) as usize, &self.weights[skipped..kept])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Filter; 7] = [
        Filter::Box,
        Filter::Tent { radius: 1.0 },
        Filter::Gaussian { stddev: 0.5 },
        Filter::Gaussian { stddev: 0.8 },
        Filter::Cubic { b: 1.0 / 3.0, c: 1.0 / 3.0 },
        Filter::Cubic { b: 0.0, c: 0.5 },
        Filter::Lanczos { lobes: 3.0 },
    ];

    #[test]
    fn the_integral_is_that_of_the_values() {
        for filter in ALL {
            let profile = Profile::new(filter).expect("a filter in range");
            for (from, to) in [(-9.0, 9.0), (-0.5, 1.25), (-3.0, -0.2), (0.0, 0.4)] {
                let n = 20_000;
                let step = (to - from) / f64::from(n);
                let sum: f64 = (0..n).map(|i| profile.at(from + (f64::from(i) + 0.5) * step) * step).sum();
                let allowed = if filter == Filter::Box { step } else { 1e-6 };
                assert!((profile.integral(from, to) - sum).abs() <= allowed, "{filter:?}");
            }
        }
    }

    /// Mitsuba 3.9's own evaluation at these distances, to the precision of its polynomial exponential.
    #[test]
    fn the_gaussian_is_mitsubas() {
        let profile = Profile::new(Filter::Gaussian { stddev: 0.5 }).expect("a filter in range");
        for (x, h) in [(0.0, 0.99925), (0.25, 0.88217), (0.5, 0.60642), (1.0, 0.13496), (1.5, 0.01076), (2.0, 0.0)] {
            assert!((profile.at(x) - h).abs() < 5e-4, "{x}: {} {h}", profile.at(x));
        }
    }

    #[test]
    fn taps_hold_every_pixel_in_reach_and_no_other() {
        for filter in ALL {
            let profile = Profile::new(filter).expect("a filter in range");
            let reach = profile.reach() as i32;
            for i in 0..=1000 {
                let raster = 40.0 + f64::from(i) / 1000.0;
                let mut taps = Taps::EMPTY;
                profile.taps(raster, &mut taps);
                let (start, weights) = taps.within(0, 100);
                for pixel in 0..100 {
                    let expected = profile.at(raster - (f64::from(pixel) + 0.5));
                    let found = (pixel as usize).checked_sub(start).and_then(|k| weights.get(k)).copied().unwrap_or(0.0);
                    if filter == Filter::Box {
                        assert_eq!(found, f64::from(pixel == raster.floor() as i32));
                    } else {
                        assert!((found - expected).abs() < 1e-5);
                    }
                    assert!(found == 0.0 || i == 1000 || (pixel - 40).abs() <= reach);
                }
            }
        }
    }

    #[test]
    fn a_filter_too_wide_or_empty_is_refused() {
        for filter in [Filter::Tent { radius: 0.0 }, Filter::Tent { radius: f64::NAN }, Filter::Gaussian { stddev: 4.0 }] {
            assert!(Profile::new(filter).is_err());
        }
    }
}
