//! How much of unpolarised light a smooth boundary reflects.

use bidir_sdk::{
    Real, Spectrum,
    math::{ln, max, min, safe_sqrt, sqr, sqrt},
};

/// What a boundary between two dielectrics does to one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Boundary {
    /// The share of power that is reflected, 0 … 1; the rest is refracted.
    pub reflectance: Real,
    /// |cos| of the refracted direction; 0 under total internal reflection.
    pub cos_refracted: Real,
}

/// The indices of two media, as seen from one of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RelativeIndex {
    /// η: index on the far side / index on the near side.
    pub eta: Real,
    /// η² − 1, kept since η near 1 has lost its digits: 1/η rounded is not the same boundary from its other side.
    pub excess: Real,
}

impl RelativeIndex {
    /// For a direction with this cosine, where `eta` is the index below the surface / above it.
    #[inline(always)]
    pub fn seen_from(eta: Real, cos: Real) -> Self {
        let excess = (eta - 1.0) * (eta + 1.0);
        if cos > 0.0 { Self { eta, excess } } else { Self { eta: 1.0 / eta, excess: -excess / sqr(eta) } }
    }
}

/// Fresnel's equations for a dielectric. `cos` ≥ 0 is that of the direction.
///
/// With g = η cos θ_t, c = cos θ and e = η² − 1 = g² − c² (Walter et al. 2007, eq. 22, in other words) the amplitudes are
/// r_s = −e/(c + g)² and r_p = e (c − 1/(c + g))/(η² c + g): no difference of nearly equal numbers anywhere,
/// so that they go to 0 with e, and to ±1 at the critical angle and at grazing.
#[inline]
pub fn dielectric(cos: Real, index: RelativeIndex) -> Boundary {
    if index.excess == 0.0 {
        return Boundary { reflectance: 0.0, cos_refracted: cos };
    }
    let squared = index.excess + sqr(cos);
    if !(squared > 0.0) {
        return Boundary { reflectance: 1.0, cos_refracted: 0.0 };
    }
    let g = sqrt(squared);
    Boundary { reflectance: amplitudes(cos, g, index), cos_refracted: min(g / index.eta, 1.0) }
}

/// The reflectance where both cosines, on the near side and on the far one, are known: it is the same from both sides
/// to the last digits, which a cosine near the critical angle alone would lose.
#[inline]
pub fn dielectric_between(cos: Real, cos_refracted: Real, index: RelativeIndex) -> Real {
    amplitudes(cos, index.eta * cos_refracted, index)
}

#[inline(always)]
fn amplitudes(cos: Real, g: Real, index: RelativeIndex) -> Real {
    let inverse = 1.0 / (cos + g);
    let s = index.excess * sqr(inverse);
    let p = index.excess * (cos - inverse) / (sqr(index.eta) * cos + g);
    min(0.5 * (sqr(s) + sqr(p)), 1.0)
}

/// The chance with which shaders pick reflection over refraction: the reflectance, unless one of the two is black.
/// It is the same from both ends of a refracted pair, and of a reflected one.
#[inline]
pub(crate) fn reflection_chance(reflectance: Real, reflected: Spectrum, refracted: Spectrum) -> Real {
    if reflected.is_black() {
        0.0
    } else if refracted.is_black() {
        1.0
    } else {
        reflectance
    }
}

/// Fresnel's equations for a conductor in vacuum, per band: `cos` ≥ 0, index of refraction `eta` + i·`k`.
/// (0, 1) reflects everything.
#[inline]
pub fn conductor(cos: Real, eta: Spectrum, k: Spectrum) -> Spectrum {
    Spectrum(core::array::from_fn(|band| conductor_band(cos, eta[band], k[band])))
}

/// Born & Wolf, 14.2, with a² and b² of (a + ib)² = (η + ik)² − sin² θ.
#[inline]
fn conductor_band(cos: Real, eta: Real, k: Real) -> Real {
    let cos2 = sqr(cos);
    let sin2 = max(1.0 - cos2, 0.0);
    let real = (eta - k) * (eta + k) - sin2;
    let a2_plus_b2 = sqrt(sqr(real) + 4.0 * sqr(eta * k));
    let twice_a_cos = 2.0 * cos * safe_sqrt(0.5 * (a2_plus_b2 + real));
    let s = ratio(a2_plus_b2 + cos2, twice_a_cos);
    let p = s * ratio(a2_plus_b2 * cos2 + sqr(sin2), twice_a_cos * sin2);
    0.5 * (s + p)
}

/// (x − y)/(x + y); 1 for 0/0.
#[inline(always)]
fn ratio(x: Real, y: Real) -> Real {
    if x + y > 0.0 { max((x - y) / (x + y), 0.0) } else { 1.0 }
}

/// 2 ∫ R(c) c dc: the reflectance of a dielectric boundary under light from everywhere on one side,
/// `eta` is the index on the far side / the index on that side. Exact (Duntley 1942; d'Eon 2021, "An Analytic BRDF for Materials with Spherical Lambertian
/// Scatterers", appendix), except within 1 % of 1, where the exact form cancels and its expansion takes over (5e-6).
pub fn diffuse(eta: Real) -> Real {
    if eta < 1.0 {
        // The same boundary from its other side: what enters equals what leaves (étendue grows with η²).
        let n = 1.0 / eta;
        return ((n - 1.0) * (n + 1.0) + diffuse(n)) / sqr(n);
    }
    let n = eta;
    let e = n - 1.0;
    if e == 0.0 {
        return 0.0;
    }
    if e < 0.01 {
        return e / 3.0 + sqr(e) * (0.387 + 0.5 * ln(e));
    }
    let n2 = sqr(n);
    let (below, above) = ((n - 1.0) * (n + 1.0), n2 + 1.0);
    let n4_minus_1 = below * above;
    0.5 + e * (3.0 * n + 1.0) / (6.0 * sqr(n + 1.0)) + n2 * sqr(below) / (above * sqr(above)) * ln(e / (n + 1.0))
        - 2.0 * n2 * n * (n2 + 2.0 * n - 1.0) / (above * n4_minus_1)
        + 8.0 * sqr(n2) * (sqr(n2) + 1.0) / (above * sqr(n4_minus_1)) * ln(n)
}
