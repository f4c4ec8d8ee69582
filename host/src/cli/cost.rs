//! `bidir cost`.

use std::{
    fmt::Write,
    fs,
    io::{self, IsTerminal},
    path::Path,
    time::Duration,
};

use sha2::{Digest, Sha256};

use crate::{
    check::builtin,
    cli::{
        Outcome,
        arguments::{Cost, SceneArguments},
        interrupt,
        progress::Stages,
        render::{library, limited, read, strictness, thread_count, verbosity},
    },
    cost::{self, Settings, curve, page, subject::Subject},
    error::{Error, Result},
    load,
    plan::effects::Effects,
    scene::{
        Scene,
        description::{Description, EmitterKind, Material, PluginShader, ShapeLight},
    },
};

pub(super) fn run(arguments: &Cost) -> Result<Outcome> {
    let folder = &arguments.output;
    if folder.exists() && !folder.is_dir() {
        return Err(Error::in_file(folder, "this is a file, and the report needs a folder", "name a folder, new or old"));
    }
    let mut stages = Stages::new(verbosity(arguments.quiet));
    let description = read(Some(&arguments.scene), &arguments.from, &mut stages)?;
    fs::create_dir_all(folder)
        .map_err(|error| Error::in_file(folder, format!("the folder cannot be made: {error}"), "name one where you may write"))?;
    stages.building(&description);
    let scene = Scene::new(&description)?;
    let sandboxed = sandboxed(&arguments.scene, &arguments.from, modules(&description).len());
    stages.built();
    let digest = digest(arguments, &description)?;
    let subject = Subject {
        name: arguments.scene.display().to_string(),
        effects: Effects::of(&description, &scene),
        threads: thread_count(arguments.threads),
        seed: arguments.seed.unwrap_or(description.seed),
        strictness: strictness(&arguments.from),
        description,
        scene,
    };
    let settings = Settings {
        folder: folder.clone(),
        budget: Duration::from_secs_f64(arguments.budget.min(1e9)),
        references: arguments.references.clone(),
        digest,
    };
    let interrupt = interrupt::flag();
    let mut progress = |what: &str, share: f64| {
        if !arguments.quiet {
            say(what, share);
        }
    };
    let report = cost::measure(&subject, sandboxed, &settings, &interrupt, &mut progress)?;
    page::write(folder, &report)?;
    if !arguments.quiet && io::stderr().is_terminal() {
        eprintln!();
    }
    for what in &report.left_out {
        eprintln!("warning: left out: {what}");
    }
    if !arguments.quiet {
        for prices in &report.prices {
            let words = prices.targets.iter().filter_map(|price| {
                let about = if price.how == curve::How::Measured { "" } else { "about " };
                Some(format!("{:.0e} in {about}{}", price.relmse, curve::seconds(price.cpu?)))
            });
            println!("{:<5} relMSE {}", prices.method, words.collect::<Vec<_>>().join(", "));
        }
        let rest = match (report.interrupted, report.out_of_time) {
            (true, _) => "; not all of it, run again to go on",
            (false, true) => "; not all of it, give a larger --budget and another folder",
            _ => "",
        };
        println!("{:.0} s{rest}: {}", report.spent, folder.join(page::NAME).display());
    }
    Ok(if interrupt.load(std::sync::atomic::Ordering::Relaxed) { Outcome::Interrupted } else { Outcome::Done })
}

/// One line that is written over on a terminal, or a line each.
fn say(what: &str, share: f64) {
    let percent = 100.0 * share.min(1.0);
    if io::stderr().is_terminal() {
        eprint!("\r\x1b[2K{percent:3.0} % {what}");
    } else {
        eprintln!("{percent:3.0} % {what}");
    }
}

/// The scene with modules for its built-in shaders; `None` if that makes no more than it has anyway.
fn sandboxed(path: &Path, from: &SceneArguments, own: usize) -> Option<(Description, Scene)> {
    let library = library(from).instead_of_built_ins(&builtin::MODULES);
    let built = load::load(path, &from.defines, &library).and_then(|loaded| {
        let description = limited(loaded.description, from);
        let scene = Scene::new(&description)?;
        Ok((description, scene))
    });
    match built {
        Ok((description, scene)) => (modules(&description).len() > own).then_some((description, scene)),
        Err(error) => {
            eprintln!("warning: the knob `plugins` is left out: {error}");
            None
        }
    }
}

/// The shaders that are modules.
fn modules(description: &Description) -> Vec<&PluginShader> {
    let materials = description.materials.iter().filter_map(|material| match material {
        Material::Plugin(shader) => Some(shader),
        _ => None,
    });
    let shining = description.all_shapes().filter_map(|shape| match &shape.light {
        Some(ShapeLight::Plugin(shader)) => Some(shader),
        _ => None,
    });
    let emitters = description.emitters.iter().filter_map(|emitter| match &emitter.kind {
        EmitterKind::PluginPoint { shader, .. } | EmitterKind::PluginEnvironment { shader, .. } => Some(shader),
        _ => None,
    });
    materials.chain(shining).chain(emitters).collect()
}

/// Of all that what was measured depends on and that may be another the next time: the scene's text, what is defined in it, modules,
/// references, this program.
fn digest(arguments: &Cost, description: &Description) -> Result<String> {
    let Cost { scene, from, references, .. } = arguments;
    let mut hash = Sha256::new();
    let mut add = |file: &Path| -> Result<()> {
        let bytes = fs::read(file).map_err(|error| Error::in_file(file, format!("it cannot be read: {error}"), "name a file that can"))?;
        hash.update(bytes.len().to_le_bytes());
        hash.update(bytes);
        Ok(())
    };
    add(scene)?;
    references.iter().try_for_each(|file| add(file))?;
    let mut files: Vec<_> = modules(description).iter().map(|shader| shader.module.file()).collect();
    files.sort();
    files.dedup();
    files.into_iter().try_for_each(&mut add)?;
    hash.update(format!("{:?} {:?} {}", from.defines, from.max_depth, from.strict));
    if let Ok(program) = std::env::current_exe().and_then(fs::read) {
        hash.update(program);
    }
    Ok(hash.finalize().iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    }))
}
