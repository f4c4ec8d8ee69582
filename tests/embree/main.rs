//! Our rays against Embree's: `cargo bench -p bidir-embree [-- LIBRARY [MESH]]`, where LIBRARY is Embree's shared library if it is not installed
//! where libraries are (Debian has it in `libembree-dev`, the Python package `embreex` brings one).
//!
//! One thread, the same meshes and the same rays; rounds alternate between the two, times are the thread's CPU time, and a ratio is
//! the median over rounds of Embree's time over ours: above 1 we are faster. Embree builds with its best quality.

mod embree;

use std::hint::black_box;

use bidir::rays::{Bvh, Geometry, Primitives, Triangles, Visibility::Everywhere};
use bidir_embree::{Mesh, Rays, hall, kitchen, rays, statue, thicket};
use bidir_kernel::{Ray, Vec3};
use cpu_time::{ProcessTime, ThreadTime};
use embree::{Embree, Scene};

const ROUNDS: usize = 11;
const SIDE: usize = 384;

/// A mesh, where it is seen from and towards, and its size.
type Subject = (&'static str, fn() -> Mesh, [Vec3; 2], f32);

fn main() {
    let mut words = std::env::args().skip(1).filter(|word| !word.starts_with('-'));
    let (library, filter) = (words.next(), words.next().unwrap_or_default());
    let embree = match Embree::load(library.as_deref()) {
        Ok(embree) => embree,
        Err(why) => return println!("{why}\ninstall it, or name its library after --"),
    };
    println!("against Embree {}, one thread", embree.version.map(|part| part.to_string()).join("."));
    let subjects: [Subject; 4] = [
        ("kitchen", kitchen, [Vec3::new(2.6, 1.9, 1.6), Vec3::new(-1.0, 1.2, -0.6)], 6.0),
        ("thicket", thicket, [Vec3::new(0.0, 1.8, 4.5), Vec3::new(0.0, 0.8, 0.0)], 6.0),
        ("statue", statue, [Vec3::new(0.6, 0.8, 3.2), Vec3::new(0.0, 0.0, 0.0)], 2.0),
        ("hall", hall, [Vec3::new(8.9, 2.0, 8.9), Vec3::new(-2.0, 2.5, -3.0)], 20.0),
    ];
    let mut all = [vec![], vec![]];
    for (name, make, view, size) in subjects.into_iter().filter(|(name, ..)| name.contains(&filter)) {
        let ratios = compare(&embree, name, &make(), view, size);
        for (all, ratios) in all.iter_mut().zip(ratios) {
            all.extend(ratios);
        }
    }
    for (mode, ratios) in ["robust", "fast"].iter().zip(&all) {
        let mean = (ratios.iter().map(|ratio| ratio.ln()).sum::<f64>() / ratios.len() as f64).exp();
        let least = ratios.iter().copied().fold(f64::INFINITY, f64::min);
        println!("against Embree's {mode} mode: geometric mean {mean:.3}, least {least:.3}");
    }
}

fn compare(embree: &Embree, name: &str, mesh: &Mesh, [eye, target]: [Vec3; 2], size: f32) -> [Vec<f64>; 2] {
    let start = ProcessTime::now();
    let mut primitives = Primitives::new();
    primitives.reserve_triangles(mesh.triangles.len());
    for triangle in &mesh.triangles {
        primitives.triangle(triangle.map(|corner| mesh.vertices[corner as usize]), Everywhere);
    }
    let ours = Bvh::build(primitives);
    let build = start.elapsed().as_secs_f64();
    let theirs = [true, false].map(|robust| {
        let scene = embree.scene(&mesh.vertices, &mesh.triangles, robust).expect("an Embree scene");
        let start = ProcessTime::now();
        scene.build().expect("an Embree tree");
        (scene, start.elapsed().as_secs_f64())
    });
    let fast = ours.clone().with_triangles(Triangles::Fast);
    let stats = ours.stats();
    println!("\n{name}, {} triangles; {:.1} bytes each", mesh.triangles.len(), stats.bytes as f64 / stats.primitives as f64);
    println!("build {build:.2} s ({:.2} s of wall clock); Embree's {:.2} s robust, {:.2} s fast", stats.seconds, theirs[0].1, theirs[1].1);
    println!("{:<16}{:>11}{:>9}{:>8}{:>11}{:>9}{:>8}", "ns per ray", "watertight", "robust", "ratio", "ours, fast", "fast", "ratio");
    let bounce = |ray: &Ray| {
        let hit = ours.closest(ray)?;
        let point = ours.surface(ray, &hit);
        let normal = if point.normal.dot(ray.direction) > 0.0 { -point.normal } else { point.normal };
        Some((point.position + normal * point.offset, normal))
    };
    let mut ratios = [vec![], vec![]];
    for set in rays(eye, target, size, SIDE, bounce) {
        agree(&ours, &theirs[0].0, &set);
        let round =
            || [time(&set, &Ours(&ours)), time(&set, &Theirs(&theirs[0].0)), time(&set, &Ours(&fast)), time(&set, &Theirs(&theirs[1].0))];
        let rounds: Vec<[f64; 4]> = (0..ROUNDS).map(|_| round()).collect();
        let [own, robust, own_fast, fast] = [0, 1, 2, 3].map(|i| median(rounds.iter().map(|round| round[i])));
        let against = [0, 2].map(|i| median(rounds.iter().map(|round| round[i + 1] / round[i])));
        let [one, two] = against;
        println!("{:<16}{own:>11.1}{robust:>9.1}{one:>8.3}{own_fast:>11.1}{fast:>9.1}{two:>8.3}", set.name);
        for (all, ratio) in ratios.iter_mut().zip(against) {
            all.push(ratio);
        }
    }
    ratios
}

/// Something that casts rays.
trait Caster {
    fn closest(&self, ray: &Ray) -> u32;
    fn occluded(&self, ray: &Ray) -> bool;
}

struct Ours<'a>(&'a Bvh);
struct Theirs<'a>(&'a Scene<'a>);

impl Caster for Ours<'_> {
    #[inline(always)]
    fn closest(&self, ray: &Ray) -> u32 {
        self.0.closest(ray).map_or(0, |hit| hit.primitive.0)
    }
    #[inline(always)]
    fn occluded(&self, ray: &Ray) -> bool {
        self.0.occluded(ray)
    }
}

impl Caster for Theirs<'_> {
    #[inline(always)]
    fn closest(&self, ray: &Ray) -> u32 {
        self.0.closest(ray).map_or(0, |(primitive, _)| primitive)
    }
    #[inline(always)]
    fn occluded(&self, ray: &Ray) -> bool {
        self.0.occluded(ray)
    }
}

/// Nanoseconds per ray.
fn time(set: &Rays, caster: &impl Caster) -> f64 {
    let start = ThreadTime::now();
    let sum = if set.any {
        set.rays.iter().fold(0, |sum: u32, ray| sum.wrapping_add(u32::from(caster.occluded(ray))))
    } else {
        set.rays.iter().fold(0, |sum: u32, ray| sum.wrapping_add(caster.closest(ray)))
    };
    black_box(sum);
    start.elapsed().as_secs_f64() * 1e9 / set.rays.len() as f64
}

/// Both see the same things; rays that pass an edge may differ.
fn agree(ours: &Bvh, theirs: &Scene, set: &Rays) {
    let differ = |ray: &&Ray| {
        if set.any {
            return ours.occluded(ray) != theirs.occluded(ray);
        }
        match (ours.closest(ray), theirs.closest(ray)) {
            (Some(hit), Some((_, t))) => (hit.t - t).abs() > 1e-4 * t.max(1e-2),
            (hit, other) => hit.is_some() != other.is_some(),
        }
    };
    let differing = set.rays.iter().filter(differ).count();
    assert!(differing * 1000 <= set.rays.len(), "{}: {differing} of {} rays differ", set.name, set.rays.len());
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
