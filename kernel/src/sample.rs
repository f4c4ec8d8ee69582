//! One sample: a camera walk, its light walks, and every way of joining them.

use crate::{
    camera_walk::camera_walk,
    connection::{Ration, connect},
    film::Film,
    light_walk::light_walk,
    math::floor,
    real::{Real, Vec2},
    sampler::{Sampler, Walk, start},
    scene::Scene,
    strategy::Strategy,
    technique::{Join, Techniques},
    walk::WalkVertex,
};

/// Samples one camera path through `raster` and as many light paths as the strategy has a use for, and hands the film everything
/// that they contribute.
///
/// `camera_path` and `light_path` are the caller's storage: how long they are caps how many vertices of a walk can be connected.
/// The sampler's first two camera dimensions are the caller's, for `raster`.
#[inline(always)]
pub fn sample<'s, S: Scene, F: Film>(
    scene: &'s S,
    strategy: &Strategy,
    sampler: &mut impl Sampler,
    raster: Vec2,
    camera_path: &mut [Option<WalkVertex<'s, S, F::Rivals>>],
    light_path: &mut [Option<WalkVertex<'s, S, F::Rivals>>],
    film: &mut F,
) {
    let strategy = &strategy.within(S::EFFECTS);
    let techniques = &strategy.techniques;
    let joined_length = strategy.joined_length(camera_path.len().min(light_path.len()));
    let walks = if S::EFFECTS.light_walks { light_walks(techniques, sampler) } else { 0 };
    // What no light walk comes to is not kept.
    let kept = if walks > 0 { camera_path.len() } else { 0 };
    let kept = &mut camera_path[..kept];
    let seen = if techniques.camera_walk() { camera_walk(scene, strategy, joined_length, sampler, raster, kept, film) } else { 0 };
    if !S::EFFECTS.light_walks {
        return;
    }
    for number in 0..walks {
        let lit = light_walk(scene, strategy, joined_length, number, sampler, light_path, film);
        if seen > 0 && lit > 0 {
            let ration = ration(techniques, number, sampler);
            connect(scene, strategy, joined_length, ration, (&camera_path[..seen], &light_path[..lit]), film);
        }
    }
}

/// How many light walks this sample has: a whole number, whose mean is the number of light paths per camera path.
#[inline]
fn light_walks(techniques: &Techniques, sampler: &mut impl Sampler) -> u32 {
    let walks = techniques.light_walks();
    let whole = walks as u32;
    if walks == f64::from(whole) {
        return whole;
    }
    sampler.seek(Walk::Light, start::COUNT);
    floor(walks as Real + sampler.next()) as u32
}

/// Which pairs of vertices are joined, if there are fewer connections than light paths.
#[inline]
fn ration(techniques: &Techniques, number: u32, sampler: &mut impl Sampler) -> Option<Ration> {
    let chance = techniques.effort(Join::Connection) / techniques.light_walks();
    if chance >= 1.0 {
        return None;
    }
    sampler.seek(Walk::Camera, start::RATION + number % 4);
    Some(Ration { chance: chance as Real, u: sampler.next() })
}
