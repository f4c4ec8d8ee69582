//! Writes pictures. A file is either whole or not there.

use std::{
    io::{BufWriter, Seek, Write},
    path::Path,
};

use bidir_kernel::math;
use exr::prelude as ex;
use image::{ExtendedColorType, ImageEncoder, Rgb, codecs};

use super::Image;
use crate::{
    error::{Error, Result},
    partial::Partial,
};

/// What is being written, for messages.
const WHAT: &str = "image";

/// What goes into a file.
#[derive(Clone, Debug)]
pub struct Layers<'a> {
    /// The picture: an EXR's unnamed layer.
    pub image: &'a Image,
    /// Others of the same size; EXR only.
    pub named: Vec<Layer<'a>>,
    /// What a reader should know (samples per pixel, seed, version), as `name=value` words in an EXR's `comments`.
    /// Other formats leave it out.
    pub notes: Vec<(String, String)>,
}

/// A layer beside the picture.
#[derive(Clone, Debug)]
pub struct Layer<'a> {
    /// Channels are called `name.R` and so on.
    pub name: String,
    /// What comes after the name, for as many bands of the image; at most 3.
    pub channels: &'a [&'a str],
    /// As large as the picture.
    pub image: &'a Image,
}

impl<'a> Layer<'a> {
    /// A layer of colours.
    pub fn rgb(name: impl Into<String>, image: &'a Image) -> Self {
        Self { name: name.into(), channels: &RGB, image }
    }
}

const RGB: [&str; 3] = ["R", "G", "B"];

impl<'a> From<&'a Image> for Layers<'a> {
    fn from(image: &'a Image) -> Self {
        Self { image, named: Vec::new(), notes: Vec::new() }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Exr,
    Hdr,
    Png,
}

/// Whether [`write()`] could write there: the extension is known, and the folder takes a file. Leaves nothing behind.
/// To be asked before a render starts.
pub fn check_writable(path: &Path) -> Result<()> {
    format_of(path)?;
    Partial::create(path, WHAT).map(drop)
}

/// Writes by extension: `.exr` linear in float32; `.hdr` linear in RGBE; `.png` in 8-bit sRGB, clamped to 0 … 1 and not dithered.
/// An existing file is replaced once the new one is whole.
pub fn write(path: &Path, layers: &Layers) -> Result<()> {
    let format = format_of(path)?;
    check_layers(path, format, layers)?;
    let mut partial = Partial::create(path, WHAT)?;
    let mut out = BufWriter::new(partial.file());
    match format {
        Format::Exr => write_exr(&mut out, layers),
        Format::Hdr => write_hdr(&mut out, layers.image),
        Format::Png => write_png(&mut out, layers.image),
    }
    .and_then(|()| out.flush().map_err(|e| e.to_string()))
    .map_err(|cause| Error::in_file(path, format!("the image cannot be written: {cause}"), "free some space, or choose another place"))?;
    drop(out);
    partial.finish()
}

fn format_of(path: &Path) -> Result<Format> {
    let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    match extension.as_deref() {
        Some("exr") => Ok(Format::Exr),
        Some("hdr") => Ok(Format::Hdr),
        Some("png") => Ok(Format::Png),
        Some(other) => Err(Error::in_file(path, format!("images of type .{other} cannot be written"), "choose .exr, .hdr or .png")),
        None => Err(Error::in_file(path, "an image's name needs an extension", "choose .exr, .hdr or .png")),
    }
}

fn check_layers(path: &Path, format: Format, layers: &Layers) -> Result<()> {
    if format != Format::Exr && !layers.named.is_empty() {
        return Err(Error::in_file(path, "only an EXR holds more than one layer", "choose .exr"));
    }
    let Image { width, height, .. } = *layers.image;
    let images = || std::iter::once(layers.image).chain(layers.named.iter().map(|layer| layer.image));
    if width == 0 || height == 0 || images().any(|i| i.pixels.len() != width as usize * height as usize) {
        return Err(Error::in_file(path, "an image needs pixels, and its layers one size", "this is a bug; please report it"));
    }
    if let Some(Layer { name, image, .. }) = layers.named.iter().find(|layer| (layer.image.width, layer.image.height) != (width, height)) {
        let thing = format!("layer {name} has {}×{} pixels, the image {width}×{height}", image.width, image.height);
        return Err(Error::in_file(path, thing, "this is a bug; please report it"));
    }
    Ok(())
}

fn write_exr(out: impl Write + Seek, layers: &Layers) -> std::result::Result<(), String> {
    let mut channels = ex::SmallVec::new();
    let unnamed = std::iter::once((String::new(), &RGB[..], layers.image));
    let named = layers.named.iter().map(|layer| (format!("{}.", layer.name), layer.channels, layer.image));
    for (prefix, letters, image) in unnamed.chain(named) {
        for (band, letter) in letters.iter().take(3).enumerate() {
            let samples = image.pixels.iter().map(|pixel| pixel[band]).collect();
            channels.push(ex::AnyChannel::new(text(&format!("{prefix}{letter}"))?, ex::FlatSamples::F32(samples)));
        }
    }
    let words: Vec<_> = layers.notes.iter().map(|(name, value)| format!("{name}={value}")).collect();
    // One attribute, and a standard one: the writer keeps others in a map whose order changes from run to run.
    let attributes = ex::LayerAttributes {
        comments: (!words.is_empty()).then(|| text(&words.join(" "))).transpose()?,
        ..ex::LayerAttributes::default()
    };
    let size = (layers.image.width as usize, layers.image.height as usize);
    let layer = ex::Layer::new(size, attributes, ex::Encoding::SMALL_LOSSLESS, ex::AnyChannels::sort(channels));
    ex::WritableImage::write(&ex::Image::from_layer(layer)).to_buffered(out).map_err(|e| e.to_string())
}

fn text(words: &str) -> std::result::Result<ex::Text, String> {
    ex::Text::new_or_none(words).ok_or_else(|| format!("EXR cannot spell “{words}”"))
}

/// RGBE has no sign and no infinity; its 8-bit mantissas are cut, not rounded.
fn write_hdr(out: impl Write, image: &Image) -> std::result::Result<(), String> {
    let pixels: Vec<_> = image.pixels.iter().map(|pixel| Rgb(pixel.map(|v| if v.is_nan() { 0.0 } else { v.clamp(0.0, 1e38) }))).collect();
    let (width, height) = (image.width as usize, image.height as usize);
    codecs::hdr::HdrEncoder::new(out).encode(&pixels, width, height).map_err(|e| e.to_string())
}

fn write_png(out: impl Write, image: &Image) -> std::result::Result<(), String> {
    let bytes: Vec<u8> = image.pixels.iter().flatten().map(|&v| srgb(v)).collect();
    codecs::png::PngEncoder::new(out).write_image(&bytes, image.width, image.height, ExtendedColorType::Rgb8).map_err(|e| e.to_string())
}

/// Linear → 8-bit sRGB (IEC 61966-2-1), rounded to the nearest; NaN is black.
fn srgb(linear: f32) -> u8 {
    let v = linear.clamp(0.0, 1.0);
    // The cast takes NaN to 0.
    let encoded = if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * math::pow(v, 1.0 / 2.4) - 0.055 };
    (encoded * 255.0 + 0.5) as u8
}

#[cfg(test)]
mod tests;
