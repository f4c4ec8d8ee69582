//! The (s,t) pyramid: what each technique brings, with its weight and without.

use std::sync::Mutex;

use bidir_kernel::{Contribution, Join, Technique, Together, Vec2};

use crate::{
    error::{Error, Result},
    image::Image,
    scene::description::FilmSettings,
};

use super::{
    Exposure, Store, Unit,
    layout::Layout,
    sequencer::Sequencer,
    unit::{Dispatch, lock},
};

/// The most memory a pyramid may take, in bytes.
const MAX_BYTES: usize = 4 << 30;

/// A film that keeps techniques apart, up to some path length. Pixels are boxes, whatever the scene's filter.
/// Determinism is that of [`super::Film`].
#[derive(Debug)]
pub struct Pyramid {
    layout: Layout,
    longest: u32,
    dispatch: Dispatch,
    order: Sequencer<PyramidBuffer>,
    sums: Mutex<Sums>,
}

#[derive(Debug)]
struct Sums {
    /// Layer by layer, row by row: weighted in 0 … 2, unweighted in 3 … 5.
    values: Vec<[f64; 6]>,
    /// Per pixel, each as often as it counts.
    samples: Vec<f64>,
    total: f64,
    refused: u64,
}

/// The [`Exposure`] of a [`Pyramid`]: a list of contributions.
#[derive(Debug)]
pub struct PyramidBuffer {
    unit: Unit,
    longest: u32,
    crop: [u32; 4],
    /// The pixel that the camera walk under way belongs to.
    pixel: u32,
    /// How often each of its samples counts.
    weight: f64,
    samples: Vec<u32>,
    arrivals: Vec<Arrival>,
    refused: u64,
}

#[derive(Clone, Copy, Debug)]
struct Arrival {
    pixel: u32,
    layer: u32,
    weight: f32,
    value: [f32; 3],
}

impl Pyramid {
    /// Black; keeps paths of up to `longest` segments, 48 bytes per pixel and technique. A length k has k + 2 techniques.
    pub fn new(settings: &FilmSettings, longest: u32) -> Result<Self> {
        let layout = Layout::new(settings)?;
        let pixels = layout.pixels();
        let most = MAX_BYTES / size_of::<[f64; 6]>() / pixels.max(1);
        let cells = (u64::from(longest) < 1 << 12).then(|| layers(longest) as usize).filter(|&n| n <= most);
        let Some(cells) = cells.map(|n| n * pixels) else {
            let thing = format!(
                "the techniques of paths up to length {longest} at {}×{} pixels need more than {} GiB of memory",
                layout.crop.width,
                layout.crop.height,
                MAX_BYTES >> 30
            );
            let remedy = match (1..longest.min(1 << 12)).rev().find(|&length| layers(length) as usize <= most) {
                Some(fits) => format!("lower the longest path to {fits} (--longest {fits}), or the film's width and height"),
                None => "lower the film's width and height".to_owned(),
            };
            return Err(Error::new(thing, remedy));
        };
        let sums = Sums { values: vec![[0.0; 6]; cells], samples: vec![0.0; pixels], total: 0.0, refused: 0 };
        let dispatch = Dispatch::new(layout.crop.width, layout.crop.height);
        Ok(Self { layout, longest, dispatch, order: Sequencer::new(), sums: Mutex::new(sums) })
    }

    /// Every technique there is a layer for, by path length, then by s.
    pub fn techniques(&self) -> impl Iterator<Item = Technique> + use<> {
        (1..=self.longest).flat_map(|k| (0..=k + 1).map(move |s| Technique { s, t: k + 1 - s }))
    }

    /// What a technique brought, weighted and unweighted; the weighted layers add up to the image. Black for techniques without a layer.
    pub fn develop(&self, technique: Technique) -> [Image; 2] {
        let mut images = [0, 1].map(|_| Image::black(self.layout.crop.width, self.layout.crop.height));
        let Some(layer) = layer(technique, self.longest) else { return images };
        let pixels = self.layout.pixels();
        let sums = lock(&self.sums);
        for i in 0..pixels {
            let scale = match technique.join() {
                Join::LensSplat | Join::LensHit => pixels as f64 / sums.total,
                Join::LightHit | Join::NextEvent | Join::Connection => 1.0 / sums.samples[i],
            };
            let scale = if scale.is_finite() { scale } else { 0.0 };
            let values = sums.values[layer as usize * pixels + i].map(|v| (v * scale) as f32);
            images[0].pixels[i] = [values[0], values[1], values[2]];
            images[1].pixels[i] = [values[3], values[4], values[5]];
        }
        images
    }

    /// Contributions that were not finite, or came to no place on the film.
    pub fn refused(&self) -> u64 {
        lock(&self.sums).refused
    }
}

impl Store for Pyramid {
    type Buffer = PyramidBuffer;

    fn claim(&self, end: u32) -> Option<PyramidBuffer> {
        let unit = self.dispatch.claim(end)?;
        let crop = self.layout.crop;
        let crop = [crop.x, crop.y, crop.width, crop.height];
        Some(PyramidBuffer {
            unit,
            longest: self.longest,
            crop,
            pixel: 0,
            weight: 1.0,
            samples: Vec::new(),
            arrivals: Vec::new(),
            refused: 0,
        })
    }

    fn commit(&self, buffer: PyramidBuffer) {
        self.order.submit(buffer.unit.index, buffer, |buffer| {
            lock(&self.sums).add(&buffer, self.layout.pixels());
            self.dispatch.settle(buffer.unit.index);
        });
    }

    fn abandon(&self) {
        self.dispatch.abandon();
    }

    fn pixels(&self, unit: &Unit) -> impl Iterator<Item = (u32, u32)> + use<> {
        self.layout.pixels_of(unit)
    }
}

impl Sums {
    fn add(&mut self, buffer: &PyramidBuffer, pixels: usize) {
        let weight = buffer.weight;
        self.total += weight * buffer.samples.len() as f64;
        self.refused += buffer.refused;
        for &pixel in &buffer.samples {
            self.samples[pixel as usize] += weight;
        }
        for arrival in &buffer.arrivals {
            let sum = &mut self.values[arrival.layer as usize * pixels + arrival.pixel as usize];
            for (i, value) in arrival.value.map(|value| weight * f64::from(value)).into_iter().enumerate() {
                sum[i] += value * f64::from(arrival.weight);
                sum[i + 3] += value;
            }
        }
    }
}

impl PyramidBuffer {
    fn take(&mut self, pixel: u32, Contribution { value, weight, technique }: Contribution) {
        if !(value.is_finite() && weight.is_finite()) {
            self.refused += 1;
        } else if let Some(layer) = layer(technique, self.longest) {
            self.arrivals.push(Arrival { pixel, layer, weight, value: value.0 });
        }
    }
}

impl Exposure for PyramidBuffer {
    fn unit(&self) -> Unit {
        self.unit
    }

    fn begin(&mut self, raster: Vec2) {
        let [x0, y0, width, _] = self.crop;
        let unit = &self.unit;
        // A position just below a whole number can round to it, and so leave the tile.
        let x = (raster.x as u32).saturating_sub(x0).clamp(unit.x, unit.x + unit.width - 1);
        let y = (raster.y as u32).saturating_sub(y0).clamp(unit.y, unit.y + unit.height - 1);
        self.pixel = y * width + x;
    }

    fn end(&mut self) {
        self.samples.push(self.pixel);
    }

    fn clear(&mut self) {
        self.samples.clear();
        self.arrivals.clear();
        self.refused = 0;
    }

    fn weigh(&mut self, weight: f64) {
        self.weight = weight;
    }
}

impl bidir_kernel::Film for PyramidBuffer {
    type Rivals = Together;

    fn add(&mut self, contribution: Contribution) {
        self.take(self.pixel, contribution);
    }

    fn splat(&mut self, raster: Vec2, contribution: Contribution) {
        let [x0, y0, width, height] = self.crop.map(f64::from);
        let (x, y) = (f64::from(raster.x) - x0, f64::from(raster.y) - y0);
        if x >= 0.0 && x < width && y >= 0.0 && y < height {
            self.take(y as u32 * self.crop[2] + x as u32, contribution);
        } else {
            self.refused += 1;
        }
    }
}

/// How many techniques paths of up to that length have: Σ (k + 2).
fn layers(longest: u32) -> u32 {
    longest * (longest + 5) / 2
}

fn layer(technique: Technique, longest: u32) -> Option<u32> {
    let length = (technique.s + technique.t).checked_sub(1)?;
    (1..=longest).contains(&length).then(|| layers(length - 1) + technique.s)
}

#[cfg(test)]
mod tests {
    use bidir_kernel::{Film as _, Spectrum};

    use super::*;
    use crate::scene::description::{Crop, Filter};

    fn pyramid() -> Pyramid {
        let crop = Crop { x: 2, y: 1, width: 18, height: 17 };
        Pyramid::new(&FilmSettings { width: 20, height: 20, crop, filter: Filter::Box }, 4).expect("a small pyramid")
    }

    #[test]
    fn every_technique_has_its_own_layer() {
        let found: Vec<_> = pyramid().techniques().filter_map(|t| layer(t, 4)).collect();
        assert_eq!(found, (0..layers(4)).collect::<Vec<_>>());
        for (s, t) in [(0, 0), (1, 0), (0, 6), (6, 0), (3, 3)] {
            assert_eq!(layer(Technique { s, t }, 4), None);
        }
    }

    /// Each technique brings s + 10 t with weight 1/(s + 1) to every pixel, in any order of commits.
    #[test]
    fn layers_hold_what_their_technique_brought() {
        let pyramid = pyramid();
        for end in [2, 3] {
            let buffers: Vec<_> = std::iter::from_fn(|| pyramid.claim(end)).collect();
            for mut buffer in buffers.into_iter().rev() {
                for (x, y) in pyramid.pixels(&buffer.unit()) {
                    let raster = Vec2::new(x as f32 + 0.5, y as f32 + 0.999);
                    buffer.begin(raster);
                    for technique in pyramid.techniques() {
                        let value = Spectrum::splat(technique.s as f32 + 10.0 * technique.t as f32);
                        let contribution = Contribution { value, weight: 1.0 / (technique.s as f32 + 1.0), technique };
                        if technique.t <= 1 { buffer.splat(raster, contribution) } else { buffer.add(contribution) }
                    }
                    buffer.end();
                }
                pyramid.commit(buffer);
            }
        }
        for technique in pyramid.techniques() {
            let value = technique.s as f32 + 10.0 * technique.t as f32;
            let [weighted, unweighted] = pyramid.develop(technique);
            assert!(unweighted.pixels.iter().all(|p| (p[1] - value).abs() < 1e-5), "{technique:?}");
            assert!(weighted.pixels.iter().all(|p| (p[2] - value / (technique.s as f32 + 1.0)).abs() < 1e-5), "{technique:?}");
        }
        assert_eq!(pyramid.refused(), 0);
    }

    #[test]
    fn a_sample_that_counts_more_is_that_many_samples() {
        let pyramid = pyramid();
        while let Some(mut buffer) = pyramid.claim(2) {
            let sample = buffer.unit().sample;
            buffer.weigh([1.0, 3.0][sample as usize]);
            for (x, y) in pyramid.pixels(&buffer.unit()) {
                let raster = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
                let of =
                    |s, t| Contribution { value: Spectrum::splat([2.0, 6.0][sample as usize]), weight: 0.5, technique: Technique { s, t } };
                buffer.begin(raster);
                buffer.add(of(1, 2));
                buffer.splat(raster, of(2, 1));
                buffer.end();
            }
            pyramid.commit(buffer);
        }
        for (s, t) in [(1, 2), (2, 1)] {
            let [weighted, unweighted] = pyramid.develop(Technique { s, t });
            let all = |image: &Image, value: f32| image.pixels.iter().all(|p| p.iter().all(|v| (v - value).abs() < 1e-6));
            assert!(all(&weighted, 2.5) && all(&unweighted, 5.0), "{s} {t}");
        }
    }

    #[test]
    fn a_pyramid_too_large_is_refused() {
        let crop = Crop { x: 0, y: 0, width: 2000, height: 2000 };
        let settings = FilmSettings { width: 2000, height: 2000, crop, filter: Filter::Box };
        for longest in [30, u32::MAX] {
            // 22 layers of 4e6 pixels of 48 bytes fit; up to length 4 there are 18, up to 5 there are 25.
            let error = Pyramid::new(&settings, longest).expect_err("too large").to_string();
            assert!(error.contains("--longest 4"), "{error}");
        }
    }
}
