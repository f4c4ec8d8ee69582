//! The compilers, and what to install where one is missing.

use std::{env, process::Command};

use crate::{Language, Result};

/// The target of Rust.
pub const TARGET: &str = "wasm32-unknown-unknown";

/// A compiler by the name it gives itself; an error says what to install.
pub fn version(language: Language) -> Result<String> {
    match language {
        Language::Rust => {
            let libraries = answer("rustc", &["--print", "target-libdir", "--target", TARGET]);
            let installed = libraries.is_some_and(|folder| std::path::Path::new(&folder).is_dir());
            let rustc = answer("rustc", &["--version"]).filter(|_| installed);
            rustc.ok_or_else(|| format!("Rust's target {TARGET} is missing: rustup target add {TARGET}"))
        }
        Language::C => {
            let clang = answer(&named("CLANG", "clang"), &["--version"]).filter(|_| answer("wasm-ld", &["--version"]).is_some());
            clang.ok_or_else(|| "clang or wasm-ld is missing: apt-get install clang lld (Debian)".to_owned())
        }
        Language::AssemblyScript => {
            let asc = answer(&named("ASC", "asc"), &["--version"]);
            asc.map(|version| format!("asc {}", version.trim_start_matches("Version ")))
                .ok_or_else(|| "asc is missing: npm install --global assemblyscript".to_owned())
        }
        Language::Zig => {
            let zig = answer(&named("ZIG", "python3 -m ziglang"), &["version"]);
            zig.map(|version| format!("zig {version}")).ok_or_else(|| "Zig is missing: python3 -m pip install ziglang".to_owned())
        }
    }
}

/// The command that the folders' `build.sh` would call: an environment variable may name another one.
fn named(variable: &str, default: &str) -> String {
    env::var(variable).unwrap_or_else(|_| default.to_owned())
}

/// The first line that a command prints, if it can be run; its words are separated by spaces.
fn answer(command: &str, arguments: &[&str]) -> Option<String> {
    let mut words = command.split_whitespace();
    let output = Command::new(words.next()?).args(words).args(arguments).output().ok()?;
    let text = String::from_utf8_lossy(&output.stdout);
    output.status.success().then(|| text.lines().next().unwrap_or_default().trim().to_owned())
}
