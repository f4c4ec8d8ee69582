//! What the lens meets first: layers beside the picture, for denoisers and compositors.

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

/// A layer of what the lens meets first, by so many of the render's samples per pixel: through the film's own filter, but for numbers of
/// shapes and the like, which nothing lies between. Black for what is not met, and for quantities that are not of the first surface.
///
/// # Errors
/// If the film cannot be made.
pub fn feature(scene: &Scene, settings: &FilmSettings, job: &Job, quantity: Quantity, samples: u32) -> Result<Image> {
    if !quantity.is_filtered() {
        return Ok(numbers(scene, settings, quantity));
    }
    let film = Film::new(settings)?;
    let samples = samples.clamp(1, MOST_SAMPLES);
    std::thread::scope(|scope| {
        for _ in 0..job.threads.max(1) {
            scope.spawn(|| match job.numbers {
                Numbers::Sobol => expose::<Sobol>(scene, &film, job, quantity, samples),
                Numbers::Independent => expose::<Apart>(scene, &film, job, quantity, samples),
            });
        }
    });
    Ok(film.develop())
}

/// One thread's share.
fn expose<N: Source>(scene: &Scene, film: &Film, job: &Job, quantity: Quantity, samples: u32) {
    let view = View::new(scene, Strictness::Lenient);
    while let Some(mut buffer) = film.claim(samples) {
        let unit = buffer.unit();
        let source = N::new(job.seed, unit.sample);
        for (x, y) in film.pixels(&unit) {
            let mut numbers = source.pixel(u64::from(y) * u64::from(job.width) + u64::from(x));
            numbers.seek(Walk::Camera, 0);
            let [dx, dy] = numbers.next_pair();
            let raster = Vec2::new(x as Real + dx, y as Real + dy);
            let ray = ray(&view, raster, numbers.next_pair());
            buffer.begin(raster);
            add(&mut buffer, sampled(&view, &ray, quantity, &mut numbers));
            buffer.end();
        }
        film.commit(buffer);
    }
}

fn add(buffer: &mut TileBuffer, value: Spectrum) {
    buffer.add(Contribution { value, weight: 1.0, technique: Technique { s: 0, t: 2 } });
}

/// The ray that the lens sees a place of the film by.
fn ray(view: &View, raster: Vec2, lens: [Real; 2]) -> Ray {
    let seen = view.camera().look(raster, lens);
    Ray {
        origin: seen.point.position + seen.direction * seen.near,
        direction: seen.direction,
        t_max: seen.far - seen.near,
        segment: Segment::Lens,
    }
}

fn sampled(view: &View, ray: &Ray, quantity: Quantity, numbers: &mut impl Sampler) -> Spectrum {
    if quantity == Quantity::Albedo {
        return albedo(view, ray, numbers);
    }
    let scene = view.scene();
    scene.first_met(ray).map_or(Spectrum::BLACK, |met| Spectrum(first(scene, ray, &met, quantity)))
}

fn first(scene: &Scene, ray: &Ray, met: &Met, quantity: Quantity) -> [Real; 3] {
    let of = |v: Vec3| [v.x, v.y, v.z];
    match quantity {
        Quantity::ShadingNormal => of(met.point.frame.z),
        Quantity::GeometricNormal => of(met.point.normal),
        Quantity::Depth => [(met.point.position - ray.origin).length(), 0.0, 0.0],
        Quantity::Position => of((met.point.position.as_dvec3() + scene.origin()).as_vec3()),
        Quantity::Uv => [met.point.uv.x, met.point.uv.y, 0.0],
        _ => [0.0; 3],
    }
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

/// Numbers of what lies behind the middles of pixels.
fn numbers(scene: &Scene, settings: &FilmSettings, quantity: Quantity) -> Image {
    let (view, crop) = (View::new(scene, Strictness::Lenient), settings.crop);
    let mut image = Image::black(crop.width, crop.height);
    for (i, pixel) in image.pixels.iter_mut().enumerate() {
        let [x, y] = [i as u32 % crop.width + crop.x, i as u32 / crop.width + crop.y].map(|v| v as Real + 0.5);
        let met = scene.first_met(&ray(&view, Vec2::new(x, y), [0.5; 2]));
        let number = |met: Met| match quantity {
            Quantity::ShapeIndex => met.shape,
            Quantity::PrimIndex => met.triangle,
            _ => met.material,
        };
        *pixel = [met.map_or(-1.0, |met| number(met) as f32); 3];
    }
    image
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
        let image = feature(&scene, &description.film, &job, quantity, 16).unwrap();
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
