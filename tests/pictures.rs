//! Renders with error estimates: independent batches of one scene, each a picture of its own.

use std::{path::PathBuf, sync::atomic::AtomicBool};

use bidir::{
    film::{Film, Pyramid},
    image::{Image, write},
    plugin::Strictness,
    render::{self, Job, Numbers, Target},
    scene::{Scene, description::Description},
};
use bidir_kernel::{Heuristic, Strategy, Technique, Techniques};

use crate::statistics::Estimate;

/// How many pictures an error is estimated from.
pub const BATCHES: u32 = 32;

/// Path tracing, as far as the scene's integrator goes.
pub const PATH: Techniques = Techniques::PATH;
/// Light tracing.
pub const LIGHT: Techniques = Techniques::LIGHT;
/// Every technique.
pub const BDPT: Techniques = Techniques::BIDIRECTIONAL;

/// A scene ready to be rendered in many ways.
pub struct Subject {
    /// What was read.
    pub description: Description,
    /// What was built from it.
    pub scene: Scene,
}

/// The same picture, many times.
pub struct Pictures {
    /// Independent of each other.
    pub batches: Vec<Image>,
}

/// What the techniques brought, many times.
pub struct Pyramids {
    batches: Vec<Pyramid>,
}

impl Subject {
    /// The scene with these techniques.
    pub fn strategy(&self, techniques: Techniques, heuristic: Heuristic) -> Strategy {
        let integrator = &self.description.integrator;
        let max_depth = integrator.max_depth.unwrap_or(u32::MAX);
        Strategy { techniques, heuristic, max_depth, rr_depth: integrator.rr_depth }
    }

    /// What `bidir render` does with one thread.
    pub fn job(&self, strategy: Strategy, samples: u32, seed: u64) -> Job {
        Job {
            strategy,
            seed,
            numbers: Numbers::default(),
            threads: 1,
            target: Target::Samples(samples),
            width: self.description.film.width,
            strictness: Strictness::Strict,
        }
    }

    /// One picture.
    pub fn image(&self, job: &Job) -> Image {
        let film = Film::new(&self.description.film).expect("a film");
        let status = render::render(&self.scene, &film, job, &AtomicBool::new(false), |_| None);
        assert_eq!(status.fault, None);
        assert!(!status.interrupted && film.refused() == 0, "{} contributions refused", film.refused());
        film.develop()
    }

    /// [`BATCHES`] pictures with `samples` per pixel each; `seed` tells apart what must not share random numbers.
    pub fn pictures(&self, strategy: Strategy, samples: u32, seed: u64) -> Pictures {
        let batch = |i| self.image(&self.job(strategy, samples, seed * 1000 + u64::from(i)));
        Pictures { batches: (0..BATCHES).map(batch).collect() }
    }

    /// The same, techniques kept apart for paths of up to `longest` segments.
    pub fn pyramids(&self, strategy: Strategy, samples: u32, seed: u64, longest: u32) -> Pyramids {
        let batch = |i| {
            let pyramid = Pyramid::new(&self.description.film, longest).expect("a pyramid");
            let job = self.job(strategy, samples, seed * 1000 + u64::from(i));
            let status = render::render(&self.scene, &pyramid, &job, &AtomicBool::new(false), |_| None);
            assert_eq!(status.fault, None);
            assert_eq!(pyramid.refused(), 0);
            pyramid
        };
        Pyramids { batches: (0..BATCHES).map(batch).collect() }
    }
}

/// A rectangle of pixels: left, top, width, height.
pub type Region = [u32; 4];

impl Pictures {
    /// All of it.
    pub fn whole(&self) -> Region {
        [0, 0, self.batches[0].width, self.batches[0].height]
    }

    /// Squares of 8×8 pixels; what is left at the right and lower edge is left out.
    pub fn blocks(&self) -> Vec<Region> {
        let [_, _, width, height] = self.whole();
        let steps = |length: u32| (0..length / 8).map(|i| i * 8);
        steps(height).flat_map(|y| steps(width).map(move |x| [x, y, 8, 8])).collect()
    }

    /// The mean of a region over pixels and `bands`.
    pub fn mean(&self, region: Region, bands: &[usize]) -> Estimate {
        Estimate::of(&self.batches.iter().map(|image| mean(image, region, bands)).collect::<Vec<_>>())
    }

    /// All batches in one.
    pub fn average(&self) -> Image {
        let mut sum = Image::black(self.batches[0].width, self.batches[0].height);
        for (i, pixel) in sum.pixels.iter_mut().enumerate() {
            let total = |band: usize| self.batches.iter().map(|image| f64::from(image.pixels[i][band])).sum::<f64>();
            *pixel = [0, 1, 2].map(|band| (total(band) / self.batches.len() as f64) as f32);
        }
        sum
    }
}

impl Pyramids {
    /// The mean over pixels and bands of what a technique brought, weighted (0) or unweighted (1).
    pub fn technique(&self, technique: Technique, layer: usize) -> Estimate {
        Estimate::of(&self.means(|pyramid| mean_of(&pyramid.develop(technique)[layer])))
    }

    /// The weighted mean of all paths with `length` segments.
    pub fn length(&self, length: u32) -> Estimate {
        Estimate::of(
            &self.means(|pyramid| (0..=length + 1).map(|s| mean_of(&pyramid.develop(Technique { s, t: length + 1 - s })[0])).sum()),
        )
    }

    fn means(&self, of: impl Fn(&Pyramid) -> f64) -> Vec<f64> {
        self.batches.iter().map(of).collect()
    }
}

/// The mean of a picture over pixels and bands.
pub fn mean_of(image: &Image) -> f64 {
    mean(image, [0, 0, image.width, image.height], &[0, 1, 2])
}

fn mean(image: &Image, [x, y, width, height]: Region, bands: &[usize]) -> f64 {
    let pixels = (y..y + height).flat_map(|y| (x..x + width).map(move |x| image.at(x, y)));
    pixels.map(|pixel| bands.iter().map(|&band| f64::from(pixel[band])).sum::<f64>()).sum::<f64>()
        / (f64::from(width) * f64::from(height) * bands.len() as f64)
}

/// Leaves two pictures and ten times their difference (about grey) where somebody can look at them; says where.
pub fn leave(test: &str, named: &[(&str, &Image)]) -> PathBuf {
    let folder = std::env::temp_dir().join("bidir-tests").join(test);
    std::fs::create_dir_all(&folder).expect("a folder for pictures");
    let save = |name: &str, image: &Image| {
        for extension in ["exr", "png"] {
            write::write(&folder.join(name).with_extension(extension), &image.into()).expect("a picture");
        }
    };
    for (name, image) in named {
        save(name, image);
    }
    if let [(_, a), (_, b), ..] = named {
        let scale = mean_of(b).max(f64::MIN_POSITIVE) as f32;
        let difference = a.pixels.iter().zip(&b.pixels).map(|(a, b)| [0, 1, 2].map(|i| 0.5 + 10.0 * (a[i] - b[i]) / scale)).collect();
        save("difference", &Image { pixels: difference, ..**a });
    }
    folder
}
