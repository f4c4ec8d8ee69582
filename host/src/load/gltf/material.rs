//! Materials: what a primitive is made of, and what it sends out.

use ::gltf::json::{
    Index, Material as Source,
    material::{AlphaCutoff, AlphaMode},
    validation::Checked,
};
use bidir_kernel::Spectrum;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

use super::{
    Reader,
    asset::{DAMAGED, label},
    extension::EmissiveStrength,
    principled::{Kind, Shaded},
};
use crate::{
    error::Result,
    image::read::Encoding,
    scene::description::{Bending, Material, MaterialId, NormalMap, Principled, ShapeLight, Texture},
};

/// How texture coordinates lie: as an image does that is seen from outside, or as its mirror image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Laid {
    Straight,
    Mirrored,
}

/// What a primitive is made of.
#[derive(Clone, Debug)]
pub(super) struct Surface {
    pub(super) material: MaterialId,
    /// Whether it matters how coordinates lie.
    pub(super) has_normals: bool,
    pub(super) light: Option<ShapeLight>,
    /// Which texture coordinates it takes; `None` without textures.
    pub(super) uv_set: Option<u32>,
}

/// A material that is being read.
pub(super) struct Open<'a> {
    pub(super) source: &'a Source,
    pub(super) name: String,
    others: Option<&'a Map<String, Value>>,
    pub(super) uv_set: Option<u32>,
}

impl Reader<'_> {
    /// The surface that a material describes, or that of primitives without one; once for each.
    pub(super) fn surface(&mut self, index: Option<Index<Source>>, laid: Laid) -> Result<Surface> {
        let key = (index.map(|index| index.value()), laid);
        if let Some(known) = self.surfaces.get(&key) {
            return Ok(known.clone());
        }
        let default = Source::default();
        let source = match index {
            Some(index) => self.asset.root.get(index).ok_or_else(|| self.asset.missing(&format!("material {}", index.value())))?,
            None => &default,
        };
        let name = key.0.map_or_else(|| "the default material".to_owned(), |key| label("material", key, source.name.as_ref()));
        let others = source.extensions.as_ref().map(|all| &all.others);
        let surface = self.read(&mut Open { source, name, others, uv_set: None }, laid)?;
        self.surfaces.insert(key, surface.clone());
        Ok(surface)
    }

    fn read(&mut self, open: &mut Open, laid: Laid) -> Result<Surface> {
        let base_color = self.base_color(open)?;
        let opacity = self.opacity(open)?;
        let normals = self.normals(open, laid)?;
        let light = self.light(open)?;
        let material = if open.others.is_some_and(|all| all.contains_key("KHR_materials_unlit")) {
            self.warn(format_args!("{} is unlit; it is taken as matt", open.name));
            let front = self.add(Material::Diffuse { reflectance: base_color });
            self.add(Material::TwoSided { sides: [front; 2] })
        } else {
            let shaded = self.principled(open, base_color)?;
            self.assembled(shaded, normals.as_ref())
        };
        let material = match opacity {
            Some(opacity) => self.add(Material::Mask { opacity, bsdf: material }),
            None => material,
        };
        Ok(Surface { material, has_normals: normals.is_some(), light, uv_set: open.uv_set })
    }

    /// Both sides of what reflects are alike, and what lets light through has its own way behind.
    fn assembled(&mut self, Shaded { of, kind }: Shaded, normals: Option<&Texture>) -> MaterialId {
        match kind {
            Kind::Opaque => self.reflecting(of, normals),
            Kind::Solid => self.bent(Material::Principled(Box::new(of)), normals),
            Kind::Thin => {
                let metallic = of.metallic.clone();
                let metal = Principled { metallic: number(1.0), spec_trans: number(0.0), diff_trans: number(0.0), ..of.clone() };
                let thin = Principled { metallic: number(0.0), clearcoat: number(0.0), clearcoat_gloss: number(0.0), ..of };
                let thin = self.bent(Material::PrincipledThin(Box::new(thin)), normals);
                if metallic.is(0.0) {
                    return thin;
                }
                // Only what is no metal lets light through.
                let metal = self.reflecting(metal, normals);
                self.add(Material::Blend { weight: metallic, parts: [thin, metal] })
            }
        }
    }

    fn reflecting(&mut self, of: Principled, normals: Option<&Texture>) -> MaterialId {
        let front = self.bent(Material::Principled(Box::new(of)), normals);
        self.add(Material::TwoSided { sides: [front; 2] })
    }

    fn bent(&mut self, material: Material, normals: Option<&Texture>) -> MaterialId {
        let bsdf = self.add(material);
        match normals {
            Some(map) => {
                let bending = Bending { flips: true, shadowed: true };
                self.add(Material::Bent { map: NormalMap::Normals(map.clone()), bending, bsdf })
            }
            None => bsdf,
        }
    }

    fn add(&mut self, material: Material) -> MaterialId {
        self.materials.push(material);
        MaterialId(self.materials.len() as u32 - 1)
    }

    fn base_color(&mut self, open: &mut Open) -> Result<Texture> {
        let pbr = &open.source.pbr_metallic_roughness;
        let [red, green, blue, alpha] = pbr.base_color_factor.0;
        for value in [red, green, blue, alpha] {
            self.fraction(open, "baseColorFactor", value)?;
        }
        let factor = [red, green, blue];
        let Some(info) = &pbr.base_color_texture else { return Ok(Texture::Constant(Spectrum(factor))) };
        self.texture(info, Encoding::Srgb, format!("times {factor:?}"), &mut open.uv_set, |c, _| times(c, factor))
    }

    /// How much of it is there; `None` if all of it is.
    fn opacity(&mut self, open: &mut Open) -> Result<Option<Texture>> {
        let cutoff = match open.source.alpha_mode {
            Checked::Valid(AlphaMode::Opaque) => return Ok(None),
            Checked::Valid(AlphaMode::Blend) => None,
            Checked::Valid(AlphaMode::Mask) => Some(open.source.alpha_cutoff.unwrap_or(AlphaCutoff(0.5)).0),
            Checked::Invalid => return Err(self.asset.error(format!("alphaMode of {} is none of glTF's", open.name), DAMAGED)),
        };
        let pbr = &open.source.pbr_metallic_roughness;
        let factor = pbr.base_color_factor.0[3];
        let opaque = |alpha: f32| match cutoff {
            Some(cutoff) => Spectrum::splat(if alpha * factor >= cutoff { 1.0 } else { 0.0 }),
            None => Spectrum::splat(alpha * factor),
        };
        let texture = match &pbr.base_color_texture {
            Some(info) => {
                let what = format!("alpha times {factor}, cut off at {cutoff:?}");
                self.texture(info, Encoding::Srgb, what, &mut open.uv_set, |_, alpha| opaque(alpha))?
            }
            None => Texture::Constant(opaque(1.0)),
        };
        Ok(if texture.is(1.0) { None } else { Some(texture) })
    }

    /// The map of its normals, as (n + 1) / 2 with what lies along the surface scaled (glTF 2.0, §3.9.3). Here y is where the normal turns x
    /// to; where an image is seen in a mirror, its y is the other way round.
    fn normals(&mut self, open: &mut Open, laid: Laid) -> Result<Option<Texture>> {
        let Some(info) = &open.source.normal_texture else { return Ok(None) };
        let across = info.scale;
        if !across.is_finite() {
            return Err(self.asset.error(format!("the scale of the normalTexture of {} is not finite", open.name), DAMAGED));
        }
        let up = if laid == Laid::Straight { across } else { -across };
        // A scale of 1 changes no bit.
        let scaled = |v: f32, scale: f32| v + (scale - 1.0) * (v - 0.5);
        let pick = |c: Spectrum, _: f32| Spectrum([scaled(c[0], across), scaled(c[1], up), c[2]]);
        let map = self.texture(info, Encoding::Linear, format!("normals times {across}, {up}"), &mut open.uv_set, pick)?;
        // What is the same everywhere is flat, but for rounding.
        Ok(Some(map).filter(|map| matches!(map, Texture::Bitmap(_))))
    }

    /// What it sends out.
    fn light(&mut self, open: &mut Open) -> Result<Option<ShapeLight>> {
        let strength: EmissiveStrength = self.extension(open, "KHR_materials_emissive_strength")?;
        let factor = open.source.emissive_factor.0.map(|v| v * strength.emissive_strength);
        if !factor.iter().all(|v| (0.0..=1e30).contains(v)) {
            let remedy = "light is finite and cannot be less than 0";
            return Err(self.asset.error(format!("{} sends out {factor:?}", open.name), remedy));
        }
        if factor == [0.0; 3] {
            return Ok(None);
        }
        let radiance = match &open.source.emissive_texture {
            Some(info) => self.texture(info, Encoding::Srgb, format!("times {factor:?}"), &mut open.uv_set, |c, _| times(c, factor))?,
            None => Texture::Constant(Spectrum(factor)),
        };
        let light = ShapeLight::Area(radiance);
        if light.is_black() {
            return Ok(None);
        }
        if open.source.double_sided {
            self.warn(format_args!("{} is double-sided, and shines from its front only", open.name));
        }
        Ok(Some(light))
    }

    /// What an extension says of a material, or what its absence means.
    pub(super) fn extension<T: DeserializeOwned + Default>(&self, open: &Open, name: &str) -> Result<T> {
        Ok(self.asset.extension(open.others, name, &open.name)?.unwrap_or_default())
    }

    /// An error unless it is one.
    pub(super) fn fraction(&self, open: &Open, what: &str, value: f32) -> Result<()> {
        if (0.0..=1.0).contains(&value) {
            return Ok(());
        }
        Err(self.asset.error(format!("{what} of {} is {value}", open.name), "it must lie within 0 … 1"))
    }
}

/// The same everywhere.
pub(super) fn number(value: f32) -> Texture {
    Texture::Constant(Spectrum::splat(value))
}

fn times(color: Spectrum, factor: [f32; 3]) -> Spectrum {
    Spectrum([color[0] * factor[0], color[1] * factor[1], color[2] * factor[2]])
}
