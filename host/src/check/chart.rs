//! The sphere of directions laid out flat about one of them, so that lobes of any width can be told apart.

use bidir_kernel::{Frame, Real, Vec3};

/// Equal-area polar coordinates about a direction: x = (1 − cos θ)/2 and y, the azimuth in turns, both in 0 … 1.
/// A stretch of the unit square covers 4π times its area in steradians. In f64, and by the chord, so that the
/// surroundings of the centre keep all their digits.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chart {
    axes: [[f64; 3]; 3],
}

/// Steradians per unit of area.
pub(super) const STERADIANS: f64 = 4.0 * core::f64::consts::PI;

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn unit(w: Vec3) -> [f64; 3] {
    let w = w.to_array().map(f64::from);
    let length = dot(w, w).sqrt();
    w.map(|x| x / length)
}

impl Chart {
    pub(super) fn about(centre: Vec3) -> Self {
        let z = unit(centre);
        let frame = Frame::from_z(centre);
        // Made perpendicular in f64.
        let x = frame.x.to_array().map(f64::from);
        let along = dot(x, z);
        let x: [f64; 3] = core::array::from_fn(|i| x[i] - along * z[i]);
        let length = dot(x, x).sqrt();
        let x = x.map(|v| v / length);
        let y = [z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0]];
        Self { axes: [x, y, z] }
    }

    pub(super) fn place(&self, w: Vec3) -> [f64; 2] {
        let (w, [x, y, z]) = (unit(w), self.axes);
        let chord: [f64; 3] = core::array::from_fn(|i| w[i] - z[i]);
        let turns = dot(chord, y).atan2(dot(chord, x)) / core::f64::consts::TAU + 0.5;
        [(0.25 * dot(chord, chord)).clamp(0.0, 1.0), turns.clamp(0.0, 1.0)]
    }

    pub(super) fn direction(&self, [height, turns]: [f64; 2]) -> Vec3 {
        let [x, y, z] = self.axes;
        let (sin_phi, cos_phi) = (core::f64::consts::TAU * (turns - 0.5)).sin_cos();
        let (sin, cos) = (2.0 * (height * (1.0 - height)).max(0.0).sqrt(), 1.0 - 2.0 * height);
        let w: [f64; 3] = core::array::from_fn(|i| cos * z[i] + sin * (cos_phi * x[i] + sin_phi * y[i]));
        Vec3::from_array(w.map(|v| v as Real))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::dice::Dice;

    #[test]
    fn there_and_back_is_where_it_began() {
        let mut dice = Dice::new(3);
        for _ in 0..1000 {
            let chart = Chart::about(dice.direction());
            for scale in [1.0, 1e-3, 1e-8] {
                let place = [scale * dice.exact(), dice.exact()];
                let back = chart.place(chart.direction(place));
                // A direction is rounded by 6e-8 in each coordinate.
                let chord = 2.0 * place[0].sqrt();
                let off = (2.0 * back[0].sqrt() - chord).abs();
                assert!(off < 3e-7, "{place:?} came back as {back:?}");
            }
        }
    }
}
