//! Eight numbers at once: AVX2's registers where the machine has them, else two fours.
//! Both are off by less than the probe's slack.

#[cfg(target_arch = "x86_64")]
use pulp::{NullaryFnOnce, x86::V3};
use wide::f32x4;

/// How many.
pub(super) const WIDTH: usize = 8;

/// What eight numbers can do.
pub(super) trait Lanes: Copy {
    type Eight: Copy;
    fn load(self, numbers: &[f32; WIDTH]) -> Self::Eight;
    fn splat(self, number: f32) -> Self::Eight;
    /// What [`Lanes::along`] wants to know of a ray's origin.
    fn start(self, origin: f32, inverse: f32) -> Self::Eight;
    /// (plane − origin) · inverse, with the error of three roundings of operands and result.
    fn along(self, plane: Self::Eight, start: Self::Eight, inverse: Self::Eight) -> Self::Eight;
    /// Neither is NaN.
    fn max(self, a: Self::Eight, b: Self::Eight) -> Self::Eight;
    /// Neither is NaN.
    fn min(self, a: Self::Eight, b: Self::Eight) -> Self::Eight;
    /// Where a ≤ b, as bits.
    fn at_most(self, a: Self::Eight, b: Self::Eight) -> u32;
    fn store(self, a: Self::Eight) -> [f32; WIDTH];
    /// Tells the machine that the value there will be read soon, if there is one.
    fn prefetch<T>(self, values: &[T], index: usize);
}

/// Two fours, on every machine.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fours;

impl Lanes for Fours {
    type Eight = [f32x4; 2];

    #[inline(always)]
    fn load(self, numbers: &[f32; WIDTH]) -> Self::Eight {
        let [a, b, c, d, e, f, g, h] = *numbers;
        [f32x4::new([a, b, c, d]), f32x4::new([e, f, g, h])]
    }

    #[inline(always)]
    fn splat(self, number: f32) -> Self::Eight {
        [f32x4::splat(number); 2]
    }

    #[inline(always)]
    fn start(self, origin: f32, _: f32) -> Self::Eight {
        self.splat(origin)
    }

    #[inline(always)]
    fn along(self, plane: Self::Eight, start: Self::Eight, inverse: Self::Eight) -> Self::Eight {
        [(plane[0] - start[0]) * inverse[0], (plane[1] - start[1]) * inverse[1]]
    }

    #[inline(always)]
    fn max(self, a: Self::Eight, b: Self::Eight) -> Self::Eight {
        [a[0].fast_max(b[0]), a[1].fast_max(b[1])]
    }

    #[inline(always)]
    fn min(self, a: Self::Eight, b: Self::Eight) -> Self::Eight {
        [a[0].fast_min(b[0]), a[1].fast_min(b[1])]
    }

    #[inline(always)]
    fn at_most(self, a: Self::Eight, b: Self::Eight) -> u32 {
        a[0].simd_le(b[0]).to_bitmask() | a[1].simd_le(b[1]).to_bitmask() << 4
    }

    #[inline(always)]
    fn store(self, a: Self::Eight) -> [f32; WIDTH] {
        let ([a, b, c, d], [e, f, g, h]) = (a[0].to_array(), a[1].to_array());
        [a, b, c, d, e, f, g, h]
    }

    #[inline(always)]
    fn prefetch<T>(self, _: &[T], _: usize) {}
}

/// AVX2's registers.
#[cfg(target_arch = "x86_64")]
#[derive(Clone, Copy, Debug)]
pub(super) struct Avx2(V3);

#[cfg(target_arch = "x86_64")]
impl Lanes for Avx2 {
    type Eight = core::arch::x86_64::__m256;

    #[inline(always)]
    fn load(self, numbers: &[f32; WIDTH]) -> Self::Eight {
        pulp::cast(*numbers)
    }

    #[inline(always)]
    fn splat(self, number: f32) -> Self::Eight {
        self.0.avx._mm256_set1_ps(number)
    }

    #[inline(always)]
    fn start(self, origin: f32, inverse: f32) -> Self::Eight {
        self.splat(origin * inverse)
    }

    #[inline(always)]
    fn along(self, plane: Self::Eight, start: Self::Eight, inverse: Self::Eight) -> Self::Eight {
        self.0.fma._mm256_fmsub_ps(plane, inverse, start)
    }

    #[inline(always)]
    fn max(self, a: Self::Eight, b: Self::Eight) -> Self::Eight {
        self.0.avx._mm256_max_ps(a, b)
    }

    #[inline(always)]
    fn min(self, a: Self::Eight, b: Self::Eight) -> Self::Eight {
        self.0.avx._mm256_min_ps(a, b)
    }

    #[inline(always)]
    fn at_most(self, a: Self::Eight, b: Self::Eight) -> u32 {
        use core::arch::x86_64::_CMP_LE_OQ;
        let avx = self.0.avx;
        avx._mm256_movemask_ps(avx._mm256_cmp_ps::<_CMP_LE_OQ>(a, b)) as u32
    }

    #[inline(always)]
    fn store(self, a: Self::Eight) -> [f32; WIDTH] {
        pulp::cast(a)
    }

    #[inline(always)]
    fn prefetch<T>(self, values: &[T], index: usize) {
        use core::arch::x86_64::_MM_HINT_T0;
        const LINE: usize = 64;
        let first = values.as_ptr().wrapping_add(index).cast::<i8>();
        for line in 0..size_of::<T>().div_ceil(LINE) {
            self.0.sse._mm_prefetch::<_MM_HINT_T0>(first.wrapping_add(line * LINE));
        }
    }
}

/// Work that is compiled once for each kind of machine.
pub(super) trait Work {
    type Output;
    /// Has to be inlined, with all it calls that is to be fast.
    fn run<L: Lanes>(self, lanes: L) -> Self::Output;
}

/// Which of the machine's registers are used. Answers do not depend on it.
#[derive(Clone, Copy, Debug)]
pub(super) enum Machine {
    Any,
    #[cfg(target_arch = "x86_64")]
    Avx2(V3),
}

impl Machine {
    /// What this machine does best.
    pub fn detected() -> Self {
        #[cfg(target_arch = "x86_64")]
        if let Some(v3) = V3::try_new() {
            return Self::Avx2(v3);
        }
        Self::Any
    }

    #[inline(always)]
    pub fn run<W: Work>(self, work: W) -> W::Output {
        match self {
            Self::Any => work.run(Fours),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(v3) => v3.vectorize(With(work, Avx2(v3))),
        }
    }
}

#[cfg(target_arch = "x86_64")]
struct With<W>(W, Avx2);

#[cfg(target_arch = "x86_64")]
impl<W: Work> NullaryFnOnce for With<W> {
    type Output = W::Output;

    #[inline(always)]
    fn call(self) -> W::Output {
        self.0.run(self.1)
    }
}
