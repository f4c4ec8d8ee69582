//! Where contributions go.

use crate::{
    real::{Real, Vec2},
    spectrum::Spectrum,
    technique::Technique,
    weight::Rivals,
};

/// What one join adds.
#[derive(Clone, Copy, Debug)]
pub struct Contribution {
    /// f/p under the technique alone, over the number of its samples per camera path.
    pub value: Spectrum,
    /// The technique's share in the path, 0 … 1.
    pub weight: Real,
    /// What made it.
    pub technique: Technique,
}

/// Takes contributions as they are made.
pub trait Film {
    /// How finely weights are kept: [`Together`](crate::weight::Together), unless the film asks what other counts would have done.
    type Rivals: Rivals;

    /// How the contribution that comes next was weighed: own / (own + others).
    #[inline(always)]
    fn weighed(&mut self, own: f64, others: Self::Rivals) {
        let _ = (own, others);
    }

    /// δ: what contributes less than this to the pixel of the camera walk under way, value times weight, plays roulette for its shadow
    /// ray. 0 casts every ray. The mean is the same for any δ that was known before this sample.
    #[inline(always)]
    fn threshold(&self) -> Real {
        0.0
    }

    /// The same for a splat at that raster position.
    #[inline(always)]
    fn splat_threshold(&self, raster: Vec2) -> Real {
        let _ = raster;
        0.0
    }

    /// From the camera walk under way, to the raster position it started at.
    fn add(&mut self, contribution: Contribution);

    /// From a light walk that reached the lens, to wherever it exposes the film.
    fn splat(&mut self, raster: Vec2, contribution: Contribution);
}
