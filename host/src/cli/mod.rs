//! The command line.

mod arguments;
mod check;
mod compare;
mod cost;
mod explain;
mod interrupt;
mod plugin;
pub mod progress;
mod render;
mod stats;
mod techniques;

use std::process::ExitCode;

use clap::{Parser, error::ErrorKind};

use crate::error::{Blame, Error};
use arguments::{Arguments, Command};

/// How a command ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// All right: exit status 0.
    Done,
    /// Done, but part of the input was refused, and said to be: 1.
    Refused,
    /// What was checked is wrong: 3.
    Wrong,
    /// Ctrl-C; what was rendered is saved: 130.
    Interrupted,
}

/// Runs the command line of this process.
pub fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => {
            let asked = matches!(error.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion);
            // Nothing is left to say if not even this can be printed.
            let _ = error.print();
            return ExitCode::from(if asked { 0 } else { 2 });
        }
    };
    let outcome = match &arguments.command {
        Command::Render(render) => render::run(render),
        Command::Explain(explain) => explain::run(explain),
        Command::Techniques(techniques) => techniques::run(techniques),
        Command::Compare(compare) => compare::run(compare),
        Command::Cost(cost) => cost::run(cost),
        Command::Check(check) => check::run(check),
        Command::Plugin(command) => plugin::run(command),
    };
    match outcome {
        Ok(Outcome::Done) => ExitCode::SUCCESS,
        Ok(Outcome::Refused) => ExitCode::from(1),
        Ok(Outcome::Wrong) => ExitCode::from(3),
        Ok(Outcome::Interrupted) => ExitCode::from(130),
        Err(error) => {
            complain(&error);
            ExitCode::from(match error.blame {
                Blame::Input => 1,
                Blame::Plugin => 3,
            })
        }
    }
}

fn complain(error: &Error) {
    eprintln!("error: {error}");
}
