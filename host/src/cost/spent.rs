//! Where the time of a render goes: its parts, each measured alone on the same random numbers, so that their rays must add up to the
//! whole's exactly.

use std::sync::{Arc, atomic::AtomicBool};

use bidir_kernel::{Contribution, Film as _, Spectrum, Technique, Techniques, Vec2};
use cpu_time::{ProcessTime, ThreadTime};
use serde::{Deserialize, Serialize};

use super::{
    casts::{self, PerRay},
    subject::{Subject, whole},
};
use crate::{
    error::Result,
    film::{Exposure, Film, Store},
    plan::{Stage, words},
    render::{self, Always, Auto, Target},
    scene::view::RayCounts,
};

/// Renders of each part, of which the fastest counts: what else the machine does only ever adds.
const ROUNDS: u32 = 3;

/// About how many times as long as one render of every technique all of this takes.
pub(super) const RENDERS: f64 = 12.0;

/// Where time went.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Spent {
    /// What was rendered.
    pub words: String,
    /// Its parts, in CPU seconds; joins that cannot be timed apart from their walk are in it.
    pub parts: Vec<Part>,
    /// Rays of the whole, and of all its parts.
    pub rays: Rays,
}

/// A part of a render.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Part {
    /// Which.
    pub name: String,
    /// CPU seconds.
    pub seconds: f64,
    /// How much of that its rays take; the rest is what is made of where they end.
    pub tracing: f64,
    /// Its own rays.
    pub rays: Option<RayCounts>,
}

/// Rays of a render.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Rays {
    /// Of the whole.
    pub counted: RayCounts,
    /// Of its parts, each rendered alone.
    pub predicted: RayCounts,
}

/// What a stage's samples cost, and their rays.
#[derive(Clone, Copy, Debug, Default)]
struct Cost {
    seconds: f64,
    rays: RayCounts,
}

/// Takes a plan's render apart: so many samples per pixel, with a pilot such as `auto` would send ahead.
///
/// # Errors
/// If the film cannot be made, or a plugin broke off.
pub fn spent(subject: &Subject, stage: &Stage, samples: u32, interrupt: &Arc<AtomicBool>) -> Result<Spent> {
    let techniques = stage.techniques();
    let Techniques { light_hit, next_event, connection, lens_splat, lens_hit } = techniques;
    let of = |techniques: Techniques| {
        let some = techniques.camera_walk() || techniques.light_walk();
        if some { cost(subject, &Stage::of(&techniques), samples, interrupt) } else { Ok(Cost::default()) }
    };
    let all = of(techniques)?;
    let bare = of(Techniques { light_hit, ..Techniques::NONE })?;
    let path = of(Techniques { light_hit, next_event, ..Techniques::NONE })?;
    let shown = of(Techniques { lens_splat, lens_hit, ..Techniques::NONE })?;
    let walk = of(Techniques { lens_hit, ..Techniques::NONE })?;
    let unconnected = of(Techniques { connection: 0.0, ..techniques })?;
    // With the same light walks, or other pairs would be joined.
    let connected = of(Techniques { light_hit: 0.0, next_event: 0.0, ..techniques })?;
    let joins = connected.rays.any.saturating_sub(shown.rays.any);
    let film = film(subject, samples)?;
    let (pilot, [in_camera_paths, in_light_paths, in_connections]) = pilot(subject, stage, samples);
    let per_ray = |techniques: Techniques, cast: RayCounts| casts::per_ray(subject, techniques, cast, interrupt);
    let of_path = per_ray(Techniques { light_hit, next_event, ..Techniques::NONE }, path.rays);
    let of_shown = per_ray(Techniques { lens_splat, lens_hit, ..Techniques::NONE }, shown.rays);

    let rays = |closest: u64, any: u64| RayCounts { closest, any };
    let mut parts = Vec::new();
    let mut part = |name: &str, seconds: f64, rays: RayCounts, each: PerRay| {
        let (seconds, tracing) = (seconds.max(0.0), rays.closest as f64 * each.closest + rays.any as f64 * each.any);
        parts.push(Part { name: name.to_owned(), seconds, tracing: tracing.min(seconds), rays: Some(rays) });
    };
    if techniques.camera_walk() {
        let calls = in_camera_paths.min(path.seconds);
        let left = 1.0 - calls / path.seconds.max(f64::MIN_POSITIVE);
        // Where no light can be landed on, nobody walks for that alone.
        let alone = if next_event > 0.0 && bare.rays.closest > 0 { bare.seconds.min(path.seconds) } else { path.seconds };
        part("camera walk", left * alone - film, rays(path.rays.closest, 0), of_path);
        part("next event", left * (path.seconds - alone), rays(0, path.rays.any), of_path);
    }
    if techniques.light_walk() {
        let left = 1.0 - in_light_paths.min(shown.seconds) / shown.seconds.max(f64::MIN_POSITIVE);
        // Where no lens can be landed on, nobody walks for that alone.
        let alone = if walk.rays.closest > 0 { walk.seconds.min(shown.seconds) } else { shown.seconds };
        part("light walk", left * alone, rays(shown.rays.closest, 0), of_shown);
        part("lens splat", left * (shown.seconds - alone), rays(0, shown.rays.any), of_shown);
    }
    if connection > 0.0 {
        let each = per_ray(Techniques { connection, ..Techniques::NONE }, rays(0, joins));
        part("connections", all.seconds - unconnected.seconds - in_connections, rays(0, joins), each);
    }
    let calls = in_camera_paths + in_light_paths + in_connections;
    let rayless = [("plugins", calls), ("film", film), ("plan", pilot)];
    parts.extend(rayless.map(|(name, seconds)| Part { name: name.to_owned(), seconds, tracing: 0.0, rays: None }));
    parts.retain(|part| part.seconds > 0.0 || part.rays.is_some_and(|rays| rays != RayCounts::default()));
    let predicted = rays(path.rays.closest + shown.rays.closest, path.rays.any + shown.rays.any + if connection > 0.0 { joins } else { 0 });
    Ok(Spent { words: format!("{}, {samples} samples per pixel", words::stage(stage)), parts, rays: Rays { counted: all.rays, predicted } })
}

/// A render of some techniques: the same numbers each time, so the same rays.
fn cost(subject: &Subject, stage: &Stage, samples: u32, interrupt: &Arc<AtomicBool>) -> Result<Cost> {
    let manner = subject.manner(stage);
    let mut best = Cost { seconds: f64::INFINITY, ..Cost::default() };
    for _ in 0..ROUNDS {
        let film = Film::new(&subject.description.film)?;
        let job = subject.job(&manner, 0, Target::Samples(samples));
        let status = render::directed(&subject.scene, &film, &job, &mut Always, interrupt, |_| None);
        whole(&status)?;
        best = Cost { seconds: best.seconds.min(status.cpu.as_secs_f64()), rays: status.rays };
    }
    Ok(best)
}

/// CPU seconds of what the film does with so many samples that all bring something.
fn film(subject: &Subject, samples: u32) -> Result<f64> {
    let mut best = f64::INFINITY;
    for _ in 0..ROUNDS {
        let film = Film::new(&subject.description.film)?;
        let clock = ThreadTime::now();
        while let Some(mut buffer) = film.claim(samples) {
            for (x, y) in film.pixels(&buffer.unit()) {
                buffer.begin(Vec2::new(x as f32 + 0.25, y as f32 + 0.75));
                buffer.add(Contribution { value: Spectrum::ONE, weight: 1.0, technique: Technique { s: 0, t: 2 } });
                buffer.end();
            }
            film.commit(buffer);
        }
        best = best.min(clock.elapsed().as_secs_f64());
    }
    Ok(best)
}

/// CPU seconds of a pilot, and of plugins' calls in the camera paths, light paths and connections of a render of that stage.
fn pilot(subject: &Subject, stage: &Stage, samples: u32) -> (f64, [f64; 3]) {
    let mut auto = Auto::new(&subject.description, &subject.effects);
    let clock = ProcessTime::now();
    auto.begin(&subject.scene, &subject.job(&subject.manner(stage), 0, Target::Samples(samples)));
    let pilot = clock.elapsed().as_secs_f64();
    let crop = subject.description.film.crop;
    let all = 1e-9 * f64::from(samples) * f64::from(crop.width) * f64::from(crop.height);
    let mut plugins = [0.0; 3];
    for plugin in auto.choice().iter().flat_map(|choice| &choice.plugins) {
        for (time, calls) in plugins.iter_mut().zip(plugin.calls_in.split(stage)) {
            *time += all * plugin.nanoseconds * calls;
        }
    }
    (pilot, plugins)
}
