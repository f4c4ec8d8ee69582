//! Building a module.

use std::{
    env, fs,
    path::{Path, PathBuf},
    process::{Command, Stdio},
};

use crate::{Module, Result, discover::Recipe, failed, tool::TARGET};

/// Bytes of a Rust module's stack: small, so that instances are made fast.
const STACK: usize = 32 << 10;

/// Builds a module into `folder`, and says so on standard error.
pub fn compile(root: &Path, folder: &Path, module: &Module) -> Result<()> {
    let out = folder.join(format!("{}.wasm", module.name));
    match &module.recipe {
        Recipe::Library { package, library } => cargo(root, package, &["--lib"], &format!("{library}.wasm"), &out)?,
        Recipe::Example { package, features } => {
            let file = format!("examples/{}.wasm", module.name);
            cargo(root, package, &["--example", &module.name, "--features", features], &file, &out)?;
        }
        Recipe::Script => {
            let folder = root.join("target/modules");
            fs::create_dir_all(&folder).map_err(failed("making", &folder))?;
            let built = folder.join(format!("{}.wasm", module.name));
            run(Command::new("sh").arg(root.join(&module.folder).join("build.sh")).arg(&built), &module.name)?;
            take(&built, &out)?;
        }
    }
    let bytes = fs::metadata(&out).map_err(failed("reading", &out))?.len();
    eprintln!("{}: {bytes} bytes", module.name);
    Ok(())
}

fn cargo(root: &Path, package: &str, what: &[&str], file: &str, out: &Path) -> Result<()> {
    let target = root.join("target/modules");
    let mut command = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.current_dir(root).args(["build", "--quiet", "--profile", "plugin", "--target", TARGET, "--package", package]);
    command.args(what).arg("--target-dir").arg(&target).env("CARGO_ENCODED_RUSTFLAGS", flags(root)).env_remove("RUSTFLAGS");
    run(&mut command, package)?;
    let built = target.join(TARGET).join("plugin").join(file);
    take(&built, out)
}

/// Written, not copied: a module is no program, and has no permission to be one.
fn take(built: &Path, out: &Path) -> Result<()> {
    write_changed(out, &fs::read(built).map_err(failed("reading", built))?)
}

/// Writes a file, unless it is so already: whoever was built from it is then still up to date.
pub(crate) fn write_changed(file: &Path, bytes: &[u8]) -> Result<()> {
    if fs::read(file).is_ok_and(|known| known == bytes) {
        return Ok(());
    }
    fs::write(file, bytes).map_err(failed("writing", file))
}

/// No path of the machine gets into a module: places in messages begin with a word instead.
fn flags(root: &Path) -> String {
    let home = env::var_os("HOME").or_else(|| env::var_os("USERPROFILE")).map(PathBuf::from);
    let registry = env::var_os("CARGO_HOME").map(PathBuf::from).or_else(|| Some(home?.join(".cargo")));
    let mut flags = vec![format!("-Clink-arg=-zstack-size={STACK}")];
    for (path, word) in [(registry, "cargo"), (Some(root.to_path_buf()), "bidir")] {
        flags.extend(path.map(|path| format!("--remap-path-prefix={}={word}", path.display())));
    }
    flags.join("\u{1f}")
}

fn run(command: &mut Command, what: &str) -> Result<()> {
    let status = command.stdin(Stdio::null()).status().map_err(|error| format!("building {what}: {error}"))?;
    if status.success() { Ok(()) } else { Err(format!("building {what} failed ({status}); the compiler said why")) }
}
