//! Scenes whose light is known: furnaces, integrating spheres, lights over a plane, panes of glass.

mod closed;
mod open;
mod panes;
mod plane;

use bidir_kernel::{Heuristic, Techniques};

use crate::pictures::{BDPT, LIGHT, PATH};

/// Relative tolerance of means.
const WITHIN: f64 = 0.003;
/// Light walks go everywhere, and few of them into the picture: what is left of their noise says less.
const WITHIN_NOISE: f64 = 0.015;

/// An estimator that a scene's known light is asked of.
struct Estimator {
    name: &'static str,
    techniques: Techniques,
    heuristic: Heuristic,
    /// Samples for one of path tracing.
    effort: u32,
    within: f64,
}

const fn estimator(name: &'static str, techniques: Techniques, heuristic: Heuristic, effort: u32, within: f64) -> Estimator {
    Estimator { name, techniques, heuristic, effort, within }
}

const ESTIMATORS: [Estimator; 5] = [
    estimator("path", PATH, Heuristic::Balance, 1, WITHIN),
    estimator("path, power", PATH, Heuristic::Power, 1, WITHIN),
    estimator("bdpt", BDPT, Heuristic::Balance, 1, WITHIN),
    estimator("bdpt, power", BDPT, Heuristic::Power, 1, WITHIN),
    estimator("light", LIGHT, Heuristic::Balance, 4, WITHIN_NOISE),
];
