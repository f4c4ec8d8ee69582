//! Shader by shader: f32 against f64, at random inputs and at corners.

mod inputs;
mod worst;

use crate::{
    Held,
    case::MATERIALS,
    double::world as double,
    nudge::Nudge,
    setting::{Material, Slopes},
    single::world as single,
};
use inputs::{Draw, Numbers, SAMPLES, draws, pairs};
use worst::Worst;

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

/// The kernel's lobes that have a density.
const SMOOTH: u32 = bidir_kernel_f64::Lobe::SMOOTH.0;

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
