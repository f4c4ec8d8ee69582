//! What is fuzzed, and what must hold of it beside that it neither panics, runs on, nor grows: a function for each kind of input.
//!
//! The fuzzers in `tests/fuzz` call them with whatever they make up, and an ordinary test with every file of the corpus.

mod image;
mod mesh;
mod plugin;
mod scene;
mod trace;

pub use image::{exr, hdr, png};
pub use mesh::{obj, ply, serialized};
pub use plugin::{manifest, module};
pub use scene::scene_xml;

use bidir::error::Error;

/// A target: its name, which its fuzzer and its folder of the corpus have too, and what it does with an input.
pub type Target = (&'static str, fn(&[u8]));

/// Every target.
pub const TARGETS: [Target; 9] = [
    ("scene_xml", scene_xml),
    ("obj", obj),
    ("ply", ply),
    ("serialized", serialized),
    ("exr", exr),
    ("hdr", hdr),
    ("png", png),
    ("manifest", manifest),
    ("module", module),
];

/// Whoever gave an input that is refused learns why, and what to do.
fn told(error: &Error) {
    assert!(!error.thing.trim().is_empty(), "{error:?} does not say what is wrong");
    assert!(!error.remedy.trim().is_empty(), "{error:?} does not say what to do");
}
