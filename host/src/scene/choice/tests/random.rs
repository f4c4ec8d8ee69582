//! Lights and receivers at random.

use std::sync::Arc;

use bidir_kernel::{Frame, Point, Real, Spectrum, Vec2, Vec3, math};
use bidir_standard::{Area, Constant, Directional, Isotropic, Spot};
use glam::DMat3;

use crate::{
    plugin::Sandbox,
    scene::{
        choice::shares::STEPS,
        description::Mesh,
        extent::{Ball, Ellipse, Flat, LightExtent, Parallelogram, Surface, Tube},
        lights::{LightSource, ProfileSource, Seat},
        shape::{MeshForm, Turn},
    },
};

pub fn sandbox() -> Sandbox {
    Sandbox::new(Default::default(), Default::default())
}

pub struct Random(pub u64);

impl Random {
    pub fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / STEPS as f32
    }

    pub fn cube(&mut self) -> Vec3 {
        Vec3::new(self.unit(), self.unit(), self.unit()) * 2.0 - 1.0
    }

    pub fn direction(&mut self) -> Vec3 {
        loop {
            let v = self.cube();
            if v.length_squared() < 1.0
                && let Some(direction) = math::normalize(v)
            {
                return direction;
            }
        }
    }

    /// A point of a surface that faces anywhere.
    pub fn receiver(&mut self, scale: Real) -> Point {
        let (position, normal) = (self.cube() * (1.5 * scale), self.direction());
        receiver(position, normal)
    }
}

pub fn receiver(position: Vec3, normal: Vec3) -> Point {
    Point::surface(position, normal, Frame::from_z(normal), Vec2::ZERO, 0.0)
}

pub fn point(position: Vec3, intensity: Real, sandbox: &Sandbox) -> LightSource {
    let profile = ProfileSource::Isotropic(Isotropic { intensity: Spectrum::splat(intensity) });
    LightSource::new(Seat::Point { position, frame: Frame::from_z(Vec3::Z) }, profile, sandbox)
}

/// Two triangles at an angle.
pub fn roof(center: Vec3, x: Vec3, y: Vec3, outward: Real) -> LightExtent {
    let [a, b, c, d] = [center - x, center + y * 0.4, center + x + y * 0.2, center - y];
    let positions = vec![a.to_array(), b.to_array(), c.to_array(), d.to_array()];
    let mesh = Mesh { positions, triangles: vec![[0, 1, 2], [0, 3, 1]], ..Mesh::default() };
    let corners = [[a, b, c], [a, d, b]];
    let (mut sum, mut cumulative, mut triangles) = (0.0, vec![], vec![]);
    for [p, q, r] in corners {
        let cross = (q - p).as_dvec3().cross((r - p).as_dvec3());
        sum += 0.5 * cross.length();
        cumulative.push(sum);
        triangles.push(([p, q, r], cross.normalize().as_vec3() * outward));
    }
    let form = MeshForm::new(Arc::new(mesh), Turn::of(&DMat3::IDENTITY));
    LightExtent::Surface(Surface { triangles, numbers: vec![0, 1], form, outward, cumulative, center })
}

/// Lights of every kind in a cube of 2 `scale` about `about`, of powers over three decades.
pub fn all_kinds(count: usize, scale: Real, about: Vec3, seed: u64, sandbox: &Sandbox) -> Vec<LightSource> {
    let mut random = Random(seed);
    let mut kind = |i: usize| {
        let (at, z) = (about + random.cube() * scale, random.direction());
        let size = scale * 0.2 * random.unit();
        let frame = Frame::from_z(z);
        let outward = if random.unit() < 0.5 { 1.0 } else { -1.0 };
        let level = Spectrum::splat(math::pow(1000.0, random.unit()));
        let intensity = level * (scale * scale);
        let flat = |share: Real| Flat::new(at, frame.x * size, frame.y * (0.3 * size), outward, share);
        let on = |extent: LightExtent, both: bool| {
            let profile =
                if both { ProfileSource::Isotropic(Isotropic { intensity: level }) } else { ProfileSource::Area(Area { radiance: level }) };
            LightSource::new(Seat::Shape(extent), profile, sandbox)
        };
        let both = random.unit() < 0.25;
        let axes = [frame.x, frame.y, frame.z];
        match i % 8 {
            0 => on(LightExtent::Parallelogram(Parallelogram(flat(4.0))), both),
            1 => on(LightExtent::Ellipse(Ellipse(flat(std::f32::consts::PI))), both),
            2 => on(LightExtent::Ball(Ball { center: at, radius: size, axes, outward, both_sides: false }), both),
            3 => on(LightExtent::Tube(Tube { base: at, axis: z * size, x: frame.x, radius: 0.1 * size, outward, turning: 1.0 }), both),
            4 => on(roof(at, frame.x * size, frame.y * size, outward), both),
            5 => {
                let spot = Spot { intensity, cutoff: 0.02 + 2.0 * random.unit(), beam_width: 0.0 };
                LightSource::new(Seat::Point { position: at, frame }, ProfileSource::Spot(spot), sandbox)
            }
            _ => LightSource::new(Seat::Point { position: at, frame }, ProfileSource::Isotropic(Isotropic { intensity }), sandbox),
        }
    };
    (0..count).map(&mut kind).collect()
}

/// A sky and some suns.
pub fn far(suns: usize, sandbox: &Sandbox) -> Vec<LightSource> {
    let mut random = Random(99);
    let profile = |radiance: Real| ProfileSource::Constant(Constant { radiance: Spectrum::splat(radiance) });
    let (center, radius) = (Vec3::ZERO, 4.0);
    let sky = LightSource::new(Seat::Environment { center, radius, frame: Frame::from_z(Vec3::Z) }, profile(3.0), sandbox);
    let mut sun = || {
        let irradiance = Spectrum::splat(10.0 * random.unit());
        let light = Directional { direction: random.direction(), irradiance, center, radius };
        LightSource::new(Seat::Directional(light), profile(1.0), sandbox)
    };
    std::iter::once(sky).chain((0..suns).map(|_| sun()).collect::<Vec<_>>()).collect()
}
