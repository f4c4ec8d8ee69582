//! {{Name}}: a cone of light that falls off from its axis to its edge.
//!
//! L(ω) = radiance · (1 − h), h = (1 − ω.z)/(1 − cos spread), for h below 1;
//! directions are made in proportion: pdf = (1 − h)/(π (1 − cos spread)).

use bidir_sdk::{
    Emitted, PerSolidAngle, Profile, Real, Spectrum, Vec2, Vec3,
    math::{safe_sqrt, sin, sin_cos, sqr, sqrt, vec3},
    profile::Profiled,
    real::PI,
};

bidir_sdk::parameters! {
    /// A cone of light that falls off from its axis to its edge.
    pub struct {{Name}} {
        /// On the axis, W/(m² sr); for a point W/sr.
        radiance: rgb(min 0.0, max 1e6, label "Radiance") = 1.0;
        /// Degrees from the axis to the edge.
        spread: float(min 0.5, max 90.0, label "Spread") = 30.0;
    }
}

bidir_sdk::light! { {{Name}}, emits_from: [area, point, environment] }

impl {{Name}} {
    /// 1 − cos spread, in a form that keeps its digits when the cone is narrow.
    fn opening(&self) -> Real {
        2.0 * sqr(sin(self.spread * (PI / 360.0)))
    }
}

impl Profile for {{Name}} {
    fn eval(&self, _: Vec2, w: Vec3) -> Profiled {
        let open = self.opening();
        // (x² + y²)/(1 + z) is 1 − z without cancellation.
        let left = 1.0 - (sqr(w.x) + sqr(w.y)) / (1.0 + w.z) / open;
        if !(w.z > 0.0 && left > 0.0) {
            return Profiled { radiance: Spectrum::BLACK, pdf: PerSolidAngle(0.0) };
        }
        Profiled { radiance: self.radiance * left, pdf: PerSolidAngle(left / (PI * open)) }
    }

    fn emit(&self, uv: Vec2, u: [Real; 2]) -> Option<Emitted> {
        // 1 − h has density 2 (1 − h): the square root.
        let below = (1.0 - sqrt(1.0 - u[0])) * self.opening();
        let r = safe_sqrt(below * (2.0 - below));
        let (sin_phi, cos_phi) = sin_cos(2.0 * PI * u[1]);
        let direction = vec3(r * cos_phi, r * sin_phi, 1.0 - below);
        let profiled = self.eval(uv, direction);
        (profiled.pdf.0 > 0.0).then_some(Emitted { direction, profiled })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_direction_is_made_with_the_density_of_eval() {
        let lamp = {{Name}}::default();
        let made = lamp.emit(Vec2::ZERO, [0.3, 0.7]).expect("the cone is open");
        assert!(made.profiled.pdf.0 > 0.0);
        assert_eq!(made.profiled, lamp.eval(Vec2::ZERO, made.direction));
    }

    #[test]
    fn the_edge_is_dark() {
        assert_eq!({{Name}}::default().eval(Vec2::ZERO, vec3(0.8, 0.0, 0.6)).radiance, Spectrum::BLACK);
    }
}
