//! Plain scenes: a pinhole camera, diffuse surfaces of one colour each, and uniform light from rectangles.
//! Each part is kept once more without the choice among all that it could have been.

use bidir_kernel::{Bsdf, Carried, Lobe, Real, Scatter, Scattered, Spectrum, Vec3, camera::Pinhole, light::AreaLight};
use bidir_standard as standard;

use crate::scene::{
    camera::SceneCamera,
    choice::Lights,
    extent::{LightExtent, Parallelogram},
    lights::{LightId, LightSource, ProfileSource, Seat},
    shape::Shape,
    surface::Finish,
};

/// The parts of a plain scene.
#[derive(Clone, Debug)]
pub struct Parts {
    pub(super) camera: Pinhole,
    /// Of each of the scene's finishes.
    surfaces: Vec<Matt>,
    /// Of each of the scene's lights.
    lights: Vec<Lamp>,
}

/// A rectangle that shines alike all over.
pub type Lamp = AreaLight<Parallelogram, standard::Area>;

/// A diffuse surface of one colour, on its normal's side or on both.
#[derive(Clone, Copy, Debug)]
pub struct Matt {
    /// Where the normal points.
    pub shader: standard::Diffuse,
    /// −1 if it is the same behind, as if its normal pointed there; 1 if it is black there.
    pub behind: Real,
}

impl Parts {
    /// `None` if the scene is not plain.
    pub(super) fn of(camera: &SceneCamera, shapes: &[Shape], finishes: &[Finish], lights: &Lights) -> Option<Self> {
        let SceneCamera::Perspective(camera) = camera else { return None };
        if camera.lens_radius > 0.0 {
            return None;
        }
        let matt: Vec<_> = finishes.iter().map(Finish::matt).collect();
        if shapes.iter().any(|shape| matt[shape.finish as usize].is_none()) {
            return None;
        }
        // What no shape wears, no path meets.
        let unworn = Matt { shader: standard::Diffuse { reflectance: Spectrum::BLACK }, behind: 1.0 };
        let surfaces = matt.into_iter().map(|matt| matt.unwrap_or(unworn)).collect();
        let lights = lights.sources().iter().map(lamp).collect::<Option<_>>()?;
        Some(Self { camera: Pinhole(*camera), surfaces, lights })
    }

    #[inline(always)]
    pub(super) fn surface(&self, finish: u32) -> Matt {
        self.surfaces[finish as usize]
    }

    #[inline(always)]
    pub(super) fn light(&self, id: LightId) -> &Lamp {
        &self.lights[id.0 as usize]
    }
}

fn lamp(source: &LightSource) -> Option<Lamp> {
    match (&source.seat, &source.profile) {
        (Seat::Shape(LightExtent::Parallelogram(extent)), ProfileSource::Area(profile)) => {
            Some(AreaLight { extent: *extent, profile: *profile })
        }
        _ => None,
    }
}

impl Matt {
    /// −1 where z is to be turned round.
    #[inline(always)]
    fn turn(&self, wo: Vec3) -> Real {
        if wo.z >= 0.0 { 1.0 } else { self.behind }
    }
}

#[inline(always)]
fn turned(w: Vec3, turn: Real) -> Vec3 {
    Vec3::new(w.x, w.y, w.z * turn)
}

impl Bsdf for Matt {
    #[inline(always)]
    fn eval(&self, wo: Vec3, wi: Vec3, carried: Carried) -> Scatter {
        let turn = self.turn(wo);
        self.shader.eval(turned(wo, turn), turned(wi, turn), carried)
    }

    #[inline(always)]
    fn sample(&self, wo: Vec3, u: [Real; 3], carried: Carried) -> Option<Scattered> {
        let turn = self.turn(wo);
        let scattered = self.shader.sample(turned(wo, turn), u, carried)?;
        Some(Scattered { wi: turned(scattered.wi, turn), ..scattered })
    }

    #[inline(always)]
    fn lobes(&self) -> Lobe {
        self.shader.lobes()
    }
}
