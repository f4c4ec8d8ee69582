//! The `bidir` program as a user meets it.

use std::{
    fs,
    io::{BufRead, BufReader},
    path::{Path, PathBuf},
    process::{Command, Output, Stdio},
    time::{Duration, Instant},
};

use bidir::image::{Image, read};
use tempfile::TempDir;

/// A folder with a good scene in it.
struct Desk {
    folder: TempDir,
}

const SENSOR: &str = r#"<sensor type="perspective"><film type="hdrfilm"><integer name="width" value="$res"/><integer name="height" value="$res"/></film></sensor>"#;
const LIGHT: &str = r#"<emitter type="constant"/>"#;

impl Desk {
    fn new() -> Self {
        let desk = Self { folder: tempfile::tempdir().expect("a folder") };
        desk.scene("good.xml", &format!("{SENSOR}{LIGHT}"));
        desk
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn scene(&self, name: &str, content: &str) {
        let text = format!("<scene version=\"3.0.0\">\n<default name=\"res\" value=\"8\"/>\n{content}\n</scene>\n");
        fs::write(self.path(name), text).expect("a scene");
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_bidir"));
        command.current_dir(self.folder.path()).args(arguments);
        command
    }

    fn run(&self, arguments: &[&str]) -> Output {
        self.command(arguments).output().expect("the program")
    }

    fn names(&self) -> Vec<String> {
        let entry = |entry: std::io::Result<fs::DirEntry>| entry.expect("an entry").file_name().to_string_lossy().into_owned();
        let mut names: Vec<_> = fs::read_dir(self.folder.path()).expect("the folder").map(entry).collect();
        names.sort();
        names
    }

    /// Bad input: status 1, one line that begins with `error:` and holds `words`, and nothing new in the folder.
    fn refuses(&self, arguments: &[&str], words: &[&str]) {
        let before = self.names();
        let output = self.run(arguments);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {said}");
        let lines: Vec<_> = said.lines().filter(|line| !line.starts_with("warning: ")).collect();
        assert!(lines.len() == 1 && lines[0].starts_with("error: "), "{arguments:?}: {said}");
        assert!(!said.contains("panicked") && output.stdout.is_empty(), "{said}");
        // A remedy follows the thing.
        assert!(lines[0].contains("; "), "{said}");
        for word in words {
            assert!(said.contains(word), "{arguments:?}: \"{word}\" is not in: {said}");
        }
        assert_eq!(self.names(), before, "{arguments:?} left something behind");
    }

    /// A scene that is wrong in one place.
    fn refuses_scene(&self, content: &str, words: &[&str]) {
        self.scene("bad.xml", content);
        self.refuses(&["render", "bad.xml", "-o", "out.exr", "--spp", "1"], words);
    }
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn image(path: &Path) -> Image {
    read::picture(path).expect("an image")
}

fn film(content: &str) -> String {
    format!(r#"<sensor type="perspective"><film type="hdrfilm">{content}</film></sensor>{LIGHT}"#)
}

fn mesh(file: &str) -> String {
    format!(r#"{SENSOR}{LIGHT}<shape type="obj"><string name="filename" value="{file}"/></shape>"#)
}

#[test]
fn a_scene_that_is_not_there_is_an_error() {
    Desk::new().refuses(&["render", "nowhere.xml", "-o", "out.exr"], &["nowhere.xml"]);
}

#[test]
fn a_folder_is_no_scene() {
    let desk = Desk::new();
    fs::create_dir(desk.path("folder")).expect("a folder");
    desk.refuses(&["render", "folder", "-o", "out.exr"], &["folder"]);
}

#[test]
fn broken_xml_is_an_error_at_its_place() {
    let desk = Desk::new();
    fs::write(desk.path("bad.xml"), "<scene version=\"3.0.0\">\n<sensor type=\"perspective\">\n</scene>").expect("a file");
    desk.refuses(&["render", "bad.xml", "-o", "out.exr"], &["bad.xml:3:"]);
}

#[test]
fn an_unknown_type_is_an_error_with_a_likely_name() {
    let bad = format!(r#"{SENSOR}{LIGHT}<bsdf type="ruffconductor"/>"#);
    Desk::new().refuses_scene(&bad, &["bad.xml:3:", "ruffconductor", "roughconductor"]);
}

#[test]
fn a_mesh_that_is_not_there_is_an_error() {
    Desk::new().refuses_scene(&mesh("nowhere.obj"), &["bad.xml:3:", "nowhere.obj"]);
}

#[test]
fn a_mesh_that_is_not_a_number_is_an_error() {
    let desk = Desk::new();
    fs::write(desk.path("bad.obj"), "v 0 0 0\nv NaN 0 0\nv 0 1 0\nf 1 2 3\n").expect("a mesh");
    desk.refuses_scene(&mesh("bad.obj"), &["bad.obj"]);
}

#[test]
fn a_film_without_pixels_is_an_error() {
    Desk::new().refuses_scene(&film(r#"<integer name="width" value="0"/>"#), &["bad.xml:3:", "width"]);
}

#[test]
fn a_crop_window_without_pixels_is_an_error() {
    let crop = r#"<integer name="crop_width" value="0"/><integer name="crop_height" value="0"/>"#;
    Desk::new().refuses_scene(&film(crop), &["bad.xml:3:", "crop_"]);
}

#[test]
fn a_film_beyond_all_memory_is_an_error() {
    let sides = r#"<integer name="width" value="1000000000"/><integer name="height" value="1000000000"/>"#;
    Desk::new().refuses_scene(&film(sides), &["bad.xml:3:", "1000000000"]);
}

#[test]
fn a_texture_of_text_is_an_error() {
    let desk = Desk::new();
    fs::write(desk.path("text.png"), "this is text\n").expect("a file");
    let texture =
        r#"<bsdf type="diffuse"><texture name="reflectance" type="bitmap"><string name="filename" value="text.png"/></texture></bsdf>"#;
    desk.refuses_scene(&format!("{SENSOR}{LIGHT}{texture}"), &["bad.xml:3:", "text.png"]);
}

#[test]
fn an_output_that_cannot_be_written_is_an_error_before_the_render() {
    let desk = Desk::new();
    let start = Instant::now();
    for output in ["no/such/folder/out.exr", "out.tiff", "out", "."] {
        desk.refuses(&["render", "good.xml", "-o", output, "--spp", "1000000"], &[output]);
    }
    assert!(start.elapsed() < Duration::from_secs(20));
}

#[test]
fn a_plan_that_is_none_is_an_error() {
    let desk = Desk::new();
    fs::write(desk.path("plan.json"), "{}").expect("a file");
    desk.refuses(&["render", "good.xml", "-o", "out.exr", "--plan", "plan.json"], &["plan.json"]);
    desk.refuses(&["render", "good.xml", "-o", "out.exr", "--plan", "nowhere.json"], &["nowhere.json"]);
}

#[test]
fn what_cannot_be_meant_is_a_usage_error() {
    let desk = Desk::new();
    let before = desk.names();
    let usages: [&[&str]; 9] = [
        &[],
        &["paint"],
        &["render", "good.xml", "--colour", "red"],
        &["render", "good.xml", "--spp", "0"],
        &["render", "good.xml", "--time", "-1"],
        &["render", "good.xml", "--error", "nan"],
        &["render", "good.xml", "--spp", "1", "--time", "1"],
        &["render", "good.xml", "--integrator", "magic"],
        &["render", "good.xml", "--define", "res"],
    ];
    for arguments in usages {
        let output = desk.run(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", text(&output.stderr));
    }
    assert_eq!(desk.names(), before);
}

#[test]
fn help_and_version_are_no_errors() {
    for argument in ["--help", "--version"] {
        assert_eq!(Desk::new().run(&[argument]).status.code(), Some(0));
    }
}

/// Ctrl-C in the middle of a long render: every pixel has as many samples, so that the picture is one of fewer samples.
#[cfg(unix)]
#[test]
fn ctrl_c_saves_what_was_rendered() {
    let desk = Desk::new();
    let arguments = [
        "render",
        "good.xml",
        "-o",
        "out.exr",
        "--spp",
        "100000000",
        "--stats",
        "stats.json",
        "--integrator",
        "path",
        "--define",
        "res=64",
    ];
    let mut child = desk.command(&arguments).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("the program");
    // It tells of its first pass as soon as that is done.
    let mut progress = BufReader::new(child.stderr.take().expect("its standard error"));
    let mut line = String::new();
    progress.read_line(&mut line).expect("a line");
    assert!(line.contains("spp"), "{line}");
    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill");
    assert!(sent.success());
    assert_eq!(child.wait().expect("an end").code(), Some(130));
    let stats: serde_json::Value = serde_json::from_str(&fs::read_to_string(desk.path("stats.json")).expect("statistics")).expect("JSON");
    assert_eq!(stats["interrupted"], true);
    let spp = stats["spp"].as_u64().expect("a number");
    assert!((1..100_000_000).contains(&spp));
    let picture = image(&desk.path("out.exr"));
    assert_eq!((picture.width, picture.height), (64, 64));
    assert!(picture.pixels.iter().all(|pixel| pixel.iter().all(|v| (v - 1.0).abs() < 1e-5)));
    assert!(desk.names().iter().all(|name| !name.contains("partial")));
}

#[test]
fn statistics_hold_what_was_promised() {
    let desk = Desk::new();
    let output = desk.run(&["render", "good.xml", "-o", "out.exr", "--spp", "3", "--stats", "stats.json", "--threads", "2", "--seed", "5"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let stats: serde_json::Value = serde_json::from_str(&fs::read_to_string(desk.path("stats.json")).expect("statistics")).expect("JSON");
    for key in ["/seconds/load", "/seconds/build", "/seconds/plan", "/seconds/render", "/seconds/total", "/cpu_seconds/render"] {
        assert!(stats.pointer(key).and_then(serde_json::Value::as_f64).is_some_and(|v| v >= 0.0), "{key}");
    }
    for key in ["/rays/closest", "/rays/any", "/quarantined"] {
        assert!(stats.pointer(key).and_then(serde_json::Value::as_u64).is_some(), "{key}");
    }
    let wanted = [("spp", 3), ("width", 8), ("height", 8), ("camera_paths", 192), ("threads", 2), ("seed", 5)];
    for (key, value) in wanted {
        assert_eq!(stats[key], value, "{key}");
    }
    assert!(stats["plan"].is_object() && stats["version"].is_string() && stats["integrator"] == "auto");
    let walks = stats.pointer("/plan/stages/0/lens_splat").and_then(serde_json::Value::as_f64).expect("a count");
    assert_eq!(stats["light_paths"].as_u64(), Some((192.0 * walks) as u64));
}

/// The plan in the statistics is one that `--plan` takes, and makes the same bits.
#[test]
fn a_plan_repeats_a_render() {
    let desk = Desk::new();
    let first = desk.run(&["render", "good.xml", "-o", "a.exr", "--stats", "stats.json"]);
    assert!(first.status.success() && text(&first.stdout).contains("plan: camera paths"), "{}", text(&first.stdout));
    let stats: serde_json::Value = serde_json::from_str(&fs::read_to_string(desk.path("stats.json")).expect("statistics")).expect("JSON");
    fs::write(desk.path("plan.json"), stats["plan"].to_string()).expect("a plan");
    assert!(desk.run(&["render", "good.xml", "-o", "b.exr", "--plan", "plan.json"]).status.success());
    assert_eq!(image(&desk.path("a.exr")), image(&desk.path("b.exr")));
}

/// Passes grow by a quarter, so the last one may end late by as much; and a busy machine may be slow to begin.
#[test]
fn a_time_limit_is_kept() {
    let desk = Desk::new();
    let output = desk.run(&["render", "good.xml", "-o", "out.exr", "--time", "1", "--stats", "stats.json"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let stats: serde_json::Value = serde_json::from_str(&fs::read_to_string(desk.path("stats.json")).expect("statistics")).expect("JSON");
    let seconds: f64 = ["render", "plan"].map(|part| stats["seconds"][part].as_f64().expect("a number")).iter().sum();
    assert!((1.0..3.0).contains(&seconds), "{seconds} s");
}

#[test]
fn an_error_goal_is_reached() {
    let desk = Desk::new();
    let lamp = r#"<shape type="sphere"><transform name="to_world"><translate value="0.5, 0.5, 4"/></transform></shape>"#;
    desk.scene("ball.xml", &format!("{SENSOR}{LIGHT}{lamp}"));
    let output = desk.run(&["render", "ball.xml", "-o", "out.exr", "--error", "1e-3", "--stats", "stats.json", "--define", "res=32"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let stats: serde_json::Value = serde_json::from_str(&fs::read_to_string(desk.path("stats.json")).expect("statistics")).expect("JSON");
    assert!(stats["estimated_error"].as_f64().expect("a number") <= 1e-3 && stats["spp"].as_u64().expect("a number") >= 2);
    // And that is what another render says of it.
    assert!(desk.run(&["render", "ball.xml", "-o", "better.exr", "--spp", "4096", "--seed", "9", "--define", "res=32"]).status.success());
    let compared = desk.run(&["compare", "out.exr", "better.exr", "--json"]);
    let comparison: serde_json::Value = serde_json::from_slice(&compared.stdout).expect("JSON");
    assert!(comparison["relmse_trimmed"].as_f64().expect("a number") < 3e-3, "{comparison}");
}

#[test]
fn without_a_scene_there_is_a_picture_and_its_path_comes_last() {
    let desk = Desk::new();
    let output = desk.run(&["render", "--spp", "1", "--define", "res=32"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let said = text(&output.stdout);
    let word = said.lines().last().and_then(|line| line.split_whitespace().last()).expect("a last word");
    let picture = image(&desk.path(word));
    assert_eq!((picture.width, picture.height), (32, 32));
}

#[test]
fn every_format_holds_the_same_picture() {
    let desk = Desk::new();
    for name in ["a.exr", "a.hdr", "a.png"] {
        assert!(desk.run(&["render", "good.xml", "-o", name, "--spp", "2", "--quiet"]).status.success());
        let picture = image(&desk.path(name));
        assert!(picture.pixels.iter().all(|pixel| pixel.iter().all(|v| (v - 1.0).abs() < 0.5)), "{name}");
    }
}

#[test]
fn comparing_prints_for_people_and_for_programs() {
    let desk = Desk::new();
    for (name, seed) in [("a.exr", "1"), ("b.exr", "2")] {
        assert!(desk.run(&["render", "good.xml", "-o", name, "--seed", seed]).status.success());
    }
    let said = text(&desk.run(&["compare", "a.exr", "b.exr"]).stdout);
    assert!(["relMSE", "SMAPE", "mean bias", "worst block"].iter().all(|word| said.contains(word)), "{said}");
    let output = desk.run(&["compare", "a.exr", "a.exr", "--json"]);
    let comparison: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(comparison["relmse"], 0.0);
    assert!(comparison["worst_block"]["deviation"].is_number());
    desk.refuses(&["compare", "a.exr", "nowhere.exr"], &["nowhere.exr"]);
    assert!(desk.run(&["render", "good.xml", "-o", "small.exr", "--define", "res=4"]).status.success());
    desk.refuses(&["compare", "a.exr", "small.exr"], &["8×8", "4×4"]);
}

#[test]
fn a_depth_limit_beats_the_scenes() {
    let desk = Desk::new();
    assert!(desk.run(&["render", "good.xml", "-o", "black.exr", "--max-depth", "0"]).status.success());
    assert!(image(&desk.path("black.exr")).pixels.iter().all(|&pixel| pixel == [0.0; 3]));
}

/// The committed modules.
fn prebuilt() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../plugins/prebuilt")
}

fn json(output: &Output) -> serde_json::Value {
    serde_json::from_slice(&output.stdout).expect("JSON")
}

#[test]
fn a_plugin_cannot_have_any_name() {
    let desk = Desk::new();
    for name in ["Velvet", "my_velvet", "2ply", "a/b", "", "über", "diffuse", "area", "self"] {
        desk.refuses(&["plugin", "new", name, "--kind", "bsdf", "--language", "c"], &[&format!("\"{name}\"")]);
    }
}

#[test]
fn a_new_plugin_writes_over_nothing() {
    let desk = Desk::new();
    fs::create_dir(desk.path("chalk")).expect("a folder");
    fs::write(desk.path("chalk/notes.txt"), "mine").expect("a file");
    desk.refuses(&["plugin", "new", "chalk", "--kind", "bsdf", "--language", "zig"], &["chalk", "not empty"]);
    desk.refuses(&["plugin", "new", "chalk", "--kind", "bsdf", "--language", "zig", "-o", "good.xml"], &["good.xml"]);
    assert_eq!(fs::read_dir(desk.path("chalk")).expect("a folder").count(), 1);
}

#[test]
fn a_new_plugin_has_its_files_in_every_language() {
    let desk = Desk::new();
    let sources = [("rust", "src/lib.rs"), ("c", "shader.c"), ("assemblyscript", "shader.ts"), ("zig", "shader.zig")];
    for (language, source) in sources {
        for kind in ["bsdf", "light"] {
            let folder = format!("{language}-{kind}");
            let output = desk.run(&["plugin", "new", "chalk", "--kind", kind, "--language", language, "-o", &folder]);
            assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
            assert_eq!(text(&output.stdout).split_whitespace().last(), Some(folder.as_str()));
            for file in [source, "build.sh", "README.md", "scene.xml", ".gitignore"] {
                assert!(desk.path(&folder).join(file).is_file(), "{folder}/{file}");
            }
        }
    }
}

#[test]
fn a_rust_project_names_the_sdk_it_was_given() {
    let desk = Desk::new();
    let begin = ["plugin", "new", "chalk", "--kind", "bsdf", "--language", "rust", "--sdk"];
    desk.refuses(&[&begin[..], &["nowhere"]].concat(), &["nowhere", "--sdk"]);
    fs::create_dir(desk.path("kit")).expect("a folder");
    fs::write(desk.path("kit/Cargo.toml"), "").expect("a file");
    assert_eq!(desk.run(&[&begin[..], &["kit"]].concat()).status.code(), Some(0));
    let manifest = fs::read_to_string(desk.path("chalk/Cargo.toml")).expect("a manifest");
    let kit = desk.path("kit").canonicalize().expect("a path");
    assert!(manifest.contains(&format!("path = \"{}\"", kit.display())), "{manifest}");
}

#[test]
fn the_list_of_plugins_says_what_each_is() {
    let desk = Desk::new();
    let folder = prebuilt().display().to_string();
    let output = desk.run(&["plugin", "list", &folder]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let said = text(&output.stdout);
    let line = said.lines().find(|line| line.starts_with("roughconductor ")).expect("a line");
    assert!(line.contains("bsdf") && line.contains("glossy_reflection"), "{line}");
    let same = desk.command(&["plugin", "list", "--json"]).env("BIDIR_PLUGINS", &folder).output().expect("the program");
    let listed = json(&same);
    assert_eq!(listed.as_array().expect("a list").len(), said.lines().count());
}

#[test]
fn a_refused_plugin_does_not_hide_the_others() {
    let desk = Desk::new();
    fs::write(desk.path("broken.wasm"), "no module").expect("a file");
    fs::copy(prebuilt().join("diffuse.wasm"), desk.path("matt.wasm")).expect("a copy");
    let output = desk.run(&["plugin", "list"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stdout).starts_with("matt "), "{}", text(&output.stdout));
    let said = text(&output.stderr);
    assert!(said.lines().count() == 1 && said.starts_with("error: ") && said.contains("broken.wasm"), "{said}");
}

#[test]
fn inspecting_a_plugin_tells_its_parameters_and_its_times() {
    let desk = Desk::new();
    for (name, exports) in [("roughconductor", ["bsdf_eval", "bsdf_sample"]), ("spot", ["light_eval", "light_emit"])] {
        let file = prebuilt().join(format!("{name}.wasm")).display().to_string();
        let output = desk.run(&["plugin", "inspect", &file, "--json"]);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        assert!(output.stderr.is_empty(), "{}", text(&output.stderr));
        let report = json(&output);
        assert_eq!((&report["type"], &report["abi"]), (&name.into(), &"1.0".into()));
        assert_eq!(report["bytes"], fs::metadata(&file).expect("a file").len());
        for (at, export) in exports.into_iter().enumerate() {
            assert_eq!(report["timing"]["calls"][at]["export"], export);
            let nanoseconds = report["timing"]["calls"][at]["nanoseconds"].as_f64().expect("a number");
            assert!(nanoseconds > 1.0 && nanoseconds < 1e6, "{name} {export}: {nanoseconds}");
        }
        assert!(report["timing"]["instantiation_microseconds"].as_f64().expect("a number") > 0.0);
        let words = text(&desk.run(&["plugin", "inspect", &file]).stdout);
        for parameter in report["manifest"]["params"].as_array().expect("parameters") {
            let parameter = format!("\n  {} ", parameter["name"].as_str().expect("a name"));
            assert!(words.contains(&parameter), "{parameter} is not in: {words}");
        }
    }
}

#[test]
fn what_is_no_plugin_cannot_be_inspected() {
    let desk = Desk::new();
    fs::write(desk.path("notes.wasm"), "no module").expect("a file");
    desk.refuses(&["plugin", "inspect", "notes.wasm"], &["notes.wasm", "not a WebAssembly module"]);
    desk.refuses(&["plugin", "inspect", "nowhere.wasm"], &["nowhere.wasm"]);
}

#[test]
fn a_plugin_that_breaks_off_when_it_is_loaded_is_bad_input() {
    let desk = Desk::new();
    let manifest = r#"{"name": "trap", "kind": "light", "emits_from": ["point"]}"#;
    let module = r#"(module (memory (export "memory") 1)
        (func (export "bidir_abi") (result i32) unreachable) (func (export "bidir_scratch") (param i32) (result i32) (i32.const 16))
        (func (export "light_eval") (param i32 i32 f32 f32 f32 f32 f32)) (func (export "light_emit") (param i32 i32 f32 f32 f32 f32)))"#;
    fs::write(desk.path("trap.json"), manifest).expect("a file");
    fs::write(desk.path("trap.wasm"), wat::parse_str(module).expect("a module")).expect("a file");
    desk.refuses(&["plugin", "inspect", "trap.wasm"], &["trap.wasm", "bidir_abi"]);
}

/// The channels of an EXR and the sums of their values.
fn channels(path: &Path) -> Vec<(String, f64)> {
    use exr::prelude::{ReadChannels as _, ReadLayers as _};
    let all = exr::prelude::read().no_deep_data().largest_resolution_level().all_channels().all_layers().all_attributes();
    let image = all.from_file(path).expect("an EXR");
    let channels = image.layer_data.iter().flat_map(|layer| &layer.channel_data.list);
    channels.map(|one| (one.name.to_string(), one.sample_data.values_as_f32().map(f64::from).sum())).collect()
}

#[test]
fn layers_stand_beside_the_picture() {
    let desk = Desk::new();
    let output = desk.run(&["render", "good.xml", "-o", "a.exr", "--spp", "4", "--quiet", "--integrator", "bdpt", "--aov", "all"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let found = channels(&desk.path("a.exr"));
    let names: Vec<&str> = found.iter().map(|(name, _)| name.as_str()).collect();
    for name in
        ["R", "albedo.G", "N.X", "Ng.Z", "depth.Z", "P.Y", "uv.V", "shape_index.id", "prim_index.id", "material_index.id", "variance.B"]
    {
        assert!(names.contains(&name), "{name} is not among {names:?}");
    }
    let sum = |name: &str| found.iter().find(|(known, _)| known == name).map_or(0.0, |(_, sum)| *sum);
    let techniques: f64 =
        found.iter().filter(|(name, _)| name.starts_with("techniques.") && name.ends_with(".R")).map(|(_, sum)| sum).sum();
    assert!((techniques / sum("R") - 1.0).abs() < 0.05, "{techniques} of {}", sum("R"));
    assert!(sum("samples.count") > 0.0);

    desk.refuses(&["render", "good.xml", "-o", "a.png", "--aov", "depth"], &["a.png", "only an EXR holds more than one layer"]);
    let asked = r#"<integrator type="aov"><string name="aovs" value="dd:depth, nn:sh_normal"/><integrator type="path"/></integrator>"#;
    desk.scene("aov.xml", &format!("{asked}{SENSOR}{LIGHT}"));
    assert!(desk.run(&["render", "aov.xml", "-o", "b.exr", "--spp", "1", "--quiet"]).status.success());
    let names: Vec<String> = channels(&desk.path("b.exr")).into_iter().map(|(name, _)| name).collect();
    assert_eq!(names, ["B", "G", "R", "dd.T", "nn.X", "nn.Y", "nn.Z"]);
}
