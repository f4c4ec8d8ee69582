//! Cloth whose fibres shine at grazing angles: the sheen of Estevez & Kulla 2017 over a matt base.
//!
//! f = tint · sheen + ρ/π (1 − t E(ω_o)) (1 − t E(ω_i))/(1 − t E_mean), where E is the sheen's albedo and t the strongest
//! band of the tint: the base gets what the sheen leaves, the same both ways, and white on white gives everything back.
#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "`!(x > 0.0)` refuses NaN too")]

pub mod sheen;

use bidir_sdk::{
    Bsdf, Carried, Lobe, Made, PerSolidAngle, Real, Scatter, Scattered, Vec3,
    math::{safe_sqrt, sin_cos, vec3},
    real::{INV_PI, PI},
    warp::{cosine_hemisphere, cosine_hemisphere_pdf},
};
use sheen::Sheen;

bidir_sdk::parameters! {
    /// Cloth whose fibres shine at grazing angles: velvet, felt, brushed cotton.
    pub struct Velvet {
        /// Colour of the cloth below the sheen.
        reflectance: rgb(min 0.0, max 1.0, texturable, label "Colour") = [0.18, 0.02, 0.03];
        /// Colour of the sheen.
        tint: rgb(min 0.0, max 1.0, texturable, label "Sheen") = [0.8, 0.5, 0.45];
        /// How far the sheen reaches in from the silhouette.
        roughness: float(min 0.1, max 1.0, texturable, label "Roughness") = 0.3;
    }
}

/// What one direction says, whatever the other is.
struct End {
    /// The share of light that the sheen leaves to the base.
    left: Real,
    /// The chance that a sample is one of the sheen.
    sheen: Real,
}

impl Velvet {
    fn end(&self, sheen: &Sheen, cos: Real) -> End {
        let albedo = sheen.albedo(cos);
        let left = 1.0 - self.tint.max() * albedo;
        let (shine, base) = (self.tint.mean() * albedo, self.reflectance.mean() * left);
        End { left, sheen: if shine + base > 0.0 { shine / (shine + base) } else { 0.0 } }
    }

    fn scatter(&self, wo: Vec3, wi: Vec3, sheen: &Sheen, [out, into]: [&End; 2]) -> Scatter {
        let base = out.left * into.left / (1.0 - self.tint.max() * sheen.mean_albedo()) * INV_PI;
        let pdf = |chance: Real, cos: Real| PerSolidAngle(chance * UNIFORM_PDF + (1.0 - chance) * cosine_hemisphere_pdf(cos));
        Scatter {
            value: (self.tint * sheen.value(wo, wi) + self.reflectance * base) * wi.z,
            pdf: pdf(out.sheen, wi.z),
            pdf_rev: pdf(into.sheen, wo.z),
        }
    }
}

/// Uniform on the hemisphere: sheen has no peak to look for, and its microfacets' normals would mostly reflect below.
const UNIFORM_PDF: Real = 0.5 * INV_PI;

fn uniform_hemisphere(u: [Real; 2]) -> Vec3 {
    // Off 0, as every direction that is scattered into.
    let z = u[0].max(1e-7);
    let r = safe_sqrt((1.0 - z) * (1.0 + z));
    let (sin, cos) = sin_cos(2.0 * PI * u[1]);
    vec3(r * cos, r * sin, z)
}

impl Bsdf for Velvet {
    fn eval(&self, wo: Vec3, wi: Vec3, _: Carried) -> Scatter {
        if !(wo.z > 0.0 && wi.z > 0.0) {
            return Scatter::NONE;
        }
        let sheen = Sheen::new(self.roughness);
        self.scatter(wo, wi, &sheen, [&self.end(&sheen, wo.z), &self.end(&sheen, wi.z)])
    }

    fn sample(&self, wo: Vec3, u: [Real; 3], _: Carried) -> Option<Scattered> {
        if !(wo.z > 0.0) {
            return None;
        }
        let sheen = Sheen::new(self.roughness);
        let out = self.end(&sheen, wo.z);
        let shines = u[2] < out.sheen;
        let wi = if shines { uniform_hemisphere([u[0], u[1]]) } else { cosine_hemisphere([u[0], u[1]]) };
        let Scatter { value, pdf, pdf_rev } = self.scatter(wo, wi, &sheen, [&out, &self.end(&sheen, wi.z)]);
        Some(Scattered {
            wi,
            weight: value / pdf.0,
            made: Made::Smooth { pdf, pdf_rev },
            eta: 1.0,
            lobe: if shines { Lobe::GLOSSY_REFLECTION } else { Lobe::DIFFUSE_REFLECTION },
        })
    }

    fn lobes(&self) -> Lobe {
        Lobe::DIFFUSE_REFLECTION | Lobe::GLOSSY_REFLECTION
    }
}

bidir_sdk::bsdf! { Velvet, lobes: [diffuse_reflection, glossy_reflection], isotropic: true }

#[cfg(test)]
mod tests {
    use bidir_sdk::Spectrum;

    use super::*;

    fn velvet(reflectance: Spectrum, tint: Spectrum, roughness: Real) -> Velvet {
        Velvet { reflectance, tint, roughness }
    }

    fn cases() -> Vec<(String, Box<dyn Bsdf>)> {
        let red = Spectrum([0.5, 0.05, 0.02]);
        let pink = Spectrum([1.0, 0.6, 0.7]);
        let case = |name: &str, velvet: Velvet| (name.to_owned(), Box::new(velvet) as Box<dyn Bsdf>);
        vec![
            case("fine", velvet(red, pink, 0.1)),
            case("plain", velvet(red, pink, 0.35)),
            case("rough", velvet(red, pink, 1.0)),
            case("white on white", velvet(Spectrum::ONE, Spectrum::ONE, 0.3)),
            case("sheen alone", velvet(Spectrum::BLACK, pink, 0.3)),
            case("base alone", velvet(red, Spectrum::BLACK, 0.3)),
            case("black", velvet(Spectrum::BLACK, Spectrum::BLACK, 0.3)),
        ]
    }

    bidir_proof::surface_tests!(cases());

    #[test]
    fn white_on_white_gives_everything_back_but_what_the_table_rounds_up() {
        for roughness in [0.1, 0.17, 0.3, 0.6, 1.0] {
            for cos in [1.0, 0.7, 0.3, 0.1, 0.03] {
                let white = velvet(Spectrum::ONE, Spectrum::ONE, roughness);
                let (albedo, error) = bidir_proof::surface::albedo(&white, bidir_proof::direction(cos, 0.4), 100_000);
                assert!(albedo > 0.98 - 4.5 * error && albedo < 1.0 + 4.5 * error, "{roughness} at {cos}: {albedo} ± {error}");
            }
        }
    }

    #[test]
    fn the_sheen_alone_reflects_what_the_table_says() {
        for roughness in [0.1, 0.17, 0.3, 0.6, 1.0] {
            for cos in [1.0, 0.7, 0.3, 0.1, 0.03] {
                let alone = velvet(Spectrum::BLACK, Spectrum::ONE, roughness);
                let (albedo, error) = bidir_proof::surface::albedo(&alone, bidir_proof::direction(cos, 0.4), 100_000);
                let said = f64::from(Sheen::new(roughness).albedo(cos));
                assert!(albedo < said + 4.5 * error && albedo > said - 0.02 - 4.5 * error, "{roughness} at {cos}: {albedo} against {said}");
            }
        }
    }
}
