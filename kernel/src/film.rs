//! Where contributions go.

use crate::{
    real::{Real, Vec2},
    spectrum::Spectrum,
    technique::Technique,
};

/// What one join adds.
#[derive(Clone, Copy, Debug)]
pub struct Contribution {
    /// f/p under the technique alone.
    pub value: Spectrum,
    /// The technique's share in the path, 0 … 1.
    pub weight: Real,
    /// What made it.
    pub technique: Technique,
}

/// Takes contributions as they are made.
pub trait Film {
    /// From the camera walk under way, to the raster position it started at.
    fn add(&mut self, contribution: Contribution);

    /// From a light walk that reached the lens, to wherever it exposes the film; per light walk.
    fn splat(&mut self, raster: Vec2, contribution: Contribution);
}
