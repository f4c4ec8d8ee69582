//! What a surface does to light, as a shader's author writes it.

use core::ops::{BitOr, BitOrAssign};

use crate::{
    density::{Chance, PerSolidAngle},
    real::{Real, Vec3},
    spectrum::Spectrum,
};

/// What the walk that meets a surface carries. It decides the η² factor of refraction, and nothing else in a shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Carried {
    /// The walk came from the camera: refraction scales by (η_o/η_i)².
    Radiance,
    /// The walk came from a light: no factor.
    Importance,
}

/// A set of lobes, as bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Lobe(pub u32);

impl Lobe {
    /// No lobe.
    pub const NONE: Self = Self(0);
    /// Reflection into the whole hemisphere.
    pub const DIFFUSE_REFLECTION: Self = Self(1);
    /// Reflection about the mirror direction.
    pub const GLOSSY_REFLECTION: Self = Self(2);
    /// Reflection into one direction.
    pub const DELTA_REFLECTION: Self = Self(4);
    /// Transmission into the whole hemisphere.
    pub const DIFFUSE_TRANSMISSION: Self = Self(8);
    /// Transmission about the refracted direction.
    pub const GLOSSY_TRANSMISSION: Self = Self(16);
    /// Transmission into one direction.
    pub const DELTA_TRANSMISSION: Self = Self(32);
    /// Every lobe that has a density: what a path can be joined through.
    pub const SMOOTH: Self = Self(1 | 2 | 8 | 16);
    /// Every lobe that has a density, on the side the light came from.
    pub const SMOOTH_REFLECTION: Self = Self(1 | 2);
    /// Every lobe that has a density, on the other side.
    pub const SMOOTH_TRANSMISSION: Self = Self(8 | 16);
    /// Every lobe into one direction.
    pub const DELTA: Self = Self(4 | 32);
    /// Every lobe on the side the light came from.
    pub const REFLECTION: Self = Self(1 | 2 | 4);
    /// Every lobe on the other side.
    pub const TRANSMISSION: Self = Self(8 | 16 | 32);

    /// Whether the two sets share a lobe.
    #[inline(always)]
    pub const fn intersects(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// Whether this set holds all of `other`.
    #[inline(always)]
    pub const fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }
}

impl BitOr for Lobe {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl BitOrAssign for Lobe {
    #[inline(always)]
    fn bitor_assign(&mut self, other: Self) {
        self.0 |= other.0;
    }
}

/// The smooth lobes' answer for a pair of directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scatter {
    /// f(ω_o, ω_i) · |cos θ_i|, 1/sr.
    pub value: Spectrum,
    /// How densely [`Bsdf::sample`] makes ω_i from ω_o, the chance of picking the lobe included.
    pub pdf: PerSolidAngle,
    /// How densely it makes ω_o from ω_i.
    pub pdf_rev: PerSolidAngle,
}

impl Scatter {
    /// Nothing is scattered between these directions.
    pub const NONE: Self = Self { value: Spectrum::BLACK, pdf: PerSolidAngle(0.0), pdf_rev: PerSolidAngle(0.0) };
}

/// How a sampled direction came about.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Made {
    /// From lobes that have a density: both densities, summed over all smooth lobes, pick chances included.
    Smooth {
        /// Of making ω_i from ω_o.
        pdf: PerSolidAngle,
        /// Of making ω_o from ω_i.
        pdf_rev: PerSolidAngle,
    },
    /// From a lobe into one direction: the chances of picking it.
    Delta {
        /// With light arriving along ω_o.
        chance: Chance,
        /// With light arriving along ω_i.
        chance_rev: Chance,
    },
}

/// A sampled direction and all that anyone will ask of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scattered {
    /// The sampled direction, unit, away from the surface, in the shading frame.
    pub wi: Vec3,
    /// f · |cos θ_i| / pdf (for a delta lobe: / chance); finite even where both are not.
    pub weight: Spectrum,
    /// The densities or chances behind it.
    pub made: Made,
    /// Index of refraction on ω_i's side / on ω_o's side where the sample was refracted; 1 otherwise.
    pub eta: Real,
    /// The one lobe that made it.
    pub lobe: Lobe,
}

/// How many directions one [`Bsdf::eval_n`] has at most.
pub const BATCH: usize = 8;

/// A surface's scattering, in its own shading frame: z is the normal; ω_o (towards where the walk came from)
/// and ω_i (where it goes on to) are unit vectors that both point away from the surface.
///
/// A shader is pure: the same arguments give the same answer. It never applies the adjoint factor of shading normals.
pub trait Bsdf {
    /// Value and densities of the smooth lobes; [`Scatter::NONE`] where there are none.
    fn eval(&self, wo: Vec3, wi: Vec3, carried: Carried) -> Scatter;

    /// Samples ω_i with three numbers in [0, 1); `None` absorbs the walk.
    fn sample(&self, wo: Vec3, u: [Real; 3], carried: Carried) -> Option<Scattered>;

    /// Every lobe this surface can have here.
    fn lobes(&self) -> Lobe;

    /// [`Bsdf::eval`] towards each of `wi`, at most [`BATCH`], into `scatters`. Worth writing where a call costs more than its answer,
    /// as one into a sandbox does; the answers must be those of the single calls.
    #[inline]
    fn eval_n(&self, wo: Vec3, wi: &[Vec3], carried: Carried, scatters: &mut [Scatter]) {
        for (scatter, wi) in scatters.iter_mut().zip(wi) {
            *scatter = self.eval(wo, *wi, carried);
        }
    }

    /// [`Bsdf::eval`] and [`Bsdf::sample`] for one ω_o: what a walk mostly asks at a vertex. Worth writing as [`Bsdf::eval_n`] is.
    #[inline]
    fn eval_and_sample(&self, wo: Vec3, wi: Vec3, u: [Real; 3], carried: Carried) -> (Scatter, Option<Scattered>) {
        (self.eval(wo, wi, carried), self.sample(wo, u, carried))
    }
}

impl<B: Bsdf> Bsdf for &B {
    #[inline(always)]
    fn eval(&self, wo: Vec3, wi: Vec3, carried: Carried) -> Scatter {
        (**self).eval(wo, wi, carried)
    }

    #[inline(always)]
    fn sample(&self, wo: Vec3, u: [Real; 3], carried: Carried) -> Option<Scattered> {
        (**self).sample(wo, u, carried)
    }

    #[inline(always)]
    fn lobes(&self) -> Lobe {
        (**self).lobes()
    }

    #[inline(always)]
    fn eval_n(&self, wo: Vec3, wi: &[Vec3], carried: Carried, scatters: &mut [Scatter]) {
        (**self).eval_n(wo, wi, carried, scatters);
    }

    #[inline(always)]
    fn eval_and_sample(&self, wo: Vec3, wi: Vec3, u: [Real; 3], carried: Carried) -> (Scatter, Option<Scattered>) {
        (**self).eval_and_sample(wo, wi, u, carried)
    }
}
