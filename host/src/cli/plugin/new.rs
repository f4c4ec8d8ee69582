//! `bidir plugin new`.

use std::{
    fs,
    path::{Path, PathBuf},
};

use super::{say, templates};
use crate::{
    cli::{Outcome, arguments::NewPlugin},
    error::{Error, Result},
    load::catalog,
};

/// The SDK of the checkout that this program was built from, which need not be there any more.
const SDK: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../plugins/sdk");

/// Names that the Rust projects cannot have: crates and keywords of the language, types of the SDK in lower case.
const TAKEN: &str = "\
    abstract alloc as async await become box break bsdf carried const continue core crate do dyn else emitted enum extern \
    false final fn for frame gen if impl in let lobe loop macro made match mod move mut override priv profile profiled pub \
    real ref return scatter scattered self spectrum static std struct super test trait true try type typeof union unsafe \
    unsized use virtual where while yield";

pub(super) fn run(arguments: &NewPlugin) -> Result<Outcome> {
    let NewPlugin { name, kind, language, output, .. } = arguments;
    check_name(name)?;
    let sdk = if language == "rust" { sdk(arguments.sdk.as_deref())? } else { String::new() };
    let folder = output.clone().unwrap_or_else(|| PathBuf::from(name));
    check_free(&folder)?;
    let files = templates::files(language, kind)
        .ok_or_else(|| Error::new(format!("there is no project of a {kind} in {language}"), "see bidir plugin new --help"))?;
    for (path, text) in files {
        write(&folder.join(path), &templates::filled(text, name, &sdk))?;
    }
    say(&format!(
        "Next:\n  cd {}\n  sh build.sh\n  bidir plugin inspect {name}.wasm\n  bidir render scene.xml -o {name}.png\nREADME.md says more.\nwrote {}",
        folder.display(),
        folder.display()
    ));
    Ok(Outcome::Done)
}

fn check_name(name: &str) -> Result<()> {
    let refused = |why: &str| Err(Error::new(format!("a plugin cannot be called \"{name}\": {why}"), "give it another name"));
    let mut letters = name.chars();
    if !letters.next().is_some_and(|c| c.is_ascii_lowercase()) || !letters.all(|c| c.is_ascii_lowercase() || c.is_ascii_digit()) {
        return refused("a name is a lower-case letter, then lower-case letters and digits");
    }
    if ["bsdf", "emitter"].into_iter().any(|tag| catalog::supported(tag).contains(&name)) {
        return refused("there is a built-in of that name, which would win");
    }
    if TAKEN.split_whitespace().any(|taken| taken == name) {
        return refused("the word has a meaning of its own in a project's source");
    }
    Ok(())
}

/// Nothing that is there already is written over.
fn check_free(folder: &Path) -> Result<()> {
    let refused = |thing: &str| Err(Error::in_file(folder, thing, "name a new folder with -o DIR"));
    match fs::read_dir(folder) {
        Ok(mut entries) => entries.next().map_or(Ok(()), |_| refused("the folder is not empty")),
        Err(_) if folder.exists() => refused("it is there already, and is no folder that can be read"),
        Err(_) => Ok(()),
    }
}

/// The path of the SDK as a project's manifest writes it.
fn sdk(given: Option<&Path>) -> Result<String> {
    let path = given.unwrap_or(Path::new(SDK));
    let found = path.join("Cargo.toml").is_file().then(|| path.canonicalize().ok()).flatten();
    let Some(found) = found else {
        let thing =
            if given.is_some() { "there is no SDK in that folder" } else { "the SDK that this program came with is not there any more" };
        return Err(Error::in_file(path, thing, "name the folder plugins/sdk of a checkout with --sdk PATH"));
    };
    // In a string of TOML these two would mean something else.
    Ok(found.to_string_lossy().replace('\\', "\\\\").replace('"', "\\\""))
}

fn write(file: &Path, text: &str) -> Result<()> {
    let made = file.parent().map_or(Ok(()), fs::create_dir_all).and_then(|()| fs::write(file, text));
    made.map_err(|error| Error::in_file(file, format!("it cannot be written: {error}"), "name another folder with -o DIR"))
}
