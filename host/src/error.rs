//! The one error a user sees: file, place, thing, remedy.

use std::{
    fmt,
    path::{Path, PathBuf},
};

/// What this crate's functions return.
pub type Result<T> = std::result::Result<T, Error>;

/// Where in a file something is wrong; lines and columns count from 1.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The file.
    pub file: PathBuf,
    /// Line and column, where they are known.
    pub position: Option<(u32, u32)>,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file.display())?;
        match self.position {
            Some((line, column)) => write!(f, ":{line}:{column}"),
            None => Ok(()),
        }
    }
}

/// What went wrong, where, and what to do about it. Displays as `file:line:column: thing; remedy`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    /// Where, if it is in a file.
    pub place: Option<Place>,
    /// The thing that is wrong, in one clause.
    pub thing: String,
    /// What to do; may be empty.
    pub remedy: String,
    /// Who is to blame.
    pub blame: Blame,
}

/// Who is to blame for an error.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Blame {
    /// What was given: a file, a value, a name.
    #[default]
    Input,
    /// A plugin that ran and broke off.
    Plugin,
}

impl Error {
    /// An error without a place.
    pub fn new(thing: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self { place: None, thing: thing.into(), remedy: remedy.into(), blame: Blame::Input }
    }

    /// An error somewhere in a file.
    pub fn in_file(file: &Path, thing: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self {
            place: Some(Place { file: file.to_owned(), position: None }),
            thing: thing.into(),
            remedy: remedy.into(),
            blame: Blame::Input,
        }
    }

    /// An error at a place.
    pub fn at(place: &Place, thing: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self { place: Some(place.clone()), thing: thing.into(), remedy: remedy.into(), blame: Blame::Input }
    }
}

impl Error {
    /// A plugin broke off.
    pub fn plugin(thing: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self { blame: Blame::Plugin, ..Self::new(thing, remedy) }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(place) = &self.place {
            write!(f, "{place}: ")?;
        }
        write!(f, "{}", self.thing)?;
        if !self.remedy.is_empty() {
            write!(f, "; {}", self.remedy)?;
        }
        Ok(())
    }
}

impl std::error::Error for Error {}
