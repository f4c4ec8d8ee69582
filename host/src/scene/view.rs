//! The scene as one render thread sees it.

use std::{cell::Cell, rc::Rc, sync::Arc};

use bidir_kernel::{Chance, Effects, Point, Ray, Real, Segment};

use crate::{
    plugin::{Sandbox, Strictness},
    rays::Geometry,
    scene::{
        Scene,
        lights::LightId,
        preset::{Full, Preset},
        shape::Shape,
    },
};

/// How many rays were cast.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct RayCounts {
    /// For the nearest surface.
    pub closest: u64,
    /// For whether anything is in the way.
    pub any: u64,
}

impl std::ops::AddAssign for RayCounts {
    fn add_assign(&mut self, other: Self) {
        self.closest += other.closest;
        self.any += other.any;
    }
}

/// One thread's view of the shared scene, as a preset has it; it holds that thread's plugins and counts its rays.
#[derive(Debug)]
pub struct View<'a, P = Full> {
    scene: &'a Scene,
    preset: P,
    sandbox: Rc<Sandbox>,
    closest: Cell<u64>,
    any: Cell<u64>,
}

impl<'a> View<'a> {
    /// A view of any scene, with nothing counted yet.
    pub fn new(scene: &'a Scene, strictness: Strictness) -> Self {
        Self::with(scene, Full {}, strictness)
    }
}

impl<'a, P: Preset> View<'a, P> {
    /// A view with a preset that covers the scene.
    pub fn with(scene: &'a Scene, preset: P, strictness: Strictness) -> Self {
        let sandbox = Rc::new(Sandbox::new(Arc::clone(&scene.roster), strictness));
        Self { scene, preset, sandbox, closest: Cell::new(0), any: Cell::new(0) }
    }

    /// The same thread's view, plugins and all, with another preset that covers the scene; it counts anew.
    pub fn with_preset<Q: Preset>(&self, preset: Q) -> View<'a, Q> {
        View { scene: self.scene, preset, sandbox: Rc::clone(&self.sandbox), closest: Cell::new(0), any: Cell::new(0) }
    }

    /// The scene.
    pub fn scene(&self) -> &'a Scene {
        self.scene
    }

    /// This thread's plugins.
    #[inline]
    pub fn sandbox(&self) -> &Sandbox {
        &self.sandbox
    }

    /// Whether a plugin has failed.
    #[inline(always)]
    pub fn faulted(&self) -> bool {
        P::PLUGINS && self.sandbox.faulted()
    }

    /// The rays cast through this view.
    pub fn rays(&self) -> RayCounts {
        RayCounts { closest: self.closest.get(), any: self.any.get() }
    }
}

/// A ray's end: the shape it met, and what few finishes ask of it, where a preset has those.
#[derive(Clone, Copy, Debug)]
pub struct Hit<'a, D> {
    shape: &'a Shape,
    detail: D,
}

impl<'s, P: Preset> bidir_kernel::Scene for View<'s, P> {
    const EFFECTS: Effects = P::EFFECTS;
    type Hit = Hit<'s, P::Detail>;
    type LightId = LightId;
    type Camera = P::Camera;
    type Bsdf<'a>
        = P::Bsdf<'a>
    where
        Self: 'a;
    type Light<'a>
        = P::Light<'a>
    where
        Self: 'a;

    #[inline(always)]
    fn camera(&self) -> &P::Camera {
        self.preset.camera(self.scene)
    }

    #[inline(always)]
    fn intersect(&self, ray: &Ray) -> Option<(Point, Hit<'s, P::Detail>)> {
        self.closest.set(self.closest.get() + 1);
        // The hit is read where it lies: `?` would copy it.
        let Some(hit) = &self.scene.geometry.closest(ray) else { return None };
        let (point, shape) = self.scene.met_shape(ray, hit);
        let detail = P::detail(self.scene, ray, hit, point.frame, shape);
        Some((point, Hit { shape, detail }))
    }

    #[inline(always)]
    fn unoccluded(&self, a: &Point, b: &Point, segment: Segment) -> bool {
        self.any.set(self.any.get() + 1);
        !self.scene.geometry.occluded(&Ray::between(a, b, segment))
    }

    #[inline(always)]
    fn bsdf(&self, point: &Point, hit: Hit<'s, P::Detail>) -> P::Bsdf<'_> {
        self.preset.bsdf(self.scene, &self.sandbox, hit.shape.finish, point.uv, hit.detail)
    }

    #[inline(always)]
    fn light(&self, id: LightId) -> P::Light<'_> {
        self.preset.light(self.scene, &self.sandbox, id)
    }

    #[inline(always)]
    fn light_id_at(&self, hit: Hit<'s, P::Detail>) -> Option<LightId> {
        hit.shape.light
    }

    #[inline(always)]
    fn environment(&self) -> Option<LightId> {
        self.scene.lights.environment()
    }

    #[inline(always)]
    fn pick_light(&self, lit: Option<&Point>, u: impl FnOnce() -> Real) -> Option<(LightId, Chance)> {
        // A copy, so that the receiver itself need not lie in memory.
        self.scene.lights.only(lit).or_else(|| self.scene.lights.pick(lit.copied().as_ref(), u(), &self.sandbox))
    }

    #[inline(always)]
    fn light_chance(&self, id: LightId, lit: Option<&Point>) -> Chance {
        match self.scene.lights.only(lit) {
            Some((_, chance)) => chance,
            None => self.scene.lights.chance(id, lit.copied().as_ref(), &self.sandbox),
        }
    }

    #[inline(always)]
    fn hides_emitters(&self) -> bool {
        self.scene.hides_emitters
    }
}
