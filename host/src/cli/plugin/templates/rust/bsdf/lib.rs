//! {{Name}}: matt paint that sends part of the light back to where it came from.
//!
//! f(ω_o, ω_i) = tint · ((1 − retro)/π + retro · 17/2π · max(0, ω_o · ω_i)¹⁵), on the front only.
//! 17/2π keeps the lobe from sending back more than it gets at any angle.

use bidir_sdk::{
    Bsdf, Carried, Frame, Lobe, Made, PerSolidAngle, Real, Scatter, Scattered, Vec3,
    math::{dot, safe_sqrt, sin_cos, sqrt, vec3},
    real::{INV_PI, PI},
};

bidir_sdk::parameters! {
    /// Matt paint that sends part of the light back to where it came from.
    pub struct {{Name}} {
        /// Colour of both parts.
        tint: rgb(min 0.0, max 1.0, texturable, label "Tint") = [0.8, 0.4, 0.1];
        /// Share that goes back to where the light came from; the rest is matt.
        retro: float(min 0.0, max 1.0, texturable, label "Retro") = 0.5;
    }
}

bidir_sdk::bsdf! { {{Name}}, lobes: [diffuse_reflection, glossy_reflection], isotropic: true }

impl {{Name}} {
    /// How densely both lobes together make a direction of cosine `cos` that encloses an angle of cosine `d` with the other one.
    fn density(&self, cos: Real, d: Real) -> PerSolidAngle {
        PerSolidAngle((1.0 - self.retro) * (cos * INV_PI) + self.retro * (8.0 * INV_PI * power_15(d)))
    }
}

impl Bsdf for {{Name}} {
    fn eval(&self, wo: Vec3, wi: Vec3, _: Carried) -> Scatter {
        if !(wo.z > 0.0 && wi.z > 0.0) {
            return Scatter::NONE;
        }
        let d = dot(wo, wi).max(0.0);
        let f = (1.0 - self.retro) * INV_PI + self.retro * (8.5 * INV_PI * power_15(d));
        Scatter { value: self.tint * (f * wi.z), pdf: self.density(wi.z, d), pdf_rev: self.density(wo.z, d) }
    }

    fn sample(&self, wo: Vec3, u: [Real; 3], carried: Carried) -> Option<Scattered> {
        if !(wo.z > 0.0) {
            return None;
        }
        // The cosine has density 16 d¹⁵ about ω_o: the sixteenth root; about the normal 2 cos: the square root.
        let root = sqrt(u[0]);
        let (wi, lobe) = if u[2] < self.retro {
            (Frame::from_z(wo).to_world(about_z(sqrt(sqrt(sqrt(root))), u[1])), Lobe::GLOSSY_REFLECTION)
        } else {
            (about_z(root, u[1]), Lobe::DIFFUSE_REFLECTION)
        };
        let Scatter { value, pdf, pdf_rev } = self.eval(wo, wi, carried);
        // Below the surface, where eval knows nothing, there is no sample.
        (pdf.0 > 0.0).then(|| Scattered { wi, weight: value / pdf.0, made: Made::Smooth { pdf, pdf_rev }, eta: 1.0, lobe })
    }

    fn lobes(&self) -> Lobe {
        Lobe::DIFFUSE_REFLECTION | Lobe::GLOSSY_REFLECTION
    }
}

/// d¹⁵ for d from 0 to 1.
fn power_15(d: Real) -> Real {
    let d2 = d * d;
    let d4 = d2 * d2;
    d4 * d4 * d4 * d2 * d
}

/// A direction of cosine `cos` to z.
fn about_z(cos: Real, u: Real) -> Vec3 {
    let r = safe_sqrt(1.0 - cos * cos);
    let (sin_phi, cos_phi) = sin_cos(2.0 * PI * u);
    vec3(r * cos_phi, r * sin_phi, cos)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_reverse_density_is_the_density_with_the_directions_swapped() {
        let shader = {{Name}}::default();
        let (wo, wi) = (vec3(0.6, 0.0, 0.8), vec3(0.0, -0.8, 0.6));
        let (there, back) = (shader.eval(wo, wi, Carried::Radiance), shader.eval(wi, wo, Carried::Importance));
        assert_eq!((there.pdf, there.pdf_rev), (back.pdf_rev, back.pdf));
    }

    #[test]
    fn a_sample_knows_its_density() {
        let (shader, wo) = ({{Name}}::default(), vec3(0.6, 0.0, 0.8));
        for u in [[0.1, 0.2, 0.3], [0.9, 0.4, 0.7], [0.5, 0.8, 0.1]] {
            let Some(sample) = shader.sample(wo, u, Carried::Radiance) else { continue };
            let Scatter { pdf, pdf_rev, .. } = shader.eval(wo, sample.wi, Carried::Radiance);
            assert_eq!(sample.made, Made::Smooth { pdf, pdf_rev });
        }
    }
}
