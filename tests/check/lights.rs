//! The same for lights.

use std::sync::atomic::{AtomicU32, Ordering};

use bidir::check::Test;
use bidir_kernel::{Emitted, PerSolidAngle, Profile, Real, Spectrum, Vec2, Vec3, profile::Profiled, real::PI};

use super::light;

/// A lobe about z: radiance cosⁿ, pdf (n + 1)/2π · cosⁿ.
#[derive(Clone, Copy)]
struct Lamp {
    n: Real,
    mistake: u32,
}

static ANSWERS: AtomicU32 = AtomicU32::new(0);

impl Lamp {
    fn profiled(&self, direction: Vec3) -> Profiled {
        let cos = direction.z.clamp(0.0, 1.0);
        let power = libm::powf(cos, self.n);
        let mut pdf = (self.n + 1.0) / (2.0 * PI) * power;
        let mut radiance = Spectrum([3.0, 2.0, 1.0]) * power;
        match self.mistake {
            1 => pdf *= 1.03,
            6 if direction.x > 0.1 => pdf = 0.0,
            8 if direction.z < 0.0 => (radiance, pdf) = (Spectrum::splat(0.05), 1e-6),
            _ => {}
        }
        Profiled { radiance, pdf: PerSolidAngle(pdf) }
    }
}

impl Profile for Lamp {
    fn eval(&self, _: Vec2, direction: Vec3) -> Profiled {
        let mut profiled = self.profiled(direction);
        if self.mistake == 5 && direction.z > 0.999_999 {
            profiled.radiance = Spectrum::splat(Real::NAN);
        }
        if self.mistake == 9 && ANSWERS.fetch_add(1, Ordering::Relaxed) % 7 == 6 {
            profiled.radiance = profiled.radiance * 1.001;
        }
        profiled
    }

    fn emit(&self, _: Vec2, u: [Real; 2]) -> Option<Emitted> {
        let n = if self.mistake == 7 { 1.1 * self.n } else { self.n };
        let cos = libm::powf(1.0 - u[0], 1.0 / (n + 1.0));
        let (sin, phi) = (((1.0 - cos) * (1.0 + cos)).sqrt(), 2.0 * PI * u[1]);
        let x = sin * libm::cosf(phi);
        let mut direction = Vec3::new(if self.mistake == 4 { x.abs() } else { x }, sin * libm::sinf(phi), cos);
        let mut profiled = self.profiled(direction);
        match self.mistake {
            2 => profiled.radiance = profiled.radiance * 1.03,
            3 => profiled.pdf.0 *= 1.03,
            10 => direction *= 1.02,
            11 if u[0] > 0.9 => return None,
            _ => {}
        }
        (profiled.pdf.0 > 0.0).then_some(Emitted { direction, profiled })
    }
}

const MISTAKES: [(u32, &str, Test); 11] = [
    (1, "pdf 3 % too large", Test::Mass),
    (2, "emission 3 % larger in samples", Test::Emission),
    (3, "pdf 3 % larger in samples", Test::Agreement),
    (4, "half of the directions are never made", Test::Sampling),
    (5, "NaN on the axis", Test::Range),
    (6, "no pdf where there is radiance", Test::Range),
    (7, "sampling narrower than the pdf", Test::Sampling),
    (8, "bright where samples never go", Test::Power),
    (9, "every seventh answer is 0.1 % larger", Test::Purity),
    (10, "directions 2 % too long", Test::Range),
    (11, "a tenth of the samples is thrown away", Test::Mass),
];

#[test]
fn mistakes_of_lights_are_named() {
    for (mistake, what, test) in MISTAKES {
        for n in [1.0, 50.0, 10_000.0] {
            // Where the lobe is narrower than the mistake, there is none.
            if (mistake == 6 && n > 100.0) || (mistake == 7 && n < 10.0) {
                continue;
            }
            let report = light("lamp", || Lamp { n, mistake }, 3);
            assert_eq!(report.culprit, Some(test), "{mistake}, {what}, n = {n}: {report}");
        }
    }
}

#[test]
fn a_right_light_passes() {
    for (seed, n) in [0.5, 1.0, 50.0, 10_000.0].into_iter().enumerate() {
        let report = light("lamp", || Lamp { n, mistake: 0 }, seed as u64);
        assert!(report.passed, "n = {n}: {report}");
    }
}
