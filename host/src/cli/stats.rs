//! What `--stats` writes.

use std::path::Path;

use serde::Serialize;

use crate::{
    error::{Error, Result},
    partial::Partial,
    plan::Plan,
    rays::BuildStats,
    render::Numbers,
    scene::{Scene, view::RayCounts},
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
    /// The ray caster's trees.
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
    /// What the lens meets first, for layers beside the picture.
    pub layers: f64,
    /// Everything.
    pub total: f64,
}

/// CPU seconds, threads added up.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct CpuSeconds {
    /// Sampling.
    pub render: f64,
}

/// The ray caster's trees, each group's counted once.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Geometry {
    /// Triangles and other shapes.
    pub primitives: usize,
    /// Triangles among them, and two for each rectangle.
    pub triangles: usize,
    /// Where groups stand.
    pub instances: usize,
    /// Shapes and triangles without area, dropped.
    pub degenerate: usize,
    /// Memory of the trees, and of what tells whose a primitive is; without the meshes' own vertices and indices.
    pub bytes: usize,
    /// The same for each triangle; what other shapes and instances take is not told apart.
    pub bytes_per_triangle: Option<f64>,
}

impl Geometry {
    /// Of a scene.
    pub fn of(scene: &Scene) -> Self {
        let BuildStats { primitives, triangles, instances, bytes, .. } = scene.build_stats();
        Self {
            primitives: primitives - instances,
            triangles,
            instances,
            degenerate: scene.degenerate(),
            bytes,
            bytes_per_triangle: (triangles > 0).then(|| bytes as f64 / triangles as f64),
        }
    }
}

/// What is being written, for messages.
const WHAT: &str = "statistics";

/// Whether statistics could be written there. To be asked before a render starts.
pub fn check_writable(path: &Path) -> Result<()> {
    Partial::create(path, WHAT).map(drop)
}

impl Stats {
    /// Writes them; the file is whole or not there.
    pub fn write(&self, path: &Path) -> Result<()> {
        let text = serde_json::to_string_pretty(self).map_err(|error| {
            Error::in_file(path, format!("the statistics cannot be spelled as JSON: {error}"), "this is a bug; please report it")
        })?;
        Partial::write_text(path, WHAT, &(text + "\n"))
    }
}
