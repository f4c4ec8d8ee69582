//! What accuracy costs in time: for a scene, how long each method takes to be good enough, and what each knob costs and brings.
//!
//! [`measure`] does everything within a budget and keeps what it has in a folder; [`page`] shows it. The parts serve others too:
//! [`mod@reference`] tells errors without the reference's own noise, [`subject`] watches a render's error as it goes on, [`curve`] tells
//! prices and crossings, [`pace`] what samples take whatever else the machine does, [`interval`] how sure a bias is,
//! [`spent`] where a render's time goes.

mod casts;
pub mod curve;
pub mod interval;
pub mod journal;
pub mod knobs;
pub mod pace;
pub mod page;
pub mod reference;
pub mod report;
pub mod spent;
pub mod subject;
mod tables;
mod techniques;
mod work;

use std::{path::PathBuf, time::Duration};

pub use report::Report;
pub use work::measure;

/// What is to be done.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Where everything goes.
    pub folder: PathBuf,
    /// How long it may take.
    pub budget: Duration,
    /// Pictures to hold others against: none, one, or two halves.
    pub references: Vec<PathBuf>,
    /// A digest of what was read for it: what was measured for another one is not gone on with.
    pub digest: String,
}
