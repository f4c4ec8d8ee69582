//! Every function whose result decides a pixel, with the same bits on every machine.
//!
//! What IEEE 754 makes exact (square root, floor, absolute value) comes from std where it is there; minimum and maximum are
//! comparisons, since std leaves the sign of a zero open and calls a function for them in WebAssembly; every transcendental function comes from the crate `libm`, natively and in wasm alike. Nothing here fuses
//! a multiplication with an addition.

use crate::real::{self, Real, Vec2, Vec3};

/// √x, exact; NaN below 0.
#[inline(always)]
pub fn sqrt(x: Real) -> Real {
    #[cfg(feature = "std")]
    return x.sqrt();
    #[cfg(not(feature = "std"))]
    return libm::Libm::<Real>::sqrt(x);
}

/// The larger; `y` where either is NaN.
#[inline(always)]
pub fn max(x: Real, y: Real) -> Real {
    if x > y { x } else { y }
}

/// The smaller; `y` where either is NaN.
#[inline(always)]
pub fn min(x: Real, y: Real) -> Real {
    if x < y { x } else { y }
}

/// √x with everything below 0 taken as 0: for 1 − cos², which rounding pushes under.
#[inline(always)]
pub fn safe_sqrt(x: Real) -> Real {
    sqrt(max(x, 0.0))
}

/// The largest whole number not above x.
#[inline(always)]
pub fn floor(x: Real) -> Real {
    #[cfg(feature = "std")]
    return x.floor();
    #[cfg(not(feature = "std"))]
    return libm::Libm::<Real>::floor(x);
}

/// |x|.
#[inline(always)]
pub fn abs(x: Real) -> Real {
    real::abs(x)
}

/// x².
#[inline(always)]
pub fn sqr(x: Real) -> Real {
    x * x
}

macro_rules! from_libm {
    ($($(#[$doc:meta])* $name:ident),+ $(,)?) => {$(
        $(#[$doc])*
        #[inline]
        pub fn $name(x: Real) -> Real {
            real::$name(x)
        }
    )+};
}

from_libm! {
    /// sin x, x in radians.
    sin,
    /// cos x, x in radians.
    cos,
    /// tan x, x in radians.
    tan,
    /// arcsin x in radians.
    asin,
    /// arccos x in radians; NaN outside −1 … 1.
    acos,
    /// arctan x in radians.
    atan,
    /// e to the x.
    exp,
    /// The natural logarithm.
    ln,
    /// The hyperbolic cosine.
    cosh,
    /// The complementary error function, 1 − erf x.
    erfc,
}

/// (sin x, cos x), x in radians.
#[inline]
pub fn sin_cos(x: Real) -> (Real, Real) {
    (real::sin(x), real::cos(x))
}

/// arccos x with x clamped to −1 … 1.
#[inline]
pub fn safe_acos(x: Real) -> Real {
    real::acos(x.clamp(-1.0, 1.0))
}

/// The angle of (x, y) in −π … π.
#[inline]
pub fn atan2(y: Real, x: Real) -> Real {
    real::atan2(y, x)
}

/// x to the y.
#[inline]
pub fn pow(x: Real, y: Real) -> Real {
    real::pow(x, y)
}

/// a + t (b − a).
#[inline(always)]
pub fn lerp(a: Real, b: Real, t: Real) -> Real {
    a + t * (b - a)
}

/// x · y with 0 for 0 · ∞.
#[inline(always)]
pub(crate) fn times(x: f64, y: f64) -> f64 {
    if x == 0.0 || y == 0.0 { 0.0 } else { x * y }
}

/// The sum of three products, each rounded once, left to right: a dot product that sums in one order everywhere.
#[inline(always)]
pub fn dot(a: Vec3, b: Vec3) -> Real {
    a.x * b.x + a.y * b.y + a.z * b.z
}

/// A vector of its own direction and length 1, or `None` where the length is 0 or not finite.
#[inline]
pub fn normalize(v: Vec3) -> Option<Vec3> {
    let squared = dot(v, v);
    if squared > SMALLEST_SQUARE && squared < 1.0 / SMALLEST_SQUARE {
        return Some(v * (1.0 / sqrt(squared)));
    }
    normalize_extreme(v)
}

/// Sums of squares between this and its inverse are far from where they lose digits.
const SMALLEST_SQUARE: Real = 1e-30;

/// Scales by the largest component first: the squares of a scene 1e±30 in size leave f32.
#[cold]
fn normalize_extreme(v: Vec3) -> Option<Vec3> {
    let largest = v.x.abs().max(v.y.abs()).max(v.z.abs());
    if largest > 0.0 && largest < Real::INFINITY {
        let v = v / largest;
        Some(v / sqrt(dot(v, v)))
    } else {
        None
    }
}

/// (x, y) as a vector.
#[inline(always)]
pub fn vec2(x: Real, y: Real) -> Vec2 {
    Vec2::new(x, y)
}

/// (x, y, z) as a vector.
#[inline(always)]
pub fn vec3(x: Real, y: Real, z: Real) -> Vec3 {
    Vec3::new(x, y, z)
}
