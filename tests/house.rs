//! The order of the house, kept by reading the sources.

use std::{
    fs,
    path::{Path, PathBuf},
};

use bidir::load::catalog;

/// A module of the host uses only what stands to its left.
const ORDER: [&str; 14] =
    ["error", "partial", "image", "rays", "plugin", "scene", "load", "plan", "film", "render", "compare", "check", "cost", "cli"];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Every file under a folder of the repository, build results left out.
fn files(folder: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut waiting = vec![root().join(folder)];
    while let Some(folder) = waiting.pop() {
        for entry in fs::read_dir(&folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if !path.is_dir() {
                found.push(path);
            } else if path.file_name().is_some_and(|name| name != "target") {
                waiting.push(path);
            }
        }
    }
    found.sort();
    found
}

fn sources(folder: &str) -> Vec<PathBuf> {
    files(folder).into_iter().filter(|path| path.extension().is_some_and(|extension| extension == "rs")).collect()
}

/// The text without comments and without what only tests see.
fn code(path: &Path) -> String {
    let text = fs::read_to_string(path).expect("a source");
    let shipped = text.split("#[cfg(test)]").next().unwrap_or_default();
    shipped.lines().map(|line| line.split("//").next().unwrap_or_default()).collect::<Vec<_>>().join("\n")
}

/// The modules named behind `crate::`, in braces or not.
fn used(text: &str) -> Vec<String> {
    let mut names = Vec::new();
    for (at, _) in text.match_indices("crate::") {
        let before = text[..at].chars().next_back();
        if before.is_some_and(|c| c.is_alphanumeric() || c == '_' || c == '$') {
            continue;
        }
        let rest = &text[at + "crate::".len()..];
        let word = |text: &str| text.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect::<String>();
        let Some(list) = rest.strip_prefix('{') else {
            names.push(word(rest));
            continue;
        };
        let mut depth = 0;
        let mut begins = true;
        for (i, c) in list.char_indices() {
            match c {
                '{' => depth += 1,
                '}' if depth == 0 => break,
                '}' => depth -= 1,
                ',' if depth == 0 => begins = true,
                c if begins && !c.is_whitespace() => {
                    names.push(word(&list[i..]));
                    begins = false;
                }
                _ => {}
            }
        }
    }
    names
}

#[test]
fn uses_are_read_in_and_out_of_braces() {
    let text =
        "use crate::{\n    film::{Film, a},\n    scene,\n};\nuse crate::error::Error; fn f(x: crate::plan::Plan, y: bidir_crate::no) {}";
    assert_eq!(used(text), ["film", "scene", "error", "plan"]);
}

#[test]
fn a_module_of_the_host_uses_only_what_stands_to_its_left() {
    let host = root().join("host/src");
    for path in sources("host/src") {
        let inside = path.strip_prefix(&host).expect("a source of the host");
        let module = inside.components().next().and_then(|first| Path::new(first.as_os_str()).file_stem()).expect("a name");
        let module = module.to_str().expect("letters");
        if matches!(module, "lib" | "main") {
            continue;
        }
        let place = |name: &str| ORDER.iter().position(|other| *other == name);
        let own = place(module).unwrap_or_else(|| panic!("{module} has no place in the order"));
        for name in used(&fs::read_to_string(&path).expect("a source")) {
            let other = place(&name).unwrap_or_else(|| panic!("{}: {name} has no place in the order", inside.display()));
            assert!(other <= own, "{}: {module} uses {name}, which stands to its right", inside.display());
        }
    }
}

#[test]
fn the_host_lists_its_modules_in_that_order() {
    let text = fs::read_to_string(root().join("host/src/lib.rs")).expect("a source");
    let listed: Vec<_> = text.lines().filter_map(|line| line.strip_prefix("pub mod ")?.strip_suffix(';')).collect();
    assert_eq!(listed, ORDER);
}

/// Kinds of lobe share these words with materials.
const LOBES: [&str; 2] = ["diffuse", "null"];

#[test]
fn the_kernel_names_no_material() {
    for path in sources("kernel/src") {
        let code = code(&path).to_lowercase();
        for material in catalog::supported("bsdf").iter().filter(|name| !LOBES.contains(name)) {
            let named = code.split(|c: char| !c.is_alphanumeric()).any(|word| word == *material);
            assert!(!named, "{} names {material}", path.display());
        }
    }
}

/// `extern crate std` behind its feature is all there is of it, for the instruction behind `sqrt`.
#[test]
fn the_kernel_allocates_nothing_and_asks_nothing_of_the_system() {
    for path in sources("kernel/src") {
        let inside = path.strip_prefix(root()).expect("a path inside").with_extension("");
        if inside.iter().any(|part| part.to_string_lossy().ends_with("tests")) {
            continue;
        }
        let code = code(&path);
        for word in ["std::", "alloc::", "extern crate alloc", "static mut", "thread_local"] {
            assert!(!code.contains(word), "{} holds {word}", path.display());
        }
        for (at, _) in code.match_indices("extern crate std") {
            assert!(code[..at].trim_end().ends_with(r#"#[cfg(feature = "std")]"#), "{} takes std without its feature", path.display());
        }
    }
}

const ROOMS: [&str; 5] = ["kernel", "plugins", "host", "tests", "examples"];

#[test]
fn no_file_is_named_for_what_it_is_not_about() {
    for path in ROOMS.into_iter().flat_map(sources) {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        for name in ["util", "utils", "common", "helper", "helpers", "types", "misc"] {
            assert_ne!(stem, name, "{}", path.display());
        }
    }
}

#[test]
fn no_test_is_left_out() {
    let attribute = ["#[", "ignore"].concat();
    for path in ROOMS.into_iter().flat_map(sources) {
        assert!(!fs::read_to_string(&path).expect("a source").contains(&attribute), "{}", path.display());
    }
}

/// Names of what a manifest takes from elsewhere.
fn dependencies(manifest: &str) -> Vec<String> {
    let mut names = Vec::new();
    let mut inside = false;
    for line in manifest.lines().map(str::trim) {
        if let Some(section) = line.strip_prefix('[') {
            inside = section.trim_end_matches(']').ends_with("dependencies");
        } else if inside && let Some((name, _)) = line.split_once(['=', '.']) {
            names.push(name.trim().to_owned());
        }
    }
    names.retain(|name| !name.is_empty() && !name.starts_with('#') && !name.starts_with("bidir"));
    names
}

#[test]
fn every_dependency_has_its_line_in_the_readme() {
    let readme = fs::read_to_string(root().join("README.md")).expect("README.md");
    let (_, section) = readme.split_once("## Dependencies").expect("a section \"## Dependencies\" in README.md");
    let section = section.split("\n## ").next().unwrap_or_default();
    let manifests = ROOMS.into_iter().flat_map(files).filter(|path| path.file_name().is_some_and(|name| name == "Cargo.toml"));
    for manifest in manifests.chain([root().join("Cargo.toml")]) {
        for name in dependencies(&fs::read_to_string(&manifest).expect("a manifest")) {
            let line = format!("- `{name}`");
            assert!(section.lines().any(|said| said.starts_with(&line)), "README.md does not say what {name} is for");
        }
    }
}

#[test]
fn the_readme_quotes_the_embedding_example_as_it_is() {
    let read = |name: &str| fs::read_to_string(root().join(name)).expect("a text");
    let (readme, example) = (read("README.md"), read("examples/embed.rs"));
    let (_, quote) = readme.split_once("```rust\n").expect("a quote in README.md");
    let (quote, _) = quote.split_once("```").expect("the quote's end");
    let indented: String = quote.lines().map(|line| format!("    {line}\n")).collect();
    assert!(example.contains(&indented), "README.md quotes what examples/embed.rs does not hold:\n{quote}");
}
