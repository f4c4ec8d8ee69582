//! `<film>` and its reconstruction filter.

use super::{catalog, ids::Ids, properties::Properties, xml::Element};
use crate::{
    error::Result,
    scene::description::{Crop, FilmSettings, Filter},
};

/// The longest side of an image.
const MAX_SIDE: u64 = 1 << 20;
/// The most pixels of an image.
const MAX_PIXELS: u64 = 1 << 30;
/// The widest filter, in pixels.
const MAX_RADIUS: f64 = 15.0;

/// The film that an element describes, or Mitsuba's default.
pub(super) fn film(ids: &Ids, element: Option<&Element>) -> Result<FilmSettings> {
    let filter = Filter::Gaussian { stddev: 0.5 };
    let Some(element) = element else {
        let crop = Crop { x: 0, y: 0, width: 768, height: 576 };
        return Ok(FilmSettings { width: 768, height: 576, crop, filter });
    };
    let of = Properties::read(element, ids)?;
    catalog::check("film", of.kind(), &element.place)?;
    let width = side(&of, "width", 768)?;
    let height = side(&of, "height", 576)?;
    if u64::from(width) * u64::from(height) > MAX_PIXELS {
        let thing = format!("is {width}, which with a height of {height} is more than 2^30 pixels");
        return Err(of.error("width", thing, "render a smaller image"));
    }
    let crop = crop(&of, width, height)?;
    let filter = match of.object("rfilter")? {
        Some(element) => self::filter(ids, element)?,
        None => filter,
    };
    // RGB goes into the file whether or not alpha is asked for; other colours would be another image.
    of.choice("pixel_format", &[("rgb", ()), ("rgba", ())])?;
    of.choice("component_format", &[("float16", ()), ("float32", ())])?;
    of.choice("file_format", &[("openexr", ()), ("exr", ()), ("rgbe", ()), ("pfm", ())])?;
    of.boolean("compensate")?;
    of.boolean("sample_border")?;
    of.pass_over(&["banner", "high_quality_edges"]);
    of.finish()?;
    Ok(FilmSettings { width, height, crop, filter })
}

fn side(of: &Properties, name: &'static str, default: u32) -> Result<u32> {
    let Some(value) = of.whole(name, 1)? else { return Ok(default) };
    if value as u64 > MAX_SIDE {
        return Err(of.error(name, format!("is {value}"), format!("it must lie within 1 … {MAX_SIDE}")));
    }
    Ok(value as u32)
}

fn crop(of: &Properties, width: u32, height: u32) -> Result<Crop> {
    let mut window = [0_i64; 4];
    let axes = [("crop_offset_x", "crop_width", width), ("crop_offset_y", "crop_height", height)];
    for (axis, (offset, size, whole)) in axes.into_iter().enumerate() {
        let start = of.whole(offset, 0)?.unwrap_or(0);
        let length = of.whole(size, 1)?.unwrap_or(whole.into());
        if start + length > i64::from(whole) {
            let name = if of.has(size) { size } else { offset };
            let thing = format!("reaches beyond the image: {offset} {start} + {size} {length} > {whole}");
            return Err(of.error(name, thing, "keep the crop window inside the image"));
        }
        (window[axis], window[axis + 2]) = (start, length);
    }
    let [x, y, width, height] = window.map(|v| v as u32);
    Ok(Crop { x, y, width, height })
}

fn filter(ids: &Ids, element: &Element) -> Result<Filter> {
    let of = Properties::read(element, ids)?;
    catalog::check("rfilter", of.kind(), &element.place)?;
    let bounded = |name: &'static str, default: f64, most: f64| match of.positive(name)?.unwrap_or(default) {
        v if v > most => Err(of.error(name, format!("is {v}"), format!("it must not be above {most} pixels"))),
        v => Ok(v),
    };
    let filter = match of.kind() {
        "box" => Filter::Box,
        "mitchell" => Filter::Cubic { b: of.float("B")?.unwrap_or(1.0 / 3.0), c: of.float("C")?.unwrap_or(1.0 / 3.0) },
        "catmullrom" => Filter::Cubic { b: 0.0, c: 0.5 },
        "lanczos" => {
            let lobes = of.whole("lobes", 1)?.unwrap_or(3);
            if lobes as f64 > MAX_RADIUS {
                return Err(of.error("lobes", format!("is {lobes}"), format!("it must not be above {MAX_RADIUS}")));
            }
            Filter::Lanczos { lobes: lobes as f64 }
        }
        "tent" => Filter::Tent { radius: bounded("radius", 1.0, MAX_RADIUS)? },
        _ => Filter::Gaussian { stddev: bounded("stddev", 0.5, MAX_RADIUS / 4.0)? },
    };
    of.finish()?;
    Ok(filter)
}
