//! What shaders are asked: random directions and numbers, and corners.

use bidir_kernel_f64::sampler::{Independent, Sampler, Walk};

use crate::setting::rounded;

/// Random inputs per surface and per profile.
pub const SAMPLES: u64 = 1_500;

/// Numbers in [0, 1) of 24 bits, by place.
pub struct Numbers(pub u64);

impl Numbers {
    pub fn at(&self, place: u32) -> f64 {
        let mut numbers = Independent::new(7, 0, self.0);
        numbers.seek(Walk::Camera, place);
        numbers.next()
    }
}

/// The unit direction with this cosine and azimuth, as f32 holds it.
fn direction(cos: f64, phi: f64) -> [f64; 3] {
    let sin = ((1.0 - cos) * (1.0 + cos)).sqrt();
    [sin * phi.cos(), sin * phi.sin(), cos].map(rounded)
}

/// From the normal to grazing, on both sides.
const COSINES: [f64; 12] = [1.0, 0.999_999, 0.99, 0.6, 0.1, 1e-3, 1e-5, -1e-5, -1e-3, -0.3, -0.999, -1.0];

/// Any two directions, pairs near mirrored and refracted ones, and corners.
pub fn pairs() -> Vec<([f64; 3], [f64; 3])> {
    let mut pairs = Vec::new();
    for i in 0..SAMPLES {
        let n = Numbers(i);
        let wo = direction(2.0 * n.at(0) - 1.0, 6.3 * n.at(1));
        // So narrow lobes are met too.
        let near = 10f64.powf(-5.0 * n.at(2));
        let [x, y, z] = wo;
        let (dx, dy, eta) = (near * (n.at(3) - 0.5), near * (n.at(4) - 0.5), 0.5 + 2.0 * n.at(5));
        let wi = match i % 3 {
            0 => direction(2.0 * n.at(3) - 1.0, 6.3 * n.at(4)),
            1 => unit([dx - x, dy - y, z]),
            _ => refracted(wo, eta).map_or_else(|| unit([dx - x, dy - y, z]), |[x, y, z]| unit([x + dx, y + dy, z])),
        };
        pairs.push((wo, wi));
    }
    for a in COSINES {
        for b in COSINES {
            for phi in [0.3, 0.3 + std::f64::consts::PI, 2.0] {
                pairs.push((direction(a, 0.3), direction(b, phi)));
            }
        }
    }
    pairs
}

/// A question to `sample`.
pub struct Draw {
    pub wo: [f64; 3],
    pub u: [f64; 3],
    /// Whether one of the numbers lies at an end of its range.
    pub end: bool,
}

/// Any direction and grazing ones with any numbers, and with numbers at their ends.
pub fn draws() -> Vec<Draw> {
    let mut draws = Vec::new();
    for i in 0..SAMPLES {
        let n = Numbers(i);
        let cos = if i % 2 == 0 { 2.0 * n.at(0) - 1.0 } else { COSINES[i as usize / 2 % COSINES.len()] };
        draws.push(Draw { wo: direction(cos, 6.3 * n.at(1)), u: [n.at(2), n.at(3), n.at(4)], end: false });
    }
    let ends = [0.0, 1.0 / 16_777_216.0, 0.5, 0.75, 1.0 - 1.0 / 16_777_216.0];
    for cos in COSINES {
        for x in ends {
            for y in ends {
                draws.extend([0.0, 0.5, ends[4]].map(|z| Draw { wo: direction(cos, 0.3), u: [x, y, z], end: true }));
            }
        }
    }
    draws
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    v.map(|x| rounded(x / length))
}

fn refracted([x, y, z]: [f64; 3], eta: f64) -> Option<[f64; 3]> {
    let squared = 1.0 - (x * x + y * y) / (eta * eta);
    (squared > 0.0).then(|| [-x / eta, -y / eta, -z.signum() * squared.sqrt()])
}
