//! The sky of a clear day, with its sun: Preetham, Shirley & Smits 1999.
//!
//! Places on the sky are unit vectors from the scene, z up; a profile's directions come from there, so they are looked up
//! at their opposite. Directions are made by four lobes, and the density is that of all four, everywhere:
//! the sun's disk in proportion to its radiance, the glow about it, the dome with more towards the horizon, the ground.

mod lobe;
mod perez;

use bidir_sdk::{
    Emitted, PerSolidAngle, Profile, Real, Spectrum, Vec2, Vec3,
    math::{dot, normalize, safe_sqrt, sin_cos, vec3},
    profile::Profiled,
    real::{INV_PI, ONE_MINUS_EPSILON, PI},
};
use lobe::{Cap, about_axis, at_height, dome_pdf, glow_pdf, ground_pdf, sample_dome, sample_glow};
use perez::{Perez, sunlight};

bidir_sdk::parameters! {
    /// The sky of a clear day, with its sun and a ground below the horizon.
    pub struct Sky {
        /// How much haze is in the air: 2 is a clear mountain day, 3 to 5 are usual, 10 is a hot and humid one.
        turbidity: float(min 2.0, max 10.0, label "Turbidity") = 3.0;
        /// Degrees of the sun above the horizon.
        sun_elevation: float(min 0.0, max 90.0, label "Elevation of the sun") = 40.0;
        /// Degrees about z, from x to y.
        sun_azimuth: float(min -360.0, max 360.0, label "Azimuth of the sun") = 0.0;
        /// Multiplies the light of the sun's disk; 0 leaves the disk out.
        sun_scale: float(min 0.0, max 1000.0, label "Strength of the sun") = 1.0;
        /// Half the angle of the sun's disk in degrees; the true one has 0.27. A larger disk gives the same light and softer shadows.
        sun_radius: float(min 0.1, max 20.0, label "Radius of the sun") = 0.5;
        /// Of the ground, which the sky and the sun light.
        ground_albedo: rgb(min 0.0, max 1.0, label "Ground") = [0.25, 0.22, 0.18];
        /// Radiance per kcd/m². A clear sky has 2 to 10 of them, so 0.1 suits a scene that is lit by about 1.
        scale: float(min 0.0, max 1000.0, label "Scale") = 0.1;
    }
}

/// What the parameters come to, whatever the direction.
struct Heaven {
    /// Where the sun stands.
    sun: Vec3,
    air: Perez,
    disk: Cap,
    /// Irradiance perpendicular to the sun; black without a disk.
    sunlight: Spectrum,
    ground_albedo: Spectrum,
    scale: Real,
    /// How often the disk, the glow, the dome and the ground are picked; they sum to 1.
    chances: [Real; 4],
}

const DEGREE: Real = PI / 180.0;

impl Sky {
    fn heaven(&self) -> Heaven {
        let (up, flat) = sin_cos(self.sun_elevation * DEGREE);
        let (sin_azimuth, cos_azimuth) = sin_cos(self.sun_azimuth * DEGREE);
        let from_zenith = (90.0 - self.sun_elevation) * DEGREE;
        let mut heaven = Heaven {
            sun: vec3(flat * cos_azimuth, flat * sin_azimuth, up),
            air: Perez::new(self.turbidity, from_zenith),
            disk: Cap::new(self.sun_radius * DEGREE),
            sunlight: sunlight(self.turbidity, from_zenith) * (self.sun_scale * self.scale),
            ground_albedo: self.ground_albedo,
            scale: self.scale,
            chances: [0.0; 4],
        };
        heaven.chances = heaven.guess_chances();
        heaven
    }
}

/// What the mean radiance of the sky is to that at the zenith, about.
const MEAN_TO_ZENITH: Real = 1.6;
/// More of the samples for the disk would starve the sky, whose shape varies more.
const MOST_FOR_THE_DISK: Real = 0.6;
/// What part of the sky's samples the glow about the sun gets.
const GLOW_OF_SKY: Real = 0.35;

impl Heaven {
    /// By the power of each, roughly.
    fn guess_chances(&self) -> [Real; 4] {
        let sun = self.sunlight.mean();
        let sky = MEAN_TO_ZENITH * 2.0 * PI * self.sky(Vec3::Z).mean();
        let ground = self.ground_albedo.mean() * (sky + 2.0 * self.sun.z * sun);
        let all = sun + sky + ground;
        let disk = if all > 0.0 { (sun / all).min(MOST_FOR_THE_DISK) } else { 0.0 };
        let below = if all > 0.0 { (1.0 - disk) * ground / (sky + ground) } else { 0.0 };
        let above = 1.0 - disk - below;
        [disk, above * GLOW_OF_SKY, above * (1.0 - GLOW_OF_SKY), below]
    }

    /// 1 − cos of the angle between a place and the sun, without cancellation.
    fn apart_from_sun(&self, place: Vec3) -> Real {
        let chord = place - self.sun;
        0.5 * dot(chord, chord)
    }

    /// Radiance from a place above the horizon, without the disk.
    fn sky(&self, place: Vec3) -> Spectrum {
        self.air.radiance(place.z, self.apart_from_sun(place)) * self.scale
    }

    /// Radiance of the ground: matt, lit by the disk and by the sky, whose irradiance is
    /// π ∫ L d(cos² θ) by Gauss's rule in cos² θ, at 45° and 135° from the sun.
    fn ground(&self) -> Spectrum {
        let length = (1.0 - self.sun.z * self.sun.z).max(1e-12);
        let toward = vec3(self.sun.x, self.sun.y, 0.0) / safe_sqrt(length);
        let mut mean = Spectrum::BLACK;
        for (squared, weight) in [(0.112_701_7, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.887_298_3, 5.0 / 18.0)] {
            let (z, r) = (safe_sqrt(squared), safe_sqrt(0.5 * (1.0 - squared)));
            for side in [1.0, -1.0] {
                let place = vec3(r * (side * toward.x - toward.y), r * (side * toward.y + toward.x), z);
                mean += self.sky(place) * (0.5 * weight);
            }
        }
        self.ground_albedo * (mean + self.sunlight * (self.sun.z * INV_PI))
    }

    fn look(&self, place: Vec3) -> Profiled {
        let h = self.apart_from_sun(place);
        let disk = self.disk.pdf(h);
        let radiance = if place.z > 0.0 { self.sky(place) + self.sunlight * disk } else { self.ground() };
        let densities = [disk, glow_pdf(h), dome_pdf(place.z), ground_pdf(place.z)];
        let pdf = self.chances.iter().zip(densities).map(|(chance, density)| chance * density).sum();
        Profiled { radiance, pdf: PerSolidAngle(pdf) }
    }

    fn pick(&self, u: [Real; 2]) -> Vec3 {
        let mut rest = u[0];
        let mut lobe = 0;
        while lobe < 3 && rest >= self.chances[lobe] {
            rest -= self.chances[lobe];
            lobe += 1;
        }
        let along = (rest / self.chances[lobe]).min(ONE_MINUS_EPSILON);
        match lobe {
            0 => about_axis(self.sun, self.disk.sample(along), u[1]),
            1 => about_axis(self.sun, sample_glow(along), u[1]),
            2 => at_height(sample_dome(along), u[1]),
            _ => at_height(-along, u[1]),
        }
    }
}

impl Profile for Sky {
    fn eval(&self, _: Vec2, direction: Vec3) -> Profiled {
        self.heaven().look(-direction)
    }

    fn emit(&self, _: Vec2, u: [Real; 2]) -> Option<Emitted> {
        let heaven = self.heaven();
        let place = normalize(heaven.pick(u))?;
        Some(Emitted { direction: -place, profiled: heaven.look(place) })
    }
}

bidir_sdk::light! { Sky, emits_from: [environment] }

#[cfg(test)]
mod tests {
    use super::*;

    const BIN_WIDE: Sky = Sky {
        turbidity: 3.0,
        sun_elevation: 35.0,
        sun_azimuth: 20.0,
        sun_scale: 1.0,
        sun_radius: 10.0,
        ground_albedo: Spectrum([0.3, 0.2, 0.1]),
        scale: 0.1,
    };

    fn cases() -> Vec<(String, Box<dyn Profile>)> {
        let case = |name: &str, sky: Sky| (name.to_owned(), Box::new(sky) as Box<dyn Profile>);
        vec![
            case("with its sun", BIN_WIDE),
            case("without", Sky { sun_scale: 0.0, ..BIN_WIDE }),
            case("evening", Sky { sun_elevation: 0.0, turbidity: 6.0, ..BIN_WIDE }),
            case("noon", Sky { sun_elevation: 90.0, turbidity: 2.0, ..BIN_WIDE }),
            case("haze", Sky { turbidity: 10.0, ground_albedo: Spectrum::BLACK, ..BIN_WIDE }),
            case("dark", Sky { scale: 0.0, ..BIN_WIDE }),
        ]
    }

    bidir_proof::light_tests!(cases());

    fn strata(n: u32) -> impl Iterator<Item = [Real; 2]> {
        (0..n * n).map(move |i| [((i / n) as Real + 0.5) / n as Real, ((i % n) as Real + 0.5) / n as Real])
    }

    /// ∫ L dω over the sphere, from samples, and their spread.
    fn power(sky: &Sky) -> (f64, f64) {
        let (mut sum, mut squares, n) = (0.0, 0.0, 300);
        for u in strata(n) {
            let Emitted { profiled, .. } = sky.emit(Vec2::ZERO, u).expect("the sky shines");
            let weight = f64::from(profiled.radiance.mean() / profiled.pdf.0);
            (sum, squares) = (sum + weight, squares + weight * weight);
        }
        let (n, mean) = (f64::from(n * n), sum / f64::from(n * n));
        (mean, (squares / n / mean / mean - 1.0).max(0.0).sqrt())
    }

    #[test]
    fn samples_are_made_where_the_light_is() {
        for elevation in [5.0, 20.0, 45.0, 80.0] {
            for turbidity in [2.0, 4.0, 8.0] {
                for (sun_scale, sun_radius) in [(0.0, 0.5), (1.0, 0.27), (1.0, 5.0)] {
                    let (_, spread) = power(&Sky { sun_elevation: elevation, turbidity, sun_scale, sun_radius, ..BIN_WIDE });
                    assert!(spread < 1.0, "elevation {elevation}, turbidity {turbidity}, sun {sun_scale}: {spread}");
                }
            }
        }
    }

    #[test]
    fn the_disk_adds_the_light_of_the_sun_whatever_its_radius() {
        let (without, _) = power(&Sky { sun_scale: 0.0, ground_albedo: Spectrum::BLACK, ..BIN_WIDE });
        for sun_radius in [0.27, 1.0, 10.0] {
            let sky = Sky { sun_radius, ground_albedo: Spectrum::BLACK, ..BIN_WIDE };
            let added = power(&sky).0 - without;
            let expected = f64::from(sky.heaven().sunlight.mean());
            assert!((added / expected - 1.0).abs() < 1e-2, "{sun_radius}: {added} against {expected}");
        }
    }

    #[test]
    fn the_ground_reflects_what_falls_on_it() {
        let white = Sky { ground_albedo: Spectrum::ONE, sun_radius: 0.27, ..BIN_WIDE };
        let n = 300;
        let mut irradiance = 0.0;
        for u in strata(n) {
            let Emitted { direction, profiled } = white.emit(Vec2::ZERO, u).expect("the sky shines");
            irradiance += f64::from((-direction.z).max(0.0) * profiled.radiance[1] / profiled.pdf.0);
        }
        irradiance /= f64::from(n * n);
        let leaving = f64::from(white.eval(Vec2::ZERO, Vec3::Z).radiance[1] * PI);
        assert!((leaving / irradiance - 1.0).abs() < 0.05, "{leaving} against {irradiance}");
    }

    #[test]
    fn a_clear_noon_has_a_blue_zenith_of_some_kilocandelas_and_a_yellow_evening_sun() {
        let noon = Sky { sun_elevation: 60.0, turbidity: 2.5, scale: 1.0, ..BIN_WIDE };
        let Spectrum([r, g, b]) = noon.eval(Vec2::ZERO, -Vec3::Z).radiance;
        assert!(b > 1.3 * r && (1.0..10.0).contains(&g), "{r} {g} {b}");
        let Spectrum([r, _, b]) = Sky { sun_elevation: 5.0, ..noon }.heaven().sunlight;
        assert!(r > 2.0 * b && b > 0.0, "{r} {b}");
    }
}
