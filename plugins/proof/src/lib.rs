//! What every shader must keep, as tests that a plugin takes with one line:
//!
//! ```ignore
//! bidir_proof::surface_tests!(cases()); // Vec<(String, Box<dyn Bsdf>)>
//! bidir_proof::light_tests!(cases()); // Vec<(String, Box<dyn Profile>)>
//! ```
//!
//! Only tests depend on this crate. Every check panics with the case, its inputs and what was found.

#[path = "../../standard/src/tests/chi_square.rs"]
mod chi_square;
pub mod light;
mod macros;
pub mod surface;

use bidir_sdk::{
    Real, Vec3,
    math::{safe_sqrt, sin_cos, vec3},
    real::{ONE_MINUS_EPSILON, PI},
    sampler::{Independent, Sampler},
};

/// The unit direction with this cosine to z and this azimuth in radians.
pub fn direction(cos: Real, phi: Real) -> Vec3 {
    let (sin_phi, cos_phi) = sin_cos(phi);
    let sin = safe_sqrt((1.0 - cos) * (1.0 + cos));
    vec3(sin * cos_phi, sin * sin_phi, cos)
}

/// Directions on both sides, from the normal to grazing.
fn directions() -> Vec<Vec3> {
    [1.0, 0.999, 0.8, 0.4, 0.1, 1e-3].iter().flat_map(|&cos| [direction(cos, 0.7), direction(-cos, 0.7)]).collect()
}

/// Directions at the normal, at grazing and closer to it than any image needs, on both sides; and of unit vectors that
/// rounding has made longer than 1, as every renderer has them.
fn edges() -> Vec<Vec3> {
    let cosines = [1.0, 0.5, 1e-3, 1e-7, 1e-12, 0.0, -0.0, -1e-12, -1e-7, -1e-3, -0.5, -1.0];
    let longer = [1.0, -1.0].map(|side| vec3(1.25e-4, -1.1e-5, side * (1.0 + 2.0 * Real::EPSILON)));
    cosines.iter().flat_map(|&cos| [direction(cos, 0.3), direction(cos, 0.3 + PI)]).chain(longer).collect()
}

/// The corners of the cube that samples are made from, and its middles.
fn corners() -> Vec<[Real; 3]> {
    let ends = [0.0, 0.5, ONE_MINUS_EPSILON];
    let pairs = ends.iter().flat_map(|&x| ends.iter().map(move |&y| (x, y)));
    pairs.flat_map(|(x, y)| ends.iter().map(move |&z| [x, y, z])).collect()
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
