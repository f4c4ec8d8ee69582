//! How far one picture is from another.

use std::fmt;

use serde::Serialize;

use crate::{
    error::{Error, Result},
    image::{
        Image,
        trim::{TRIM, trimmed_mean},
    },
};

/// Keeps relative errors finite in black pixels.
const EPSILON: f64 = 0.01;
/// The edge of a block, in pixels.
const BLOCK: u32 = 16;
/// A pixel so many times as bright as the reference, there and in the mean, is a firefly.
const FIREFLY: f64 = 10.0;
/// A block darker than this share of the mean counts as that bright.
const DARK: f64 = 0.05;

/// A picture x against a reference r. Pixels that are not finite count as black.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// Mean over pixels and bands of (x − r)² / (r² + 0.01).
    pub relmse: f64,
    /// The same without the 0.1 % of pixels with the largest values.
    pub relmse_trimmed: f64,
    /// Mean over pixels and bands of |x − r| / (|x| + |r| + 0.01): 0 … 1.
    pub smape: f64,
    /// The share of pixels that are more than ten times as bright as r is there and in the mean.
    pub fireflies: f64,
    /// Mean of x over mean of r; 1 if both are 0. Not a number in JSON (null) where only r's is 0.
    pub mean_ratio: f64,
    /// `mean_ratio` − 1: above 0 if x is too bright.
    pub bias: f64,
    /// The same for R, G and B.
    pub bias_rgb: [f64; 3],
    /// The block that is farthest off.
    pub worst_block: Block,
    /// Root of the mean square of all blocks' deviations.
    pub block_rms: f64,
    /// Pixels of x that are not finite.
    pub nonfinite: usize,
    /// Pixels of r that are not finite.
    pub nonfinite_reference: usize,
}

/// A block of 16×16 pixels (or as many as there are); incomplete ones at the right and lower edge are left out.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Block {
    /// Its left edge, in pixels.
    pub x: u32,
    /// Its upper edge, in pixels.
    pub y: u32,
    /// (mean of x − mean of r) / max(mean of r, 5 % of the whole reference's mean); above 0 if x is too bright.
    pub deviation: f64,
}

/// Compares two pictures of one size.
pub fn compare(image: &Image, reference: &Image) -> Result<Comparison> {
    against_halves(image, [reference, reference])
}

/// Compares with a reference that comes as two independent halves a and b: r is their mean, and (x − a)(x − b) stands for (x − r)²,
/// which is free of the reference's own noise. SMAPE alone has no such form and keeps it.
pub fn against_halves(image: &Image, [a, b]: [&Image; 2]) -> Result<Comparison> {
    for other in [a, b] {
        check_sizes(image, other)?;
    }
    let pixels = image.pixels.len();
    let (mut relative, mut smape) = (Vec::with_capacity(pixels), 0.0);
    let mut whole = Means::default();
    for ((x, a), b) in image.pixels.iter().zip(&a.pixels).zip(&b.pixels) {
        let (x, a, b) = (finite(x), finite(a), finite(b));
        let reference = middle(a, b);
        let squared = |i: usize| (x[i] - a[i]) * (x[i] - b[i]) / (reference[i] * reference[i] + EPSILON);
        relative.push((squared(0) + squared(1) + squared(2)) / 3.0);
        smape += (0..3).map(|i| (x[i] - reference[i]).abs() / (x[i].abs() + reference[i].abs() + EPSILON)).sum::<f64>();
        whole.add(x, reference);
    }
    let brightness = |pixel: [f64; 3]| pixel.iter().sum::<f64>() / 3.0;
    let least = whole.reference() / pixels as f64;
    let fireflies = image
        .pixels
        .iter()
        .zip(a.pixels.iter().zip(&b.pixels))
        .filter(|(x, (a, b))| brightness(finite(x)) > FIREFLY * brightness(middle(finite(a), finite(b))).max(least));
    let fireflies = fireflies.count() as f64 / pixels as f64;
    let bad = |image: &Image| image.pixels.iter().filter(|p| !is_finite(p)).count();
    let (worst_block, block_rms) = blocks(image, [a, b], DARK * whole.reference() / pixels as f64);
    let mean_ratio = ratio(whole.image(), whole.reference());
    Ok(Comparison {
        relmse: relative.iter().sum::<f64>() / pixels as f64,
        relmse_trimmed: trimmed_mean(&mut relative, TRIM),
        smape: smape / (3 * pixels) as f64,
        fireflies,
        mean_ratio,
        bias: mean_ratio - 1.0,
        bias_rgb: std::array::from_fn(|i| ratio(whole.sums[0][i], whole.sums[1][i]) - 1.0),
        worst_block,
        block_rms,
        nonfinite: bad(image),
        nonfinite_reference: a.pixels.iter().zip(&b.pixels).filter(|(a, b)| !(is_finite(a) && is_finite(b))).count(),
    })
}

impl fmt::Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [r, g, b] = self.bias_rgb.map(|v| 100.0 * v);
        let Block { x, y, deviation } = self.worst_block;
        writeln!(f, "relMSE       {:.4e} (trimmed {:.4e})", self.relmse, self.relmse_trimmed)?;
        writeln!(f, "SMAPE        {:.4e}", self.smape)?;
        writeln!(f, "fireflies    {:.4} %", 100.0 * self.fireflies)?;
        writeln!(f, "mean bias    {:+.3} % (R {r:+.3} %, G {g:+.3} %, B {b:+.3} %)", 100.0 * self.bias)?;
        writeln!(f, "worst block  {:+.2} % at ({x}, {y}), rms {:.2} %", 100.0 * deviation, 100.0 * self.block_rms)?;
        write!(f, "non-finite   {} pixels", self.nonfinite)?;
        if self.nonfinite_reference > 0 {
            write!(f, ", {} in the reference", self.nonfinite_reference)?;
        }
        Ok(())
    }
}

fn check_sizes(image: &Image, other: &Image) -> Result<()> {
    let size = |image: &Image| format!("{}×{}", image.width, image.height);
    if (image.width, image.height) != (other.width, other.height) {
        let thing = format!("images of {} and {} pixels cannot be compared", size(image), size(other));
        return Err(Error::new(thing, "render both at one size"));
    }
    if image.pixels.is_empty() {
        return Err(Error::new("images without pixels cannot be compared", ""));
    }
    Ok(())
}

/// The block that is farthest off, and the root mean square of all.
fn blocks(image: &Image, [a, b]: [&Image; 2], darkest: f64) -> (Block, f64) {
    let (width, height) = (BLOCK.min(image.width), BLOCK.min(image.height));
    let mut worst = Block { x: 0, y: 0, deviation: 0.0 };
    let (mut squares, mut count) = (0.0, 0);
    for y in (0..=image.height - height).step_by(height as usize) {
        for x in (0..=image.width - width).step_by(width as usize) {
            let mut means = Means::default();
            for (x, y) in (y..y + height).flat_map(|row| (x..x + width).map(move |column| (column, row))) {
                means.add(finite(&image.at(x, y)), middle(finite(&a.at(x, y)), finite(&b.at(x, y))));
            }
            let pixels = f64::from(width * height);
            let (found, wanted) = (means.image() / pixels, means.reference() / pixels);
            let scale = wanted.max(darkest);
            let deviation = if found == wanted { 0.0 } else { (found - wanted) / scale };
            squares += deviation * deviation;
            count += 1;
            if deviation.abs() > worst.deviation.abs() {
                worst = Block { x, y, deviation };
            }
        }
    }
    (worst, (squares / f64::from(count)).sqrt())
}

/// Sums of a picture and its reference, per band.
#[derive(Default)]
struct Means {
    sums: [[f64; 3]; 2],
}

impl Means {
    fn add(&mut self, image: [f64; 3], reference: [f64; 3]) {
        for (sum, pixel) in self.sums.iter_mut().zip([image, reference]) {
            sum.iter_mut().zip(pixel).for_each(|(s, v)| *s += v);
        }
    }

    /// Over the bands: their mean.
    fn image(&self) -> f64 {
        self.sums[0].iter().sum::<f64>() / 3.0
    }

    fn reference(&self) -> f64 {
        self.sums[1].iter().sum::<f64>() / 3.0
    }
}

fn ratio(image: f64, reference: f64) -> f64 {
    if image == reference { 1.0 } else { image / reference }
}

fn is_finite(pixel: &[f32; 3]) -> bool {
    pixel.iter().all(|v| v.is_finite())
}

fn finite(pixel: &[f32; 3]) -> [f64; 3] {
    if is_finite(pixel) { pixel.map(f64::from) } else { [0.0; 3] }
}

fn middle(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| 0.5 * (a[i] + b[i]))
}

#[cfg(test)]
mod tests;
