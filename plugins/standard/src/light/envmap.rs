//! An image of the surroundings.

use bidir_sdk::{
    Emitted, PerSolidAngle, Profile, Real, Spectrum, Vec2, Vec3,
    math::{atan2, floor, lerp, sin, sin_cos, sqr, sqrt, vec3},
    profile::Profiled,
    real::{ONE_MINUS_EPSILON, PI},
};

/// A latitude-longitude image around the scene, sampled by its brightness.
///
/// The image is looked up at d = −direction, since an environment's directions travel into the scene: the azimuth
/// atan2(d.x, d.y)/2π gives the column, texel i being centred at (i + ½)/width with wrap-around; the angle from up,
/// acos(d.z)/π, gives the row, the first row lying on the upper pole and the last on the lower one. Bilinear between texels.
/// This is Mitsuba 3's `envmap`, whose local (X, Y, Z) is (x, z, −y) here.
///
/// Between the centres of four texels lies a *cell*. A cell is chosen by its mean brightness times sin θ, and a direction
/// in it by the bilinear brightness of its corners.
#[derive(Clone, Copy, Debug)]
pub struct Envmap<'a> {
    width: usize,
    height: usize,
    texels: &'a [Spectrum],
    rows: &'a [Real],
    columns: &'a [Real],
}

/// How long the tables of an image are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EnvmapSizes {
    /// Of `rows`: the distribution over rows of cells.
    pub rows: usize,
    /// Of `columns`: one distribution per row of cells over its columns.
    pub columns: usize,
}

/// The least share of a cell that is not black in its row, and of a row in the image, relative to an even share;
/// the differences of a cumulative f32 table of up to 16,384 entries show no less.
const LEAST_SHARE: Real = 1.0 / 256.0;

/// Rows of cells of an image with this many rows of texels.
fn cell_rows(height: usize) -> usize {
    height.saturating_sub(1).max(1)
}

impl<'a> Envmap<'a> {
    /// How long the tables of an image of this size have to be.
    pub fn sizes(width: usize, height: usize) -> EnvmapSizes {
        EnvmapSizes { rows: cell_rows(height) + 1, columns: cell_rows(height) * (width + 1) }
    }

    /// Fills the tables of an image; once per image. `texels` are rows from the top, W/(m² sr), finite and not negative.
    /// False, and nothing usable, where a slice has another length than [`Envmap::sizes`] says, or `width` · `height` is 0.
    pub fn fill(width: usize, height: usize, texels: &[Spectrum], rows: &mut [Real], columns: &mut [Real]) -> bool {
        if !Self::fits(width, height, texels, rows, columns) {
            return false;
        }
        let cells = cell_rows(height);
        for (row, columns) in columns.chunks_exact_mut(width + 1).enumerate() {
            let corner = |row: usize, column: usize| texels[row.min(height - 1) * width + column % width].mean();
            let mean =
                |column| 0.25 * (corner(row, column) + corner(row, column + 1) + corner(row + 1, column) + corner(row + 1, column + 1));
            for (column, slot) in columns[1..].iter_mut().enumerate() {
                *slot = mean(column);
            }
            rows[row + 1] = accumulate(columns) * sin((row as Real + 0.5) / cells as Real * PI);
        }
        accumulate(rows);
        true
    }

    /// The image with its filled tables; `None` where a slice's length is wrong.
    pub fn new(width: usize, height: usize, texels: &'a [Spectrum], rows: &'a [Real], columns: &'a [Real]) -> Option<Self> {
        Self::fits(width, height, texels, rows, columns).then_some(Self { width, height, texels, rows, columns })
    }

    fn fits(width: usize, height: usize, texels: &[Spectrum], rows: &[Real], columns: &[Real]) -> bool {
        let sizes = Self::sizes(width, height);
        width > 0 && height > 0 && texels.len() == width * height && rows.len() == sizes.rows && columns.len() == sizes.columns
    }

    #[inline]
    fn corners(&self, row: usize, column: usize) -> [[Spectrum; 2]; 2] {
        let (right, below) = (if column + 1 == self.width { 0 } else { column + 1 }, (row + 1).min(self.height - 1));
        let texel = |row: usize, column: usize| self.texels[row * self.width + column];
        [[texel(row, column), texel(row, right)], [texel(below, column), texel(below, right)]]
    }

    #[inline]
    fn columns_of(&self, row: usize) -> &[Real] {
        &self.columns[row * (self.width + 1)..][..self.width + 1]
    }

    /// What comes from a place in a cell, and how densely; `s` and `t` in 0 … 1 from its upper left corner.
    #[inline]
    fn at(&self, row: usize, column: usize, s: Real, t: Real, sin_theta: Real) -> Profiled {
        let [[a, b], [c, d]] = self.corners(row, column);
        let radiance = (a * (1.0 - s) + b * s) * (1.0 - t) + (c * (1.0 - s) + d * s) * t;
        let mean = 0.25 * (a.mean() + b.mean() + c.mean() + d.mean());
        let columns = self.columns_of(row);
        let chance = (self.rows[row + 1] - self.rows[row]) * (columns[column + 1] - columns[column]);
        if !(mean > 0.0) {
            return Profiled { radiance, pdf: PerSolidAngle(0.0) };
        }
        let (rows, width) = (cell_rows(self.height) as Real, self.width as Real);
        let cells_per_steradian = width * rows / (2.0 * PI * PI * sin_theta.max(LEAST_SINE));
        Profiled { radiance, pdf: PerSolidAngle(chance * (radiance.mean() / mean) * cells_per_steradian) }
    }
}

/// What stands for sin θ at the poles, where it vanishes.
const LEAST_SINE: Real = 1e-7;

/// Turns shares `table[1..]` into a cumulative distribution from 0 to 1, none of them vanishing; all 0 if all shares are.
/// Gives the mean share.
fn accumulate(table: &mut [Real]) -> Real {
    let count = (table.len() - 1) as Real;
    let total: f64 = table[1..].iter().map(|&share| f64::from(share)).sum();
    let mean = (total / f64::from(count)) as Real;
    let floor = mean * LEAST_SHARE;
    let raised = |share: Real| if share > 0.0 { share.max(floor) } else { 0.0 };
    let total: f64 = table[1..].iter().map(|&share| f64::from(raised(share))).sum();
    table[0] = 0.0;
    let mut sum = 0.0;
    for slot in &mut table[1..] {
        sum += f64::from(raised(*slot));
        *slot = if total > 0.0 { (sum / total) as Real } else { 0.0 };
    }
    mean
}

/// The entry of a cumulative distribution that `u` falls into, and how far into it.
#[inline]
fn find(table: &[Real], u: Real) -> (usize, Real) {
    let entry = table.partition_point(|&below| below <= u).clamp(1, table.len() - 1) - 1;
    let (low, high) = (table[entry], table[entry + 1]);
    (entry, if high > low { ((u - low) / (high - low)).clamp(0.0, ONE_MINUS_EPSILON) } else { 0.0 })
}

/// Samples 0 … 1 with a density that goes linearly from `a` to `b`.
#[inline]
fn linear(a: Real, b: Real, u: Real) -> Real {
    if a == b { u } else { (u * (a + b) / (a + sqrt(lerp(sqr(a), sqr(b), u)))).min(ONE_MINUS_EPSILON) }
}

impl Profile for Envmap<'_> {
    #[inline]
    fn eval(&self, _: Vec2, direction: Vec3) -> Profiled {
        let d = -direction;
        let sin_theta = sqrt(sqr(d.x) + sqr(d.y));
        let (rows, width) = (cell_rows(self.height), self.width as Real);
        let x = atan2(d.x, d.y) / (2.0 * PI) * width - 0.5;
        let x = if x < 0.0 { x + width } else { x };
        let y = atan2(sin_theta, d.z) / PI * rows as Real;
        let (column, row) = ((floor(x) as usize).min(self.width - 1), (floor(y) as usize).min(rows - 1));
        self.at(row, column, (x - column as Real).min(1.0), (y - row as Real).min(1.0), sin_theta)
    }

    #[inline]
    fn emit(&self, _: Vec2, u: [Real; 2]) -> Option<Emitted> {
        let (row, v) = find(self.rows, u[1]);
        let (column, u) = find(self.columns_of(row), u[0]);
        let [[a, b], [c, d]] = self.corners(row, column).map(|row| row.map(Spectrum::mean));
        let t = linear(a + b, c + d, v);
        let s = linear(lerp(a, c, t), lerp(b, d, t), u);
        let (sin_theta, cos_theta) = sin_cos((row as Real + t) / cell_rows(self.height) as Real * PI);
        let (sin_phi, cos_phi) = sin_cos((column as Real + 0.5 + s) / self.width as Real * (2.0 * PI));
        let profiled = self.at(row, column, s, t, sin_theta);
        let direction = -vec3(sin_theta * sin_phi, sin_theta * cos_phi, cos_theta);
        (profiled.pdf.0 > 0.0).then_some(Emitted { direction, profiled })
    }
}
