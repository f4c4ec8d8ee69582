//! The `bidir` program with plugins that fail while it renders.

use std::{
    fs,
    process::{Command, Output},
};

use bidir::image::read;
use tempfile::TempDir;

const HARM: &str = include_str!("../../tests/hostile/modules/harm.wat");
const NAN: &str = include_str!("../../tests/hostile/modules/nan.wat");

/// A folder with a scene of one shape in its lower right corner, of this material, under an even sky.
fn desk(material: &str) -> TempDir {
    let desk = tempfile::tempdir().expect("a folder");
    for (name, text) in [("harm.wasm", HARM), ("nan.wasm", NAN)] {
        fs::write(desk.path().join(name), wat::parse_str(text).expect("a module")).expect("a file");
    }
    let scene = format!(
        r#"<scene version="3.0.0"><emitter type="constant"/>
<sensor type="orthographic"><film type="hdrfilm"><integer name="width" value="64"/><integer name="height" value="64"/></film>
<transform name="to_world"><lookat origin="0, 0, 4" target="0, 0, 0" up="0, 1, 0"/></transform></sensor>
<shape type="rectangle"><transform name="to_world"><scale value="0.2"/><translate x="0.75" y="-0.75"/></transform>{material}</shape>
<shape type="rectangle"><transform name="to_world"><scale value="0.2"/><translate x="-0.75" y="-0.75"/></transform>{material}</shape></scene>"#
    );
    fs::write(desk.path().join("scene.xml"), scene).expect("a scene");
    desk
}

fn render(desk: &TempDir, more: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_bidir"));
    command.current_dir(desk.path()).args([
        "render",
        "scene.xml",
        "-o",
        "out.exr",
        "--spp",
        "4",
        "--threads",
        "1",
        "--quiet",
        "--integrator",
        "path",
    ]);
    command.args(["--stats", "stats.json"]).args(more).output().expect("the program")
}

fn says(output: &Output, status: i32, words: &[&str]) {
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(status), "{said}");
    assert!(!said.contains("panicked"), "{said}");
    for word in words {
        assert!(said.contains(word), "\"{word}\" is not in: {said}");
    }
}

/// The picture's upper left pixel, where there is nothing but sky.
fn sky(desk: &TempDir) -> [f32; 3] {
    read::read(&desk.path().join("out.exr"), read::Encoding::Srgb).expect("an image").values[0].0
}

fn quarantined(desk: &TempDir) -> u64 {
    let text = fs::read_to_string(desk.path().join("stats.json")).expect("statistics");
    let stats: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    stats["quarantined"].as_u64().expect("a count")
}

fn harm(eval: i32, sample: i32) -> TempDir {
    desk(&format!(r#"<bsdf type="harm"><integer name="eval" value="{eval}"/><integer name="sample" value="{sample}"/></bsdf>"#))
}

#[test]
fn a_plugin_that_does_not_end_ends_the_render_with_status_3_and_what_was_rendered() {
    let desk = harm(1, 1);
    says(&render(&desk, &[]), 3, &["error: ", "harm.wasm: bsdf_", "one call ran for more than 50 ms", "what was rendered before is saved"]);
    assert!(sky(&desk).iter().all(|value| *value > 0.5), "{:?}", sky(&desk));
}

#[test]
fn a_plugin_that_traps_ends_the_render_with_status_3_and_what_was_rendered() {
    let desk = harm(2, 4);
    says(&render(&desk, &[]), 3, &["error: ", "harm.wasm: bsdf_", "what was rendered before is saved"]);
    assert!(sky(&desk).iter().all(|value| *value > 0.5), "{:?}", sky(&desk));
}

#[test]
fn bad_answers_leave_status_0_and_a_warning_with_their_count() {
    let desk = desk(r#"<bsdf type="nan"/>"#);
    says(&render(&desk, &[]), 0, &["warning: ", "nan.wasm: bsdf_", "bad answers were left out; the first: ", "NaN", "wo = ["]);
    assert!(quarantined(&desk) > 0);
}

#[test]
fn the_first_bad_answer_ends_a_strict_render_with_status_3() {
    let desk = desk(r#"<bsdf type="nan"/>"#);
    says(&render(&desk, &["--strict"]), 3, &["error: ", "nan.wasm: bsdf_", "NaN", "render without --strict"]);
    assert!(sky(&desk).iter().all(|value| *value > 0.5), "{:?}", sky(&desk));
}

#[test]
fn a_plugin_that_traps_while_it_is_loaded_is_bad_input_and_leaves_no_image() {
    let desk = desk(r#"<bsdf type="harm.wasm"/>"#);
    let bad = HARM.replacen("i32.const 65536", "unreachable", 1);
    fs::write(desk.path().join("harm.wasm"), wat::parse_str(bad).expect("a module")).expect("a file");
    says(&render(&desk, &[]), 1, &["error: ", "harm.wasm: bidir_abi: it gave up"]);
    assert!(!desk.path().join("out.exr").exists());
}
