//! Scenes in XML.

use std::path::{Path, PathBuf};

use bidir::{load, plugin::Library};

use crate::{told, trace};

/// The most primitives of a scene that is built.
const MOST_PRIMITIVES: usize = 10_000;

/// The folder of the files that inputs may name.
fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("beside")
}

thread_local! {
    /// Kept, so that a module is compiled once.
    static LIBRARY: Library = Library::new(vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("../corpus/module")]);
}

/// A scene is refused with a remedy, or is built and traced.
pub fn scene_xml(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    let folder = folder();
    let loaded = LIBRARY.with(|library| load::load_str(text, &folder.join("fuzz.xml"), Some(&folder), &[], library));
    let loaded = match loaded {
        Ok(loaded) => loaded,
        Err(error) => return told(&error),
    };
    assert!(loaded.warnings.iter().all(|warning| !warning.trim().is_empty()));
    if loaded.description.primitives() <= MOST_PRIMITIVES {
        trace::built(&loaded.description);
    }
}
