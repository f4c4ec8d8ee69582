//! How long a ray takes: `cargo bench -p bidir --bench rays [-- FILTER]` prints nanoseconds per ray.
//!
//! Coherent rays come from a pinhole in scan order; random rays join random points of random surfaces, as connections do.

use std::{f32::consts::TAU, hint::black_box, sync::Arc, time::Instant};

use bidir::rays::{Bvh, Cylinder, Geometry, Instance, Parallelogram, Primitives, Sphere, Visibility::Everywhere};
use bidir_kernel::{Ray, Segment, Vec3};
use glam::{DAffine3, DMat3, DVec3};

const RAYS: usize = 1 << 18;
const ROUNDS: usize = 15;

fn main() {
    let filter = std::env::args().skip(1).find(|word| !word.starts_with('-')).unwrap_or_default();
    println!("{:<22}{:>9}{:>9}{:>9}{:>9}   build", "ns per ray", "coherent", "bounces", "segments", "any hit");
    type Scene = (&'static str, fn() -> Primitives);
    let scenes: [Scene; 6] = [
        ("box, 6 + 10 + 12", cornell),
        ("box and analytics", analytic),
        ("blob, 5k", || blob(50)),
        ("blob, 50k", || blob(158)),
        ("blob, 1M", || blob(707)),
        ("a million blobs of 10k", million),
    ];
    for (name, make) in scenes.into_iter().filter(|(name, _)| name.contains(&filter)) {
        let bvh = Bvh::build(make());
        let (coherent, bounces, segments) = rays(&bvh);
        let times = [
            time(&coherent, |ray| bvh.closest(ray).map_or(0, |hit| hit.primitive.0)),
            time(&bounces, |ray| bvh.closest(ray).map_or(0, |hit| hit.primitive.0)),
            time(&segments, |ray| bvh.closest(ray).map_or(0, |hit| hit.primitive.0)),
            time(&segments, |ray| u32::from(bvh.occluded(ray))),
        ];
        print!("{name:<22}");
        times.iter().for_each(|time| print!("{time:>9.1}"));
        let stats = bvh.stats();
        let per_primitive = stats.bytes as f64 / stats.primitives as f64;
        print!("   {:.3} s, {} nodes, {} packets, {per_primitive:.0} bytes each", stats.seconds, stats.nodes, stats.packets);
        println!("{}", peak().map_or_else(String::new, |peak| format!("; {peak} MB at most so far")));
    }
}

/// The most memory that this process has had, MB; `None` where the system does not say.
fn peak() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.split_whitespace().next()?.parse().ok().map(|kilobytes: u64| kilobytes / 1024)
}

/// The least over some rounds: what the machine does besides can only add.
fn time(rays: &[Ray], cast: impl Fn(&Ray) -> u32) -> f64 {
    let rounds = (0..ROUNDS).map(|_| {
        let start = Instant::now();
        let sum = rays.iter().fold(0_u32, |sum, ray| sum.wrapping_add(cast(ray)));
        black_box(sum);
        start.elapsed().as_secs_f64() * 1e9 / rays.len() as f64
    });
    rounds.fold(f64::INFINITY, f64::min)
}

struct Random(u64);

impl Random {
    fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 * 2.0_f32.powi(-24)
    }

    fn direction(&mut self) -> Vec3 {
        let (z, angle) = (2.0 * self.unit() - 1.0, TAU * self.unit());
        let r = (1.0 - z * z).sqrt();
        Vec3::new(r * angle.cos(), r * angle.sin(), z)
    }
}

/// From a pinhole; off the hit points; between two hit points.
fn rays(bvh: &Bvh) -> (Vec<Ray>, Vec<Ray>, Vec<Ray>) {
    let mut random = Random(1);
    let side = (RAYS as f64).sqrt() as usize;
    let ray = |origin, direction| Ray { origin, direction, t_max: f32::INFINITY, segment: Segment::Inner };
    let coherent: Vec<Ray> = (0..side * side)
        .map(|i| {
            let (x, y) = ((i % side) as f32 / side as f32 - 0.5, (i / side) as f32 / side as f32 - 0.5);
            ray(Vec3::new(0.01, 0.02, 3.4), Vec3::new(0.8 * x, 0.8 * y, -1.0).normalize())
        })
        .collect();
    let mut ends = vec![];
    let mut bounces = vec![];
    let mut current = coherent[0];
    for i in (0..).map(|i: usize| i.wrapping_mul(7919) % coherent.len()) {
        let Some(hit) = bvh.closest(&current) else {
            current = coherent[i];
            continue;
        };
        let at = bvh.surface(&current, &hit);
        let normal = if at.normal.dot(current.direction) < 0.0 { at.normal } else { -at.normal };
        let spawn = at.position + normal * at.offset;
        current = ray(spawn, (normal + random.direction() * 0.999).normalize());
        ends.push(spawn);
        bounces.push(current);
        if bounces.len() == RAYS {
            break;
        }
    }
    let segments = (0..RAYS)
        .map(|i| {
            let (from, to) = (ends[i], ends[(i + 4321) % RAYS]);
            Ray { origin: from, direction: to - from, t_max: 1.0, segment: Segment::Inner }
        })
        .collect();
    (coherent, bounces, segments)
}

/// A hundred a side of the same blob, each turned another way.
fn million() -> Primitives {
    const SIDE: usize = 100;
    let blob = Arc::new(Bvh::build(blob(71)));
    let mut random = Random(2);
    let mut all = Primitives::new();
    for i in 0..SIDE * SIDE * SIDE {
        let cell = DVec3::new((i % SIDE) as f64, (i / SIDE % SIDE) as f64, (i / SIDE / SIDE) as f64);
        let turn = DMat3::from_axis_angle(random.direction().as_dvec3().normalize(), f64::from(TAU * random.unit()));
        let matrix3 = turn * (0.4 / SIDE as f64);
        let to_world = DAffine3 { matrix3, translation: (cell + 0.5) * (2.0 / SIDE as f64) - 1.0 };
        all.instance(Instance::new(Arc::clone(&blob), to_world).expect("an inverse"), Everywhere);
    }
    all
}

/// Six walls (one open), a lamp, two blocks of triangles: a box as everybody has it.
fn cornell() -> Primitives {
    let mut all = walls();
    block(&mut all, Vec3::new(-0.35, -0.4, -0.3), Vec3::new(0.3, 0.6, 0.3), 0.3);
    block(&mut all, Vec3::new(0.35, -0.7, 0.3), Vec3::new(0.3, 0.3, 0.3), -0.3);
    all
}

fn analytic() -> Primitives {
    let mut all = walls();
    block(&mut all, Vec3::new(-0.35, -0.4, -0.3), Vec3::new(0.3, 0.6, 0.3), 0.3);
    all.sphere(Sphere { centre: Vec3::new(0.35, -0.7, 0.3), radius: 0.3 }, Everywhere);
    all.sphere(Sphere { centre: Vec3::new(0.35, 0.0, -0.3), radius: 0.2 }, Everywhere);
    let (p0, p1) = (Vec3::new(-0.5, 0.4, 0.4), Vec3::new(0.5, 0.5, 0.4));
    all.cylinder(Cylinder { p0, p1, x: Vec3::Y, radius: 0.05 }, Everywhere);
    all
}

fn walls() -> Primitives {
    let mut all = Primitives::new();
    let mut wall = |corner: Vec3, x: Vec3, y: Vec3| all.parallelogram(Parallelogram { corner, x, y }, Everywhere);
    let (x, y, z, low) = (Vec3::X * 2.0, Vec3::Y * 2.0, Vec3::Z * 2.0, Vec3::splat(-1.0));
    wall(low, x, z);
    wall(low + y, x, z);
    wall(low, x, y);
    wall(low, y, z);
    wall(low + x, y, z);
    wall(Vec3::new(-0.25, 0.99, -0.25), Vec3::X * 0.5, Vec3::Z * 0.5);
    all
}

/// A turned box of twelve triangles.
fn block(all: &mut Primitives, centre: Vec3, half: Vec3, angle: f32) {
    let turn = |v: Vec3| Vec3::new(v.x * angle.cos() + v.z * angle.sin(), v.y, v.z * angle.cos() - v.x * angle.sin());
    for axis in 0..3 {
        for sign in [-1.0, 1.0] {
            let corner = |a: f32, b: f32| {
                let mut v = Vec3::ZERO;
                v[axis] = sign;
                v[(axis + 1) % 3] = a;
                v[(axis + 2) % 3] = b;
                centre + turn(v * half)
            };
            let [a, b, c, d] = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
            all.triangle([a, b, c], Everywhere);
            all.triangle([a, c, d], Everywhere);
        }
    }
}

/// A bumpy sphere of 2 · rings · 2 · rings triangles, roughly.
fn blob(rings: usize) -> Primitives {
    let at = |ring: usize, sector: usize| {
        let (theta, phi) = (0.5 * TAU * ring as f32 / rings as f32, TAU * (sector % rings) as f32 / rings as f32);
        let v = Vec3::new(theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin());
        let bump = |f: f32| ((v.x * f + 1.0).sin() * (v.y * f * 1.1 + 2.0).sin() * (v.z * f * 0.9 + 3.0).sin()) / f;
        v * (0.8 + 0.6 * bump(4.0) + 0.9 * bump(17.0) + 0.9 * bump(61.0))
    };
    let mut all = Primitives::new();
    for ring in 0..rings {
        for sector in 0..rings {
            let [a, b, c, d] = [at(ring, sector), at(ring + 1, sector), at(ring + 1, sector + 1), at(ring, sector + 1)];
            if ring > 0 {
                all.triangle([a, d, c], Everywhere);
            }
            if ring + 1 < rings {
                all.triangle([a, c, b], Everywhere);
            }
        }
    }
    all
}
