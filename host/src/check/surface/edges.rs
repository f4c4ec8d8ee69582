//! Questions from where arithmetic ends. The answers are judged where they are taken in.

use bidir_kernel::{Bsdf, Carried, Real, Vec3, real::ONE_MINUS_EPSILON};

use crate::check::ledger::Ledger;

const COSINES: [f64; 12] = [1.0, 0.5, 1e-3, 1e-7, 1e-12, 0.0, -0.0, -1e-12, -1e-7, -1e-3, -0.5, -1.0];

/// At the normal, at grazing and closer to it than any image needs, on both sides; and unit vectors that rounding has made
/// longer than 1, as every renderer has them.
pub(in crate::check) fn directions() -> Vec<Vec3> {
    let direction = |cos: f64, phi: f64| {
        let sin = ((1.0 - cos) * (1.0 + cos)).sqrt();
        Vec3::new((sin * phi.cos()) as Real, (sin * phi.sin()) as Real, cos as Real)
    };
    let longer = [1.0, -1.0].map(|side: Real| Vec3::new(1.25e-4, -1.1e-5, side * (1.0 + 2.0 * Real::EPSILON)));
    let turned = |cos| [direction(cos, 0.3), direction(cos, 0.3 + std::f64::consts::PI)];
    COSINES.into_iter().flat_map(turned).chain(longer).collect()
}

/// The corners of the cube that samples are made from, and its middles.
pub(in crate::check) fn corners() -> Vec<[Real; 3]> {
    let ends = [0.0, 0.5, ONE_MINUS_EPSILON];
    let pairs = ends.into_iter().flat_map(|x| ends.map(|y| (x, y)));
    pairs.flat_map(|(x, y)| ends.map(|z| [x, y, z])).collect()
}

pub(super) fn ask(bsdf: &dyn Bsdf, ledger: &mut Ledger) {
    let (directions, corners) = (directions(), corners());
    for wo in &directions {
        for carried in [Carried::Radiance, Carried::Importance] {
            for u in &corners {
                if let Some(sample) = bsdf.sample(*wo, *u, carried) {
                    ledger.observe(sample.lobe);
                }
            }
            for wi in directions.iter().copied().chain([*wo, -*wo]) {
                bsdf.eval(*wo, wi, carried);
            }
        }
    }
}
