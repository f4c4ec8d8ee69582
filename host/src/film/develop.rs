//! From sums to pictures, and how far they may be trusted.

use serde::Serialize;

use crate::image::{
    Image,
    trim::{TRIM, trimmed_mean},
};

use super::{Film, band::Sums, lock};

/// Keeps a relative squared error finite in black pixels; relMSE's usual ε.
const EPSILON: f64 = 0.01;

/// The render's own estimate of its error, from its two halves.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Noise {
    /// Mean over pixels of the estimated variance over (value² + 0.01), without the 0.1 % largest; the value is the mean of 3×3 pixels.
    pub relmse: f64,
    /// Mean over pixels and bands of the estimated variance.
    pub mse: f64,
}

/// What turns sums into values.
struct Scale {
    /// pixels / samples.
    light: f64,
    /// 1 / ∫ h within the window, per column and per row.
    columns: Vec<f64>,
    rows: Vec<f64>,
}

impl Film {
    /// The picture: samples of both halves.
    /// A pixel that no sample reached is black.
    pub fn develop(&self) -> Image {
        let scale = self.scale(self.weights().iter().sum());
        let mut image = Image::black(self.layout.crop.width, self.layout.crop.height);
        self.each(|index, column, row, [even, odd]| {
            let value = scale.value(&(even + odd), column, row);
            image.pixels[index] = value.map(|v| v as f32);
        });
        image
    }

    /// The pictures that samples of even and of odd number make on their own; independent unless the sampler ties samples together.
    pub fn halves(&self) -> [Image; 2] {
        let scales = self.weights().map(|n| self.scale(n));
        let mut images = [0, 1].map(|_| Image::black(self.layout.crop.width, self.layout.crop.height));
        self.each(|index, column, row, sums| {
            for ((image, scale), sum) in images.iter_mut().zip(&scales).zip(sums) {
                image.pixels[index] = scale.value(&sum, column, row).map(|v| v as f32);
            }
        });
        images
    }

    /// How noisy [`Film::develop`] is; `None` before there are two samples.
    ///
    /// With m and n samples in the halves, whose pixel values are a and b, Var(a − b) = σ² (1/m + 1/n) and the picture's variance is
    /// σ² / (m + n); so (a − b)² m n / (m + n)² estimates it without bias: the sampler ties no sample of one half to one of the other.
    /// relMSE divides by the squared value of the picture, of which a pixel with a firefly knows little: its neighbours are asked too.
    /// Where samples count more or less, m and n are how often they do, and the halves have about the same stages.
    /// It is low while few pixels have seen the light that matters, like every estimate from the samples alone.
    pub fn noise(&self) -> Option<Noise> {
        let variances = self.variances()?;
        let whole = self.scale(self.weights().iter().sum());
        let mut values = Vec::with_capacity(self.layout.pixels());
        self.each(|_, column, row, [even, odd]| values.push(whole.value(&(even + odd), column, row)));
        let sum: f64 = variances.iter().map(|v| v.iter().sum::<f64>() / 3.0).sum();
        let width = self.layout.crop.width as usize;
        let relative = variances.iter().enumerate().map(|(index, variance)| {
            let mean = around(&values, width, index);
            variance.iter().zip(mean).map(|(v, m)| v / (m * m + EPSILON)).sum::<f64>() / 3.0
        });
        let mut relative: Vec<f64> = relative.collect();
        let pixels = relative.len() as f64;
        Some(Noise { relmse: trimmed_mean(&mut relative, TRIM), mse: sum / pixels })
    }

    /// How far each value of [`Film::develop`] may be off, squared, as [`Film::noise`] has it; black before there are two samples.
    pub fn variance(&self) -> Image {
        let mut image = Image::black(self.layout.crop.width, self.layout.crop.height);
        for (pixel, variance) in image.pixels.iter_mut().zip(self.variances().unwrap_or_default()) {
            *pixel = variance.map(|v| v as f32);
        }
        image
    }

    /// Of each pixel, row by row; `None` before both halves have samples.
    fn variances(&self) -> Option<Vec<[f64; 3]>> {
        let samples = self.weights();
        if samples.contains(&0.0) {
            return None;
        }
        let total = samples[0] + samples[1];
        let share = samples[0] * samples[1] / (total * total);
        let scales = samples.map(|n| self.scale(n));
        let mut variances = Vec::with_capacity(self.layout.pixels());
        self.each(|_, column, row, [even, odd]| {
            let (a, b) = (scales[0].value(&even, column, row), scales[1].value(&odd, column, row));
            variances.push([0, 1, 2].map(|i| (a[i] - b[i]) * (a[i] - b[i]) * share));
        });
        Some(variances)
    }

    /// Samples of even and of odd number, each as often as it counts; every strip was told of all, in the same order.
    fn weights(&self) -> [f64; 2] {
        self.bands.first().map_or([0.0; 2], |strip| lock(&strip.sums).halves.each_ref().map(|half| half.weight))
    }

    fn scale(&self, samples: f64) -> Scale {
        let crop = &self.layout.crop;
        let reciprocals = |length| self.layout.masses(length).into_iter().map(|m| if m > 0.0 { 1.0 / m } else { 0.0 }).collect();
        Scale {
            light: if samples > 0.0 { self.layout.pixels() as f64 / samples } else { 0.0 },
            columns: reciprocals(crop.width),
            rows: reciprocals(crop.height),
        }
    }

    /// Calls `visit(index, column, row, sums of both halves)` for each pixel, row by row.
    fn each(&self, mut visit: impl FnMut(usize, usize, usize, [PixelSums; 2])) {
        let width = self.layout.crop.width as usize;
        for strip in &self.bands {
            let band = lock(&strip.sums);
            let start = band.rect.y0 as usize * width;
            for i in 0..band.rect.width() * band.rect.height() {
                let index = start + i;
                visit(index, index % width, index / width, [PixelSums::of(&band.halves[0], i), PixelSums::of(&band.halves[1], i)]);
            }
        }
    }
}

/// The mean of a pixel and those about it, as far as there are any.
fn around(values: &[[f64; 3]], width: usize, index: usize) -> [f64; 3] {
    let near = |at: usize, end: usize| at.saturating_sub(1)..(at + 2).min(end);
    let (mut sum, mut count) = ([0.0; 3], 0.0);
    for row in near(index / width, values.len() / width) {
        for column in near(index % width, width) {
            sum.iter_mut().zip(values[row * width + column]).for_each(|(sum, value)| *sum += value);
            count += 1.0;
        }
    }
    sum.map(|sum| sum / count)
}

#[derive(Clone, Copy)]
struct PixelSums {
    camera: [f64; 4],
    light: [f64; 3],
}

impl PixelSums {
    fn of(sums: &Sums, index: usize) -> Self {
        Self { camera: sums.camera[index], light: sums.light.get(index).copied().unwrap_or_default() }
    }
}

impl std::ops::Add for PixelSums {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            camera: std::array::from_fn(|i| self.camera[i] + other.camera[i]),
            light: std::array::from_fn(|i| self.light[i] + other.light[i]),
        }
    }
}

impl Scale {
    fn value(&self, sums: &PixelSums, column: usize, row: usize) -> [f64; 3] {
        let light = self.light * self.columns[column] * self.rows[row];
        let weight = sums.camera[3];
        std::array::from_fn(|i| {
            let camera = if weight > 0.0 { sums.camera[i] / weight } else { 0.0 };
            camera + sums.light[i] * light
        })
    }
}
