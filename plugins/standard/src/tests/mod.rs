//! What holds for every shader.

mod bent;
mod chi_square;
mod limits;
mod profiles;
mod reflectance;
mod scattering;
mod surfaces;

use std::vec::Vec;

use bidir_sdk::{
    Real, Vec3,
    math::{safe_sqrt, sin_cos, vec3},
    sampler::{Independent, Sampler},
};

/// π.
const HALF_TURN: Real = bidir_sdk::real::PI;

/// The unit direction with this cosine and azimuth.
fn direction(cos: Real, phi: Real) -> Vec3 {
    let (sin_phi, cos_phi) = sin_cos(phi);
    let sin = safe_sqrt((1.0 - cos) * (1.0 + cos));
    vec3(sin * cos_phi, sin * sin_phi, cos)
}

/// Directions on both sides, from the normal to grazing.
fn directions() -> Vec<Vec3> {
    [1.0, 0.999, 0.8, 0.4, 0.1, 1e-3].iter().flat_map(|&cos| [direction(cos, 0.7), direction(-cos, 0.7)]).collect()
}

/// Three independent numbers in [0, 1).
fn numbers(seed: u64, index: u64) -> [Real; 3] {
    let mut sampler = Independent::new(seed, 0, index);
    [sampler.next(), sampler.next(), sampler.next()]
}

/// Whether two numbers agree to `tolerance`, relative to the larger.
fn close(a: Real, b: Real, tolerance: Real) -> bool {
    (a - b).abs() <= tolerance * a.abs().max(b.abs()) + 1e-12
}
