//! The one file that knows the number type.
//!
//! The packages a user builds have no feature `f64`. The stability oracle (`tests/f64`) compiles the same
//! sources a second time, in a package that has it.

#[cfg(not(feature = "f64"))]
mod chosen {
    /// The number type of geometry, directions, spectra and densities.
    pub type Real = f32;
    pub use glam::{Mat3, Vec2, Vec3};
    pub use libm::{
        acosf as acos, asinf as asin, atan2f as atan2, atanf as atan, cosf as cos, coshf as cosh, erfcf as erfc, expf as exp, fabsf as abs,
        logf as ln, powf as pow, sinf as sin, tanf as tan,
    };
}

#[cfg(feature = "f64")]
mod chosen {
    /// The number type of geometry, directions, spectra and densities.
    pub type Real = f64;
    pub use glam::{DMat3 as Mat3, DVec2 as Vec2, DVec3 as Vec3};
    pub use libm::{acos, asin, atan, atan2, cos, cosh, erfc, exp, fabs as abs, log as ln, pow, sin, tan};
}

pub use chosen::{Mat3, Real, Vec2, Vec3};
pub(crate) use chosen::{abs, acos, asin, atan, atan2, cos, cosh, erfc, exp, ln, pow, sin, tan};

/// π.
pub const PI: Real = core::f64::consts::PI as Real;
/// 1/π.
pub const INV_PI: Real = core::f64::consts::FRAC_1_PI as Real;
/// The largest number below 1.
pub const ONE_MINUS_EPSILON: Real = 1.0 - Real::EPSILON / 2.0;
