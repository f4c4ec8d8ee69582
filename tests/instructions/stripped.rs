//! A path tracer for one kind of scene and nothing else, written by hand: diffuse surfaces of one colour, seen by a pinhole, lit by
//! one rectangle; next event and BSDF sampling, weighed by the balance heuristic. Rays, random numbers and film are the host's.

use bidir::{
    film::{Exposure as _, Film, Store as _, TileBuffer},
    plugin::Strictness,
    rays::Geometry as _,
    render::{Scrambled, Sobol, Source as _},
    scene::{
        Scene,
        camera::SceneCamera,
        description::Description,
        extent::{LightExtent, Parallelogram},
        lights::{ProfileSource, Seat},
        view::View,
    },
};
use bidir_kernel::{
    Contribution, Film as _, Ray, Real, Sampler as _, Scene as _, Segment, Spectrum, Technique, Vec2, Vec3, Walk,
    camera::Perspective,
    light::Extent as _,
    math::{dot, sqrt},
    real::INV_PI,
    sampler::DIMENSIONS_PER_VERTEX,
    warp::cosine_hemisphere,
};

/// Where the numbers of a vertex's next event, roulette and BSDF begin.
const ENDPOINT: u32 = 0;
const ROULETTE: u32 = 3;
const BSDF: u32 = 4;

/// The scene, as far as it matters.
pub struct Stripped<'a> {
    scene: &'a Scene,
    camera: Perspective,
    /// Of each shape: its colour, and whether it is the light.
    shapes: Vec<(Spectrum, bool)>,
    light: Parallelogram,
    radiance: Spectrum,
    max_depth: u32,
    rr_depth: u32,
}

impl<'a> Stripped<'a> {
    /// `None` if it is another kind of scene.
    pub fn new(scene: &'a Scene, description: &Description) -> Option<Self> {
        let SceneCamera::Perspective(camera) = *View::new(scene, Strictness::Strict).camera() else { return None };
        let [light] = scene.all_lights().sources() else { return None };
        let Seat::Shape(LightExtent::Parallelogram(rectangle)) = &light.seat else { return None };
        let ProfileSource::Area(profile) = &light.profile else { return None };
        let seen =
            |shape| Some((scene.finish_of(shape).matt().filter(|matt| !matt.both_sides())?.shader.reflectance, shape.light.is_some()));
        let integrator = &description.integrator;
        Some(Self {
            scene,
            camera,
            shapes: scene.shapes().iter().map(seen).collect::<Option<_>>()?,
            light: *rectangle,
            radiance: profile.radiance,
            max_depth: integrator.max_depth.unwrap_or(u32::MAX),
            rr_depth: integrator.rr_depth,
        })
    }

    /// Samples every pixel so many times.
    pub fn render(&self, film: &Film, seed: u64, width: u32, samples: u32) {
        while let Some(mut buffer) = film.claim(samples) {
            let unit = buffer.unit();
            let source = Sobol::new(seed, unit.sample);
            for (x, y) in film.pixels(&unit) {
                let mut numbers = source.pixel(u64::from(y) * u64::from(width) + u64::from(x));
                numbers.seek(Walk::Camera, 0);
                let [dx, dy] = numbers.next_pair();
                let raster = Vec2::new(x as f32 + dx, y as f32 + dy);
                buffer.begin(raster);
                self.path(raster, &mut numbers, &mut buffer);
                buffer.end();
            }
            film.commit(buffer);
        }
    }

    fn ray(&self, raster: Vec2) -> Ray {
        let Perspective { position, axes: [x, y, z], film, .. } = &self.camera;
        let slope = film.at(raster);
        let length = sqrt(slope.x * slope.x + slope.y * slope.y + 1.0);
        let direction = *x * (slope.x / length) + *y * (slope.y / length) + *z * (1.0 / length);
        Ray { origin: *position, direction, t_max: Real::INFINITY, segment: Segment::Lens }
    }

    fn path(&self, raster: Vec2, numbers: &mut Scrambled, buffer: &mut TileBuffer) {
        let geometry = self.scene.geometry();
        let mut ray = self.ray(raster);
        let mut throughput = Spectrum::ONE;
        // Where the last segment began, and how densely its direction was made.
        let (mut previous, mut pdf) = (Vec3::ZERO, 0.0);
        for length in 1..=self.max_depth {
            let Some(hit) = geometry.closest(&ray) else { return };
            let (point, shape) = self.scene.met(&ray, &hit);
            let (reflectance, shines) = self.shapes[shape as usize];
            let cos_o = -dot(ray.direction, point.normal);
            if cos_o <= 0.0 {
                return;
            }
            if shines {
                let weight = if length == 1 { 1.0 } else { balance(1.0, self.picked(point.position - previous, cos_o) / f64::from(pdf)) };
                add(buffer, throughput * self.radiance, weight, Technique { s: 0, t: length + 1 });
            }
            if length == self.max_depth {
                return;
            }
            numbers.seek(Walk::Camera, length * DIMENSIONS_PER_VERTEX + ENDPOINT);
            if let Some(lit) = self.light.sample_toward(&point, numbers.next_pair()) {
                let cos_i = dot(lit.direction, point.normal);
                let cos_light = -dot(lit.direction, self.light.0.frame.z);
                let value = throughput * (reflectance * (cos_i * INV_PI)) * (self.radiance * lit.weight);
                if cos_i > 0.0
                    && cos_light > 0.0
                    && !value.is_black()
                    && !geometry.occluded(&Ray::between(&point, &lit.point, Segment::Inner))
                {
                    let made = f64::from(cos_i * INV_PI) / self.picked(lit.point.position - point.position, cos_light);
                    add(buffer, value, balance(1.0, made), Technique { s: 1, t: length + 1 });
                }
            }
            numbers.seek(Walk::Camera, length * DIMENSIONS_PER_VERTEX + BSDF);
            let wi = cosine_hemisphere(numbers.next_pair());
            throughput *= reflectance;
            if throughput.is_black() {
                return;
            }
            if length >= self.rr_depth {
                numbers.seek(Walk::Camera, length * DIMENSIONS_PER_VERTEX + ROULETTE);
                let survival = throughput.max().min(0.95);
                if numbers.next() >= survival {
                    return;
                }
                throughput = throughput * (1.0 / survival);
            }
            (previous, pdf) = (point.position, wi.z * INV_PI);
            ray = Ray::leaving(&point, point.frame.to_world(wi), Segment::Inner);
        }
    }

    /// How densely next event makes a direction to the light, `away` of which there is, per steradian.
    fn picked(&self, away: Vec3, cos: Real) -> f64 {
        let (x, y, z) = (f64::from(away.x), f64::from(away.y), f64::from(away.z));
        (x * x + y * y + z * z) / (f64::from(cos) * f64::from(self.light.0.area))
    }
}

/// The share of a technique in a path that another makes so densely.
fn balance(own: f64, other: f64) -> Real {
    (own / (own + other)) as Real
}

fn add(buffer: &mut TileBuffer, value: Spectrum, weight: Real, technique: Technique) {
    buffer.add(Contribution { value, weight, technique });
}
