//! The committed modules against the sources in this checkout.

use bidir_prebuilt::{Module, Sources, discover, fingerprint, folder, root};

#[test]
fn every_committed_module_is_built_from_the_sources_that_are_here() {
    let (root, folder) = (root(), folder());
    let modules = discover(&root).expect("the workspace");
    let complaints = Sources::read(&folder).and_then(|sources| sources.complaints(&root, &folder, &modules)).expect("files");
    assert!(complaints.is_empty(), "rebuild the modules of plugins/ and commit them:\n{}", complaints.join("\n"));
}

#[test]
fn every_built_in_that_fits_the_abi_is_a_module() {
    let modules = discover(&root()).expect("the workspace");
    let names: Vec<&str> = modules.iter().filter(|module| module.folder == "plugins/standard").map(|module| module.name.as_str()).collect();
    let expected = [
        "area",
        "conductor",
        "constant",
        "dielectric",
        "diffuse",
        "null",
        "plastic",
        "point",
        "roughconductor",
        "roughdielectric",
        "spot",
        "thindielectric",
    ];
    assert_eq!(names, expected);
}

#[test]
fn no_module_holds_a_path_of_the_machine_that_built_it() {
    let home = std::env::var("HOME").unwrap_or_else(|_| "/home/".to_owned());
    for module in discover(&root()).expect("the workspace") {
        let text = std::fs::read(folder().join(format!("{}.wasm", module.name))).expect("a module");
        let text = String::from_utf8_lossy(&text);
        for path in [home.as_str(), "/home/", "/root/", "/Users/", "/tmp/"] {
            assert!(!text.contains(path), "{}.wasm holds {path}", module.name);
        }
    }
}

/// What there is to build, and a record of it in a folder of its own.
fn copied(to: &std::path::Path) -> (Module, Sources) {
    let modules = discover(&root()).expect("the workspace");
    let module = modules.into_iter().find(|module| module.name == "null").expect("null");
    let mut sources = Sources::read(&folder()).expect("a record");
    sources.0.retain(|name, _| *name == module.name);
    std::fs::copy(folder().join("null.wasm"), to.join("null.wasm")).expect("a copy");
    (module, sources)
}

#[test]
fn a_changed_a_missing_and_a_strange_module_are_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let (module, sources) = copied(folder.path());
    let complaints = |sources: &Sources| sources.complaints(&root(), folder.path(), std::slice::from_ref(&module)).expect("files");
    assert_eq!(complaints(&sources), Vec::<String>::new());
    let mut older = sources.clone();
    older.0.get_mut("null").expect("null").sources = fingerprint::file(&folder.path().join("null.wasm")).expect("a hash");
    assert!(complaints(&older)[0].contains("older than its sources"));
    std::fs::write(folder.path().join("null.wasm"), "another").expect("written");
    assert!(complaints(&sources)[0].contains("not the one that was built"));
    std::fs::rename(folder.path().join("null.wasm"), folder.path().join("strange.wasm")).expect("renamed");
    let both = complaints(&sources);
    assert!(both[0].contains("null.wasm is missing") && both[1].contains("strange.wasm has no sources"), "{both:?}");
}
