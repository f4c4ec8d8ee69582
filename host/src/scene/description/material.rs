//! Materials and textures.

use std::sync::Arc;

use bidir_kernel::Spectrum;

use super::Mesh;
use crate::{image::texels::Texels, plugin::Module};

/// A material's name: its index in [`super::Description::materials`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MaterialId(pub u32);

/// A colour that may vary over a surface.
#[derive(Clone, Debug)]
pub enum Texture {
    /// The same everywhere.
    Constant(Spectrum),
    /// An image.
    Bitmap(Arc<Bitmap>),
    /// Two colours in squares half a unit wide.
    Checkerboard {
        /// Where both halves agree.
        color0: Spectrum,
        /// Elsewhere.
        color1: Spectrum,
        /// Applied to uv first.
        to_uv: UvTransform,
    },
    /// What is known of a mesh's vertices or triangles.
    Attribute {
        /// The mesh that wears it.
        mesh: Arc<Mesh>,
        /// Which one of [`Mesh::attributes`].
        index: usize,
        /// Multiplies its values.
        scale: f32,
    },
}

/// An image as a texture. Linear values; v = 0 is the image's upper edge and v = 1 its lower one, as Mitsuba 3 has it.
#[derive(Clone, Debug)]
pub struct Bitmap {
    /// In texels.
    pub width: u32,
    /// In texels.
    pub height: u32,
    /// Rows from the image's top.
    pub texels: Texels,
    /// How it is read between texels.
    pub nearest: bool,
    /// How it goes on outside 0 … 1.
    pub wrap: Wrap,
    /// Applied to uv first.
    pub to_uv: UvTransform,
}

/// How a bitmap goes on outside 0 … 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wrap {
    /// Again and again.
    Repeat,
    /// Back and forth.
    Mirror,
    /// Its edge for ever.
    Clamp,
}

/// An affine map of uv: rows (a, b, c) with u' = a u + b v + c.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UvTransform(pub [[f32; 3]; 2]);

impl UvTransform {
    /// Changes nothing.
    pub const IDENTITY: Self = Self([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
}

/// Microfacet distributions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Distribution {
    /// Trowbridge & Reitz.
    Ggx,
    /// Beckmann & Spizzichino.
    Beckmann,
}

/// What a surface does to light: Mitsuba's plugins, their parameters resolved.
#[derive(Clone, Debug)]
pub enum Material {
    /// Lambertian.
    Diffuse {
        /// Albedo.
        reflectance: Texture,
    },
    /// A smooth metal; `eta` 0 and `k` 1 is Mitsuba's `none`, a perfect mirror.
    Conductor {
        /// Real part of the index of refraction.
        eta: Spectrum,
        /// Imaginary part.
        k: Spectrum,
        /// Scales the reflection.
        specular_reflectance: Texture,
    },
    /// A rough metal.
    RoughConductor {
        /// As in `Conductor`.
        eta: Spectrum,
        /// As in `Conductor`.
        k: Spectrum,
        /// Scales the reflection.
        specular_reflectance: Texture,
        /// Of microfacets.
        distribution: Distribution,
        /// Roughness along x; the first band of the texture.
        alpha_u: Texture,
        /// Roughness along y.
        alpha_v: Texture,
    },
    /// A smooth boundary between two media.
    Dielectric {
        /// Index inside / index outside (the normal points outside).
        eta: f32,
        /// Scales the reflection.
        specular_reflectance: Texture,
        /// Scales the transmission.
        specular_transmittance: Texture,
    },
    /// A thin slab: both its boundaries at once, without displacement.
    ThinDielectric {
        /// Index inside / index outside.
        eta: f32,
        /// Scales the reflection.
        specular_reflectance: Texture,
        /// Scales the transmission.
        specular_transmittance: Texture,
    },
    /// A rough boundary between two media.
    RoughDielectric {
        /// Index inside / index outside.
        eta: f32,
        /// Scales the reflection.
        specular_reflectance: Texture,
        /// Scales the transmission.
        specular_transmittance: Texture,
        /// Of microfacets.
        distribution: Distribution,
        /// Roughness along x; the first band of the texture.
        alpha_u: Texture,
        /// Roughness along y.
        alpha_v: Texture,
    },
    /// A smooth dielectric coat over a diffuse base.
    Plastic {
        /// Index inside / index outside.
        eta: f32,
        /// The base.
        diffuse_reflectance: Texture,
        /// Scales the coat's reflection.
        specular_reflectance: Texture,
        /// Whether inner reflections saturate the base's colour.
        nonlinear: bool,
    },
    /// A rough dielectric coat over a diffuse base.
    RoughPlastic {
        /// Index inside / index outside.
        eta: f32,
        /// The base.
        diffuse_reflectance: Texture,
        /// Scales the coat's reflection.
        specular_reflectance: Texture,
        /// Whether inner reflections saturate the base's colour.
        nonlinear: bool,
        /// Of microfacets.
        distribution: Distribution,
        /// Roughness.
        alpha: f32,
    },
    /// What artists steer materials with.
    Principled(Box<Principled>),
    /// The same for thin things.
    PrincipledThin(Box<Principled>),
    /// Lets light pass as if nothing were there.
    Null,
    /// A module's.
    Plugin(PluginShader),
    /// One material on each side.
    TwoSided {
        /// Where the normal points, and behind.
        sides: [MaterialId; 2],
    },
    /// One material where it is opaque, none elsewhere.
    Mask {
        /// How opaque it is; the first band.
        opacity: Texture,
        /// What is there.
        bsdf: MaterialId,
    },
    /// A part of one material and the rest of another.
    Blend {
        /// The second one's part; the first band.
        weight: Texture,
        /// Two materials.
        parts: [MaterialId; 2],
    },
    /// A material whose normal is turned.
    Bent {
        /// Whereto.
        map: NormalMap,
        /// What else happens there.
        bending: Bending,
        /// What is turned.
        bsdf: MaterialId,
    },
}

impl Material {
    /// The materials that it is made of, if it is made of others.
    pub fn parts(&self) -> &[MaterialId] {
        match self {
            Self::TwoSided { sides: parts } | Self::Blend { parts, .. } => parts,
            Self::Mask { bsdf, .. } | Self::Bent { bsdf, .. } => std::slice::from_ref(bsdf),
            _ => &[],
        }
    }

    /// Everything of it that may vary; not that of its parts.
    pub fn textures(&self) -> Vec<&Texture> {
        match self {
            Self::Diffuse { reflectance } => vec![reflectance],
            Self::Conductor { specular_reflectance, .. } => vec![specular_reflectance],
            Self::RoughConductor { specular_reflectance, alpha_u, alpha_v, .. } => vec![specular_reflectance, alpha_u, alpha_v],
            Self::Dielectric { specular_reflectance, specular_transmittance, .. }
            | Self::ThinDielectric { specular_reflectance, specular_transmittance, .. } => {
                vec![specular_reflectance, specular_transmittance]
            }
            Self::RoughDielectric { specular_reflectance, specular_transmittance, alpha_u, alpha_v, .. } => {
                vec![specular_reflectance, specular_transmittance, alpha_u, alpha_v]
            }
            Self::Plastic { diffuse_reflectance, specular_reflectance, .. }
            | Self::RoughPlastic { diffuse_reflectance, specular_reflectance, .. } => vec![diffuse_reflectance, specular_reflectance],
            Self::Principled(of) | Self::PrincipledThin(of) => of.textures().into(),
            Self::Plugin(plugin) => plugin.textures.iter().map(|parameter| &parameter.texture).collect(),
            Self::Mask { opacity: texture, .. }
            | Self::Blend { weight: texture, .. }
            | Self::Bent { map: NormalMap::Normals(texture) | NormalMap::Heights(texture, _), .. } => vec![texture],
            Self::Null | Self::TwoSided { .. } => vec![],
        }
    }
}

/// What a principled surface is steered with; of a texture that is no colour the first band counts. See [`bidir_standard::Principled`].
#[derive(Clone, Debug)]
#[allow(missing_docs, reason = "they are told where they are used")]
pub struct Principled {
    pub base_color: Texture,
    pub roughness: Texture,
    pub anisotropic: Texture,
    /// 0 in thin things.
    pub metallic: Texture,
    pub spec_trans: Texture,
    pub eta: Texture,
    pub spec_tint: Texture,
    pub sheen: Texture,
    pub sheen_tint: Texture,
    pub flatness: Texture,
    /// 0 in thin things.
    pub clearcoat: Texture,
    /// 0 in thin things.
    pub clearcoat_gloss: Texture,
    /// 0 but in thin things.
    pub diff_trans: Texture,
}

impl Principled {
    fn textures(&self) -> [&Texture; 13] {
        let Self { base_color, roughness, anisotropic, metallic, spec_trans, eta, spec_tint, sheen, sheen_tint, .. } = self;
        let Self { flatness, clearcoat, clearcoat_gloss, diff_trans, .. } = self;
        [
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
        ]
    }
}

impl Texture {
    /// Whether its first band is that everywhere.
    pub fn is(&self, value: f32) -> bool {
        matches!(self, Self::Constant(color) if color[0] == value)
    }
}

/// Where a normal is turned to.
#[derive(Clone, Debug)]
pub enum NormalMap {
    /// Normals n in the shading frame, as (n + 1)/2.
    Normals(Texture),
    /// As if the surface had hills so high, times a scale; of a colour the luminance counts.
    Heights(Texture, f32),
}

/// What is done where a turned normal and the true one disagree.
#[derive(Clone, Copy, Debug)]
pub struct Bending {
    /// Whether a mirror image takes its place where its back would be seen.
    pub flips: bool,
    /// Whether the shadow at its edge is softened.
    pub shadowed: bool,
}

/// A plugin with its parameters.
#[derive(Clone, Debug)]
pub struct PluginShader {
    /// The plugin.
    pub module: Arc<Module>,
    /// Its parameters, as it reads them; what a texture decides is not filled in.
    pub block: Vec<u8>,
    /// The parameters that vary.
    pub textures: Vec<TexturedParameter>,
}

impl PluginShader {
    /// What scenes call it: its file's name without the ending.
    pub fn name(&self) -> String {
        self.module.file().file_stem().unwrap_or_default().to_string_lossy().into_owned()
    }
}

/// A plugin's parameter that a texture decides.
#[derive(Clone, Debug)]
pub struct TexturedParameter {
    /// In the parameter block, bytes.
    pub offset: u32,
    /// 1, a float: the texture's first band; or 3.
    pub channels: usize,
    /// Its value.
    pub texture: Texture,
}
