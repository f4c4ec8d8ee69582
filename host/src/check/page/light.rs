//! What a page draws of a light with one set of parameters.

use std::f64::consts::PI;

use bidir_kernel::{Profile, Vec2, Vec3, profile::Profiled};

use super::{
    heading,
    map::{Map, disc, each},
    png::toned,
    polar::{Polar, Scale},
    trouble,
};
use crate::check::{
    bridge::{Claim, Drawn, Scatterer},
    dice::{Dice, stream},
    subject::Lamps,
};

pub(super) const LEGEND: &str = "Each row has one set of parameters. The polar plots show the radiance (of a point light: the intensity) that leaves \
in three planes through the axis z. The discs are the hemispheres in equal area, about +z and under it about −z, seen from +z: what leaves, in \
colours with the brightest at white; the pdf as it is told; and the samples as they fall.";

/// Planes through the axis, by their azimuth in degrees.
const PLANES: [f64; 3] = [0.0, 45.0, 90.0];

const SAMPLES: usize = 1 << 17;
const CLOSELY: usize = 256;

/// A profile at one place.
struct Spot<'a> {
    profile: &'a dyn Profile,
    uv: Vec2,
}

impl Scatterer for Spot<'_> {
    const NOTHING: f64 = 0.0;

    fn draw(&self, dice: &mut Dice) -> Drawn {
        Drawn { direction: self.profile.emit(self.uv, dice.pair()).map(|emitted| emitted.direction), ..Drawn::default() }
    }

    fn look(&self, w: Vec3) -> Claim {
        let Profiled { radiance, pdf } = self.profile.eval(self.uv, w);
        Claim { pdf: f64::from(pdf.0), value: radiance.0.map(f64::from) }
    }
}

/// Everything of one set.
pub(super) fn row(lamps: &dyn Lamps, set: usize, less: u32) -> String {
    let mut dice = Dice::new(stream(0x6c69_6768, set as u64));
    let uv = if lamps.on_surfaces() { Vec2::new(0.5, 0.5) } else { Vec2::ZERO };
    // What breaks one leaves the other.
    let (telling, drawing) = (lamps.open(), lamps.open());
    let (told, drawn) = (telling.profile(set), drawing.profile(set));
    let (said, drawn) = (Spot { profile: &*told, uv }, Spot { profile: &*drawn, uv });
    let polars = PLANES.map(|azimuth| polar(&said, &drawn, azimuth, &mut dice));
    let map = Map::of(&said, &drawn, SAMPLES >> less, &mut dice);
    let radiance = each(|w| said.look(w).value);
    let most = radiance.iter().flatten().copied().fold(0.0, f64::max);
    // The brightest is nearly white.
    let colour = |at: usize| radiance[at].map(|value| toned(2.5 * value / most.max(f64::MIN_POSITIVE)));
    let below = polars.iter().any(|polar| polar.below) || map.halves()[1];
    let scale = Scale::common(polars.iter());
    let figures: String = polars
        .into_iter()
        .zip(PLANES)
        .map(|(polar, azimuth)| {
            let plot = Polar { below, ..polar }.svg(&scale);
            format!("<figure>{plot}<figcaption>in the plane at azimuth {azimuth}°</figcaption></figure>\n")
        })
        .collect();
    let seen = format!(
        "<span><img alt=\"radiance over the sphere\" src=\"{}\"/>radiance</span>
",
        disc(below, colour)
    );
    let notes: Vec<_> = trouble(&*telling).into_iter().chain(trouble(&*drawing)).collect();
    let place = if lamps.on_surfaces() { "; at uv = (0.5, 0.5)" } else { "" };
    let words = scale.words(if lamps.on_surfaces() { " W/(m² sr)" } else { "" });
    format!(
        "<section class=\"set\">\n{}<p class=\"aside\">{words}{place}</p>\n<div class=\"figures\">\n{figures}<figure>{}</figure>\n</div>\n</section>\n",
        heading(&lamps.sets()[set], &notes),
        map.figures(below, &seen)
    )
}

fn polar(said: &Spot<'_>, drawn: &Spot<'_>, azimuth: f64, dice: &mut Dice) -> Polar {
    let (sin, cos) = azimuth.to_radians().sin_cos();
    let in_plane = |w: Vec3| (cos * f64::from(w.x) + sin * f64::from(w.y)).atan2(f64::from(w.z));
    let close = (0..CLOSELY).filter_map(|_| drawn.draw(dice).direction).map(in_plane);
    let mut angles: Vec<f64> = (-180..180).map(|degree| f64::from(degree).to_radians()).chain(close).collect();
    angles.sort_by(f64::total_cmp);
    let towards = |angle: f64| Vec3::new((angle.sin() * cos) as f32, (angle.sin() * sin) as f32, angle.cos() as f32);
    let values: Vec<_> = angles.into_iter().map(|angle| (angle, said.look(towards(angle)).value)).collect();
    let below = values.iter().any(|(angle, bands)| angle.abs() > 0.5 * PI && bands.iter().any(|value| *value > 0.0));
    let title = format!("what leaves in the plane at azimuth {azimuth}°");
    Polar { values, below, title, ..Polar::default() }
}
