//! A plugin that is slow changes the plan, and the card says so.
//!
//! A room is seen through a window, so that light paths reach the image through connections alone: the glass is in the way of every
//! lens splat. It is lit by a lamp deep in a box that is open at the top. Light paths find the way out of it, camera paths hardly ever the
//! way in, so light paths with all connections are worth their price, about what a camera path costs. The inside of the box is the plugin.
//! A light path is scattered there about six times, which is twelve calls; a camera path next to never. With 10 µs a call light paths and
//! their connections cost thirty times as much as camera paths, far more than they save.
//!
//! What a plan's error is depends on seed and scene alone; only the times are the machine's. With the fast plugin light paths are about
//! 1.6 times as efficient as the best plan without them, with the slow one about 0.35 times, so the plan changes as long as times are right
//! within a factor of one and a half. Were the plugin on every surface, camera paths would become slow as well, and the margin would be small: in
//! `examples/scenes/torchiere` connections, which cost the most calls, are then left out by 1.2 against 1.3.

use std::{fs, path::Path, sync::Arc, time::Duration};

use bidir::{
    plan::{
        choice::{Candidate, Choice},
        effects::Effects,
        words,
    },
    plugin::{Engine, Module, Roster, Sandbox, Strictness},
    render::Auto,
};
use bidir_kernel::{Bsdf, Carried, Heuristic, Vec3};
use cpu_time::ThreadTime;

use crate::{pictures::BDPT, scenes::*};

const MATT: &str = include_str!("matt.wat");

/// Nanoseconds that a call of the slow one takes.
const SLOW: f64 = 10_000.0;

/// Pixels that the pilot looks at.
const PIXELS: u64 = 256;

fn bytes() -> Vec<u8> {
    wat::parse_str(MATT).expect("text that is well formed")
}

#[test]
fn light_paths_are_given_up_where_their_plugin_is_slow_and_the_card_says_so() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["fast.wasm", "slow.wasm"] {
        fs::write(folder.path().join(name), bytes()).expect("a module");
    }
    let fast = choice(&room_lit_from_a_box("fast", 0), folder.path());
    let slow = choice(&room_lit_from_a_box("slow", loops()), folder.path());
    for (name, choice) in [("fast", &fast), ("slow", &slow)] {
        println!("{name}: light paths are {:.2} times as efficient as the best plan without", advantage_of_light_paths(choice));
        println!("  {}", words::card(choice).join("\n  "));
    }
    let connected = |candidate: &Candidate| candidate.stage.techniques().light_walks() > 0.0 && candidate.stage.connection > 0.0;
    assert!(connected(&fast.chosen));
    assert_eq!(slow.chosen.stage.techniques().light_walks(), 0.0);
    assert!(fast.without_plugins.as_ref().is_some_and(connected) && slow.without_plugins.as_ref().is_some_and(connected));

    let plugin = &slow.plugins[0];
    assert!(plugin.nanoseconds > 0.5 * SLOW && plugin.nanoseconds < 3.0 * SLOW, "{plugin:?}");
    assert!(plugin.calls_in.light_path > 10.0 * plugin.calls_in.camera_path, "{plugin:?}");
    let said = words::card(&slow).join("\n");
    assert!(said.contains("plugin slow.wasm: "), "{said}");
    assert!(said.contains("if calls of plugins took no time, it would be: camera paths with next event, "), "{said}");
    // How many of several plans that are about as good as each other depends on the clock.
    assert!(words::card(&fast).join("\n").contains("if calls of plugins took no time, "));
}

#[test]
fn a_slow_plugin_on_what_the_camera_sees_takes_nearly_all_of_the_time() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("slow.wasm"), bytes()).expect("a module");
    let floor = shape("rectangle", r#"<scale value="2"/><rotate x="1" angle="-90"/>"#, &matt("slow", 0.6, loops()));
    let back = shape("rectangle", r#"<scale value="2"/><translate value="0, 1.5, -2"/>"#, &matt("slow", 0.6, loops()));
    let choice = choice(&[depth(4), pinhole(), floor, back, panel()].concat(), folder.path());
    println!("{}", words::card(&choice).join("\n"));
    let plugin = &choice.plugins[0];
    assert!(plugin.share > 0.7 && plugin.share < 1.0, "{plugin:?}");
    assert!(plugin.calls > 1.0, "{plugin:?}");
}

/// How many times as efficient the best plan with light paths is as the best one without.
fn advantage_of_light_paths(choice: &Choice) -> f64 {
    let best = |lit: bool| {
        let such = choice.candidates.iter().filter(|candidate| (candidate.stage.techniques().light_walks() > 0.0) == lit);
        such.map(Candidate::efficiency).fold(0.0, f64::max)
    };
    best(true) / best(false)
}

/// What `auto` makes of a scene.
fn choice(content: &str, folder: &Path) -> Choice {
    let subject = read_beside(content, Some(folder));
    let effects = Effects::of(&subject.description, &subject.scene);
    let job = subject.job(subject.strategy(BDPT, Heuristic::Balance), 64, 1);
    let mut auto = Auto::new(&subject.description, &effects);
    auto.look(&subject.scene, &job, Duration::MAX, PIXELS, 0);
    auto.choice().expect("a choice").clone()
}

/// Small, and grey but for the lamp; `kind` is the plugin on the inside of the box.
fn room_lit_from_a_box(kind: &str, loops: i32) -> String {
    let sensor = r#"<transform name="to_world"><lookat origin="0, 1.5, 3.5" target="0, 1.2, 0" up="0, 1, 0"/></transform>"#;
    let sensor = format!(r#"<sensor type="perspective"><float name="fov" value="60"/>{}{sensor}</sensor>"#, film(64));
    let window = shape("rectangle", r#"<translate value="0, 1.5, 3.2"/>"#, &bsdf("thindielectric", ""));
    let (grey, plugin) = (diffuse("0.5, 0.5, 0.5"), matt(kind, 0.95, loops));
    let two_sided = |front: &str, back: &str| bsdf("twosided", &[front, back].concat());
    let wall = |transform: &str| shape("rectangle", transform, &two_sided(&grey, ""));
    // Four metres by three by eight.
    let walls = [
        r#"<rotate x="1" angle="-90"/><scale x="2" z="4"/>"#,
        r#"<rotate x="1" angle="90"/><scale x="2" z="4"/><translate value="0, 3, 0"/>"#,
        r#"<scale x="2" y="1.5"/><translate value="0, 1.5, -4"/>"#,
        r#"<scale x="2" y="1.5"/><rotate y="1" angle="180"/><translate value="0, 1.5, 4"/>"#,
        r#"<scale x="4" y="1.5"/><rotate y="1" angle="90"/><translate value="-2, 1.5, 0"/>"#,
        r#"<scale x="4" y="1.5"/><rotate y="1" angle="-90"/><translate value="2, 1.5, 0"/>"#,
    ]
    .map(wall);
    // A metre by a metre, and 1.6 high; its upper edge is 0.2 below the ceiling.
    let side = |angle: i32| {
        let turned = format!(r#"<rotate y="1" angle="{angle}"/><translate value="0, 2, -2"/>"#);
        let transform = format!(r#"<scale x="0.5" y="0.8"/><translate value="0, 0, 0.5"/>{turned}"#);
        shape("rectangle", &transform, &two_sided(&grey, &plugin))
    };
    let lying =
        |scale: f64, height: f64| format!(r#"<scale value="{scale}"/><rotate x="1" angle="-90"/><translate value="0, {height}, -2"/>"#);
    let bottom = shape("rectangle", &lying(0.5, 1.2), &two_sided(&plugin, &grey));
    let lamp = shape("rectangle", &lying(0.45, 1.22), &(diffuse("0, 0, 0") + &area(10.0)));
    [depth(12), sensor, window, walls.concat(), [0, 90, 180, 270].map(side).concat(), bottom, lamp].concat()
}

fn matt(kind: &str, reflectance: f64, loops: i32) -> String {
    bsdf(kind, &format!(r#"{}<integer name="loops" value="{loops}"/>"#, float("reflectance", reflectance)))
}

/// How far the slow one has to count on this machine.
fn loops() -> i32 {
    const MANY: i32 = 10_000;
    let engine = Engine::new().expect("a machine that runs WebAssembly");
    let module = Arc::new(Module::from_bytes(&engine, Path::new("slow.wasm"), &bytes(), None).expect("a good module"));
    let each = (nanoseconds(&module, MANY) - nanoseconds(&module, 0)) / f64::from(MANY);
    let loops = (SLOW / each) as i32;
    println!("a call of {loops} loops takes {:.0} ns, one of none {:.0} ns", nanoseconds(&module, loops), nanoseconds(&module, 0));
    loops
}

/// CPU time of a call, the least of several tries.
fn nanoseconds(module: &Arc<Module>, loops: i32) -> f64 {
    const CALLS: u32 = 64;
    let mut roster = Roster::default();
    let shader = roster.shader(module, &[("loops", loops.into())]).expect("its parameter");
    let sandbox = Sandbox::new(Arc::new(roster), Strictness::Strict);
    let once = || {
        let start = ThreadTime::now();
        for _ in 0..CALLS {
            std::hint::black_box(sandbox.bsdf(shader).eval(Vec3::Z, Vec3::Z, Carried::Radiance));
        }
        start.elapsed().as_nanos() as f64 / f64::from(CALLS)
    };
    (0..20).map(|_| once()).fold(f64::INFINITY, f64::min)
}
