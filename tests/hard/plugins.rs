//! Rows 58 to 68: plugins. `tests/hostile` asks the same at length, message by message; here is what it comes to.

use std::{
    fs,
    path::Path,
    sync::{Arc, OnceLock, atomic::AtomicBool},
};

use bidir::{
    check::{self, Plugin, Settings, Test},
    error::Result,
    film::Film,
    image::Image,
    plugin::{Cause, Engine, Module, Roster, Sandbox, ShaderId, Strictness, Value},
    render,
};
use bidir_kernel::{Bsdf, Carried, Heuristic, Profile, Vec2, Vec3};
use cpu_time::ThreadTime;
use tempfile::TempDir;

use super::{Case, Form, Held, files::different, lights::Dice};
use crate::{pictures::PATH, scenes, statistics::worse};

pub(super) const CASES: &[Case] = &[
    Case {
        number: 58,
        what: "answers NaN, infinite, negative, 1e38; f > 0 where pdf = 0; no unit direction, or below the surface",
        seen: "–",
        must: "left out, counted, named; the frame is never poisoned",
        run: answers,
    },
    Case { number: 59, what: "an endless loop in any export, in start", seen: "–", must: "stopped in bounded time, named", run: endless },
    Case { number: 60, what: "stack overflow, out of bounds, unreachable, division", seen: "–", must: "named; ends cleanly", run: traps },
    Case { number: 61, what: "memory.grow for ever; huge memory or table", seen: "–", must: "refused or bounded", run: greed },
    Case {
        number: 62,
        what: "imports; missing or wrong exports; another ABI",
        seen: "–",
        must: "refused at load, with what was expected",
        run: strangers,
    },
    Case { number: 63, what: "truncated, empty, random, 100 MB files", seen: "–", must: "refused at load", run: rubbish },
    Case {
        number: 64,
        what: "pointers outside its memory, unaligned; a parameter block too large",
        seen: "–",
        must: "refused",
        run: pointers,
    },
    Case {
        number: 65,
        what: "global state kept between calls",
        seen: "–",
        must: "the same image at any number of threads",
        run: remembers,
    },
    Case { number: 66, what: "NaN payloads that differ per processor", seen: "–", must: "no payload reaches the image", run: payloads },
    Case {
        number: 67,
        what: "biased pdf, wrong weight, not reciprocal, energy > 1",
        seen: "–",
        must: "caught by the material tests",
        run: wrong_materials,
    },
    Case { number: 68, what: "one bad plugin among ten good ones", seen: "–", must: "named; the others unaffected", run: one_of_ten },
];

const GOOD: &str = include_str!("../hostile/modules/good.wat");
const ECHO: &str = include_str!("../hostile/modules/echo.wat");
const ECHO_LIGHT: &str = include_str!("../hostile/modules/echo_light.wat");
const HARM: &str = include_str!("../hostile/modules/harm.wat");
const HARM_LIGHT: &str = include_str!("../hostile/modules/harm_light.wat");
const NAN: &str = include_str!("../hostile/modules/nan.wat");
const REMEMBERS: &str = include_str!("../hostile/modules/remembers.wat");

fn sandboxed(form: Form, held: impl FnOnce() -> Vec<Held>) -> Vec<Held> {
    if form == Form::Sandbox { held() } else { Vec::new() }
}

fn engine() -> &'static Engine {
    static ENGINE: OnceLock<Engine> = OnceLock::new();
    ENGINE.get_or_init(|| Engine::new().expect("a machine that runs WebAssembly"))
}

fn assembled(text: &str) -> Vec<u8> {
    wat::parse_str(text).expect("text that is well formed")
}

fn load_bytes(bytes: &[u8]) -> Result<Arc<Module>> {
    Module::from_bytes(engine(), Path::new("hostile.wasm"), bytes, None).map(Arc::new)
}

fn broken(good: &str, bad: &str) -> String {
    assert!(GOOD.contains(good), "good.wat does not hold {good}");
    GOOD.replacen(good, bad, 1)
}

fn sandbox(module: &Arc<Module>, block: &[u8]) -> (Sandbox, ShaderId) {
    let mut roster = Roster::default();
    let shader = roster.add(module, block);
    (Sandbox::new(Arc::new(roster), Strictness::Lenient), shader)
}

/// Modules that are not refused with every one of these words.
fn not_refused<'a>(modules: impl IntoIterator<Item = (String, &'a [&'a str])>) -> usize {
    let refused = |text: &str, words: &[&str]| {
        load_bytes(&assembled(text)).is_err_and(|error| words.iter().chain(&["hostile.wasm"]).all(|word| error.to_string().contains(word)))
    };
    modules.into_iter().filter(|(text, words)| !refused(text, words)).count()
}

const EVAL: [f32; 5] = [0.2, 0.2, 0.2, 0.3, 0.3];

/// ω_i, weight, pdf, pdf_rev, lobe, η.
fn sample() -> [f32; 10] {
    [0.6, 0.0, 0.8, 0.5, 0.5, 0.5, 0.3, 0.3, f32::from_bits(1), 1.0]
}

fn with<const N: usize>(mut answer: [f32; N], at: usize, number: f32) -> [f32; N] {
    answer[at] = number;
    answer
}

/// Of these bad answers, those that got through, or were not counted and named.
fn through(bad: &[([f32; 5], [f32; 10], &str)]) -> usize {
    let echo = load_bytes(&assembled(ECHO)).expect("a good module");
    let passes = |(eval, sample, export): &&([f32; 5], [f32; 10], &str)| {
        let block: Vec<u8> = eval.iter().chain(sample).flat_map(|number| number.to_le_bytes()).collect();
        let (sandbox, shader) = sandbox(&echo, &block);
        let wo = Vec3::new(0.6, 0.0, 0.8);
        let scatter = sandbox.bsdf(shader).eval(wo, Vec3::Z, Carried::Radiance);
        let scattered = sandbox.bsdf(shader).sample(wo, [0.5; 3], Carried::Radiance);
        let empty = if *export == "bsdf_eval" { scatter.value.is_black() } else { scattered.is_none() };
        let quarantine = sandbox.quarantine();
        let named = quarantine.0.iter().any(|entry| entry.asked.export() == *export && entry.to_string().contains("hostile.wasm"));
        !(empty && named && quarantine.count() == 1)
    };
    bad.iter().filter(passes).count()
}

fn of_numbers(numbers: &[f32]) -> Vec<([f32; 5], [f32; 10], &'static str)> {
    let evals = |number: f32| (0..5).map(move |at| (with(EVAL, at, number), sample(), "bsdf_eval"));
    // A coordinate of a direction may be negative.
    let first = |number: f32| if number.is_finite() { 3 } else { 0 };
    let samples = |number: f32| (first(number)..10).filter(|at| *at != 8).map(move |at| (EVAL, with(sample(), at, number), "bsdf_sample"));
    numbers.iter().flat_map(|number| evals(*number).chain(samples(*number))).collect()
}

fn answers(form: Form) -> Vec<Held> {
    sandboxed(form, || {
        let numbers = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, 1e38];
        let mut bad = of_numbers(&numbers);
        bad.extend([(with(EVAL, 3, 0.0), sample(), "bsdf_eval"), (EVAL, with(sample(), 6, 0.0), "bsdf_sample")]);
        bad.extend([0.0, 0.9, 2.0, -0.8].map(|z| (EVAL, with(sample(), 2, z), "bsdf_sample")));
        vec![
            Held::none(format!("of {} bad answers, those not left out, counted and named", bad.len()), through(&bad)),
            Held::none("of 40 bad answers of lights, those not left out, counted and named", through_lights(&numbers)),
        ]
    })
}

fn payloads(form: Form) -> Vec<Held> {
    sandboxed(form, || {
        let payloads = [0x7f80_0001, 0x7fc0_0000, 0x7fff_ffff, 0xff80_0001, 0xffc0_0000, 0xffff_ffff].map(f32::from_bits);
        let bad = of_numbers(&payloads);
        vec![Held::none(format!("of {} answers with payloads, those that got through", bad.len()), through(&bad))]
    })
}

/// Of bad answers of a light's two exports, those that got through, or were not counted and named.
fn through_lights(numbers: &[f32]) -> usize {
    let echo = load_bytes(&assembled(ECHO_LIGHT)).expect("a good module");
    let (eval, emit) = ([1.0, 1.0, 1.0, 0.3], [0.6, 0.0, 0.8, 1.0, 1.0, 1.0, 0.3]);
    let passes = |eval: [f32; 4], emit: [f32; 7], export: &str| {
        let block: Vec<u8> = eval.iter().chain(&emit).flat_map(|number| number.to_le_bytes()).collect();
        let (sandbox, shader) = sandbox(&echo, &block);
        let black = sandbox.profile(shader).eval(Vec2::new(0.5, 0.5), Vec3::Z).radiance.is_black();
        let none = sandbox.profile(shader).emit(Vec2::new(0.5, 0.5), [0.5; 2]).is_none();
        let quarantine = sandbox.quarantine();
        let named = quarantine.0.iter().any(|entry| entry.asked.export() == export);
        !(if export == "light_eval" { black } else { none } && named && quarantine.count() == 1)
    };
    let evals = |number: f32| (0..4).filter(|at| passes(with(eval, *at, number), emit, "light_eval")).count();
    let emits = |number: f32| (3..7).filter(|at| passes(eval, with(emit, *at, number), "light_emit")).count();
    numbers.iter().map(|number| evals(*number) + emits(*number)).sum()
}

/// A call that is told to do harm: what became of it, and after how many seconds of its thread.
fn call(export: &str, harm: i32) -> (Option<bidir::plugin::Fault>, f64) {
    let module = load_bytes(&assembled(if export.starts_with("light") { HARM_LIGHT } else { HARM })).expect("a module that loads");
    let parameters = if export.ends_with("eval") { [harm, 0] } else { [0, harm] };
    let (sandbox, shader) = sandbox(&module, parameters.map(i32::to_le_bytes).as_flattened());
    let start = ThreadTime::now();
    match export {
        "bsdf_eval" => drop(sandbox.bsdf(shader).eval(Vec3::Z, Vec3::Z, Carried::Radiance)),
        "bsdf_sample" => drop(sandbox.bsdf(shader).sample(Vec3::Z, [0.5; 3], Carried::Radiance)),
        "light_eval" => drop(sandbox.profile(shader).eval(Vec2::new(0.5, 0.5), Vec3::Z)),
        _ => drop(sandbox.profile(shader).emit(Vec2::new(0.5, 0.5), [0.5; 2])),
    }
    (sandbox.fault(), start.elapsed().as_secs_f64())
}

const EXPORTS: [&str; 4] = ["bsdf_eval", "bsdf_sample", "light_eval", "light_emit"];
const MEMORY: &str = r#"(memory (export "memory") 1)"#;
const SCRATCH: &str = "i32.const 1024";
const LOOP: &str = "(loop $ever (br $ever))";

/// Of the thread's own time; a call is stopped after about 60 ms of anybody's.
const SOON: f64 = 1.0;

fn endless(form: Form) -> Vec<Held> {
    sandboxed(form, || {
        let calls = EXPORTS.map(|export| (export, call(export, 1)));
        let unnamed = calls
            .iter()
            .filter(|(export, (fault, _))| !fault.as_ref().is_some_and(|fault| fault.export == *export && fault.cause == Cause::Endless));
        let longest = calls.iter().map(|(_, (_, seconds))| *seconds).fold(0.0, worse);
        let start = ThreadTime::now();
        let at_load = [
            (broken(MEMORY, &format!("{MEMORY} (func $start {LOOP}) (start $start)")), &["start", "ran for more than"][..]),
            (broken("i32.const 65536", &format!("{LOOP} i32.const 0")), &["bidir_abi", "ran for more than"]),
            (broken(SCRATCH, &format!("{LOOP} i32.const 0")), &["bidir_scratch", "ran for more than"]),
        ];
        let loaded = not_refused(at_load);
        vec![
            Held::none("of 4 calls and 3 loads without end, those not stopped and named", unnamed.count() + loaded),
            Held::new("seconds until a call without end was stopped", longest, SOON),
            Held::new("seconds until a load without end was stopped, on average", start.elapsed().as_secs_f64() / 3.0, SOON),
        ]
    })
}

fn traps(form: Form) -> Vec<Held> {
    sandboxed(form, || {
        let harms = [(2, "ran out of stack"), (3, "reached outside its memory"), (4, "gave up"), (5, "divided an integer by 0")];
        let all = EXPORTS.iter().flat_map(|export| harms.map(|(harm, words)| (*export, harm, words)));
        let unnamed = |(export, harm, words): &(&str, i32, &str)| {
            let named =
                |fault: bidir::plugin::Fault| fault.export == *export && matches!(&fault.cause, Cause::Trap(why) if why.contains(words));
            !call(export, *harm).0.is_some_and(named)
        };
        vec![Held::none("of 16 traps, those not named with their export", all.filter(unnamed).count())]
    })
}

fn greed(form: Form) -> Vec<Held> {
    sandboxed(form, || {
        let huge = [
            (broken(MEMORY, r#"(memory (export "memory") 257)"#), &["memory has 16842752 bytes"][..]),
            (broken(MEMORY, r#"(memory (export "memory") 65536)"#), &["memory has 4294967296 bytes"]),
            (broken(MEMORY, &format!("{MEMORY} (table 10001 funcref)")), &["10001 table entries"]),
            (broken(MEMORY, &format!("{MEMORY} (memory 1)")), &["one memory"]),
        ];
        let module = load_bytes(&assembled(HARM)).expect("a module that loads");
        let (sandbox, shader) = sandbox(&module, [6_i32, 0].map(i32::to_le_bytes).as_flattened());
        sandbox.bsdf(shader).eval(Vec3::Z, Vec3::Z, Carried::Radiance);
        let taken = sandbox.memory_bytes(shader).unwrap_or(usize::MAX);
        vec![
            Held::none("of 4 modules that declare too much, those not refused with the limit", not_refused(huge)),
            Held::new("MiB that a module took that grows for ever", taken as f64 / f64::from(1 << 20), 16.0),
        ]
    })
}

fn strangers(form: Form) -> Vec<Held> {
    sandboxed(form, || {
        let import = |kind: &str| broken("(memory (export", &format!(r#"(import "env" "thing" {kind}) (memory (export"#));
        let mut modules: Vec<(String, &[&str])> = vec![];
        for kind in ["(func)", "(memory 1)", "(global i32)", "(table 1 funcref)"] {
            modules.push((import(kind), &[r#"imports "thing" from "env""#]));
        }
        for export in ["bidir_abi", "bidir_scratch", "bsdf_eval", "bsdf_sample"] {
            modules.push((broken(&format!(r#"(export "{export}")"#), r#"(export "another")"#), &["exports no \"", "->"]));
        }
        modules.push((broken("(result i32) i32.const 65536", "(result i64) i64.const 65536"), &["() -> (i64)", "() -> (i32)"]));
        modules.push((broken("(param f32 f32 f32 f32 f32 f32)", "(param f64 f32 f32 f32 f32 f32)"), &["i32 i32 i32 f64"]));
        for version in [9, 0x1_0001, 0x2_0000, -1] {
            modules.push((broken("i32.const 65536", &format!("i32.const {version}")), &["of the plugin ABI"]));
        }
        vec![Held::none(format!("of {} strange modules, those not refused with what was expected", modules.len()), not_refused(modules))]
    })
}

fn rubbish(form: Form) -> Vec<Held> {
    sandboxed(form, || {
        let whole = assembled(GOOD);
        // Names of variables come last, and are no part of what a module does.
        let end = whole.windows(5).position(|window| window == b"\x04name").map_or(whole.len(), |at| at - 3);
        let mut files: Vec<Vec<u8>> = (0..end).map(|length| whole[..length].to_vec()).collect();
        let mut dice = Dice::new(5);
        for length in [0, 1, 8, 100, 10_000] {
            files.push((0..length).map(|_| dice.roll() as u8).collect());
            files.push(
                b"\0asm\x01\0\0\0".iter().copied().chain((0..length).map(|_| dice.roll() as u8)).skip(usize::from(length == 0)).collect(),
            );
        }
        let mut loaded = files.iter().filter(|bytes| load_bytes(bytes).is_ok()).count();
        let folder = tempfile::tempdir().expect("a folder");
        let large = folder.path().join("large.wasm");
        fs::File::create(&large).and_then(|file| file.set_len(100 << 20)).expect("a file");
        loaded += usize::from(Module::load(engine(), &large).is_ok());
        vec![Held::none(format!("of {} files that are no modules, those that load", files.len() + 1), loaded)]
    })
}

fn pointers(form: Form) -> Vec<Held> {
    sandboxed(form, || {
        let at = |address: &str| broken(SCRATCH, &format!("i32.const {address}"));
        let modules: Vec<(String, &[&str])> = ["65535", "65488", "-16", "2147483632", "1032", "1"]
            .map(|address| (at(address), &["bidir_scratch"][..]))
            .into_iter()
            .chain([(
                broken(
                    r#"[\"delta_reflection\"]"#,
                    r#"[\"delta_reflection\"], \"params\": [{\"name\": \"far\", \"type\": \"float\", \"offset\": 4096, \"default\": 0}]"#,
                ),
                &["past the 4096 bytes"][..],
            )])
            .collect();
        vec![Held::none(format!("of {} bad addresses and blocks, those not refused", modules.len()), not_refused(modules))]
    })
}

fn folder(modules: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, text) in modules {
        fs::write(folder.path().join(name), assembled(text)).expect("a module");
    }
    folder
}

fn picture(content: &str, folder: &Path, threads: usize) -> (Image, render::Status) {
    let subject = scenes::read_beside(content, Some(folder));
    let film = Film::new(&subject.description.film).expect("a film");
    let job = render::Job { threads, strictness: Strictness::Lenient, ..subject.job(subject.strategy(PATH, Heuristic::Balance), 16, 1) };
    let status = render::render(&subject.scene, &film, &job, &AtomicBool::new(false), |_| None);
    (film.develop(), status)
}

fn remembers(form: Form) -> Vec<Held> {
    sandboxed(form, || {
        let folder = folder(&[("remembers.wasm", REMEMBERS)]);
        let camera = scenes::camera("perspective", &scenes::film(48));
        let content = [scenes::depth(6), camera, scenes::room(), scenes::panel(), scenes::ball(&scenes::bsdf("remembers", ""))].concat();
        let (one, _) = picture(&content, folder.path(), 1);
        let differ = [2, 3].map(|threads| different(&one, &picture(&content, folder.path(), threads).0));
        vec![Held::none("pixels that change with the number of threads", differ.iter().sum())]
    })
}

/// By a crate that makes one mistake at a time; `tests/check` has 42 of them.
fn wrong_materials(form: Form) -> Vec<Held> {
    sandboxed(form, || {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("wrong/wrong.wasm");
        let module = Arc::new(Module::load(engine(), &file).expect("a module"));
        let caught = |mistake: i32, test: Test| {
            let given = [
                ("mistake".to_owned(), Value::Int(mistake)),
                ("albedo".to_owned(), Value::Float(1.0)),
                ("alpha".to_owned(), Value::Float(0.02)),
            ];
            let plugin = Plugin::with(&module, &given).expect("parameters");
            check::bsdfs(&plugin, &Settings { seed: 7, threads: 2, effort: Some(13) }).failed().contains(&test)
        };
        let mistakes = [(1, Test::Mass), (3, Test::Weight), (16, Test::Reciprocity), (17, Test::Albedo)];
        let missed = mistakes.iter().filter(|(mistake, test)| !caught(*mistake, *test)).count();
        vec![Held::none("of 4 mistakes (pdf, weight, reciprocity, energy), those not caught", missed)]
    })
}

fn one_of_ten(form: Form) -> Vec<Held> {
    sandboxed(form, || {
        let folder = folder(&[("good.wasm", GOOD), ("nan.wasm", NAN)]);
        let kinds =
            ["conductor", "dielectric", "diffuse", "leaf", "null", "plastic", "roughconductor", "roughdielectric", "thindielectric"];
        for name in kinds.map(|kind| format!("{kind}.wasm")) {
            let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("../plugins/prebuilt").join(&name);
            fs::copy(from, folder.path().join(&name)).expect("a module");
        }
        let mut materials: [String; 11] = std::array::from_fn(|i| format!("{}.wasm", kinds.get(i).unwrap_or(&"good")));
        let strips = |materials: &[String]| {
            let strip = |(i, material): (usize, &String)| {
                let transform = format!(r#"<scale x="0.5" y="0.5"/><translate x="{}"/>"#, i as f64 - 5.0);
                scenes::shape("rectangle", &transform, &scenes::bsdf(material, ""))
            };
            let film = scenes::film_with(44, 4, r#"<rfilter type="box"/>"#);
            let to_world =
                r#"<transform name="to_world"><scale value="5.5"/><lookat origin="0, 0, 4" target="0, 0, 0" up="0, 1, 0"/></transform>"#;
            let sensor = format!(r#"<sensor type="orthographic">{film}{to_world}</sensor>"#);
            let strips: String = materials.iter().enumerate().map(strip).collect();
            [scenes::depth(3), sensor, strips, scenes::emitter("constant", "")].concat()
        };
        let (expected, _) = picture(&strips(&materials), folder.path(), 2);
        materials[5] = "nan.wasm".to_owned();
        let (found, status) = picture(&strips(&materials), folder.path(), 2);
        let others = expected.pixels.iter().zip(&found.pixels).enumerate().filter(|(i, (a, b))| i % 44 / 4 != 5 && a != b).count();
        let named = status.quarantine.0.iter().all(|entry| entry.file.ends_with("nan.wasm")) && !status.quarantine.0.is_empty();
        vec![
            Held::none("pixels of the ten others that change", others),
            Held::none("reports that name another plugin, or none", usize::from(!named)),
        ]
    })
}
