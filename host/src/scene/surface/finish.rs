//! A material with what can be worked out before any hit.

use bidir_kernel::{Bsdf, Effects, Lobe, Spectrum, Vec2};
use bidir_standard as standard;

use super::{Detail, Shader, Surface, share};
use crate::{
    plugin::{Roster, Sandbox, ShaderId},
    scene::{
        description::{Bending, Distribution, Material, MaterialId, NormalMap, Texture},
        plain::Matt,
        texture::Coordinates,
    },
};

/// A material with what can be worked out before any hit: a shader, or one on each side.
#[derive(Clone, Debug)]
pub struct Finish {
    /// Where the normal points.
    pub(super) front: Recipe,
    pub(super) behind: Behind,
}

/// What a surface is behind its normal.
#[derive(Clone, Debug)]
pub(super) enum Behind {
    /// Whatever the one shader says of directions from behind.
    Itself,
    /// The same shader, as if its normal pointed there (`twosided` with one child).
    Mirrored,
    /// Another shader, as if its normal pointed there.
    Other(Box<Recipe>),
}

/// A shader, as far as it is known before any hit.
#[derive(Clone, Debug)]
pub(super) enum Ready {
    /// A built-in one whose parameters are the same everywhere.
    Fixed(Shader),
    /// A built-in one whose parameters a texture decides.
    Varying,
    /// A module's, with its lobes.
    Plugin(ShaderId, Lobe),
    /// One that is made of others.
    Made(Box<Nested>),
}

/// A material that is made of others.
#[derive(Clone, Debug)]
pub(super) enum Nested {
    Mask { opacity: Texture, bsdf: Finish },
    Blend { weight: Texture, parts: Box<[Finish; 2]> },
    Bent { map: NormalMap, bending: Bending, bsdf: Finish },
}

impl Nested {
    /// `None` if the material is not made of others; if that cannot be built either, `Some(None)`.
    fn new(materials: &[Material], material: &Material, depth: usize, roster: &mut Roster) -> Option<Option<Self>> {
        let mut part = |id: MaterialId| Finish::within(materials, id, depth, roster);
        Some(match material {
            Material::Mask { opacity, bsdf } => part(*bsdf).map(|bsdf| Self::Mask { opacity: opacity.clone(), bsdf }),
            Material::Blend { weight, parts: [first, second] } => {
                let parts = part(*first).and_then(|first| Some([first, part(*second)?]));
                parts.map(|parts| Self::Blend { weight: weight.clone(), parts: Box::new(parts) })
            }
            Material::Bent { map, bending, bsdf } => part(*bsdf).map(|bsdf| Self::Bent { map: map.clone(), bending: *bending, bsdf }),
            _ => return None,
        })
    }

    fn parts(&self) -> &[Finish] {
        match self {
            Self::Mask { bsdf, .. } | Self::Bent { bsdf, .. } => std::slice::from_ref(bsdf),
            Self::Blend { parts, .. } => &**parts,
        }
    }

    fn lobes(&self, at: Coordinates) -> Lobe {
        let of_parts = self.parts().iter().map(|part| part.lobes_at(at)).fold(Lobe::NONE, |all, lobes| all | lobes);
        match self {
            Self::Mask { opacity, .. } if opacity.at(at)[0] < 1.0 => of_parts | Lobe::DELTA_TRANSMISSION,
            _ => of_parts,
        }
    }
}

#[derive(Clone, Debug)]
pub(super) struct Recipe {
    pub(super) material: Material,
    /// What of a coat does not depend on colours.
    coated: Option<Box<standard::RoughPlastic>>,
    pub(super) shader: Ready,
}

impl Finish {
    /// The finish of material `id`, its plugins added to `roster`; `None` if an id names nothing, materials nest too deep, or a `TwoSided`
    /// holds another.
    pub fn new(materials: &[Material], id: MaterialId, roster: &mut Roster) -> Option<Self> {
        Self::within(materials, id, 0, roster)
    }

    fn within(materials: &[Material], id: MaterialId, depth: usize, roster: &mut Roster) -> Option<Self> {
        let material = |id: MaterialId| materials.get(id.0 as usize);
        let mut recipe = |id| Recipe::new(materials, material(id)?, depth + 1, roster);
        Some(match material(id)? {
            Material::TwoSided { sides: [front, back] } if front == back => Self { front: recipe(*front)?, behind: Behind::Mirrored },
            Material::TwoSided { sides: [front, back] } => Self { front: recipe(*front)?, behind: Behind::Other(Box::new(recipe(*back)?)) },
            _ => Self { front: recipe(id)?, behind: Behind::Itself },
        })
    }

    /// The surface at `uv`, whose plugins, if there are any, are asked in `sandbox`.
    #[inline(always)]
    pub fn at<'a>(&'a self, uv: Vec2, detail: Detail, sandbox: &'a Sandbox) -> Surface<'a> {
        Surface { finish: self, sandbox, uv, detail }
    }

    /// Whether anything varies over the surface, or about its normal: then hits need uv, and frames that follow u.
    pub fn mapped(&self) -> bool {
        self.recipes().any(|recipe| recipe.varies() || recipe.anisotropic() || recipe.parts().iter().any(Self::mapped))
    }

    /// Whether it has bumps or attributes of a mesh: then hits need a [`Detail`].
    pub fn detailed(&self) -> bool {
        let of_itself = |recipe: &Recipe| {
            matches!(recipe.material, Material::Bent { map: NormalMap::Heights(..), .. })
                || recipe.material.textures().iter().any(|texture| matches!(texture, Texture::Attribute { .. }))
        };
        self.recipes().any(|recipe| of_itself(recipe) || recipe.parts().iter().any(Self::detailed))
    }

    fn recipes(&self) -> impl Iterator<Item = &Recipe> {
        let behind = match &self.behind {
            Behind::Other(recipe) => Some(&**recipe),
            _ => None,
        };
        std::iter::once(&self.front).chain(behind)
    }

    /// The finish as a diffuse surface of one colour, if it is one.
    pub fn matt(&self) -> Option<Matt> {
        let both_sides = match self.behind {
            Behind::Itself => false,
            Behind::Mirrored => true,
            Behind::Other(_) => return None,
        };
        match &self.front.shader {
            Ready::Fixed(Shader::Diffuse(shader)) => Some(Matt::new(*shader, both_sides)),
            _ => None,
        }
    }

    /// What the surface may need of the kernel. Those that are not matt are not told apart.
    pub fn effects(&self) -> Effects {
        let other = self.matt().is_none();
        Effects { deltas: other, lobe_choice: other, dear_surfaces: other, refraction: other, ..Effects::NONE }
    }

    /// Every lobe the surface has at uv (0, 0), for what `explain` says of it.
    pub fn lobes(&self) -> Lobe {
        self.lobes_at(Coordinates::default())
    }

    #[inline]
    pub(super) fn lobes_at(&self, at: Coordinates) -> Lobe {
        match &self.behind {
            Behind::Other(recipe) => self.front.lobes(at) | recipe.lobes(at),
            _ => self.front.lobes(at),
        }
    }
}

/// How deep materials may nest.
const MAX_DEPTH: usize = 32;

impl Recipe {
    fn new(materials: &[Material], material: &Material, depth: usize, roster: &mut Roster) -> Option<Self> {
        if matches!(material, Material::TwoSided { .. }) || depth > MAX_DEPTH {
            return None;
        }
        let mut recipe = Self { material: material.clone(), coated: coated(material).map(Box::new), shader: Ready::Varying };
        if let Some(nested) = Nested::new(materials, material, depth, roster) {
            recipe.shader = Ready::Made(Box::new(nested?));
        } else if let Material::Plugin(shader) = material {
            recipe.shader = Ready::Plugin(roster.add(&shader.module, &shader.block), shader.module.manifest().lobes());
        } else if !recipe.varies() {
            recipe.shader = Ready::Fixed(recipe.looked_up(Coordinates::default()));
        }
        Some(recipe)
    }

    /// What it is made of, if it is made of others.
    fn parts(&self) -> &[Finish] {
        match &self.shader {
            Ready::Made(nested) => nested.parts(),
            _ => &[],
        }
    }

    fn varies(&self) -> bool {
        self.material.textures().iter().any(|texture| !matches!(texture, Texture::Constant(_)))
    }

    /// Whether it may matter which way the tangent points. Asked of the kind of material, as a module's manifest is.
    fn anisotropic(&self) -> bool {
        match &self.material {
            Material::RoughConductor { .. } | Material::RoughDielectric { .. } => true,
            Material::Principled(of) | Material::PrincipledThin(of) => !of.anisotropic.is(0.0),
            Material::Plugin(shader) => !shader.module.manifest().isotropic,
            _ => false,
        }
    }

    #[inline]
    fn lobes(&self, at: Coordinates) -> Lobe {
        match &self.shader {
            Ready::Fixed(shader) => shader.lobes(),
            Ready::Plugin(_, lobes) => *lobes,
            Ready::Made(nested) => nested.lobes(at),
            Ready::Varying => self.looked_up(at).lobes(),
        }
    }

    /// A built-in shader at `uv`.
    pub(super) fn looked_up(&self, at: Coordinates) -> Shader {
        match &self.material {
            Material::Diffuse { reflectance } => Shader::Diffuse(standard::Diffuse { reflectance: reflectance.at(at) }),
            Material::Conductor { eta, k, specular_reflectance } => {
                Shader::Conductor(standard::Conductor { eta: *eta, k: *k, specular_reflectance: specular_reflectance.at(at) })
            }
            Material::RoughConductor { eta, k, specular_reflectance, distribution, alpha_u, alpha_v } => {
                Shader::RoughConductor(standard::RoughConductor {
                    eta: *eta,
                    k: *k,
                    specular_reflectance: specular_reflectance.at(at),
                    microfacet: microfacet(*distribution, alpha_u, alpha_v, at),
                })
            }
            Material::Dielectric { eta, specular_reflectance, specular_transmittance } => Shader::Dielectric(standard::Dielectric {
                eta: *eta,
                specular_reflectance: specular_reflectance.at(at),
                specular_transmittance: specular_transmittance.at(at),
            }),
            Material::ThinDielectric { eta, specular_reflectance, specular_transmittance } => {
                Shader::ThinDielectric(standard::ThinDielectric {
                    eta: *eta,
                    specular_reflectance: specular_reflectance.at(at),
                    specular_transmittance: specular_transmittance.at(at),
                })
            }
            Material::RoughDielectric { eta, specular_reflectance, specular_transmittance, distribution, alpha_u, alpha_v } => {
                Shader::RoughDielectric(standard::RoughDielectric {
                    eta: *eta,
                    specular_reflectance: specular_reflectance.at(at),
                    specular_transmittance: specular_transmittance.at(at),
                    microfacet: microfacet(*distribution, alpha_u, alpha_v, at),
                })
            }
            Material::Plastic { diffuse_reflectance, specular_reflectance, .. }
            | Material::RoughPlastic { diffuse_reflectance, specular_reflectance, .. } => {
                let Some(coated) = &self.coated else { return Shader::Null(standard::Null) };
                let (diffuse_reflectance, specular_reflectance) = (diffuse_reflectance.at(at), specular_reflectance.at(at));
                let plastic = standard::Plastic { diffuse_reflectance, specular_reflectance, ..coated.plastic };
                match self.material {
                    Material::Plastic { .. } => Shader::Plastic(plastic),
                    _ => Shader::RoughPlastic(standard::RoughPlastic { plastic, ..**coated }),
                }
            }
            Material::Principled(of) => Shader::Principled(standard::Principled {
                base_color: of.base_color.at(at),
                roughness: share(&of.roughness, at),
                anisotropic: share(&of.anisotropic, at),
                metallic: share(&of.metallic, at),
                spec_trans: share(&of.spec_trans, at),
                eta: of.eta.at(at)[0],
                spec_tint: share(&of.spec_tint, at),
                sheen: share(&of.sheen, at),
                sheen_tint: share(&of.sheen_tint, at),
                flatness: share(&of.flatness, at),
                clearcoat: share(&of.clearcoat, at),
                clearcoat_gloss: share(&of.clearcoat_gloss, at),
            }),
            Material::PrincipledThin(of) => Shader::PrincipledThin(standard::PrincipledThin {
                base_color: of.base_color.at(at),
                roughness: share(&of.roughness, at),
                anisotropic: share(&of.anisotropic, at),
                spec_trans: share(&of.spec_trans, at),
                eta: of.eta.at(at)[0],
                spec_tint: share(&of.spec_tint, at),
                sheen: share(&of.sheen, at),
                sheen_tint: share(&of.sheen_tint, at),
                flatness: share(&of.flatness, at),
                diff_trans: of.diff_trans.at(at)[0].clamp(0.0, 2.0),
            }),
            // Modules and those that are made of others are not looked up.
            _ => Shader::Null(standard::Null),
        }
    }
}

/// What a coat's index and roughness say, its colours left open.
fn coated(material: &Material) -> Option<standard::RoughPlastic> {
    let (eta, nonlinear, distribution, alpha) = match material {
        Material::Plastic { eta, nonlinear, .. } => (*eta, *nonlinear, Distribution::Ggx, 0.0),
        Material::RoughPlastic { eta, nonlinear, distribution, alpha, .. } => (*eta, *nonlinear, *distribution, *alpha),
        _ => return None,
    };
    let white = Spectrum::ONE;
    Some(standard::RoughPlastic::new(eta, white, white, nonlinear, slopes(distribution), alpha))
}

fn slopes(distribution: Distribution) -> standard::Distribution {
    match distribution {
        Distribution::Ggx => standard::Distribution::Ggx,
        Distribution::Beckmann => standard::Distribution::Beckmann,
    }
}

fn microfacet(distribution: Distribution, alpha_u: &Texture, alpha_v: &Texture, at: Coordinates) -> standard::Microfacet {
    let distribution = slopes(distribution);
    standard::Microfacet { distribution, alpha_u: alpha_u.at(at)[0], alpha_v: alpha_v.at(at)[0] }
}
