//! The committed modules of `plugins/`, and the sources that they were built from.
//!
//! `cargo run -p bidir-prebuilt` builds every module into this folder and writes `sources.json`: for each module its
//! language, its folder, the SHA-256 of its sources and its own. `cargo run -p bidir-prebuilt -- NAME …` builds only those.
//! What there is to build is found, not listed: every member of the workspace in `plugins/` that makes a `cdylib`,
//! and every folder there with a `build.sh`.

pub mod compile;
pub mod discover;
pub mod fingerprint;
pub mod recorded;
pub mod tool;

pub use discover::{Language, Module, discover};
pub use recorded::{Recorded, Sources};

use std::path::{Path, PathBuf};

/// A message for people: what went wrong, and what to do.
pub type Result<T> = core::result::Result<T, String>;

/// The repository's folder.
pub fn root() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.ancestors().nth(2).unwrap_or(here).to_path_buf()
}

/// Where the modules are.
pub fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// Adds what was done and to what to an error of the system.
pub(crate) fn failed<E: core::fmt::Display>(doing: &str, path: &Path) -> impl FnOnce(E) -> String {
    move |error| format!("{doing} {}: {error}", path.display())
}
