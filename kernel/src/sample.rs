//! One sample: a light walk, a camera walk, and every way of joining them.

use crate::{
    camera_walk::camera_walk,
    film::Film,
    light_walk::{LightVertex, light_walk},
    real::Vec2,
    sampler::Sampler,
    scene::Scene,
    strategy::Strategy,
};

/// Samples one camera path through `raster` and, where the strategy has a use for it, one light path, and hands
/// the film everything that they contribute.
///
/// `light_path` is the caller's storage: its length caps how many vertices of a light walk can be connected to.
/// The sampler's first two camera dimensions are the caller's, for `raster`.
pub fn sample<'s, S: Scene>(
    scene: &'s S,
    strategy: &Strategy,
    sampler: &mut impl Sampler,
    raster: Vec2,
    light_path: &mut [Option<LightVertex<'s, S>>],
    film: &mut impl Film,
) {
    let joined_length = strategy.joined_length(light_path.len());
    let stored = if strategy.techniques.light_walk() { light_walk(scene, strategy, joined_length, sampler, light_path, film) } else { 0 };
    if strategy.techniques.camera_walk() {
        let light_path = light_path.get(..stored).unwrap_or_default();
        camera_walk(scene, strategy, joined_length, sampler, raster, light_path, film);
    }
}
