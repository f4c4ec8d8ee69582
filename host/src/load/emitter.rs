//! `<emitter>`: lights, on shapes and alone.

use std::sync::Arc;

use glam::{DAffine3, DVec3};

use super::{
    catalog,
    context::Context,
    plugin,
    properties::{Properties, Value},
    suggest::list,
    texture::{self, named_here},
    transform,
    xml::Element,
};
use crate::{
    error::{Error, Place, Result},
    image::read::{Encoding, read},
    plugin::{EmitsFrom, Module},
    scene::description::{Emitter, EmitterKind, EnvironmentImage, ShapeLight, Texture},
};

/// The light of a shape.
pub(super) fn area(context: &mut Context, element: &Element, shape: &Place) -> Result<ShapeLight> {
    let of = Properties::read(element, &context.ids)?;
    let light = match plugin::find(context, "emitter", &of, &element.place)? {
        Some(module) => {
            check_seat(&of, &module, EmitsFrom::Area)?;
            let light = ShapeLight::Plugin(plugin::shader(context, &of, module)?);
            finish(of)?;
            light
        }
        None => built_in_area(context, of, element)?,
    };
    context.attach(element, shape)?;
    Ok(light)
}

fn built_in_area(context: &mut Context, of: Properties, element: &Element) -> Result<ShapeLight> {
    catalog::check("emitter", of.kind(), &element.place)?;
    if of.kind() != "area" {
        let thing = format!("a {} emitter stands inside a shape", of.kind());
        return Err(Error::at(&element.place, thing, "only area lights are on shapes; move it out of the shape"));
    }
    let radiance = match of.any("radiance") {
        Some(Value::Object(_)) => texture::parameter(context, &of, "radiance", 1.0, texture::Range::LIGHT)?,
        _ => Texture::Constant(of.radiance("radiance")?),
    };
    finish(of)?;
    Ok(ShapeLight::Area(radiance))
}

fn finish(of: Properties) -> Result<()> {
    of.pass_over(&["sampling_weight"]);
    of.finish()
}

/// A light that is not on a shape; `None` if it is one for shapes to refer to.
pub(super) fn emitter(context: &mut Context, element: &Element) -> Result<Option<Emitter>> {
    let of = Properties::read(element, &context.ids)?;
    let kind = match plugin::find(context, "emitter", &of, &element.place)? {
        Some(module) => free_plugin(context, &of, module)?,
        None => {
            if of.kind() == "area" {
                built_in_area(context, of, element)?;
                return Ok(None);
            }
            catalog::check("emitter", of.kind(), &element.place)?;
            Some(built_in(context, &of)?)
        }
    };
    finish(of)?;
    Ok(kind.map(|kind| Emitter { kind, place: element.place.clone() }))
}

fn built_in(context: &mut Context, of: &Properties) -> Result<EmitterKind> {
    Ok(match of.kind() {
        "point" => point(of)?,
        "spot" => spot(of)?,
        "directional" => directional(of)?,
        "constant" => {
            of.pass_over(&["to_world"]);
            EmitterKind::Constant { radiance: of.radiance("radiance")? }
        }
        _ => envmap(context, of)?,
    })
}

/// A module's light outside shapes: where its manifest, or `as`, says that it shines from.
fn free_plugin(context: &mut Context, of: &Properties, module: Arc<Module>) -> Result<Option<EmitterKind>> {
    let seats = &module.manifest().emits_from;
    let free: Vec<EmitsFrom> = seats.iter().copied().filter(|seat| *seat != EmitsFrom::Area).collect();
    let seat = match of.text("as")? {
        Some(name) => {
            let known: Vec<_> = free.iter().map(|seat| seat.name()).collect();
            let named = free.iter().copied().find(|seat| seat.name() == name);
            named.ok_or_else(|| of.error("as", format!("is \"{name}\""), format!("it can be {}", list(&known))))?
        }
        None => match free.as_slice() {
            [] => EmitsFrom::Area,
            [one] => *one,
            _ => return Err(of.missing("as", "string")),
        },
    };
    if seat == EmitsFrom::Area {
        // For shapes to refer to.
        plugin::shader(context, of, module)?;
        return Ok(None);
    }
    let to_world = match of.vector("position")? {
        Some(_) if of.has("to_world") => return Err(of.error("to_world", "is given together with position", "keep one of them")),
        Some(position) => DAffine3::from_translation(position),
        None => of.transform("to_world")?,
    };
    if !transform::is_similar(&to_world) {
        return Err(of.error("to_world", "skews or squashes the light", "only move, turn and mirror it"));
    }
    let shader = plugin::shader(context, of, module)?;
    Ok(Some(match seat {
        EmitsFrom::Environment => EmitterKind::PluginEnvironment { to_world, shader },
        _ => EmitterKind::PluginPoint { to_world, shader },
    }))
}

/// An error unless the module can shine from there.
fn check_seat(of: &Properties, module: &Module, seat: EmitsFrom) -> Result<()> {
    let seats = &module.manifest().emits_from;
    if seats.contains(&seat) {
        return Ok(());
    }
    let known: Vec<_> = seats.iter().map(|seat| seat.name()).collect();
    let thing = format!("{} stands inside a shape, and shines from {}", of.label(), list(&known));
    Err(Error::at(of.place(), thing, "move it out of the shape"))
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
    // In f32, as a plugin would.
    let beam_width = of.float("beam_width")?.unwrap_or_else(|| f64::from(0.75 * cutoff_angle as f32));
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
            let mut pixels = read(&path, Encoding::Srgb).map_err(|e| named_here(&e, place))?;
            let cleaned = pixels.clean();
            if cleaned > 0 {
                let file = path.file_name().unwrap_or_default().to_string_lossy();
                context.warn(place, format_args!("{cleaned} pixels of {file} are NaN, infinite or negative, and taken as black there"));
            }
            let image = Arc::new(EnvironmentImage { width: pixels.width, height: pixels.height, texels: pixels.values });
            context.environments.insert(path, image.clone());
            image
        }
    };
    Ok(EmitterKind::Envmap { image, scale, to_world })
}
