//! A shape's surface at a hit: its finish, asked where the point lies.

mod finish;

use bidir_kernel::{BATCH, Bsdf, Carried, Lobe, Real, Scatter, Scattered, Vec2, Vec3, math};
use bidir_standard as standard;

pub use self::finish::Finish;
use self::finish::{Behind, Nested, Ready};
use crate::{
    plugin::{Sandbox, ShaderId},
    scene::{
        description::{Bending, Material, NormalMap, PluginShader, Texture, TexturedParameter},
        texture::{Coordinates, Face},
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
    detail: Detail,
}

/// What few finishes ask of a hit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Detail {
    /// For bumps.
    pub stretch: Stretch,
    /// For attributes of meshes.
    pub face: Face,
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
    /// Where its textures are looked up.
    #[inline(always)]
    fn at(&self) -> Coordinates {
        Coordinates { uv: self.uv, face: self.detail.face }
    }

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
                    set_textured(self.sandbox, *id, textures, self.at());
                }
                question.put(&self.sandbox.bsdf(*id), turn)
            }
            Ready::Varying => question.put(&recipe.looked_up(self.at()), turn),
            Ready::Made(nested) => self.ask_nested(nested, question, turn),
        }
    }

    /// The same of a material that is made of others.
    #[inline(never)]
    fn ask_nested<Q: Question>(&self, nested: &Nested, question: Q, turn: Real) -> Q::Answer {
        let part = |finish| Surface { finish, ..*self };
        match nested {
            Nested::Mask { opacity, bsdf } => {
                let masked = standard::Blend { weight: share(opacity, self.at()), first: standard::Null, second: part(bsdf) };
                question.put(&masked, turn)
            }
            Nested::Blend { weight, parts } => {
                let [first, second] = &**parts;
                question.put(&standard::Blend { weight: share(weight, self.at()), first: part(first), second: part(second) }, turn)
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
                let [x, y, z] = normals.at(self.at()).0;
                math::normalize(Vec3::new(2.0 * x - 1.0, 2.0 * y - 1.0, 2.0 * z - 1.0)).unwrap_or(Vec3::Z)
            }
            NormalMap::Heights(heights, scale) => self.detail.stretch.bent(heights.slope(self.uv) * *scale),
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
        self.finish.lobes_at(self.at())
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

/// Looks the textures of a plugin's parameters up.
#[inline]
pub(super) fn set_textured(sandbox: &Sandbox, id: ShaderId, textures: &[TexturedParameter], at: impl Into<Coordinates>) {
    let at = at.into();
    if !textures.is_empty() {
        sandbox.set(id, textures.iter().map(|parameter| (parameter.offset, parameter.texture.at(at), parameter.channels)));
    }
}

/// A texture's first band as a part of a whole: between texels, rounding may leave 0 … 1.
fn share(texture: &Texture, at: Coordinates) -> Real {
    texture.at(at)[0].clamp(0.0, 1.0)
}
