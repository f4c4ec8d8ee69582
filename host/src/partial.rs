//! Files that are either whole or not there.

use std::{
    ffi::OsString,
    fs::{self, File, OpenOptions},
    io::{self, Write},
    path::{Path, PathBuf},
    process,
};

use crate::error::{Error, Result};

/// A file beside the one to be written, which vanishes unless it is finished.
#[derive(Debug)]
pub struct Partial {
    file: File,
    path: PathBuf,
    target: PathBuf,
    what: &'static str,
}

impl Partial {
    /// Begins the file that will be `target`; `what` it is, for messages. Dropped at once, it tells whether the folder takes files.
    pub fn create(target: &Path, what: &'static str) -> Result<Self> {
        let refuse = |cause: &dyn std::fmt::Display| {
            let thing = format!("the {what} cannot be written: {cause}");
            Error::in_file(target, thing, "name a file in a folder that exists and can be written to")
        };
        let name = target.file_name().ok_or_else(|| refuse(&"it has no name"))?;
        if target.is_dir() {
            return Err(refuse(&"it is a folder"));
        }
        // Another process, or a thread of this one, may be writing the same file.
        for attempt in 0..100 {
            let mut hidden = OsString::from(".");
            hidden.push(name);
            hidden.push(format!(".{}-{attempt}.partial", process::id()));
            let path = target.with_file_name(hidden);
            match OpenOptions::new().write(true).create_new(true).open(&path) {
                Ok(file) => return Ok(Self { file, path, target: target.to_owned(), what }),
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(refuse(&error)),
            }
        }
        Err(refuse(&"unfinished files are in its way"))
    }

    /// Where its contents go.
    pub fn file(&mut self) -> &mut File {
        &mut self.file
    }

    /// Puts it in its place; what was there before is replaced.
    pub fn finish(self) -> Result<()> {
        fs::rename(&self.path, &self.target).map_err(|error| self.failed(&error))
    }

    /// A whole file of text.
    pub fn write_text(target: &Path, what: &'static str, text: &str) -> Result<()> {
        let mut partial = Self::create(target, what)?;
        match partial.file.write_all(text.as_bytes()) {
            Ok(()) => partial.finish(),
            Err(error) => Err(partial.failed(&error)),
        }
    }

    fn failed(&self, cause: &io::Error) -> Error {
        Error::in_file(&self.target, format!("the {} cannot be written: {cause}", self.what), "free some space, or choose another place")
    }
}

impl Drop for Partial {
    fn drop(&mut self) {
        // After `finish` there is no such file, and nobody can be told of any other failure here.
        let _ = fs::remove_file(&self.path);
    }
}
