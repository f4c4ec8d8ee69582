//! Rectangles whose light varies: points sampled by how bright they are.

use bidir_kernel::{
    PerArea, Point, Real, Vec2,
    light::{Extent, Toward},
};

use crate::scene::{description::Texture, extent::Parallelogram};

/// The least side of the grid, in cells, and the greatest.
const SIDES: [u32; 2] = [32, 256];

/// How many texels along a side are looked at in a cell, at most.
const LOOKS: u32 = 8;

/// The share of samples that goes evenly everywhere, so that what no look at a cell met is found as well.
const EVENLY: f64 = 0.1;

/// A distribution over the unit square that is uniform in each cell of a grid.
#[derive(Clone, Debug)]
pub struct Cells {
    columns: usize,
    /// The cells' shares added up, row by row: `rows[i]` is that of the first i + 1 rows.
    rows: Vec<f64>,
    /// For each row, its cells' shares added up likewise.
    cells: Vec<f64>,
}

impl Cells {
    /// As a texture's brightness lies over the unit square; `None` where it is the same everywhere.
    pub fn of(texture: &Texture) -> Option<Self> {
        let [width, height] = match texture {
            Texture::Constant(_) | Texture::Attribute { .. } => return None,
            Texture::Bitmap(bitmap) => [bitmap.width, bitmap.height],
            Texture::Checkerboard { .. } => [SIDES[1]; 2],
        };
        let [columns, rows] = [width, height].map(|side| side.clamp(SIDES[0], SIDES[1]));
        let looks = (width.max(height) / SIDES[1]).clamp(2, LOOKS);
        let at = |cell: u32, look: u32, cells: u32| (cell as Real + (look as Real + 0.5) / looks as Real) / cells as Real;
        let brightness = |x: u32, y: u32| -> f64 {
            let looked = (0..looks * looks).map(|i| Vec2::new(at(x, i % looks, columns), at(y, i / looks, rows)));
            looked.map(|uv| f64::from(texture.at(uv).mean())).sum()
        };
        let weights: Vec<f64> = (0..rows * columns).map(|i| brightness(i % columns, i / columns)).collect();
        Self::new(&weights, columns as usize)
    }

    /// From the cells' weights, row by row; `None` where they add up to nothing.
    fn new(weights: &[f64], columns: usize) -> Option<Self> {
        let total: f64 = weights.iter().sum();
        if !(total > 0.0 && total.is_finite()) {
            return None;
        }
        let even = EVENLY / weights.len() as f64;
        let (mut rows, mut cells, mut sum) = (Vec::new(), Vec::with_capacity(weights.len()), 0.0);
        for row in weights.chunks(columns) {
            let mut within = 0.0;
            for weight in row {
                within += (1.0 - EVENLY) * weight / total + even;
                cells.push(within);
            }
            sum += within;
            rows.push(sum);
        }
        Some(Self { columns, rows, cells })
    }

    /// A point of the square, and how densely it is made relative to even sampling.
    fn sample(&self, u: [Real; 2]) -> ([Real; 2], f64) {
        let (row, v) = pick(&self.rows, u[1]);
        let (column, across) = pick(self.row(row), u[0]);
        let size = [self.columns, self.rows.len()];
        let within = |cell: usize, rest: f64, cells: usize| ((cell as f64 + rest) / cells as f64) as Real;
        let at = [within(column, across, size[0]), within(row, v, size[1])].map(|x| x.min(bidir_kernel::real::ONE_MINUS_EPSILON));
        (at, self.density(at))
    }

    /// How densely a point is made, relative to even sampling.
    fn density(&self, at: [Real; 2]) -> f64 {
        let size = [self.columns, self.rows.len()];
        let cell = |x: Real, cells: usize| ((f64::from(x) * cells as f64) as usize).min(cells - 1);
        let (column, row) = (cell(at[0], size[0]), cell(at[1], size[1]));
        share(self.row(row), column) * (size[0] * size[1]) as f64
    }

    fn row(&self, row: usize) -> &[f64] {
        &self.cells[row * self.columns..][..self.columns]
    }
}

fn share(sums: &[f64], index: usize) -> f64 {
    sums[index] - if index == 0 { 0.0 } else { sums[index - 1] }
}

/// An index by its share, and where in that share u lies.
fn pick(sums: &[f64], u: Real) -> (usize, f64) {
    let target = f64::from(u) * sums.last().copied().unwrap_or(0.0);
    let index = sums.partition_point(|&sum| sum <= target).min(sums.len() - 1);
    let below = if index == 0 { 0.0 } else { sums[index - 1] };
    (index, ((target - below) / share(sums, index)).clamp(0.0, 1.0))
}

/// A rectangle whose points are sampled by a texture's brightness.
#[derive(Clone, Copy, Debug)]
pub struct Painted<'a> {
    /// Its coordinates go over the unit square.
    pub extent: &'a Parallelogram,
    /// What is sampled there.
    pub cells: &'a Cells,
}

impl Painted<'_> {
    fn scaled(PerArea(even): PerArea, by: f64) -> PerArea {
        PerArea((f64::from(even) * by) as Real)
    }
}

impl Extent for Painted<'_> {
    fn sample(&self, u: [Real; 2]) -> (Point, PerArea) {
        let (at, density) = self.cells.sample(u);
        let (point, even) = self.extent.sample(at);
        (point, Self::scaled(even, density))
    }

    fn density(&self, at: &Point) -> PerArea {
        Self::scaled(self.extent.density(at), self.cells.density([at.uv.x, at.uv.y]))
    }

    fn sample_toward(&self, lit: &Point, u: [Real; 2]) -> Option<Toward> {
        let (at, density) = self.cells.sample(u);
        let even = self.extent.sample_toward(lit, at)?;
        let weight = even.weight * (1.0 / density) as Real;
        Some(Toward { density: Self::scaled(even.density, density), weight, ..even })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Four cells, of which one is black.
    fn quarters() -> Cells {
        Cells::new(&[1.0, 2.0, 0.0, 5.0], 2).expect("some light")
    }

    #[test]
    fn the_density_integrates_to_one_and_is_nowhere_zero() {
        let cells = quarters();
        let quarters = [[0.2, 0.2], [0.7, 0.2], [0.2, 0.7], [0.7, 0.7]].map(|at| cells.density(at));
        assert!((quarters.iter().sum::<f64>() / 4.0 - 1.0).abs() < 1e-12, "{quarters:?}");
        assert!((quarters[2] - EVENLY).abs() < 1e-12, "what is black gets its part of the even ones: {quarters:?}");
        assert!((quarters[3] - (0.9 * 5.0 / 8.0 * 4.0 + EVENLY)).abs() < 1e-12, "{quarters:?}");
    }

    #[test]
    fn samples_fall_as_densely_as_the_density_says() {
        let cells = quarters();
        let side = 400;
        let mut found = [0; 4];
        for i in 0..side * side {
            let u = [i % side, i / side].map(|x| (x as Real + 0.5) / side as Real);
            let (at, density) = cells.sample(u);
            assert!(at.iter().all(|x| (0.0..1.0).contains(x)));
            assert_eq!(density, cells.density(at));
            found[usize::from(at[0] >= 0.5) + 2 * usize::from(at[1] >= 0.5)] += 1;
        }
        for (i, at) in [[0.2, 0.2], [0.7, 0.2], [0.2, 0.7], [0.7, 0.7]].into_iter().enumerate() {
            let share = f64::from(found[i]) / f64::from(side * side);
            assert!((4.0 * share - cells.density(at)).abs() < 0.02, "{i}: {share}");
        }
    }

    #[test]
    fn what_is_black_everywhere_has_no_distribution() {
        assert!(Cells::new(&[0.0; 4], 2).is_none());
    }
}
