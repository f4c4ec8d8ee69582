//! A shape's surface at a hit: a built-in shader with its parameters looked up, one on each side.

use bidir_kernel::{Bsdf, Carried, Lobe, Real, Scatter, Scattered, Vec2, Vec3};
use bidir_standard as standard;

use crate::scene::description::{Distribution, Material, MaterialId, Texture};

/// A built-in shader, ready to be asked.
#[derive(Clone, Copy, Debug)]
pub enum Shader {
    /// See [`standard::Diffuse`].
    Diffuse(standard::Diffuse),
    /// See [`standard::Conductor`].
    Conductor(standard::Conductor),
    /// See [`standard::RoughConductor`].
    RoughConductor(standard::RoughConductor),
    /// See [`standard::Dielectric`].
    Dielectric(standard::Dielectric),
    /// See [`standard::ThinDielectric`].
    ThinDielectric(standard::ThinDielectric),
    /// See [`standard::RoughDielectric`].
    RoughDielectric(standard::RoughDielectric),
    /// See [`standard::Plastic`].
    Plastic(standard::Plastic),
    /// See [`standard::Null`].
    Null(standard::Null),
}

macro_rules! of_shader {
    ($self:expr, $shader:ident => $call:expr) => {
        match $self {
            Shader::Diffuse($shader) => $call,
            Shader::Conductor($shader) => $call,
            Shader::RoughConductor($shader) => $call,
            Shader::Dielectric($shader) => $call,
            Shader::ThinDielectric($shader) => $call,
            Shader::RoughDielectric($shader) => $call,
            Shader::Plastic($shader) => $call,
            Shader::Null($shader) => $call,
        }
    };
}

impl Bsdf for Shader {
    #[inline]
    fn eval(&self, wo: Vec3, wi: Vec3, carried: Carried) -> Scatter {
        of_shader!(self, shader => shader.eval(wo, wi, carried))
    }

    #[inline]
    fn sample(&self, wo: Vec3, u: [Real; 3], carried: Carried) -> Option<Scattered> {
        of_shader!(self, shader => shader.sample(wo, u, carried))
    }

    #[inline]
    fn lobes(&self) -> Lobe {
        of_shader!(self, shader => shader.lobes())
    }
}

/// A surface at a point: its finish, asked where the point lies. It is two words, so that vertices stay cheap to move;
/// a finish without textures has its shader ready, others look theirs up when they are asked.
#[derive(Clone, Copy, Debug)]
pub struct Surface<'a> {
    finish: &'a Finish,
    uv: Vec2,
}

impl Surface<'_> {
    /// Asks the shader that ω_o meets; the second argument is −1 where that one sees z turned round.
    #[inline(always)]
    fn ask<T>(&self, wo: Vec3, question: impl FnOnce(&Shader, Real) -> T) -> T {
        let Finish { front, behind } = self.finish;
        let (recipe, turn) = match behind {
            _ if wo.z >= 0.0 => (front, 1.0),
            Behind::Itself => (front, 1.0),
            Behind::Mirrored => (front, -1.0),
            Behind::Other(recipe) => (&**recipe, -1.0),
        };
        match &recipe.fixed {
            Some(shader) => question(shader, turn),
            None => question(&recipe.looked_up(self.uv), turn),
        }
    }
}

#[inline(always)]
fn turned(w: Vec3, turn: Real) -> Vec3 {
    Vec3::new(w.x, w.y, w.z * turn)
}

impl Bsdf for Surface<'_> {
    #[inline]
    fn eval(&self, wo: Vec3, wi: Vec3, carried: Carried) -> Scatter {
        self.ask(wo, |shader, turn| shader.eval(turned(wo, turn), turned(wi, turn), carried))
    }

    #[inline]
    fn sample(&self, wo: Vec3, u: [Real; 3], carried: Carried) -> Option<Scattered> {
        self.ask(wo, |shader, turn| {
            let scattered = shader.sample(turned(wo, turn), u, carried)?;
            Some(Scattered { wi: turned(scattered.wi, turn), ..scattered })
        })
    }

    #[inline]
    fn lobes(&self) -> Lobe {
        match &self.finish.behind {
            Behind::Other(recipe) => self.finish.front.lobes(self.uv) | recipe.lobes(self.uv),
            _ => self.finish.front.lobes(self.uv),
        }
    }
}

/// A material with what can be worked out before any hit: a shader, or one on each side.
#[derive(Clone, Debug)]
pub struct Finish {
    /// Where the normal points.
    front: Recipe,
    behind: Behind,
}

/// What a surface is behind its normal.
#[derive(Clone, Debug)]
enum Behind {
    /// Whatever the one shader says of directions from behind.
    Itself,
    /// The same shader, as if its normal pointed there (`twosided` with one child).
    Mirrored,
    /// Another shader, as if its normal pointed there.
    Other(Box<Recipe>),
}

#[derive(Clone, Debug)]
struct Recipe {
    material: Material,
    /// Set once if no texture varies.
    fixed: Option<Shader>,
    inner_reflectance: Real,
}

impl Finish {
    /// The finish of material `id`; `None` if an id names nothing, or a `TwoSided` holds another.
    pub fn new(materials: &[Material], id: MaterialId) -> Option<Self> {
        let material = |id: MaterialId| materials.get(id.0 as usize);
        Some(match material(id)? {
            Material::TwoSided { front, back } if front == back => {
                Self { front: Recipe::new(material(*front)?)?, behind: Behind::Mirrored }
            }
            Material::TwoSided { front, back } => {
                Self { front: Recipe::new(material(*front)?)?, behind: Behind::Other(Box::new(Recipe::new(material(*back)?)?)) }
            }
            one => Self { front: Recipe::new(one)?, behind: Behind::Itself },
        })
    }

    /// The surface at `uv`.
    #[inline(always)]
    pub fn at(&self, uv: Vec2) -> Surface<'_> {
        Surface { finish: self, uv }
    }

    /// Whether anything varies over the surface, or about its normal: then hits need uv, and frames that follow u.
    pub fn mapped(&self) -> bool {
        let mapped = |recipe: &Recipe| recipe.fixed.is_none() || recipe.anisotropic();
        mapped(&self.front) || matches!(&self.behind, Behind::Other(recipe) if mapped(recipe))
    }

    /// Every lobe the surface has at uv (0, 0), for what `explain` says of it.
    pub fn lobes(&self) -> Lobe {
        self.at(Vec2::ZERO).lobes()
    }
}

impl Recipe {
    fn new(material: &Material) -> Option<Self> {
        if matches!(material, Material::TwoSided { .. }) {
            return None;
        }
        let inner_reflectance = match material {
            Material::Plastic { eta, .. } => standard::Plastic::inner_reflectance(*eta),
            _ => 0.0,
        };
        let mut recipe = Self { material: material.clone(), fixed: None, inner_reflectance };
        if recipe.material.textures().iter().all(|texture| matches!(texture, Texture::Constant(_))) {
            recipe.fixed = Some(recipe.looked_up(Vec2::ZERO));
        }
        Some(recipe)
    }

    fn anisotropic(&self) -> bool {
        let differ = |u: &Texture, v: &Texture| !matches!((u, v), (Texture::Constant(u), Texture::Constant(v)) if u[0] == v[0]);
        match &self.material {
            Material::RoughConductor { alpha_u, alpha_v, .. } | Material::RoughDielectric { alpha_u, alpha_v, .. } => {
                differ(alpha_u, alpha_v)
            }
            _ => false,
        }
    }

    #[inline]
    fn lobes(&self, uv: Vec2) -> Lobe {
        match &self.fixed {
            Some(shader) => shader.lobes(),
            None => self.looked_up(uv).lobes(),
        }
    }

    fn looked_up(&self, uv: Vec2) -> Shader {
        match &self.material {
            Material::Diffuse { reflectance } => Shader::Diffuse(standard::Diffuse { reflectance: reflectance.at(uv) }),
            Material::Conductor { eta, k, specular_reflectance } => {
                Shader::Conductor(standard::Conductor { eta: *eta, k: *k, specular_reflectance: specular_reflectance.at(uv) })
            }
            Material::RoughConductor { eta, k, specular_reflectance, distribution, alpha_u, alpha_v } => {
                Shader::RoughConductor(standard::RoughConductor {
                    eta: *eta,
                    k: *k,
                    specular_reflectance: specular_reflectance.at(uv),
                    microfacet: microfacet(*distribution, alpha_u, alpha_v, uv),
                })
            }
            Material::Dielectric { eta, specular_reflectance, specular_transmittance } => Shader::Dielectric(standard::Dielectric {
                eta: *eta,
                specular_reflectance: specular_reflectance.at(uv),
                specular_transmittance: specular_transmittance.at(uv),
            }),
            Material::ThinDielectric { eta, specular_reflectance, specular_transmittance } => {
                Shader::ThinDielectric(standard::ThinDielectric {
                    eta: *eta,
                    specular_reflectance: specular_reflectance.at(uv),
                    specular_transmittance: specular_transmittance.at(uv),
                })
            }
            Material::RoughDielectric { eta, specular_reflectance, specular_transmittance, distribution, alpha_u, alpha_v } => {
                Shader::RoughDielectric(standard::RoughDielectric {
                    eta: *eta,
                    specular_reflectance: specular_reflectance.at(uv),
                    specular_transmittance: specular_transmittance.at(uv),
                    microfacet: microfacet(*distribution, alpha_u, alpha_v, uv),
                })
            }
            Material::Plastic { eta, diffuse_reflectance, specular_reflectance, nonlinear } => Shader::Plastic(standard::Plastic {
                eta: *eta,
                diffuse_reflectance: diffuse_reflectance.at(uv),
                specular_reflectance: specular_reflectance.at(uv),
                nonlinear: *nonlinear,
                inner_reflectance: self.inner_reflectance,
            }),
            Material::Null | Material::TwoSided { .. } => Shader::Null(standard::Null),
        }
    }
}

fn microfacet(distribution: Distribution, alpha_u: &Texture, alpha_v: &Texture, uv: Vec2) -> standard::Microfacet {
    let distribution = match distribution {
        Distribution::Ggx => standard::Distribution::Ggx,
        Distribution::Beckmann => standard::Distribution::Beckmann,
    };
    standard::Microfacet { distribution, alpha_u: alpha_u.at(uv)[0], alpha_v: alpha_v.at(uv)[0] }
}
