//! Nothing for what is absent: counts the instructions of a camera path in a plain scene, with the preset for any scene, with the one
//! that a render chooses, and of a path tracer stripped by hand to such scenes. The chosen one may take 2 % more than the last.
//!
//! Valgrind's callgrind counts exactly; this program runs itself in it. Two sample counts tell a path from what comes once.

mod stripped;

use std::{
    env, fs,
    path::Path,
    process::{Command, ExitCode},
    sync::atomic::AtomicBool,
};

use bidir::{
    film::Film,
    image::Image,
    render::{self, Job},
    scene::Scene,
};
use bidir_kernel::{Effects, Heuristic};
use bidir_tests::{
    pictures::{PATH, Subject},
    scenes::{area, camera, depth, diffuse, film, read, shape},
};
use stripped::Stripped;

/// How much more than the stripped path tracer the chosen preset may take.
const MOST: f64 = 1.02;

/// How far its image may be from the others: relative to the mean of all pixels. All take the same samples; they round differently.
const ROUNDED: f64 = 1e-5;

const SIZE: u32 = 64;

const SEED: u64 = 1;

/// Samples per pixel.
const SAMPLES: [u32; 2] = [2, 6];

const WAYS: [&str; 3] = ["full", "chosen", "stripped"];

/// Three walls, a cube and a lamp, all matt.
fn subject() -> Subject {
    let grey = diffuse("0.6, 0.6, 0.6");
    let wall = |transform: &str| shape("rectangle", transform, &grey);
    read(
        &[
            depth(8),
            camera("perspective", &film(SIZE)),
            wall(r#"<scale value="2"/><rotate x="1" angle="-90"/>"#),
            wall(r#"<scale value="2"/><translate value="0, 1.5, -2"/>"#),
            wall(r#"<scale value="2"/><rotate y="1" angle="90"/><translate value="-2, 1.5, 0"/>"#),
            shape("cube", r#"<scale value="0.5"/><rotate y="1" angle="20"/><translate value="0, 0.5, 0"/>"#, &grey),
            shape(
                "rectangle",
                r#"<scale value="0.5"/><rotate x="1" angle="90"/><translate value="0, 2.8, 0"/>"#,
                &(grey.clone() + &area(5.0)),
            ),
        ]
        .concat(),
    )
}

/// Renders in one of the [`WAYS`], on one thread.
fn rendered(way: &str, samples: u32) -> Result<Image, String> {
    let subject = subject();
    let film = Film::new(&subject.description.film).map_err(|error| error.to_string())?;
    let job = subject.job(subject.strategy(PATH, Heuristic::Balance), samples, SEED);
    match way {
        "full" => render(&subject.scene.with_effects(Effects::ALL), &film, &job),
        "chosen" => render(&subject.scene, &film, &job),
        "stripped" => {
            Stripped::new(&subject.scene, &subject.description).ok_or("the scene is not plain")?.render(&film, SEED, SIZE, samples)
        }
        _ => return Err(format!("{way} is none of {WAYS:?}")),
    }
    Ok(film.develop())
}

fn render(scene: &Scene, film: &Film, job: &Job) {
    render::render(scene, film, job, &AtomicBool::new(false), |_| None);
}

/// Renders and leaves the image's numbers in a file: what is counted.
fn leave(way: &str, samples: &str, file: &str) -> Result<(), String> {
    let image = rendered(way, samples.parse().map_err(|_| format!("{samples} is no number of samples"))?)?;
    let bytes: Vec<_> = image.pixels.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
    fs::write(file, bytes).map_err(|error| error.to_string())
}

/// What one way took and made.
struct Counted {
    per_path: f64,
    pixels: Vec<f32>,
}

fn counted(way: &str, folder: &Path) -> Result<Counted, String> {
    let [(few, _), (many, pixels)] = [one(way, SAMPLES[0], folder)?, one(way, SAMPLES[1], folder)?];
    let paths = f64::from(SIZE * SIZE) * f64::from(SAMPLES[1] - SAMPLES[0]);
    Ok(Counted { per_path: (many as f64 - few as f64) / paths, pixels })
}

/// How many instructions one run takes, and its image.
fn one(way: &str, samples: u32, folder: &Path) -> Result<(u64, Vec<f32>), String> {
    let program = env::current_exe().map_err(|error| error.to_string())?;
    let (counts, image) = (folder.join("counts"), folder.join("image"));
    let output = Command::new("valgrind")
        .arg("--tool=callgrind")
        .arg(format!("--callgrind-out-file={}", counts.display()))
        .arg(program)
        .args([way, &samples.to_string()])
        .arg(&image)
        .output()
        .map_err(|error| format!("valgrind cannot be run ({error}); install it, Debian's package has that name"))?;
    if !output.status.success() {
        return Err(format!("{way} failed:\n{}", String::from_utf8_lossy(&output.stderr)));
    }
    let text = fs::read_to_string(&counts).map_err(|error| error.to_string())?;
    let total = text.lines().find_map(|line| line.strip_prefix("summary: ")?.trim().parse().ok());
    let bytes = fs::read(&image).map_err(|error| error.to_string())?;
    let pixels = bytes.as_chunks().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect();
    Ok((total.ok_or("callgrind counted nothing")?, pixels))
}

/// The largest difference of two images, relative to the mean of one.
fn apart(a: &[f32], b: &[f32]) -> f64 {
    let mean = b.iter().map(|v| f64::from(*v)).sum::<f64>() / b.len() as f64;
    a.iter().zip(b).map(|(a, b)| (f64::from(*a) - f64::from(*b)).abs()).fold(0.0, f64::max) / mean
}

/// Counts, prints, and says what does not hold.
fn judged() -> Result<(), String> {
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let mut all = Vec::new();
    for way in WAYS {
        all.push(counted(way, folder.path())?);
    }
    let [full, chosen, stripped] = &all[..] else { return Err("not every way was counted".to_owned()) };
    println!("instructions per camera path; plain diffuse scene, {SIZE}×{SIZE} pixels, paths of up to 8 segments");
    for (way, counted) in WAYS.into_iter().zip(&all) {
        println!("{way:>10} {:>8.0}   {:.4} × stripped", counted.per_path, counted.per_path / stripped.per_path);
    }
    let apart = apart(&chosen.pixels, &stripped.pixels);
    println!("largest difference of chosen and stripped pixels: {apart:.1e} of the mean");
    if full.pixels.iter().zip(&chosen.pixels).any(|(a, b)| a.to_bits() != b.to_bits()) {
        return Err("the full and the chosen preset do not give the same image".to_owned());
    }
    if apart.is_nan() || apart > ROUNDED {
        return Err(format!("the stripped path tracer gives another image: more than {ROUNDED:e} of the mean apart"));
    }
    if chosen.per_path > MOST * stripped.per_path {
        return Err(format!(
            "the chosen preset takes {:.2} % more instructions than the stripped path tracer; {:.0} % are allowed",
            100.0 * (chosen.per_path / stripped.per_path - 1.0),
            100.0 * (MOST - 1.0)
        ));
    }
    Ok(())
}

fn main() -> ExitCode {
    let arguments: Vec<_> = env::args().skip(1).collect();
    let arguments: Vec<_> = arguments.iter().map(String::as_str).collect();
    let done = match arguments[..] {
        [] => judged(),
        [way, samples, file] => leave(way, samples, file),
        _ => Err("usage: instructions [full|chosen|stripped SAMPLES FILE]".to_owned()),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}
