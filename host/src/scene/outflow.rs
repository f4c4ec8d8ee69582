//! How much light a profile sends, estimated from what it says of a fixed set of directions; built-in profiles and plugins alike,
//! so that the choice among lights does not depend on which of the two a light is.

use bidir_kernel::{Profile, Real, Vec2, Vec3, warp};

/// Means of the bands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outflow {
    /// ∫ L |cos θ| dω over all directions: what leaves a unit of area.
    pub exitance: f64,
    /// ∫ L dω over all directions: what leaves a point.
    pub total: f64,
    /// Whether anything leaves towards −z.
    pub both_sides: bool,
    /// The least z of a direction in which anything leaves: the cosine of a cone about z that holds nearly all.
    pub reach: f64,
}

/// Directions asked for: so many squared.
const ROOT: u32 = 32;

/// Directions from behind that are looked at: so many squared.
const BEHIND: u32 = 8;

impl Outflow {
    /// Nothing.
    pub const NONE: Self = Self { exitance: 0.0, total: 0.0, both_sides: false, reach: 1.0 };

    /// That of a profile.
    pub fn of(profile: &impl Profile) -> Self {
        let mut sum = Self::NONE;
        for i in 0..ROOT * ROOT {
            let Some(emitted) = profile.emit(spread(i), centred(i, ROOT)) else { continue };
            let radiance = f64::from(emitted.profiled.radiance.mean());
            let share = radiance / f64::from(emitted.profiled.pdf.0);
            sum.total += share;
            sum.exitance += share * f64::from(emitted.direction.z.abs());
            if radiance > 0.0 {
                sum.reach = sum.reach.min(f64::from(emitted.direction.z));
            }
        }
        for i in 0..BEHIND * BEHIND {
            let up = warp::cosine_hemisphere(centred(i, BEHIND));
            let behind = Vec3::new(up.x, up.y, -up.z);
            if !profile.eval(spread(i), behind).radiance.is_black() {
                sum.reach = sum.reach.min(f64::from(behind.z));
            }
        }
        let count = f64::from(ROOT * ROOT);
        sum.both_sides = sum.reach < 0.0;
        Self { exitance: sum.exitance / count, total: sum.total / count, ..sum }
    }
}

/// The middle of a cell of the unit square.
fn centred(i: u32, root: u32) -> [Real; 2] {
    [(i % root) as Real + 0.5, (i / root) as Real + 0.5].map(|x| x / root as Real)
}

/// Surface coordinates that go evenly over the unit square, whatever the directions beside them do: multiples of the powers
/// of the plastic number, modulo 1.
fn spread(i: u32) -> Vec2 {
    let turn = |step: u32| (i.wrapping_mul(step) >> 8) as Real / (1 << 24) as Real;
    Vec2::new(turn(3_242_174_889), turn(2_447_445_414))
}

#[cfg(test)]
mod tests {
    use bidir_kernel::{Emitted, PerSolidAngle, Spectrum, profile::Profiled, real::PI};
    use bidir_standard::{Area, Isotropic, Spot};

    use super::*;

    fn near(a: f64, b: f64, tolerance: f64) {
        assert!((a / b - 1.0).abs() < tolerance, "{a} {b}");
    }

    #[test]
    fn a_hemisphere_sends_pi_times_its_radiance_from_each_unit_of_area_and_nothing_behind() {
        let outflow = Outflow::of(&Area { radiance: Spectrum::splat(3.0) });
        near(outflow.exitance, 3.0 * std::f64::consts::PI, 1e-5);
        assert!(!outflow.both_sides);
    }

    #[test]
    fn a_point_sends_four_pi_times_its_intensity() {
        let outflow = Outflow::of(&Isotropic { intensity: Spectrum::ONE });
        near(outflow.total, 4.0 * std::f64::consts::PI, 1e-5);
        assert!(outflow.reach < -0.99);
    }

    #[test]
    fn a_narrow_spot_is_weighed_by_its_cone() {
        let (cutoff, beam_width) = (0.01 * PI, 0.01 * PI);
        let outflow = Outflow::of(&Spot { intensity: Spectrum::ONE, cutoff, beam_width });
        near(outflow.total, std::f64::consts::TAU * (1.0 - f64::from(cutoff).cos()), 1e-3);
        assert!(outflow.reach > f64::from(cutoff).cos() && outflow.reach < f64::from(0.98 * cutoff).cos(), "{}", outflow.reach);
    }

    /// Shines backwards only.
    struct Backwards;

    impl Profile for Backwards {
        fn eval(&self, _: Vec2, direction: Vec3) -> Profiled {
            let radiance = if direction.z < 0.0 { Spectrum::ONE } else { Spectrum::BLACK };
            Profiled { radiance, pdf: PerSolidAngle(warp::cosine_hemisphere_pdf(direction.z)) }
        }

        fn emit(&self, _: Vec2, _: [Real; 2]) -> Option<Emitted> {
            None
        }
    }

    #[test]
    fn light_that_is_never_sampled_backwards_but_goes_there_is_found() {
        assert!(Outflow::of(&Backwards).both_sides);
    }
}
