//! The density over all directions, and beside it the histogram of samples, on two discs of equal area.

use bidir_kernel::Vec3;

use super::{png, polar::Scale};
use crate::check::{
    bridge::{Scatterer, learn},
    dice::Dice,
    partition::Partition,
};

/// Pixels along a disc.
const SIDE: usize = 64;

/// A pixel has the density of so many places along each of its sides.
const FINE: usize = 4;

/// Where the density is more than this many times the uniform one, random places are taken rather than those.
const NARROW: f64 = 60.0;

const STERADIANS: f64 = 4.0 * std::f64::consts::PI;

/// Densities per steradian, of the upper disc's pixels and then the lower one's.
#[derive(Clone, Debug)]
pub(super) struct Map {
    pub(super) claimed: Vec<f64>,
    pub(super) sampled: Vec<f64>,
}

/// Lambert's projection: each half of the sphere on a disc, the normal in the middle, seen from above. NaN falls anywhere.
fn pixel(w: Vec3) -> usize {
    let [x, y, z] = w.to_array().map(f64::from);
    // (1 − |z|)/sin², without cancellation.
    let stretch = (1.0 / (1.0 + z.abs())).sqrt();
    let place = |c: f64| ((0.5 + 0.5 * c * stretch) * SIDE as f64).clamp(0.0, (SIDE - 1) as f64) as usize;
    let half = if z < 0.0 { SIDE * SIDE } else { 0 };
    half + (SIDE - 1 - place(y)) * SIDE + place(x)
}

/// The direction at a place of a disc, if it lies on it.
fn direction(x: f64, y: f64, up: bool) -> Option<Vec3> {
    let r = x * x + y * y;
    let stretch = (2.0 - r).max(0.0).sqrt();
    let z = if up { 1.0 - r } else { r - 1.0 };
    (r < 1.0).then(|| Vec3::new((x * stretch) as f32, (y * stretch) as f32, z as f32))
}

/// The places of a pixel, `fine` along each of its sides.
fn places(pixel: usize, fine: usize) -> impl Iterator<Item = (f64, f64, bool)> {
    let (up, at) = (pixel < SIDE * SIDE, pixel % (SIDE * SIDE));
    let (row, column) = ((at / SIDE) as f64, (at % SIDE) as f64);
    let coordinate = move |whole: f64, part: usize| 2.0 * (whole + (part as f64 + 0.5) / fine as f64) / SIDE as f64 - 1.0;
    (0..fine * fine).map(move |part| (coordinate(column, part % fine), -coordinate(row, part / fine), up))
}

/// Steradians of each pixel.
fn extents() -> Vec<f64> {
    let whole = 2.0 * (2.0 / SIDE as f64).powi(2);
    let covered = |pixel| places(pixel, 8).filter(|(x, y, up)| direction(*x, *y, *up).is_some()).count() as f64 / 64.0;
    (0..2 * SIDE * SIDE).map(|pixel| whole * covered(pixel)).collect()
}

impl Map {
    /// Asks `said` for densities, and `drawn` for samples: what breaks one leaves the other.
    pub(super) fn of(said: &impl Scatterer, drawn: &impl Scatterer, samples: usize, dice: &mut Dice) -> Self {
        let (extents, pixels) = (extents(), 2 * SIDE * SIDE);
        let mut map = Self { claimed: vec![0.0; pixels], sampled: vec![0.0; pixels] };
        let mut found = 0;
        for _ in 0..samples {
            if let Some(w) = drawn.draw(dice).direction {
                map.sampled[pixel(w)] += 1.0 / samples as f64;
                found += 1;
            }
        }
        // Without samples there is nothing narrow to be found.
        let partition = if found > 0 { learn(drawn, (samples / 16).max(1024), dice) } else { Partition::new(Vec3::Z, &[]) };
        let narrow = |q: f64| q * STERADIANS > NARROW;
        for (at, mass) in map.claimed.iter_mut().enumerate() {
            let inside = places(at, FINE).filter_map(|(x, y, up)| direction(x, y, up));
            let each = 2.0 * (2.0 / (SIDE * FINE) as f64).powi(2);
            *mass = inside.filter(|w| !narrow(partition.look(*w).1)).map(|w| each * said.look(w).pdf).sum();
        }
        for _ in 0..samples / 4 {
            let w = partition.pick(dice);
            let q = partition.look(w).1;
            if narrow(q) {
                map.claimed[pixel(w)] += said.look(w).pdf / (q * (samples / 4) as f64);
            }
        }
        for half in [&mut map.claimed, &mut map.sampled] {
            // What lies on the rim has too few places to tell.
            half.iter_mut().zip(&extents).for_each(|(mass, extent)| *mass = if *extent > 2e-4 { *mass / extent } else { 0.0 });
        }
        map
    }

    /// Whether anything is in the upper and in the lower half.
    pub(super) fn halves(&self) -> [bool; 2] {
        let some =
            |from: usize| [&self.claimed, &self.sampled].into_iter().any(|half| half[from..from + SIDE * SIDE].iter().any(|d| *d > 0.0));
        [some(0), some(SIDE * SIDE)]
    }

    /// Both, as figures; the lower halves only where there is a `below`; `before` stands before them.
    pub(super) fn figures(&self, below: bool, before: &str) -> String {
        if self.halves() == [false; 2] {
            return format!("<div class=\"maps\">{before}</div>\n<p class=\"aside\">no pdf, and no samples that have one</p>\n");
        }
        // Samples scatter about the density; so its own largest counts.
        let most = self.claimed.iter().chain(self.sampled.iter().filter(|_| self.claimed.iter().all(|d| *d <= 0.0)));
        let scale = Scale::of(most.copied());
        // Samples scatter; what lies above the densest is to be told from it.
        let scale = Scale { most: if scale.logarithmic { 1.5 } else { 1.15 } * scale.most, ..scale };
        let figure = |densities: &[f64], name: &str| {
            let colour = |at: usize| warm(scale.place(densities[at]));
            format!("<span><img alt=\"{name} over the sphere\" src=\"{}\"/>{name}</span>\n", disc(below, colour))
        };
        let words = if scale.logarithmic { "brighter is denser, in logarithms" } else { "brighter is denser" };
        format!(
            "<div class=\"maps\" title=\"{words}\">\n{before}{}{}</div>\n",
            figure(&self.claimed, "pdf"),
            figure(&self.sampled, "samples")
        )
    }
}

/// A picture of the upper disc, and under it the lower one.
pub(super) fn disc(below: bool, colour: impl Fn(usize) -> [u8; 3]) -> String {
    let gap = 4;
    let height = if below { 2 * SIDE + gap } else { SIDE };
    let mut rgba = vec![0; 4 * SIDE * height];
    for at in 0..if below { 2 } else { 1 } * SIDE * SIDE {
        let covered = places(at, 4).filter(|(x, y, up)| direction(*x, *y, *up).is_some()).count();
        let row = at / SIDE + if at < SIDE * SIDE { 0 } else { gap };
        let [r, g, b] = colour(at);
        rgba[4 * (row * SIDE + at % SIDE)..][..4].copy_from_slice(&[r, g, b, (255 * covered / 16) as u8]);
    }
    png::uri(SIDE, height, &rgba)
}

/// What `value` says of each pixel's middle, for [`disc`].
pub(super) fn each<T>(mut value: impl FnMut(Vec3) -> T) -> Vec<T> {
    // A pixel whose middle lies beside the disc has the value of the rim.
    let middle = |at| {
        places(at, 1).next().map_or(Vec3::Z, |(x, y, up)| {
            let longer = x.hypot(y).max(0.999) / 0.999;
            direction(x / longer, y / longer, up).unwrap_or(Vec3::Z)
        })
    };
    (0..2 * SIDE * SIDE).map(|at| value(middle(at))).collect()
}

/// Dark blue to pale yellow, even to the eye (after "viridis").
fn warm(place: f64) -> [u8; 3] {
    const STOPS: [[f64; 3]; 6] =
        [[68.0, 1.0, 84.0], [65.0, 68.0, 135.0], [42.0, 120.0, 142.0], [34.0, 168.0, 132.0], [122.0, 209.0, 81.0], [253.0, 231.0, 37.0]];
    let along = 5.0 * place.clamp(0.0, 1.0);
    let (stop, share) = ((along as usize).min(4), along - (along as usize).min(4) as f64);
    std::array::from_fn(|band| (STOPS[stop][band] + share * (STOPS[stop + 1][band] - STOPS[stop][band]) + 0.5) as u8)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::bridge::{Claim, Drawn};

    #[test]
    fn a_place_of_a_disc_is_found_again() {
        for at in (0..2 * SIDE * SIDE).step_by(7) {
            for w in places(at, 3).filter_map(|(x, y, up)| direction(x, y, up)) {
                assert_eq!(pixel(w), at, "{w:?}");
            }
        }
        let all: f64 = extents().iter().sum();
        assert!((all / STERADIANS - 1.0).abs() < 1e-3, "{all}");
    }

    /// A narrow cone with a known density.
    struct Cone(f64);

    impl Scatterer for Cone {
        const NOTHING: f64 = 0.0;

        fn draw(&self, dice: &mut Dice) -> Drawn {
            let (z, phi) = (1.0 - self.0 * dice.exact(), std::f64::consts::TAU * dice.exact());
            let r = (1.0 - z * z).sqrt();
            let w = Vec3::new((0.6 * z + 0.8 * r * phi.cos()) as f32, (r * phi.sin()) as f32, (0.8 * z - 0.6 * r * phi.cos()) as f32);
            Drawn { direction: Some(w), ..Drawn::default() }
        }
        fn look(&self, w: Vec3) -> Claim {
            let inside = 1.0 - f64::from(0.6 * w.x + 0.8 * w.z) < self.0;
            Claim { pdf: if inside { 1.0 / (std::f64::consts::TAU * self.0) } else { 0.0 }, ..Claim::default() }
        }
    }

    #[test]
    fn the_density_has_the_mass_of_the_samples_however_narrow() {
        for width in [0.3, 1e-2, 1e-5] {
            let map = Map::of(&Cone(width), &Cone(width), 1 << 14, &mut Dice::new(7));
            let mass = |densities: &[f64]| densities.iter().zip(extents()).map(|(d, extent)| d * extent).sum::<f64>();
            let (claimed, sampled) = (mass(&map.claimed), mass(&map.sampled));
            assert!((sampled - 1.0).abs() < 1e-6 && (claimed - 1.0).abs() < 0.1, "{width}: {claimed}, {sampled}");
        }
    }
}
