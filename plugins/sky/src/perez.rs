//! The colour of a clear sky: Preetham, Shirley & Smits 1999, "A Practical Analytic Model for Daylight", and the light of
//! the sun through that air.

use bidir_sdk::{
    Real, Spectrum,
    math::{asin, cos, exp, pow, sqr, sqrt, tan},
    real::PI,
};

/// Perez' five coefficients of luminance and of both chromaticities, for one turbidity and one sun.
#[derive(Clone, Copy, Debug)]
pub struct Perez {
    coefficients: [[Real; 5]; 3],
    /// Y (kcd/m²), x and y at the zenith, over what the formula says for the sun's place.
    scale: [Real; 3],
}

/// Each coefficient is slope · turbidity + offset (appendix A.2); rows Y, x, y.
const DISTRIBUTION: [[(Real, Real); 5]; 3] = [
    [(0.1787, -1.4630), (-0.3554, 0.4275), (-0.0227, 5.3251), (0.1206, -2.5771), (-0.0670, 0.3703)],
    [(-0.0193, -0.2592), (-0.0665, 0.0008), (-0.0004, 0.2125), (-0.0641, -0.8989), (-0.0033, 0.0452)],
    [(-0.0167, -0.2608), (-0.0950, 0.0092), (-0.0079, 0.2102), (-0.0441, -1.6537), (-0.0109, 0.0529)],
];

/// Chromaticity at the zenith: rows by powers 2, 1, 0 of the turbidity, columns by powers 3 … 0 of the sun's angle.
const ZENITH: [[[Real; 4]; 3]; 2] = [
    [[0.00166, -0.00375, 0.00209, 0.0], [-0.02903, 0.06377, -0.03202, 0.00394], [0.11693, -0.21196, 0.06052, 0.25886]],
    [[0.00275, -0.00610, 0.00317, 0.0], [-0.04214, 0.08970, -0.04153, 0.00516], [0.15346, -0.26756, 0.06670, 0.26688]],
];

impl Perez {
    /// `sun` is its angle to the zenith in radians, up to π/2.
    pub fn new(turbidity: Real, sun: Real) -> Self {
        let coefficients = DISTRIBUTION.map(|row| row.map(|(slope, offset)| slope * turbidity + offset));
        let chi = (4.0 / 9.0 - turbidity / 120.0) * (PI - 2.0 * sun);
        let luminance = (4.0453 * turbidity - 4.9710) * tan(chi) - 0.2155 * turbidity + 2.4192;
        let cubic = |row: &[Real; 4]| ((row[0] * sun + row[1]) * sun + row[2]) * sun + row[3];
        let chromaticity = |rows: &[[Real; 4]; 3]| (cubic(&rows[0]) * turbidity + cubic(&rows[1])) * turbidity + cubic(&rows[2]);
        let zenith = [luminance, chromaticity(&ZENITH[0]), chromaticity(&ZENITH[1])];
        let scale = core::array::from_fn(|i| zenith[i] / distribution(&coefficients[i], 1.0, sun, cos(sun)));
        Self { coefficients, scale }
    }

    /// Radiance, in kcd/m² of luminance, from a place with cosine `cos` > 0 to the zenith, and `h` = 1 − cosine to the sun.
    pub fn radiance(&self, cos: Real, h: Real) -> Spectrum {
        let cos_gamma = 1.0 - h;
        let gamma = 2.0 * asin(sqrt(0.5 * h).min(1.0));
        let [luminance, x, y] = core::array::from_fn(|i| self.scale[i] * distribution(&self.coefficients[i], cos, gamma, cos_gamma));
        rgb(luminance, x, y)
    }
}

/// (1 + A e^{B/cos θ}) (1 + C e^{Dγ} + E cos² γ), eq. 3.
fn distribution([a, b, c, d, e]: &[Real; 5], cos: Real, gamma: Real, cos_gamma: Real) -> Real {
    (1.0 + a * exp(b / cos)) * (1.0 + c * exp(d * gamma) + e * sqr(cos_gamma))
}

/// CIE xyY → linear sRGB; what lies outside the gamut is cut off.
fn rgb(luminance: Real, x: Real, y: Real) -> Spectrum {
    let (big_x, big_z) = (luminance * x / y, luminance * (1.0 - x - y) / y);
    Spectrum([
        3.240_454 * big_x - 1.537_139 * luminance - 0.498_531 * big_z,
        -0.969_266 * big_x + 1.876_011 * luminance + 0.041_556 * big_z,
        0.055_643 * big_x - 0.204_026 * luminance + 1.057_225 * big_z,
    ])
    .map(|band| band.max(0.0))
}

/// Illuminance of the sun above the air, klx.
const SOLAR: Real = 128.0;

/// What of the sun's light arrives perpendicular to it, in klx: Rayleigh scattering and aerosols (appendix A.1; ozone, gas
/// and vapour, which take a few per cent, are left out). `sun` is its angle to the zenith.
pub fn sunlight(turbidity: Real, sun: Real) -> Spectrum {
    let mass = 1.0 / (cos(sun).max(0.0) + 0.15 * pow(93.885 - sun * (180.0 / PI), -1.253));
    let haze = (0.046_08 * turbidity - 0.045_86).max(0.0);
    Spectrum(core::array::from_fn(|band| SOLAR * exp(-mass * (RAYLEIGH[band] + haze * AEROSOL[band]))))
}

/// 0.008735 λ^−4.08 at 0.61, 0.55 and 0.465 µm.
const RAYLEIGH: [Real; 3] = [0.065632, 0.100134, 0.198635];
/// λ^−1.3 there.
const AEROSOL: [Real; 3] = [1.90139, 2.17535, 2.7059];
