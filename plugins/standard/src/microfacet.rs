//! Distributions of microfacets: their density, what of them is visible, and the sampling of the visible ones.

use bidir_sdk::{
    Real, Vec3,
    math::{dot, erfc, exp, ln, max, min, normalize, safe_sqrt, sin_cos, sqr, sqrt, vec3},
    real::{INV_PI, PI},
};

/// Distributions of slopes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Distribution {
    /// Trowbridge & Reitz 1975; Walter et al. 2007 call it GGX.
    Ggx,
    /// Gaussian slopes (Beckmann & Spizzichino 1963).
    Beckmann,
}

/// A rough surface as a height field of tiny mirrors.
///
/// The masking of microfacets is Smith's, each direction on its own: G = G1(ω_o) G1(ω_i).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Microfacet {
    /// Of the slopes.
    pub distribution: Distribution,
    /// Roughness along x: √2 times the standard deviation of the slope (for GGX: its like). 0 is smooth.
    pub alpha_u: Real,
    /// Roughness along y.
    pub alpha_v: Real,
}

/// √π.
const SQRT_PI: Real = 1.772_453_850_905_516;

impl Microfacet {
    /// The least roughness that is told from a smooth surface. Unit vectors in f32 turn by 6e-8 when rounded; a lobe
    /// a thousand times as wide still has its densities to 0.1 %, and no eye tells it from a mirror. The same in f64,
    /// so that both make the same decision.
    pub const LEAST: Real = 6e-5;

    /// With the roughness `alpha` along x and y, but for what of `alpha_u` and `alpha_v` is not negative.
    #[inline(always)]
    pub fn with_alphas(distribution: Distribution, alpha: Real, alpha_u: Real, alpha_v: Real) -> Self {
        let along = |own: Real| if own < 0.0 { alpha } else { own };
        Self { distribution, alpha_u: along(alpha_u), alpha_v: along(alpha_v) }
    }

    /// Whether the roughness is too little to be told from a smooth surface (0 and NaN included).
    #[inline(always)]
    pub fn is_smooth(&self) -> bool {
        !(self.alpha_u >= Self::LEAST || self.alpha_v >= Self::LEAST)
    }

    /// The larger roughness.
    #[inline(always)]
    pub fn largest_alpha(&self) -> Real {
        max(self.alpha_u, self.alpha_v)
    }

    #[inline(always)]
    fn alphas(&self) -> (Real, Real) {
        (max(self.alpha_u, Self::LEAST), max(self.alpha_v, Self::LEAST))
    }

    /// D(m), microfacet area per steradian of normals and unit of surface: ∫ D cos = 1. `m` is a unit vector; 0 below.
    #[inline]
    pub fn density(&self, m: Vec3) -> Real {
        if !(m.z > 0.0) {
            return 0.0;
        }
        let (u, v) = self.alphas();
        let across = sqr(m.x / u) + sqr(m.y / v);
        let cos2 = sqr(m.z);
        match self.distribution {
            Distribution::Ggx => INV_PI / (u * v * sqr(across + cos2)),
            Distribution::Beckmann => {
                let gauss = exp(-across / cos2);
                if gauss > 0.0 { gauss * INV_PI / (u * v * sqr(cos2)) } else { 0.0 }
            }
        }
    }

    /// G1(w)/|cos θ_w|: finite at grazing, where both factors vanish (Heitz 2014, eq. 72 and 66).
    #[inline]
    pub fn visibility(&self, w: Vec3) -> Real {
        let (u, v) = self.alphas();
        let z = w.z.abs();
        // tan θ · α · cos θ
        let t2 = sqr(u * w.x) + sqr(v * w.y);
        match self.distribution {
            Distribution::Ggx => 2.0 / (z + sqrt(sqr(z) + t2)),
            Distribution::Beckmann => {
                let t = sqrt(t2);
                if z > 6.0 * t {
                    return 1.0 / z;
                }
                let a = z / t;
                // 1/(z (1 + Λ)) with Λ = −erfc(a)/2 + exp(−a²)/(2 a √π).
                1.0 / (z * (1.0 - 0.5 * erfc(a)) + t * exp(-sqr(a)) / (2.0 * SQRT_PI))
            }
        }
    }

    /// Samples a unit microfacet normal that `w` (w.z > 0) sees: density G1(w) max(0, w·m) D(m)/cos θ_w per steradian.
    #[inline]
    pub fn sample_visible(&self, w: Vec3, u: [Real; 2]) -> Option<Vec3> {
        let (alpha_u, alpha_v) = self.alphas();
        let stretched = normalize(vec3(alpha_u * w.x, alpha_v * w.y, w.z))?;
        let m = match self.distribution {
            Distribution::Ggx => visible_hemisphere(stretched, u),
            Distribution::Beckmann => visible_gaussian(stretched, u),
        };
        normalize(vec3(alpha_u * m.x, alpha_v * m.y, m.z))
    }
}

/// The surface of a hemisphere as `w` sees it: the half vector of `w` and a uniform direction on a spherical cap
/// (Dupuy & Benyoub 2023, listing 3), written so that neither grazing nor normal `w` cancels. Of any length.
#[inline]
fn visible_hemisphere(w: Vec3, u: [Real; 2]) -> Vec3 {
    let up = (1.0 - u[1]) * (1.0 + w.z);
    // 1 + cos of the cap direction, with 1 − w.z from its sine.
    let above = up + (sqr(w.x) + sqr(w.y)) / (1.0 + w.z);
    let sine = safe_sqrt(above * (2.0 - above));
    let (sin, cos) = sin_cos(2.0 * PI * u[0]);
    vec3(sine * cos + w.x, sine * sin + w.y, up)
}

/// A Gaussian height field of slope variance ½ as `w` sees it: the slope across `w` stays Gaussian, the slope along it has
/// the density (cos θ − x sin θ)⁺ exp(−x²) (Heitz & d'Eon 2014). Of any length.
#[inline]
fn visible_gaussian(w: Vec3, u: [Real; 2]) -> Vec3 {
    let sin = sqrt(sqr(w.x) + sqr(w.y));
    let (cos_phi, sin_phi) = if sin > 0.0 { (w.x / sin, w.y / sin) } else { (1.0, 0.0) };
    let (along, across) = (visible_slope(w.z, sin, u[0]), gaussian(u[1]));
    vec3(sin_phi * across - cos_phi * along, -cos_phi * across - sin_phi * along, 1.0)
}

/// Slopes beyond this have a probability below 1e-16.
const STEEPEST: Real = 6.0;

/// Inverts ∫ (cos − x sin)⁺ exp(−x²) dx = cos √π/2 erfc(−x) + sin exp(−x²)/2 by Newton steps kept inside a bracket.
fn visible_slope(cos: Real, sin: Real, u: Real) -> Real {
    let cdf = |x: Real, gauss: Real| cos * (0.5 * SQRT_PI) * erfc(-x) + 0.5 * sin * gauss;
    let (least, most) = (-STEEPEST, if cos < STEEPEST * sin { cos / sin } else { STEEPEST });
    let (mut low, mut high) = (least, most);
    let target = u * cdf(high, exp(-sqr(high)));
    // Exact at grazing and at normal incidence.
    let mut x = min(max(cos * gaussian(u) - sin * sqrt(-ln(max(u, SMALLEST))), low), high);
    for _ in 0..24 {
        let gauss = exp(-sqr(x));
        let error = cdf(x, gauss) - target;
        if error > 0.0 {
            high = x;
        } else {
            low = x;
        }
        let step = x - error / ((cos - x * sin) * gauss);
        // Rounding leaves an error this small no sign, and a bracket made of it may have lost the root: no bisecting then.
        if (step - x).abs() < 1e-6 {
            return min(max(step, least), most);
        }
        x = if step > low && step < high { step } else { 0.5 * (low + high) };
    }
    x
}

/// Half the step of a 24-bit random number: what 0 stands for.
const SMALLEST: Real = 3e-8;

/// A Gaussian of variance ½: erf⁻¹(2u − 1) (Giles 2012, single precision).
fn gaussian(u: Real) -> Real {
    let u = max(u, SMALLEST);
    let w = -ln(4.0 * u * (1.0 - u));
    let near = [
        2.81022636e-08,
        3.43273939e-07,
        -3.5233877e-06,
        -4.39150654e-06,
        0.00021858087,
        -0.00125372503,
        -0.00417768164,
        0.246640727,
        1.50140941,
    ];
    let far = [
        -0.000200214257,
        0.000100950558,
        0.00134934322,
        -0.00367342844,
        0.00573950773,
        -0.0076224613,
        0.00943887047,
        1.00167406,
        2.83297682,
    ];
    let (coefficients, t): ([Real; 9], Real) = if w < 5.0 { (near, w - 2.5) } else { (far, sqrt(w) - 3.0) };
    coefficients.iter().fold(0.0, |sum, c| sum * t + c) * (2.0 * u - 1.0)
}

/// `w` mirrored about the unit vector `m`.
#[inline(always)]
pub(crate) fn reflect(w: Vec3, m: Vec3) -> Vec3 {
    m * (2.0 * dot(w, m)) - w
}
