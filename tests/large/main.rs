//! How long a large scene takes from its files to a first picture, and how much memory: `cargo run --release -p bidir-tests --bin large
//! [triangles=5000000] [textures=200] [side=1024]`.
//!
//! Meshes of about 100,000 triangles each, with texture coordinates and without normals, so that those are made; a texture of noise for
//! each fourth of a mesh; a sky. The scene is written to a temporary folder first, which is not counted.

use std::{
    fmt::Write as _,
    fs,
    io::{self, BufWriter, Write},
    path::Path,
    process::ExitCode,
    sync::atomic::AtomicBool,
    time::Instant,
};

use bidir::{
    film::Film,
    load,
    plan::effects::Effects,
    plugin::{Library, Strictness},
    render::{self, Auto, Job, Numbers, Target},
    scene::Scene,
};
use bidir_kernel::{Heuristic, Strategy, Techniques};

/// How long it may take, in seconds.
const MOST: f64 = 20.0;

/// Quads along each side of a mesh.
const QUADS: u32 = 224;

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let number = |name: &str, usual: u32| {
        let given = words.iter().find_map(|word| word.strip_prefix(name)?.strip_prefix('='));
        given.map_or(usual, |value| value.parse().expect("a number"))
    };
    let (triangles, textures, side) = (number("triangles", 5_000_000), number("textures", 200), number("side", 1024));
    let folder = tempfile::tempdir().expect("a folder");
    write_scene(folder.path(), triangles.div_ceil(2 * QUADS * QUADS), textures, side).expect("room for a scene");
    println!(
        "{triangles} triangles or a few more; {textures} textures of {:.1} MB together",
        f64::from(textures) * f64::from(side * side) * 3e-6
    );
    let before = Memory::now();

    let start = Instant::now();
    let mut last = start;
    let mut lap = |what: &str| {
        println!("{what:<8}{:>6.2} s", last.elapsed().as_secs_f64());
        last = Instant::now();
    };
    let loaded = load::load(&folder.path().join("scene.xml"), &[], &Library::default()).expect("a good scene");
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    lap("load");
    println!("{:<8}{:>6.2} GB, at most {:.2} GB", "", Memory::now().resident - before.resident, Memory::now().most);
    let description = loaded.description;
    let scene = Scene::new(&description).expect("a good scene");
    lap("build");
    let film = Film::new(&description.film).expect("a film");
    let job = Job {
        strategy: Strategy { techniques: Techniques::BIDIRECTIONAL, heuristic: Heuristic::Balance, max_depth: u32::MAX, rr_depth: 5 },
        seed: 1,
        numbers: Numbers::default(),
        threads: std::thread::available_parallelism().map_or(1, usize::from),
        target: Target::Samples(1),
        width: description.film.width,
        strictness: Strictness::Lenient,
    };
    let mut director = Auto::new(&description, &Effects::of(&description, &scene));
    render::directed(&scene, &film, &job, &mut director, &AtomicBool::new(false), |_| None);
    lap("render");
    let mean = film.develop().pixels.iter().flatten().map(|&v| f64::from(v)).sum::<f64>();
    assert!(mean > 0.0, "the picture is black");
    let total = start.elapsed().as_secs_f64();
    println!("{:<8}{total:>6.2} s, of {MOST} s; at most {:.2} GB of memory", "total", Memory::now().most);
    ExitCode::from(u8::from(total > MOST))
}

/// GB, as Linux tells them; 0 elsewhere.
struct Memory {
    resident: f64,
    most: f64,
}

impl Memory {
    fn now() -> Self {
        let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
        let of = |name: &str| -> f64 {
            let line = status.lines().find_map(|line| line.strip_prefix(name));
            line.and_then(|line| line.trim_start_matches(':').trim().trim_end_matches(" kB").parse::<f64>().ok()).unwrap_or(0.0) * 1024e-9
        };
        Self { resident: of("VmRSS"), most: of("VmHWM") }
    }
}

fn write_scene(folder: &Path, meshes: u32, textures: u32, side: u32) -> io::Result<()> {
    let mut scene = String::from(
        r#"<scene version="3.0.0"><integrator type="path"><integer name="max_depth" value="6"/></integrator>
        <sensor type="perspective"><float name="fov" value="50"/>
            <transform name="to_world"><lookat origin="-3, -3, 6" target="4, 4, 0" up="0, 0, 1"/></transform>
            <film type="hdrfilm"><integer name="width" value="640"/><integer name="height" value="360"/></film></sensor>
        <emitter type="constant"/>"#,
    );
    let mut noise = 1_u32;
    for texture in 0..textures {
        let mut bytes = || {
            noise = noise.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
            (noise >> 26) as u8
        };
        let pixel = |x: u32, y: u32, low: u8| [(x * 191 / side) as u8 + low, (y * 191 / side) as u8 + low, (texture % 192) as u8 + low];
        let pixels: Vec<u8> = (0..side * side).flat_map(|i| pixel(i % side, i / side, bytes())).collect();
        let picture = image::RgbImage::from_raw(side, side, pixels).expect("as many as pixels");
        picture.save(folder.join(format!("{texture}.png"))).map_err(io::Error::other)?;
        write!(
            scene,
            r#"<bsdf type="diffuse" id="m{texture}"><texture type="bitmap" name="reflectance"><string name="filename" value="{texture}.png"/></texture></bsdf>"#
        )
        .map_err(io::Error::other)?;
    }
    // Each mesh is four files, so that textures and meshes are as many as each other.
    let across = f64::from(meshes).sqrt().ceil() as u32;
    for mesh in 0..4 * meshes {
        write_mesh(&folder.join(format!("{mesh}.ply")), mesh)?;
        let (tile, part) = (mesh / 4, mesh % 4);
        let at = [tile % across, tile / across].map(f64::from);
        let [x, y] = [at[0] + 0.5 * f64::from(part % 2), at[1] + 0.5 * f64::from(part / 2)];
        write!(
            scene,
            r#"<shape type="ply"><string name="filename" value="{mesh}.ply"/><transform name="to_world"><scale value="0.5"/><translate x="{x}" y="{y}"/></transform><ref id="m{}"/></shape>"#,
            mesh % textures.max(1)
        )
        .map_err(io::Error::other)?;
    }
    scene.push_str("</scene>");
    fs::write(folder.join("scene.xml"), scene)
}

/// Hills over the unit square: a quarter of the quads of a mesh.
fn write_mesh(path: &Path, seed: u32) -> io::Result<()> {
    let mut file = BufWriter::new(fs::File::create(path)?);
    let quads = QUADS / 2;
    let (vertices, triangles) = ((quads + 1) * (quads + 1), 2 * quads * quads);
    write!(
        file,
        "ply\nformat binary_little_endian 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\nproperty float z\n\
         property float u\nproperty float v\nelement face {triangles}\nproperty list uchar int vertex_indices\nend_header\n"
    )?;
    for i in 0..vertices {
        let [u, v] = [i % (quads + 1), i / (quads + 1)].map(|x| x as f32 / quads as f32);
        let z = 0.1 * ((9.0 + seed as f32) * u).sin() * ((7.0 + 2.0 * seed as f32) * v).sin();
        for value in [u, v, z, u, v] {
            file.write_all(&value.to_le_bytes())?;
        }
    }
    for i in 0..quads * quads {
        let first = i / quads * (quads + 1) + i % quads;
        for corners in [[first, first + 1, first + quads + 2], [first, first + quads + 2, first + quads + 1]] {
            file.write_all(&[3])?;
            for corner in corners {
                file.write_all(&corner.to_le_bytes())?;
            }
        }
    }
    file.flush()
}
