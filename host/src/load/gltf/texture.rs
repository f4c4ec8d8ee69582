//! Textures: images, what is taken of them, and how they lie on a surface.

use std::{path::Path, rc::Rc, sync::Arc};

use ::gltf::json::{
    Image, Index, Texture as Source,
    material::NormalTexture,
    texture::{Info, MagFilter, WrappingMode},
    validation::Checked,
};
use bidir_kernel::Spectrum;
use serde::Deserialize;
use serde_json::{Map, Value};

use super::{
    Reader,
    asset::{Asset, DAMAGED, label},
};
use crate::{
    error::Result,
    image::{
        read::{Encoding, Limits, decode_with_alpha},
        texels::{Packed, Texels},
    },
    scene::description::{Bitmap, Texture, UvTransform, Wrap},
};

/// The most memory that all textures together may take, in bytes.
const MAX_BYTES: usize = 6 << 30;

/// An image, decoded.
pub(super) struct Decoded {
    packed: Packed,
    /// Per pixel, or nothing where all are opaque.
    alpha: Vec<f32>,
}

/// A texture as a material names it.
pub(super) struct Named<'a> {
    index: Index<Source>,
    set: u32,
    extensions: Option<&'a Map<String, Value>>,
}

impl<'a> From<&'a Info> for Named<'a> {
    fn from(info: &'a Info) -> Self {
        Self { index: info.index, set: info.tex_coord, extensions: info.extensions.as_ref().map(|all| &all.others) }
    }
}

impl<'a> From<&'a NormalTexture> for Named<'a> {
    fn from(info: &'a NormalTexture) -> Self {
        Self { index: info.index, set: info.tex_coord, extensions: info.extensions.as_ref().map(|all| &all.others) }
    }
}

/// `KHR_texture_transform`
#[derive(Deserialize)]
#[serde(default, rename_all = "camelCase")]
struct Transform {
    offset: [f32; 2],
    rotation: f32,
    scale: [f32; 2],
    tex_coord: Option<u32>,
}

impl Default for Transform {
    fn default() -> Self {
        Self { offset: [0.0; 2], rotation: 0.0, scale: [1.0; 2], tex_coord: None }
    }
}

impl Transform {
    /// Scaled, turned, moved. The specification turns clockwise where v points down, as its example shows.
    fn to_uv(&self) -> UvTransform {
        let ([x, y], [width, height]) = (self.offset.map(f64::from), self.scale.map(f64::from));
        let (sin, cos) = (libm::sin(self.rotation.into()), libm::cos(self.rotation.into()));
        UvTransform([[cos * width, sin * height, x], [-sin * width, cos * height, y]].map(|row| row.map(|v| v as f32)))
    }
}

impl Reader<'_> {
    /// A texture whose values are what `pick` makes of the image's, and of how opaque it is. `what` says which `pick` it is: textures that are
    /// the same are kept once. One that is the same everywhere is no bitmap.
    pub(super) fn texture<'t>(
        &mut self,
        named: impl Into<Named<'t>>,
        encoding: Encoding,
        what: String,
        uv_set: &mut Option<u32>,
        pick: impl Fn(Spectrum, f32) -> Spectrum,
    ) -> Result<Texture> {
        let (named, asset) = (named.into(), self.asset);
        let index = named.index.value();
        let Some(source) = asset.root.get(named.index) else { return Err(asset.missing(&format!("texture {index}"))) };
        let name = label("texture", index, source.name.as_ref());
        let transform: Transform = asset.extension(named.extensions, "KHR_texture_transform", &name)?.unwrap_or_default();
        let to_uv = transform.to_uv();
        if !to_uv.0.iter().flatten().all(|v| v.abs() < 1e18) {
            return Err(asset.error(format!("KHR_texture_transform of {name} is not finite or beyond 1e18"), DAMAGED));
        }
        let set = transform.tex_coord.unwrap_or(named.set);
        if *uv_set.get_or_insert(set) != set {
            self.leave_out("second sets of texture coordinates in one material");
        }
        let (nearest, wrap) = self.sampler(source, &name)?;
        let key = format!("{} {encoding:?} {nearest} {wrap:?} {to_uv:?} {what}", source.source.value());
        if let Some(known) = self.textures.get(&key) {
            return Ok(known.clone());
        }
        let image = self.image(source.source, encoding, &name)?;
        let Decoded { packed: Packed { width, height, texels }, alpha } = &*image;
        let picked = picked(texels, alpha, pick);
        let texture = match picked.get(0) {
            Some(first) if picked.iter().all(|texel| texel == first) => Texture::Constant(first),
            _ => {
                self.bytes += picked.size();
                if self.bytes > MAX_BYTES {
                    let thing = format!("its textures take more than {} GiB", MAX_BYTES >> 30);
                    return Err(asset.error(thing, "make them smaller"));
                }
                Texture::Bitmap(Arc::new(Bitmap { width: *width, height: *height, texels: picked, nearest, wrap, to_uv }))
            }
        };
        self.textures.insert(key, texture.clone());
        Ok(texture)
    }

    /// Whether texels stay squares, and how the image goes on.
    fn sampler(&mut self, source: &Source, name: &str) -> Result<(bool, Wrap)> {
        let Some(index) = source.sampler else { return Ok((false, Wrap::Repeat)) };
        let Some(sampler) = self.asset.root.get(index) else {
            return Err(self.asset.missing(&format!("sampler {}", index.value())));
        };
        let wrap = |mode| match mode {
            Checked::Valid(WrappingMode::Repeat) => Some(Wrap::Repeat),
            Checked::Valid(WrappingMode::MirroredRepeat) => Some(Wrap::Mirror),
            Checked::Valid(WrappingMode::ClampToEdge) => Some(Wrap::Clamp),
            Checked::Invalid => None,
        };
        let (Some(along_s), Some(along_t)) = (wrap(sampler.wrap_s), wrap(sampler.wrap_t)) else {
            return Err(self.asset.error(format!("the sampler of {name} wraps in a way that is none of glTF's"), DAMAGED));
        };
        if along_s != along_t {
            self.warn(format_args!("{name} goes on as {along_s:?} along u and as {along_t:?} along v; the former is taken for both"));
        }
        Ok((sampler.mag_filter == Some(Checked::Valid(MagFilter::Nearest)), along_s))
    }

    /// An image, decoded; the last one is kept at hand, as materials ask for several bands of one.
    fn image(&mut self, index: Index<Image>, encoding: Encoding, texture: &str) -> Result<Rc<Decoded>> {
        let key = (index.value(), encoding);
        if let Some((known, decoded)) = &self.decoded
            && *known == key
        {
            return Ok(decoded.clone());
        }
        let (packed, alpha) = self.asset.decode(index, encoding, texture)?;
        let decoded = Rc::new(Decoded { packed, alpha });
        self.decoded = Some((key, decoded.clone()));
        Ok(decoded)
    }
}

/// What `pick` makes of an image: as dense as the image where that is the image itself, one band where all three are alike.
fn picked(texels: &Texels, alpha: &[f32], pick: impl Fn(Spectrum, f32) -> Spectrum) -> Texels {
    let opaque = |at: usize| alpha.get(at).copied().unwrap_or(1.0);
    let each = || texels.iter().enumerate().map(|(at, value)| (value, pick(value, opaque(at))));
    if each().all(|(value, picked)| value == picked) {
        texels.clone()
    } else if each().all(|(_, picked)| picked[0] == picked[1] && picked[0] == picked[2]) {
        Texels::floats(each().map(|(_, picked)| picked[0]).collect(), 1)
    } else {
        each().map(|(_, picked)| picked).collect()
    }
}

impl Asset {
    fn decode(&self, index: Index<Image>, encoding: Encoding, texture: &str) -> Result<(Packed, Vec<f32>)> {
        // What the schema's crate takes a missing one for.
        if index.value() == u32::MAX as usize {
            return Err(self.error(format!("{texture} has no image that is a PNG or JPEG"), "export its images as PNG or JPEG"));
        }
        let Some(image) = self.root.get(index) else { return Err(self.missing(&format!("image {}", index.value()))) };
        let name = label("image", index.value(), image.name.as_ref());
        let fetched;
        let bytes = match (&image.uri, image.buffer_view) {
            (Some(uri), _) => {
                fetched = self.fetch(uri, &name)?;
                &fetched
            }
            (None, Some(view)) => self.view(view)?,
            (None, None) => return Err(self.error(format!("{name} has neither a URI nor a buffer view"), DAMAGED)),
        };
        let remedy = "use a PNG or JPEG image";
        let decoded = decode_with_alpha(bytes, Path::new(""), encoding, &Limits::default());
        let decoded = decoded.map_err(|e| self.error(format!("{name} {}", e.thing), remedy))?;
        if decoded.0.texels.iter().flat_map(|texel| texel.0).any(|v| !(0.0..=1.0).contains(&v)) {
            return Err(self.error(format!("{name} has values outside 0 … 1"), remedy));
        }
        Ok(decoded)
    }
}
