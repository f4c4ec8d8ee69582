//! What a page draws of a BSDF with one set of parameters.

use std::f64::consts::{PI, TAU};

use bidir_kernel::{Bsdf, Carried, Chance, Lobe, Made, Scatter, Vec3};

use super::{
    albedo, ball, heading,
    map::Map,
    polar::{Arrow, Polar, Scale},
    trouble,
};
use crate::check::{
    bridge::{Claim, Drawn, Scatterer},
    dice::{Dice, stream},
    subject::Surfaces,
};

pub(super) const LEGEND: &str = "Each row has one set of parameters: a ball of it under a sky with a sun, what it scatters in all and how much the weight \
of a sample varies, and what it scatters from 0°, 45° and 75°. The polar plots show f · |cos θ| in the plane of incidence for radiance, per \
steradian; light that is let through goes below the line. The walk comes in along the dashed line, ω_o; an arrow is a lobe into one direction with its \
chance. The discs are the hemispheres in equal area, above and below the surface: the pdf as it is told, and the samples as they fall.";

/// ω_o to draw, in degrees from the normal.
const ANGLES: [f64; 3] = [0.0, 45.0, 75.0];

/// Samples of a histogram, and those that tell a plot where to look closely.
const SAMPLES: usize = 1 << 17;
const CLOSELY: usize = 256;

/// Samples that arrows are looked for in.
const ARROWS: usize = 4096;

/// Of a row's ball, and of the large one: pixels along its side, and samples of each.
const SMALL: (usize, usize) = (168, 32);
const LARGE: (usize, usize) = (288, 48);

/// A BSDF seen from one direction.
struct Seen<'a> {
    bsdf: &'a dyn Bsdf,
    wo: Vec3,
}

impl Scatterer for Seen<'_> {
    const NOTHING: f64 = 0.0;

    fn draw(&self, dice: &mut Dice) -> Drawn {
        let sample = self.bsdf.sample(self.wo, dice.three(), Carried::Radiance);
        Drawn { direction: sample.filter(|sample| sample.lobe.intersects(Lobe::SMOOTH)).map(|sample| sample.wi), ..Drawn::default() }
    }

    fn look(&self, w: Vec3) -> Claim {
        let Scatter { value, pdf, .. } = self.bsdf.eval(self.wo, w, Carried::Radiance);
        Claim { pdf: f64::from(pdf.0), value: value.0.map(f64::from) }
    }
}

/// Towards `degrees` from the normal, on the left.
fn from(degrees: f64) -> Vec3 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    Vec3::new(-sin as f32, 0.0, cos as f32)
}

/// The large picture.
pub(super) fn picture(surfaces: &dyn Surfaces, set: usize, less: u32) -> String {
    format!("<figure class=\"large\">{}</figure>\n", sphere(surfaces, set, LARGE, less).0)
}

fn sphere(surfaces: &dyn Surfaces, set: usize, (side, samples): (usize, usize), less: u32) -> (String, Vec<String>) {
    let surface = surfaces.open();
    let clear = surfaces.promises().lobes.intersects(Lobe::TRANSMISSION);
    let uri = ball::picture(&*surface.bsdf(set), clear, side, (samples >> less).max(4));
    (format!("<img class=\"ball\" width=\"{side}\" height=\"{side}\" alt=\"a ball under a sky\" src=\"{uri}\"/>"), trouble(&*surface))
}

/// Everything of one set.
pub(super) fn row(surfaces: &dyn Surfaces, set: usize, less: u32) -> String {
    let (ball, mut notes) = sphere(surfaces, set, SMALL, less);
    let curve = {
        let surface = surfaces.open();
        let curve = albedo::figure(&*surface.bsdf(set), less, &mut Dice::new(stream(0x616c_6265, set as u64)));
        notes.extend(trouble(&*surface));
        curve
    };
    let mut views = Vec::new();
    for (at, degrees) in ANGLES.into_iter().enumerate() {
        let mut dice = Dice::new(stream(0x7061_6765, (set * ANGLES.len() + at) as u64));
        // What breaks one leaves the other.
        let (telling, drawing) = (surfaces.open(), surfaces.open());
        let (told, drawn) = (telling.bsdf(set), drawing.bsdf(set));
        let (said, drawn) = (Seen { bsdf: &*told, wo: from(degrees) }, Seen { bsdf: &*drawn, wo: from(degrees) });
        let polar = polar(&said, &drawn, degrees, &mut dice);
        views.push((degrees, polar, Map::of(&said, &drawn, SAMPLES >> less, &mut dice)));
        notes.extend(trouble(&*telling).into_iter().chain(trouble(&*drawing)));
    }
    let below = views.iter().any(|(_, polar, map)| polar.below || map.halves()[1]);
    let scale = Scale::common(views.iter().map(|(_, polar, _)| polar));
    let figures: String = views
        .into_iter()
        .map(|(degrees, polar, map)| {
            let plot = Polar { below, ..polar }.svg(&scale);
            format!("<figure>{plot}{}<figcaption>from {degrees}°</figcaption></figure>\n", map.figures(below, ""))
        })
        .collect();
    let words = scale.words(" sr<sup>−1</sup>");
    format!(
        "<section class=\"set\">\n{}<p class=\"aside\">{words}</p>\n<div class=\"figures\">\n<figure>{ball}{curve}</figure>\n{figures}</div>\n</section>\n",
        heading(&surfaces.sets()[set], &notes)
    )
}

fn polar(said: &Seen<'_>, drawn: &Seen<'_>, degrees: f64, dice: &mut Dice) -> Polar {
    let arrows = arrows(drawn, dice);
    let close = (0..CLOSELY).filter_map(|_| drawn.draw(dice).direction).map(|w| f64::from(w.x).atan2(f64::from(w.z)));
    let mut angles: Vec<f64> = (-180..180).map(|degree| f64::from(degree).to_radians()).chain(close).collect();
    angles.sort_by(f64::total_cmp);
    let towards = |angle: f64| said.look(Vec3::new(angle.sin() as f32, 0.0, angle.cos() as f32)).value;
    let values: Vec<_> = angles.into_iter().map(|angle| (angle, towards(angle))).collect();
    let under = |angle: f64| angle.abs() > 0.5 * PI;
    let below = values.iter().any(|(angle, bands)| under(*angle) && bands.iter().any(|value| *value > 0.0))
        || arrows.iter().any(|arrow| under(arrow.angle));
    let title = format!("what is scattered in the plane of incidence from {degrees}°");
    Polar { values, arrows, from: Some(-degrees.to_radians()), below, title }
}

/// The lobes into one direction, each once.
fn arrows(drawn: &Seen<'_>, dice: &mut Dice) -> Vec<Arrow> {
    let mut known: Vec<Arrow> = Vec::new();
    for _ in 0..ARROWS {
        let Some(sample) = drawn.bsdf.sample(drawn.wo, dice.three(), Carried::Radiance) else { continue };
        let Made::Delta { chance: Chance(chance), .. } = sample.made else { continue };
        let arrow = Arrow { angle: f64::from(sample.wi.x).atan2(f64::from(sample.wi.z)), chance: f64::from(chance) };
        let apart = |other: &Arrow| {
            let turn = (other.angle - arrow.angle).abs();
            turn.min(TAU - turn) > 0.01
        };
        // One that says another direction each time is no delta lobe, which its verdict tells.
        if known.len() < 6 && known.iter().all(apart) {
            known.push(arrow);
        }
    }
    known.sort_by(|a, b| a.angle.total_cmp(&b.angle));
    known
}
