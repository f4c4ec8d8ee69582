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

const SIGN: u32 = 1 << 31;

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
    /// The sign bit, if it is the same behind, as if its normal pointed there; 0 if it is black there.
    behind: u32,
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
        let unworn = Matt::new(standard::Diffuse { reflectance: Spectrum::BLACK }, false);
        let surfaces = matt.into_iter().map(|matt| matt.unwrap_or(unworn)).collect();
        let lights = lights.sources().iter().map(lamp).collect::<Option<_>>()?;
        Some(Self { camera: Pinhole(*camera), surfaces, lights })
    }

    #[inline(always)]
    pub(super) fn surface(&self, finish: u32) -> &Matt {
        &self.surfaces[finish as usize]
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
    /// The same behind, or black there.
    pub fn new(shader: standard::Diffuse, both_sides: bool) -> Self {
        Self { shader, behind: if both_sides { SIGN } else { 0 } }
    }

    /// Whether it is the same behind.
    pub fn both_sides(&self) -> bool {
        self.behind != 0
    }

    /// The sign bit where z is to be turned round.
    #[inline(always)]
    fn turn(&self, wo: Vec3) -> u32 {
        wo.z.to_bits() & self.behind
    }
}

/// z turned round or not. No branch: which side is seen cannot be foretold.
#[inline(always)]
fn turned(w: Vec3, turn: u32) -> Vec3 {
    Vec3::new(w.x, w.y, Real::from_bits(w.z.to_bits() ^ turn))
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
