//! What a contribution has to reach for its shadow ray to be certain: a share of what the film held when a pass ended.

use bidir_kernel::Real;

use super::{Film, unit::lock};

/// How many pixels to each side have a say in how bright a pixel is.
const ABOUT: usize = 2;

/// δ of each pixel of the crop window.
#[derive(Debug)]
pub struct Thresholds {
    width: usize,
    pixels: Vec<Real>,
}

impl Thresholds {
    /// δ at a pixel of the window.
    #[inline]
    pub fn at(&self, column: usize, row: usize) -> Real {
        self.pixels.get(row * self.width + column).copied().unwrap_or(0.0)
    }
}

impl Film {
    /// That share of each pixel's mean so far, or of the mean about it where that is less: a bright neighbour does not make a dark pixel
    /// noisy, nor a stray bright sample its own. A black pixel has 0. `None` while there is nothing to go by.
    pub(super) fn thresholds(&self, share: f64) -> Option<Thresholds> {
        if share <= 0.0 || lock(&self.tally).samples == [0, 0] {
            return None;
        }
        let image = self.develop();
        let (width, height) = (image.width as usize, image.height as usize);
        let means: Vec<f64> = image.pixels.iter().map(|pixel| pixel.iter().map(|&v| f64::from(v)).sum::<f64>() / 3.0).collect();
        let about = averaged(&transposed(&averaged(&means, width), width), height);
        let about = transposed(&about, height);
        let of = |(own, about): (&f64, f64)| (share * own.min(about)).clamp(0.0, f64::from(Real::MAX)) as Real;
        Some(Thresholds { width, pixels: means.iter().zip(about).map(of).collect() })
    }
}

/// The mean of each pixel and those about it in its row.
fn averaged(values: &[f64], width: usize) -> Vec<f64> {
    let of = |row: &[f64], column: usize| {
        let near = &row[column.saturating_sub(ABOUT)..(column + ABOUT + 1).min(width)];
        near.iter().sum::<f64>() / near.len() as f64
    };
    values.chunks(width).flat_map(|row| (0..width).map(move |column| of(row, column))).collect()
}

/// Columns as rows.
fn transposed(values: &[f64], width: usize) -> Vec<f64> {
    (0..width).flat_map(|column| values.iter().skip(column).step_by(width).copied()).collect()
}
