//! `bidir techniques`.

mod save;

use std::{fs, path::Path};

use bidir_kernel::Technique;

use crate::{
    cli::{
        Outcome,
        arguments::Techniques,
        interrupt,
        progress::{Goal, Progress, Stages},
        render::{conclude, read, strictness, thread_count, verbosity},
    },
    error::{Error, Result},
    film::Pyramid,
    image::write,
    plan::{Stage, effects::Effects, joins::exists},
    render::{self, Job, Status, Target},
    scene::{Scene, description::Description},
};
use save::{Index, KINDS};

pub(super) fn run(arguments: &Techniques) -> Result<Outcome> {
    let mut stages = Stages::new(verbosity(arguments.quiet));
    let mut description = read(Some(&arguments.scene), &arguments.from, &mut stages)?;
    let longest = limit(&mut description, arguments.longest);
    if longest == 0 {
        return Err(Error::in_file(&arguments.scene, "max_depth is 0, so there are no paths to show", "give --max-depth 1 or more"));
    }
    let pyramid = Pyramid::new(&description.film, longest)?;
    prepare(&arguments.output)?;
    stages.building(&description);
    let scene = Scene::new(&description)?;
    stages.built();
    if scene.degenerate() > 0 {
        eprintln!("warning: {} shapes or triangles without area were dropped", scene.degenerate());
    }

    let job = Job {
        strategy: Stage::BIDIRECTIONAL.strategy(&description.integrator),
        numbers: arguments.sampler,
        seed: arguments.seed.unwrap_or(description.seed),
        threads: thread_count(arguments.threads),
        target: Target::Samples(arguments.spp),
        width: description.film.width,
        strictness: strictness(&arguments.from),
    };
    let status = expose(&scene, &pyramid, &job, arguments);

    let effects = Effects::of(&description, &scene);
    let (there, impossible): (Vec<Technique>, Vec<Technique>) = pyramid.techniques().partition(|&technique| exists(&effects, technique));
    let index = Index {
        scene: arguments.scene.clone(),
        width: description.film.crop.width,
        height: description.film.crop.height,
        spp: status.samples,
        seed: job.seed,
        longest,
        mean: [0.0; 3],
        techniques: Vec::new(),
        impossible: impossible.iter().map(|technique| [technique.s, technique.t]).collect(),
        pictures: Vec::new(),
        interrupted: status.interrupted,
        version: env!("CARGO_PKG_VERSION"),
    };
    save::save(&arguments.output, &pyramid, &there, index)?;
    if pyramid.refused() > 0 {
        eprintln!("warning: {} contributions were not finite and were refused", pyramid.refused());
    }
    if !arguments.quiet {
        let picture = arguments.output.join("weighted.png");
        let (seconds, count) = (status.elapsed.as_secs_f64(), there.len());
        println!("{count} techniques, {} samples per pixel in {seconds:.1} s: {}", status.samples, picture.display());
    }
    conclude(&status)
}

/// The longest paths to show. No path up to there depends on a longer one, so those are not made at all.
fn limit(description: &mut Description, longest: u32) -> u32 {
    let longest = longest.min(description.integrator.max_depth.unwrap_or(u32::MAX));
    description.integrator.max_depth = Some(longest);
    longest
}

fn expose(scene: &Scene, pyramid: &Pyramid, job: &Job, arguments: &Techniques) -> Status {
    let mut progress = Progress::new(Goal::Samples(arguments.spp), verbosity(arguments.quiet));
    let status = render::render(scene, pyramid, job, &interrupt::flag(), |status| {
        progress.update(status.samples, status.elapsed, None);
        None
    });
    progress.finish();
    status
}

/// Makes the folders, and tells whether they take files, before anything is rendered.
fn prepare(folder: &Path) -> Result<()> {
    if folder.exists() && !folder.is_dir() {
        return Err(Error::in_file(folder, "this is a file, and the techniques need a folder", "name a folder, new or old"));
    }
    for folder in KINDS.iter().map(|kind| folder.join(kind)) {
        fs::create_dir_all(&folder)
            .map_err(|error| Error::in_file(&folder, format!("the folder cannot be made: {error}"), "name one where you may write"))?;
        write::check_writable(&folder.join("s0_t2.exr"))?;
    }
    write::check_writable(&folder.join("weighted.png"))
}

#[cfg(test)]
mod tests {
    use bidir_kernel::Strategy;

    use super::*;
    use crate::render::Numbers;
    use crate::{
        film::Film,
        image::Image,
        load::load_str,
        plugin::{Library, Strictness},
    };

    /// A small room: a lamp, a mirror, something rough, and a lens.
    const ROOM: &str = r#"<scene version="3.0.0">
        <sensor type="thinlens">
            <float name="fov" value="60"/><float name="aperture_radius" value="0.1"/><float name="focus_distance" value="3"/>
            <transform name="to_world"><lookat origin="0, 0, 3" target="0, 0, 0" up="0, 1, 0"/></transform>
            <film type="hdrfilm">
                <integer name="width" value="20"/><integer name="height" value="18"/><rfilter type="box"/>
            </film>
        </sensor>
        <shape type="rectangle"><bsdf type="diffuse"/><transform name="to_world"><scale value="3"/><translate z="-1"/></transform></shape>
        <shape type="sphere"><point name="center" value="-0.8, 0, 0"/><float name="radius" value="0.5"/><bsdf type="conductor"/></shape>
        <shape type="sphere"><point name="center" value="0.8, 0, 0"/><float name="radius" value="0.5"/>
            <bsdf type="roughconductor"><float name="alpha" value="0.3"/></bsdf></shape>
        <shape type="sphere"><point name="center" value="0, 1.2, 0.5"/><float name="radius" value="0.2"/>
            <emitter type="area"><rgb name="radiance" value="5"/></emitter></shape>
        </scene>"#;

    fn room() -> (Description, Scene) {
        let mut description = load_str(ROOM, Path::new("room.xml"), None, &[], &Library::default()).unwrap().description;
        assert_eq!(limit(&mut description, 4), 4);
        let scene = Scene::new(&description).unwrap();
        (description, scene)
    }

    fn job(strategy: Strategy) -> Job {
        Job {
            strategy,
            seed: 3,
            numbers: Numbers::Sobol,
            threads: 2,
            target: Target::Samples(8),
            width: 20,
            strictness: Strictness::Lenient,
        }
    }

    fn pyramid(description: &Description, scene: &Scene, job: &Job) -> Pyramid {
        let pyramid = Pyramid::new(&description.film, 4).unwrap();
        render::render(scene, &pyramid, job, &false.into(), |_| None);
        pyramid
    }

    fn sum(images: impl Iterator<Item = Image>) -> Image {
        let mut sum = Image::black(20, 18);
        for image in images {
            for (sum, value) in sum.pixels.iter_mut().zip(image.pixels) {
                (0..3).for_each(|band| sum[band] += value[band]);
            }
        }
        sum
    }

    /// A box filter is what a pyramid's pixels are, so every pixel must agree but for rounding: sums of 8 samples in f32, over 18 layers.
    #[test]
    fn the_weighted_layers_add_up_to_the_image() {
        let (description, scene) = room();
        let job = job(Stage::BIDIRECTIONAL.strategy(&description.integrator));
        let film = Film::new(&description.film).unwrap();
        render::render(&scene, &film, &job, &false.into(), |_| None);
        let image = film.develop();
        let pyramid = pyramid(&description, &scene, &job);
        let layers = sum(pyramid.techniques().map(|technique| pyramid.develop(technique)[0].clone()));
        for (a, b) in image.pixels.iter().zip(&layers.pixels) {
            assert!((0..3).all(|band| (a[band] - b[band]).abs() <= 1e-5 * a[band].abs().max(0.1)), "{a:?} {b:?}");
        }
        assert!(image.pixels.iter().any(|pixel| pixel[0] > 0.1));
    }

    /// So that limiting the depth to what is shown changes nothing that is shown.
    #[test]
    fn shown_paths_do_not_depend_on_longer_ones() {
        let (description, scene) = room();
        let strategy = Stage::BIDIRECTIONAL.strategy(&description.integrator);
        let limited = pyramid(&description, &scene, &job(strategy));
        let unlimited = pyramid(&description, &scene, &job(Strategy { max_depth: u32::MAX, ..strategy }));
        for technique in limited.techniques() {
            let [a, b] = [&limited, &unlimited].map(|pyramid| pyramid.develop(technique));
            for (a, b) in a[0].pixels.iter().chain(&a[1].pixels).zip(b[0].pixels.iter().chain(&b[1].pixels)) {
                assert!((0..3).all(|band| (a[band] - b[band]).abs() <= 1e-5 * a[band].abs().max(1e-3)), "{technique:?} {a:?} {b:?}");
            }
        }
    }

    #[test]
    fn techniques_that_are_said_to_be_impossible_are_black_and_others_are_not() {
        for (lens, lamp) in [("thinlens", "area"), ("perspective", "area"), ("perspective", "point")] {
            let mut text = ROOM.replace("thinlens", lens);
            if lens == "perspective" {
                text = text.replace("<float name=\"aperture_radius\" value=\"0.1\"/><float name=\"focus_distance\" value=\"3\"/>", "");
            }
            if lamp == "point" {
                text = text.replace("<emitter type=\"area\"><rgb name=\"radiance\" value=\"5\"/></emitter>", "");
                text = text.replace("</scene>", "<emitter type=\"point\"><point name=\"position\" value=\"0, 1, 1\"/></emitter></scene>");
            }
            let mut description = load_str(&text, Path::new("room.xml"), None, &[], &Library::default()).unwrap().description;
            limit(&mut description, 4);
            let scene = Scene::new(&description).unwrap();
            let job = Job { target: Target::Samples(64), ..job(Stage::BIDIRECTIONAL.strategy(&description.integrator)) };
            let pyramid = pyramid(&description, &scene, &job);
            let effects = Effects::of(&description, &scene);
            for technique in pyramid.techniques() {
                let black = pyramid.develop(technique)[1].pixels.iter().all(|pixel| *pixel == [0.0; 3]);
                // The lamp stands above what the lens sees at first, and light seldom lands on a lens so small.
                if technique.length() > 1 && technique.t > 0 || !exists(&effects, technique) {
                    assert_eq!(black, !exists(&effects, technique), "{lens}, {lamp}: {technique:?}");
                }
            }
        }
    }

    #[test]
    fn a_file_is_no_folder() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("taken");
        fs::write(&file, "").unwrap();
        assert!(prepare(&file).unwrap_err().to_string().contains("this is a file"));
        assert!(prepare(&file.join("below")).is_err());
        assert!(prepare(&folder.path().join("new/one")).is_ok());
    }
}
