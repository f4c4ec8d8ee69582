//! `sources.json`: which sources the committed modules were built from.

use std::{collections::BTreeMap, fs, path::Path};

use serde::{Deserialize, Serialize};

use crate::{Language, Module, Result, compile::write_changed, failed, fingerprint};

/// The file's content: every committed module by name.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Sources(pub BTreeMap<String, Recorded>);

/// What is written down of a module when it is built.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Recorded {
    /// What it is written in.
    pub language: Language,
    /// Where, from the repository's folder on.
    pub folder: String,
    /// The compiler, as it names itself.
    pub compiler: String,
    /// The SHA-256 of the sources.
    pub sources: String,
    /// The SHA-256 of the module.
    pub module: String,
}

impl Sources {
    /// The file's name in the folder of the modules.
    pub const FILE: &str = "sources.json";

    /// Reads the file in the folder of the modules; nothing is recorded where there is none.
    pub fn read(folder: &Path) -> Result<Self> {
        let path = folder.join(Self::FILE);
        if !path.exists() {
            return Ok(Self::default());
        }
        let text = fs::read(&path).map_err(failed("reading", &path))?;
        serde_json::from_slice(&text).map_err(failed("reading", &path))
    }

    /// Writes the file.
    pub fn write(&self, folder: &Path) -> Result<()> {
        let path = folder.join(Self::FILE);
        let text = serde_json::to_string_pretty(self).map_err(failed("writing", &path))?;
        write_changed(&path, (text + "\n").as_bytes())
    }

    /// What is wrong with the committed modules, one line each; empty if nothing is. `modules` are all there should be.
    pub fn complaints(&self, root: &Path, folder: &Path, modules: &[Module]) -> Result<Vec<String>> {
        let mut complaints = Vec::new();
        for module in modules {
            let path = folder.join(format!("{}.wasm", module.name));
            let complaint = match self.0.get(&module.name) {
                _ if !path.is_file() => Some("is missing"),
                None => Some("is not recorded"),
                Some(recorded) if recorded.module != fingerprint::file(&path)? => Some("is not the one that was built"),
                Some(recorded) if recorded.sources != fingerprint::sources(root, module)? => Some("is older than its sources"),
                Some(_) => None,
            };
            complaints.extend(complaint.map(|what| format!("{0}.wasm {what}: cargo run -p bidir-prebuilt -- {0}", module.name)));
        }
        let known = |name: &str| modules.iter().any(|module| module.name == name);
        for entry in fs::read_dir(folder).map_err(failed("reading", folder))? {
            let name = entry.map_err(failed("reading", folder))?.file_name().to_string_lossy().into_owned();
            if name.strip_suffix(".wasm").is_some_and(|stem| !known(stem)) {
                complaints.push(format!("{name} has no sources: take it out, or put its folder into plugins/"));
            }
        }
        for name in self.0.keys().filter(|name| !known(name)) {
            complaints.push(format!("{} names {name}, which has no sources: cargo run -p bidir-prebuilt", Self::FILE));
        }
        Ok(complaints)
    }
}
