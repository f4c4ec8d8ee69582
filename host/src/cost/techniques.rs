//! The techniques apart: small pictures of each, weighted and not.

use std::sync::{Arc, atomic::AtomicBool};

use serde::{Deserialize, Serialize};

use super::subject::{Subject, whole};
use crate::{
    check::page::png,
    error::Result,
    film::{
        Pyramid,
        picture::{self, Deciding},
    },
    image::{Image, resize::resize},
    plan::{Stage, joins::exists},
    render::{self, Target},
};

/// The longest paths that are shown.
const LONGEST: u32 = 6;
/// The widest small picture, in pixels.
const WIDEST: u32 = 112;

/// The (s,t) pyramid.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Techniques {
    /// In segments.
    pub longest: u32,
    /// By path length, then by s.
    pub techniques: Vec<Apart>,
}

/// What one technique brings.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Apart {
    /// Vertices of the light walk.
    pub s: u32,
    /// Vertices of the camera walk.
    pub t: u32,
    /// Mean of its part of the image.
    pub mean_weighted: f64,
    /// Mean of what it would have been alone.
    pub mean_unweighted: f64,
    /// A picture as a data URI, every row exposed alike.
    pub weighted: String,
    /// The same without weights.
    pub unweighted: String,
}

/// All techniques that there are in the scene; `None` where its film is too large for that.
///
/// # Errors
/// If a plugin broke off.
pub fn apart(subject: &Subject, samples: u32, interrupt: &Arc<AtomicBool>) -> Result<Option<Techniques>> {
    let longest = LONGEST.min(subject.description.integrator.max_depth.unwrap_or(LONGEST)).max(1);
    let Ok(pyramid) = Pyramid::new(&subject.description.film, longest) else { return Ok(None) };
    let mut manner = subject.manner(&Stage::BIDIRECTIONAL);
    manner.strategy.max_depth = longest;
    let job = subject.job(&manner, 0, Target::Samples(samples));
    whole(&render::render(&subject.scene, &pyramid, &job, interrupt, |_| None))?;
    let there: Vec<_> = pyramid.techniques().filter(|&technique| exists(&subject.effects, technique)).collect();
    let images: Vec<[Image; 2]> = there.iter().map(|&technique| pyramid.develop(technique)).collect();
    let small = |image: &Image| {
        let width = image.width.min(WIDEST);
        resize(image, width, (image.height * width / image.width).max(1))
    };
    let layers = [0, 1].map(|kind| {
        let layer = |(&technique, images): (_, &[Image; 2])| picture::Layer { technique, image: small(&images[kind]) };
        there.iter().zip(&images).map(layer).collect::<Vec<_>>()
    });
    let exposures =
        [Deciding::Brightest, Deciding::Middle].into_iter().zip(&layers).map(|(deciding, layers)| picture::draw(layers, deciding).1);
    let exposures: Vec<_> = exposures.collect();
    let uri = |kind: usize, index: usize| {
        let layer = &layers[kind][index];
        let stops = exposures[kind].iter().find(|(length, _)| *length == layer.technique.length()).map_or(1.0, |(_, stops)| stops.factor());
        exposed(&layer.image, stops)
    };
    let techniques = there.iter().zip(&images).enumerate().map(|(index, (technique, [weighted, unweighted]))| Apart {
        s: technique.s,
        t: technique.t,
        mean_weighted: mean(weighted),
        mean_unweighted: mean(unweighted),
        weighted: uri(0, index),
        unweighted: uri(1, index),
    });
    Ok(Some(Techniques { longest, techniques: techniques.collect() }))
}

fn mean(image: &Image) -> f64 {
    let sum: f64 = image.pixels.iter().flatten().map(|value| f64::from(*value)).sum();
    sum / (3 * image.pixels.len().max(1)) as f64
}

fn exposed(image: &Image, factor: f64) -> String {
    let rgba: Vec<u8> = image
        .pixels
        .iter()
        .flat_map(|[r, g, b]| [*r, *g, *b].map(|v| png::toned(factor * f64::from(v))).into_iter().chain([255]))
        .collect();
    png::uri(image.width as usize, image.height as usize, &rgba)
}
