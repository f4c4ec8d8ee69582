//! `bidir::cost` says what is so: of known scenes, of renders that are cut off, and of its own sureness.

mod estimate;
mod intervals;
mod page;

use std::{path::Path, sync::Arc, sync::atomic::AtomicBool};

use bidir::{
    cost::subject::Subject,
    load::{load, load_str},
    plan::effects::Effects,
    plugin::{Library, Strictness},
    scene::{Scene, description::Description},
};

fn subject(name: &str, description: Description) -> Subject {
    let scene = Scene::new(&description).expect("a scene");
    let effects = Effects::of(&description, &scene);
    Subject { name: name.to_owned(), effects, scene, description, threads: 2, seed: 0, strictness: Strictness::Strict }
}

/// A scene from its text.
fn of_text(name: &str, text: &str) -> Subject {
    subject(name, load_str(text, Path::new("scene.xml"), None, &[], &Library::default()).expect("a scene").description)
}

/// One of the examples, at so many pixels in a row.
fn of_example(name: &str, pixels: u32) -> Subject {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/scenes").join(name).join("scene.xml");
    let defines = [("res".to_owned(), pixels.to_string())];
    subject(name, load(&file, &defines, &Library::default()).expect("a scene").description)
}

fn never() -> Arc<AtomicBool> {
    Arc::default()
}
