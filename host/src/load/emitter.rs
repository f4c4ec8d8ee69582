//! `<emitter>`: lights, on shapes and alone.

use std::sync::Arc;

use bidir_kernel::Spectrum;
use glam::{DAffine3, DVec3};

use super::{
    catalog,
    context::Context,
    properties::{Properties, Value},
    texture::named_here,
    transform,
    xml::Element,
};
use crate::{
    error::{Error, Place, Result},
    image::read::{Encoding, read},
    scene::description::{Emitter, EmitterKind, EnvironmentImage},
};

/// The radiance of a shape's light.
pub(super) fn area(context: &mut Context, element: &Element, shape: &Place) -> Result<Spectrum> {
    let radiance = unattached_area(context, element)?;
    context.attach(element, shape)?;
    Ok(radiance)
}

/// The radiance of an area light, on a shape or not yet.
pub(super) fn unattached_area(context: &Context, element: &Element) -> Result<Spectrum> {
    let of = Properties::read(element, &context.ids)?;
    catalog::check("emitter", of.kind(), &element.place)?;
    if of.kind() != "area" {
        let thing = format!("a {} emitter stands inside a shape", of.kind());
        return Err(Error::at(&element.place, thing, "only area lights are on shapes; move it out of the shape"));
    }
    let radiance = of.radiance("radiance")?;
    of.pass_over(&["sampling_weight"]);
    of.finish()?;
    Ok(radiance)
}

/// A light that is not on a shape.
pub(super) fn emitter(context: &mut Context, element: &Element) -> Result<Emitter> {
    let of = Properties::read(element, &context.ids)?;
    catalog::check("emitter", of.kind(), &element.place)?;
    let kind = match of.kind() {
        "point" => point(&of)?,
        "spot" => spot(&of)?,
        "directional" => directional(&of)?,
        "constant" => {
            of.pass_over(&["to_world"]);
            EmitterKind::Constant { radiance: of.radiance("radiance")? }
        }
        _ => envmap(context, &of)?,
    };
    of.pass_over(&["sampling_weight"]);
    of.finish()?;
    Ok(Emitter { kind, place: element.place.clone() })
}

fn point(of: &Properties) -> Result<EmitterKind> {
    let position = match of.vector("position")? {
        Some(_) if of.has("to_world") => return Err(of.error("to_world", "is given together with position", "keep one of them")),
        Some(position) => position,
        None => of.transform("to_world")?.translation,
    };
    Ok(EmitterKind::Point { position, intensity: of.radiance("intensity")? })
}

fn spot(of: &Properties) -> Result<EmitterKind> {
    if let Some(Value::Object(_)) = of.any("texture") {
        return Err(of.error("texture", "is not supported", "take it out"));
    }
    of.refuse("texture", "take it out")?;
    let to_world = of.transform("to_world")?;
    if !transform::is_similar(&to_world) {
        return Err(of.error("to_world", "skews or squashes the spot", "only move, turn and mirror it"));
    }
    let cutoff_angle = of.float("cutoff_angle")?.unwrap_or(20.0);
    let beam_width = of.float("beam_width")?.unwrap_or(cutoff_angle * 0.75);
    if !(cutoff_angle > 0.0 && cutoff_angle <= 180.0) {
        return Err(of.error("cutoff_angle", format!("is {cutoff_angle}"), "it must lie above 0 and not above 180 degrees"));
    }
    if !(0.0..=cutoff_angle).contains(&beam_width) {
        return Err(of.error("beam_width", format!("is {beam_width}"), format!("it must lie within 0 … {cutoff_angle}, the cutoff_angle")));
    }
    let turned = DAffine3 { matrix3: to_world.matrix3 * (1.0 / to_world.matrix3.z_axis.length()), ..to_world };
    Ok(EmitterKind::Spot { to_world: turned, intensity: of.radiance("intensity")?, cutoff_angle, beam_width })
}

fn directional(of: &Properties) -> Result<EmitterKind> {
    let direction = match of.vector("direction")? {
        Some(_) if of.has("to_world") => return Err(of.error("to_world", "is given together with direction", "keep one of them")),
        Some(direction) => direction,
        None => of.transform("to_world")?.transform_vector3(DVec3::Z),
    };
    let Some(direction) = direction.try_normalize() else {
        return Err(of.error("direction", "is 0", "write where the light goes, such as \"0, -1, 0\""));
    };
    Ok(EmitterKind::Directional { direction, irradiance: of.radiance("irradiance")? })
}

fn envmap(context: &mut Context, of: &Properties) -> Result<EmitterKind> {
    of.refuse("bitmap", "name a file with \"filename\"")?;
    of.pass_over(&["mis_compensation"]);
    let scale = of.float("scale")?.unwrap_or(1.0);
    if !(0.0..=1e30).contains(&scale) {
        return Err(of.error("scale", format!("is {scale}"), "light cannot be less than 0"));
    }
    let to_world = of.transform("to_world")?;
    if !transform::is_similar(&to_world) {
        return Err(of.error("to_world", "skews or squashes the surroundings", "only turn and mirror them"));
    }
    let place = of.place_of("filename");
    let path = context.file(of.required_text("filename")?, place)?;
    let image = match context.environments.get(&path) {
        Some(known) => known.clone(),
        None => {
            let pixels = read(&path, Encoding::Srgb).map_err(|e| named_here(&e, place))?;
            let mut image = EnvironmentImage { width: pixels.width, height: pixels.height, texels: pixels.values };
            let cleaned = clean(&mut image.texels);
            if cleaned > 0 {
                let file = path.file_name().unwrap_or_default().to_string_lossy();
                context.warn(place, format_args!("{cleaned} pixels of {file} are NaN, infinite or negative, and taken as black there"));
            }
            let image = Arc::new(image);
            context.environments.insert(path, image.clone());
            image
        }
    };
    Ok(EmitterKind::Envmap { image, scale, to_world })
}

/// Sets what no light can be to 0, and says in how many texels.
fn clean(texels: &mut [Spectrum]) -> usize {
    let mut count = 0;
    for texel in texels {
        // The bound keeps sums over an image finite.
        let cleaned = texel.map(|v| if (0.0..=1e30).contains(&v) { v } else { 0.0 });
        count += usize::from(cleaned != *texel);
        *texel = cleaned;
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_no_light_can_be_becomes_black_and_is_counted() {
        let mut texels = [Spectrum([1.0, f32::NAN, -1.0]), Spectrum([f32::INFINITY, 2.0, 0.0]), Spectrum::ONE];
        assert_eq!(clean(&mut texels), 2);
        assert_eq!(texels, [Spectrum([1.0, 0.0, 0.0]), Spectrum([0.0, 2.0, 0.0]), Spectrum::ONE]);
    }
}
