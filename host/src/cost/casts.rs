//! What the rays of a render take: some of them are kept, and cast again for nothing but the time.

use std::{
    cell::RefCell,
    hint::black_box,
    sync::atomic::{AtomicBool, Ordering},
    time::Duration,
};

use bidir_kernel::{Chance, Point, Ray, Real, Sampler as _, Segment, Techniques, Vec2, Walk, sample};
use cpu_time::ThreadTime;

use super::subject::Subject;
use crate::{
    plan::Stage,
    rays::Geometry as _,
    render::{Nobody, Sobol, Source as _, scattered, storage},
    scene::{
        camera::SceneCamera,
        lights::{LightId, SceneLight},
        surface::{Detail, Surface},
        view::{Hit, RayCounts, View},
    },
};

/// Rays that are kept of each kind: enough to tell, few enough to lie in a cache's reach while the next ones come.
const KEPT: usize = 100_000;
/// How long it takes to find them at most.
const LONGEST: Duration = Duration::from_millis(500);
/// Times that they are cast again, of which the fastest counts.
const ROUNDS: u32 = 3;
/// Samples of a pixel before another one has its turn.
const SAMPLES: u32 = 4;

/// CPU seconds of a ray.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PerRay {
    /// That asks for the nearest hit.
    pub closest: f64,
    /// That asks whether there is any.
    pub any: f64,
}

/// What a ray takes of those that a render casts which joins paths so, by the mean over its picture. `cast` is how many
/// that render has of each kind.
pub(super) fn per_ray(subject: &Subject, techniques: Techniques, cast: RayCounts, interrupt: &AtomicBool) -> PerRay {
    if cast == RayCounts::default() {
        return PerRay::default();
    }
    let view = View::new(&subject.scene, subject.strictness);
    let watched = Watched { view: &view, closest: RefCell::default(), any: RefCell::default() };
    let strategy = Stage::of(&techniques).strategy(&subject.description.integrator);
    let crop = subject.description.film.crop;
    let (mut camera_path, mut light_path) = (storage(&strategy), storage(&strategy));
    let clock = ThreadTime::now();
    // Pixels all over the picture, and no more of them than there are.
    for turn in 0..(u64::from(crop.width) * u64::from(crop.height)).min(KEPT as u64) {
        let [x, y] = scattered(turn, crop);
        view.sandbox().begin_tile(turn);
        for index in 0..SAMPLES {
            let source = Sobol::new(subject.seed, index);
            let mut numbers = source.pixel(u64::from(y) * u64::from(subject.description.film.width) + u64::from(x));
            numbers.seek(Walk::Camera, 0);
            let [dx, dy] = numbers.next_pair();
            let raster = Vec2::new(x as f32 + dx, y as f32 + dy);
            sample(&watched, &strategy, &mut numbers, raster, &mut camera_path, &mut light_path, &mut Nobody);
        }
        let full = |rays: &RefCell<Vec<Ray>>, cast: u64| cast == 0 || rays.borrow().len() >= KEPT;
        let enough = full(&watched.closest, cast.closest) && full(&watched.any, cast.any) || clock.elapsed() > LONGEST;
        if enough || view.sandbox().faulted() || interrupt.load(Ordering::Relaxed) {
            break;
        }
    }
    let geometry = subject.scene.geometry();
    PerRay {
        closest: each(&watched.closest.borrow(), |ray| geometry.closest(ray)),
        any: each(&watched.any.borrow(), |ray| geometry.occluded(ray)),
    }
}

/// CPU seconds of casting one.
fn each<T>(rays: &[Ray], cast: impl Fn(&Ray) -> T) -> f64 {
    let once = |_| {
        let clock = ThreadTime::now();
        for ray in rays {
            black_box(cast(ray));
        }
        clock.elapsed().as_secs_f64()
    };
    (0..ROUNDS).map(once).fold(f64::INFINITY, f64::min) / rays.len().max(1) as f64
}

/// A scene that keeps the rays which are cast in it.
struct Watched<'v> {
    view: &'v View<'v>,
    closest: RefCell<Vec<Ray>>,
    any: RefCell<Vec<Ray>>,
}

fn keep(rays: &RefCell<Vec<Ray>>, ray: Ray) {
    let mut rays = rays.borrow_mut();
    if rays.len() < KEPT {
        rays.push(ray);
    }
}

impl<'v> bidir_kernel::Scene for Watched<'v> {
    type Hit = Hit<'v, Detail>;
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

    fn camera(&self) -> &Self::Camera {
        self.view.camera()
    }

    fn intersect(&self, ray: &Ray) -> Option<(Point, Self::Hit)> {
        keep(&self.closest, *ray);
        self.view.intersect(ray)
    }

    fn unoccluded(&self, a: &Point, b: &Point, segment: Segment) -> bool {
        keep(&self.any, Ray::between(a, b, segment));
        self.view.unoccluded(a, b, segment)
    }

    fn bsdf(&self, point: &Point, hit: Self::Hit) -> Self::Bsdf<'_> {
        self.view.bsdf(point, hit)
    }

    fn light(&self, id: LightId) -> Self::Light<'_> {
        self.view.light(id)
    }

    fn light_id_at(&self, hit: Self::Hit) -> Option<LightId> {
        self.view.light_id_at(hit)
    }

    fn environment(&self) -> Option<LightId> {
        self.view.environment()
    }

    fn pick_light(&self, lit: Option<&Point>, u: impl FnOnce() -> Real) -> Option<(LightId, Chance)> {
        self.view.pick_light(lit, u)
    }

    fn light_chance(&self, id: LightId, lit: Option<&Point>) -> Chance {
        self.view.light_chance(id, lit)
    }

    fn hides_emitters(&self) -> bool {
        self.view.hides_emitters()
    }
}
