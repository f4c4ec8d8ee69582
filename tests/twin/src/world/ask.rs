//! Shaders and profiles, asked one question in f64 and answering in f64.

use super::{
    super::{
        kernel::{
            Camera, Carried, Frame, Made, Point, Profile, Real, Spectrum, Vec2, Vec3,
            camera::{FilmPlane, Perspective},
            math::{vec2, vec3},
            profile::Profiled,
            warp,
        },
        standard::{Area, Constant, Envmap, Isotropic, Spot},
    },
    drawn, moved, number,
    surface::Surface,
    turned, vector,
};
use crate::{
    nudge::Nudge,
    setting::Material,
    shader::{Function, Gleam, Heading, TEXELS, texel},
};

/// The numbers of an answer, and the lobe that made it.
#[derive(Clone, Debug)]
pub struct Answer {
    /// In the order of the kernel's answer.
    pub numbers: Vec<f64>,
    /// The bits of the lobe, 0 where none is named.
    pub lobe: u32,
}

fn given(v: [f64; 3]) -> Vec3 {
    vec3(v[0] as Real, v[1] as Real, v[2] as Real)
}

fn carried(heading: Heading) -> Carried {
    match heading {
        Heading::FromCamera => Carried::Radiance,
        Heading::FromLight => Carried::Importance,
    }
}

fn answer(numbers: impl IntoIterator<Item = Real>, lobe: u32) -> Answer {
    Answer { numbers: numbers.into_iter().map(f64::from).collect(), lobe }
}

/// Value, pdf and reverse pdf.
pub fn evaluated(material: &Material, wo: [f64; 3], wi: [f64; 3], heading: Heading, nudge: &Nudge) -> Answer {
    let scatter = Surface::new(material).eval(nudge, given(wo), given(wi), carried(heading));
    answer(scatter.value.0.into_iter().chain([scatter.pdf.0, scatter.pdf_rev.0]), 0)
}

/// Direction, weight, both densities or chances, η.
pub fn sampled(material: &Material, wo: [f64; 3], u: [f64; 3], heading: Heading, nudge: &Nudge) -> Option<Answer> {
    let sampled = Surface::new(material).sample(nudge, given(wo), u.map(|u| u as Real), carried(heading))?;
    let made = match sampled.made {
        Made::Smooth { pdf, pdf_rev } => [pdf.0, pdf_rev.0],
        Made::Delta { chance, chance_rev } => [chance.0, chance_rev.0],
    };
    Some(answer(sampled.wi.to_array().into_iter().chain(sampled.weight.0).chain(made).chain([sampled.eta]), sampled.lobe.0))
}

/// Radiance and pdf.
pub fn profile_evaluated(gleam: &Gleam, direction: [f64; 3], nudge: &Nudge) -> Answer {
    let Profiled { radiance, pdf } = with(gleam, nudge, |profile| profile.eval(Vec2::ZERO, turned(nudge, given(direction))));
    answer(radiance.0.into_iter().chain([pdf.0]), 0)
}

/// Direction, radiance and pdf; those of the direction, as it was rounded.
pub fn profile_sampled(gleam: &Gleam, u: [f64; 2], nudge: &Nudge) -> Option<Answer> {
    with(gleam, nudge, |profile| {
        let emitted = profile.emit(Vec2::ZERO, drawn(nudge, u.map(|u| u as Real)))?;
        let direction = turned(nudge, emitted.direction);
        let Profiled { radiance, pdf } = if nudge.active() { profile.eval(Vec2::ZERO, direction) } else { emitted.profiled };
        Some(answer(direction.to_array().into_iter().chain(radiance.0).chain([pdf.0]), 0))
    })
}

/// A function of the kernel. Directions and points are f32's before they are asked about.
pub fn computed(function: Function, u: [f64; 5], nudge: &Nudge) -> Option<Answer> {
    let pair = drawn(nudge, [u[0] as Real, u[1] as Real]);
    let around = |u: [f64; 2]| bidir_kernel_f64::warp::sphere(u).to_array();
    let [one, other] = [around([u[0], u[1]]), around([u[2], u[3]])].map(|v| turned(nudge, vector(v)));
    let small = number(10f64.powf(-12.0 * u[4]));
    let camera = || {
        let film = FilmPlane::centred(vec2(16.0, 16.0), number(0.4));
        Perspective::pinhole(Vec3::ZERO, [Vec3::X, Vec3::Y, Vec3::Z], film)
    };
    let whole = |v: Vec3| v.to_array().to_vec();
    Some(match function {
        Function::Disk => answer(warp::disk(pair).to_array(), 0),
        Function::CosineHemisphere => answer(whole(warp::cosine_hemisphere(pair)), 0),
        Function::Sphere => answer(whole(warp::sphere(pair)), 0),
        // What lies across a narrow cone's axis is told apart from what lies along it.
        Function::Cone => {
            let v = warp::cone(pair, small);
            answer([v.x, v.y, 0.0, v.z], 0)
        }
        Function::OneMinusCos => answer([warp::one_minus_cos(small)], 0),
        Function::Triangle => answer(warp::triangle(pair).to_array(), 0),
        Function::Frame => {
            let frame = Frame::from_z(one);
            answer([whole(frame.x), whole(frame.y)].concat(), 0)
        }
        Function::TangentFrame => {
            let frame = Frame::from_z_and_tangent(one, other);
            answer([whole(frame.x), whole(frame.y)].concat(), 0)
        }
        Function::DirectionTo => {
            let far = number(10f64.powf(6.0 * u[4] - 3.0));
            let (from, to) = (moved(nudge, other), moved(nudge, other + one * far));
            let (direction, squared) = Point::free(from).direction_to(&Point::free(to))?;
            answer(whole(direction).into_iter().chain([squared]), 0)
        }
        Function::Look => {
            let seen = camera().look(vec2(pair[0], pair[1]) * 16.0, [0.5; 2]);
            answer(whole(seen.direction).into_iter().chain([seen.spread.value()]), 0)
        }
        Function::See => {
            let at = vec3(pair[0] - 0.5, pair[1] - 0.5, number(0.5 + u[2]));
            let seen = camera().see(&Point::free(at), [0.5; 2])?;
            answer([seen.raster.x, seen.raster.y, 16.0, seen.spread.value()], 0)
        }
    })
}

fn with<T>(gleam: &Gleam, nudge: &Nudge, ask: impl FnOnce(&dyn Profile) -> T) -> T {
    let bright = Spectrum([number(0.9), number(0.5), number(0.2)]);
    match *gleam {
        Gleam::Area => ask(&Area { radiance: bright }),
        Gleam::Isotropic => ask(&Isotropic { intensity: bright }),
        Gleam::Constant => ask(&Constant { radiance: bright }),
        Gleam::Spot { cutoff, beam } => ask(&Spot { intensity: bright, cutoff: number(cutoff), beam_width: number(beam) }),
        Gleam::Envmap => {
            let [width, height] = TEXELS;
            let texels: Vec<Spectrum> = (0..width * height).map(|i| Spectrum(texel(i).map(number))).collect();
            let sizes = Envmap::sizes(width, height);
            let (mut rows, mut columns) = (vec![0.0; sizes.rows], vec![0.0; sizes.columns]);
            assert!(Envmap::fill(width, height, &texels, &mut rows, &mut columns), "tables of the right length");
            // A cumulative table in f32 is rounded at its own size, which is up to 1.
            rows.iter_mut().chain(&mut columns).for_each(|entry| *entry = nudge.random(f64::from(*entry)) as Real);
            ask(&Envmap::new(width, height, &texels, &rows, &columns).expect("tables of the right length"))
        }
    }
}
