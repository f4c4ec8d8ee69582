//! What loads also builds, and paths can be traced through it.

use bidir::{
    plugin::Strictness,
    scene::{Scene, description::Description, view::View},
};
use bidir_kernel::{Camera, Contribution, Film, Point, Scene as _, Strategy, Techniques, Together, Vec2, sample, sampler::Independent};

use crate::told;

/// The longest path, in segments.
const DEPTH: u32 = 6;

/// Takes what comes.
struct Nowhere;

impl Film for Nowhere {
    type Rivals = Together;

    fn add(&mut self, _: Contribution) {}

    fn splat(&mut self, _: Vec2, _: Contribution) {}
}

/// One thread's view of a scene.
pub fn view(scene: &Scene) -> View<'_> {
    View::new(scene, Strictness::Lenient)
}

/// Builds the scene and traces some paths from the corners and the middle of its film; `None` if it is refused, with a remedy.
pub fn built(description: &Description) -> Option<Scene> {
    let scene = match Scene::new(description) {
        Ok(scene) => scene,
        Err(error) => {
            told(&error);
            return None;
        }
    };
    let crop = description.film.crop;
    let (left, top) = (crop.x as f32, crop.y as f32);
    let (width, height) = (crop.width as f32, crop.height as f32);
    let view = view(&scene);
    let strategy = Strategy::new(Techniques::BIDIRECTIONAL, description.integrator.max_depth.unwrap_or(DEPTH).min(DEPTH));
    for (index, (x, y)) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0), (0.5, 0.5), (0.4, 0.6)].into_iter().enumerate() {
        let raster = Vec2::new(left + width * x, top + height * y);
        let seen = view.camera().look(raster, [0.3, 0.6]);
        assert!(seen.direction.is_finite(), "the camera looks along {:?}", seen.direction);
        let (mut camera_path, mut light_path) = ([const { None }; DEPTH as usize], [const { None }; DEPTH as usize]);
        let mut numbers = Independent::new(1, 0, index as u64);
        sample(&view, &strategy, &mut numbers, raster, &mut camera_path, &mut light_path, &mut Nowhere);
    }
    if let Some(fault) = view.sandbox().fault() {
        assert!(!fault.to_string().is_empty());
    }
    drop(view);
    Some(scene)
}

/// Asserts that a hit is somewhere, on a surface that faces somewhere.
pub fn plausible(point: &Point) {
    assert!(point.position.is_finite() && point.offset >= 0.0 && point.offset.is_finite(), "{point:?}");
    for axis in [point.normal, point.frame.x, point.frame.y, point.frame.z] {
        assert!((axis.length() - 1.0).abs() < 1e-3, "{point:?}");
    }
}
