//! Shader by shader: f32 against f64, at random inputs and at corners.

use std::ops::Range;

use crate::{
    Held,
    case::MATERIALS,
    double::world as double,
    held::relative,
    nudge::Nudge,
    setting::{Material, Slopes, rounded},
    single::world as single,
};

/// A function of the kernel that directions, points and frames come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Function {
    /// Square → disk.
    Disk,
    /// Square → hemisphere.
    CosineHemisphere,
    /// Square → sphere.
    Sphere,
    /// Square → cone; how open it is from 1 down to 1e-12.
    Cone,
    /// sin² → 1 − cos, down to 1e-12.
    OneMinusCos,
    /// Square → triangle.
    Triangle,
    /// A frame about a direction.
    Frame,
    /// A frame about a direction, along another one.
    TangentFrame,
    /// From a point to another one 1e-3 … 1e3 away, and the square of its distance.
    DirectionTo,
    /// Raster → a pinhole's direction and its density.
    Look,
    /// A direction → a pinhole's raster and its density.
    See,
}

/// All of them.
pub const FUNCTIONS: [Function; 11] = [
    Function::Disk,
    Function::CosineHemisphere,
    Function::Sphere,
    Function::Cone,
    Function::OneMinusCos,
    Function::Triangle,
    Function::Frame,
    Function::TangentFrame,
    Function::DirectionTo,
    Function::Look,
    Function::See,
];

/// What a walk that asks a surface carries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Heading {
    /// Radiance.
    FromCamera,
    /// Importance.
    FromLight,
}

/// An emission profile of the standard crate.
#[derive(Clone, Copy, Debug)]
pub enum Gleam {
    /// Of a surface.
    Area,
    /// Of a point.
    Isotropic,
    /// Of the surroundings.
    Constant,
    /// Half angles in radians.
    Spot {
        /// Of the cone.
        cutoff: f64,
        /// Of its part without falloff.
        beam: f64,
    },
    /// An image of the surroundings.
    Envmap,
}

/// The image's width and height.
pub const TEXELS: [usize; 2] = [12, 7];

/// A texel of the image: over three decades, none of them black.
pub fn texel(index: usize) -> [f64; 3] {
    let numbers = Numbers(index as u64);
    [0, 1, 2].map(|band| 10f64.powf(3.0 * numbers.at(band) - 1.0))
}

/// Runs of the f64 shader with moved inputs; and as many where those do not explain a difference, since a few moves at random
/// may all be small, or miss an edge that lies near.
const FEW: u64 = 8;
const MANY: u64 = 512;

/// What differences are measured in is never less than this, relatively: a few operations of f32.
const FLOOR: f64 = 4.0 * f32::EPSILON as f64;

/// In such units: no chain of operations in a shader is longer.
const BOUND: f64 = 8.0;

/// The kernel's lobes that have a density.
const SMOOTH: u32 = bidir_kernel_f64::Lobe::SMOOTH.0;

/// Random inputs per surface and per profile.
const SAMPLES: u64 = 1_500;

/// Surfaces over many parameters.
pub fn surfaces() -> Vec<(String, Material)> {
    let mut found: Vec<(String, Material)> = MATERIALS.iter().map(|(name, material)| ((*name).to_owned(), *material)).collect();
    for slopes in [Slopes::Ggx, Slopes::Beckmann] {
        for alphas in [[1e-4; 2], [1e-4, 1.0], [0.01; 2], [1.0; 2]] {
            found.push((format!("rough conductor {slopes:?} {alphas:?}"), Material::RoughConductor((slopes, alphas))));
            for eta in [1.05, 0.7, 2.4] {
                found.push((format!("rough dielectric {eta} {slopes:?} {alphas:?}"), Material::RoughDielectric(eta, (slopes, alphas))));
            }
        }
    }
    for eta in [1.0, 1.000_001, 0.999_999, 0.6, 2.4] {
        found.push((format!("dielectric {eta}"), Material::Dielectric(eta)));
        found.push((format!("thin dielectric {eta}"), Material::ThinDielectric(eta)));
    }
    found.extend([1.0, 1.05, 1.9].map(|eta| (format!("plastic {eta}"), Material::Plastic(eta))));
    found
}

/// Profiles over many parameters.
pub fn profiles() -> Vec<(String, Gleam)> {
    let spots = [(0.5, 0.3), (1e-3, 5e-4), (3.1, 1.0), (0.2, 0.2)];
    let spots = spots.map(|(cutoff, beam)| (format!("spot {cutoff} {beam}"), Gleam::Spot { cutoff, beam }));
    let plain = [("area", Gleam::Area), ("isotropic", Gleam::Isotropic), ("constant", Gleam::Constant), ("envmap", Gleam::Envmap)];
    plain.map(|(name, gleam)| (name.to_owned(), gleam)).into_iter().chain(spots).collect()
}

/// `eval` of a surface: value and densities.
pub fn evaluated(name: &str, material: &Material) -> Held {
    let mut worst = Worst::new("eval", name);
    for (wo, wi) in pairs() {
        for heading in [Heading::FromCamera, Heading::FromLight] {
            let exact = double::evaluated(material, wo, wi, heading, &still());
            let moved = |nudge: &Nudge| Some(double::evaluated(material, wo, wi, heading, nudge));
            let found = single::evaluated(material, wo, wi, heading, &still());
            worst.see(Some(&found.numbers), Some(&exact), &moved, &[0..3, 3..4, 4..5], || format!("wo {wo:?}, wi {wi:?}, {heading:?}"));
        }
    }
    worst.held()
}

/// `sample` of a surface: direction, weight, densities or chances, η, and which lobe. Numbers at the ends of their range
/// lead to where a distribution has its far tails, and nothing of a direction is left of f32; what is then said of the direction
/// that is returned is held against f64 all the same.
pub fn sampled(name: &str, material: &Material) -> Held {
    let mut worst = Worst::new("sample", name);
    for Draw { wo, u, end } in draws() {
        for heading in [Heading::FromCamera, Heading::FromLight] {
            let found = single::sampled(material, wo, u, heading, &still());
            let asked = || format!("wo {wo:?}, u {u:?}, {heading:?}");
            if let Some(found) = found.as_ref().filter(|found| found.lobe & SMOOTH != 0) {
                let wi = [found.numbers[0], found.numbers[1], found.numbers[2]];
                let exact = double::evaluated(material, wo, wi, heading, &still());
                let moved = |nudge: &Nudge| Some(double::evaluated(material, wo, wi, heading, nudge));
                let [pdf, pdf_rev] = [found.numbers[6], found.numbers[7]];
                let values = [3, 4, 5].map(|band| found.numbers[band] * pdf);
                worst.see(Some(&[&values[..], &[pdf, pdf_rev]].concat()), Some(&exact), &moved, &[0..3, 3..4, 4..5], asked);
            }
            let exact = double::sampled(material, wo, u, heading, &still());
            let smooth = |lobe: Option<u32>| lobe.is_some_and(|lobe| lobe & SMOOTH != 0);
            if end && (smooth(found.as_ref().map(|found| found.lobe)) || smooth(exact.as_ref().map(|exact| exact.lobe))) {
                continue;
            }
            let moved = |nudge: &Nudge| double::sampled(material, wo, u, heading, nudge);
            // Whichever lobe: another one is another answer.
            let same = found.as_ref().zip(exact.as_ref()).is_none_or(|(a, b)| a.lobe == b.lobe);
            let numbers = found.as_ref().filter(|_| same).map(|found| &found.numbers[..]);
            worst.see(numbers, exact.as_ref(), &moved, &[0..3, 3..6, 6..7, 7..8, 8..9], asked);
        }
    }
    worst.held()
}

/// `eval` of a profile: radiance and density.
pub fn profile_evaluated(name: &str, gleam: &Gleam) -> Held {
    let mut worst = Worst::new("profile's eval", name);
    for (direction, _) in pairs() {
        let exact = double::profile_evaluated(gleam, direction, &still());
        let moved = |nudge: &Nudge| Some(double::profile_evaluated(gleam, direction, nudge));
        let found = single::profile_evaluated(gleam, direction, &still());
        worst.see(Some(&found.numbers), Some(&exact), &moved, &[0..3, 3..4], || format!("{direction:?}"));
    }
    worst.held()
}

/// `emit` of a profile: direction, radiance and density.
pub fn profile_sampled(name: &str, gleam: &Gleam) -> Held {
    let mut worst = Worst::new("emit", name);
    for Draw { u: [x, y, _], .. } in draws() {
        let exact = double::profile_sampled(gleam, [x, y], &still());
        let moved = |nudge: &Nudge| double::profile_sampled(gleam, [x, y], nudge);
        let found = single::profile_sampled(gleam, [x, y], &still());
        let numbers = found.as_ref().map(|found| &found.numbers[..]);
        worst.see(numbers, exact.as_ref(), &moved, &[0..3, 3..6, 6..7], || format!("u {:?}", [x, y]));
    }
    worst.held()
}

/// A function of the kernel, over random numbers in [0, 1) that it makes its inputs of.
pub fn computed(function: Function) -> Held {
    let mut worst = Worst::new("kernel", &format!("{function:?}"));
    for i in 0..SAMPLES {
        let u = [0, 1, 2, 3, 4].map(|place| Numbers(i).at(place));
        let exact = double::computed(function, u, &still());
        let moved = |nudge: &Nudge| double::computed(function, u, nudge);
        let found = single::computed(function, u, &still());
        let numbers = found.as_ref().map(|found| &found.numbers[..]);
        let count = exact.as_ref().map_or(0, |exact| exact.numbers.len());
        worst.see(numbers, exact.as_ref(), &moved, &[0..count.min(3), count.min(3)..count], || format!("u {u:?}"));
    }
    worst.held()
}

/// Nothing moves.
fn still() -> Nudge {
    Nudge::new(None)
}

/// The worst answer of one shader.
struct Worst {
    measure: &'static str,
    name: String,
    asked: u64,
    edges: u64,
    score: f64,
    what: String,
}

impl Worst {
    fn new(measure: &'static str, name: &str) -> Self {
        Self { measure, name: name.to_owned(), asked: 0, edges: 0, score: 0.0, what: String::new() }
    }

    /// Scores an answer by a few moved ones, or by many.
    fn see(
        &mut self,
        found: Option<&[f64]>,
        exact: Option<&double::Answer>,
        moved: &dyn Fn(&Nudge) -> Option<double::Answer>,
        groups: &[Range<usize>],
        asked: impl Fn() -> String,
    ) {
        self.asked += 1;
        let moves = |count: u64| (0..count).map(|k| moved(&Nudge::new(Some(self.asked * count + k)))).collect::<Vec<_>>();
        let mut scored = score(found, exact, &moves(FEW), groups);
        if scored.as_ref().is_some_and(|(score, _)| *score > 0.5 * BOUND) {
            scored = score(found, exact, &moves(MANY), groups);
        }
        let Some((score, group)) = scored else {
            self.edges += 1;
            return;
        };
        if !(score <= self.score) {
            let said = |numbers: Option<&[f64]>| format!("{:?}", numbers.map(|numbers| &numbers[group.clone()]));
            let (single, double) = (said(found), said(exact.map(|exact| &exact.numbers[..])));
            self.what = format!("{}, numbers {group:?}: {single} in f32, {double} in f64", asked());
            self.score = score;
        }
    }

    fn held(self) -> Held {
        let what = format!("{}, {}", self.name, self.what);
        Held { measure: self.measure, worst: self.score, bound: BOUND, parted: self.edges as f64 / self.asked as f64, what }
    }
}

/// The worst group of numbers that belong together, in units of what moved inputs explain. `None` where they lead to another
/// lobe or to nothing: which one it is is for rounding to say.
fn score(
    found: Option<&[f64]>,
    exact: Option<&double::Answer>,
    moved: &[Option<double::Answer>],
    groups: &[Range<usize>],
) -> Option<(f64, Range<usize>)> {
    let nothing = |numbers: &[f64]| numbers[groups[0].clone()].iter().all(|x| *x == 0.0);
    let kind = |answer: Option<&double::Answer>| answer.map(|answer| (answer.lobe, nothing(&answer.numbers)));
    if moved.iter().any(|answer| kind(answer.as_ref()) != kind(exact)) {
        return None;
    }
    let (Some(found), Some(exact)) = (found, exact) else {
        let worst = if found.is_some() || exact.is_some() { f64::INFINITY } else { 0.0 };
        return Some((worst, groups[0].clone()));
    };
    let scored = groups.iter().map(|group| {
        let off = |numbers: &[f64]| relative(&numbers[group.clone()], &exact.numbers[group.clone()]);
        let unit = moved.iter().flatten().map(|answer| off(&answer.numbers)).fold(FLOOR, f64::max);
        let worst = off(found) / unit;
        (if worst.is_nan() { f64::INFINITY } else { worst }, group.clone())
    });
    scored.max_by(|a, b| a.0.total_cmp(&b.0))
}

/// Numbers in [0, 1) of 24 bits, by place.
struct Numbers(u64);

impl Numbers {
    fn at(&self, place: u32) -> f64 {
        use bidir_kernel_f64::sampler::{Independent, Sampler, Walk};
        let mut numbers = Independent::new(7, 0, self.0);
        numbers.seek(Walk::Camera, place);
        numbers.next()
    }
}

/// The unit direction with this cosine and azimuth, as f32 holds it.
fn direction(cos: f64, phi: f64) -> [f64; 3] {
    let sin = ((1.0 - cos) * (1.0 + cos)).sqrt();
    [sin * phi.cos(), sin * phi.sin(), cos].map(rounded)
}

/// From the normal to grazing, on both sides.
const COSINES: [f64; 12] = [1.0, 0.999_999, 0.99, 0.6, 0.1, 1e-3, 1e-5, -1e-5, -1e-3, -0.3, -0.999, -1.0];

/// Any two directions, pairs near mirrored and refracted ones, and corners.
fn pairs() -> Vec<([f64; 3], [f64; 3])> {
    let mut pairs = Vec::new();
    for i in 0..SAMPLES {
        let n = Numbers(i);
        let wo = direction(2.0 * n.at(0) - 1.0, 6.3 * n.at(1));
        // So narrow lobes are met too.
        let near = 10f64.powf(-5.0 * n.at(2));
        let [x, y, z] = wo;
        let (dx, dy, eta) = (near * (n.at(3) - 0.5), near * (n.at(4) - 0.5), 0.5 + 2.0 * n.at(5));
        let wi = match i % 3 {
            0 => direction(2.0 * n.at(3) - 1.0, 6.3 * n.at(4)),
            1 => unit([dx - x, dy - y, z]),
            _ => refracted(wo, eta).map_or_else(|| unit([dx - x, dy - y, z]), |[x, y, z]| unit([x + dx, y + dy, z])),
        };
        pairs.push((wo, wi));
    }
    for a in COSINES {
        for b in COSINES {
            for phi in [0.3, 0.3 + std::f64::consts::PI, 2.0] {
                pairs.push((direction(a, 0.3), direction(b, phi)));
            }
        }
    }
    pairs
}

/// A question to `sample`.
struct Draw {
    wo: [f64; 3],
    u: [f64; 3],
    /// Whether one of the numbers lies at an end of its range.
    end: bool,
}

/// Any direction and grazing ones with any numbers, and with numbers at their ends.
fn draws() -> Vec<Draw> {
    let mut draws = Vec::new();
    for i in 0..SAMPLES {
        let n = Numbers(i);
        let cos = if i % 2 == 0 { 2.0 * n.at(0) - 1.0 } else { COSINES[i as usize / 2 % COSINES.len()] };
        draws.push(Draw { wo: direction(cos, 6.3 * n.at(1)), u: [n.at(2), n.at(3), n.at(4)], end: false });
    }
    let ends = [0.0, 1.0 / 16_777_216.0, 0.5, 0.75, 1.0 - 1.0 / 16_777_216.0];
    for cos in COSINES {
        for x in ends {
            for y in ends {
                draws.extend([0.0, 0.5, ends[4]].map(|z| Draw { wo: direction(cos, 0.3), u: [x, y, z], end: true }));
            }
        }
    }
    draws
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    v.map(|x| rounded(x / length))
}

fn refracted([x, y, z]: [f64; 3], eta: f64) -> Option<[f64; 3]> {
    let squared = 1.0 - (x * x + y * y) / (eta * eta);
    (squared > 0.0).then(|| [-x / eta, -y / eta, -z.signum() * squared.sqrt()])
}
