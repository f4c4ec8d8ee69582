//! What `--stats` writes.

use std::path::Path;

use serde::Serialize;

use crate::{
    error::{Error, Result},
    plan::Plan,
    render::Numbers,
    scene::view::RayCounts,
};

/// What was done and what it took.
#[derive(Clone, Debug, Serialize)]
pub struct Stats {
    /// Samples per pixel.
    pub spp: u32,
    /// Of the image, in pixels.
    pub width: u32,
    /// Of the image, in pixels.
    pub height: u32,
    /// Wall-clock seconds of each part.
    pub seconds: Seconds,
    /// CPU seconds of all threads.
    pub cpu_seconds: CpuSeconds,
    /// Samples per pixel times pixels written.
    pub camera_paths: u64,
    /// Light walks.
    pub light_paths: u64,
    /// Rays cast.
    pub rays: RayCounts,
    /// Contributions refused because they were not finite.
    pub refused: u64,
    /// Bad answers of plugins.
    pub quarantined: u64,
    /// The render's own estimate of its relMSE, trimmed by 0.1 %.
    pub estimated_error: Option<f64>,
    /// What the command line asked for.
    pub integrator: &'static str,
    /// The techniques that ran.
    pub plan: Plan,
    /// Of rendering.
    pub threads: usize,
    /// Of the random numbers.
    pub seed: u64,
    /// Which random numbers.
    pub sampler: Numbers,
    /// The ray caster's tree.
    pub geometry: Geometry,
    /// Of this program.
    pub version: &'static str,
    /// Whether Ctrl-C ended it.
    pub interrupted: bool,
}

/// Wall-clock seconds.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Seconds {
    /// Reading files.
    pub load: f64,
    /// Building the scene.
    pub build: f64,
    /// Deciding what to run.
    pub plan: f64,
    /// Sampling.
    pub render: f64,
    /// Everything.
    pub total: f64,
}

/// CPU seconds, threads added up.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct CpuSeconds {
    /// Sampling.
    pub render: f64,
}

/// The ray caster's tree.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Geometry {
    /// Triangles and other shapes.
    pub primitives: usize,
    /// Those without area, dropped.
    pub degenerate: usize,
    /// Memory of the tree.
    pub bytes: usize,
}

impl Stats {
    /// Writes them; the file is whole or not there.
    pub fn write(&self, path: &Path) -> Result<()> {
        let failed = |error: &dyn std::fmt::Display| {
            Error::in_file(path, format!("the statistics cannot be written: {error}"), "name a file in a folder that takes one")
        };
        let text = serde_json::to_string_pretty(self).map_err(|error| failed(&error))?;
        std::fs::write(path, text + "\n").map_err(|error| failed(&error))
    }
}
