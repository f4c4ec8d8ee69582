//! The scene as one render thread sees it.

use std::{cell::Cell, sync::Arc};

use bidir_kernel::{Chance, Point, Ray, Real, Segment};

use crate::{
    plugin::{Sandbox, Strictness},
    rays::Geometry,
    scene::{
        Scene,
        camera::SceneCamera,
        lights::{LightId, SceneLight},
        surface::Surface,
    },
};

/// How many rays were cast.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
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

/// One thread's view of the shared scene; it holds that thread's plugins and counts its rays.
#[derive(Debug)]
pub struct View<'a> {
    scene: &'a Scene,
    sandbox: Sandbox,
    closest: Cell<u64>,
    any: Cell<u64>,
}

impl<'a> View<'a> {
    /// A view with nothing counted yet.
    pub fn new(scene: &'a Scene, strictness: Strictness) -> Self {
        let sandbox = Sandbox::new(Arc::clone(&scene.roster), strictness);
        Self { scene, sandbox, closest: Cell::new(0), any: Cell::new(0) }
    }

    /// This thread's plugins.
    #[inline]
    pub fn sandbox(&self) -> &Sandbox {
        &self.sandbox
    }

    /// The rays cast through this view.
    pub fn rays(&self) -> RayCounts {
        RayCounts { closest: self.closest.get(), any: self.any.get() }
    }
}

/// A ray's end: the shape it met.
#[derive(Clone, Copy, Debug)]
pub struct Hit {
    shape: u32,
}

impl bidir_kernel::Scene for View<'_> {
    type Hit = Hit;
    type LightId = LightId;
    type Camera = SceneCamera;
    type Bsdf<'a>
        = Surface<'a>
    where
        Self: 'a;
    type Light<'a>
        = SceneLight<'a>
    where
        Self: 'a;

    #[inline]
    fn camera(&self) -> &SceneCamera {
        &self.scene.camera
    }

    #[inline]
    fn intersect(&self, ray: &Ray) -> Option<(Point, Hit)> {
        self.closest.set(self.closest.get() + 1);
        let hit = self.scene.geometry.closest(ray)?;
        let (point, shape) = self.scene.met(ray, &hit);
        Some((point, Hit { shape }))
    }

    #[inline]
    fn unoccluded(&self, a: &Point, b: &Point, segment: Segment) -> bool {
        self.any.set(self.any.get() + 1);
        !self.scene.geometry.occluded(&Ray::between(a, b, segment))
    }

    #[inline]
    fn bsdf(&self, point: &Point, hit: Hit) -> Surface<'_> {
        self.scene.finishes[self.scene.shapes[hit.shape as usize].finish as usize].at(point.uv, &self.sandbox)
    }

    #[inline]
    fn light(&self, id: LightId) -> SceneLight<'_> {
        self.scene.lights.get(id, &self.sandbox)
    }

    #[inline]
    fn light_id_at(&self, hit: Hit) -> Option<LightId> {
        self.scene.shapes[hit.shape as usize].light
    }

    #[inline]
    fn environment(&self) -> Option<LightId> {
        self.scene.lights.environment()
    }

    #[inline]
    fn pick_light(&self, lit: Option<&Point>, u: Real) -> Option<(LightId, Chance)> {
        self.scene.lights.pick(lit, u, &self.sandbox)
    }

    #[inline]
    fn light_chance(&self, id: LightId, lit: Option<&Point>) -> Chance {
        self.scene.lights.chance(id, lit, &self.sandbox)
    }

    #[inline]
    fn hides_emitters(&self) -> bool {
        self.scene.hides_emitters
    }
}
