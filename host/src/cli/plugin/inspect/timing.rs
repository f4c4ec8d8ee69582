//! How long a module's calls take.

use std::{f32::consts::TAU, hint::black_box, sync::Arc, time::Instant};

use bidir_kernel::{Bsdf, Carried, Lobe, Profile, Vec2, Vec3};
use serde::Serialize;

use crate::{
    error::Result,
    plugin::{Kind, Module, Quarantine, Roster, Sandbox, ShaderId, Strictness},
};

/// Nanoseconds and microseconds, each the median of its batches.
#[derive(Debug, Serialize)]
pub(super) struct Timing {
    pub(super) calls: Vec<Call>,
    /// A fresh instance in place of the last one, as every tile has it.
    pub(super) instantiation_microseconds: f64,
}

/// One export.
#[derive(Debug, Serialize)]
pub(super) struct Call {
    pub(super) export: &'static str,
    pub(super) nanoseconds: f64,
}

const BATCHES: usize = 15;
const QUESTIONS: usize = 4096;
const INSTANCES: u64 = 100;

/// Asks a module what a render asks, all of its parameters at their defaults, and gives the answers that were left out with the times.
///
/// # Errors
/// If a call breaks off.
pub(super) fn measure(module: &Arc<Module>) -> Result<(Timing, Quarantine)> {
    let mut roster = Roster::default();
    let shader = roster.shader(module, &[])?;
    let sandbox = Sandbox::new(Arc::new(roster), Strictness::Lenient);
    sandbox.begin_tile(0);
    let calls = match module.manifest().kind {
        Kind::Bsdf => bsdf(&sandbox, shader, module.manifest().lobes()),
        Kind::Light => light(&sandbox, shader),
    };
    let instantiation = median(INSTANCES as usize, || {
        for tile in 0..INSTANCES {
            sandbox.begin_tile(tile);
            // An instance is made when it is first asked; this asks nothing.
            sandbox.set(shader, []);
        }
    });
    match sandbox.fault() {
        Some(fault) => Err(fault.into()),
        None => Ok((Timing { calls, instantiation_microseconds: instantiation * 1e-3 }, sandbox.quarantine())),
    }
}

fn bsdf(sandbox: &Sandbox, shader: ShaderId, lobes: Lobe) -> Vec<Call> {
    let bsdf = sandbox.bsdf(shader);
    let through = lobes.intersects(Lobe::TRANSMISSION);
    let pairs: Vec<_> = (0..QUESTIONS)
        .map(|i| {
            let [a, b, c, d] = numbers(i);
            let below = if through && i % 2 == 1 { -1.0 } else { 1.0 };
            let (wo, wi) = (direction(a, b), direction(c, d));
            (wo, Vec3::new(wi.x, wi.y, below * wi.z), [b, c, d])
        })
        .collect();
    let eval = median(QUESTIONS, || {
        for (wo, wi, _) in &pairs {
            black_box(bsdf.eval(*wo, *wi, Carried::Radiance));
        }
    });
    let sample = median(QUESTIONS, || {
        for (wo, _, u) in &pairs {
            black_box(bsdf.sample(*wo, *u, Carried::Radiance));
        }
    });
    vec![
        Call { export: bidir_abi::export::BSDF_EVAL, nanoseconds: eval },
        Call { export: bidir_abi::export::BSDF_SAMPLE, nanoseconds: sample },
    ]
}

fn light(sandbox: &Sandbox, shader: ShaderId) -> Vec<Call> {
    let profile = sandbox.profile(shader);
    let questions: Vec<_> = (0..QUESTIONS)
        .map(|i| {
            let [a, b, c, d] = numbers(i);
            (Vec2::new(a, b), direction(c, d), [c, d])
        })
        .collect();
    let eval = median(QUESTIONS, || {
        for (uv, w, _) in &questions {
            black_box(profile.eval(*uv, *w));
        }
    });
    let emit = median(QUESTIONS, || {
        for (uv, _, u) in &questions {
            black_box(profile.emit(*uv, *u));
        }
    });
    vec![
        Call { export: bidir_abi::export::LIGHT_EVAL, nanoseconds: eval },
        Call { export: bidir_abi::export::LIGHT_EMIT, nanoseconds: emit },
    ]
}

/// Numbers in [0, 1), spread evenly: multiples of powers of the inverse of the root of x⁵ = x + 1.
fn numbers(i: usize) -> [f32; 4] {
    const ROOT: f64 = 1.167_303_978_261_418_7;
    [1, 2, 3, 4].map(|power| ((0.5 + i as f64 / ROOT.powi(power)).fract() as f32).min(1.0 - f32::EPSILON))
}

/// A direction on the front, as often at one cosine as at another.
fn direction(u: f32, v: f32) -> Vec3 {
    let z = 1.0 - u;
    let r = (1.0 - z * z).max(0.0).sqrt();
    let (sin, cos) = (TAU * v).sin_cos();
    Vec3::new(r * cos, r * sin, z)
}

/// Nanoseconds of one of the `count` things that `batch` does.
fn median(count: usize, mut batch: impl FnMut()) -> f64 {
    batch();
    let mut times: Vec<_> = (0..BATCHES)
        .map(|_| {
            let start = Instant::now();
            batch();
            start.elapsed().as_secs_f64() * 1e9 / count as f64
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[BATCHES / 2]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn questions_are_asked_about_unit_vectors_on_the_front() {
        for i in 0..QUESTIONS {
            let [a, b, ..] = numbers(i);
            let w = direction(a, b);
            let squared = w.x * w.x + w.y * w.y + w.z * w.z;
            assert!((squared - 1.0).abs() < 1e-5 && w.z > 0.0, "{w:?}");
        }
    }
}
