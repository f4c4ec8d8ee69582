//! The standard shaders as one type, and each of their answers as rounding would have it.

use super::{
    super::{
        kernel::{Bsdf, Carried, Lobe, Made, PerSolidAngle, Real, Scatter, Scattered, Spectrum, Vec3},
        standard::{
            Conductor, Dielectric, Diffuse, Distribution, Microfacet, Null, Plastic, RoughConductor, RoughDielectric, ThinDielectric,
        },
    },
    drawn, number, scaled, turned,
};
use crate::{
    nudge::Nudge,
    setting::{Facets, Material, Slopes},
};

/// Any shader of the standard crate.
#[derive(Clone, Copy, Debug)]
pub enum Surface {
    Diffuse(Diffuse),
    Conductor(Conductor),
    RoughConductor(RoughConductor),
    Dielectric(Dielectric),
    RoughDielectric(RoughDielectric),
    ThinDielectric(ThinDielectric),
    Plastic(Plastic),
    Null(Null),
}

macro_rules! whichever {
    ($surface:expr, $shader:ident => $answer:expr) => {
        match $surface {
            Surface::Diffuse($shader) => $answer,
            Surface::Conductor($shader) => $answer,
            Surface::RoughConductor($shader) => $answer,
            Surface::Dielectric($shader) => $answer,
            Surface::RoughDielectric($shader) => $answer,
            Surface::ThinDielectric($shader) => $answer,
            Surface::Plastic($shader) => $answer,
            Surface::Null($shader) => $answer,
        }
    };
}

fn bands(x: f64, y: f64, z: f64) -> Spectrum {
    Spectrum([number(x), number(y), number(z)])
}

fn microfacet((slopes, [u, v]): Facets) -> Microfacet {
    let distribution = match slopes {
        Slopes::Ggx => Distribution::Ggx,
        Slopes::Beckmann => Distribution::Beckmann,
    };
    Microfacet { distribution, alpha_u: number(u), alpha_v: number(v) }
}

impl Surface {
    pub fn new(material: &Material) -> Self {
        let (tint, white) = (bands(0.9, 0.5, 0.2), Spectrum::ONE);
        let (gold, absorption) = (bands(0.14, 0.37, 1.44), bands(3.98, 2.38, 1.6));
        match *material {
            Material::Diffuse => Self::Diffuse(Diffuse { reflectance: tint }),
            Material::Conductor => Self::Conductor(Conductor { eta: gold, k: absorption, specular_reflectance: white }),
            Material::RoughConductor(facets) => Self::RoughConductor(RoughConductor {
                eta: gold,
                k: absorption,
                specular_reflectance: tint,
                microfacet: microfacet(facets),
            }),
            Material::RoughMirror(facets) => Self::RoughConductor(RoughConductor {
                eta: Spectrum::BLACK,
                k: white,
                specular_reflectance: white,
                microfacet: microfacet(facets),
            }),
            Material::Dielectric(eta) => {
                Self::Dielectric(Dielectric { eta: number(eta), specular_reflectance: white, specular_transmittance: tint })
            }
            Material::RoughDielectric(eta, facets) => Self::RoughDielectric(RoughDielectric {
                eta: number(eta),
                specular_reflectance: white,
                specular_transmittance: tint,
                microfacet: microfacet(facets),
            }),
            Material::ThinDielectric(eta) => {
                Self::ThinDielectric(ThinDielectric { eta: number(eta), specular_reflectance: white, specular_transmittance: tint })
            }
            Material::Plastic(eta) => Self::Plastic(Plastic::new(number(eta), tint, white, true)),
            Material::Null => Self::Null(Null),
        }
    }

    /// [`Bsdf::eval`] of directions that were rounded on their way.
    pub fn eval(&self, nudge: &Nudge, wo: Vec3, wi: Vec3, carried: Carried) -> Scatter {
        let (wo, wi) = if nudge.active() { (turned(nudge, wo), turned(nudge, wi)) } else { (wo, wi) };
        whichever!(self, shader => shader.eval(wo, wi, carried))
    }

    /// [`Bsdf::sample`]. The densities and the weight of a sample are those of the direction that is returned, as it was rounded.
    pub fn sample(&self, nudge: &Nudge, wo: Vec3, u: [Real; 3], carried: Carried) -> Option<Scattered> {
        if !nudge.active() {
            return whichever!(self, shader => shader.sample(wo, u, carried));
        }
        // The third number is compared with a chance, and nothing else.
        let (from, [x, y]) = (turned(nudge, wo), drawn(nudge, [u[0], u[1]]));
        let u = [x, y, u[2]];
        let mut sampled = whichever!(self, shader => shader.sample(from, u, carried))?;
        sampled.wi = turned(nudge, sampled.wi);
        match &mut sampled.made {
            Made::Smooth { pdf, pdf_rev } => {
                let scatter = self.eval(nudge, wo, sampled.wi, carried);
                if !(scatter.pdf.0 > 0.0) {
                    return None;
                }
                sampled.weight = scatter.value / scatter.pdf.0;
                (*pdf, *pdf_rev) = (PerSolidAngle(scaled(nudge, scatter.pdf.0)), PerSolidAngle(scaled(nudge, scatter.pdf_rev.0)));
            }
            Made::Delta { chance, chance_rev } => {
                (chance.0, chance_rev.0) = (scaled(nudge, chance.0), scaled(nudge, chance_rev.0));
            }
        }
        sampled.weight = sampled.weight.map(|band| scaled(nudge, band));
        Some(sampled)
    }

    pub fn lobes(&self) -> Lobe {
        whichever!(self, shader => shader.lobes())
    }
}
