//! Hashes of files.

use std::{
    fs,
    path::{Path, PathBuf},
};

use sha2::{Digest, Sha256};

use crate::{Module, Result, failed};

/// The SHA-256 of everything that a module is built from: each file's path from `root` on, its length and its bytes,
/// in the order of the paths; tests are left out.
pub fn sources(root: &Path, module: &Module) -> Result<String> {
    let mut files = Vec::new();
    for source in &module.sources {
        add_files(source, &mut files)?;
    }
    files.sort();
    files.dedup();
    let mut hash = Sha256::new();
    for file in files {
        let bytes = fs::read(&file).map_err(failed("reading", &file))?;
        let path = file.strip_prefix(root).unwrap_or(&file).to_string_lossy().replace('\\', "/");
        hash.update(format!("{path}\n{}\n", bytes.len()));
        hash.update(bytes);
    }
    Ok(hexadecimal(&hash.finalize()))
}

/// The SHA-256 of a file.
pub fn file(path: &Path) -> Result<String> {
    let bytes = fs::read(path).map_err(failed("reading", path))?;
    Ok(hexadecimal(&Sha256::digest(bytes)))
}

fn add_files(path: &Path, files: &mut Vec<PathBuf>) -> Result<()> {
    if !path.is_dir() {
        files.push(path.to_path_buf());
        return Ok(());
    }
    for entry in fs::read_dir(path).map_err(failed("reading", path))? {
        let path = entry.map_err(failed("reading", path))?.path();
        // Tests are in no module.
        if !path.file_stem().is_some_and(|stem| stem.to_string_lossy().ends_with("tests")) {
            add_files(&path, files)?;
        }
    }
    Ok(())
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
