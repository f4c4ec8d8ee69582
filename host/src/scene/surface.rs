//! A shape's surface at a hit: a shader with its parameters looked up, one on each side.

use bidir_kernel::{BATCH, Bsdf, Carried, Effects, Lobe, Real, Scatter, Scattered, Spectrum, Vec2, Vec3, math};
use bidir_standard as standard;

use crate::{
    plugin::{Roster, Sandbox, ShaderId},
    scene::{
        description::{Bending, Distribution, Material, MaterialId, NormalMap, PluginShader, Texture, TexturedParameter},
        plain::Matt,
    },
};

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
    /// See [`standard::RoughPlastic`].
    RoughPlastic(standard::RoughPlastic),
    /// See [`standard::Principled`].
    Principled(standard::Principled),
    /// See [`standard::PrincipledThin`].
    PrincipledThin(standard::PrincipledThin),
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
            Shader::RoughPlastic($shader) => $call,
            Shader::Principled($shader) => $call,
            Shader::PrincipledThin($shader) => $call,
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

    #[inline]
    fn eval_n(&self, wo: Vec3, wi: &[Vec3], carried: Carried, scatters: &mut [Scatter]) {
        of_shader!(self, shader => shader.eval_n(wo, wi, carried, scatters));
    }

    #[inline]
    fn eval_and_sample(&self, wo: Vec3, wi: Vec3, u: [Real; 3], carried: Carried) -> (Scatter, Option<Scattered>) {
        of_shader!(self, shader => shader.eval_and_sample(wo, wi, u, carried))
    }
}

/// A surface at a point: its finish, asked where the point lies. It is small, so that vertices stay cheap to move;
/// a finish without textures has its shader ready, others look theirs up when they are asked.
#[derive(Clone, Copy, Debug)]
pub struct Surface<'a> {
    finish: &'a Finish,
    sandbox: &'a Sandbox,
    uv: Vec2,
    stretch: Stretch,
}

/// How a surface's coordinates lie on it, in its shading frame: ∂p/∂u = (a, 0) and ∂p/∂v = (b, c). Only bumps ask for it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stretch {
    /// Of u along x.
    pub a: Real,
    /// Of v along x.
    pub b: Real,
    /// Of v along y.
    pub c: Real,
}

impl Stretch {
    /// The unit normal of a surface with hills whose slope in u and v is that (Blinn 1978, without what the normal's own change adds).
    fn bent(&self, slope: Vec2) -> Vec3 {
        let Self { a, b, c } = *self;
        let normal = Vec3::new(-slope.x * c, slope.x * b - slope.y * a, a * c);
        // Where v runs the other way, so does the cross product.
        math::normalize(normal * Real::signum(a * c)).unwrap_or(Vec3::Z)
    }
}

/// What is asked of a shader, whichever it is; `turn` is −1 where it sees z turned round.
trait Question {
    type Answer;
    fn put(self, shader: &impl Bsdf, turn: Real) -> Self::Answer;
}

impl Surface<'_> {
    /// Asks the shader that ω_o meets.
    #[inline(always)]
    fn ask<Q: Question>(&self, wo: Vec3, question: Q) -> Q::Answer {
        let Finish { front, behind } = self.finish;
        let (recipe, turn) = match behind {
            _ if wo.z >= 0.0 => (front, 1.0),
            Behind::Itself => (front, 1.0),
            Behind::Mirrored => (front, -1.0),
            Behind::Other(recipe) => (&**recipe, -1.0),
        };
        match &recipe.shader {
            Ready::Fixed(shader) => question.put(shader, turn),
            Ready::Plugin(id, _) => {
                if let Material::Plugin(PluginShader { textures, .. }) = &recipe.material
                    && !textures.is_empty()
                {
                    set_textured(self.sandbox, *id, textures, self.uv);
                }
                question.put(&self.sandbox.bsdf(*id), turn)
            }
            Ready::Varying => question.put(&recipe.looked_up(self.uv), turn),
            Ready::Made(nested) => self.ask_nested(nested, question, turn),
        }
    }

    /// The same of a material that is made of others.
    #[inline(never)]
    fn ask_nested<Q: Question>(&self, nested: &Nested, question: Q, turn: Real) -> Q::Answer {
        let part = |finish| Surface { finish, ..*self };
        match nested {
            Nested::Mask { opacity, bsdf } => {
                let masked = standard::Blend { weight: share(opacity, self.uv), first: standard::Null, second: part(bsdf) };
                question.put(&masked, turn)
            }
            Nested::Blend { weight, parts } => {
                let [first, second] = &**parts;
                question.put(&standard::Blend { weight: share(weight, self.uv), first: part(first), second: part(second) }, turn)
            }
            Nested::Bent { map, bending: Bending { flips, shadowed }, bsdf } => {
                let normal = self.normal(map);
                question.put(&standard::Bent::new(normal, *flips, *shadowed, part(bsdf)), turn)
            }
        }
    }
}

impl Surface<'_> {
    /// The turned normal in the shading frame, unit.
    fn normal(&self, map: &NormalMap) -> Vec3 {
        match map {
            NormalMap::Normals(normals) => {
                let [x, y, z] = normals.at(self.uv).0;
                math::normalize(Vec3::new(2.0 * x - 1.0, 2.0 * y - 1.0, 2.0 * z - 1.0)).unwrap_or(Vec3::Z)
            }
            NormalMap::Heights(heights, scale) => self.stretch.bent(heights.slope(self.uv) * *scale),
        }
    }
}

struct Eval {
    wo: Vec3,
    wi: Vec3,
    carried: Carried,
}

impl Question for Eval {
    type Answer = Scatter;

    #[inline(always)]
    fn put(self, shader: &impl Bsdf, turn: Real) -> Scatter {
        shader.eval(turned(self.wo, turn), turned(self.wi, turn), self.carried)
    }
}

struct Sample {
    wo: Vec3,
    u: [Real; 3],
    carried: Carried,
}

impl Question for Sample {
    type Answer = Option<Scattered>;

    #[inline(always)]
    fn put(self, shader: &impl Bsdf, turn: Real) -> Option<Scattered> {
        let scattered = shader.sample(turned(self.wo, turn), self.u, self.carried)?;
        Some(Scattered { wi: turned(scattered.wi, turn), ..scattered })
    }
}

struct EvalMany<'q> {
    wo: Vec3,
    wi: &'q [Vec3],
    carried: Carried,
    scatters: &'q mut [Scatter],
}

impl Question for EvalMany<'_> {
    type Answer = ();

    #[inline(always)]
    fn put(self, shader: &impl Bsdf, turn: Real) {
        if turn > 0.0 {
            return shader.eval_n(self.wo, self.wi, self.carried, self.scatters);
        }
        for (wi, scatters) in self.wi.chunks(BATCH).zip(self.scatters.chunks_mut(BATCH)) {
            let mut seen_turned = [Vec3::ZERO; BATCH];
            for (there, wi) in seen_turned.iter_mut().zip(wi) {
                *there = turned(*wi, turn);
            }
            shader.eval_n(turned(self.wo, turn), &seen_turned[..wi.len()], self.carried, scatters);
        }
    }
}

struct EvalAndSample {
    wo: Vec3,
    wi: Vec3,
    u: [Real; 3],
    carried: Carried,
}

impl Question for EvalAndSample {
    type Answer = (Scatter, Option<Scattered>);

    #[inline(always)]
    fn put(self, shader: &impl Bsdf, turn: Real) -> Self::Answer {
        let (scatter, sampled) = shader.eval_and_sample(turned(self.wo, turn), turned(self.wi, turn), self.u, self.carried);
        (scatter, sampled.map(|sampled| Scattered { wi: turned(sampled.wi, turn), ..sampled }))
    }
}

#[inline(always)]
fn turned(w: Vec3, turn: Real) -> Vec3 {
    Vec3::new(w.x, w.y, w.z * turn)
}

impl Bsdf for Surface<'_> {
    #[inline]
    fn eval(&self, wo: Vec3, wi: Vec3, carried: Carried) -> Scatter {
        self.ask(wo, Eval { wo, wi, carried })
    }

    #[inline]
    fn sample(&self, wo: Vec3, u: [Real; 3], carried: Carried) -> Option<Scattered> {
        self.ask(wo, Sample { wo, u, carried })
    }

    #[inline]
    fn lobes(&self) -> Lobe {
        self.finish.lobes_at(self.uv)
    }

    #[inline]
    fn eval_n(&self, wo: Vec3, wi: &[Vec3], carried: Carried, scatters: &mut [Scatter]) {
        self.ask(wo, EvalMany { wo, wi, carried, scatters });
    }

    #[inline]
    fn eval_and_sample(&self, wo: Vec3, wi: Vec3, u: [Real; 3], carried: Carried) -> (Scatter, Option<Scattered>) {
        self.ask(wo, EvalAndSample { wo, wi, u, carried })
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

/// A shader, as far as it is known before any hit.
#[derive(Clone, Debug)]
enum Ready {
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
enum Nested {
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

    fn lobes(&self, uv: Vec2) -> Lobe {
        let of_parts = self.parts().iter().map(|part| part.lobes_at(uv)).fold(Lobe::NONE, |all, lobes| all | lobes);
        match self {
            Self::Mask { opacity, .. } if opacity.at(uv)[0] < 1.0 => of_parts | Lobe::DELTA_TRANSMISSION,
            _ => of_parts,
        }
    }
}

#[derive(Clone, Debug)]
struct Recipe {
    material: Material,
    /// What of a coat does not depend on colours.
    coated: Option<Box<standard::RoughPlastic>>,
    shader: Ready,
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
    pub fn at<'a>(&'a self, uv: Vec2, stretch: Stretch, sandbox: &'a Sandbox) -> Surface<'a> {
        Surface { finish: self, sandbox, uv, stretch }
    }

    /// Whether anything varies over the surface, or about its normal: then hits need uv, and frames that follow u.
    pub fn mapped(&self) -> bool {
        self.recipes().any(|recipe| recipe.varies() || recipe.anisotropic() || recipe.parts().iter().any(Self::mapped))
    }

    /// Whether it has bumps: then hits need to know how coordinates lie on the surface.
    pub fn bumpy(&self) -> bool {
        let bumps = |recipe: &Recipe| {
            matches!(recipe.material, Material::Bent { map: NormalMap::Heights(..), .. }) || recipe.parts().iter().any(Self::bumpy)
        };
        self.recipes().any(bumps)
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
        self.lobes_at(Vec2::ZERO)
    }

    #[inline]
    fn lobes_at(&self, uv: Vec2) -> Lobe {
        match &self.behind {
            Behind::Other(recipe) => self.front.lobes(uv) | recipe.lobes(uv),
            _ => self.front.lobes(uv),
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
            recipe.shader = Ready::Fixed(recipe.looked_up(Vec2::ZERO));
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
    fn lobes(&self, uv: Vec2) -> Lobe {
        match &self.shader {
            Ready::Fixed(shader) => shader.lobes(),
            Ready::Plugin(_, lobes) => *lobes,
            Ready::Made(nested) => nested.lobes(uv),
            Ready::Varying => self.looked_up(uv).lobes(),
        }
    }

    /// A built-in shader at `uv`.
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
            Material::Plastic { diffuse_reflectance, specular_reflectance, .. }
            | Material::RoughPlastic { diffuse_reflectance, specular_reflectance, .. } => {
                let Some(coated) = &self.coated else { return Shader::Null(standard::Null) };
                let (diffuse_reflectance, specular_reflectance) = (diffuse_reflectance.at(uv), specular_reflectance.at(uv));
                let plastic = standard::Plastic { diffuse_reflectance, specular_reflectance, ..coated.plastic };
                match self.material {
                    Material::Plastic { .. } => Shader::Plastic(plastic),
                    _ => Shader::RoughPlastic(standard::RoughPlastic { plastic, ..**coated }),
                }
            }
            Material::Principled(of) => Shader::Principled(standard::Principled {
                base_color: of.base_color.at(uv),
                roughness: share(&of.roughness, uv),
                anisotropic: share(&of.anisotropic, uv),
                metallic: share(&of.metallic, uv),
                spec_trans: share(&of.spec_trans, uv),
                eta: of.eta.at(uv)[0],
                spec_tint: share(&of.spec_tint, uv),
                sheen: share(&of.sheen, uv),
                sheen_tint: share(&of.sheen_tint, uv),
                flatness: share(&of.flatness, uv),
                clearcoat: share(&of.clearcoat, uv),
                clearcoat_gloss: share(&of.clearcoat_gloss, uv),
            }),
            Material::PrincipledThin(of) => Shader::PrincipledThin(standard::PrincipledThin {
                base_color: of.base_color.at(uv),
                roughness: share(&of.roughness, uv),
                anisotropic: share(&of.anisotropic, uv),
                spec_trans: share(&of.spec_trans, uv),
                eta: of.eta.at(uv)[0],
                spec_tint: share(&of.spec_tint, uv),
                sheen: share(&of.sheen, uv),
                sheen_tint: share(&of.sheen_tint, uv),
                flatness: share(&of.flatness, uv),
                diff_trans: of.diff_trans.at(uv)[0].clamp(0.0, 2.0),
            }),
            // Modules and those that are made of others are not looked up.
            _ => Shader::Null(standard::Null),
        }
    }
}

/// Looks the textures of a plugin's parameters up.
#[inline]
pub(super) fn set_textured(sandbox: &Sandbox, id: ShaderId, textures: &[TexturedParameter], uv: Vec2) {
    if !textures.is_empty() {
        sandbox.set(id, textures.iter().map(|parameter| (parameter.offset, parameter.texture.at(uv), parameter.channels)));
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

fn microfacet(distribution: Distribution, alpha_u: &Texture, alpha_v: &Texture, uv: Vec2) -> standard::Microfacet {
    let distribution = slopes(distribution);
    standard::Microfacet { distribution, alpha_u: alpha_u.at(uv)[0], alpha_v: alpha_v.at(uv)[0] }
}

/// A texture's first band as a part of a whole: between texels, rounding may leave 0 … 1.
fn share(texture: &Texture, uv: Vec2) -> Real {
    texture.at(uv)[0].clamp(0.0, 1.0)
}
