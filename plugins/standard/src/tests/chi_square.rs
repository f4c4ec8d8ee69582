//! Pearson's χ² test of directions against their density.

use std::{vec, vec::Vec};

use bidir_sdk::{
    Real, Vec3,
    math::{atan2, vec3},
};

/// Bins of equal solid angle: in the cosine, and in the azimuth.
const BINS: (usize, usize) = (16, 32);
const TAU: f64 = 2.0 * core::f64::consts::PI;

/// How many directions fell into each bin.
pub struct Histogram {
    counts: Vec<u32>,
    /// All samples, those without a direction too.
    pub samples: u32,
}

impl Histogram {
    /// Empty.
    pub fn new() -> Self {
        Self { counts: vec![0; BINS.0 * BINS.1], samples: 0 }
    }

    /// One more sample.
    pub fn add(&mut self, sampled: Option<Vec3>) {
        self.samples += 1;
        let Some(w) = sampled else { return };
        let row = ((f64::from(w.z) + 1.0) / 2.0 * BINS.0 as f64) as usize;
        let turn = f64::from(atan2(w.y, w.x)) / TAU;
        let column = (turn.rem_euclid(1.0) * BINS.1 as f64) as usize;
        self.counts[row.min(BINS.0 - 1) * BINS.1 + column.min(BINS.1 - 1)] += 1;
    }

    /// The share of samples that have a direction.
    pub fn share(&self) -> f64 {
        f64::from(self.counts.iter().sum::<u32>()) / f64::from(self.samples)
    }

    /// The statistic, as standard deviations of a normal variable (Wilson & Hilferty 1931). Bins that expect fewer than
    /// five samples are pooled. Samples without a direction are not in it: compare [`Histogram::share`].
    pub fn deviation(&self, masses: &[f64]) -> f64 {
        let n = f64::from(self.samples);
        let cells = masses.iter().zip(&self.counts).map(|(&mass, &count)| (n * mass, f64::from(count)));
        let (mut statistic, mut bins, mut pool) = (0.0, 0.0, (0.0, 0.0));
        let mut add = |(expected, count): (f64, f64)| {
            statistic += (count - expected) * (count - expected) / expected;
            bins += 1.0;
        };
        for (expected, count) in cells {
            if expected >= 5.0 {
                add((expected, count));
            } else {
                pool = (pool.0 + expected.max(0.0), pool.1 + count);
            }
        }
        if pool.0 >= 5.0 {
            add(pool);
        } else {
            assert!(pool.1 < 30.0, "{} samples fell where the density expects {:.3}", pool.1, pool.0);
        }
        let freedom: f64 = bins - 1.0;
        if freedom < 1.0 {
            return 0.0;
        }
        let v = 2.0 / (9.0 * freedom);
        ((statistic / freedom).cbrt() - (1.0 - v)) / v.sqrt()
    }
}

/// ∫ pdf over each bin, by Gauss's rule on cells that are split until they agree with their parts.
pub fn masses(pdf: &dyn Fn(Vec3) -> Real) -> Vec<f64> {
    let width = TAU / BINS.1 as f64;
    let mut out = Vec::new();
    for row in 0..BINS.0 {
        let strips = strips(row);
        // Lobes near the horizon are narrow in azimuth too.
        let cuts = if strips.len() > 3 { 8 } else { 2 };
        for column in 0..BINS.1 {
            let cell = |ends: &[f64], cut: usize| {
                let width = width / f64::from(cuts as u32);
                Cell { theta: ends[0], phi: (column * cuts + cut) as f64 * width, height: ends[1] - ends[0], width }
            };
            let cells = strips.windows(2).flat_map(|ends| (0..cuts).map(move |cut| cell(ends, cut)));
            out.push(cells.map(|cell| cell.integrate(pdf, cell.gauss(pdf), 8)).sum());
        }
    }
    out
}

/// Where a row of bins is cut before it is integrated, in angles to z: ever finer towards the horizon, where lobes seen from
/// grazing end in strips as thin as the cosine.
fn strips(row: usize) -> Vec<f64> {
    let edge = |row: usize| (row as f64 * 2.0 / BINS.0 as f64 - 1.0).acos();
    let (top, bottom) = (edge(row + 1), edge(row));
    let near = [1.0, 0.5, 0.12, 0.03, 0.007, 0.002, 0.0].map(|part| part * (bottom - top));
    if row == BINS.0 / 2 {
        near.map(|distance| bottom - distance).to_vec()
    } else if row + 1 == BINS.0 / 2 {
        near.iter().rev().map(|distance| top + distance).collect()
    } else {
        vec![top, 0.5 * (top + bottom), bottom]
    }
}

/// Part of the sphere, by the angles to z and about it: so a density that grows like 1/sin θ at the poles stays regular.
struct Cell {
    theta: f64,
    phi: f64,
    height: f64,
    width: f64,
}

impl Cell {
    fn parts(&self) -> [Cell; 4] {
        let (height, width) = (self.height / 2.0, self.width / 2.0);
        let part = |i: f64, j: f64| Cell { theta: self.theta + i * height, phi: self.phi + j * width, height, width };
        [part(0.0, 0.0), part(0.0, 1.0), part(1.0, 0.0), part(1.0, 1.0)]
    }

    fn gauss(&self, pdf: &dyn Fn(Vec3) -> Real) -> f64 {
        const NODES: [(f64, f64); 3] = [(0.112_701_665_379_258, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.887_298_334_620_742, 5.0 / 18.0)];
        let mut sum = 0.0;
        for (y, wy) in NODES {
            for (x, wx) in NODES {
                let (sin, cos) = (self.theta + y * self.height).sin_cos();
                let (sin_phi, cos_phi) = (self.phi + x * self.width).sin_cos();
                let w = vec3((sin * cos_phi) as Real, (sin * sin_phi) as Real, cos as Real);
                sum += wx * wy * sin * f64::from(pdf(w));
            }
        }
        sum * self.height * self.width
    }

    fn integrate(&self, pdf: &dyn Fn(Vec3) -> Real, whole: f64, depth: u32) -> f64 {
        let parts = self.parts();
        let sums = [0, 1, 2, 3].map(|i| parts[i].gauss(pdf));
        let sum: f64 = sums.iter().sum();
        if depth == 0 || (sum - whole).abs() < 1e-7 + 1e-4 * sum {
            return sum;
        }
        parts.iter().zip(sums).map(|(part, whole)| part.integrate(pdf, whole, depth - 1)).sum()
    }
}
