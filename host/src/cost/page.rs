//! The page: one file that needs no other, and the figures behind it beside it.

use std::path::Path;

use exr::prelude::f16;

use super::{
    report::Report,
    tables::{errors, knobs, prices, time},
};
use crate::{
    check::page::markup::{base64, escaped},
    error::{Error, Result},
    image::{Image, read::picture, resize::resize},
    partial::Partial,
};

const PAGE: &str = include_str!("page/page.html");
const STYLE: &str = include_str!("page/page.css");
const SCRIPT: &str = include_str!("page/page.js");

/// What is being written, for messages.
const WHAT: &str = "report";

/// Pictures larger than this, in pixels, are shown smaller.
const LARGEST: f64 = 1e6;

/// The page's name within its folder.
pub const NAME: &str = "index.html";

/// Writes the page and its figures into the folder that [`super::measure`] kept everything in.
///
/// # Errors
/// If something cannot be written, or a picture is not there any more.
pub fn write(folder: &Path, report: &Report) -> Result<()> {
    let json = serde_json::to_string_pretty(report)
        .map_err(|error| Error::in_file(folder, format!("no JSON: {error}"), "this is a bug; please report it"))?;
    for (name, text) in
        [("error.csv", errors(report)), ("prices.csv", prices(report)), ("knobs.csv", knobs(report)), ("time.csv", time(report))]
    {
        Partial::write_text(&folder.join(name), WHAT, &text)?;
    }
    Partial::write_text(&folder.join("report.json"), WHAT, &(json.clone() + "\n"))?;
    let mut images = String::new();
    for shown in &report.images {
        images += &script(&shown.name, &picture(&shown.file)?);
    }
    let title = format!("{}: what accuracy costs", report.scene);
    let mut page = String::new();
    let mut rest = PAGE;
    // Each token once, from the left: what is put in is never searched.
    while let Some((before, (token, after))) = rest.split_once("{{").and_then(|(before, after)| Some((before, after.split_once("}}")?))) {
        page += before;
        match token {
            "title" => page += &escaped(&title),
            "css" => page += STYLE,
            "js" => page += SCRIPT,
            "report" => page += &json.replace('<', "\\u003c"),
            _ => page += &images,
        }
        rest = after;
    }
    Partial::write_text(&folder.join(NAME), WHAT, &(page + rest))
}

/// A picture as text that the page's script reads: linear R, G, B in half floats.
fn script(name: &str, image: &Image) -> String {
    let scale = (LARGEST / image.pixels.len().max(1) as f64).sqrt();
    let smaller;
    let image = if scale < 1.0 {
        let of = |length: u32| ((f64::from(length) * scale) as u32).max(1);
        smaller = resize(image, of(image.width), of(image.height));
        &smaller
    } else {
        image
    };
    let bytes: Vec<u8> = image.pixels.iter().flatten().flat_map(|value| f16::from_f32(*value).to_le_bytes()).collect();
    let (name, width, height) = (escaped(name), image.width, image.height);
    let text = base64(&bytes);
    format!(
        "<script type=\"text/plain\" class=\"image\" data-name=\"{name}\" data-width=\"{width}\" data-height=\"{height}\">{text}</script>\n"
    )
}
