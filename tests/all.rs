//! Tests that need more than one crate.
//!
//! Statistical tests fix their seeds, and print statistic, threshold and samples. A failing picture is left in the folder that the
//! message names.
#![cfg(test)]

mod agreement;
mod check;
mod corpus;
mod depth;
mod furnace;
mod hostile;
mod house;
mod instances;
mod invariance;
mod pictures;
#[path = "../host/src/rays/tests/generator.rs"]
mod random;
mod references;
mod sandbox;
mod scenes;
mod self_hits;
mod statistics;
mod techniques;
