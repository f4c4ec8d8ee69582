//! Sums of products over more decades than f64 has.

use crate::math::times;

/// value · 2^(512 · shift), not negative: ratios of densities multiplied along a whole walk leave f64 in hard cases and come back.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wide {
    /// 0, not finite, or within [`LOW`] … [`HIGH`], so that a few more factors fit.
    value: f64,
    shift: i32,
}

/// 2^512 and 2^−512.
const UP: f64 = f64::from_bits((1023 + 512) << 52);
const DOWN: f64 = f64::from_bits((1023 - 512) << 52);
/// 2^256 and 2^−256.
const HIGH: f64 = f64::from_bits((1023 + 256) << 52);
const LOW: f64 = f64::from_bits((1023 - 256) << 52);

impl Wide {
    pub(crate) const ZERO: Self = Self { value: 0.0, shift: 0 };

    #[inline]
    fn new(value: f64, shift: i32) -> Self {
        if (LOW..HIGH).contains(&value) {
            Self { value, shift }
        } else if value == 0.0 {
            Self::ZERO
        } else {
            Self::shifted(value, shift)
        }
    }

    #[cold]
    fn shifted(mut value: f64, mut shift: i32) -> Self {
        if !(value > 0.0 && value < f64::INFINITY) {
            return Self { value, shift: 0 };
        }
        // Two steps reach the middle from either end of f64. That there are no more lets a sum that nobody reads be left out.
        for _ in 0..2 {
            if value >= HIGH {
                (value, shift) = (value * DOWN, shift + 1);
            } else if value < LOW {
                (value, shift) = (value * UP, shift - 1);
            }
        }
        Self { value, shift }
    }

    /// This times x, 0 for 0 · ∞.
    #[inline]
    pub(crate) fn times(self, x: f64) -> Self {
        if self.value == 0.0 { self } else { Self::new(times(self.value, x), self.shift) }
    }

    /// This and x.
    #[inline]
    pub(crate) fn plus(self, x: f64) -> Self {
        if self.shift == 0 || x == 0.0 { Self::new(self.value + x, self.shift) } else { self.aligned(Self::new(x, 0)) }
    }

    #[cold]
    fn aligned(self, other: Self) -> Self {
        let (high, low) = if self.shift >= other.shift { (self, other) } else { (other, self) };
        let low = match high.shift - low.shift {
            0 => low.value,
            1 => low.value * DOWN,
            _ => 0.0,
        };
        Self::new(high.value + low, high.shift)
    }

    /// This over a sum that it is a part of; 1 where it is infinite, 0 where both are 0.
    #[inline]
    pub(crate) fn part_of(self, sum: Self) -> f64 {
        if self.value == 0.0 {
            0.0
        } else if self.shift == sum.shift && sum.value < f64::INFINITY {
            self.value / sum.value
        } else {
            self.far_part_of(sum)
        }
    }

    #[cold]
    fn far_part_of(self, sum: Self) -> f64 {
        if self.value == f64::INFINITY {
            return 1.0;
        }
        // A part is never above its sum.
        (0..(sum.shift - self.shift).clamp(0, 3)).fold(self.value / sum.value, |part, _| part * DOWN)
    }

    /// The nearest f64: 0 or ∞ beyond its range.
    #[inline]
    pub(crate) fn get(self) -> f64 {
        if self.shift == 0 { self.value } else { self.beyond() }
    }

    #[cold]
    fn beyond(self) -> f64 {
        let step = if self.shift > 0 { UP } else { DOWN };
        // Three steps leave f64 from wherever they start.
        (0..self.shift.unsigned_abs().min(3)).fold(self.value, |value, _| value * step)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// log2, of what may be beyond f64.
    fn log(x: Wide) -> f64 {
        libm::log2(x.value) + 512.0 * f64::from(x.shift)
    }

    #[test]
    fn products_come_back_from_far_beyond_f64() {
        for (away, back) in [(1e200, 1e-200), (1e-200, 1e200)] {
            let far = (0..50).fold(Wide::ZERO.plus(3.0), |x, _| x.times(away));
            assert!((log(far) - (libm::log2(3.0) + 50.0 * libm::log2(away))).abs() < 1e-9);
            assert_eq!(far.get(), if away > 1.0 { f64::INFINITY } else { 0.0 });
            let near = (0..50).fold(far, |x, _| x.times(back)).get();
            assert!((near - 3.0).abs() < 1e-12, "{near}");
        }
    }

    #[test]
    fn sums_do_not_depend_on_how_the_parts_are_kept() {
        for exponent in (-300..=300).step_by(10) {
            for other in (-300..=300).step_by(10) {
                let (x, y) = (libm::exp10(f64::from(exponent)), libm::exp10(f64::from(other)));
                let sum = Wide::ZERO.plus(1.5 * x).plus(2.5 * y).get();
                let exact = 1.5 * x + 2.5 * y;
                assert!((sum - exact).abs() <= 1e-15 * exact, "{sum} {exact}");
            }
        }
    }

    #[test]
    fn parts_of_a_sum_add_up_however_far_apart_they_are() {
        for exponent in (-900..=900).step_by(45) {
            let wide = |exponent: i32| (0..9).fold(Wide::ZERO.plus(1.5), |x, _| x.times(libm::exp10(f64::from(exponent / 9))));
            let (a, b) = (wide(exponent), wide(exponent / 3));
            let sum = a.aligned(b);
            let [a, b] = [a, b].map(|part| part.part_of(sum));
            assert!((a + b - 1.0).abs() < 1e-12 && a >= 0.0 && b >= 0.0, "{exponent}: {a} {b}");
        }
        let infinite = Wide::ZERO.plus(f64::INFINITY);
        assert_eq!([infinite, Wide::ZERO.plus(2.0), Wide::ZERO].map(|part| part.part_of(infinite)), [1.0, 0.0, 0.0]);
    }

    #[test]
    fn zeros_infinities_and_no_numbers_stay_what_they_are() {
        assert_eq!(Wide::ZERO.times(f64::INFINITY).get(), 0.0);
        assert_eq!(Wide::ZERO.plus(1e-200).times(0.0).plus(1.0).get(), 1.0);
        assert_eq!(Wide::ZERO.plus(f64::INFINITY).plus(1.0).times(1e-300).get(), f64::INFINITY);
        assert!(Wide::ZERO.plus(f64::NAN).times(1e-300).get().is_nan());
    }
}
