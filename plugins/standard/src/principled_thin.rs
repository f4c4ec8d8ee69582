//! The principled surface of thin things: leaves, paper, lampshades.

use bidir_sdk::{
    Bsdf, Carried, Lobe, PerSolidAngle, Real, Scatter, Scattered, Spectrum, Vec3,
    math::{dot, normalize},
    warp::{cosine_hemisphere, cosine_hemisphere_pdf},
};

use crate::{
    fresnel::{self, RelativeIndex},
    microfacet::{Microfacet, reflect},
    principled::{diffuse, mix, reflectance_at_normal, schlick, sheen, slopes, tint},
    rough_dielectric::flipped,
    rough_plastic::sampled_from,
};

/// Burley's thin surface (2015, §5.3) as Mitsuba 3 defines it: reflection and transmission of microfacets, the latter without bending, and
/// of a diffuse base, the same from both sides. Weights lie within 0 … 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrincipledThin {
    /// Of everything but dielectric reflections.
    pub base_color: Spectrum,
    /// Square root of the reflecting microfacets' α.
    pub roughness: Real,
    /// How much longer lobes are across the tangent.
    pub anisotropic: Real,
    /// From diffuse to specular.
    pub spec_trans: Real,
    /// Index of refraction inside / outside.
    pub eta: Real,
    /// How much of the dielectric's reflection has the base's tint.
    pub spec_tint: Real,
    /// Of a lobe at grazing, as cloth has it.
    pub sheen: Real,
    /// How much of it has the base's tint.
    pub sheen_tint: Real,
    /// From a diffuse base to a fake subsurface.
    pub flatness: Real,
    /// How much of the diffuse part goes through: 0 … 2 stands for none … all.
    pub diff_trans: Real,
}

/// Chances of the four lobes.
struct Shares {
    reflected: Real,
    passed: Real,
    diffuse: Real,
    diffuse_passed: Real,
}

impl PrincipledThin {
    #[inline]
    fn shares(&self) -> Shares {
        let (specular, diffuse, through) = (self.spec_trans, 1.0 - self.spec_trans, 0.5 * self.diff_trans);
        Shares { reflected: 0.5 * specular, passed: 0.5 * specular, diffuse: diffuse * (1.0 - through), diffuse_passed: diffuse * through }
    }

    /// Of what is reflected, and of what passes: two boundaries, scaled by the index (Burley 2015, figure 15).
    #[inline]
    fn slopes(&self, passed: bool) -> Microfacet {
        let scale = if passed { 0.65 * self.eta - 0.35 } else { 1.0 };
        slopes(scale * self.roughness, self.anisotropic)
    }
}

impl Bsdf for PrincipledThin {
    fn eval(&self, wo: Vec3, wi: Vec3, _: Carried) -> Scatter {
        if wo.z == 0.0 || wi.z == 0.0 {
            return Scatter::NONE;
        }
        let reflected = wo.z * wi.z > 0.0;
        let upper = |w: Vec3| if w.z > 0.0 { w } else { flipped(w) };
        // A thin surface has one side; the other is its mirror image.
        let (seen, lit) = (upper(wo), upper(wi));
        let Some(m) = normalize(seen + lit) else { return Scatter::NONE };
        let shares = self.shares();
        let slopes = self.slopes(!reflected);
        let cos = dot(seen, m).clamp(0.0, 1.0);
        let density = 0.25 * slopes.density(m);
        let (out, back) = (slopes.visibility(seen), slopes.visibility(lit));
        let dielectric = fresnel::dielectric(cos, RelativeIndex::seen_from(self.eta, 1.0)).reflectance;
        let specular = self.spec_trans * density * out * back * lit.z;
        let (specular_chance, diffuse_chance) =
            if reflected { (shares.reflected, shares.diffuse) } else { (shares.passed, shares.diffuse_passed) };
        let value = if reflected {
            let tinted = schlick(tint(self.base_color) * reflectance_at_normal(self.eta), cos, self.eta);
            let base = self.base_color * diffuse(seen, lit, m, self.roughness, self.flatness);
            mix(Spectrum::splat(dielectric), tinted, self.spec_tint) * specular
                + (base + sheen(self.base_color, self.sheen_tint, lit, m) * self.sheen) * shares.diffuse
        } else {
            self.base_color * ((1.0 - dielectric) * specular + shares.diffuse_passed * cosine_hemisphere_pdf(lit.z))
        };
        let pdf = |visibility: Real, cos: Real| specular_chance * density * visibility + diffuse_chance * cosine_hemisphere_pdf(cos);
        Scatter { value, pdf: PerSolidAngle(pdf(out, lit.z)), pdf_rev: PerSolidAngle(pdf(back, seen.z)) }
    }

    fn sample(&self, wo: Vec3, u: [Real; 3], carried: Carried) -> Option<Scattered> {
        if wo.z == 0.0 {
            return None;
        }
        let above = wo.z > 0.0;
        let seen = if above { wo } else { flipped(wo) };
        let shares = self.shares();
        let uv = [u[0], u[1]];
        let facet = |passed: bool| normalize(reflect(seen, self.slopes(passed).sample_visible(seen, uv)?));
        let up = |w: Vec3| (w.z > 0.0).then_some(w);
        let (wi, lobe) = if u[2] < shares.reflected {
            (up(facet(false)?)?, Lobe::GLOSSY_REFLECTION)
        } else if u[2] < shares.reflected + shares.passed {
            (flipped(up(facet(true)?)?), Lobe::GLOSSY_TRANSMISSION)
        } else if u[2] < shares.reflected + shares.passed + shares.diffuse || !(shares.diffuse_passed > 0.0) {
            (cosine_hemisphere(uv), Lobe::DIFFUSE_REFLECTION)
        } else {
            (flipped(cosine_hemisphere(uv)), Lobe::DIFFUSE_TRANSMISSION)
        };
        let wi = if above { wi } else { flipped(wi) };
        sampled_from(self, wo, wi, carried, lobe, 1.0)
    }

    fn lobes(&self) -> Lobe {
        let shares = self.shares();
        let lobes = [
            (shares.reflected, Lobe::GLOSSY_REFLECTION),
            (shares.passed, Lobe::GLOSSY_TRANSMISSION),
            (shares.diffuse, Lobe::DIFFUSE_REFLECTION),
            (shares.diffuse_passed, Lobe::DIFFUSE_TRANSMISSION),
        ];
        lobes.into_iter().filter(|(share, _)| *share > 0.0).fold(Lobe::NONE, |all, (_, lobe)| all | lobe)
    }
}
