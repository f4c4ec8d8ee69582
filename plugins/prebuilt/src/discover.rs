//! What there is to build.

use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

use serde::{Deserialize, Serialize};

use crate::{Result, failed};

/// A module that can be built.
#[derive(Clone, Debug)]
pub struct Module {
    /// The file's name without `.wasm`, which is the type that scenes ask for.
    pub name: String,
    /// What it is written in.
    pub language: Language,
    /// The folder that holds it, from the repository's on.
    pub folder: String,
    /// How it is built.
    pub recipe: Recipe,
    /// Every file and folder that it is built from.
    pub sources: Vec<PathBuf>,
}

/// What a module is written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Language {
    /// With the SDK.
    Rust,
    /// From the ABI's page alone.
    C,
    /// From the ABI's page alone.
    AssemblyScript,
    /// From the ABI's page alone.
    Zig,
}

/// How a module is built.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Recipe {
    /// A package's library.
    Library {
        /// The package.
        package: String,
        /// The library, whose name cargo gives the file.
        library: String,
    },
    /// A package's example of the module's name.
    Example {
        /// The package.
        package: String,
        /// The features that the example asks for, separated by commas.
        features: String,
    },
    /// `build.sh` in the folder, which is told where to write.
    Script,
}

/// Every module of `plugins/`, by name.
pub fn discover(root: &Path) -> Result<Vec<Module>> {
    let plugins = root.join("plugins");
    let workspace = Workspace::read(root)?;
    let mut modules = workspace.modules(root, &plugins);
    for entry in fs::read_dir(&plugins).map_err(failed("reading", &plugins))? {
        let folder = entry.map_err(failed("reading", &plugins))?.path();
        if folder.join("build.sh").is_file() {
            modules.push(scripted(root, &folder)?);
        }
    }
    modules.sort_by(|a, b| a.name.cmp(&b.name));
    if let Some(twice) = modules.windows(2).find(|pair| pair[0].name == pair[1].name) {
        return Err(format!("{} and {} both make {}.wasm: rename one", twice[0].folder, twice[1].folder, twice[0].name));
    }
    Ok(modules)
}

/// A folder with a `build.sh`: the one source in a language that is known gives the name; what lies beside it belongs to it.
fn scripted(root: &Path, folder: &Path) -> Result<Module> {
    let mut found = None;
    let mut sources = Vec::new();
    for entry in fs::read_dir(folder).map_err(failed("reading", folder))? {
        let path = entry.map_err(failed("reading", folder))?.path();
        let language = match path.extension().and_then(|extension| extension.to_str()) {
            Some("c") => Some(Language::C),
            Some("ts") => Some(Language::AssemblyScript),
            Some("zig") => Some(Language::Zig),
            Some("h" | "json" | "mjs" | "sh") => None,
            _ => continue,
        };
        if let (Some(language), Some(stem)) = (language, path.file_stem()) {
            found = Some((language, stem.to_string_lossy().into_owned()));
        }
        sources.push(path);
    }
    let (language, name) = found.ok_or_else(|| format!("{} has a build.sh, but no .c, .ts or .zig file", folder.display()))?;
    Ok(Module { name, language, folder: relative(root, folder), recipe: Recipe::Script, sources })
}

fn relative(root: &Path, path: &Path) -> String {
    path.strip_prefix(root).unwrap_or(path).to_string_lossy().replace('\\', "/")
}

/// What cargo tells of the workspace, of it what is used here.
#[derive(Deserialize)]
struct Workspace {
    packages: Vec<Package>,
}

#[derive(Deserialize)]
struct Package {
    name: String,
    manifest_path: PathBuf,
    targets: Vec<Target>,
    dependencies: Vec<Dependency>,
}

#[derive(Deserialize)]
struct Target {
    name: String,
    kind: Vec<String>,
    crate_types: Vec<String>,
    src_path: PathBuf,
    #[serde(default, rename = "required-features")]
    required_features: Vec<String>,
}

#[derive(Deserialize)]
struct Dependency {
    path: Option<PathBuf>,
    kind: Option<String>,
}

impl Workspace {
    fn read(root: &Path) -> Result<Self> {
        let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        let manifest = root.join("Cargo.toml");
        let mut command = Command::new(cargo);
        command.args(["metadata", "--no-deps", "--format-version", "1", "--manifest-path"]).arg(&manifest);
        let output = command.output().map_err(failed("running cargo metadata for", &manifest))?;
        if !output.status.success() {
            return Err(format!("cargo metadata: {}", String::from_utf8_lossy(&output.stderr)));
        }
        serde_json::from_slice(&output.stdout).map_err(failed("reading cargo metadata of", &manifest))
    }

    fn modules(&self, root: &Path, plugins: &Path) -> Vec<Module> {
        let mut modules = Vec::new();
        for package in self.packages.iter().filter(|package| package.manifest_path.starts_with(plugins)) {
            for target in package.targets.iter().filter(|target| target.crate_types.iter().any(|kind| kind == "cdylib")) {
                modules.push(self.module(root, package, target));
            }
        }
        modules
    }

    fn module(&self, root: &Path, package: &Package, target: &Target) -> Module {
        let folder = relative(root, package.folder());
        let mut sources = Vec::new();
        self.add_sources(package, &mut sources);
        let (name, recipe) = if target.kind.iter().any(|kind| kind == "example") {
            sources.push(target.src_path.clone());
            let features = target.required_features.join(",");
            (target.name.clone(), Recipe::Example { package: package.name.clone(), features })
        } else {
            // The twin of a module in another language.
            let twin = if folder.ends_with("/rust") { "-rust" } else { "" };
            let recipe = Recipe::Library { package: package.name.clone(), library: target.name.clone() };
            (format!("{}{twin}", target.name), recipe)
        };
        Module { name, language: Language::Rust, folder, recipe, sources }
    }

    /// A package's own sources and those of the members that it depends on.
    fn add_sources(&self, package: &Package, sources: &mut Vec<PathBuf>) {
        if sources.contains(&package.manifest_path) {
            return;
        }
        sources.push(package.manifest_path.clone());
        sources.push(package.folder().join("src"));
        for dependency in package.dependencies.iter().filter(|dependency| dependency.kind.is_none()) {
            if let Some(other) = self.packages.iter().find(|other| Some(other.folder()) == dependency.path.as_deref()) {
                self.add_sources(other, sources);
            }
        }
    }
}

impl Package {
    fn folder(&self) -> &Path {
        self.manifest_path.parent().unwrap_or(&self.manifest_path)
    }
}
