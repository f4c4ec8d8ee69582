//! `bidir check`.

mod page;

use std::{
    io::{self, Write},
    num::NonZero,
    path::Path,
    sync::Arc,
    thread,
};

use serde::Serialize;

use crate::{
    check::{self, Case, Plugin, Report, Settings, Surfaces, builtin},
    cli::{Outcome, arguments::Check},
    error::{Error, Result},
    load::suggest::did_you_mean,
    plugin::{Engine, Kind, Library, Module, Value, is_module},
};

/// What there is to say of a check.
#[derive(Debug, Serialize)]
struct Checked<'a> {
    subject: &'a str,
    version: &'static str,
    #[serde(flatten)]
    report: Report,
}

pub(super) fn run(arguments: &Check) -> Result<Outcome> {
    let module = Arc::new(module(arguments)?);
    page::prepare(arguments)?;
    let given = arguments.set.iter().map(|(name, value)| (name.as_str(), value.as_str()));
    let report = match &arguments.replay {
        Some(text) => replay(&module, text, arguments)?,
        None => checked(&module, &check::values(module.manifest(), given)?, arguments)?,
    };
    let passed = report.passed;
    let words = if arguments.json {
        let checked = Checked { subject: &arguments.subject, version: env!("CARGO_PKG_VERSION"), report };
        serde_json::to_string_pretty(&checked)
            .map_err(|error| Error::new(format!("no JSON: {error}"), "this is a bug; please report it"))?
    } else {
        report.to_string()
    };
    // Who stops reading halfway (`| head`) has read enough.
    let _ = writeln!(io::stdout(), "{words}");
    Ok(if passed { Outcome::Done } else { Outcome::Wrong })
}

/// The module of a file, of a built-in, or of a type that is found as a scene's is.
fn module(arguments: &Check) -> Result<Module> {
    let name = arguments.subject.as_str();
    if let Some((_, bytes)) = builtin::MODULES.iter().find(|(known, _)| *known == name) {
        return Module::from_bytes(&Engine::new()?, Path::new(name), bytes, None);
    }
    if let Some((_, why)) = builtin::OTHERS.iter().find(|(known, _)| *known == name) {
        return Err(Error::new(format!("\"{name}\" cannot be checked alone"), *why));
    }
    if is_module(name) && Path::new(name).is_file() {
        return Module::load(&Engine::new()?, Path::new(name));
    }
    match Library::with_environment(arguments.plugins.clone()).find(name, &[]) {
        Some(file) => Module::load(&Engine::new()?, &file),
        None if is_module(name) => Module::load(&Engine::new()?, Path::new(name)),
        None => {
            let known: Vec<_> = builtin::MODULES.iter().map(|(name, _)| *name).collect();
            let remedy =
                format!("{}name a .wasm file, a folder with --plugins, or one of {}", did_you_mean(name, &known), known.join(", "));
            Err(Error::new(format!("\"{name}\" is no built-in, and no plugin of that name is found"), remedy))
        }
    }
}

fn checked(module: &Arc<Module>, given: &[(String, Value)], arguments: &Check) -> Result<Report> {
    let settings = Settings { seed: arguments.seed, threads: threads(arguments), effort: None };
    let plugin = Plugin::new(module, given, arguments.seed)?;
    let kind = module.manifest().kind;
    let report = match kind {
        Kind::Bsdf => check::bsdfs(&plugin, &settings),
        Kind::Light => check::lights(&plugin, &settings),
    };
    page::write(&plugin, kind, &report, arguments, settings.threads)?;
    Ok(report)
}

fn threads(arguments: &Check) -> usize {
    let threads = arguments.threads.map(|threads| threads as usize);
    threads.unwrap_or_else(|| thread::available_parallelism().map_or(1, NonZero::get))
}

fn replay(module: &Arc<Module>, text: &str, arguments: &Check) -> Result<Report> {
    let mut case: Case = text.parse().map_err(|why| Error::new(format!("the case {why}"), "copy one from what a check printed"))?;
    let given = case.given();
    let given = given.iter().map(|(name, value)| (name.as_str(), value.as_str()));
    let plugin = Plugin::with(module, &check::values(module.manifest(), given)?)?;
    // A case may have been edited: its one set is meant, however that is called.
    if let Some(set) = Surfaces::sets(&plugin).first() {
        case.parameters = set.name.clone();
    }
    let kind = module.manifest().kind;
    let report = match kind {
        Kind::Bsdf => check::replay_bsdf(&plugin, &case),
        Kind::Light => check::replay_light(&plugin, &case),
    }?;
    page::write(&plugin, kind, &report, arguments, threads(arguments))?;
    Ok(report)
}
