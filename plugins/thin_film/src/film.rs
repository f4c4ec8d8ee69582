//! Interference in a thin film on metal, in colour: Belcour & Barla 2017, "A Practical Extension to Microfacet Theory for
//! the Modeling of Varying Iridescence", written for a metal whose index is known per band.
//!
//! Light of wavenumber κ that is reflected below the film lags by δ = 4π κ n d cos θ_film. With r the amplitude that the
//! film's upper side reflects, ρ that of the metal (complex), z = −r ρ and A = (1 − r²)(1 − |ρ|²)/(1 − |z|²), Airy's sum is
//!
//! ```text
//! |(r + ρ e^{iδ})/(1 + r ρ e^{iδ})|² = 1 − A (1 + 2 Σ_{m ≥ 1} Re (z e^{iδ})^m)
//! ```
//!
//! so that a spectral average is the average of e^{imδ}, the Fourier transform of the eye's sensitivity. That is a sum of
//! Gaussians; thick films go grey by themselves instead of aliasing.

use bidir_sdk::{
    Real, Spectrum,
    math::{exp, safe_sqrt, sin_cos, sqr, sqrt},
    real::PI,
};

/// Terms of the sum. What is left out is below 1 % where the film reflects less than half at its upper side.
const TERMS: usize = 6;

/// A complex number.
#[derive(Clone, Copy, Debug)]
struct Complex(Real, Real);

impl Complex {
    fn times(self, other: Self) -> Self {
        Self(self.0 * other.0 - self.1 * other.1, self.0 * other.1 + self.1 * other.0)
    }

    fn squared_length(self) -> Real {
        sqr(self.0) + sqr(self.1)
    }

    /// self / other; −1, what grazing light meets, for 0/0.
    fn over(self, other: Self) -> Self {
        let squared = other.squared_length();
        if squared > 0.0 {
            let product = self.times(Self(other.0, -other.1));
            Self(product.0 / squared, product.1 / squared)
        } else {
            Self(-1.0, 0.0)
        }
    }

    /// √ in the upper right quarter, of a number in the upper half.
    fn root(self) -> Self {
        let length = sqrt(self.squared_length());
        Self(safe_sqrt(0.5 * (length + self.0)), safe_sqrt(0.5 * (length - self.0)))
    }
}

/// A film on metal, in air.
#[derive(Clone, Copy, Debug)]
pub struct Film {
    /// In nanometres.
    pub thickness: Real,
    /// Index of refraction of the film, at least 1.
    pub index: Real,
    /// Real part of the metal's index, per band.
    pub eta: Spectrum,
    /// Its imaginary part.
    pub k: Spectrum,
}

impl Film {
    /// The reflectance for unpolarised light, `cos` ≥ 0 that of the direction; within 0 … 1.
    pub fn reflectance(&self, cos: Real) -> Spectrum {
        let cos_film = safe_sqrt(1.0 - (1.0 - sqr(cos)) / sqr(self.index));
        let lags = lags(2.0 * self.index * self.thickness * 1e-9 * cos_film);
        let upper = [
            ratio(cos - self.index * cos_film, cos + self.index * cos_film),
            ratio(self.index * cos - cos_film, self.index * cos + cos_film),
        ];
        Spectrum(core::array::from_fn(|band| {
            let lower = self.lower(band, cos, cos_film);
            let both: Real = (0..2).map(|polarisation| airy(upper[polarisation], lower[polarisation], &lags[band])).sum();
            (0.5 * both).clamp(0.0, 1.0)
        }))
    }

    /// Amplitudes that the metal reflects of light in the film: perpendicular to the plane of incidence, and in it.
    fn lower(&self, band: usize, cos: Real, cos_film: Real) -> [Complex; 2] {
        let (eta, k) = (self.eta[band], self.k[band]);
        let squared = Complex((eta - k) * (eta + k), 2.0 * eta * k);
        // N cos θ in the metal, with Snell's law in terms of the angle outside.
        let Complex(a, b) = Complex(squared.0 - (1.0 - sqr(cos)), squared.1).root();
        let near = self.index * cos_film;
        let (p, q) = (Complex(squared.0 * cos_film, squared.1 * cos_film), Complex(self.index * a, self.index * b));
        [Complex(near - a, -b).over(Complex(near + a, b)), Complex(p.0 - q.0, p.1 - q.1).over(Complex(p.0 + q.0, p.1 + q.1))]
    }
}

/// x/y; −1 for 0/0.
fn ratio(x: Real, y: Real) -> Real {
    if y > 0.0 { x / y } else { -1.0 }
}

/// One band's averages of e^{imδ}, m from 1.
type Lags = [Complex; TERMS];

fn airy(r: Real, rho: Complex, lags: &Lags) -> Real {
    let z = Complex(-r * rho.0, -r * rho.1);
    let left = (1.0 - sqr(r)) * (1.0 - rho.squared_length());
    // 0 for a film that lets nothing in, and for a metal that takes nothing.
    if !(left > 0.0) {
        return 1.0;
    }
    let mut power = Complex(1.0, 0.0);
    let mut sum = 0.0;
    for &lag in lags {
        power = power.times(z);
        sum += power.0 * lag.0 - power.1 * lag.1;
    }
    1.0 - left / (1.0 - z.squared_length()) * (1.0 + 2.0 * sum)
}

/// A part of the eye's sensitivity: `share` of the integral, about a wavenumber (1/m), half the variance of it (1/m²).
struct Sensitivity {
    share: Real,
    center: Real,
    half_variance: Real,
}

/// Belcour & Barla's fit of CIE 1931: both lobes of X, then Y and Z.
const EYE: [Sensitivity; 4] = [
    Sensitivity { share: 0.846_2, center: 1.6810e6, half_variance: 4.3278e9 },
    Sensitivity { share: 0.153_8, center: 2.2399e6, half_variance: 4.5282e9 },
    Sensitivity { share: 1.0, center: 1.7953e6, half_variance: 9.3046e9 },
    Sensitivity { share: 1.0, center: 2.2084e6, half_variance: 6.6121e9 },
];

/// X, Y, Z → linear sRGB, each row divided by its sum: what reflects all wavelengths alike is grey.
const RGB_FROM_XYZ: [[Real; 3]; 3] =
    [[2.689_655, -1.275_862, -0.413_793], [-1.022_108, 1.978_287, 0.043_822], [0.061_224, -0.224_490, 1.163_265]];

/// Averages of e^{imδ} over each band, for a path of this length (m).
fn lags(path: Real) -> [Lags; 3] {
    let mut bands = [[Complex(0.0, 0.0); TERMS]; 3];
    for (part, eye) in EYE.iter().enumerate() {
        for (m, wave) in waves(eye, 2.0 * PI * path).into_iter().enumerate() {
            for (band, row) in RGB_FROM_XYZ.iter().enumerate() {
                let share = row[part.saturating_sub(1)] * eye.share;
                bands[band][m].0 += share * wave.0;
                bands[band][m].1 += share * wave.1;
            }
        }
    }
    bands
}

/// Averages of e^{imδ} over one part of the sensitivity: exp(−m² v φ²) e^{imκφ}.
fn waves(eye: &Sensitivity, phase: Real) -> Lags {
    let (sin, cos) = sin_cos(eye.center * phase);
    let turn = Complex(cos, sin);
    let first = exp(-eye.half_variance * sqr(phase));
    // From m² to (m + 1)² by a factor that itself falls.
    let (mut turned, mut damping, mut factor) = (turn, first, first * sqr(first));
    core::array::from_fn(|_| {
        let wave = Complex(damping * turned.0, damping * turned.1);
        turned = turned.times(turn);
        damping *= factor;
        factor *= sqr(first);
        wave
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const CHROMIUM: (Spectrum, Spectrum) = (Spectrum([4.3697, 2.9165, 1.6549]), Spectrum([5.2066, 4.2313, 3.7547]));
    const SILVER: (Spectrum, Spectrum) = (Spectrum([0.155, 0.117, 0.138]), Spectrum([4.828, 3.122, 2.147]));

    fn film(thickness: Real, index: Real, (eta, k): (Spectrum, Spectrum)) -> Film {
        Film { thickness, index, eta, k }
    }

    /// What is compared, and how far it may differ.
    fn near(a: Spectrum, b: [f64; 3], tolerance: f64) -> bool {
        (0..3).all(|band| (f64::from(a[band]) - b[band]).abs() < tolerance)
    }

    type C = (f64, f64);
    fn mul(a: C, b: C) -> C {
        (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
    }
    fn div(a: C, b: C) -> C {
        let s = b.0 * b.0 + b.1 * b.1;
        ((a.0 * b.0 + a.1 * b.1) / s, (a.1 * b.0 - a.0 * b.1) / s)
    }
    fn root(a: C) -> C {
        let length = a.0.hypot(a.1).sqrt();
        let angle = 0.5 * a.1.atan2(a.0);
        (length * angle.cos(), length * angle.sin())
    }

    /// Airy's sum at one wavenumber, as a textbook has it.
    fn airy_at(wavenumber: f64, cos: f64, film: &Film, band: usize) -> f64 {
        let (n, metal) = ((f64::from(film.index), 0.0), (f64::from(film.eta[band]), f64::from(film.k[band])));
        let sin2 = 1.0 - cos * cos;
        let inside = |index: C| {
            let ratio = div((sin2, 0.0), mul(index, index));
            root((1.0 - ratio.0, -ratio.1))
        };
        let (cos_film, cos_metal) = (inside(n), inside(metal));
        let phase = 4.0 * core::f64::consts::PI * wavenumber * f64::from(film.thickness) * 1e-9 * n.0 * cos_film.0;
        let turn = (phase.cos(), phase.sin());
        let fraction = |a: C, b: C| div((a.0 - b.0, a.1 - b.1), (a.0 + b.0, a.1 + b.1));
        let whole = |upper: C, lower: C| {
            let lower = mul(lower, turn);
            let both = mul(upper, lower);
            let r = div((upper.0 + lower.0, upper.1 + lower.1), (1.0 + both.0, both.1));
            r.0 * r.0 + r.1 * r.1
        };
        let air = (cos, 0.0);
        let s = whole(fraction(air, mul(n, cos_film)), fraction(mul(n, cos_film), mul(metal, cos_metal)));
        let p = whole(fraction(mul(n, air), cos_film), fraction(mul(metal, cos_film), mul(n, cos_metal)));
        0.5 * (s + p)
    }

    /// The definition: Airy's sum under the eye's sensitivity, by quadrature over wavenumbers.
    fn definition(cos: f64, film: &Film) -> [f64; 3] {
        [0, 1, 2].map(|band| {
            let part = |index: usize| {
                let eye = &EYE[index];
                let deviation = f64::from(2.0 * eye.half_variance).sqrt();
                let steps = 4_000;
                let (mut sum, mut norm) = (0.0, 0.0);
                for i in 0..steps {
                    let x = 12.0 * (f64::from(i) + 0.5) / f64::from(steps) - 6.0;
                    let weight = (-0.5 * x * x).exp();
                    sum += weight * airy_at(f64::from(eye.center) + x * deviation, cos, film, band);
                    norm += weight;
                }
                f64::from(RGB_FROM_XYZ[band][index.saturating_sub(1)] * eye.share) * sum / norm
            };
            (0..4).map(part).sum::<f64>().clamp(0.0, 1.0)
        })
    }

    #[test]
    fn colours_are_those_of_airys_sum_over_the_spectrum() {
        for metal in [CHROMIUM, SILVER] {
            for (thickness, index) in [(100.0, 1.5), (250.0, 1.33), (400.0, 2.0), (700.0, 1.5), (2000.0, 1.8)] {
                for cos in [1.0, 0.7, 0.4, 0.2] {
                    let film = film(thickness, index, metal);
                    let (ours, exact) = (film.reflectance(cos), definition(f64::from(cos), &film));
                    assert!(near(ours, exact, 0.012), "{thickness} nm of index {index} at {cos}: {ours:?} against {exact:?}");
                }
            }
        }
    }

    #[test]
    fn a_film_of_index_1_or_of_no_thickness_is_none() {
        for cos in [1.0, 0.6, 0.25] {
            let bare = bidir_standard::fresnel::conductor(cos, CHROMIUM.0, CHROMIUM.1);
            let bands = [0, 1, 2].map(|band| f64::from(bare[band]));
            assert!(near(film(300.0, 1.0, CHROMIUM).reflectance(cos), bands, 1e-4));
            assert!(near(film(0.0, 1.5, CHROMIUM).reflectance(cos), bands, 5e-3));
        }
    }

    #[test]
    fn a_metal_that_takes_nothing_stays_white() {
        for cos in [1.0, 0.5, 0.0] {
            assert_eq!(film(400.0, 1.5, (Spectrum::BLACK, Spectrum::ONE)).reflectance(cos), Spectrum::ONE);
        }
    }

    #[test]
    fn thick_films_lose_their_colours() {
        let spread = |thickness| {
            let Spectrum([r, g, b]) = film(thickness, 1.5, (Spectrum::splat(3.0), Spectrum::splat(3.0))).reflectance(1.0);
            r.max(g).max(b) - r.min(g).min(b)
        };
        assert!(spread(20_000.0) < 1e-3 && spread(400.0) > 0.05, "{} {}", spread(20_000.0), spread(400.0));
    }
}
