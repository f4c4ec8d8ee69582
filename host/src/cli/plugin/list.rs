//! `bidir plugin list`.

use std::path::{Path, PathBuf};

use serde::Serialize;

use super::{json, reach, say, table::aligned, type_name};
use crate::{
    cli::{Outcome, arguments::ListPlugins, complain},
    error::Result,
    plugin::{Library, Manifest, describe, modules},
};

/// A module and what it says of itself.
#[derive(Debug, Serialize)]
struct Listed {
    #[serde(rename = "type")]
    kind: String,
    file: PathBuf,
    manifest: Manifest,
}

pub(super) fn run(arguments: &ListPlugins) -> Result<Outcome> {
    let named = [arguments.folders.as_slice(), &arguments.plugins].concat();
    let library = Library::with_environment(named);
    // A scene finds what lies beside it without being told; so does the list.
    let here = [PathBuf::from(".")];
    let folders = if library.folders().is_empty() { &here } else { library.folders() };
    let (mut listed, mut all_good) = (Vec::new(), true);
    for folder in folders {
        let files = modules(folder).unwrap_or_else(|error| {
            complain(&error);
            all_good = false;
            Vec::new()
        });
        for file in files {
            match read(&file) {
                Ok(module) => listed.push(module),
                Err(error) => {
                    complain(&error);
                    all_good = false;
                }
            }
        }
    }
    if arguments.json {
        say(&json(&listed)?);
    } else {
        lines(&listed).iter().for_each(|line| say(line));
    }
    Ok(if all_good { Outcome::Done } else { Outcome::Refused })
}

fn read(file: &Path) -> Result<Listed> {
    Ok(Listed { kind: type_name(file), file: file.to_owned(), manifest: describe(file)? })
}

fn lines(listed: &[Listed]) -> Vec<String> {
    let row = |Listed { kind, manifest, .. }: &Listed| {
        [kind.clone(), manifest.kind.name().to_owned(), reach(manifest), manifest.description.clone()]
    };
    aligned(&listed.iter().map(row).collect::<Vec<_>>())
}
