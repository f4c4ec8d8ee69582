//! What can be checked: families of shaders, one for each set of parameters.

use std::cell::RefCell;

use bidir_abi::{EmitOut, EvalOut, ProfileOut, SampleOut};
use bidir_kernel::{
    Bsdf, Carried, Chance, Emitted, Lobe, Made, PerSolidAngle, Profile, Real, Scatter, Scattered, Spectrum, Vec2, Vec3, profile::Profiled,
};

use crate::plugin::{Asked, Flaw, answer};

/// A set of parameters.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Set {
    /// What cases call it; no two sets have one name.
    pub name: String,
    /// What differs from the defaults, in words; empty at the defaults.
    pub words: String,
}

impl Set {
    /// A set that is called `name` in cases and sentences.
    pub fn named(name: impl Into<String>) -> Self {
        let name = name.into();
        Self { words: name.clone(), name }
    }
}

/// What a BSDF promises.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Promises {
    /// Every lobe that it has with some parameters.
    pub lobes: Lobe,
    /// Whether f is the same both ways.
    pub reciprocal: bool,
    /// Whether only the azimuth between directions counts.
    pub isotropic: bool,
}

/// Answers that broke a rule, and were left out.
#[derive(Clone, Debug, PartialEq)]
pub struct Refusal {
    /// What was asked, the first time.
    pub asked: Asked,
    /// What was wrong.
    pub flaw: Flaw,
    /// How many there were.
    pub count: u64,
}

/// A place where shaders answer, and what went wrong there so far. Nothing reaches one from another.
pub trait Instance {
    /// Answers that were left out, one entry for each kind of question.
    fn refusals(&self) -> Vec<Refusal>;

    /// Why a call did not return, if one did not; answers are black from then on.
    fn broken(&self) -> Option<String> {
        None
    }

    /// Its memory, if it has one of its own.
    fn memory_bytes(&self) -> Option<usize> {
        None
    }
}

/// An instance of BSDFs.
pub trait Surface: Instance {
    /// The BSDF of a set, by its place among [`Surfaces::sets`].
    fn bsdf(&self, set: usize) -> Box<dyn Bsdf + '_>;
}

/// BSDFs to check.
pub trait Surfaces: Sync {
    /// The sets of parameters.
    fn sets(&self) -> &[Set];

    /// What is promised for all of them.
    fn promises(&self) -> Promises;

    /// What the sets leave out, in words.
    fn left_out(&self) -> Vec<String> {
        Vec::new()
    }

    /// A fresh instance.
    fn open(&self) -> Box<dyn Surface + '_>;
}

/// An instance of emission profiles.
pub trait Lamp: Instance {
    /// The profile of a set, by its place among [`Lamps::sets`].
    fn profile(&self, set: usize) -> Box<dyn Profile + '_>;
}

/// Emission profiles to check.
pub trait Lamps: Sync {
    /// The sets of parameters.
    fn sets(&self) -> &[Set];

    /// Whether they shine from surfaces, so that `uv` may matter.
    fn on_surfaces(&self) -> bool;

    /// What the sets leave out, in words.
    fn left_out(&self) -> Vec<String> {
        Vec::new()
    }

    /// A fresh instance.
    fn open(&self) -> Box<dyn Lamp + '_>;
}

/// Shaders of this program's own: `make` makes the one of a set. Their answers are held to the rules that plugins are held to.
#[derive(Clone, Debug)]
pub struct Linked<M> {
    sets: Vec<Set>,
    promises: Promises,
    make: M,
}

impl<M> Linked<M> {
    /// BSDFs that keep those promises.
    pub fn bsdfs<B: Bsdf>(sets: Vec<Set>, promises: Promises, make: M) -> Self
    where
        M: Fn(usize) -> B + Sync,
    {
        Self { sets, promises, make }
    }

    /// Emission profiles.
    pub fn profiles<P: Profile>(sets: Vec<Set>, make: M) -> Self
    where
        M: Fn(usize) -> P + Sync,
    {
        Self { sets, promises: Promises { lobes: Lobe::NONE, reciprocal: true, isotropic: false }, make }
    }
}

impl<B: Bsdf + 'static, M: Fn(usize) -> B + Sync> Surfaces for Linked<M> {
    fn sets(&self) -> &[Set] {
        &self.sets
    }

    fn promises(&self) -> Promises {
        self.promises
    }

    fn open(&self) -> Box<dyn Surface + '_> {
        Box::new(Opened { family: self, refusals: RefCell::default() })
    }
}

impl<P: Profile + 'static, M: Fn(usize) -> P + Sync> Lamps for Linked<M> {
    fn sets(&self) -> &[Set] {
        &self.sets
    }

    fn on_surfaces(&self) -> bool {
        true
    }

    fn open(&self) -> Box<dyn Lamp + '_> {
        Box::new(Opened { family: self, refusals: RefCell::default() })
    }
}

struct Opened<'a, M> {
    family: &'a Linked<M>,
    refusals: RefCell<Vec<Refusal>>,
}

impl<M> Instance for Opened<'_, M> {
    fn refusals(&self) -> Vec<Refusal> {
        self.refusals.borrow().clone()
    }
}

impl<B: Bsdf + 'static, M: Fn(usize) -> B + Sync> Surface for Opened<'_, M> {
    fn bsdf(&self, set: usize) -> Box<dyn Bsdf + '_> {
        Box::new(Held { shader: (self.family.make)(set), lobes: self.family.promises.lobes, refusals: &self.refusals })
    }
}

impl<P: Profile + 'static, M: Fn(usize) -> P + Sync> Lamp for Opened<'_, M> {
    fn profile(&self, set: usize) -> Box<dyn Profile + '_> {
        Box::new(Held { shader: (self.family.make)(set), lobes: Lobe::NONE, refusals: &self.refusals })
    }
}

/// A shader whose answers are held to the rules.
struct Held<'a, S> {
    shader: S,
    lobes: Lobe,
    refusals: &'a RefCell<Vec<Refusal>>,
}

impl<S> Held<'_, S> {
    #[cold]
    fn refuse(&self, asked: Asked, flaw: Flaw) {
        let mut refusals = self.refusals.borrow_mut();
        match refusals.iter_mut().find(|known| known.asked.export() == asked.export()) {
            Some(known) => known.count += 1,
            None => refusals.push(Refusal { asked, flaw, count: 1 }),
        }
    }
}

impl<B: Bsdf> Held<'_, B> {
    fn scatter(&self, wo: Vec3, wi: Vec3, carried: Carried, answer: Scatter) -> Scatter {
        let Scatter { value, pdf: PerSolidAngle(pdf), pdf_rev: PerSolidAngle(pdf_rev) } = answer;
        answer::scatter(&EvalOut { value: value.0, pdf, pdf_rev }).unwrap_or_else(|flaw| {
            self.refuse(Asked::Eval { wo: wo.to_array(), wi: wi.to_array(), carried }, flaw);
            Scatter::NONE
        })
    }

    fn scattered(&self, wo: Vec3, u: [Real; 3], carried: Carried, answer: Option<Scattered>) -> Option<Scattered> {
        let Scattered { wi, weight, made, eta, lobe } = answer?;
        let (pdf, pdf_rev) = match made {
            Made::Smooth { pdf: PerSolidAngle(pdf), pdf_rev: PerSolidAngle(pdf_rev) } => (pdf, pdf_rev),
            Made::Delta { chance: Chance(pdf), chance_rev: Chance(pdf_rev) } => (pdf, pdf_rev),
        };
        let out = SampleOut { wi: wi.to_array(), weight: weight.0, pdf, pdf_rev, lobe: lobe.0, eta };
        answer::scattered(&out, wo.z, self.lobes).unwrap_or_else(|flaw| {
            self.refuse(Asked::Sample { wo: wo.to_array(), u, carried }, flaw);
            None
        })
    }
}

impl<B: Bsdf> Bsdf for Held<'_, B> {
    fn eval(&self, wo: Vec3, wi: Vec3, carried: Carried) -> Scatter {
        self.scatter(wo, wi, carried, self.shader.eval(wo, wi, carried))
    }

    fn sample(&self, wo: Vec3, u: [Real; 3], carried: Carried) -> Option<Scattered> {
        self.scattered(wo, u, carried, self.shader.sample(wo, u, carried))
    }

    fn lobes(&self) -> Lobe {
        self.lobes
    }

    fn eval_n(&self, wo: Vec3, wi: &[Vec3], carried: Carried, scatters: &mut [Scatter]) {
        self.shader.eval_n(wo, wi, carried, scatters);
        for (scatter, wi) in scatters.iter_mut().zip(wi) {
            *scatter = self.scatter(wo, *wi, carried, *scatter);
        }
    }

    fn eval_and_sample(&self, wo: Vec3, wi: Vec3, u: [Real; 3], carried: Carried) -> (Scatter, Option<Scattered>) {
        let (scatter, scattered) = self.shader.eval_and_sample(wo, wi, u, carried);
        (self.scatter(wo, wi, carried, scatter), self.scattered(wo, u, carried, scattered))
    }
}

impl<P: Profile> Profile for Held<'_, P> {
    fn eval(&self, uv: Vec2, direction: Vec3) -> Profiled {
        let Profiled { radiance, pdf } = self.shader.eval(uv, direction);
        answer::profiled(&ProfileOut { radiance: radiance.0, pdf: pdf.0 }).unwrap_or_else(|flaw| {
            self.refuse(Asked::Profile { uv: uv.to_array(), w: direction.to_array() }, flaw);
            Profiled { radiance: Spectrum::BLACK, pdf: PerSolidAngle(0.0) }
        })
    }

    fn emit(&self, uv: Vec2, u: [Real; 2]) -> Option<Emitted> {
        let Emitted { direction, profiled } = self.shader.emit(uv, u)?;
        let out = EmitOut { direction: direction.to_array(), radiance: profiled.radiance.0, pdf: profiled.pdf.0 };
        answer::emitted(&out).unwrap_or_else(|flaw| {
            self.refuse(Asked::Emit { uv: uv.to_array(), u }, flaw);
            None
        })
    }
}
