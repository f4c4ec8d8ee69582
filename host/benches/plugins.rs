//! What plugins cost: `cargo bench -p bidir --bench plugins [-- renders|calls|limits]` prints whole renders, calls, and limits.
//!
//! A render is made twice with the same code: linked natively, and as modules in the sandbox, with every check and the clock on.
//! Rounds alternate between the two, in one process; times are CPU time of the one render thread, and each figure is a median.

use std::{
    fs,
    hint::black_box,
    path::{Path, PathBuf},
    sync::{Arc, atomic::AtomicBool},
    time::Instant,
};

use bidir::{
    film::Film,
    image::Image,
    load,
    plugin::{Engine, Library, Module, Roster, Sandbox, ShaderId, Strictness},
    render::{self, Job, Numbers, Target},
    scene::{
        Scene,
        description::{Crop, Description, FilmSettings, Filter},
        view::View,
    },
};
use bidir_kernel::{Bsdf, Carried, Heuristic, Ray, Scene as _, Segment, Strategy, Techniques, Vec3};

const ROUNDS: usize = 15;
const SIDE: u32 = 96;
const KINDS: [&str; 7] = ["diffuse", "conductor", "dielectric", "thindielectric", "plastic", "roughconductor", "roughdielectric"];

fn main() {
    let filter = std::env::args().skip(1).find(|word| !word.starts_with('-')).unwrap_or_default();
    let parts: [(&str, fn()); 3] = [("renders", renders), ("calls", calls), ("limits", limits)];
    parts.into_iter().filter(|(name, _)| name.contains(&filter)).for_each(|(_, part)| part());
}

fn renders() {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, text) in [("ground.ply", ground(180)), ("blob.ply", blob(160)), ("leaves.ply", leaves(120_000))] {
        fs::write(folder.path().join(name), text).expect("a mesh");
    }
    println!("whole renders, {SIDE}×{SIDE}, every surface a plugin; CPU seconds, medians of {ROUNDS}");
    for (name, xml) in [("room", ROOM), ("thicket", THICKET)] {
        whole(name, &["", ".wasm"].map(|ending| read(xml, folder.path(), &[("w", ending)])));
    }
}

fn whole(scene: &str, [native, plugin]: &[(Description, Scene); 2]) {
    println!("{scene}, {} primitives", native.1.build_stats().primitives);
    println!("{:<8}{:>8}{:>8}{:>8}{:>8}   range of the ratio", "", "samples", "native", "plugin", "ratio");
    for (name, techniques, samples) in [("path", Techniques::PATH, 24), ("bdpt", Techniques::BIDIRECTIONAL, 10)] {
        let rounds: Vec<[f64; 2]> = (0..ROUNDS)
            .map(|_| {
                let (expected, without) = image(native, techniques, samples);
                let (found, with) = image(plugin, techniques, samples);
                let bits = |image: &Image| image.pixels.iter().flatten().map(|value| value.to_bits()).collect::<Vec<_>>();
                assert!(bits(&expected) == bits(&found), "{name}: native and sandboxed images differ");
                [without, with]
            })
            .collect();
        let [without, with] = [0, 1].map(|i| median(rounds.iter().map(|round| round[i]).collect()));
        let ratios: Vec<f64> = rounds.iter().map(|[without, with]| with / without).collect();
        let (least, most) = ratios.iter().fold((f64::MAX, 0.0_f64), |(least, most), ratio| (least.min(*ratio), most.max(*ratio)));
        println!("{name:<8}{samples:>8}{without:>8.3}{with:>8.3}{:>8.3}   {least:.3} … {most:.3}; bit-identical", median(ratios));
    }
}

fn image((description, scene): &(Description, Scene), techniques: Techniques, samples: u32) -> (Image, f64) {
    let film = Film::new(&description.film).expect("a film");
    let job = Job {
        strategy: Strategy { techniques, heuristic: Heuristic::Balance, max_depth: 12, rr_depth: 5 },
        seed: 0,
        numbers: Numbers::default(),
        threads: 1,
        target: Target::Samples(samples),
        width: description.film.width,
        strictness: Strictness::Strict,
    };
    let status = render::render(scene, &film, &job, &AtomicBool::new(false), |_| None);
    assert!(status.fault.is_none() && status.samples == samples, "{:?}", status.fault);
    (film.develop(), status.cpu.as_secs_f64())
}

/// Single calls, through the surface that a ray meets, as in a render.
fn calls() {
    println!("\none call, ns; medians of {ROUNDS}");
    let (id, sandbox) = assembled("");
    let nothing = time(|wo, wi| f64::from(sandbox.bsdf(id).eval(wo, wi, Carried::Radiance).pdf.0));
    println!("{:<20}{nothing:>8.1}", "empty, eval");
    println!("{:<20}{:>8}{:>8}{:>10}{:>8}{:>14}", "", "eval", "plugin", "sample", "plugin", "instance, µs");
    for kind in KINDS {
        let xml = BALL.replace("KIND", kind);
        let [native, plugin] = ["", ".wasm"].map(|ending| read(&xml, Path::new(""), &[("w", ending)]).1);
        let [native, plugin] = [&native, &plugin].map(|scene| View::new(scene, Strictness::Strict));
        let [eval, sample] = [&native, &plugin]
            .map(|view| both(view))
            .into_iter()
            .fold([[0.0; 2]; 2], |[eval, sample], [e, s]| [[eval[1], e], [sample[1], s]]);
        let instance = instantiation(&prebuilt().join(format!("{kind}.wasm")));
        println!("{kind:<20}{:>8.1}{:>8.1}{:>10.1}{:>8.1}{instance:>14.1}", eval[0], eval[1], sample[0], sample[1]);
    }
}

/// Times of `eval` and `sample` of what the ray along −z meets.
fn both(view: &View) -> [f64; 2] {
    let ray = Ray { origin: Vec3::new(0.0, 0.0, 3.0), direction: Vec3::NEG_Z, t_max: f32::INFINITY, segment: Segment::Inner };
    let (point, hit) = view.intersect(&ray).expect("the ball");
    let bsdf = view.bsdf(&point, hit);
    let eval = time(|wo, wi| f64::from(bsdf.eval(wo, wi, Carried::Radiance).value.0[0]));
    let sample =
        time(|wo, u| f64::from(bsdf.sample(wo, u.abs().to_array().map(|u| u.min(0.999)), Carried::Radiance).map_or(0.0, |s| s.wi.z)));
    [eval, sample]
}

/// Making an instance afresh and one call, less the call.
fn instantiation(file: &Path) -> f64 {
    let module = Arc::new(Module::load(&Engine::new().expect("an engine"), file).expect("a module"));
    let mut roster = Roster::default();
    let id = roster.shader(&module, &[]).expect("its defaults");
    let sandbox = Sandbox::new(Arc::new(roster), Strictness::Strict);
    let rounds = (0..500).map(|tile| {
        let start = Instant::now();
        sandbox.begin_tile(tile);
        black_box(sandbox.bsdf(id).eval(Vec3::Z, Vec3::Z, Carried::Radiance));
        start.elapsed().as_secs_f64() * 1e6
    });
    median(rounds.collect())
}

fn limits() {
    println!("\nlimits");
    let rounds = (0..ROUNDS).map(|_| {
        let (id, sandbox) = assembled("(loop $on (br $on))");
        let start = Instant::now();
        sandbox.bsdf(id).eval(Vec3::Z, Vec3::Z, Carried::Radiance);
        assert!(sandbox.fault().is_some());
        start.elapsed().as_secs_f64() * 1e3
    });
    let times: Vec<f64> = rounds.collect();
    let most = times.iter().copied().fold(0.0, f64::max);
    println!("a call that does not end is stopped after {:.0} ms; at most {most:.0} ms", median(times));
}

/// A module whose calls do just that.
fn assembled(body: &str) -> (ShaderId, Sandbox) {
    let nine = "(param i32 i32 i32 f32 f32 f32 f32 f32 f32)";
    let manifest = r#"{\"name\": \"bench\", \"kind\": \"bsdf\", \"lobes\": [\"diffuse_reflection\"]}"#;
    let text = format!(
        r#"(module (@custom "bidir.manifest" "{manifest}") (memory (export "memory") 1)
            (func (export "bidir_abi") (result i32) (i32.const 65536))
            (func (export "bidir_scratch") (param i32) (result i32) (i32.const 1024))
            (func (export "bsdf_eval") {nine} {body}) (func (export "bsdf_sample") {nine}))"#
    );
    let bytes = wat::parse_str(text).expect("a module");
    let module = Module::from_bytes(&Engine::new().expect("an engine"), Path::new("bench.wasm"), &bytes, None).expect("a plugin");
    let mut roster = Roster::default();
    let id = roster.shader(&Arc::new(module), &[]).expect("no parameters");
    (id, Sandbox::new(Arc::new(roster), Strictness::Strict))
}

/// Nanoseconds per call, over pairs of directions on the upper side.
fn time(call: impl Fn(Vec3, Vec3) -> f64) -> f64 {
    let direction = |i: usize, a: f32| {
        let (z, angle) = (0.05 + 0.95 * ((i as f32 * a) % 1.0), i as f32 * 2.4);
        let r = (1.0 - z * z).sqrt();
        Vec3::new(r * angle.cos(), r * angle.sin(), z)
    };
    let pairs: Vec<_> = (0..4096).map(|i| (direction(i, 0.618_034), direction(i + 1, 0.754_878))).collect();
    let rounds = (0..ROUNDS).map(|_| {
        let start = Instant::now();
        for _ in 0..8 {
            black_box(pairs.iter().map(|&(wo, wi)| call(wo, wi)).sum::<f64>());
        }
        start.elapsed().as_secs_f64() * 1e9 / (8 * pairs.len()) as f64
    });
    median(rounds.collect())
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn prebuilt() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../plugins/prebuilt")
}

fn read(xml: &str, folder: &Path, defines: &[(&str, &str)]) -> (Description, Scene) {
    let defines: Vec<_> = defines.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect();
    let library = Library::new(vec![prebuilt()]);
    let mut description = load::load_str(xml, Path::new("bench.xml"), Some(folder), &defines, &library).expect("a scene").description;
    let crop = Crop { x: 0, y: 0, width: SIDE, height: SIDE };
    description.film = FilmSettings { width: SIDE, height: SIDE, crop, filter: Filter::Box };
    let scene = Scene::new(&description).expect("a scene");
    (description, scene)
}

const BALL: &str = r#"<scene version="3.0.0"><default name="w" value=""/><sensor type="perspective"/>
    <shape type="sphere"><bsdf type="KIND$w"/></shape><emitter type="constant"/></scene>"#;

/// Rough ground, a plastic rock, a ball of rough metal and one of frosted glass, in a closed room with a lamp.
const ROOM: &str = r#"<scene version="3.0.0"><default name="w" value=""/>
    <sensor type="perspective"><float name="fov" value="60"/>
        <transform name="to_world"><lookat origin="0, 1.4, 3.8" target="0, 0.9, 0" up="0, 1, 0"/></transform></sensor>
    <bsdf type="twosided" id="wall"><bsdf type="diffuse$w"><rgb name="reflectance" value="0.7, 0.7, 0.65"/></bsdf></bsdf>
    <bsdf type="twosided" id="red"><bsdf type="diffuse$w"><rgb name="reflectance" value="0.6, 0.15, 0.1"/></bsdf></bsdf>
    <bsdf type="twosided" id="soil"><bsdf type="diffuse$w"><rgb name="reflectance" value="0.4, 0.35, 0.3"/></bsdf></bsdf>
    <bsdf type="plastic$w" id="rock"><rgb name="diffuse_reflectance" value="0.1, 0.3, 0.6"/></bsdf>
    <bsdf type="roughconductor$w" id="metal"><float name="alpha" value="0.2"/></bsdf>
    <bsdf type="roughdielectric$w" id="glass"><float name="alpha" value="0.15"/></bsdf>
    <shape type="ply"><string name="filename" value="ground.ply"/><ref id="soil"/></shape>
    <shape type="ply"><string name="filename" value="blob.ply"/><ref id="rock"/>
        <transform name="to_world"><scale value="0.6"/><translate x="-0.9" y="0.8" z="-0.6"/></transform></shape>
    <shape type="sphere"><point name="center" value="0.5, 0.9, -0.9"/><float name="radius" value="0.6"/><ref id="metal"/></shape>
    <shape type="sphere"><point name="center" value="0.7, 0.6, 0.7"/><float name="radius" value="0.4"/><ref id="glass"/></shape>
    <shape type="cube"><transform name="to_world"><scale value="2, 2, 4"/><translate y="2"/></transform><ref id="wall"/></shape>
    <shape type="rectangle"><transform name="to_world"><rotate y="1" angle="90"/><scale value="1, 2, 4"/><translate x="-1.99" y="2"/></transform>
        <ref id="red"/></shape>
    <shape type="rectangle"><transform name="to_world"><rotate x="1" angle="90"/><scale value="0.6"/><translate y="3.9"/></transform>
        <ref id="wall"/><emitter type="area"><rgb name="radiance" value="9, 8, 7"/></emitter></shape>
</scene>"#;

/// Leaves at random in a box over ground, under a sky and a lamp: rays take longer than in a room, as in most scenes of that size.
const THICKET: &str = r#"<scene version="3.0.0"><default name="w" value=""/>
    <sensor type="perspective"><float name="fov" value="50"/>
        <transform name="to_world"><lookat origin="0, 1.6, 5" target="0, 0.9, 0" up="0, 1, 0"/></transform></sensor>
    <bsdf type="twosided" id="leaf"><bsdf type="diffuse$w"><rgb name="reflectance" value="0.3, 0.6, 0.2"/></bsdf></bsdf>
    <bsdf type="twosided" id="soil"><bsdf type="diffuse$w"><rgb name="reflectance" value="0.4, 0.35, 0.3"/></bsdf></bsdf>
    <bsdf type="plastic$w" id="rock"><rgb name="diffuse_reflectance" value="0.5, 0.5, 0.5"/></bsdf>
    <shape type="ply"><string name="filename" value="leaves.ply"/><ref id="leaf"/></shape>
    <shape type="ply"><string name="filename" value="ground.ply"/><ref id="soil"/></shape>
    <shape type="ply"><string name="filename" value="blob.ply"/><ref id="rock"/>
        <transform name="to_world"><scale value="0.5"/><translate x="0.3" y="0.6" z="2.4"/></transform></shape>
    <shape type="sphere"><point name="center" value="1, 4, 3"/><float name="radius" value="0.4"/>
        <emitter type="area"><rgb name="radiance" value="20, 18, 15"/></emitter></shape>
    <emitter type="constant"><rgb name="radiance" value="0.4, 0.5, 0.7"/></emitter>
</scene>"#;

/// A heightfield of 2 · cells · cells triangles over [−2, 2]².
fn ground(cells: usize) -> String {
    let at = |i: usize, j: usize| {
        let (x, z) = (4.0 * i as f32 / cells as f32 - 2.0, 4.0 * j as f32 / cells as f32 - 2.0);
        Vec3::new(x, 0.1 + 0.06 * (5.0 * x).sin() * (4.0 * z).cos() + 0.015 * (31.0 * x + 2.0).sin() * (37.0 * z).sin(), 2.0 * z)
    };
    ply(cells, at)
}

/// A bumpy sphere of 2 · rings · rings triangles.
fn blob(rings: usize) -> String {
    let at = |ring: usize, sector: usize| {
        let (theta, phi) = (std::f32::consts::PI * ring as f32 / rings as f32, std::f32::consts::TAU * sector as f32 / rings as f32);
        let v = Vec3::new(theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin());
        let bump = |f: f32| ((v.x * f + 1.0).sin() * (v.y * f * 1.1 + 2.0).sin() * (v.z * f * 0.9 + 3.0).sin()) / f;
        v * (0.8 + 0.6 * bump(4.0) + 0.9 * bump(17.0))
    };
    ply(rings, at)
}

/// Separate triangles at random in [−1.8, 1.8] × [0.2, 2.2] × [−2, 1.6].
fn leaves(count: usize) -> String {
    let mut state = 1_u64;
    let mut random = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f32 / (1_u64 << 24) as f32
    };
    let corners = (0..count).flat_map(|_| {
        let centre = Vec3::new(3.6 * random() - 1.8, 0.2 + 2.0 * random(), 3.6 * random() - 2.0);
        [(); 3].map(|()| centre + 0.06 * Vec3::new(random() - 0.5, random() - 0.5, random() - 0.5))
    });
    let corners: Vec<Vec3> = corners.collect();
    listed(&corners, (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]))
}

/// A grid, each cell two triangles.
fn ply(cells: usize, at: impl Fn(usize, usize) -> Vec3) -> String {
    let side = cells + 1;
    let vertices: Vec<Vec3> = (0..side * side).map(|i| at(i / side, i % side)).collect();
    let faces = (0..cells * cells).flat_map(|i| {
        let a = i / cells * side + i % cells;
        let (b, c, d) = (a + 1, a + side + 1, a + side);
        [[a, b, c], [a, c, d]]
    });
    listed(&vertices, faces)
}

fn listed(vertices: &[Vec3], faces: impl Iterator<Item = [usize; 3]>) -> String {
    let faces: Vec<_> = faces.collect();
    let mut text = format!(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n\
         element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        vertices.len(),
        faces.len()
    );
    vertices.iter().for_each(|v| text += &format!("{} {} {}\n", v.x, v.y, v.z));
    faces.iter().for_each(|[a, b, c]| text += &format!("3 {a} {b} {c}\n"));
    text
}
