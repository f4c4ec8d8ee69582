//! What light is made of: one number per colour band.

use core::ops::{Add, AddAssign, Div, Index, Mul, MulAssign, Sub};

use crate::real::Real;

/// How many colour bands a spectrum has. Everything below this file works for any number.
pub const BANDS: usize = 3;

/// One number per colour band; today linear R, G, B with the sRGB primaries.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spectrum(pub [Real; BANDS]);

impl Spectrum {
    /// No light.
    pub const BLACK: Self = Self([0.0; BANDS]);
    /// The factor that changes nothing.
    pub const ONE: Self = Self([1.0; BANDS]);

    /// The same number in every band.
    #[inline(always)]
    pub const fn splat(value: Real) -> Self {
        Self([value; BANDS])
    }

    /// `f` of every band.
    #[inline(always)]
    pub fn map(self, f: impl FnMut(Real) -> Real) -> Self {
        Self(self.0.map(f))
    }

    /// The largest band.
    #[inline(always)]
    pub fn max(self) -> Real {
        self.0.iter().fold(self.0[0], |a, &b| a.max(b))
    }

    /// The mean of the bands.
    #[inline(always)]
    pub fn mean(self) -> Real {
        self.0.iter().sum::<Real>() / BANDS as Real
    }

    /// Whether every band is 0.
    #[inline(always)]
    pub fn is_black(self) -> bool {
        self.0.iter().all(|&v| v == 0.0)
    }

    /// Whether no band is NaN or infinite.
    #[inline(always)]
    pub fn is_finite(self) -> bool {
        self.0.iter().all(|v| v.is_finite())
    }
}

macro_rules! bandwise {
    ($($trait:ident $method:ident $op:tt);+ $(;)?) => {$(
        impl $trait for Spectrum {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(core::array::from_fn(|band| self.0[band] $op other.0[band]))
            }
        }
    )+};
}

bandwise! { Add add +; Sub sub -; Mul mul *; Div div / }

impl Mul<Real> for Spectrum {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: Real) -> Self {
        self.map(|v| v * factor)
    }
}

impl Div<Real> for Spectrum {
    type Output = Self;
    #[inline(always)]
    fn div(self, divisor: Real) -> Self {
        self.map(|v| v / divisor)
    }
}

impl AddAssign for Spectrum {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl MulAssign for Spectrum {
    #[inline(always)]
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

impl Index<usize> for Spectrum {
    type Output = Real;
    #[inline(always)]
    fn index(&self, band: usize) -> &Real {
        &self.0[band]
    }
}
