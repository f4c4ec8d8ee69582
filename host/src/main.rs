//! The `bidir` program.

use std::process::ExitCode;

fn main() -> ExitCode {
    bidir::cli::main()
}
