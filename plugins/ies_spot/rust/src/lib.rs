//! A lamp with a measured distribution. `../README.md` holds the definition that this source and its twin in
//! AssemblyScript follow.

use bidir_kernel::{
    Emitted, PerSolidAngle, Profile, Real, Spectrum, Vec2, Vec3,
    math::{atan2, floor, safe_sqrt, sin_cos, sqrt, vec3},
    profile::Profiled,
    real::PI,
};

/// Zones between neighbouring angles.
const ZONES: usize = 18;
const DEGREE: Real = (core::f64::consts::PI / 180.0) as Real;
const NOTHING: Profiled = Profiled { radiance: Spectrum::BLACK, pdf: PerSolidAngle(0.0) };

/// A lamp: intensities at equal steps of the angle to z, and straight lines between them.
#[derive(Clone, Copy, Debug)]
pub struct IesSpot {
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
    fn new(lamp: &IesSpot) -> Self {
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

impl IesSpot {
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

impl Profile for IesSpot {
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

#[cfg(test)]
mod tests {
    use super::*;

    fn web(at: impl Fn(usize) -> Real) -> [Real; ZONES + 1] {
        core::array::from_fn(at)
    }

    fn lamp(step: Real, web: [Real; ZONES + 1]) -> IesSpot {
        IesSpot { intensity: Spectrum([3.0, 2.0, 1.0]), step, web }
    }

    fn cases() -> Vec<(String, Box<dyn Profile>)> {
        let case = |name: &str, lamp: IesSpot| (name.to_owned(), Box::new(lamp) as Box<dyn Profile>);
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
    fn power(lamp: &IesSpot) -> f64 {
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
