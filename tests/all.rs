//! Tests that need more than one crate.
//!
//! Statistical tests fix their seeds, and print statistic, threshold and samples. A failing picture is left in the folder that the
//! message names.
#![cfg(test)]

mod agreement;
mod check;
mod corpus;
mod cost;
mod depth;
mod furnace;
mod gltf;
mod hard_cases;
mod hostile;
mod house;
mod instances;
mod invariance;
mod loading;
#[path = "../host/src/load/gltf/tests/model.rs"]
mod model;
mod peer;
mod plans;
mod presets;
#[path = "../host/src/rays/tests/generator.rs"]
mod random;
mod references;
mod sandbox;
mod self_hits;
mod techniques;

use bidir_tests::{estimators, pictures, scenes, statistics};
