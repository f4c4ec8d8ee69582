//! A ball of a material on a chequered floor, under a sky with a sun.
//!
//! A walk meets the ball, and what goes into it meets it again from inside, until it leaves. The sun is found both by samples of the BSDF and by
//! samples of the sun (balance heuristic), the rest of the surroundings by samples of the BSDF. Nothing goes from the ball to the floor but its shadow.

use bidir_kernel::{Bsdf, Carried, Frame, Lobe, Made, Scatter, Scattered, Vec3, math, warp};

use super::png::{toned, uri};
use crate::check::dice::Dice;

/// Meetings with the ball at most.
const BOUNCES: usize = 8;

/// A sample brighter than this is held to it: what is left of it would be a speck.
const SPECK: f32 = 8.0;

const CENTRE: Vec3 = Vec3::new(0.0, 0.0, 1.0);
const EYE: Vec3 = Vec3::new(0.0, -6.0, 2.1);
const AIM: Vec3 = Vec3::new(0.0, 0.0, 0.94);
/// Half the picture's extent at a distance of 1.
const EXTENT: f32 = 0.205;

/// Half the sun's width as 1 − cos (3.5°), and what it sheds on what faces it.
const SUN_WIDTH: f32 = 1.865e-3;
const SUN_POWER: f32 = 2.1;

/// Dimensions of a walk's first steps: pixel, BSDF, sun, the floor's sun.
const DIMENSIONS: usize = 9;

type Colour = [f32; 3];

fn times(a: Colour, b: Colour) -> Colour {
    std::array::from_fn(|band| a[band] * b[band])
}

fn add(sum: &mut Colour, more: Colour, factor: f32) {
    (0..3).for_each(|band| sum[band] += factor * more[band]);
}

/// What surrounds the ball.
struct Place {
    sun: Frame,
    /// The sun's radiance, and how densely its directions are made.
    sun_radiance: Colour,
    sun_pdf: f32,
    /// How much of the sun goes through the ball, to the floor's shadow.
    clear: f32,
}

/// A square picture, as a data URI. `clear` balls have a lighter shadow.
pub(super) fn picture(bsdf: &dyn Bsdf, clear: bool, side: usize, samples: usize) -> String {
    let towards_sun = Vec3::new(-0.66, -0.42, 0.62).normalize();
    let sun_pdf = warp::cone_pdf(SUN_WIDTH);
    let place = Place {
        sun: Frame::from_z(towards_sun),
        sun_radiance: [1.0, 0.93, 0.82].map(|tint| tint * SUN_POWER * sun_pdf),
        sun_pdf,
        clear: if clear { 0.45 } else { 0.0 },
    };
    let forward = (AIM - EYE).normalize();
    let right = forward.cross(Vec3::Z).normalize();
    let up = right.cross(forward);
    let (mut rgba, steps) = (Vec::with_capacity(4 * side * side), steps());
    for at in 0..side * side {
        let (mut sum, mut dice) = ([0.0; 3], Dice::new(at as u64));
        let shift: [f64; DIMENSIONS] = std::array::from_fn(|_| dice.exact());
        for sample in 0..samples {
            let u: [f32; DIMENSIONS] =
                std::array::from_fn(|i| ((shift[i] + sample as f64 * steps[i]).fract() as f32).min(1.0 - f32::EPSILON / 2.0));
            let [x, y, ..] = u;
            let across = |pixel: usize, u: f32| EXTENT * (2.0 * (pixel as f32 + u) / side as f32 - 1.0);
            let towards = (forward + right * across(at % side, x) - up * across(at / side, y)).normalize();
            let seen = place.seen(bsdf, towards, &u, &mut dice);
            if seen.iter().all(|value| value.is_finite()) {
                add(&mut sum, seen.map(|value| value.min(SPECK)), 1.0 / samples as f32);
            }
        }
        rgba.extend(sum.map(|value| toned(f64::from(value))));
        rgba.push(255);
    }
    uri(side, side, &rgba)
}

/// Points in several dimensions that keep away from each other (Roberts 2018): powers of the root of x^(d+1) = x + 1.
fn steps() -> [f64; DIMENSIONS] {
    let root = (0..64).fold(1.1_f64, |x, _| (1.0 + x).powf(1.0 / (DIMENSIONS + 1) as f64));
    std::array::from_fn(|i| root.powi(-(i as i32) - 1))
}

/// Where a ray from outside meets the ball.
fn met(from: Vec3, towards: Vec3) -> Option<Vec3> {
    let to_centre = CENTRE - from;
    let along = to_centre.dot(towards);
    let nearest = (to_centre - towards * along).length_squared();
    (along > 0.0 && nearest < 1.0).then(|| from + towards * (along - (1.0 - nearest).sqrt()))
}

impl Place {
    /// What comes from `towards` into the eye.
    fn seen(&self, bsdf: &dyn Bsdf, mut towards: Vec3, u: &[f32; DIMENSIONS], dice: &mut Dice) -> Colour {
        let [_, _, a, b, c, d, e, f, g] = *u;
        let (mut own, mut sunny) = ([a, b, c], [d, e]);
        let Some(mut point) = met(EYE, towards) else { return self.around(EYE, towards, [f, g], 1.0) };
        let (mut through, mut seen) = ([1.0; 3], [0.0; 3]);
        for _ in 0..BOUNCES {
            let normal = (point - CENTRE).normalize();
            let frame = Frame::from_z_and_tangent(normal, Vec3::Z.cross(normal));
            let wo = frame.to_local(-towards);
            let sun = self.sun.to_world(warp::cone(sunny, SUN_WIDTH));
            let sample = if normal.dot(sun) > 0.0 {
                let (Scatter { value, pdf, .. }, sample) = bsdf.eval_and_sample(wo, frame.to_local(sun), own, Carried::Radiance);
                add(&mut seen, times(times(through, value.0), self.sun_radiance), 1.0 / (self.sun_pdf + pdf.0));
                sample
            } else {
                bsdf.sample(wo, own, Carried::Radiance)
            };
            let Some(Scattered { wi, weight, made, lobe, .. }) = sample else { return seen };
            through = times(through, weight.0);
            let Some(next) = math::normalize(frame.to_world(wi)) else { return seen };
            towards = next;
            if normal.dot(towards) >= 0.0 {
                let found = match made {
                    Made::Smooth { pdf, .. } if lobe.intersects(Lobe::SMOOTH) => pdf.0 / (pdf.0 + self.sun_pdf),
                    _ => 1.0,
                };
                add(&mut seen, times(through, self.around(point, towards, [f, g], found)), 1.0);
                return seen;
            }
            // Straight across, to the ball's far side.
            point = CENTRE + normal + towards * (-2.0 * normal.dot(towards));
            (own, sunny) = (dice.three(), dice.pair());
        }
        seen
    }

    /// What comes from beside the ball; `found` is the weight of meeting the sun.
    fn around(&self, from: Vec3, towards: Vec3, u: [f32; 2], found: f32) -> Colour {
        let haze = [0.56, 0.61, 0.68];
        let mix = |a: Colour, b: Colour, share: f32| std::array::from_fn(|band| a[band] + share * (b[band] - a[band]));
        if towards.z < -1e-4 {
            let far = from.z / -towards.z;
            let floor = from + towards * far;
            return mix(self.floor(floor, u), haze, 1.0 - (-(far / 26.0).powi(2)).exp());
        }
        let sky = mix(haze, [0.12, 0.26, 0.56], towards.z.max(0.0).powf(0.55));
        let mut seen = sky;
        if 1.0 - towards.dot(self.sun.z) < SUN_WIDTH {
            add(&mut seen, self.sun_radiance, found);
        }
        seen
    }

    fn floor(&self, point: Vec3, u: [f32; 2]) -> Colour {
        let tile = |x: f32| (x / 0.7 + 0.5).floor() as i64;
        let albedo = if (tile(point.x) + tile(point.y)).rem_euclid(2) == 0 { [0.62, 0.60, 0.57] } else { [0.16, 0.17, 0.19] };
        let sun = self.sun.to_world(warp::cone(u, SUN_WIDTH));
        let shadow = if met(point, sun).is_some() { self.clear } else { 1.0 };
        // The share of the sky that the ball takes (weighed by the cosine), exactly.
        let distance = (CENTRE - point).length_squared();
        let covered = (CENTRE.z / (distance * distance.sqrt())).min(1.0) * (1.0 - self.clear);
        let sunlight = SUN_POWER * sun.z * shadow / std::f32::consts::PI;
        let light = [sunlight + 0.34 * (1.0 - covered), 0.93 * sunlight + 0.41 * (1.0 - covered), 0.82 * sunlight + 0.53 * (1.0 - covered)];
        times(albedo, light)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_across_the_ball_ends_on_its_far_side() {
        let point = met(EYE, (CENTRE + Vec3::new(0.3, 0.0, 0.2) - EYE).normalize()).expect("a hit");
        let normal = point - CENTRE;
        assert!((normal.length() - 1.0).abs() < 1e-5);
        let towards = Vec3::new(0.1, 0.9, -0.3).normalize();
        let across = CENTRE + normal + towards * (-2.0 * normal.dot(towards));
        assert!(((across - CENTRE).length() - 1.0).abs() < 1e-5);
        assert!(met(EYE, Vec3::Z).is_none());
    }
}
