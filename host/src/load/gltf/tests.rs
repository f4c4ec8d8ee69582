//! Whole files, put together in memory.

mod hostile;
mod materials;
mod model;
mod scenes;

use std::fs;

use self::model::{Model, SQUARE};
use super::*;
use crate::scene::description::{Bitmap, Geometry, Mesh};

/// Reads a file of these bytes.
fn read(name: &str, bytes: &[u8]) -> Result<Loaded> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    load(&path, &[])
}

/// A node with a square that has this material.
fn square_of(model: &mut Model, material: serde_json::Value) {
    let material = model.add("materials", material);
    let mesh = model.square(serde_json::json!({"material": material}));
    model.node(serde_json::json!({"mesh": mesh}));
}

fn loaded(model: &Model) -> Loaded {
    read("m.gltf", &model.gltf()).unwrap()
}

fn scene(model: &Model) -> Description {
    loaded(model).description
}

fn error(model: &Model) -> String {
    let error = read("m.gltf", &model.gltf()).unwrap_err();
    assert!(!error.remedy.is_empty(), "{error}");
    error.to_string()
}

/// The one warning that holds these words.
fn warning<'a>(loaded: &'a Loaded, words: &str) -> &'a str {
    let found: Vec<_> = loaded.warnings.iter().filter(|warning| warning.contains(words)).collect();
    assert_eq!(found.len(), 1, "{words}: {:?}", loaded.warnings);
    found[0]
}

fn mesh(description: &Description, shape: usize) -> (&Mesh, &glam::DAffine3) {
    match &description.shapes[shape].geometry {
        Geometry::Mesh { mesh, to_world, .. } => (mesh, to_world),
        other => panic!("{other:?}"),
    }
}

fn bitmap(texture: &Texture) -> &Bitmap {
    match texture {
        Texture::Bitmap(bitmap) => bitmap,
        other => panic!("{other:?}"),
    }
}

fn near(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-6 * (1.0 + b.abs())
}
