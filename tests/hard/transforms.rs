//! Whole scenes, scaled, moved and turned: the picture stays.

use std::f64::consts::TAU;

use bidir::scene::{
    Scene,
    description::{Description, EmitterKind, Geometry, SensorKind},
};
use bidir_kernel::{Heuristic, Spectrum};
use glam::{DAffine3, DMat3, DQuat, DVec3};

use super::{
    Held,
    files::{ESTIMATORS, image},
};
use crate::statistics::worse;
use crate::{
    estimators::difference,
    pictures::{Subject, mean_of},
};

/// What is done to a scene.
#[derive(Clone, Copy, Debug)]
pub struct Change {
    scale: f64,
    turn: DMat3,
    /// In sizes of the scaled scene.
    away: f64,
}

impl Change {
    /// Larger by a factor.
    pub fn scaled(scale: f64) -> Self {
        Self { scale, turn: DMat3::IDENTITY, away: 0.0 }
    }

    /// So many of its sizes away.
    pub fn moved(away: f64) -> Self {
        Self { scale: 1.0, turn: DMat3::IDENTITY, away }
    }

    /// About an odd axis.
    pub fn turned(turns: f64) -> Self {
        Self { scale: 1.0, turn: DMat3::from_quat(DQuat::from_axis_angle(DVec3::new(1.0, 2.0, -1.0).normalize(), TAU * turns)), away: 0.0 }
    }

    /// The scene with all of it changed so that the picture stays: lights without a surface shine as much stronger as they are farther.
    pub fn of(&self, subject: &Description, size: f64) -> Description {
        let Self { scale, turn, away } = *self;
        let offset = DVec3::new(0.64, -0.48, 0.6) * (away * scale * size);
        let all = DAffine3::from_mat3_translation(turn * scale, offset);
        let turned = DAffine3::from_mat3(turn);
        let mut changed = subject.clone();
        for shape in &mut changed.shapes {
            let (Geometry::Mesh { to_world, .. }
            | Geometry::Rectangle { to_world, .. }
            | Geometry::Disk { to_world, .. }
            | Geometry::Sphere { to_world, .. }
            | Geometry::Cylinder { to_world, .. }) = &mut shape.geometry;
            *to_world = all * *to_world;
        }
        for instance in &mut changed.instances {
            instance.to_world = all * instance.to_world;
        }
        let stronger = |intensity: &mut Spectrum| *intensity = *intensity * (scale * scale) as f32;
        for emitter in &mut changed.emitters {
            match &mut emitter.kind {
                EmitterKind::Point { position, intensity } => {
                    *position = all.transform_point3(*position);
                    stronger(intensity);
                }
                EmitterKind::Spot { to_world, intensity, .. } => {
                    *to_world = all * *to_world;
                    stronger(intensity);
                }
                EmitterKind::Directional { direction, .. } => *direction = turn * *direction,
                EmitterKind::Constant { .. } => {}
                EmitterKind::Envmap { to_world, .. } => *to_world = turned * *to_world,
                EmitterKind::PluginPoint { .. } | EmitterKind::PluginEnvironment { .. } => {
                    panic!("no scene of these has a light like that")
                }
            }
        }
        let sensor = &mut changed.sensor;
        let position = all.transform_point3(sensor.to_world.translation);
        let axes = turn * sensor.to_world.matrix3;
        sensor.to_world = DAffine3::from_mat3_translation(axes, position);
        match &mut sensor.kind {
            SensorKind::Perspective { aperture_radius, focus_distance, .. } => {
                *aperture_radius *= scale;
                *focus_distance *= scale;
            }
            SensorKind::Orthographic => sensor.to_world.matrix3 *= scale,
        }
        for clip in [&mut sensor.near_clip, &mut sensor.far_clip].into_iter().flatten() {
            *clip *= scale;
        }
        changed
    }
}

/// What is asked of every scene.
const SCALES: [f64; 4] = [1e-6, 1e-3, 1e3, 1e6];
const AWAY: [f64; 2] = [1e3, 1e4];

/// The scene with a change.
pub fn changed(subject: &Subject, change: &Change) -> Subject {
    let bounds = bidir::rays::Geometry::bounds(subject.scene.geometry());
    let description = change.of(&subject.description, f64::from((bounds.max - bounds.min).max_element()));
    let scene = Scene::new(&description).expect("a scene");
    Subject { description, scene }
}

/// The same numbers make the same paths but for rounding, so scaled and moved pictures are the same but for the few that change side
/// at an edge.
pub fn alike(what: &str, one: &Subject, other: &Subject) -> Vec<Held> {
    let (mut means, mut pixels) = (0.0_f64, 0.0_f64);
    for (_, techniques) in ESTIMATORS {
        let (one, other) = (image(one, techniques, 64), image(other, techniques, 64));
        let mean = mean_of(&one);
        let off = one.pixels.iter().zip(&other.pixels).map(|(a, b)| f64::from((a[1] - b[1]).abs())).sum::<f64>() / one.pixels.len() as f64;
        means = worse(means, (mean_of(&other) / mean - 1.0).abs());
        pixels = worse(pixels, off / mean);
    }
    vec![
        Held::new(format!("{what}: the mean's relative change"), means, 0.01),
        Held::new(format!("{what}: the pixels' mean relative change"), pixels, 0.03),
    ]
}

/// Frames about normals do not turn with them, so turned pictures have other noise.
fn alike_but_for_noise(what: &str, one: &Subject, other: &Subject) -> Held {
    let deviations = ESTIMATORS.map(|(_, techniques)| {
        let of = |subject: &Subject, seed| subject.pictures(subject.strategy(techniques, Heuristic::Balance), 16, seed);
        let found = difference(&of(other, 1), &of(one, 2));
        found.deviation / found.threshold
    });
    Held::new(format!("{what}: deviation, as a share of what chance explains"), deviations.into_iter().fold(0.0, worse), 1.0)
}

/// All that must not change the picture.
pub fn same(name: &str, subject: &Subject) -> Vec<Held> {
    let as_it_is = changed(subject, &Change::scaled(1.0));
    let mut held = Vec::new();
    for scale in SCALES {
        held.extend(alike(&format!("{name}, scaled by {scale:e}"), &as_it_is, &changed(subject, &Change::scaled(scale))));
    }
    for away in AWAY {
        held.extend(alike(&format!("{name}, {away} sizes away"), &as_it_is, &changed(subject, &Change::moved(away))));
    }
    held.push(alike_but_for_noise(&format!("{name}, turned"), &as_it_is, &changed(subject, &Change::turned(0.21))));
    held
}
