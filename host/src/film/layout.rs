//! Which pixels there are, and how they are divided.

use crate::{
    error::{Error, Result},
    scene::description::{Crop, FilmSettings},
};

use super::{filter::Profile, unit::Unit};

/// Rows that are added up by one thread at a time.
const BAND_HEIGHT: u32 = 32;
/// So that a tall image does not make every commit long.
const MAX_BANDS: u32 = 16;

/// The film's window, its filter and its bands.
#[derive(Clone, Debug)]
pub struct Layout {
    /// What is stored, in pixels of the whole image.
    pub crop: Crop,
    /// One axis of the filter.
    pub profile: Profile,
    /// Rows of a band; the last one may have fewer.
    pub band_height: u32,
}

/// A half-open rectangle, in pixels of the crop window; may reach outside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rect {
    /// Left edge.
    pub x0: i32,
    /// Upper edge.
    pub y0: i32,
    /// Right edge.
    pub x1: i32,
    /// Lower edge.
    pub y1: i32,
}

impl Layout {
    /// Checks that the window lies in the image.
    pub fn new(settings: &FilmSettings) -> Result<Self> {
        let FilmSettings { width, height, crop, filter } = *settings;
        let inside = |start: u32, length: u32, whole: u32| length > 0 && start.checked_add(length).is_some_and(|end| end <= whole);
        if !(inside(crop.x, crop.width, width) && inside(crop.y, crop.height, height)) {
            let thing = format!(
                "the crop window {}×{} at ({}, {}) is not inside the {width}×{height} image",
                crop.width, crop.height, crop.x, crop.y
            );
            return Err(Error::new(thing, "make it at least one pixel, inside the image"));
        }
        // Positions on the film are f32: beyond this, samples of neighbouring pixels could not be told apart.
        if width.max(height) > 1 << 20 {
            return Err(Error::new(format!("an image of {width}×{height} pixels is too large"), "keep either side below a million pixels"));
        }
        let band_height = BAND_HEIGHT.max(crop.height.div_ceil(MAX_BANDS));
        Ok(Self { crop, profile: Profile::new(filter)?, band_height })
    }

    /// How many bands.
    pub fn bands(&self) -> usize {
        self.crop.height.div_ceil(self.band_height) as usize
    }

    /// The rows of a band.
    pub fn band(&self, index: usize) -> Rect {
        let y0 = index as u32 * self.band_height;
        let y1 = (y0 + self.band_height).min(self.crop.height);
        Rect { x0: 0, y0: y0 as i32, x1: self.crop.width as i32, y1: y1 as i32 }
    }

    /// How many pixels the window has.
    pub fn pixels(&self) -> usize {
        self.crop.width as usize * self.crop.height as usize
    }

    /// The pixels of a unit, in pixels of the whole image, row by row.
    pub fn pixels_of(&self, unit: &Unit) -> impl Iterator<Item = (u32, u32)> + use<> {
        let (x, y) = (self.crop.x + unit.x, self.crop.y + unit.y);
        let (width, height) = (unit.width, unit.height);
        (y..y + height).flat_map(move |y| (x..x + width).map(move |x| (x, y)))
    }

    /// ∫ h over the window, about the centre of each of `length` pixels in a line: what a splat's share is divided by,
    /// since the part of h beyond the window never arrives.
    pub fn masses(&self, length: u32) -> Vec<f64> {
        let centre = |i: u32| f64::from(i) + 0.5;
        (0..length).map(|i| self.profile.integral(-centre(i), f64::from(length) - centre(i))).collect()
    }
}

impl Rect {
    /// In pixels.
    pub fn width(&self) -> usize {
        (self.x1 - self.x0).max(0) as usize
    }

    /// In pixels.
    pub fn height(&self) -> usize {
        (self.y1 - self.y0).max(0) as usize
    }

    /// What both cover.
    pub fn and(&self, other: &Self) -> Self {
        Self { x0: self.x0.max(other.x0), y0: self.y0.max(other.y0), x1: self.x1.min(other.x1), y1: self.y1.min(other.y1) }
    }
}
