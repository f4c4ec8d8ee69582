//! What `bidir techniques` leaves in its folder.

use std::path::{Path, PathBuf};

use bidir_kernel::Technique;
use serde::Serialize;

use crate::{
    error::{Error, Result},
    film::{
        Pyramid,
        picture::{self, Deciding, Layer},
    },
    image::{
        Image,
        write::{self, Layers},
    },
    partial::Partial,
    plan::joins,
};

/// The two pyramids: their pictures, and the folders of their images.
pub(super) const KINDS: [&str; 2] = ["weighted", "unweighted"];
/// The first row of a picture shows something in at least this share of the pixels: short paths that meet a few pixels
/// of a lamp are in files, and in no row.
const WORTH_A_ROW: f64 = 0.05;

/// `index.json`.
#[derive(Debug, Serialize)]
pub(super) struct Index {
    /// The scene's file.
    pub scene: PathBuf,
    /// Of every image.
    pub width: u32,
    /// Of every image.
    pub height: u32,
    /// Samples per pixel.
    pub spp: u32,
    /// Of the random numbers.
    pub seed: u64,
    /// The longest paths that are shown, in segments.
    pub longest: u32,
    /// Of all paths up to there: R, G, B.
    pub mean: [f64; 3],
    /// Those with files.
    pub techniques: Vec<Entry>,
    /// (s, t) of those that nothing in the scene can be joined by; they have no files.
    pub impossible: Vec<[u32; 2]>,
    /// The pyramids.
    pub pictures: Vec<Picture>,
    /// Whether Ctrl-C ended it.
    pub interrupted: bool,
    /// Of this program.
    pub version: &'static str,
}

/// A technique's files and what is in them.
#[derive(Debug, Serialize)]
pub(super) struct Entry {
    s: u32,
    t: u32,
    /// Segments.
    length: u32,
    join: &'static str,
    /// Of the image up to the longest paths shown, bands added up.
    share: f64,
    weighted: Part,
    unweighted: Part,
}

#[derive(Debug, Serialize)]
struct Part {
    file: String,
    /// R, G, B.
    mean: [f64; 3],
}

/// A picture of a pyramid.
#[derive(Debug, Serialize)]
pub(super) struct Picture {
    file: String,
    rows: Vec<Row>,
}

#[derive(Debug, Serialize)]
struct Row {
    length: u32,
    /// What radiance is multiplied by.
    exposure: f64,
}

/// Writes every technique of `there`, one at a time, then the pictures of all and the index, which it completes.
pub(super) fn save(folder: &Path, pyramid: &Pyramid, there: &[Technique], mut index: Index) -> Result<()> {
    let note = |name: &str, value: String| (name.to_owned(), value);
    let notes = vec![
        note("renderer", format!("bidir {}", index.version)),
        note("spp", index.spp.to_string()),
        note("seed", index.seed.to_string()),
    ];
    let columns = (1..=index.longest).map(|k| there.iter().filter(|t| t.length() == k).count()).max().unwrap_or(0);
    let cell = picture::cell_size(index.width, index.height, columns as u32);
    let mut shown: [Vec<Layer>; 2] = [Vec::new(), Vec::new()];
    for &technique in there {
        let Technique { s, t } = technique;
        let images = pyramid.develop(technique);
        let [weighted, unweighted] = [0, 1].map(|i| Part { file: format!("{}/s{s}_t{t}.exr", KINDS[i]), mean: mean(&images[i]) });
        for ((image, part), shown) in images.iter().zip([&weighted, &unweighted]).zip(&mut shown) {
            write::write(&folder.join(&part.file), &Layers { image, named: Vec::new(), notes: notes.clone() })?;
            shown.push(picture::layer(technique, image, cell));
        }
        index.mean.iter_mut().zip(weighted.mean).for_each(|(sum, mean)| *sum += mean);
        let join = joins::name(technique.join());
        index.techniques.push(Entry { s, t, length: technique.length(), join, share: 0.0, weighted, unweighted });
    }
    let total: f64 = index.mean.iter().sum();
    if total > 0.0 {
        index.techniques.iter_mut().for_each(|entry| entry.share = entry.weighted.mean.iter().sum::<f64>() / total);
    }
    index.pictures = draw(folder, &shown)?;
    write_index(&folder.join("index.json"), &index)
}

fn draw(folder: &Path, shown: &[Vec<Layer>; 2]) -> Result<Vec<Picture>> {
    let longest = shown[0].iter().map(|layer| layer.technique.length()).max().unwrap_or(0);
    let first = (1..=longest).find(|&length| covered(&shown[0], length) >= WORTH_A_ROW).unwrap_or(1);
    let mut pictures = Vec::new();
    for ((kind, layers), deciding) in KINDS.iter().zip(shown).zip([Deciding::Brightest, Deciding::Middle]) {
        let layers: Vec<Layer> = layers.iter().filter(|layer| layer.technique.length() >= first).cloned().collect();
        if layers.is_empty() {
            continue;
        }
        let (image, rows) = picture::draw(&layers, deciding);
        let file = format!("{kind}.png");
        write::write(&folder.join(&file), &Layers::from(&image))?;
        pictures
            .push(Picture { file, rows: rows.iter().map(|(length, stops)| Row { length: *length, exposure: stops.factor() }).collect() });
    }
    Ok(pictures)
}

/// The share of pixels that paths of a length bring anything to.
fn covered(layers: &[Layer], length: u32) -> f64 {
    let images: Vec<&Image> = layers.iter().filter(|layer| layer.technique.length() == length).map(|layer| &layer.image).collect();
    let Some(first) = images.first() else { return 0.0 };
    let lit = (0..first.pixels.len()).filter(|&i| images.iter().any(|image| image.pixels[i] != [0.0; 3])).count();
    lit as f64 / first.pixels.len() as f64
}

fn mean(image: &Image) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for pixel in &image.pixels {
        sum.iter_mut().zip(pixel).for_each(|(sum, &value)| *sum += f64::from(value));
    }
    sum.map(|sum| sum / image.pixels.len().max(1) as f64)
}

fn write_index(path: &Path, index: &Index) -> Result<()> {
    let text = serde_json::to_string_pretty(index).map_err(|error| {
        Error::in_file(path, format!("the index cannot be spelled as JSON: {error}"), "this is a bug; please report it")
    })?;
    Partial::write_text(path, "index", &(text + "\n"))
}
