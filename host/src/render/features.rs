//! What the lens meets first: layers beside the picture, for denoisers and compositors.

use std::sync::{
    Mutex, PoisonError,
    atomic::{AtomicBool, Ordering},
};

use bidir_kernel::{
    Bsdf as _, Camera as _, Carried, Contribution, Film as _, Ray, Real, Sampler, Scene as _, Segment, Spectrum, Technique, Vec2, Vec3,
    Walk,
};

use super::{
    Job, Numbers,
    numbers::{Apart, Sobol, Source},
};
use crate::{
    error::Result,
    film::{Exposure as _, Film, Store as _, TileBuffer},
    image::Image,
    plugin::Strictness,
    scene::{
        Met, Scene,
        description::{FilmSettings, Quantity},
        view::View,
    },
};

/// Samples per pixel that features take at most: their noise is that of edges, not of light.
const MOST_SAMPLES: u32 = 64;

/// How often each sample asks the surface what it gives back.
const ALBEDO_SAMPLES: u32 = 4;

/// Layers of what the lens meets first, in that order, by so many of the render's samples per pixel: through the film's own filter, but for
/// numbers of shapes and the like, which nothing lies between. Black for what is not met, and for quantities that are not of the first
/// surface. Raising `interrupt` ends them where they are.
///
/// # Errors
/// If a film cannot be made.
pub fn features(
    scene: &Scene,
    settings: &FilmSettings,
    job: &Job,
    quantities: &[Quantity],
    samples: u32,
    interrupt: &AtomicBool,
) -> Result<Vec<Image>> {
    let filtered: Vec<Quantity> = quantities.iter().copied().filter(|quantity| quantity.is_filtered()).collect();
    let films = filtered.iter().map(|_| Film::new(settings)).collect::<Result<Vec<_>>>()?;
    let (samples, turn) = (samples.clamp(1, MOST_SAMPLES), Mutex::new(()));
    let pass = Pass { scene, job, films: &films, filtered: &filtered, samples, turn: &turn, interrupt };
    if !films.is_empty() {
        std::thread::scope(|scope| {
            for _ in 0..job.threads.max(1) {
                scope.spawn(|| match job.numbers {
                    Numbers::Sobol => pass.expose::<Sobol>(),
                    Numbers::Independent => pass.expose::<Apart>(),
                });
            }
        });
    }
    let numbers = if filtered.len() < quantities.len() { numbers(scene, settings, job, interrupt) } else { Vec::new() };
    let (mut films, crop) = (films.iter(), settings.crop);
    let image = |quantity: &Quantity| match quantity {
        filtered if filtered.is_filtered() => films.next().map_or_else(|| Image::black(crop.width, crop.height), Film::develop),
        other => {
            let place = [Quantity::ShapeIndex, Quantity::PrimIndex, Quantity::MaterialIndex].iter().position(|one| one == other);
            let pixels = numbers.iter().map(|numbers| [place.map_or(0.0, |place| numbers[place]); 3]).collect();
            Image { width: crop.width, height: crop.height, pixels }
        }
    };
    Ok(quantities.iter().map(image).collect())
}

/// One pass over what is filtered: every ray is cast once, and told to a film for each quantity.
struct Pass<'a> {
    scene: &'a Scene,
    job: &'a Job,
    films: &'a [Film],
    filtered: &'a [Quantity],
    samples: u32,
    /// All films are claimed from by one thread at a time, so that their units stay the same.
    turn: &'a Mutex<()>,
    interrupt: &'a AtomicBool,
}

impl Pass<'_> {
    fn claim(&self) -> Option<Vec<TileBuffer>> {
        if self.interrupt.load(Ordering::Relaxed) {
            return None;
        }
        let _turn = self.turn.lock().unwrap_or_else(PoisonError::into_inner);
        self.films.iter().map(|film| film.claim(self.samples)).collect()
    }

    /// One thread's share.
    fn expose<N: Source>(&self) {
        let view = View::new(self.scene, Strictness::Lenient);
        while let Some(mut buffers) = self.claim() {
            let Some(unit) = buffers.first().map(TileBuffer::unit) else { return };
            let source = N::new(self.job.seed, unit.sample);
            for (x, y) in self.films[0].pixels(&unit) {
                let mut numbers = source.pixel(u64::from(y) * u64::from(self.job.width) + u64::from(x));
                numbers.seek(Walk::Camera, 0);
                let [dx, dy] = numbers.next_pair();
                let raster = Vec2::new(x as Real + dx, y as Real + dy);
                let (lens, ray) = ray(&view, raster, numbers.next_pair());
                let met = self.scene.first_met(&ray);
                for (buffer, quantity) in buffers.iter_mut().zip(self.filtered) {
                    let value = match (quantity, &met) {
                        (_, None) => Spectrum::BLACK,
                        (Quantity::Albedo, Some(_)) => albedo(&view, &ray, &mut numbers),
                        (_, Some(met)) => Spectrum(first(self.scene, lens, met, *quantity)),
                    };
                    buffer.begin(raster);
                    buffer.add(Contribution { value, weight: 1.0, technique: Technique { s: 0, t: 2 } });
                    buffer.end();
                }
            }
            self.films.iter().zip(buffers).for_each(|(film, buffer)| film.commit(buffer));
        }
    }
}

/// Where the lens is that sees a place of the film, and the ray by which it does.
fn ray(view: &View, raster: Vec2, lens: [Real; 2]) -> (Vec3, Ray) {
    let seen = view.camera().look(raster, lens);
    let origin = seen.point.position + seen.direction * seen.near;
    (seen.point.position, Ray { origin, direction: seen.direction, t_max: seen.far - seen.near, segment: Segment::Lens })
}

fn first(scene: &Scene, lens: Vec3, met: &Met, quantity: Quantity) -> [Real; 3] {
    let of = |v: Vec3| [v.x, v.y, v.z];
    match quantity {
        Quantity::ShadingNormal => of(met.point.frame.z),
        Quantity::GeometricNormal => of(met.point.normal),
        Quantity::Depth => [(met.point.position - lens).length(), 0.0, 0.0],
        Quantity::Position => of((met.point.position.as_dvec3() + scene.origin()).as_vec3()),
        Quantity::Uv => [met.point.uv.x, met.point.uv.y, 0.0],
        _ => [0.0; 3],
    }
}

/// The numbers of shape, triangle and material behind the middle of each pixel, row by row; −1 where nothing is.
fn numbers(scene: &Scene, settings: &FilmSettings, job: &Job, interrupt: &AtomicBool) -> Vec<[f32; 3]> {
    let crop = settings.crop;
    let (width, rows) = (crop.width as usize, crop.height.div_ceil(job.threads.max(1) as u32) as usize);
    let mut all = vec![[-1.0; 3]; width * crop.height as usize];
    std::thread::scope(|scope| {
        for (part, pixels) in all.chunks_mut(width * rows).enumerate() {
            scope.spawn(move || {
                let view = View::new(scene, Strictness::Lenient);
                for (row, pixels) in pixels.chunks_mut(width).enumerate() {
                    if interrupt.load(Ordering::Relaxed) {
                        return;
                    }
                    let y = crop.y as usize + part * rows + row;
                    for (column, pixel) in pixels.iter_mut().enumerate() {
                        let middle = Vec2::new((crop.x as usize + column) as Real + 0.5, y as Real + 0.5);
                        if let Some(met) = scene.first_met(&ray(&view, middle, [0.5; 2]).1) {
                            *pixel = [met.shape, met.triangle, met.material].map(|number| number as f32);
                        }
                    }
                }
            });
        }
    });
    all
}

/// f |cos| / p, on average over what the surface samples itself: its directional albedo.
fn albedo(view: &View, ray: &Ray, numbers: &mut impl Sampler) -> Spectrum {
    let Some((point, hit)) = view.intersect(ray) else { return Spectrum::BLACK };
    let bsdf = view.bsdf(&point, hit);
    let wo = point.frame.to_local(-ray.direction);
    let mut sum = Spectrum::BLACK;
    for _ in 0..ALBEDO_SAMPLES {
        let u = [numbers.next(), numbers.next(), numbers.next()];
        if let Some(scattered) = bsdf.sample(wo, u, Carried::Radiance)
            && scattered.weight.is_finite()
        {
            sum += scattered.weight;
        }
    }
    sum * (1.0 / ALBEDO_SAMPLES as Real)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use bidir_kernel::{Heuristic, Strategy, Techniques};

    use super::*;
    use crate::{load::load_str, plugin::Library, render::Target, scene::description::Description};

    /// A red wall two away from the lens, a mirror half a unit before it on the right, and nothing above them.
    const SCENE: &str = r#"<scene version="3.0.0">
        <sensor type="orthographic">
            <transform name="to_world"><lookat origin="10, 0, 3" target="10, 0, 0" up="0, 1, 0"/></transform>
            <film type="hdrfilm"><integer name="width" value="8"/><integer name="height" value="8"/><rfilter type="box"/></film>
        </sensor>
        <bsdf type="twosided" id="red"><bsdf type="diffuse"><rgb name="reflectance" value="0.8, 0.2, 0.1"/></bsdf></bsdf>
        <shape type="rectangle">
            <transform name="to_world"><scale y="0.5"/><translate x="10" y="-0.5" z="1"/></transform><ref id="red"/>
        </shape>
        <shape type="rectangle">
            <transform name="to_world"><scale x="0.5" y="0.5"/><translate x="10.5" y="-0.5" z="1.5"/></transform><bsdf type="conductor"/>
        </shape>
        <emitter type="constant"/></scene>"#;

    fn scene() -> (Description, Scene, Job) {
        let description = load_str(SCENE, Path::new("s.xml"), None, &[], &Library::default()).unwrap().description;
        let scene = Scene::new(&description).unwrap();
        let job = Job {
            strategy: Strategy { techniques: Techniques::PATH, heuristic: Heuristic::Balance, max_depth: 2, rr_depth: 5 },
            seed: 1,
            numbers: Numbers::Sobol,
            threads: 2,
            target: Target::Samples(4),
            width: 8,
            strictness: Strictness::Lenient,
        };
        (description, scene, job)
    }

    /// What is told of the wall, of the mirror, and of the sky.
    fn told(quantity: Quantity) -> [[f32; 3]; 3] {
        let (description, scene, job) = scene();
        let image = features(&scene, &description.film, &job, &[quantity], 16, &AtomicBool::new(false)).unwrap().remove(0);
        // The camera looks along −z, so that x grows to the right.
        [image.at(1, 6), image.at(6, 6), image.at(4, 1)]
    }

    #[track_caller]
    fn near(found: [f32; 3], wanted: [f32; 3], within: f32) {
        assert!(found.iter().zip(wanted).all(|(a, b)| (a - b).abs() <= within), "{found:?} for {wanted:?}");
    }

    #[test]
    fn depth_and_place_are_those_of_what_is_met_first_and_0_where_nothing_is() {
        let [wall, mirror, sky] = told(Quantity::Depth);
        near(wall, [2.0, 0.0, 0.0], 1e-5);
        near(mirror, [1.5, 0.0, 0.0], 1e-5);
        assert_eq!(sky, [0.0; 3]);
        // Pixel 1 of 8 across −1 … 1 has its middle at −0.625, pixel 6 down at −0.625.
        let [wall, _, sky] = told(Quantity::Position);
        near(wall, [10.0 - 0.625, -0.625, 1.0], 0.05);
        assert_eq!(sky, [0.0; 3]);
    }

    #[test]
    fn normals_are_unit_and_in_the_world() {
        for quantity in [Quantity::ShadingNormal, Quantity::GeometricNormal] {
            let [wall, mirror, _] = told(quantity);
            near(wall, [0.0, 0.0, 1.0], 1e-6);
            near(mirror, [0.0, 0.0, 1.0], 1e-6);
        }
    }

    #[test]
    fn an_albedo_is_what_a_surface_gives_back() {
        let [wall, mirror, sky] = told(Quantity::Albedo);
        near(wall, [0.8, 0.2, 0.1], 1e-5);
        near(mirror, [1.0; 3], 1e-5);
        assert_eq!(sky, [0.0; 3]);
    }

    #[test]
    fn coordinates_are_told_of_surfaces_that_do_not_ask_for_them() {
        let [wall, _, _] = told(Quantity::Uv);
        near(wall, [0.1875, 0.375, 0.0], 0.06);
    }

    #[test]
    fn numbers_are_those_of_the_file_and_never_in_between() {
        assert_eq!(told(Quantity::ShapeIndex), [[0.0; 3], [1.0; 3], [-1.0; 3]]);
        let [wall, mirror, sky] = told(Quantity::MaterialIndex);
        assert!(wall != mirror && wall[0] >= 0.0 && mirror[0] >= 0.0 && sky == [-1.0; 3], "{wall:?} {mirror:?} {sky:?}");
    }
}
