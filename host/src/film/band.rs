//! A strip of the film, where units are added up one after the other.

use super::{
    buffer::{Splat, TileBuffer},
    filter::{Profile, Taps},
    layout::Rect,
};

/// The sums of a strip's pixels, apart for samples of even and of odd number.
#[derive(Debug)]
pub struct Band {
    /// What it covers, in pixels of the crop window.
    pub rect: Rect,
    /// Even, odd.
    pub halves: [Sums; 2],
}

/// Sums per pixel, row by row.
#[derive(Clone, Debug)]
pub struct Sums {
    /// Σ h f of camera samples in 0 … 2, Σ h in 3.
    pub camera: Vec<[f64; 4]>,
    /// Σ h f of splats; empty until one comes.
    pub light: Vec<[f64; 3]>,
    /// Samples of the whole film, each as often as it counts.
    pub weight: f64,
}

impl Band {
    /// Black.
    pub fn new(rect: Rect) -> Self {
        let sums = || Sums { camera: vec![[0.0; 4]; rect.width() * rect.height()], light: Vec::new(), weight: 0.0 };
        Self { rect, halves: [sums(), sums()] }
    }

    /// Adds what a unit has for this strip, the `index`-th.
    pub fn add(&mut self, index: usize, buffer: &TileBuffer, profile: &Profile) {
        let rect = self.rect;
        let half = &mut self.halves[(buffer.unit.sample % 2) as usize];
        half.weight += buffer.weight * buffer.samples as f64;
        add_tile(rect, &mut half.camera, buffer);
        let splats = &buffer.splats[index];
        if splats.is_empty() {
            return;
        }
        if half.light.is_empty() {
            half.light = vec![[0.0; 3]; rect.width() * rect.height()];
        }
        let mut taps = [Taps::EMPTY; 2];
        for splat in splats {
            add_splat(rect, &mut half.light, splat, buffer.weight, profile, &mut taps);
        }
    }
}

fn add_tile(rect: Rect, camera: &mut [[f64; 4]], buffer: &TileBuffer) {
    let shared = rect.and(&buffer.rect);
    for y in shared.y0..shared.y1 {
        let from = (y - buffer.rect.y0) as usize * buffer.rect.width() + (shared.x0 - buffer.rect.x0) as usize;
        let to = (y - rect.y0) as usize * rect.width() + shared.x0 as usize;
        let added = &buffer.sums[from..from + shared.width()];
        for (sum, add) in camera[to..to + shared.width()].iter_mut().zip(added) {
            *sum = std::array::from_fn(|i| sum[i] + buffer.weight * add[i]);
        }
    }
}

#[inline]
fn add_splat(rect: Rect, light: &mut [[f64; 3]], splat: &Splat, weight: f64, profile: &Profile, taps: &mut [Taps; 2]) {
    let [columns, rows] = taps;
    profile.taps(f64::from(splat.at[0]), columns);
    profile.taps(f64::from(splat.at[1]), rows);
    let (x, across) = columns.within(rect.x0, rect.x1);
    let (y, down) = rows.within(rect.y0, rect.y1);
    let [r, g, b] = splat.value.map(|value| weight * f64::from(value));
    for (i, v) in down.iter().enumerate() {
        let start = (y + i) * rect.width() + x;
        for (sum, u) in light[start..start + across.len()].iter_mut().zip(across) {
            let h = u * v;
            *sum = [sum[0] + h * r, sum[1] + h * g, sum[2] + h * b];
        }
    }
}
