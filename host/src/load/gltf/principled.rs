//! Metallic-roughness and the extensions that add to it, as parameters of principled surfaces.
//!
//! glTF's α is the square of its roughness (glTF 2.0, appendix B), and so is theirs.

use ::gltf::json::texture::Info;
use bidir_kernel::Spectrum;

use super::{
    Reader,
    extension::{Clearcoat, DiffuseTransmission, Ior, Sheen, Specular, Transmission, Volume},
    material::{Open, number},
};
use crate::{
    error::Result,
    image::read::Encoding,
    scene::description::{Principled, Texture},
};

/// What a surface is steered with, and how light gets through it.
pub(super) struct Shaded {
    pub(super) of: Principled,
    pub(super) kind: Kind,
}

/// How light gets through.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Opaque,
    /// Without being bent: through both boundaries at once.
    Thin,
    /// Through the boundary of something thick.
    Solid,
}

/// A band of a texture, times a factor.
struct Band<'a> {
    what: &'a str,
    factor: f32,
    texture: Option<&'a Info>,
    band: Which,
}

#[derive(Clone, Copy, Debug)]
enum Which {
    Red,
    Green,
    Blue,
    Alpha,
}

impl Reader<'_> {
    /// Everything of a material but its normals and its opacity.
    pub(super) fn principled(&mut self, open: &mut Open, base_color: Texture) -> Result<Shaded> {
        let pbr = &open.source.pbr_metallic_roughness;
        let texture = pbr.metallic_roughness_texture.as_ref();
        let same = |value: f32| value;
        let band = Band { what: "roughnessFactor", factor: pbr.roughness_factor.0, texture, band: Which::Green };
        let roughness = self.band(open, &band, same)?;
        let band = Band { what: "metallicFactor", factor: pbr.metallic_factor.0, texture, band: Which::Blue };
        let metallic = self.band(open, &band, same)?;

        let through: Transmission = self.extension(open, "KHR_materials_transmission")?;
        let (factor, texture) = (through.transmission_factor, through.transmission_texture.as_ref());
        let spec_trans = self.band(open, &Band { what: "transmissionFactor", factor, texture, band: Which::Red }, same)?;
        let leaf: DiffuseTransmission = self.extension(open, "KHR_materials_diffuse_transmission")?;
        let (factor, texture) = (leaf.diffuse_transmission_factor, leaf.diffuse_transmission_texture.as_ref());
        // 2 stands for all of it.
        let diff_trans = self.band(open, &Band { what: "diffuseTransmissionFactor", factor, texture, band: Which::Alpha }, |v| 2.0 * v)?;
        let volume: Volume = self.extension(open, "KHR_materials_volume")?;
        let kind = match (spec_trans.is(0.0), diff_trans.is(0.0)) {
            (true, true) => Kind::Opaque,
            (false, _) if volume.thickness_factor > 0.0 => Kind::Solid,
            _ => Kind::Thin,
        };
        if kind != Kind::Opaque && volume.attenuation_color != [1.0; 3] {
            self.leave_out("what a volume absorbs (KHR_materials_volume)");
        }
        let [clearcoat, clearcoat_gloss] = self.clearcoat(open, kind)?;
        let sheen = self.sheen(open)?;
        let eta = number(self.eta(open, kind)?);
        let diff_trans = if kind == Kind::Thin { diff_trans } else { number(0.0) };
        let [anisotropic, spec_tint, sheen_tint, flatness] = [0.0; 4].map(number);
        let of = Principled {
            base_color,
            roughness,
            anisotropic,
            metallic,
            spec_trans,
            eta,
            spec_tint,
            sheen,
            sheen_tint,
            flatness,
            clearcoat,
            clearcoat_gloss,
            diff_trans,
        };
        Ok(Shaded { of, kind })
    }

    fn band(&mut self, open: &mut Open, of: &Band, then: impl Fn(f32) -> f32) -> Result<Texture> {
        let Band { what, factor, texture, band } = *of;
        self.fraction(open, what, factor)?;
        let pick = |c: Spectrum, alpha: f32| {
            let value = match band {
                Which::Red => c[0],
                Which::Green => c[1],
                Which::Blue => c[2],
                Which::Alpha => alpha,
            };
            Spectrum::splat(then(value * factor))
        };
        match texture {
            Some(info) if factor > 0.0 => self.texture(info, Encoding::Linear, format!("{what} {factor}"), &mut open.uv_set, pick),
            _ => Ok(number(then(factor))),
        }
    }

    /// A coat and how shiny it is.
    fn clearcoat(&mut self, open: &mut Open, kind: Kind) -> Result<[Texture; 2]> {
        let coat: Clearcoat = self.extension(open, "KHR_materials_clearcoat")?;
        let (factor, texture) = (coat.clearcoat_factor, coat.clearcoat_texture.as_ref());
        let clearcoat = self.band(open, &Band { what: "clearcoatFactor", factor, texture, band: Which::Red }, |v| v)?;
        if clearcoat.is(0.0) {
            return Ok([number(0.0), number(0.0)]);
        }
        if coat.clearcoat_normal_texture.is_some() {
            self.leave_out("normals of KHR_materials_clearcoat");
        }
        if kind == Kind::Thin {
            self.leave_out("KHR_materials_clearcoat of what is thin-walled");
        }
        let (factor, texture) = (coat.clearcoat_roughness_factor, coat.clearcoat_roughness_texture.as_ref());
        // The coat's α goes from 0.1 to 0.001.
        let gloss = |roughness: f32| ((0.1 - roughness * roughness) / 0.099).clamp(0.0, 1.0);
        let band = Band { what: "clearcoatRoughnessFactor", factor, texture, band: Which::Green };
        Ok([clearcoat, self.band(open, &band, gloss)?])
    }

    /// A white sheen as strong as glTF's brightest band.
    fn sheen(&mut self, open: &mut Open) -> Result<Texture> {
        let sheen: Sheen = self.extension(open, "KHR_materials_sheen")?;
        let factor = sheen.sheen_color_factor;
        for value in factor {
            self.fraction(open, "sheenColorFactor", value)?;
        }
        let brightest = |c: Spectrum| Spectrum::splat((0..3).map(|band| c[band] * factor[band]).fold(0.0, f32::max));
        match &sheen.sheen_color_texture {
            Some(info) if factor != [0.0; 3] => {
                self.texture(info, Encoding::Srgb, format!("brightest of {factor:?}"), &mut open.uv_set, |c, _| brightest(c))
            }
            _ => Ok(Texture::Constant(brightest(Spectrum::ONE))),
        }
    }

    /// The index of refraction, less where KHR_materials_specular weakens the reflection along the normal.
    fn eta(&mut self, open: &Open, kind: Kind) -> Result<f32> {
        let Ior { ior } = self.extension(open, "KHR_materials_ior")?;
        let specular: Option<Specular> = self.extension(open, "KHR_materials_specular")?;
        if ior == 0.0 {
            self.warn(format_args!("the index of refraction of {} is 0, which stands for none; 1.5 is taken", open.name));
            return Ok(1.5);
        }
        if !(1.0..=1e3).contains(&ior) {
            return Err(self.asset.error(format!("the index of refraction of {} is {ior}", open.name), "it must lie within 1 … 1000"));
        }
        // What lets light through must bend it a little, as in Mitsuba.
        if kind != Kind::Opaque {
            return Ok(ior.max(1.001));
        }
        let Some(specular) = specular else { return Ok(ior) };
        if specular.specular_texture.is_some() || specular.specular_color_texture.is_some() {
            self.leave_out("textures of KHR_materials_specular");
        }
        self.fraction(open, "specularFactor", specular.specular_factor)?;
        let color = specular.specular_color_factor;
        if !color.iter().all(|v| (0.0..=1e3).contains(v)) {
            return Err(self.asset.error(format!("specularColorFactor of {} is {color:?}", open.name), "it must lie within 0 … 1000"));
        }
        let mean = color.map(f64::from).iter().sum::<f64>() / 3.0;
        let plain = (f64::from(ior) - 1.0) / (f64::from(ior) + 1.0);
        // The root of what is reflected along the normal.
        let root = (plain * plain * mean).min(1.0).sqrt() * f64::from(specular.specular_factor).sqrt();
        Ok(((1.0 + root) / (1.0 - root)).clamp(1.0, 1e3) as f32)
    }
}
