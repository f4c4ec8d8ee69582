//! The projects that `bidir plugin new` writes: one per language and kind, each with its files.

/// A file of a project: its path in there, and its text with `{{name}}`, `{{Name}}` and `{{sdk}}` still in it.
pub type File = (&'static str, &'static str);

/// The languages there are projects in.
pub const LANGUAGES: [&str; 4] = ["rust", "c", "assemblyscript", "zig"];

/// What a plugin can be.
pub const KINDS: [&str; 2] = ["bsdf", "light"];

/// The files of a project; `None` for a language or kind that there is none of.
pub fn files(language: &str, kind: &str) -> Option<Vec<File>> {
    let own = match (language, kind) {
        ("rust", "bsdf") => RUST_BSDF,
        ("rust", "light") => RUST_LIGHT,
        ("c", "bsdf") => C_BSDF,
        ("c", "light") => C_LIGHT,
        ("assemblyscript", "bsdf") => ASSEMBLYSCRIPT_BSDF,
        ("assemblyscript", "light") => ASSEMBLYSCRIPT_LIGHT,
        ("zig", "bsdf") => ZIG_BSDF,
        ("zig", "light") => ZIG_LIGHT,
        _ => return None,
    };
    let of_language = match language {
        "rust" => RUST,
        "c" => C,
        "assemblyscript" => ASSEMBLYSCRIPT,
        _ => ZIG,
    };
    let mut files = [EVERY, of_language, own].concat();
    files.push((
        "scene.xml",
        if kind == "bsdf" { include_str!("templates/scene/bsdf.xml") } else { include_str!("templates/scene/light.xml") },
    ));
    if language != "rust" {
        let manifest =
            if kind == "bsdf" { include_str!("templates/manifest/bsdf.json") } else { include_str!("templates/manifest/light.json") };
        files.push(("manifest.json", manifest));
    }
    Some(files)
}

/// A template with its placeholders filled in: the plugin's name, lower case, and the path of the SDK.
pub fn filled(text: &str, name: &str, sdk: &str) -> String {
    let mut letters = name.chars();
    let type_name: String = letters.next().into_iter().flat_map(char::to_uppercase).chain(letters).collect();
    text.replace("{{name}}", name).replace("{{Name}}", &type_name).replace("{{sdk}}", sdk)
}

const EVERY: &[File] = &[(".gitignore", include_str!("templates/gitignore"))];

const RUST: &[File] = &[
    // A manifest under its own name would make the templates a package of their own.
    ("Cargo.toml", include_str!("templates/rust/Cargo.toml.txt")),
    (".cargo/config.toml", include_str!("templates/rust/config.toml.txt")),
    ("build.sh", include_str!("templates/rust/build.sh")),
    ("README.md", include_str!("templates/rust/README.md")),
];
const RUST_BSDF: &[File] = &[("src/lib.rs", include_str!("templates/rust/bsdf/lib.rs"))];
const RUST_LIGHT: &[File] = &[("src/lib.rs", include_str!("templates/rust/light/lib.rs"))];

const C: &[File] = &[("build.sh", include_str!("templates/c/build.sh")), ("README.md", include_str!("templates/c/README.md"))];
const C_BSDF: &[File] = &[("shader.c", include_str!("templates/c/bsdf/shader.c"))];
const C_LIGHT: &[File] = &[("shader.c", include_str!("templates/c/light/shader.c"))];

const ASSEMBLYSCRIPT: &[File] = &[
    ("build.sh", include_str!("templates/assemblyscript/build.sh")),
    ("manifest.mjs", include_str!("templates/assemblyscript/manifest.mjs")),
    ("README.md", include_str!("templates/assemblyscript/README.md")),
];
const ASSEMBLYSCRIPT_BSDF: &[File] = &[("shader.ts", include_str!("templates/assemblyscript/bsdf/shader.ts"))];
const ASSEMBLYSCRIPT_LIGHT: &[File] = &[("shader.ts", include_str!("templates/assemblyscript/light/shader.ts"))];

const ZIG: &[File] = &[("README.md", include_str!("templates/zig/README.md"))];
const ZIG_BSDF: &[File] =
    &[("build.sh", include_str!("templates/zig/bsdf/build.sh")), ("shader.zig", include_str!("templates/zig/bsdf/shader.zig"))];
const ZIG_LIGHT: &[File] =
    &[("build.sh", include_str!("templates/zig/light/build.sh")), ("shader.zig", include_str!("templates/zig/light/shader.zig"))];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_language_has_a_project_of_each_kind_without_leftover_placeholders() {
        for language in LANGUAGES {
            for kind in KINDS {
                let files = files(language, kind).expect("a project");
                for needed in ["README.md", "build.sh", "scene.xml", ".gitignore"] {
                    assert!(files.iter().any(|(path, _)| *path == needed), "{language} {kind}: {needed}");
                }
                for (path, text) in files {
                    assert!(!filled(text, "chalk", "sdk").contains("{{"), "{language} {kind}: {path}");
                }
            }
        }
    }
}
