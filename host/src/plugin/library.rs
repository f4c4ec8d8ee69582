//! Where plugins are found.

use std::{
    cell::{OnceCell, RefCell},
    collections::HashMap,
    ffi::OsStr,
    fs,
    path::{Path, PathBuf},
    sync::Arc,
};

use super::{engine::Engine, module::Module};
use crate::error::{Error, Result};

/// The environment variable that names folders of plugins, as `PATH` does programs.
pub const VARIABLE: &str = "BIDIR_PLUGINS";

/// The ending of a module's file.
const ENDING: &str = "wasm";

/// Folders of plugins, and the modules loaded from them: each file once.
#[derive(Debug, Default)]
pub struct Library {
    folders: Vec<PathBuf>,
    engine: OnceCell<Engine>,
    loaded: RefCell<HashMap<PathBuf, Arc<Module>>>,
    instead: &'static [(&'static str, &'static [u8])],
}

impl Library {
    /// Looks into `folders`, in their order.
    pub fn new(folders: Vec<PathBuf>) -> Self {
        Self { folders, ..Self::default() }
    }

    /// Looks into `folders`, and then into those that the environment names.
    pub fn with_environment(mut folders: Vec<PathBuf>) -> Self {
        if let Some(named) = std::env::var_os(VARIABLE) {
            folders.extend(std::env::split_paths(&named).filter(|folder| !folder.as_os_str().is_empty()));
        }
        Self::new(folders)
    }

    /// With modules that stand for built-ins of their names, wherever they know all that a scene says of one.
    pub fn instead_of_built_ins(self, modules: &'static [(&'static str, &'static [u8])]) -> Self {
        Self { instead: modules, ..self }
    }

    /// The module that stands for a built-in.
    ///
    /// # Errors
    /// As [`Module::from_bytes`].
    pub fn instead_of(&self, kind: &str) -> Result<Option<Arc<Module>>> {
        let Some((name, bytes)) = self.instead.iter().find(|(name, _)| *name == kind) else { return Ok(None) };
        self.once(Path::new(name), |engine| Module::from_bytes(engine, Path::new(name), bytes, None)).map(Some)
    }

    /// The file of a plugin of type `kind`, as a scene writes it: in one of the folders `near`, or in those of the library.
    /// A type that ends in `.wasm` may lead through folders.
    pub fn find(&self, kind: &str, near: &[PathBuf]) -> Option<PathBuf> {
        let name = if is_module(kind) {
            PathBuf::from(kind)
        } else if !kind.is_empty() && kind.chars().all(|c| c.is_alphanumeric() || matches!(c, '_' | '-')) {
            PathBuf::from(format!("{kind}.{ENDING}"))
        } else {
            return None;
        };
        near.iter().chain(&self.folders).map(|folder| folder.join(&name)).find(|file| file.is_file())
    }

    /// The folders of the library.
    pub fn folders(&self) -> &[PathBuf] {
        &self.folders
    }

    /// Loads a module, or gives the one that was loaded from that file before.
    ///
    /// # Errors
    /// As [`Module::load`].
    pub fn load(&self, file: &Path) -> Result<Arc<Module>> {
        self.once(file, |engine| Module::load(engine, file))
    }

    fn once(&self, file: &Path, load: impl FnOnce(&Engine) -> Result<Module>) -> Result<Arc<Module>> {
        if let Some(known) = self.loaded.borrow().get(file) {
            return Ok(Arc::clone(known));
        }
        let engine = match self.engine.get() {
            Some(engine) => engine,
            None => {
                let engine = Engine::new()?;
                self.engine.get_or_init(|| engine)
            }
        };
        let module = Arc::new(load(engine)?);
        self.loaded.borrow_mut().insert(file.to_owned(), Arc::clone(&module));
        Ok(module)
    }
}

/// Whether a type names a module's file.
pub fn is_module(kind: &str) -> bool {
    Path::new(kind).extension() == Some(OsStr::new(ENDING))
}

/// Every module in a folder, by name.
///
/// # Errors
/// If the folder cannot be read.
pub fn modules(folder: &Path) -> Result<Vec<PathBuf>> {
    let unread = |error: std::io::Error| Error::in_file(folder, format!("it cannot be read: {error}"), "name a folder of plugins");
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).map_err(unread)? {
        let path = entry.map_err(unread)?.path();
        if path.is_file() && path.extension() == Some(OsStr::new(ENDING)) {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}
