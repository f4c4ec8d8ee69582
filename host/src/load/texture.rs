//! `<texture>`, and parameters that take one.

use std::sync::Arc;

use bidir_kernel::Spectrum;
use glam::DAffine3;

use super::{
    attribute, catalog,
    context::Context,
    properties::{Properties, Value},
    xml::Element,
};
use crate::{
    error::{Error, Place, Result},
    image::read::{Encoding, packed},
    scene::description::{Bitmap, Texture, UvTransform, Wrap},
};

/// What a texture's values may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Range {
    /// Of every band.
    pub(super) min: f32,
    /// Of every band.
    pub(super) max: f32,
}

impl Range {
    /// What scales light must not add any.
    pub(super) const FRACTION: Self = Self { min: 0.0, max: 1.0 };
    /// As much light as a number may say.
    pub(super) const LIGHT: Self = Self { min: 0.0, max: 1e30 };
    /// 0 or more.
    pub(super) const NOT_NEGATIVE: Self = Self { min: 0.0, max: f32::MAX };
    /// Whatever is a number.
    pub(super) const ANY: Self = Self { min: f32::MIN, max: f32::MAX };

    pub(super) fn holds(self, color: &Spectrum) -> bool {
        color.0.iter().all(|v| (self.min..=self.max).contains(v))
    }

    pub(super) fn remedy(self) -> String {
        match self {
            Self { min, max } if max < f32::MAX => format!("every band must lie within {min} … {max}"),
            Self { min: 0.0, .. } => "every band must be finite and not negative".to_owned(),
            Self { min, .. } if min > f32::MIN => format!("every band must be finite, and {min} or more"),
            _ => "every band must be finite".to_owned(),
        }
    }
}

/// A parameter that may be a texture, `default` if it is not written.
pub(super) fn parameter(context: &mut Context, of: &Properties, name: &str, default: f32, range: Range) -> Result<Texture> {
    if let Some(Value::Object(object)) = of.any(name) {
        if object.tag != "texture" {
            return Err(of.error(name, format!("is a <{}>", object.tag), "write a <texture>, <rgb> or <float>"));
        }
        return texture(context, object, range, of.place_of(name));
    }
    let color = of.color(name)?.unwrap_or(Spectrum::splat(default));
    if !range.holds(&color) {
        return Err(of.error(name, format!("is {:?}", color.0), range.remedy()));
    }
    Ok(Texture::Constant(color))
}

/// A texture, wherever it is used.
pub(super) fn texture(context: &mut Context, element: &Element, range: Range, user: &Place) -> Result<Texture> {
    let properties = Properties::read(element, &context.ids)?;
    catalog::check("texture", properties.kind(), &element.place)?;
    let texture = match properties.kind() {
        "checkerboard" => {
            let color = |name, default| -> Result<Spectrum> {
                let color = properties.color(name)?.unwrap_or(Spectrum::splat(default));
                if range.holds(&color) { Ok(color) } else { Err(properties.error(name, format!("is {:?}", color.0), range.remedy())) }
            };
            Texture::Checkerboard { color0: color("color0", 0.4)?, color1: color("color1", 0.2)?, to_uv: to_uv(&properties)? }
        }
        "mesh_attribute" => attribute::texture(context, &properties, range, user)?,
        _ => {
            let bitmap = bitmap(context, &properties)?;
            if let Some(at) = bitmap.texels.iter().position(|texel| !range.holds(&texel)) {
                let (x, y) = (at % bitmap.width as usize, at / bitmap.width as usize);
                let count = bitmap.texels.iter().filter(|texel| !range.holds(texel)).count();
                let file = properties.required_text("filename")?;
                let first = bitmap.texels.get(at).unwrap_or_default().0;
                let thing = format!("{count} pixels of {file} are out of range, first {first:?} at {x}, {y} from its upper left");
                return Err(Error::at(user, thing, range.remedy()));
            }
            Texture::Bitmap(bitmap)
        }
    };
    properties.finish()?;
    Ok(texture)
}

fn bitmap(context: &mut Context, properties: &Properties) -> Result<Arc<Bitmap>> {
    properties.refuse("bitmap", "name a file with \"filename\"")?;
    properties.refuse("data", "name a file with \"filename\"")?;
    properties.pass_over(&["id"]);
    let filename = properties.required_text("filename")?;
    let path = context.file(filename, properties.place_of("filename"))?;
    let encoding = if properties.boolean("raw")?.unwrap_or(false) { Encoding::Linear } else { Encoding::Srgb };
    let nearest = properties.choice("filter_type", &[("bilinear", false), ("nearest", true)])?;
    let wrap = properties.choice("wrap_mode", &[("repeat", Wrap::Repeat), ("mirror", Wrap::Mirror), ("clamp", Wrap::Clamp)])?;
    let to_uv = to_uv(properties)?;
    properties.choice("format", &[("variant", ()), ("fp16", ()), ("auto", ())])?;
    properties.pass_over(&["accel"]);
    let key = format!("{} {encoding:?} {nearest} {wrap:?} {to_uv:?}", path.display());
    if let Some(known) = context.bitmaps.get(&key) {
        return Ok(known.clone());
    }
    let ready = context.ahead.image(path.clone(), encoding);
    let pixels = ready.map_or_else(|| packed(&path, encoding), Ok).map_err(|e| named_here(&e, properties.place_of("filename")))?;
    let bitmap = Arc::new(Bitmap { width: pixels.width, height: pixels.height, texels: pixels.texels, nearest, wrap, to_uv });
    context.bitmaps.insert(key, bitmap.clone());
    Ok(bitmap)
}

/// An error in a file, told where the scene names it.
pub(super) fn named_here(error: &Error, place: &Place) -> Error {
    let file = error.place.as_ref().map(|p| format!("{p}: ")).unwrap_or_default();
    Error { blame: error.blame, ..Error::at(place, format!("{file}{}", error.thing), error.remedy.clone()) }
}

fn to_uv(properties: &Properties) -> Result<UvTransform> {
    let whole: DAffine3 = properties.transform("to_uv")?;
    let (x, y, t) = (whole.matrix3.x_axis, whole.matrix3.y_axis, whole.translation);
    Ok(UvTransform([[x.x as f32, y.x as f32, t.x as f32], [x.y as f32, y.y as f32, t.y as f32]]))
}
