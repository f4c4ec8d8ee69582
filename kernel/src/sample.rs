//! One sample: a light walk, a camera walk, and every way of joining them.

use crate::{
    camera_walk::camera_walk, connection::connect, film::Film, light_walk::light_walk, real::Vec2, sampler::Sampler, scene::Scene,
    strategy::Strategy, walk::WalkVertex,
};

/// Samples one camera path through `raster` and, where the strategy has a use for it, one light path, and hands
/// the film everything that they contribute.
///
/// `camera_path` and `light_path` are the caller's storage: how long they are caps how many vertices of a walk can be connected.
/// The sampler's first two camera dimensions are the caller's, for `raster`.
pub fn sample<'s, S: Scene>(
    scene: &'s S,
    strategy: &Strategy,
    sampler: &mut impl Sampler,
    raster: Vec2,
    camera_path: &mut [Option<WalkVertex<'s, S>>],
    light_path: &mut [Option<WalkVertex<'s, S>>],
    film: &mut impl Film,
) {
    let joined_length = strategy.joined_length(camera_path.len().min(light_path.len()));
    let lit = if strategy.techniques.light_walk() { light_walk(scene, strategy, joined_length, sampler, light_path, film) } else { 0 };
    if strategy.techniques.camera_walk() {
        let seen = camera_walk(scene, strategy, joined_length, sampler, raster, camera_path, film);
        connect(scene, strategy, joined_length, (&camera_path[..seen], &light_path[..lit]), film);
    }
}
