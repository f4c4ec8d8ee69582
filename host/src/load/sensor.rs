//! `<sensor>`: the camera, its film and its sampler.

use glam::DVec2;

use super::{catalog, film, ids::Ids, properties::Properties, transform, xml::Element};
use crate::{
    error::{Error, Result},
    scene::description::{FilmSettings, Sensor, SensorKind},
};

/// Diagonal of 35 mm film, in mm.
const FILM_DIAGONAL: f64 = 43.266_615_305_567_87;
/// Mitsuba's far clip, which is its focus distance too.
const FAR: f64 = 1e4;

/// A sensor and what belongs to it.
pub(super) struct Equipment {
    pub(super) sensor: Sensor,
    pub(super) film: FilmSettings,
    pub(super) samples_per_pixel: u32,
    pub(super) seed: u64,
}

/// The sensor that an element describes.
pub(super) fn sensor(ids: &Ids, element: &Element) -> Result<Equipment> {
    let of = Properties::read(element, ids)?;
    catalog::check("sensor", of.kind(), &element.place)?;
    let film = film::film(ids, of.object("film")?)?;
    let (samples_per_pixel, seed) = sampler(ids, of.object("sampler")?)?;
    let to_world = of.transform("to_world")?;
    let (near_clip, far_clip) = (of.positive("near_clip")?, of.positive("far_clip")?);
    if let (Some(near), Some(far)) = (near_clip, far_clip)
        && near >= far
    {
        return Err(of.error("near_clip", "is not below far_clip", "swap them"));
    }
    of.pass_over(&["shutter_open", "shutter_close"]); // nothing moves
    let mut principal_point_offset = DVec2::ZERO;
    let kind = if of.kind() == "orthographic" {
        if !transform::is_invertible(&to_world) {
            return Err(of.error("to_world", "flattens the camera", "scale every axis by something other than 0"));
        }
        of.pass_over(&["focus_distance"]);
        SensorKind::Orthographic
    } else {
        if !transform::is_rigid(&to_world) {
            return Err(of.error("to_world", "scales or skews the camera", "only move, turn and mirror it; fov sets how much it sees"));
        }
        if of.kind() == "perspective" {
            let offset = |name| of.float(name).map(|v| v.unwrap_or(0.0));
            principal_point_offset = DVec2::new(offset("principal_point_offset_x")?, offset("principal_point_offset_y")?);
        }
        perspective(&of, &film, far_clip)?
    };
    let media = of.objects("medium");
    if let Some(medium) = media.first() {
        return Err(Error::at(&medium.place, "media are not supported", "take the medium out"));
    }
    of.finish()?;
    let sensor = Sensor { kind, to_world, principal_point_offset, near_clip, far_clip, place: element.place.clone() };
    Ok(Equipment { sensor, film, samples_per_pixel, seed })
}

fn perspective(of: &Properties, film: &FilmSettings, far_clip: Option<f64>) -> Result<SensorKind> {
    let fov_x = fov_x(of, f64::from(film.width) / f64::from(film.height))?;
    let focus = of.positive("focus_distance")?.unwrap_or(far_clip.unwrap_or(FAR));
    if of.kind() == "perspective" {
        return Ok(SensorKind::Perspective { fov_x, aperture_radius: 0.0, focus_distance: focus });
    }
    let aperture_radius = of.float("aperture_radius")?.ok_or_else(|| of.missing("aperture_radius", "float"))?;
    if !(0.0..=1e30).contains(&aperture_radius) {
        return Err(of.error("aperture_radius", format!("is {aperture_radius}"), "it must not be below 0"));
    }
    Ok(SensorKind::Perspective { fov_x, aperture_radius, focus_distance: focus })
}

/// The horizontal field of view in degrees; `aspect` is width over height.
fn fov_x(of: &Properties, aspect: f64) -> Result<f64> {
    let tan = |degrees: f64| libm::tan(degrees.to_radians() / 2.0);
    let degrees = |tan: f64| 2.0 * libm::atan(tan).to_degrees();
    let diagonal = aspect / libm::sqrt(aspect * aspect + 1.0);
    let Some(fov) = of.float("fov")? else {
        let written = of.text("focal_length")?;
        let text = written.unwrap_or("50mm").trim();
        let number = text.strip_suffix("mm").unwrap_or(text).trim().parse::<f64>();
        let millimetres = number.ok().filter(|v| *v > 0.0 && v.is_finite());
        let remedy = "write millimetres, such as \"50mm\"";
        let millimetres = millimetres.ok_or_else(|| of.error("focal_length", format!("is \"{text}\""), remedy))?;
        if of.has("fov_axis") {
            return Err(of.error("fov_axis", "is given without fov", "write fov, or leave fov_axis out: focal_length is the diagonal's"));
        }
        return checked(of, "focal_length", degrees(FILM_DIAGONAL / 2.0 / millimetres * diagonal));
    };
    if of.has("focal_length") {
        return Err(of.error("focal_length", "is given together with fov", "keep one of them"));
    }
    if !(fov > 0.0 && fov < 180.0) {
        return Err(of.error("fov", format!("is {fov}"), "it must lie between 0 and 180 degrees"));
    }
    // What to multiply a tangent along the axis with to have it along x.
    let smaller = if aspect < 1.0 { 1.0 } else { aspect };
    let larger = if aspect < 1.0 { aspect } else { 1.0 };
    let axes = [("x", 1.0), ("y", aspect), ("diagonal", diagonal), ("smaller", smaller), ("larger", larger)];
    let factor = of.choice("fov_axis", &axes)?;
    let fov_x = if factor == 1.0 { fov } else { degrees(tan(fov) * factor) };
    checked(of, "fov", fov_x)
}

fn checked(of: &Properties, name: &str, fov_x: f64) -> Result<f64> {
    if !(1e-6..=179.99999).contains(&fov_x) {
        return Err(of.error(name, format!("is {fov_x} degrees along x"), "choose one further from 0 and 180"));
    }
    Ok(fov_x)
}

/// Samples per pixel, and the seed.
fn sampler(ids: &Ids, element: Option<&Element>) -> Result<(u32, u64)> {
    let Some(element) = element else { return Ok((4, 0)) };
    let of = Properties::read(element, ids)?;
    catalog::check("sampler", of.kind(), &element.place)?;
    let count = of.whole("sample_count", 1)?.unwrap_or(4);
    let seed = of.whole("seed", 0)?.unwrap_or(0);
    of.pass_over(&["jitter", "strength"]); // how points are spread is ours to say
    of.finish()?;
    Ok((count as u32, seed as u64))
}
