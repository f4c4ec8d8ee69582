//! Scatters alike in every direction.

use bidir_sdk::{
    Bsdf, Carried, Lobe, Made, PerSolidAngle, Real, Scatter, Scattered, Spectrum, Vec3,
    real::INV_PI,
    warp::{cosine_hemisphere, cosine_hemisphere_pdf},
};

/// Lambert's surface: f = reflectance/π above, nothing below.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Diffuse {
    /// Albedo per band, 0 … 1.
    pub reflectance: Spectrum,
}

impl Bsdf for Diffuse {
    #[inline]
    fn eval(&self, wo: Vec3, wi: Vec3, _: Carried) -> Scatter {
        if !(wo.z > 0.0 && wi.z > 0.0) {
            return Scatter::NONE;
        }
        Scatter {
            value: self.reflectance * (wi.z * INV_PI),
            pdf: PerSolidAngle(cosine_hemisphere_pdf(wi.z)),
            pdf_rev: PerSolidAngle(cosine_hemisphere_pdf(wo.z)),
        }
    }

    #[inline]
    fn sample(&self, wo: Vec3, u: [Real; 3], _: Carried) -> Option<Scattered> {
        if !(wo.z > 0.0) {
            return None;
        }
        let wi = cosine_hemisphere([u[0], u[1]]);
        Some(Scattered {
            wi,
            weight: self.reflectance,
            made: Made::Smooth { pdf: PerSolidAngle(cosine_hemisphere_pdf(wi.z)), pdf_rev: PerSolidAngle(cosine_hemisphere_pdf(wo.z)) },
            eta: 1.0,
            lobe: Lobe::DIFFUSE_REFLECTION,
        })
    }

    #[inline]
    fn lobes(&self) -> Lobe {
        Lobe::DIFFUSE_REFLECTION
    }
}
