//! `bidir plugin`: new, list, inspect.

mod inspect;
mod list;
mod new;
mod table;
pub(super) mod templates;

use std::{
    io::{self, Write},
    path::Path,
};

use serde::Serialize;

use crate::{
    cli::{Outcome, arguments::Plugin},
    error::{Error, Result},
    plugin::Manifest,
};

pub(super) fn run(command: &Plugin) -> Result<Outcome> {
    match command {
        Plugin::New(arguments) => new::run(arguments),
        Plugin::List(arguments) => list::run(arguments),
        Plugin::Inspect(arguments) => inspect::run(arguments),
    }
}

/// What a scene calls the module: the name of its file.
fn type_name(file: &Path) -> String {
    file.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default()
}

/// The lobes of a BSDF, or where a light can shine from.
fn reach(manifest: &Manifest) -> String {
    let places = manifest.emits_from.iter().map(|place| place.name());
    manifest.lobes.iter().map(String::as_str).chain(places).collect::<Vec<_>>().join(", ")
}

/// Who stops reading halfway (`| head`) has read enough.
fn say(words: &str) {
    let _ = writeln!(io::stdout(), "{words}");
}

fn json(report: &impl Serialize) -> Result<String> {
    serde_json::to_string_pretty(report).map_err(|error| Error::new(format!("no JSON: {error}"), "this is a bug; please report it"))
}
