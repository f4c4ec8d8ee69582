//! A plugin's module: read, checked, compiled.

use std::{
    fmt, fs,
    io::Read,
    path::{Path, PathBuf},
};

use bidir_abi::{VERSION, limit};
use wasmtime::{InstancePre, Linker};

use super::{
    engine::{Clock, Engine},
    fault::{Cause, Fault},
    instance::{Failure, Instance, State},
    manifest::Manifest,
    outline::Outline,
};
use crate::error::{Blame, Error, Result};

/// A plugin that can be asked; every thread makes instances of its own.
pub struct Module {
    file: PathBuf,
    manifest: Manifest,
    exports: Vec<(String, String)>,
    bytes: usize,
    functions: u32,
    version: bidir_abi::Version,
    compiled: InstancePre<State>,
    clock: Clock,
}

impl fmt::Debug for Module {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Module").field("file", &self.file).field("manifest", &self.manifest).finish_non_exhaustive()
    }
}

impl Module {
    /// Reads, checks and compiles the module `file`, and tries it out once.
    ///
    /// # Errors
    /// If it cannot be read, or is not what `plugins/README.md` says; running nothing of it until all of that is checked.
    pub fn load(engine: &Engine, file: &Path) -> Result<Self> {
        let bytes = read(file)?;
        let sidecar = sidecar(file)?;
        Self::from_bytes(engine, file, &bytes, sidecar.as_deref())
    }

    /// A module that is in memory already; messages call it `file`. `sidecar` is its manifest if it holds none itself.
    ///
    /// # Errors
    /// As [`Module::load`].
    pub fn from_bytes(engine: &Engine, file: &Path, bytes: &[u8], sidecar: Option<&[u8]>) -> Result<Self> {
        if bytes.len() as u64 > limit::MAX_FILE_BYTES {
            return Err(too_large(file, bytes.len() as u64));
        }
        let refused = |thing: String| Error::in_file(file, thing, ABI_PAGE);
        let outline = Outline::read(bytes).map_err(refused)?;
        let manifest = manifest(file, &outline, sidecar)?;
        outline.check_exports(manifest.kind).map_err(refused)?;
        let invalid = |error: wasmtime::Error| refused(format!("the module is not valid: {}", error.root_cause()));
        let compiled = wasmtime::Module::new(engine.wasm(), bytes).map_err(invalid)?;
        let compiled = Linker::new(engine.wasm()).instantiate_pre(&compiled).map_err(invalid)?;
        let (exports, functions) = (outline.exports, outline.functions);
        let mut module = Self {
            file: file.to_owned(),
            manifest,
            exports,
            bytes: bytes.len(),
            functions,
            version: VERSION,
            compiled,
            clock: engine.clock(),
        };
        module.try_out()?;
        Ok(module)
    }

    /// Asks for its version, and makes one instance. No render is lost if that fails: it is the module that is refused.
    fn try_out(&mut self) -> Result<()> {
        let refused = |failure: Failure| Error { blame: Blame::Input, ..self.fault(*failure).into() };
        let theirs = Instance::version(&self.compiled).map_err(refused)?;
        if !VERSION.accepts(theirs) {
            let thing = format!(
                "it is written for version {}.{} of the plugin ABI; this program takes {}.0 to {}.{}",
                theirs.major, theirs.minor, VERSION.major, VERSION.major, VERSION.minor
            );
            return Err(Error::in_file(&self.file, thing, "build it with the SDK that comes with this program"));
        }
        self.instance(&self.manifest.defaults()).map_err(refused)?;
        self.version = theirs;
        Ok(())
    }

    /// The file, as messages call it.
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// What it says of itself.
    pub fn manifest(&self) -> &Manifest {
        &self.manifest
    }

    /// The version of the ABI that it is written for: major, minor.
    pub fn version(&self) -> (u16, u16) {
        (self.version.major, self.version.minor)
    }

    /// Its exports: name, and signature in words.
    pub fn exports(&self) -> &[(String, String)] {
        &self.exports
    }

    /// Of the file.
    pub fn bytes(&self) -> usize {
        self.bytes
    }

    /// How many functions it has.
    pub fn functions(&self) -> u32 {
        self.functions
    }

    /// A fresh instance with parameter blocks.
    pub(super) fn instance(&self, blocks: &[u8]) -> std::result::Result<Instance, Failure> {
        Instance::new(&self.compiled, self.clock.clone(), self.manifest.kind, blocks)
    }

    pub(super) fn fault(&self, (export, cause): (&'static str, Cause)) -> Fault {
        Fault { file: self.file.clone(), export, cause }
    }
}

const ABI_PAGE: &str = "see plugins/README.md for what a plugin has to be";

/// What the manifest of a file says, without running or compiling anything: what `bidir plugin list` shows.
///
/// # Errors
/// As [`Module::load`], as far as it looks.
pub fn describe(file: &Path) -> Result<Manifest> {
    let bytes = read(file)?;
    let sidecar = sidecar(file)?;
    let refused = |thing| Error::in_file(file, thing, ABI_PAGE);
    let outline = Outline::read(&bytes).map_err(refused)?;
    let manifest = manifest(file, &outline, sidecar.as_deref())?;
    outline.check_exports(manifest.kind).map_err(refused)?;
    Ok(manifest)
}

fn manifest(file: &Path, outline: &Outline, sidecar: Option<&[u8]>) -> Result<Manifest> {
    let Some(json) = outline.manifest.or(sidecar) else {
        let beside = file.with_extension("json");
        let thing = format!("it holds no section \"{}\", and there is no {}", bidir_abi::manifest::SECTION, beside.display());
        return Err(Error::in_file(file, thing, "give it a manifest, as plugins/README.md says"));
    };
    Manifest::read(json).map_err(|why| Error::in_file(file, format!("its manifest {why}"), ABI_PAGE))
}

/// The module's bytes; a file that is too large is not read.
fn read(file: &Path) -> Result<Vec<u8>> {
    let unread = |error: std::io::Error| Error::in_file(file, format!("it cannot be read: {error}"), "check the name and your rights");
    let mut bytes = Vec::new();
    // One byte more than allowed, so that a file that grows, or is none, cannot fill the memory.
    fs::File::open(file).map_err(unread)?.take(limit::MAX_FILE_BYTES + 1).read_to_end(&mut bytes).map_err(unread)?;
    if bytes.len() as u64 > limit::MAX_FILE_BYTES {
        let length = fs::metadata(file).map_or(bytes.len() as u64, |about| about.len());
        return Err(too_large(file, length));
    }
    Ok(bytes)
}

fn sidecar(file: &Path) -> Result<Option<Vec<u8>>> {
    let beside = file.with_extension("json");
    if beside.is_file() { read(&beside).map(Some) } else { Ok(None) }
}

fn too_large(file: &Path, bytes: u64) -> Error {
    Error::in_file(
        file,
        format!("it has {bytes} bytes, and a plugin may have {}", limit::MAX_FILE_BYTES),
        "build it without debug information",
    )
}
