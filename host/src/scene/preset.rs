//! Presets: what a render is compiled for. There are few, and a scene is rendered with the smallest that covers it; any that covers
//! it gives the same image, bit for bit.

use bidir_kernel::{Bsdf, Camera, Effects, Frame, Light, Ray, Vec2};

use crate::{
    plugin::Sandbox,
    rays::RayHit,
    scene::{
        Scene,
        camera::SceneCamera,
        lights::{LightId, SceneLight},
        plain::{Lamp, Matt, Parts},
        shape::Shape,
        surface::{Detail, Surface},
    },
};

/// What may be in a scene, and as what it is asked.
pub trait Preset: Copy {
    /// What may occur.
    const EFFECTS: Effects;
    /// Whether plugins may be called.
    const PLUGINS: bool;
    /// The camera.
    type Camera: Camera;
    /// A surface.
    type Bsdf<'v>: Bsdf
    where
        Self: 'v;
    /// A light.
    type Light<'v>: Light
    where
        Self: 'v;

    /// What few finishes ask of a hit, if there may be such.
    type Detail: Copy;

    /// What is kept of what a scene tells of a hit.
    fn detail(scene: &Scene, ray: &Ray, hit: &RayHit, frame: Frame, shape: &Shape) -> Self::Detail;

    /// The camera.
    fn camera<'v>(&'v self, scene: &'v Scene) -> &'v Self::Camera;

    /// The surface of that finish at `uv`.
    fn bsdf<'v>(&'v self, scene: &'v Scene, sandbox: &'v Sandbox, finish: u32, uv: Vec2, detail: Self::Detail) -> Self::Bsdf<'v>;

    /// A light, by name.
    fn light<'v>(&'v self, scene: &'v Scene, sandbox: &'v Sandbox, id: LightId) -> Self::Light<'v>;
}

/// Any scene; without `LIGHT_WALKS`, paths from the camera alone.
#[derive(Clone, Copy, Debug, Default)]
pub struct Any<const LIGHT_WALKS: bool>;

/// Whatever may be.
pub type Full = Any<true>;

/// Plain scenes; without `LIGHT_WALKS`, path tracing with one next event alone.
#[derive(Clone, Copy, Debug)]
pub struct Plain<'a, const LIGHT_WALKS: bool>(&'a Parts);

impl<const LIGHT_WALKS: bool> Preset for Any<LIGHT_WALKS> {
    const EFFECTS: Effects = Effects { light_walks: LIGHT_WALKS, ..Effects::ALL };
    const PLUGINS: bool = true;
    type Camera = SceneCamera;
    type Bsdf<'v> = Surface<'v>;
    type Light<'v> = SceneLight<'v>;
    type Detail = Detail;

    #[inline(always)]
    fn detail(scene: &Scene, ray: &Ray, hit: &RayHit, frame: Frame, shape: &Shape) -> Detail {
        scene.detail(ray, hit, &frame, shape)
    }

    #[inline(always)]
    fn camera<'v>(&'v self, scene: &'v Scene) -> &'v SceneCamera {
        &scene.camera
    }

    #[inline(always)]
    fn bsdf<'v>(&'v self, scene: &'v Scene, sandbox: &'v Sandbox, finish: u32, uv: Vec2, detail: Detail) -> Surface<'v> {
        scene.finishes[finish as usize].at(uv, detail, sandbox)
    }

    #[inline(always)]
    fn light<'v>(&'v self, scene: &'v Scene, sandbox: &'v Sandbox, id: LightId) -> SceneLight<'v> {
        scene.lights.get(id, sandbox)
    }
}

impl<'a, const LIGHT_WALKS: bool> Preset for Plain<'a, LIGHT_WALKS> {
    const EFFECTS: Effects = Effects { light_walks: LIGHT_WALKS, other_counts: LIGHT_WALKS, power_heuristic: LIGHT_WALKS, ..Effects::NONE };
    const PLUGINS: bool = false;
    type Camera = bidir_kernel::camera::Pinhole;
    type Bsdf<'v>
        = &'v Matt
    where
        Self: 'v;
    type Light<'v>
        = &'v Lamp
    where
        Self: 'v;
    type Detail = ();

    #[inline(always)]
    fn detail(_: &Scene, _: &Ray, _: &RayHit, _: Frame, _: &Shape) {}

    #[inline(always)]
    fn camera<'v>(&'v self, _: &'v Scene) -> &'v Self::Camera {
        &self.0.camera
    }

    #[inline(always)]
    fn bsdf<'v>(&'v self, _: &'v Scene, _: &'v Sandbox, finish: u32, _: Vec2, (): ()) -> &'v Matt {
        self.0.surface(finish)
    }

    #[inline(always)]
    fn light<'v>(&'v self, _: &'v Scene, _: &'v Sandbox, id: LightId) -> Self::Light<'v> {
        self.0.light(id)
    }
}

/// Something to be done with whichever preset suits.
pub trait Task {
    /// What comes of it.
    type Output;

    /// Does it.
    fn run<P: Preset>(self, preset: P) -> Self::Output;
}

impl Scene {
    /// Does a task with the smallest preset that covers the scene and what else is `needed`.
    pub fn with_smallest_preset<T: Task>(&self, needed: Effects, task: T) -> T::Output {
        let needed = self.effects | needed;
        match &self.plain {
            Some(parts) if Plain::<false>::EFFECTS.covers(needed) => task.run(Plain::<false>(parts)),
            Some(parts) if Plain::<true>::EFFECTS.covers(needed) => task.run(Plain::<true>(parts)),
            _ if Any::<false>::EFFECTS.covers(needed) => task.run(Any::<false>),
            _ => task.run(Full {}),
        }
    }

    /// The same with one that has light walks, whether they are needed or not: for tasks that others need not be compiled for.
    pub fn with_light_walks<T: Task>(&self, needed: Effects, task: T) -> T::Output {
        match &self.plain {
            Some(parts) if Plain::<true>::EFFECTS.covers(self.effects | needed) => task.run(Plain::<true>(parts)),
            _ => task.run(Full {}),
        }
    }
}
