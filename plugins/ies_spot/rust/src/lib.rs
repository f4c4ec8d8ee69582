//! A lamp with a measured distribution. `../README.md` holds the definition that this source and its twin in
//! AssemblyScript follow.
#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "`!(x > 0.0)` refuses NaN too")]

use bidir_sdk::{
    Emitted, PerSolidAngle, Profile, Real, Spectrum, Vec2, Vec3,
    math::{atan2, floor, safe_sqrt, sin_cos, sqrt, vec3},
    profile::Profiled,
    real::PI,
};

/// Zones between neighbouring angles.
const ZONES: usize = 18;
const DEGREE: Real = (core::f64::consts::PI / 180.0) as Real;
const NOTHING: Profiled = Profiled { radiance: Spectrum::BLACK, pdf: PerSolidAngle(0.0) };

bidir_sdk::parameters! {
    /// A lamp with a measured distribution: intensities at equal steps of the angle to its axis.
    pub struct IesSpot {
        /// W/sr where the web says 1.
        intensity: rgb(min 0.0, max 1e6, label "Intensity") = 1.0;
        /// Degrees from one value to the next: 5 covers 90°, 10 the whole sphere.
        step: float(min 0.5, max 10.0, label "Step") = 5.0;
        /// Relative intensity on the axis.
        c0: float(min 0.0, max 1e6) = 1.0;
        /// Relative intensity 1 step from the axis.
        c1: float(min 0.0, max 1e6) = 0.98;
        /// Relative intensity 2 steps from the axis.
        c2: float(min 0.0, max 1e6) = 0.93;
        /// Relative intensity 3 steps from the axis.
        c3: float(min 0.0, max 1e6) = 0.86;
        /// Relative intensity 4 steps from the axis.
        c4: float(min 0.0, max 1e6) = 0.78;
        /// Relative intensity 5 steps from the axis.
        c5: float(min 0.0, max 1e6) = 0.66;
        /// Relative intensity 6 steps from the axis.
        c6: float(min 0.0, max 1e6) = 0.5;
        /// Relative intensity 7 steps from the axis.
        c7: float(min 0.0, max 1e6) = 0.34;
        /// Relative intensity 8 steps from the axis.
        c8: float(min 0.0, max 1e6) = 0.2;
        /// Relative intensity 9 steps from the axis.
        c9: float(min 0.0, max 1e6) = 0.1;
        /// Relative intensity 10 steps from the axis.
        c10: float(min 0.0, max 1e6) = 0.05;
        /// Relative intensity 11 steps from the axis.
        c11: float(min 0.0, max 1e6) = 0.03;
        /// Relative intensity 12 steps from the axis.
        c12: float(min 0.0, max 1e6) = 0.02;
        /// Relative intensity 13 steps from the axis.
        c13: float(min 0.0, max 1e6) = 0.015;
        /// Relative intensity 14 steps from the axis.
        c14: float(min 0.0, max 1e6) = 0.01;
        /// Relative intensity 15 steps from the axis.
        c15: float(min 0.0, max 1e6) = 0.006;
        /// Relative intensity 16 steps from the axis.
        c16: float(min 0.0, max 1e6) = 0.003;
        /// Relative intensity 17 steps from the axis.
        c17: float(min 0.0, max 1e6) = 0.001;
        /// Relative intensity 18 steps from the axis.
        c18: float(min 0.0, max 1e6) = 0.0;
    }
}

impl IesSpot {
    fn lamp(&self) -> Lamp {
        let near = [self.c0, self.c1, self.c2, self.c3, self.c4, self.c5, self.c6, self.c7, self.c8, self.c9];
        let far = [self.c10, self.c11, self.c12, self.c13, self.c14, self.c15, self.c16, self.c17, self.c18];
        let web = core::array::from_fn(|i| if i < near.len() { near[i] } else { far[i - near.len()] });
        Lamp { intensity: self.intensity, step: self.step, web }
    }
}

/// A lamp: intensities at equal steps of the angle to z, and straight lines between them.
#[derive(Clone, Copy, Debug)]
pub struct Lamp {
    /// W/sr where the web says 1.
    pub intensity: Spectrum,
    /// Degrees from one value to the next, 0.5 … 10.
    pub step: Real,
    /// Relative intensity at 0, 1, … 18 steps from the axis.
    pub web: [Real; ZONES + 1],
}

/// The zones as directions are made from them.
struct Zones {
    /// Mean intensity of each.
    means: [Real; ZONES],
    /// 1/2π of the solid angle of each.
    extents: [Real; ZONES],
    /// Sum of mean times extent.
    total: Real,
}

impl Zones {
    fn new(lamp: &Lamp) -> Self {
        let (s1, c1) = sin_cos(0.5 * (lamp.step * DEGREE));
        let (sin_step, cos_step) = (2.0 * s1 * c1, 1.0 - 2.0 * s1 * s1);
        let mut zones = Self { means: [0.0; ZONES], extents: [0.0; ZONES], total: 0.0 };
        let (mut sine, mut cosine) = (s1, c1);
        for (i, ends) in lamp.web.windows(2).enumerate() {
            zones.extents[i] = 2.0 * s1 * sine;
            zones.means[i] = 0.5 * (ends[0] + ends[1]);
            zones.total += zones.means[i] * zones.extents[i];
            (sine, cosine) = (sine * cos_step + cosine * sin_step, cosine * cos_step - sine * sin_step);
        }
        zones
    }

    /// 1 − cos θ of the angle that `u` falls on.
    fn one_minus_cos(&self, u: Real) -> Real {
        let mut rest = u * self.total;
        let (mut h, mut last) = (0.0, 0.0);
        for (&mean, &extent) in self.means.iter().zip(&self.extents) {
            let mass = mean * extent;
            if rest < mass {
                return h + rest / mean;
            }
            rest -= mass;
            h += extent;
            if mean > 0.0 {
                last = h;
            }
        }
        last
    }
}

impl Lamp {
    fn look_up(&self, direction: Vec3, zones: &Zones) -> Profiled {
        let angle = atan2(sqrt(direction.x * direction.x + direction.y * direction.y), direction.z);
        let place = angle / (self.step * DEGREE);
        let whole = floor(place);
        let zone = whole as usize;
        if !(zones.total > 0.0) || zone >= ZONES || zones.means[zone] == 0.0 {
            return NOTHING;
        }
        let (from, to) = (self.web[zone], self.web[zone + 1]);
        Profiled {
            radiance: self.intensity * (from + (place - whole) * (to - from)),
            pdf: PerSolidAngle(zones.means[zone] / (2.0 * PI * zones.total)),
        }
    }
}

impl Profile for Lamp {
    fn eval(&self, _: Vec2, direction: Vec3) -> Profiled {
        self.look_up(direction, &Zones::new(self))
    }

    fn emit(&self, _: Vec2, u: [Real; 2]) -> Option<Emitted> {
        let zones = Zones::new(self);
        if !(zones.total > 0.0) {
            return None;
        }
        let h = zones.one_minus_cos(u[0]).min(2.0);
        let r = safe_sqrt(h * (2.0 - h));
        let (sin, cos) = sin_cos(2.0 * PI * u[1]);
        let direction = vec3(r * cos, r * sin, 1.0 - h);
        let profiled = self.look_up(direction, &zones);
        (profiled.pdf.0 > 0.0).then_some(Emitted { direction, profiled })
    }
}

bidir_sdk::light! { IesSpot => IesSpot::lamp, emits_from: [point] }

#[cfg(test)]
mod tests {
    use super::*;

    fn web(at: impl Fn(usize) -> Real) -> [Real; ZONES + 1] {
        core::array::from_fn(at)
    }

    fn lamp(step: Real, web: [Real; ZONES + 1]) -> Lamp {
        Lamp { intensity: Spectrum([3.0, 2.0, 1.0]), step, web }
    }

    fn cases() -> Vec<(String, Box<dyn Profile>)> {
        let case = |name: &str, lamp: Lamp| (name.to_owned(), Box::new(lamp) as Box<dyn Profile>);
        vec![
            case("falling", lamp(10.0, web(|i| 1.0 - i as Real / 18.0))),
            case("up and down", lamp(10.0, web(|i| ((i * 7) % 5) as Real))),
            case("everywhere alike", lamp(10.0, web(|_| 2.0))),
            case("a ring", lamp(10.0, web(|i| if i == 9 { 1.0 } else { 0.0 }))),
            case("upwards", lamp(10.0, web(|i| if i > 12 { 1.0 } else { 0.0 }))),
            case("half", lamp(5.0, web(|i| 1.0 + (i % 3) as Real))),
        ]
    }

    bidir_proof::light_tests!(cases());

    /// Mean of intensity / pdf: the power in the first band.
    fn power(lamp: &Lamp) -> f64 {
        let samples = 300;
        let one = |i: u32| {
            let u = [((i / samples) as Real + 0.5) / samples as Real, ((i % samples) as Real + 0.5) / samples as Real];
            lamp.emit(Vec2::ZERO, u).map_or(0.0, |e| f64::from(e.profiled.radiance[0] / e.profiled.pdf.0))
        };
        (0..samples * samples).map(one).sum::<f64>() / f64::from(samples * samples)
    }

    #[test]
    fn the_power_is_the_integral_of_the_web() {
        for (step, at) in [(10.0, 18.0), (5.0, 10.0), (0.5, 12.0)] {
            let lamp = lamp(step, web(|i| (1.0 - i as Real / at).max(0.0)));
            let end = f64::from(at * step * DEGREE);
            // 2π · 3 ∫ (1 − θ/e) sin θ dθ = 6π (1 − sin e/e)
            let exact = 6.0 * core::f64::consts::PI * (1.0 - end.sin() / end);
            let found = power(&lamp);
            assert!((found / exact - 1.0).abs() < 2e-3, "step {step}: {found} against {exact}");
        }
    }

    #[test]
    fn values_of_the_web_are_met_at_their_angles() {
        let lamp = lamp(5.0, web(|i| (i * i) as Real));
        for i in 1..18 {
            let (sin, cos) = sin_cos(i as Real * 5.0 * DEGREE);
            let found = lamp.eval(Vec2::ZERO, vec3(sin, 0.0, cos)).radiance[2];
            assert!((found - (i * i) as Real).abs() < 1e-3, "{found} at {i} steps");
        }
    }

    #[test]
    fn a_dark_web_sends_nothing() {
        let dark = lamp(5.0, web(|_| 0.0));
        assert!(dark.emit(Vec2::ZERO, [0.5, 0.5]).is_none());
        assert_eq!(dark.eval(Vec2::ZERO, Vec3::Z), NOTHING);
    }
}
