//! What one unit of work adds to the film, before it is its turn.

use bidir_kernel::{Contribution, Together, Vec2};

use super::{
    filter::{Profile, Taps},
    layout::{Layout, Rect},
    unit::Unit,
};

/// Where a thread puts the contributions of one unit: for every sample [`Exposure::begin`], the kernel's calls, [`Exposure::end`].
pub trait Exposure: bidir_kernel::Film<Rivals = Together> {
    /// The work to do: one sample in each of its pixels.
    fn unit(&self) -> Unit;

    /// A camera walk starts at `raster`, in pixels of the whole image, inside the unit.
    fn begin(&mut self, raster: Vec2);

    /// All contributions of this sample have come, those of its light walks too.
    fn end(&mut self);

    /// Forgets all samples of the unit; committed, it adds nothing.
    fn clear(&mut self);

    /// Each sample of the unit counts so many times in the image.
    fn weigh(&mut self, weight: f64);
}

/// A light walk's arrival.
#[derive(Clone, Copy, Debug)]
pub(super) struct Splat {
    /// In pixels of the crop window.
    pub at: [f32; 2],
    /// Weighted.
    pub value: [f32; 3],
}

/// The [`Exposure`] of a [`super::Film`]: filtered sums over a tile and the pixels in reach of it, and a list of splats.
#[derive(Debug)]
pub struct TileBuffer {
    pub(super) unit: Unit,
    /// What `sums` covers, in pixels of the crop window.
    pub(super) rect: Rect,
    /// Σ h f in 0 … 2, Σ h in 3.
    pub(super) sums: Vec<[f64; 4]>,
    /// Of each band, in the order they came.
    pub(super) splats: Vec<Vec<Splat>>,
    /// Samples ended.
    pub(super) samples: u64,
    /// How often each of them counts.
    pub(super) weight: f64,
    /// Contributions that were not finite, or came to no place on the film.
    pub(super) refused: u64,
    origin: [f64; 2],
    size: [f64; 2],
    band_height: i32,
    profile: Profile,
    taps: [Taps; 2],
    raster: [f64; 2],
    total: [f64; 3],
}

impl TileBuffer {
    pub(super) fn new(layout: &Layout, unit: Unit) -> Self {
        let mut buffer = Self {
            unit,
            rect: Rect { x0: 0, y0: 0, x1: 0, y1: 0 },
            sums: Vec::new(),
            splats: vec![Vec::new(); layout.bands()],
            samples: 0,
            weight: 1.0,
            refused: 0,
            origin: [f64::from(layout.crop.x), f64::from(layout.crop.y)],
            size: [f64::from(layout.crop.width), f64::from(layout.crop.height)],
            band_height: layout.band_height as i32,
            profile: layout.profile,
            taps: [Taps::EMPTY; 2],
            raster: [0.0; 2],
            total: [0.0; 3],
        };
        buffer.reset(unit);
        buffer
    }

    /// As new, for another unit of the same film.
    pub(super) fn reset(&mut self, unit: Unit) {
        let reach = self.profile.reach() as i32;
        let (x, y) = (unit.x as i32, unit.y as i32);
        self.unit = unit;
        self.rect = Rect { x0: x - reach, y0: y - reach, x1: x + unit.width as i32 + reach, y1: y + unit.height as i32 + reach };
        self.sums.clear();
        self.sums.resize(self.rect.width() * self.rect.height(), [0.0; 4]);
        self.splats.iter_mut().for_each(Vec::clear);
        (self.samples, self.refused, self.weight) = (0, 0, 1.0);
    }

    /// The bands that a splat at this row reaches.
    fn bands(&self, y: f64) -> std::ops::RangeInclusive<usize> {
        let (first, last) = self.profile.span(y);
        let band = |row: i32| (row / self.band_height) as usize;
        let lowest = self.size[1] as i32 - 1;
        band(first.clamp(0, lowest))..=band(last.clamp(0, lowest))
    }
}

impl Exposure for TileBuffer {
    fn unit(&self) -> Unit {
        self.unit
    }

    fn begin(&mut self, raster: Vec2) {
        let unit = &self.unit;
        let start = [f64::from(unit.x), f64::from(unit.y)];
        let end = [f64::from(unit.x + unit.width), f64::from(unit.y + unit.height)];
        // A position just below a whole number can round to it, and so leave the tile.
        for (axis, value) in [f64::from(raster.x), f64::from(raster.y)].into_iter().enumerate() {
            self.raster[axis] = (value - self.origin[axis]).max(start[axis]).min(end[axis].next_down());
        }
        self.total = [0.0; 3];
    }

    fn end(&mut self) {
        self.samples += 1;
        let [columns, rows] = &mut self.taps;
        self.profile.taps(self.raster[0], columns);
        self.profile.taps(self.raster[1], rows);
        let (x, across) = columns.within(self.rect.x0, self.rect.x1);
        let (y, down) = rows.within(self.rect.y0, self.rect.y1);
        let [r, g, b] = self.total;
        let width = self.rect.width();
        for (i, v) in down.iter().enumerate() {
            let start = (y + i) * width + x;
            for (sum, u) in self.sums[start..start + across.len()].iter_mut().zip(across) {
                let h = u * v;
                *sum = [sum[0] + h * r, sum[1] + h * g, sum[2] + h * b, sum[3] + h];
            }
        }
    }

    fn clear(&mut self) {
        self.reset(self.unit);
    }

    fn weigh(&mut self, weight: f64) {
        self.weight = weight;
    }
}

impl bidir_kernel::Film for TileBuffer {
    type Rivals = Together;

    #[inline]
    fn add(&mut self, contribution: Contribution) {
        let value = contribution.value * contribution.weight;
        if !value.is_finite() {
            self.refused += 1;
            return;
        }
        for (total, v) in self.total.iter_mut().zip(value.0) {
            *total += f64::from(v);
        }
    }

    #[inline]
    fn splat(&mut self, raster: Vec2, contribution: Contribution) {
        let value = contribution.value * contribution.weight;
        let (x, y) = (f64::from(raster.x) - self.origin[0], f64::from(raster.y) - self.origin[1]);
        if !(value.is_finite() && x >= 0.0 && x < self.size[0] && y >= 0.0 && y < self.size[1]) {
            self.refused += 1;
            return;
        }
        if value.is_black() {
            return;
        }
        for band in self.bands(y) {
            self.splats[band].push(Splat { at: [x as f32, y as f32], value: value.0 });
        }
    }
}
