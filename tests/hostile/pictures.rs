//! Renders with bad plugins in them (rows 65 and 68): named, and the rest of the picture is what it would have been.

use std::{fs, path::Path, sync::atomic::AtomicBool};

use bidir::{film::Film, image::Image, plugin::Strictness, render};
use bidir_kernel::Heuristic;
use tempfile::TempDir;

use super::{GOOD, assembled};
use crate::{pictures::PATH, scenes};

const NAN: &str = include_str!("modules/nan.wat");
const REMEMBERS: &str = include_str!("modules/remembers.wat");

fn folder(modules: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, text) in modules {
        fs::write(folder.path().join(name), assembled(text)).expect("a module");
    }
    folder
}

const GOOD_ONES: [&str; 9] =
    ["conductor", "dielectric", "diffuse", "leaf", "null", "plastic", "roughconductor", "roughdielectric", "thindielectric"];

/// Eleven upright strips side by side under an even sky, each 4 × 4 pixels, of these materials.
fn strips(materials: &[String; 11]) -> String {
    let strip = |(i, material): (usize, &String)| {
        let transform = format!(r#"<scale x="0.5" y="0.5"/><translate x="{}"/>"#, i as f64 - 5.0);
        scenes::shape("rectangle", &transform, &scenes::bsdf(material, ""))
    };
    let film = scenes::film_with(44, 4, r#"<rfilter type="box"/>"#);
    let sensor = format!(
        r#"<sensor type="orthographic">{film}<transform name="to_world"><scale value="5.5"/><lookat origin="0, 0, 4" target="0, 0, 0" up="0, 1, 0"/></transform></sensor>"#
    );
    let strips: String = materials.iter().enumerate().map(strip).collect();
    format!("{}{sensor}{strips}{}", scenes::depth(3), scenes::emitter("constant", ""))
}

fn render(content: &str, folder: &Path, threads: usize) -> (Image, render::Status) {
    let subject = scenes::read_beside(content, Some(folder));
    let film = Film::new(&subject.description.film).expect("a film");
    let job = render::Job { threads, strictness: Strictness::Lenient, ..subject.job(subject.strategy(PATH, Heuristic::Balance), 16, 1) };
    let status = render::render(&subject.scene, &film, &job, &AtomicBool::new(false), |_| None);
    assert_eq!(film.refused(), 0);
    (film.develop(), status)
}

#[test]
fn one_bad_plugin_among_ten_good_ones_is_named_and_harms_no_other() {
    let folder = folder(&[("good.wasm", GOOD), ("nan.wasm", NAN)]);
    for name in GOOD_ONES {
        let file = format!("{name}.wasm");
        fs::copy(Path::new(env!("CARGO_MANIFEST_DIR")).join("../plugins/prebuilt").join(&file), folder.path().join(&file))
            .expect("a module");
    }
    let mut materials: [String; 11] = std::array::from_fn(|i| format!("{}.wasm", GOOD_ONES.get(i).unwrap_or(&"good")));
    let (expected, status) = render(&strips(&materials), folder.path(), 2);
    assert!(status.quarantine.0.is_empty() && status.fault.is_none(), "{status:?}");
    materials[5] = "nan.wasm".to_owned();
    let (got, status) = render(&strips(&materials), folder.path(), 2);
    assert!(status.fault.is_none() && !status.failed && status.samples == 16, "{status:?}");
    assert!(!status.quarantine.0.is_empty());
    for entry in &status.quarantine.0 {
        assert!(entry.file.ends_with("nan.wasm"), "{entry}");
    }
    for (i, (expected, got)) in expected.pixels.iter().zip(&got.pixels).enumerate() {
        let strip = i % 44 / 4;
        assert!(got.iter().all(|value| value.is_finite()));
        if strip == 5 {
            assert_eq!(*got, [0.0; 3], "what nan.wasm says is left out");
        } else {
            assert_eq!(got, expected, "pixel {i} of strip {strip}, {}", materials[strip]);
        }
    }
}

#[test]
fn a_plugin_that_remembers_gives_one_image_at_any_number_of_threads() {
    let folder = folder(&[("remembers.wasm", REMEMBERS)]);
    let room = format!(
        "{}{}{}{}{}",
        scenes::depth(6),
        scenes::camera("perspective", &scenes::film(48)),
        scenes::room(),
        scenes::panel(),
        scenes::ball(&scenes::bsdf("remembers", ""))
    );
    let (one, _) = render(&room, folder.path(), 1);
    assert!(one.pixels.iter().any(|pixel| pixel[0] > 0.0));
    for threads in [2, 3] {
        assert_eq!(render(&room, folder.path(), threads).0.pixels, one.pixels, "{threads} threads");
    }
}
