//! A thin sheet that scatters light back and lets light through. `../README.md` holds the definition that this source
//! and its twin in C follow.
#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "`!(x > 0.0)` refuses NaN too")]

use bidir_sdk::{
    Bsdf, Carried, Lobe, Made, PerSolidAngle, Real, Scatter, Scattered, Spectrum, Vec3, math::vec3, real::INV_PI, warp::cosine_hemisphere,
};

bidir_sdk::parameters! {
    /// A thin sheet that scatters light back and lets light through: a leaf, paper, a lampshade.
    pub struct Leaf {
        /// Albedo of the side that the normal points to.
        front: rgb(min 0.0, max 1.0, texturable, label "Front") = [0.07, 0.19, 0.03];
        /// Albedo of the other side.
        back: rgb(min 0.0, max 1.0, texturable, label "Back") = [0.16, 0.25, 0.1];
        /// Share of light that passes, either way; less where it and an albedo would exceed 1.
        transmittance: rgb(min 0.0, max 1.0, texturable, label "Transmittance") = [0.2, 0.38, 0.04];
    }
}

impl Leaf {
    /// Albedo of the side that `w` lies on.
    fn reflectance(&self, w: Vec3) -> Spectrum {
        if w.z > 0.0 { self.front } else { self.back }
    }

    /// What passes: the same both ways, or the sheet would not be reciprocal.
    fn passing(&self) -> Spectrum {
        Spectrum(core::array::from_fn(|band| self.transmittance[band].min(1.0 - self.front[band].max(self.back[band]))))
    }

    /// The chance that a sample seen from `w` is one of transmission; `None` where the sheet is black.
    fn pass_chance(&self, w: Vec3) -> Option<Real> {
        let (r, t) = (self.reflectance(w).mean(), self.passing().mean());
        (r + t > 0.0).then(|| t / (r + t))
    }
}

impl Bsdf for Leaf {
    fn eval(&self, wo: Vec3, wi: Vec3, _: Carried) -> Scatter {
        let (out, into) = (wo.z.abs(), wi.z.abs());
        if !(out > 0.0 && into > 0.0) {
            return Scatter::NONE;
        }
        let same_side = (wo.z > 0.0) == (wi.z > 0.0);
        let chance = |w| {
            let pass = self.pass_chance(w);
            pass.map_or(0.0, |pass| if same_side { 1.0 - pass } else { pass })
        };
        let albedo = if same_side { self.reflectance(wo) } else { self.passing() };
        Scatter {
            value: albedo * (into * INV_PI),
            pdf: PerSolidAngle(chance(wo) * (into * INV_PI)),
            pdf_rev: PerSolidAngle(chance(wi) * (out * INV_PI)),
        }
    }

    fn sample(&self, wo: Vec3, u: [Real; 3], carried: Carried) -> Option<Scattered> {
        if !(wo.z.abs() > 0.0) {
            return None;
        }
        let pass = self.pass_chance(wo)?;
        let up = cosine_hemisphere([u[0], u[1]]);
        let passes = u[2] < pass;
        let wi = if passes == (wo.z > 0.0) { vec3(up.x, up.y, -up.z) } else { up };
        let (weight, lobe) = if passes {
            (self.passing() / pass, Lobe::DIFFUSE_TRANSMISSION)
        } else {
            (self.reflectance(wo) / (1.0 - pass), Lobe::DIFFUSE_REFLECTION)
        };
        let Scatter { pdf, pdf_rev, .. } = self.eval(wo, wi, carried);
        Some(Scattered { wi, weight, made: Made::Smooth { pdf, pdf_rev }, eta: 1.0, lobe })
    }

    fn lobes(&self) -> Lobe {
        Lobe::DIFFUSE_REFLECTION | Lobe::DIFFUSE_TRANSMISSION
    }
}

bidir_sdk::bsdf! { Leaf, lobes: [diffuse_reflection, diffuse_transmission], isotropic: true }

#[cfg(test)]
mod tests {
    use super::*;

    const GREEN: Spectrum = Spectrum([0.1, 0.3, 0.05]);
    const PALE: Spectrum = Spectrum([0.4, 0.5, 0.3]);

    fn leaf(front: Spectrum, back: Spectrum, transmittance: Spectrum) -> Leaf {
        Leaf { front, back, transmittance }
    }

    fn cases() -> Vec<(String, Box<dyn Bsdf>)> {
        let case = |name: &str, leaf: Leaf| (name.to_owned(), Box::new(leaf) as Box<dyn Bsdf>);
        vec![
            case("leaf", leaf(GREEN, PALE, Spectrum([0.2, 0.4, 0.1]))),
            case("too much", leaf(GREEN, PALE, Spectrum::ONE)),
            case("black front", leaf(Spectrum::BLACK, PALE, GREEN)),
            case("opaque", leaf(GREEN, PALE, Spectrum::BLACK)),
            case("black", leaf(Spectrum::BLACK, Spectrum::BLACK, Spectrum::BLACK)),
        ]
    }

    bidir_proof::surface_tests!(cases());

    #[test]
    fn a_white_sheet_gives_everything_back() {
        let half = Spectrum::splat(0.5);
        for cos in [1.0, 0.3, -0.3] {
            let (albedo, _) = bidir_proof::surface::albedo(&leaf(half, half, half), bidir_proof::direction(cos, 0.2), 1_000);
            assert!((albedo - 1.0).abs() < 1e-6, "{albedo} at {cos}");
        }
    }

    #[test]
    fn the_same_light_passes_both_ways() {
        let sheet = leaf(GREEN, PALE, Spectrum([0.2, 0.9, 0.1]));
        let (above, below) = (bidir_proof::direction(0.6, 0.1), bidir_proof::direction(-0.6, 2.0));
        let (down, up) = (sheet.eval(above, below, Carried::Radiance), sheet.eval(below, above, Carried::Radiance));
        assert_eq!(down.value, up.value);
        assert!(down.value[1] > 0.0 && down.pdf.0 > 0.0 && down.pdf.0 != up.pdf.0, "{down:?} {up:?}");
    }
}
