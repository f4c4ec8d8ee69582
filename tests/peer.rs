//! The scenes of `tests/peer`, one or more for each plugin of the scene language, against what Mitsuba 3.9.1 makes of them.
//!
//! Each is rendered by path tracing and by all techniques. The whole mean must lie within 1 % of the reference's, and each block of 8×8
//! pixels as near to it as chance explains.

use std::path::{Path, PathBuf};

use bidir::{
    image::{Image, read},
    load,
    plugin::Library,
    render,
    scene::Scene,
};
use bidir_kernel::Heuristic;

use crate::{
    pictures::{BDPT, PATH, Pictures, Region, Subject, leave},
    statistics::{threshold, worse},
};

/// Pixels of a side.
const SIZE: u32 = 32;

/// Samples per pixel of each batch.
const SAMPLES: u32 = 16;

/// How far apart the whole means may be.
const WITHIN: f64 = 0.01;

/// Half floats are rounded by up to so much.
const ROUNDING: f64 = 5e-4;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("peer")
}

/// The two halves of a reference, which lie one below the other.
fn halves(name: &str) -> Pictures {
    let both = read::picture(&folder().join(format!("{name}.exr"))).expect("a reference");
    assert_eq!([both.width, both.height], [SIZE, 2 * SIZE]);
    let half = |first: u32| {
        let mut half = Image::black(SIZE, SIZE);
        let pixels = (first * SIZE * SIZE) as usize..((first + 1) * SIZE * SIZE) as usize;
        half.pixels.copy_from_slice(&both.pixels[pixels]);
        half
    };
    Pictures { batches: vec![half(0), half(1)] }
}

fn blocks() -> impl Iterator<Item = Region> {
    (0..16).map(|i| [i % 4 * 8, i / 4 * 8, 8, 8])
}

fn matches(name: &str) {
    let description = load::load(&folder().join(format!("{name}.xml")), &[], &Library::default()).expect("a scene").description;
    let subject = Subject { scene: Scene::new(&description).expect("a scene"), description };
    let reference = halves(name);
    let bands = &[0, 1, 2];
    for (estimator, techniques) in [("path", PATH), ("bdpt", BDPT)] {
        let found = subject.pictures(subject.strategy(techniques, Heuristic::Balance), SAMPLES, 1);
        let (whole, wanted) = (found.mean(found.whole(), bands), reference.mean(reference.whole(), bands));
        let (apart, doubt) = (whole.mean / wanted.mean - 1.0, whole.error / wanted.mean);
        let deviation = |block| {
            let (x, r) = (found.mean(block, bands), reference.mean(block, bands));
            let apart = x.minus(&r);
            let rounding = ROUNDING * r.mean;
            // What is black is black.
            (if apart.mean == 0.0 { 0.0 } else { apart.mean.abs() / apart.error.hypot(rounding) }, apart.degrees)
        };
        let limit = |degrees| threshold(2 * blocks().count(), degrees);
        let worst = blocks().map(deviation).map(|(deviation, degrees)| deviation / limit(degrees)).fold(0.0, worse);
        println!(
            "{name}, {estimator}: {:.5} for {:.5}, {:+.2} % ± {:.2} %, worst block {worst:.2} of what chance explains",
            whole.mean,
            wanted.mean,
            100.0 * apart,
            100.0 * doubt
        );
        if !(apart.abs() < WITHIN.max(4.0 * doubt) && doubt < WITHIN && worst < 1.0) {
            let folder = leave(&format!("{name}_{estimator}"), &[(estimator, &found.average()), ("reference", &reference.average())]);
            panic!("{name}, {estimator}; pictures are in {}", folder.display());
        }
    }
}

macro_rules! rows {
    ($($name:ident)*) => {
        $(
            #[test]
            fn $name() {
                matches(stringify!($name));
            }
        )*

        const NAMES: &[&str] = &[$(stringify!($name)),*];
    };
}

rows! {
    bsdf_blendbsdf
    bsdf_bumpmap
    bsdf_bumpmap_rectangle
    bsdf_conductor
    bsdf_dielectric
    bsdf_diffuse
    bsdf_mask
    bsdf_normalmap
    bsdf_null
    bsdf_plastic
    bsdf_plastic_nonlinear
    bsdf_principled
    bsdf_principled_cloth
    bsdf_principled_glass
    bsdf_principled_metal
    bsdf_principledthin
    bsdf_principledthin_leaf
    bsdf_roughconductor
    bsdf_roughdielectric
    bsdf_roughplastic
    bsdf_roughplastic_nonlinear
    bsdf_thindielectric
    bsdf_twosided
    emitter_area
    emitter_area_mesh
    emitter_area_textured
    emitter_constant
    emitter_directional
    emitter_envmap
    emitter_point
    emitter_spot
    film_hdrfilm
    integrator_aov
    integrator_direct
    integrator_path
    integrator_ptracer
    integrator_volpath
    integrator_volpathmis
    rfilter_box
    rfilter_catmullrom
    rfilter_gaussian
    rfilter_lanczos
    rfilter_mitchell
    rfilter_tent
    scene_0_6
    sensor_orthographic
    sensor_perspective
    sensor_thinlens
    shape_cube
    shape_cylinder
    shape_cylinder_mirrored
    shape_disk
    shape_instance
    shape_merge
    shape_obj
    shape_ply
    shape_rectangle
    shape_serialized
    shape_sphere
    texture_bitmap
    texture_checkerboard
    texture_mesh_attribute
}

/// Layers beside the picture, block by block: what the lens meets first has no noise but that of edges.
#[test]
fn layers_of_an_aov_are_mitsubas() {
    let description = load::load(&folder().join("integrator_aov.xml"), &[], &Library::default()).expect("a scene").description;
    let subject = Subject { scene: Scene::new(&description).expect("a scene"), description };
    let all = read::picture(&folder().join("integrator_aov.layers.exr")).expect("a reference");
    let aovs = &subject.description.integrator.aovs;
    assert_eq!([all.width, all.height], [SIZE, aovs.len() as u32 * SIZE]);
    let job = subject.job(subject.strategy(PATH, Heuristic::Balance), 1, 1);
    let quantities: Vec<_> = aovs.iter().map(|aov| aov.of).collect();
    let layers = render::features(&subject.scene, &subject.description.film, &job, &quantities, 64, &false.into()).expect("layers");
    for (number, (aov, found)) in aovs.iter().zip(layers).enumerate() {
        for [left, top, width, height] in blocks() {
            let mean = |image: &Image, down: u32, band: usize| {
                let pixels = (0..width * height).map(|i| image.at(left + i % width, down + top + i / width)[band]);
                f64::from(pixels.sum::<f32>()) / f64::from(width * height)
            };
            for band in 0..aov.channels().len() {
                let (a, b) = (mean(&found, 0, band), mean(&all, number as u32 * SIZE, band));
                assert!((a - b).abs() < 0.01 + 0.005 * b.abs(), "{} at {left}, {top}, band {band}: {a} for {b}", aov.of.name());
            }
        }
    }
}

#[test]
fn every_scene_of_the_folder_is_a_test() {
    let files = std::fs::read_dir(folder()).expect("a folder").map(|entry| entry.expect("a file").path());
    let scenes = files.filter(|file| file.extension().is_some_and(|ending| ending == "xml"));
    let mut names: Vec<String> = scenes.map(|file| file.file_stem().expect("a name").to_string_lossy().into_owned()).collect();
    names.sort_unstable();
    assert_eq!(names, NAMES);
}
