//! A plugin that broke off.

use std::{fmt, path::PathBuf};

use crate::error::Error;

/// Why a call gave no answer at all. It ends the render: whatever the plugin would have answered is missing from the image.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// The module.
    pub file: PathBuf,
    /// What was called: an export, or "start" while the module was made ready.
    pub export: &'static str,
    /// What happened.
    pub cause: Cause,
}

/// What ended a call.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Cause {
    /// The code did what no code may.
    Trap(String),
    /// One call took too long.
    Endless,
    /// The calls of one tile took too long together.
    Slow,
    /// No instance could be made.
    Unready(String),
    /// An answer was refused, and none may be (`--strict`).
    Refused(String),
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}: {}", self.file.display(), self.export, self.cause)
    }
}

impl fmt::Display for Cause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Cause::Trap(what) => write!(f, "{what}"),
            Cause::Endless => write!(f, "one call ran for more than {} ms, and was stopped", super::instance::CALL_LIMIT.as_millis()),
            Cause::Slow => write!(f, "the calls of one tile took more than {} s together", super::instance::TILE_LIMIT.as_secs()),
            Cause::Unready(what) => write!(f, "no instance could be made: {what}"),
            Cause::Refused(what) => write!(f, "{what}"),
        }
    }
}

impl std::error::Error for Fault {}

impl From<Fault> for Error {
    fn from(fault: Fault) -> Self {
        let remedy = match fault.cause {
            Cause::Endless | Cause::Slow => "look for a loop that does not end",
            Cause::Refused(_) => "mend the plugin, or render without --strict to leave such answers out",
            _ => "mend the plugin",
        };
        Self::plugin(fault.to_string(), remedy)
    }
}
