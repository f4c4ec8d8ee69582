//! Pixels kept as densely as their file has them, and decoded one by one as they are looked up.

use std::sync::OnceLock;

use bidir_kernel::Spectrum;
use exr::prelude::f16;

use super::read::{Encoding, Pixels};

/// A file's pixels.
#[derive(Clone, Debug)]
pub struct Packed {
    /// At least 1.
    pub width: u32,
    /// At least 1.
    pub height: u32,
    /// Rows from the top, each from the left.
    pub texels: Texels,
}

impl Packed {
    /// Every pixel decoded.
    pub fn unpack(&self) -> Pixels {
        Pixels { width: self.width, height: self.height, values: self.texels.iter().collect() }
    }
}

/// Pixels of three bands, or of one that stands for three equal ones.
#[derive(Clone, Debug)]
pub struct Texels {
    bands: usize,
    values: Values,
    /// Once it was asked for.
    mean: OnceLock<Spectrum>,
}

#[derive(Clone, Debug)]
enum Values {
    /// With what each of them means.
    Bytes(Vec<u8>, &'static [f32]),
    /// With what each of them means.
    Shorts(Vec<u16>, &'static [f32]),
    Halves(Vec<f16>),
    Floats(Vec<f32>),
}

impl Texels {
    /// Whole numbers of 8 bits; `bands` is 1 or 3, and the bands of a pixel stand beside each other.
    pub fn bytes(values: Vec<u8>, bands: usize, encoding: Encoding) -> Self {
        static TABLES: [OnceLock<Box<[f32]>>; 2] = [const { OnceLock::new() }; 2];
        Self::new(bands, Values::Bytes(values, table(&TABLES, encoding, 255)))
    }

    /// Whole numbers of 16 bits.
    pub fn shorts(values: Vec<u16>, bands: usize, encoding: Encoding) -> Self {
        static TABLES: [OnceLock<Box<[f32]>>; 2] = [const { OnceLock::new() }; 2];
        Self::new(bands, Values::Shorts(values, table(&TABLES, encoding, 65535)))
    }

    /// Half floats, always linear.
    pub fn halves(values: Vec<f16>, bands: usize) -> Self {
        Self::new(bands, Values::Halves(values))
    }

    /// Floats, always linear.
    pub fn floats(values: Vec<f32>, bands: usize) -> Self {
        Self::new(bands, Values::Floats(values))
    }

    fn new(bands: usize, values: Values) -> Self {
        Self { bands, values, mean: OnceLock::new() }
    }

    /// Of all pixels; black where there is none.
    pub fn mean(&self) -> Spectrum {
        *self.mean.get_or_init(|| {
            let mut sums = [0.0; 3];
            for pixel in self.iter() {
                sums.iter_mut().zip(pixel.0).for_each(|(sum, band)| *sum += f64::from(band));
            }
            Spectrum(sums.map(|sum| (sum / self.len().max(1) as f64) as f32))
        })
    }

    /// How many pixels.
    pub fn len(&self) -> usize {
        let values = match &self.values {
            Values::Bytes(values, _) => values.len(),
            Values::Shorts(values, _) => values.len(),
            Values::Halves(values) => values.len(),
            Values::Floats(values) => values.len(),
        };
        values / self.bands
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// How much memory they take, in bytes.
    pub fn size(&self) -> usize {
        let each = match self.values {
            Values::Bytes(..) => 1,
            Values::Shorts(..) | Values::Halves(_) => 2,
            Values::Floats(_) => 4,
        };
        self.len() * self.bands * each
    }

    /// A pixel, linear; `None` beyond the last.
    #[inline]
    pub fn get(&self, at: usize) -> Option<Spectrum> {
        match &self.values {
            Values::Bytes(values, table) => self.of(values, at, |v| table[usize::from(v)]),
            Values::Shorts(values, table) => self.of(values, at, |v| table[usize::from(v)]),
            Values::Halves(values) => self.of(values, at, f16::to_f32),
            Values::Floats(values) => self.of(values, at, |v| v),
        }
    }

    #[inline(always)]
    fn of<T: Copy>(&self, values: &[T], at: usize, linear: impl Fn(T) -> f32) -> Option<Spectrum> {
        let first = at * self.bands;
        let bands = values.get(first..first + self.bands)?;
        Some(match *bands {
            [r, g, b] => Spectrum([linear(r), linear(g), linear(b)]),
            [grey, ..] => Spectrum::splat(linear(grey)),
            [] => Spectrum::BLACK,
        })
    }

    /// All pixels in turn.
    pub fn iter(&self) -> impl Iterator<Item = Spectrum> + '_ {
        (0..self.len()).filter_map(|at| self.get(at))
    }
}

impl FromIterator<Spectrum> for Texels {
    fn from_iter<I: IntoIterator<Item = Spectrum>>(pixels: I) -> Self {
        Self::floats(pixels.into_iter().flat_map(|pixel| pixel.0).collect(), 3)
    }
}

/// What whole numbers up to `most` mean; made once.
fn table(tables: &'static [OnceLock<Box<[f32]>>; 2], encoding: Encoding, most: u32) -> &'static [f32] {
    let slot = match encoding {
        Encoding::Srgb => &tables[0],
        Encoding::Linear => &tables[1],
    };
    slot.get_or_init(|| (0..=most).map(|v| encoding.decode(f64::from(v) / f64::from(most))).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_width_means_the_same_number() {
        let expected = [Spectrum([1.0, 0.0, 0.2]), Spectrum([0.4, 0.6, 0.8])];
        let fifths = [5, 0, 1, 2, 3, 4];
        let all = [
            Texels::bytes(fifths.map(|v| v * 51).into(), 3, Encoding::Linear),
            Texels::shorts(fifths.map(|v| u16::from(v) * 13107).into(), 3, Encoding::Linear),
            Texels::floats(fifths.map(|v| f32::from(v) * 0.2).into(), 3),
            Texels::halves(fifths.map(|v| f16::from_f32(f32::from(v) * 0.2)).into(), 3),
        ];
        for texels in all {
            assert_eq!(texels.len(), 2);
            assert!(texels.get(2).is_none());
            for (found, wanted) in texels.iter().zip(expected) {
                assert!(found.0.iter().zip(wanted.0).all(|(a, b)| (a - b).abs() < 2e-4), "{found:?} {wanted:?}");
            }
        }
    }

    #[test]
    fn one_band_stands_for_three() {
        let texels = Texels::bytes(vec![0, 255], 1, Encoding::Srgb);
        assert_eq!(texels.iter().collect::<Vec<_>>(), [Spectrum::BLACK, Spectrum::ONE]);
        assert_eq!(texels.size(), 2);
    }
}
