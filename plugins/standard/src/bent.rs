//! A surface whose shading normal is turned.

use bidir_sdk::{
    Bsdf, Carried, Chance, Lobe, Made, PerSolidAngle, Real, Scatter, Scattered, Vec3,
    math::{dot, min, normalize, sqr, sqrt, vec3},
};

/// A surface as if its normal pointed elsewhere: what normal maps and bump maps do, as Mitsuba 3.9 defines them.
///
/// A pair of directions has a camera's end and a light's end, whichever a walk comes from. Where the camera would see the back of the turned
/// normal, its mirror image about the true one takes its place (Schüssler et al. 2017). Light that arrives on different sides of the two
/// normals is lost; near there a shadow softens the edge (Conty Estevez, Lecocq & Stein 2019). And f |cos θ| is that about the turned
/// normal at the light's end, so that the surface is not reciprocal: Veach's adjoint of shading normals (1997, §5.3), which here the surface
/// applies itself, since the frame of [`Bsdf`] does not know of the turned one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bent<B> {
    /// About the turned normal, and about its mirror image.
    frames: [Axes; 2],
    flips: bool,
    /// Roughness² of the normals that the shadow stands for; 0 without one.
    shadow: Real,
    bsdf: B,
}

/// Which of the frames.
type Side = usize;

/// The turned one.
const TURNED: Side = 0;
/// Its mirror image.
const MIRRORED: Side = 1;

/// How often a light walk, which does not know yet from where it will be seen, takes the mirrored normal where either may be.
const SELDOM: Real = 0.125;

#[derive(Clone, Copy, Debug, PartialEq)]
struct Axes {
    x: Vec3,
    y: Vec3,
    z: Vec3,
}

impl Axes {
    /// About a unit vector, x as near to the outer x as can be.
    #[inline]
    fn about(z: Vec3) -> Self {
        let x = normalize(vec3(1.0, 0.0, 0.0) - z * z.x).unwrap_or(vec3(0.0, 1.0, 0.0));
        Self { x, y: z.cross(x), z }
    }

    #[inline]
    fn inside(&self, w: Vec3) -> Vec3 {
        vec3(dot(w, self.x), dot(w, self.y), dot(w, self.z))
    }

    #[inline]
    fn outside(&self, w: Vec3) -> Vec3 {
        self.x * w.x + self.y * w.y + self.z * w.z
    }
}

impl<B> Bent<B> {
    /// `bsdf` about a unit normal; `flips`: whether its mirror image takes its place where the camera sees its back; `shadowed`: whether
    /// the edge of what is lost is softened.
    #[inline]
    pub fn new(normal: Vec3, flips: bool, shadowed: bool, bsdf: B) -> Self {
        let mirrored = vec3(-normal.x, -normal.y, normal.z);
        let tilted = normal.x != 0.0 || normal.y != 0.0;
        let shadow = if shadowed { min(0.125 * tan2(normal), 1.0) } else { 0.0 };
        Self { frames: [Axes::about(normal), Axes::about(mirrored)], flips: flips && tilted, shadow, bsdf }
    }

    /// The frame for a camera's end.
    #[inline]
    fn seen_from(&self, camera: Vec3) -> Side {
        if self.flips && !(camera.z * dot(camera, self.frames[TURNED].z) > 0.0) { MIRRORED } else { TURNED }
    }

    /// The chance that a light walk takes each frame.
    #[inline]
    fn chances(&self, light: Vec3) -> [Real; 2] {
        let lit = |side: Side| light.z * dot(light, self.frames[side].z) > 0.0;
        match (self.flips, lit(TURNED), lit(MIRRORED)) {
            (false, _, _) | (_, _, false) => [1.0, 0.0],
            (true, false, true) => [0.0, 1.0],
            (true, true, true) => [1.0 - SELDOM, SELDOM],
        }
    }

    /// What the value in a frame is to be multiplied by, 0 where the light is lost.
    #[inline]
    fn factor(&self, side: Side, wo: Vec3, wi: Vec3, carried: Carried) -> Real {
        let z = self.frames[side].z;
        let (light, adjoint) = match carried {
            Carried::Radiance => (wi, 1.0),
            Carried::Importance => {
                let cos = dot(wi, z);
                (wo, if cos == 0.0 || wo.z == 0.0 { 0.0 } else { (dot(wo, z) / wo.z * (wi.z / cos)).abs() })
            }
        };
        if light.z * dot(light, z) > 0.0 { adjoint * 2.0 / (1.0 + sqrt(1.0 + self.shadow * tan2(light))) } else { 0.0 }
    }
}

/// tan² of the angle to z.
#[inline]
fn tan2(w: Vec3) -> Real {
    (sqr(w.x) + sqr(w.y)) / sqr(w.z)
}

impl<B: Bsdf> Bent<B> {
    #[inline]
    fn within(&self, side: Side, wo: Vec3, wi: Vec3, carried: Carried) -> Scatter {
        let axes = &self.frames[side];
        self.bsdf.eval(axes.inside(wo), axes.inside(wi), carried)
    }

    /// Samples in one frame; `wi` in the outer frame.
    #[inline]
    fn sample_within(&self, side: Side, wo: Vec3, u: [Real; 3], carried: Carried) -> Option<Scattered> {
        let axes = &self.frames[side];
        let scattered = self.bsdf.sample(axes.inside(wo), u, carried)?;
        Some(Scattered { wi: axes.outside(scattered.wi), ..scattered })
    }

    /// The density of a light walk, of those in a frame and in the other one.
    #[inline]
    fn mixed(&self, side: Side, light: Vec3, own: Real, other: impl FnOnce() -> Real) -> Real {
        let chances = self.chances(light);
        let rest = chances[1 - side];
        chances[side] * own + if rest > 0.0 { rest * other() } else { 0.0 }
    }

    /// A sample of a camera walk.
    fn sample_from_camera(&self, wo: Vec3, u: [Real; 3]) -> Option<Scattered> {
        let carried = Carried::Radiance;
        let side = self.seen_from(wo);
        let scattered = self.sample_within(side, wo, u, carried)?;
        let wi = scattered.wi;
        let made = match scattered.made {
            Made::Delta { chance, chance_rev } => Made::Delta { chance, chance_rev: Chance(self.chances(wi)[side] * chance_rev.0) },
            Made::Smooth { pdf, pdf_rev } => {
                let rev = self.mixed(side, wi, pdf_rev.0, || self.within(1 - side, wo, wi, carried).pdf_rev.0);
                Made::Smooth { pdf, pdf_rev: PerSolidAngle(rev) }
            }
        };
        Some(Scattered { made, ..scattered })
    }

    /// A sample of a light walk.
    fn sample_from_light(&self, wo: Vec3, u: [Real; 3]) -> Option<Scattered> {
        let carried = Carried::Importance;
        let chances = self.chances(wo);
        let (side, again) = if u[2] < chances[MIRRORED] {
            (MIRRORED, u[2] / chances[MIRRORED])
        } else {
            (TURNED, min((u[2] - chances[MIRRORED]) / chances[TURNED], 1.0 - Real::EPSILON))
        };
        let scattered = self.sample_within(side, wo, [u[0], u[1], again], carried)?;
        let (wi, seen) = (scattered.wi, self.seen_from(scattered.wi));
        let (own_chance, other_chance) = (chances[side], chances[1 - side]);
        match scattered.made {
            // The other frame's mirror sends light elsewhere.
            Made::Delta { .. } if seen != side => None,
            Made::Delta { chance, chance_rev } => Some(Scattered {
                weight: scattered.weight * (1.0 / own_chance),
                made: Made::Delta { chance: Chance(own_chance * chance.0), chance_rev },
                ..scattered
            }),
            Made::Smooth { pdf, pdf_rev } if other_chance == 0.0 && seen == side => {
                Some(Scattered { made: Made::Smooth { pdf, pdf_rev }, ..scattered })
            }
            Made::Smooth { pdf, pdf_rev } => {
                let other = self.within(1 - side, wo, wi, carried);
                let both = own_chance * pdf.0 + other_chance * other.pdf.0;
                let (weight, rev) = if seen == side {
                    // Of densities beyond all numbers the weight is that of the one lobe.
                    (scattered.weight * (1.0 / (own_chance + other_chance * (other.pdf.0 / pdf.0))), pdf_rev)
                } else {
                    (other.value * (1.0 / both), other.pdf_rev)
                };
                Some(Scattered { weight, made: Made::Smooth { pdf: PerSolidAngle(both), pdf_rev: rev }, ..scattered })
            }
        }
    }
}

impl<B: Bsdf> Bsdf for Bent<B> {
    fn eval(&self, wo: Vec3, wi: Vec3, carried: Carried) -> Scatter {
        let (camera, light) = match carried {
            Carried::Radiance => (wo, wi),
            Carried::Importance => (wi, wo),
        };
        let side = self.seen_from(camera);
        let factor = self.factor(side, wo, wi, carried);
        if !(factor > 0.0) {
            return Scatter::NONE;
        }
        let Scatter { value, pdf, pdf_rev } = self.within(side, wo, wi, carried);
        let other = || self.within(1 - side, wo, wi, carried);
        let (pdf, pdf_rev) = match carried {
            Carried::Radiance => (pdf, PerSolidAngle(self.mixed(side, light, pdf_rev.0, || other().pdf_rev.0))),
            Carried::Importance => (PerSolidAngle(self.mixed(side, light, pdf.0, || other().pdf.0)), pdf_rev),
        };
        Scatter { value: value * factor, pdf, pdf_rev }
    }

    fn sample(&self, wo: Vec3, u: [Real; 3], carried: Carried) -> Option<Scattered> {
        let scattered = match carried {
            Carried::Radiance => self.sample_from_camera(wo, u)?,
            Carried::Importance => self.sample_from_light(wo, u)?,
        };
        let camera = match carried {
            Carried::Radiance => wo,
            Carried::Importance => scattered.wi,
        };
        let factor = self.factor(self.seen_from(camera), wo, scattered.wi, carried);
        (factor > 0.0).then_some(Scattered { weight: scattered.weight * factor, ..scattered })
    }

    fn lobes(&self) -> Lobe {
        self.bsdf.lobes()
    }
}
