//! The world that paths are sampled in.

use crate::{
    bsdf::Bsdf,
    camera::Camera,
    density::Chance,
    effects::Effects,
    light::Light,
    point::{Point, Ray, Segment},
    real::Real,
};

/// Geometry, surfaces, lights and a camera.
///
/// Every method is infallible: a scene that can fail answers black, notes the fault, and its owner looks once per path.
pub trait Scene {
    /// What sampling it may need. It is read when the kernel is compiled for the scene: `if S::EFFECTS.environment { … }`.
    const EFFECTS: Effects = Effects::ALL;

    /// What the scene remembers of a ray's end, to find surface and light there.
    type Hit: Copy;
    /// Names a light.
    type LightId: Copy;
    /// The camera.
    type Camera: Camera;
    /// The surface at a hit, its parameters already looked up.
    type Bsdf<'a>: Bsdf
    where
        Self: 'a;
    /// A light.
    type Light<'a>: Light
    where
        Self: 'a;

    /// The camera.
    fn camera(&self) -> &Self::Camera;

    /// The nearest surface along the ray.
    fn intersect(&self, ray: &Ray) -> Option<(Point, Self::Hit)>;

    /// Whether nothing lies between the two points.
    fn unoccluded(&self, a: &Point, b: &Point, segment: Segment) -> bool {
        self.intersect(&Ray::between(a, b, segment)).is_none()
    }

    /// The surface at a hit.
    fn bsdf(&self, point: &Point, hit: Self::Hit) -> Self::Bsdf<'_>;

    /// A light, by name.
    fn light(&self, id: Self::LightId) -> Self::Light<'_>;

    /// The light whose surface was hit, if that surface is one.
    fn light_id_at(&self, hit: Self::Hit) -> Option<Self::LightId> {
        let _ = hit;
        None
    }

    /// The one light that rays which escape land on: the sum of everything infinitely far away that is not a Dirac.
    fn environment(&self) -> Option<Self::LightId> {
        None
    }

    /// Every light, for a scene that leaves the choice among them to the two methods below; else it may stay empty.
    fn lights(&self) -> &[Self::LightId] {
        &[]
    }

    /// Chooses a light with a number in [0, 1), which need not be asked for: to light the receiver `lit`, or, without one, to start
    /// a light walk. Unless told otherwise, each light as often as the next. Of the receiver, as for [`Light`], nothing counts but
    /// position, geometric normal and place.
    fn pick_light(&self, lit: Option<&Point>, u: impl FnOnce() -> Real) -> Option<(Self::LightId, Chance)> {
        let lights = self.lights();
        let id = *lights.get((u() * lights.len() as Real) as usize)?;
        Some((id, self.light_chance(id, lit)))
    }

    /// The chance that [`Scene::pick_light`] chooses `id`, asked afterwards.
    fn light_chance(&self, id: Self::LightId, lit: Option<&Point>) -> Chance {
        let _ = (id, lit);
        Chance(1.0 / self.lights().len().max(1) as Real)
    }

    /// Whether the lens sees through emitters, environments included, as if they were not there.
    fn hides_emitters(&self) -> bool {
        false
    }
}
