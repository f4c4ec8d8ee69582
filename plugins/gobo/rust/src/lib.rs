//! A projector with a pattern before its lens. `../README.md` holds the definition that this source and its twin in
//! Zig follow.

use bidir_sdk::{
    Emitted, PerSolidAngle, Profile, Real, Spectrum, Vec2, Vec3,
    math::{floor, sqrt, tan, vec3},
    profile::Profiled,
};

const DEGREE: Real = (core::f64::consts::PI / 180.0) as Real;

bidir_sdk::parameters! {
    /// A projector with a pattern before its lens: the light of a window, of a blind, stripes, dots.
    pub struct Gobo {
        /// W/sr where the pattern is open.
        intensity: rgb(min 0.0, max 1e6, label "Intensity") = 1.0;
        /// Degrees from the axis to the left and right edge of the picture.
        half_width: float(min 0.5, max 80.0, label "Half width") = 20.0;
        /// Degrees from the axis to its upper and lower edge.
        half_height: float(min 0.5, max 80.0, label "Half height") = 20.0;
        /// What a cell of the picture shows: a pane, upright bars, lying bars, a round hole.
        pattern: choice Pattern { Window = "window", Stripes = "stripes", Slats = "slats", Dots = "dots" } = "window";
        /// Cells across the picture, and down.
        count: int(min 1, max 256, label "Count") = 2;
        /// The open share of a cell's width.
        opening: float(min 0.0, max 1.0, label "Opening") = 0.85;
        /// Width of the blurred edges, in cells.
        softness: float(min 0.0, max 1.0, label "Softness") = 0.05;
    }
}

/// t²(3 − 2t), t kept within 0 … 1.
fn smooth(t: Real) -> Real {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

impl Gobo {
    /// Half the picture's size on the plane z = 1.
    fn half_size(&self) -> (Real, Real) {
        (tan(self.half_width * DEGREE), tan(self.half_height * DEGREE))
    }

    /// From 0 to 1 where x goes from below 0 to above, blurred on both sides.
    fn step(&self, x: Real) -> Real {
        if self.softness > 0.0 { smooth(x / self.softness + 0.5) } else { hard(x) }
    }

    /// From 0 at x = 0 to 1 above.
    fn fade(&self, x: Real) -> Real {
        if self.softness > 0.0 { smooth(x / self.softness) } else { hard(x) }
    }

    /// How open the picture is at (p, q) in −1 … 1.
    fn openness(&self, p: Real, q: Real) -> Real {
        let n = self.count as Real;
        let from_middle = |at: Real| (at - floor(at) - 0.5).abs();
        let (e, f) = (from_middle(0.5 * (p + 1.0) * n), from_middle(0.5 * (q + 1.0) * n));
        let open = 0.5 * self.opening;
        let shape = match self.pattern {
            Pattern::Window => self.step(open - e) * self.step(open - f),
            Pattern::Stripes => self.step(open - e),
            Pattern::Slats => self.step(open - f),
            Pattern::Dots => self.step(open - sqrt(e * e + f * f)),
        };
        let gate = self.fade(0.5 * n * (1.0 - p.abs())) * self.fade(0.5 * n * (1.0 - q.abs()));
        shape * gate
    }
}

fn hard(x: Real) -> Real {
    if x > 0.0 { 1.0 } else { 0.0 }
}

impl Profile for Gobo {
    fn eval(&self, _: Vec2, direction: Vec3) -> Profiled {
        let (a, b) = self.half_size();
        let (x, y, z) = (direction.x / direction.z, direction.y / direction.z, direction.z);
        if !(z > 0.0 && x.abs() <= a && y.abs() <= b) {
            return Profiled { radiance: Spectrum::BLACK, pdf: PerSolidAngle(0.0) };
        }
        Profiled { radiance: self.intensity * self.openness(x / a, y / b), pdf: PerSolidAngle(1.0 / (4.0 * a * b * (z * z * z))) }
    }

    fn emit(&self, uv: Vec2, u: [Real; 2]) -> Option<Emitted> {
        let (a, b) = self.half_size();
        let (x, y) = (a * (2.0 * u[0] - 1.0), b * (2.0 * u[1] - 1.0));
        let length = sqrt(x * x + y * y + 1.0);
        let direction = vec3(x / length, y / length, 1.0 / length);
        let profiled = self.eval(uv, direction);
        (profiled.pdf.0 > 0.0).then_some(Emitted { direction, profiled })
    }
}

bidir_sdk::light! { Gobo, emits_from: [point] }

#[cfg(test)]
mod tests {
    use super::*;

    fn gobo(half_width: Real, half_height: Real, pattern: Pattern, softness: Real) -> Gobo {
        Gobo { intensity: Spectrum([3.0, 2.0, 1.0]), half_width, half_height, pattern, count: 4, opening: 0.5, softness }
    }

    fn cases() -> Vec<(String, Box<dyn Profile>)> {
        let case = |name: &str, gobo: Gobo| (name.to_owned(), Box::new(gobo) as Box<dyn Profile>);
        vec![
            case("window", gobo(20.0, 20.0, Pattern::Window, 0.1)),
            case("stripes", gobo(40.0, 15.0, Pattern::Stripes, 0.0)),
            case("slats", gobo(30.0, 30.0, Pattern::Slats, 1.0)),
            case("dots", gobo(70.0, 50.0, Pattern::Dots, 0.2)),
        ]
    }

    bidir_proof::light_tests!(cases());

    /// The share of the picture that is open.
    fn open_share(gobo: &Gobo) -> Real {
        let n = 400;
        let at = |i: usize| 2.0 * (i as Real + 0.5) / n as Real - 1.0;
        let sum: f64 = (0..n * n).map(|k| f64::from(gobo.openness(at(k / n), at(k % n)))).sum();
        (sum / (n * n) as f64) as Real
    }

    #[test]
    fn hard_patterns_are_open_by_the_share_of_their_opening() {
        let round = core::f32::consts::PI * 0.25 * 0.25;
        for (pattern, share) in [(Pattern::Window, 0.25), (Pattern::Stripes, 0.5), (Pattern::Slats, 0.5), (Pattern::Dots, round as Real)] {
            let found = open_share(&gobo(20.0, 20.0, pattern, 0.0));
            assert!((found - share).abs() < 5e-3, "{pattern:?}: {found} against {share}");
        }
    }

    #[test]
    fn the_picture_is_dark_behind_its_bars_and_past_its_edge() {
        let cross = Gobo { count: 2, opening: 0.9, ..gobo(20.0, 20.0, Pattern::Window, 0.0) };
        let at = |p: Real, q: Real| {
            let (a, b) = cross.half_size();
            cross.eval(Vec2::ZERO, vec3(p * a, q * b, 1.0).normalize()).radiance[0]
        };
        assert_eq!((at(0.5, 0.5), at(0.0, 0.5), at(0.5, 0.0), at(1.01, 0.5)), (3.0, 0.0, 0.0, 0.0));
    }
}
