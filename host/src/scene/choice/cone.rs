//! Cones that hold directions.

use glam::DVec3;
use std::f64::consts::PI;

/// All directions within an angle of an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cone {
    /// Unit.
    pub axis: DVec3,
    /// In radians, 0 … π; from π on, it holds every direction.
    pub angle: f64,
}

impl Cone {
    /// Every direction.
    pub const ALL: Self = Self { axis: DVec3::Z, angle: PI };

    /// Whether it holds every direction.
    pub fn is_all(&self) -> bool {
        self.angle >= PI
    }

    /// A cone about the mean of unit directions that holds them all, each with a weight in the mean; [`Cone::ALL`] where that vanishes.
    pub fn about(directions: impl Iterator<Item = (DVec3, f64)> + Clone) -> Self {
        let mean = directions.clone().fold(DVec3::ZERO, |sum, (direction, weight)| sum + direction * weight);
        let Some(axis) = mean.try_normalize() else { return Self::ALL };
        let least = directions.map(|(direction, _)| direction.dot(axis)).fold(1.0, f64::min);
        Self { axis, angle: libm::acos(least.max(-1.0)) }
    }

    /// A cone that holds both: about the plane of the two axes, from the outer edge of the one to that of the other.
    pub fn union(&self, other: &Self) -> Self {
        let (wide, narrow) = if self.angle >= other.angle { (self, other) } else { (other, self) };
        if wide.is_all() {
            return Self::ALL;
        }
        let cos = wide.axis.dot(narrow.axis).clamp(-1.0, 1.0);
        let between = libm::acos(cos);
        if between + narrow.angle <= wide.angle {
            return *wide;
        }
        let angle = 0.5 * (between + wide.angle + narrow.angle);
        let turn = angle - wide.angle;
        match (narrow.axis - wide.axis * cos).try_normalize() {
            Some(across) if angle < PI => Self { axis: wide.axis * libm::cos(turn) + across * libm::sin(turn), angle },
            // The same axis but for rounding, or opposite ones.
            _ if cos > 0.0 => Self { axis: wide.axis, angle: between + narrow.angle },
            _ => Self::ALL,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn direction(i: u32) -> DVec3 {
        let (z, turn) = (2.0 * (f64::from(i) * 0.618_033_988_75).fract() - 1.0, f64::from(i) * 2.4);
        let r = (1.0 - z * z).sqrt();
        DVec3::new(r * turn.cos(), r * turn.sin(), z)
    }

    #[test]
    fn a_union_holds_what_either_holds() {
        let cone = |i: u32| Cone { axis: direction(i), angle: 0.9 * f64::from(i % 7) };
        let holds =
            |cone: &Cone, w: DVec3, slack: f64| cone.is_all() || libm::acos(cone.axis.dot(w).clamp(-1.0, 1.0)) <= cone.angle + slack;
        for (i, j) in (0..40).flat_map(|i| (0..40).map(move |j| (i, j))) {
            let (a, b) = (cone(i), cone(j * 3 + 1));
            let both = a.union(&b);
            assert!((both.axis.length() - 1.0).abs() < 1e-7, "{both:?}");
            for w in (0..60).map(direction).filter(|&w| holds(&a, w, 0.0) || holds(&b, w, 0.0)) {
                assert!(holds(&both, w, 1e-6), "{a:?} {b:?} {both:?} {w}");
            }
        }
    }

    #[test]
    fn a_union_with_itself_or_its_opposite_is_defined() {
        let a = Cone { axis: DVec3::X, angle: 0.1 };
        assert!((a.union(&a).angle - 0.1).abs() < 1e-6);
        assert_eq!(a.union(&Cone { axis: -DVec3::X, angle: 0.0 }), Cone::ALL);
    }
}
