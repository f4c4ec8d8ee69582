//! The sheen of Estevez & Kulla 2017, "Production Friendly Microfacet Sheen BRDF": fibres that stand up, as a
//! distribution of microfacets whose normals lie near the horizon.

use bidir_sdk::{
    Real, Vec3,
    math::{exp, floor, lerp, ln, sqrt},
    real::INV_PI,
};

/// A sheen of this roughness, 0.1 … 1.
#[derive(Clone, Copy, Debug)]
pub struct Sheen {
    roughness: Real,
}

/// The least roughness: below it the fit of the shadowing no longer holds.
pub const LEAST_ROUGHNESS: Real = 0.1;

/// The fit of the shadowing gives more than it gets for cosines below about 1e-5.
const LEAST_COSINE: Real = 1e-4;

impl Sheen {
    /// Keeps the roughness within its range.
    pub fn new(roughness: Real) -> Self {
        Self { roughness: roughness.clamp(LEAST_ROUGHNESS, 1.0) }
    }

    /// f(ω_o, ω_i) of a white sheen, both directions above: D G/(4 cos θ_o cos θ_i).
    pub fn value(&self, wo: Vec3, wi: Vec3) -> Real {
        let half = wo + wi;
        let across = half.x * half.x + half.y * half.y;
        let sine_squared = across / (across + half.z * half.z);
        let inverse = 1.0 / self.roughness;
        let density = (2.0 + inverse) * power(sine_squared, 0.5 * inverse) * (0.5 * INV_PI);
        // A unit vector may be longer by a rounding.
        let (out, into) = (wo.z.clamp(LEAST_COSINE, 1.0), wi.z.clamp(LEAST_COSINE, 1.0));
        density / (4.0 * out * into * (1.0 + self.shadowing(out) + self.shadowing(into)))
    }

    /// Λ(cos θ), eq. 3 and 4.
    fn shadowing(&self, cos: Real) -> Real {
        let smoothness = (1.0 - self.roughness) * (1.0 - self.roughness);
        let [a, b, c, d, e] = core::array::from_fn(|i| lerp(ROUGH[i], SMOOTH[i], smoothness));
        let fit = |x: Real| a / (1.0 + b * power(x, c)) + d * x + e;
        exp(if cos < 0.5 { fit(cos) } else { 2.0 * fit(0.5) - fit(1.0 - cos) })
    }

    /// What a white sheen reflects of light from a direction with this cosine, rounded up: at most 0.01 too much,
    /// 0.06 where the cosine is below 0.004. So what a base below is given never makes it gain.
    pub fn albedo(&self, cos: Real) -> Real {
        let (row, between) = self.row();
        let column = sqrt(cos.clamp(0.0, 1.0)) * (COLUMNS - 1) as Real;
        let whole = floor(column).min((COLUMNS - 2) as Real);
        let (i, part) = (whole as usize, column - whole);
        let along = |row: &[Real; COLUMNS]| lerp(row[i], row[i + 1], part);
        lerp(along(&ALBEDO[row]), along(&ALBEDO[row + 1]), between)
    }

    /// 2 ∫ albedo(c) c dc, of the table as [`Sheen::albedo`] reads it.
    pub fn mean_albedo(&self) -> Real {
        let (row, between) = self.row();
        lerp(MEAN_ALBEDO[row], MEAN_ALBEDO[row + 1], between)
    }

    fn row(&self) -> (usize, Real) {
        let row = sqrt((self.roughness - LEAST_ROUGHNESS) / (1.0 - LEAST_ROUGHNESS)) * (ROWS - 1) as Real;
        let whole = floor(row).min((ROWS - 2) as Real);
        (whole as usize, row - whole)
    }
}

/// x to the y for x in 0 … 1 and moderate y > 0: half the time of the exact one.
fn power(x: Real, y: Real) -> Real {
    exp(y * ln(x))
}

/// Table 1 of the paper at roughness 0 and 1.
const SMOOTH: [Real; 5] = [25.3245, 3.32435, 0.16801, -1.27393, -4.85967];
const ROUGH: [Real; 5] = [21.5473, 3.82987, 0.19823, -1.97760, -4.32054];

/// Rows: roughness 0.1 + 0.9 (j/7)². Columns: cos θ = (i/16)².
const ROWS: usize = 8;
const COLUMNS: usize = 17;

/// ∫ f cos θ_i dω_i, by quadrature, then raised until it is nowhere too low between its entries.
const ALBEDO: [[Real; COLUMNS]; ROWS] = [
    [
        0.7922, 0.9364, 0.8679, 0.7634, 0.6521, 0.5456, 0.4481, 0.3600, 0.2820, 0.2143, 0.1563, 0.1086, 0.0709, 0.0427, 0.0227, 0.0092,
        0.0018,
    ],
    [
        0.7557, 0.9043, 0.8426, 0.7475, 0.6441, 0.5445, 0.4533, 0.3702, 0.2956, 0.2296, 0.1723, 0.1237, 0.0841, 0.0534, 0.0302, 0.0136,
        0.0032,
    ],
    [
        0.6952, 0.8469, 0.7971, 0.7214, 0.6349, 0.5505, 0.4708, 0.3968, 0.3288, 0.2670, 0.2111, 0.1614, 0.1185, 0.0830, 0.0537, 0.0296,
        0.0109,
    ],
    [
        0.6748, 0.8293, 0.7939, 0.7281, 0.6514, 0.5761, 0.5042, 0.4368, 0.3739, 0.3153, 0.2606, 0.2100, 0.1645, 0.1251, 0.0902, 0.0588,
        0.0307,
    ],
    [
        0.7001, 0.8615, 0.8328, 0.7670, 0.6941, 0.6219, 0.5530, 0.4886, 0.4277, 0.3703, 0.3157, 0.2638, 0.2159, 0.1736, 0.1346, 0.0976,
        0.0626,
    ],
    [
        0.7505, 0.9249, 0.8979, 0.8300, 0.7549, 0.6814, 0.6116, 0.5463, 0.4846, 0.4260, 0.3701, 0.3162, 0.2662, 0.2216, 0.1800, 0.1400,
        0.1014,
    ],
    [
        0.8021, 0.9833, 0.9557, 0.8851, 0.8068, 0.7310, 0.6595, 0.5928, 0.5299, 0.4704, 0.4134, 0.3583, 0.3071, 0.2615, 0.2189, 0.1780,
        0.1385,
    ],
    [
        0.7892, 0.9489, 0.9383, 0.8743, 0.8012, 0.7288, 0.6606, 0.5971, 0.5372, 0.4806, 0.4262, 0.3741, 0.3253, 0.2817, 0.2411, 0.2022,
        0.1648,
    ],
];

/// 2 ∫ of each row, its entries joined by straight lines in √cos θ.
const MEAN_ALBEDO: [Real; ROWS] = [0.07847, 0.08719, 0.11184, 0.14900, 0.19447, 0.24195, 0.28220, 0.30148];
