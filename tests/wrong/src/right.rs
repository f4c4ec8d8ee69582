//! What the mistakes are made in.

use bidir_sdk::{Bsdf, Carried, Lobe, Made, PerSolidAngle, Real, Scatter, Scattered, Spectrum, Vec3};
use bidir_standard::{Dielectric, Diffuse, Distribution, Microfacet, Plastic, RoughConductor, RoughDielectric};

/// A right surface.
#[derive(Clone, Copy)]
pub enum Right {
    Mixed(Mixed),
    Glass(RoughDielectric),
    Plastic(Plastic),
    Clear(Dielectric),
}

/// Half matt, half rough metal.
#[derive(Clone, Copy)]
pub struct Mixed {
    pub matt: Diffuse,
    pub metal: RoughConductor,
}

pub fn microfacet(alpha: Real) -> Microfacet {
    Microfacet { distribution: Distribution::Ggx, alpha_u: alpha, alpha_v: alpha }
}

pub fn mixed(alpha: Real, albedo: Spectrum) -> Mixed {
    let metal =
        RoughConductor { eta: Spectrum::BLACK, k: Spectrum::ONE, specular_reflectance: Spectrum::ONE, microfacet: microfacet(alpha) };
    Mixed { matt: Diffuse { reflectance: albedo }, metal }
}

impl Right {
    fn shader(&self) -> &dyn Bsdf {
        match self {
            Self::Mixed(shader) => shader,
            Self::Glass(shader) => shader,
            Self::Plastic(shader) => shader,
            Self::Clear(shader) => shader,
        }
    }
}

impl Bsdf for Right {
    fn eval(&self, wo: Vec3, wi: Vec3, carried: Carried) -> Scatter {
        self.shader().eval(wo, wi, carried)
    }

    fn sample(&self, wo: Vec3, u: [Real; 3], carried: Carried) -> Option<Scattered> {
        self.shader().sample(wo, u, carried)
    }

    fn lobes(&self) -> Lobe {
        self.shader().lobes()
    }
}

impl Bsdf for Mixed {
    fn eval(&self, wo: Vec3, wi: Vec3, carried: Carried) -> Scatter {
        let (a, b) = (self.matt.eval(wo, wi, carried), self.metal.eval(wo, wi, carried));
        let half = |a: PerSolidAngle, b: PerSolidAngle| PerSolidAngle(0.5 * (a.0 + b.0));
        Scatter { value: (a.value + b.value) * 0.5, pdf: half(a.pdf, b.pdf), pdf_rev: half(a.pdf_rev, b.pdf_rev) }
    }

    fn sample(&self, wo: Vec3, u: [Real; 3], carried: Carried) -> Option<Scattered> {
        let one: &dyn Bsdf = if u[2] < 0.5 { &self.matt } else { &self.metal };
        let sample = one.sample(wo, u, carried)?;
        let Scatter { value, pdf, pdf_rev } = self.eval(wo, sample.wi, carried);
        Some(Scattered { weight: value / pdf.0, made: Made::Smooth { pdf, pdf_rev }, ..sample })
    }

    fn lobes(&self) -> Lobe {
        Lobe::DIFFUSE_REFLECTION | Lobe::GLOSSY_REFLECTION
    }
}
