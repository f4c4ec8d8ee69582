//! `--report`: the page of a check, as a file.

use std::{fs, path::PathBuf};

use crate::{
    check::{
        Plugin, Report,
        page::{self, Subject, quoted},
    },
    cli::arguments::Check,
    error::{Error, Result},
    partial::Partial,
    plugin::Kind,
};

/// What is being written, for messages.
const WHAT: &str = "report";

/// Makes the folder, and asks whether it takes files, before there is anything to lose.
pub(super) fn prepare(arguments: &Check) -> Result<()> {
    let Some(folder) = &arguments.report else { return Ok(()) };
    fs::create_dir_all(folder)
        .map_err(|error| Error::in_file(folder, format!("the folder cannot be made: {error}"), "choose another place"))?;
    Partial::create(&file(folder), WHAT).map(drop)
}

/// Writes the page, where there is to be one.
pub(super) fn write(plugin: &Plugin, kind: Kind, report: &Report, arguments: &Check, threads: usize) -> Result<()> {
    let Some(folder) = &arguments.report else { return Ok(()) };
    let plugins = arguments.plugins.iter().map(|folder| format!(" --plugins {}", quoted(&folder.to_string_lossy())));
    let command = format!("bidir check {}{}", quoted(&arguments.subject), plugins.collect::<String>());
    let subject = Subject { name: &arguments.subject, command: &command };
    let text = match kind {
        Kind::Bsdf => page::of_bsdfs(plugin, report, subject, threads),
        Kind::Light => page::of_lights(plugin, report, subject, threads),
    };
    Partial::write_text(&file(folder), WHAT, &text)
}

fn file(folder: &std::path::Path) -> PathBuf {
    folder.join("index.html")
}
