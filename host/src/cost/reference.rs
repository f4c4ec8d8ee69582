//! What pictures are held against: two independent halves.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::interval::Interval;

use crate::{
    compare::{against_halves, compare},
    error::{Error, Result},
    image::{Image, read::picture},
};

/// The edge of a block, in pixels: the parts of a picture that are taken to be independent of each other.
const BLOCK: u32 = 16;

/// How far a picture is from a reference. Its own noise is in the errors, the reference's is not (but in SMAPE).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Errors {
    /// Mean of (x − a)(x − b) / (r² + 0.01).
    pub relmse: f64,
    /// The same without the 0.1 % of pixels with the largest values.
    pub trimmed: f64,
    /// Mean of |x − r| / (|x| + |r| + 0.01).
    pub smape: f64,
    /// Mean of x over mean of r, less 1; 0 if r is black.
    pub bias: f64,
    /// The share of pixels more than ten times as bright as r is there and in the mean.
    pub fireflies: f64,
}

/// A reference r = (a + b)/2.
#[derive(Clone, Debug)]
pub struct Reference {
    halves: [Image; 2],
    /// Whether there are two halves in truth.
    independent: bool,
    /// Samples per pixel of both halves together, where that is known.
    samples: Option<u32>,
    /// Whose it is, and how long it took.
    pub words: String,
    /// Whether it was given.
    pub given: bool,
}

impl Reference {
    /// Two independent renders of so many samples per pixel each.
    pub fn rendered(halves: [Image; 2], samples: u32, words: String) -> Self {
        Self { halves, independent: true, samples: Some(2 * samples), words, given: false }
    }

    /// One file, whose own noise then counts as every picture's error; or two independent halves.
    ///
    /// # Errors
    /// If a file cannot be read, or they are of two sizes, or the same.
    pub fn given(files: &[PathBuf]) -> Result<Self> {
        let names = files.iter().map(|file| file.display().to_string()).collect::<Vec<_>>().join(", ");
        match <[Image; 1]>::try_from(files.iter().map(|file| picture(file)).collect::<Result<Vec<_>>>()?) {
            Ok([one]) => {
                let words = format!("{names}, as given; its own noise is taken for everybody's error");
                Ok(Self { halves: [one.clone(), one], independent: false, samples: None, words, given: true })
            }
            Err(images) => match <[Image; 2]>::try_from(images) {
                Ok([a, b]) => {
                    if (a.width, a.height) != (b.width, b.height) {
                        return Err(Error::in_file(&files[1], "its size is not that of the other half", "give two halves of one picture"));
                    }
                    let bits = |image: &Image| image.pixels.iter().flatten().map(|value| value.to_bits()).collect::<Vec<_>>();
                    if bits(&a) == bits(&b) {
                        let remedy = "give two renders of two seeds, or one picture alone";
                        return Err(Error::in_file(&files[1], "it is the other half again", remedy));
                    }
                    Ok(Self {
                        halves: [a, b],
                        independent: true,
                        samples: None,
                        words: format!("{names}, two halves as given"),
                        given: true,
                    })
                }
                Err(images) => {
                    let thing = format!("{} references are given", images.len());
                    Err(Error::new(thing, "give one picture, or the two independent halves of one"))
                }
            },
        }
    }

    /// In pixels.
    pub fn size(&self) -> [u32; 2] {
        [self.halves[0].width, self.halves[0].height]
    }

    /// a and b.
    pub fn halves(&self) -> &[Image; 2] {
        &self.halves
    }

    /// r.
    pub fn image(&self) -> Image {
        let [a, b] = &self.halves;
        let middle = |(a, b): (&[f32; 3], &[f32; 3])| std::array::from_fn(|i| 0.5 * (a[i] + b[i]));
        Image { pixels: a.pixels.iter().zip(&b.pixels).map(middle).collect(), ..*a }
    }

    /// The errors of a picture of the same size.
    pub fn errors(&self, image: &Image) -> Result<Errors> {
        let found = against_halves(image, [&self.halves[0], &self.halves[1]])?;
        let (relmse, trimmed, smape, fireflies) = (found.relmse, found.relmse_trimmed, found.smape, found.fireflies);
        let bias = if found.bias.is_finite() { found.bias } else { 0.0 };
        Ok(Errors { relmse, trimmed, smape, bias, fireflies })
    }

    /// r's own relMSE: a is as far from r as r is from the truth. `None` where there are no two halves.
    pub fn relmse(&self) -> Option<f64> {
        let found = compare(&self.halves[0], &self.image()).ok().filter(|_| self.independent);
        found.map(|found| found.relmse)
    }

    /// How biased pictures of so many samples per pixel each are that have these biases. They are taken to be at least as noisy as the
    /// reference's samples say, where it is known how many there were.
    pub fn interval(&self, biases: &[f64], samples: u32) -> Interval {
        let doubt = self.doubt();
        let all = f64::from(samples) * biases.len() as f64;
        let least = self.samples.map_or(0.0, |reference| doubt * (f64::from(reference) / all.max(1.0)).sqrt());
        Interval::of(biases, doubt, least)
    }

    /// The standard deviation of r's mean, as a share of it, from blocks of (a − b)/2, taken to be independent. 0 where there are no two
    /// halves: what is not known is not in an interval.
    pub fn doubt(&self) -> f64 {
        if !self.independent {
            return 0.0;
        }
        let [a, b] = &self.halves;
        let columns = a.width.div_ceil(BLOCK);
        let mut blocks = vec![0.0; (columns * a.height.div_ceil(BLOCK)) as usize];
        let mut sum = 0.0;
        for (i, (a_pixel, b_pixel)) in a.pixels.iter().zip(&b.pixels).enumerate() {
            let (x, y) = (i as u32 % a.width, i as u32 / a.width);
            let block = &mut blocks[(y / BLOCK * columns + x / BLOCK) as usize];
            for band in 0..3 {
                let (a, b) = (f64::from(a_pixel[band]), f64::from(b_pixel[band]));
                *block += 0.5 * (a - b);
                sum += 0.5 * (a + b);
            }
        }
        let squares: f64 = blocks.iter().map(|block: &f64| block * block).sum();
        if sum > 0.0 { squares.sqrt() / sum } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flat(value: f32) -> Image {
        Image { width: 32, height: 32, pixels: vec![[value; 3]; 1024] }
    }

    /// A checkered half: the noise of halves is no error of a picture that lies in their middle.
    #[test]
    fn the_noise_of_halves_is_not_in_the_error_of_a_picture() {
        let noisy = |sign: f32| {
            let mut image = flat(1.0);
            image.pixels.iter_mut().enumerate().for_each(|(i, pixel)| *pixel = [1.0 + sign * if i % 2 == 0 { 0.1 } else { -0.1 }; 3]);
            image
        };
        let reference = Reference::rendered([noisy(1.0), flat(1.0)], 8, String::new());
        let errors = reference.errors(&flat(1.2)).unwrap();
        // (1.2 − 1.1)(1.2 − 1) where r is 1.05, and (1.2 − 0.9)(1.2 − 1) where it is 0.95.
        let expected = 0.5 * (0.02 / (1.05 * 1.05 + 0.01) + 0.06 / (0.95 * 0.95 + 0.01));
        assert!((errors.relmse - expected).abs() < 1e-6, "{errors:?}");
        assert!((errors.bias - 0.2).abs() < 1e-6 && errors.fireflies == 0.0);
        let own = 0.5 * 0.0025 * (1.0 / (1.05 * 1.05 + 0.01) + 1.0 / (0.95 * 0.95 + 0.01));
        assert!((reference.relmse().unwrap() - own).abs() < 1e-6);
        assert!(reference.doubt() < 1e-6);
        assert_eq!(Reference { independent: false, ..reference }.relmse(), None);
    }

    #[test]
    fn doubt_is_of_the_mean() {
        // Four blocks, each half of which is ±0.1: (0.1 · 256 · 3 · √4) / (1 · 1024 · 3).
        let (mut a, mut b) = (flat(1.0), flat(1.0));
        for (i, (a, b)) in a.pixels.iter_mut().zip(&mut b.pixels).enumerate() {
            let sign = if (i % 32 < 16) == (i / 32 < 16) { 0.1 } else { -0.1 };
            (*a, *b) = ([1.0 + sign; 3], [1.0 - sign; 3]);
        }
        let doubt = Reference::rendered([a, b], 8, String::new()).doubt();
        assert!((doubt - 0.05).abs() < 1e-4, "{doubt}");
    }

    #[test]
    fn a_firefly_is_counted_and_a_bright_lamp_is_not() {
        let (mut reference, mut image) = (flat(1.0), flat(1.0));
        (reference.pixels[5], image.pixels[5], image.pixels[9]) = ([50.0; 3], [60.0; 3], [20.0; 3]);
        let errors = Reference::rendered([reference.clone(), reference], 8, String::new()).errors(&image).unwrap();
        assert_eq!(errors.fireflies, 1.0 / 1024.0);
    }
}
