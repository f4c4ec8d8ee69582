//! `bidir render`.

mod aovs;

use std::{
    path::{Path, PathBuf},
    sync::atomic::{AtomicBool, Ordering},
    time::{Duration, Instant},
};

use crate::{
    cli::{
        Outcome,
        arguments::{Render, SceneArguments},
        interrupt,
        progress::{Goal, Progress, Stages, Verbosity},
        stats::{self, CpuSeconds, Geometry, Seconds, Stats},
    },
    error::{Error, Result},
    film::{Both, Film, Noise, Pyramid},
    image::write::{self, Layers},
    load,
    plan::{Named, Plan, Stage, choice::Choice, effects::Effects, words},
    plugin::{Library, Strictness},
    render::{self, Auto, Director, Given, Job, Status, Target},
    scene::{Scene, description::Description},
};

use aovs::{Aovs, Developed};

/// The scene of a `render` without one.
const WELCOME: &str = include_str!("../../../examples/scenes/welcome.xml");
const WELCOME_NAME: &str = "welcome.xml";

/// The plan that ran, and how it came about.
struct Planned {
    plan: Plan,
    choice: Option<Choice>,
    /// Wall-clock time of pilots.
    elapsed: Duration,
}

/// Reads a scene, or the one that comes with the program, and says on standard error what the user should know of it.
pub(super) fn read(scene: Option<&Path>, from: &SceneArguments, stages: &mut Stages) -> Result<Description> {
    if let Some(folder) = from.plugins.iter().find(|folder| !folder.is_dir()) {
        return Err(Error::in_file(folder, "there is no such folder", "name a folder of plugins"));
    }
    stages.loading(scene.unwrap_or(Path::new(WELCOME_NAME)));
    let library = library(from);
    let loaded = match scene {
        Some(path) => load::load_watched(path, &from.defines, &library, &|done, of| stages.file(done, of))?,
        None => load::load_str(WELCOME, Path::new(WELCOME_NAME), None, &from.defines, &library)?,
    };
    stages.loaded();
    for warning in &loaded.warnings {
        eprintln!("warning: {warning}");
    }
    Ok(limited(loaded.description, from))
}

/// With paths as long as the command line has them.
pub(super) fn limited(mut description: Description, from: &SceneArguments) -> Description {
    if let Some(depth) = from.max_depth {
        description.integrator.max_depth = u32::try_from(depth).ok();
    }
    description
}

/// Where plugins are found.
pub(super) fn library(from: &SceneArguments) -> Library {
    Library::with_environment(from.plugins.clone())
}

/// What a bad answer of a plugin does.
pub(super) fn strictness(from: &SceneArguments) -> Strictness {
    if from.strict { Strictness::Strict } else { Strictness::Lenient }
}

/// Says what plugins did that was not right, and how the command ended.
pub(super) fn conclude(status: &Status) -> Result<Outcome> {
    for entry in &status.quarantine.0 {
        eprintln!("warning: {entry}");
    }
    if let Some(fault) = &status.fault {
        let error = Error::from(fault.clone());
        return Err(Error { thing: format!("{}; what was rendered before is saved", error.thing), ..error });
    }
    if status.failed {
        return Err(Error::new("a render thread broke down; what was rendered before is saved", "this is a bug; please report it"));
    }
    Ok(if status.interrupted { Outcome::Interrupted } else { Outcome::Done })
}

/// As many threads as asked for, or as the machine has.
pub(super) fn thread_count(asked: Option<u32>) -> usize {
    asked.map_or_else(|| std::thread::available_parallelism().map_or(1, usize::from), |threads| threads as usize)
}

fn default_output(scene: Option<&Path>) -> PathBuf {
    match scene.and_then(Path::file_stem) {
        Some(stem) => {
            let mut name = stem.to_owned();
            name.push(".exr");
            name.into()
        }
        None => PathBuf::from("welcome.png"),
    }
}

pub(super) fn run(arguments: &Render) -> Result<Outcome> {
    let start = Instant::now();
    let mut seconds = Seconds::default();
    let output = arguments.output.clone().unwrap_or_else(|| default_output(arguments.scene.as_deref()));
    write::check_writable(&output)?;
    if let Some(path) = &arguments.stats {
        stats::check_writable(path)?;
    }
    let given = match &arguments.plan {
        Some(path) => Some(Plan::read(path)?),
        None => arguments.integrator.stage().map(Plan::fixed),
    };

    let mut stages = Stages::new(verbosity(arguments.quiet));
    let loading = Instant::now();
    let description = read(arguments.scene.as_deref(), &arguments.from, &mut stages)?;
    seconds.load = loading.elapsed().as_secs_f64();
    let aovs = Aovs::new(&description, &arguments.aovs, &output)?;
    let pyramid = aovs.pyramid(&description)?;
    let building = Instant::now();
    stages.building(&description);
    let film = Film::new(&description.film)?;
    let scene = Scene::new(&description)?;
    seconds.build = building.elapsed().as_secs_f64();
    stages.built();
    if scene.degenerate() > 0 {
        eprintln!("warning: {} shapes or triangles without area were dropped", scene.degenerate());
    }

    let target = target(arguments, &description);
    let job = Job {
        strategy: Stage::BIDIRECTIONAL.strategy(&description.integrator),
        seed: arguments.seed.unwrap_or(description.seed),
        numbers: arguments.sampler,
        threads: thread_count(arguments.threads),
        target,
        width: description.film.width,
        strictness: strictness(&arguments.from),
    };
    let (mut progress, interrupt) = (progress(target, arguments.quiet), interrupt::flag());
    let report = |status: &Status| {
        let error = film.noise().map(|noise| noise.relmse);
        progress.update(status.samples, status.elapsed, error);
        error
    };
    let (mut status, planned) = match given {
        Some(plan) => {
            let mut director = Given { plan, integrator: description.integrator.clone() };
            (
                directed(&scene, &film, pyramid.as_ref(), &job, &mut director, &interrupt, report),
                Planned { plan: director.plan, choice: None, elapsed: Duration::ZERO },
            )
        }
        None => {
            let mut director = Auto::new(&description, &Effects::of(&description, &scene));
            let status = directed(&scene, &film, pyramid.as_ref(), &job, &mut director, &interrupt, report);
            (status, Planned { plan: director.plan().clone(), choice: director.choice().cloned(), elapsed: director.elapsed })
        }
    };
    progress.finish();
    seconds.plan = planned.elapsed.as_secs_f64();
    seconds.render = status.elapsed.saturating_sub(planned.elapsed).as_secs_f64();

    let layering = Instant::now();
    let layers = aovs.develop(&description, &scene, &job, &film, pyramid.as_ref(), status.samples, &interrupt)?;
    seconds.layers = layering.elapsed().as_secs_f64();
    status.interrupted |= interrupt.load(Ordering::Relaxed);
    save(&output, &film, &layers, &status, job.seed)?;
    if film.refused() > 0 {
        eprintln!("warning: {} contributions were not finite and were refused", film.refused());
    }
    seconds.total = start.elapsed().as_secs_f64();
    if let Some(path) = &arguments.stats {
        statistics(arguments, &description, &scene, &planned.plan, &job, &status, seconds, film.refused(), film.noise()).write(path)?;
    }
    if !arguments.quiet {
        let Status { samples, elapsed, .. } = &status;
        if let (Named::Auto, Some(stage), None) = (arguments.integrator, planned.plan.last(), &arguments.plan) {
            println!("plan: {}", words::line(stage, planned.choice.as_ref()));
        }
        println!("{samples} samples per pixel in {:.1} s: {}", elapsed.as_secs_f64(), output.display());
    }
    conclude(&status)
}

fn target(arguments: &Render, description: &Description) -> Target {
    match (arguments.time, arguments.error) {
        (Some(seconds), _) => Target::Time(Duration::from_secs_f64(seconds.min(1e9))),
        (_, Some(error)) => Target::Error(error),
        _ => Target::Samples(arguments.spp.unwrap_or(description.samples_per_pixel)),
    }
}

fn progress(target: Target, quiet: bool) -> Progress {
    let goal = match target {
        Target::Samples(samples) => Goal::Samples(samples),
        Target::Time(time) => Goal::Time(time),
        Target::Error(error) => Goal::Error(error),
    };
    Progress::new(goal, verbosity(quiet))
}

/// What `--quiet` means.
pub(super) fn verbosity(quiet: bool) -> Verbosity {
    if quiet { Verbosity::Quiet } else { Verbosity::Shown }
}

/// Onto the film, and onto one that keeps techniques apart where there is one.
fn directed(
    scene: &Scene,
    film: &Film,
    pyramid: Option<&Pyramid>,
    job: &Job,
    director: &mut impl Director,
    interrupt: &AtomicBool,
    report: impl FnMut(&Status) -> Option<f64>,
) -> Status {
    match pyramid {
        Some(pyramid) => render::directed(scene, &Both::new(film, pyramid), job, director, interrupt, report),
        None => render::directed(scene, film, job, director, interrupt, report),
    }
}

fn save(output: &Path, film: &Film, layers: &Developed, status: &Status, seed: u64) -> Result<()> {
    let image = film.develop();
    let note = |name: &str, value: String| (name.to_owned(), value);
    let notes = vec![
        note("renderer", format!("bidir {}", env!("CARGO_PKG_VERSION"))),
        note("spp", status.samples.to_string()),
        note("seed", seed.to_string()),
    ];
    write::write(output, &Layers { image: &image, named: layers.layers(), notes })
}

#[expect(clippy::too_many_arguments, reason = "the statistics are about everything there is")]
fn statistics(
    arguments: &Render,
    description: &Description,
    scene: &Scene,
    plan: &Plan,
    job: &Job,
    status: &Status,
    seconds: Seconds,
    refused: u64,
    noise: Option<Noise>,
) -> Stats {
    let crop = description.film.crop;
    let camera_paths = u64::from(status.samples) * u64::from(crop.width) * u64::from(crop.height);
    Stats {
        spp: status.samples,
        width: crop.width,
        height: crop.height,
        seconds,
        cpu_seconds: CpuSeconds { render: status.cpu.as_secs_f64() },
        camera_paths,
        light_paths: (plan.light_paths(status.samples) * f64::from(crop.width) * f64::from(crop.height)).round() as u64,
        rays: status.rays,
        refused,
        quarantined: status.quarantine.count(),
        estimated_error: noise.map(|noise| noise.relmse),
        integrator: if arguments.plan.is_some() { "plan" } else { arguments.integrator.name() },
        plan: plan.clone(),
        threads: job.threads,
        seed: job.seed,
        sampler: job.numbers,
        geometry: Geometry::of(scene),
        version: env!("CARGO_PKG_VERSION"),
        interrupted: status.interrupted,
    }
}
