//! The principled surface: what artists steer materials with.

use bidir_sdk::{
    Bsdf, Carried, Lobe, PerSolidAngle, Real, Scatter, Scattered, Spectrum, Vec3,
    math::{dot, lerp, ln, max, normalize, pow, safe_sqrt, sin_cos, sqr, sqrt, vec3},
    real::{INV_PI, PI},
    warp::{cosine_hemisphere, cosine_hemisphere_pdf},
};

use crate::{
    dielectric::refraction_factor,
    fresnel::{self, RelativeIndex},
    microfacet::{Distribution, Microfacet, reflect},
    rough_dielectric::{RoughDielectric, flipped},
    rough_plastic::sampled_from,
};

/// Burley's principled surface (2012, 2015) as Mitsuba 3 defines it: a diffuse base with retro-reflection, fake subsurface and sheen, a main
/// lobe of microfacets between dielectric and metal that may let light through, and a clear coat. All weights lie within 0 … 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Principled {
    /// Of everything but the coat and dielectric reflections.
    pub base_color: Spectrum,
    /// Square root of the main lobe's α.
    pub roughness: Real,
    /// How much longer the main lobe is across the tangent.
    pub anisotropic: Real,
    /// How much of it is a metal.
    pub metallic: Real,
    /// How much of what is no metal lets light through.
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
    /// Of a coat, four times as strong as it reflects.
    pub clearcoat: Real,
    /// From a dull coat to a shiny one.
    pub clearcoat_gloss: Real,
}

/// (1 − c)⁵ (Schlick 1994).
#[inline]
pub(crate) fn schlick_weight(cos: Real) -> Real {
    let m = (1.0 - cos).clamp(0.0, 1.0);
    sqr(sqr(m)) * m
}

/// Linear sRGB's luminance (Rec. 709).
#[inline]
pub(crate) fn luminance(color: Spectrum) -> Real {
    0.212_671 * color[0] + 0.715_16 * color[1] + 0.072_169 * color[2]
}

/// A colour of luminance 1; white for black.
#[inline]
pub(crate) fn tint(color: Spectrum) -> Spectrum {
    let luminance = luminance(color);
    if luminance > 0.0 { color * (1.0 / luminance) } else { Spectrum::ONE }
}

#[inline]
pub(crate) fn mix(a: Spectrum, b: Spectrum, part: Real) -> Spectrum {
    a * (1.0 - part) + b * part
}

/// Schlick's reflectance, seen from outside of a boundary with this index; by the refracted angle where light enters a thinner medium.
#[inline]
pub(crate) fn schlick(at_normal: Spectrum, cos: Real, eta: Real) -> Spectrum {
    let cos = if eta > 1.0 { cos } else { safe_sqrt(1.0 - (1.0 - sqr(cos)) / sqr(eta)) };
    mix(at_normal, Spectrum::ONE, schlick_weight(cos))
}

/// What a dielectric reflects along its normal.
#[inline]
pub(crate) fn reflectance_at_normal(eta: Real) -> Real {
    sqr((eta - 1.0) / (eta + 1.0))
}

/// GGX with α's of Burley's course notes.
#[inline]
pub(crate) fn slopes(roughness: Real, anisotropic: Real) -> Microfacet {
    let aspect = sqrt(1.0 - 0.9 * anisotropic);
    let alpha = sqr(roughness);
    Microfacet { distribution: Distribution::Ggx, alpha_u: max(alpha / aspect, 1e-3), alpha_v: max(alpha * aspect, 1e-3) }
}

/// Diffuse reflection with retro-reflection, bent towards a fake subsurface, without its colour: f cos θ_i.
#[inline]
pub(crate) fn diffuse(wo: Vec3, wi: Vec3, m: Vec3, roughness: Real, flatness: Real) -> Real {
    let (out, back) = (wo.z.abs(), wi.z.abs());
    let (fo, fi) = (schlick_weight(out), schlick_weight(back));
    let retro = 2.0 * roughness * sqr(dot(m, wi));
    let base = (1.0 - 0.5 * fo) * (1.0 - 0.5 * fi) + retro * (fo + fi + fo * fi * (retro - 1.0));
    // Hanrahan and Krueger's, as Burley flattens it.
    let grazing = 0.5 * retro;
    let subsurface = lerp(1.0, grazing, fo) * lerp(1.0, grazing, fi);
    let fake = 1.25 * (subsurface * (1.0 / (out + back) - 0.5) + 0.5);
    back * INV_PI * lerp(base, fake, flatness)
}

/// The sheen's f cos θ_i.
#[inline]
pub(crate) fn sheen(base: Spectrum, tinted: Real, wi: Vec3, m: Vec3) -> Spectrum {
    mix(Spectrum::ONE, tint(base), tinted) * (schlick_weight(dot(m, wi).abs()) * wi.z.abs())
}

/// The coat's slopes: a distribution with a longer tail than GGX (Burley 2012, "GTR1").
struct CoatSlopes {
    alpha2: Real,
}

impl CoatSlopes {
    #[inline]
    fn density(&self, m: Vec3) -> Real {
        let less = self.alpha2 - 1.0;
        less / (PI * ln(self.alpha2) * (1.0 + less * sqr(m.z)))
    }

    /// With density D cos.
    #[inline]
    fn sample(&self, u: [Real; 2]) -> Vec3 {
        let cos2 = (1.0 - pow(self.alpha2, 1.0 - u[1])) / (1.0 - self.alpha2);
        let sin = safe_sqrt(1.0 - cos2);
        let (sin_phi, cos_phi) = sin_cos(2.0 * PI * u[0]);
        vec3(sin * cos_phi, sin * sin_phi, safe_sqrt(cos2))
    }
}

/// How the lobes share the samples of one direction.
struct Shares {
    diffuse: Real,
    coat: Real,
    main: Real,
}

/// What one pair of directions is worth in the main lobe, from above.
#[derive(Default)]
struct Main {
    value: Spectrum,
    pdf: Real,
    pdf_rev: Real,
}

impl Principled {
    /// The index of refraction of a `specular` in 0 … 1: Burley's scale of the reflection along the normal, to 0.08.
    pub fn eta_of_specular(specular: Real) -> Real {
        2.0 / (1.0 - sqrt(0.08 * specular)) - 1.0
    }

    /// The part that is neither metal nor lets light through, and that which lets it through.
    #[inline]
    fn parts(&self) -> (Real, Real) {
        let dielectric = 1.0 - self.metallic;
        (dielectric * (1.0 - self.spec_trans), dielectric * self.spec_trans)
    }

    #[inline]
    fn shares(&self, above: bool) -> Shares {
        if !above {
            return Shares { diffuse: 0.0, coat: 0.0, main: 1.0 };
        }
        let (opaque, _) = self.parts();
        let (diffuse, coat) = (opaque, 0.25 * self.clearcoat);
        let scale = 1.0 / (1.0 + diffuse + coat);
        Shares { diffuse: diffuse * scale, coat: coat * scale, main: scale }
    }

    #[inline]
    fn slopes(&self) -> Microfacet {
        slopes(self.roughness, self.anisotropic)
    }

    #[inline]
    fn coat_slopes(&self) -> CoatSlopes {
        CoatSlopes { alpha2: sqr(lerp(0.1, 0.001, self.clearcoat_gloss)) }
    }

    /// The boundary's part of the main lobe.
    #[inline]
    fn boundary(&self) -> RoughDielectric {
        RoughDielectric {
            eta: self.eta,
            specular_reflectance: Spectrum::ONE,
            specular_transmittance: Spectrum::ONE,
            microfacet: self.slopes(),
        }
    }

    /// What the main lobe's microfacets reflect, where a dielectric reflects that much.
    #[inline]
    fn reflectance(&self, dielectric: Real, cos: Real, above: bool) -> Spectrum {
        if !above {
            return Spectrum::splat(self.parts().1 * dielectric);
        }
        let plain = 1.0 - self.metallic;
        let tinted = tint(self.base_color) * reflectance_at_normal(self.eta);
        Spectrum::splat(plain * (1.0 - self.spec_tint) * dielectric)
            + schlick(self.base_color, cos, self.eta) * self.metallic
            + schlick(tinted, cos, self.eta) * (plain * self.spec_tint)
    }

    /// `wo.z` and `wi.z` as seen from the side of ω_o, with `above` telling which that is.
    #[inline]
    fn main(&self, wo: Vec3, wi: Vec3, above: bool, carried: Carried) -> Main {
        let (_, through) = self.parts();
        let index = RelativeIndex::seen_from(self.eta, if above { 1.0 } else { -1.0 });
        let boundary = self.boundary();
        let Some(pair) = boundary.pair(wo, wi, index) else { return Main::default() };
        let facets = boundary.densities(wo, wi, index.eta, &pair);
        if wi.z > 0.0 {
            let reflected = if above { 1.0 - through * (1.0 - pair.reflectance) } else { pair.reflectance };
            let value = self.reflectance(pair.reflectance, pair.out.clamp(0.0, 1.0), above) * (facets.pdf_of_facet * facets.masked);
            return Main { value, pdf: reflected * facets.pdf_of_facet, pdf_rev: reflected * facets.rev_of_facet };
        }
        let passed = 1.0 - pair.reflectance;
        let power = passed * refraction_factor(index.eta, carried) * through;
        let (there, back) = if above { (through * passed, passed) } else { (passed, through * passed) };
        Main {
            value: self.base_color.map(safe_sqrt) * (power * facets.pdf_of_facet * facets.masked),
            pdf: there * facets.pdf_of_facet,
            pdf_rev: back * facets.rev_of_facet,
        }
    }

    /// The coat's f cos θ_i and densities; `cos` is that of half the angle between the two, whose dot products with m cancel near grazing.
    #[inline]
    fn coat(&self, wo: Vec3, wi: Vec3, m: Vec3, cos: Real) -> (Real, Real) {
        let density = self.coat_slopes().density(m);
        let masking = Microfacet { distribution: Distribution::Ggx, alpha_u: 0.25, alpha_v: 0.25 };
        let seen = masking.visibility(wo) * wo.z * masking.visibility(wi) * wi.z;
        let fresnel = schlick(Spectrum::splat(0.04), cos, self.eta)[0];
        (0.25 * self.clearcoat * fresnel * density * seen * wi.z, 0.25 * density * m.z / cos)
    }
}

impl Bsdf for Principled {
    fn eval(&self, wo: Vec3, wi: Vec3, carried: Carried) -> Scatter {
        let above = wo.z > 0.0;
        let (opaque, through) = self.parts();
        let somewhere = through > 0.0 || above && wi.z > 0.0;
        if wo.z == 0.0 || wi.z == 0.0 || !somewhere {
            return Scatter::NONE;
        }
        let (wo, wi) = if above { (wo, wi) } else { (flipped(wo), flipped(wi)) };
        let main = self.main(wo, wi, above, carried);
        let shares = self.shares(above);
        if !(above && wi.z > 0.0) {
            // Refracted light is made from the other side by the shares there.
            let rev = if wi.z > 0.0 { shares.main } else { self.shares(!above).main };
            return Scatter { value: main.value, pdf: PerSolidAngle(shares.main * main.pdf), pdf_rev: PerSolidAngle(rev * main.pdf_rev) };
        }
        let between = wo + wi;
        let Some(m) = normalize(between) else { return Scatter::NONE };
        let (mut value, mut pdf, mut pdf_rev) = (main.value, shares.main * main.pdf, shares.main * main.pdf_rev);
        if self.clearcoat > 0.0 {
            let (coat, density) = self.coat(wo, wi, m, 0.5 * sqrt(dot(between, between)));
            value += Spectrum::splat(coat);
            pdf += shares.coat * density;
            pdf_rev += shares.coat * density;
        }
        if opaque > 0.0 {
            value += self.base_color * (opaque * diffuse(wo, wi, m, self.roughness, self.flatness));
            if self.sheen > 0.0 {
                value += sheen(self.base_color, self.sheen_tint, wi, m) * (self.sheen * (1.0 - self.metallic));
            }
            pdf += shares.diffuse * cosine_hemisphere_pdf(wi.z);
            pdf_rev += shares.diffuse * cosine_hemisphere_pdf(wo.z);
        }
        Scatter { value, pdf: PerSolidAngle(pdf), pdf_rev: PerSolidAngle(pdf_rev) }
    }

    fn sample(&self, wo: Vec3, u: [Real; 3], carried: Carried) -> Option<Scattered> {
        let above = wo.z > 0.0;
        let (_, through) = self.parts();
        if wo.z == 0.0 || !(above || through > 0.0) {
            return None;
        }
        let seen = if above { wo } else { flipped(wo) };
        let shares = self.shares(above);
        let (uv, pick) = ([u[0], u[1]], u[2]);
        let (wi, lobe, eta) = if pick < shares.diffuse {
            (cosine_hemisphere(uv), Lobe::DIFFUSE_REFLECTION, 1.0)
        } else if pick < shares.diffuse + shares.coat {
            (reflect(seen, self.coat_slopes().sample(uv)), Lobe::GLOSSY_REFLECTION, 1.0)
        } else {
            let index = RelativeIndex::seen_from(self.eta, wo.z);
            let m = self.slopes().sample_visible(seen, uv)?;
            let out = dot(seen, m).clamp(0.0, 1.0);
            let boundary = fresnel::dielectric(out, index);
            let passed = 1.0 - boundary.reflectance;
            let reflected = if above { 1.0 - through * passed } else { boundary.reflectance };
            let again = (pick - shares.diffuse - shares.coat) / shares.main;
            if again < reflected {
                (reflect(seen, m), Lobe::GLOSSY_REFLECTION, 1.0)
            } else {
                if !(boundary.cos_refracted > 0.0) {
                    return None;
                }
                (m * (out / index.eta - boundary.cos_refracted) - seen / index.eta, Lobe::GLOSSY_TRANSMISSION, index.eta)
            }
        };
        let wi = normalize(wi)?;
        let wi = if above { wi } else { flipped(wi) };
        sampled_from(self, wo, wi, carried, lobe, eta)
    }

    fn lobes(&self) -> Lobe {
        let (opaque, through) = self.parts();
        let mut lobes = Lobe::GLOSSY_REFLECTION;
        if opaque > 0.0 {
            lobes |= Lobe::DIFFUSE_REFLECTION;
        }
        if through > 0.0 {
            lobes |= Lobe::GLOSSY_TRANSMISSION;
        }
        lobes
    }
}
