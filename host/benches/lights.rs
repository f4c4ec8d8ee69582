//! What the choice among lights is worth, and costs: `cargo bench -p bidir --bench lights [-- few|city|million]`.
//!
//! `city`: 100,000 lamps of very different powers along streets, chosen down the tree and by power; both render one picture with the
//! integrator `path`, in turn, and are held against a long render. Efficiency is 1/(relMSE · CPU seconds). `few`: CPU time per path, and
//! per choice, from one light on. `million`: how long a tree over a million lights takes to build. Figures are medians; times are CPU time
//! of one thread.

use std::{hint::black_box, path::Path, sync::atomic::AtomicBool, time::Instant};

use bidir::{
    compare::compare,
    film::Film,
    image::Image,
    load,
    plugin::{Library, Sandbox, Strictness},
    render::{self, Job, Numbers, Target},
    scene::{
        Scene,
        choice::Lights,
        description::Description,
        lights::{LightSource, ProfileSource, Seat},
    },
};
use bidir_kernel::{Frame, Heuristic, Point, Spectrum, Strategy, Techniques, Vec2, Vec3};
use bidir_standard::Isotropic;
use cpu_time::ThreadTime;

const ROUNDS: usize = 7;
const SIDE: u32 = 64;

fn main() {
    let filter = std::env::args().skip(1).find(|word| !word.starts_with('-')).unwrap_or_default();
    let parts: [(&str, fn()); 3] = [("few", few), ("city", city), ("million", million)];
    parts.into_iter().filter(|(name, _)| name.contains(&filter)).for_each(|(_, part)| part());
}

fn city() {
    const SAMPLES: [u32; 2] = [8, 16];
    const REFERENCE: u32 = 1024;
    let start = Instant::now();
    let description = read(&streets(100_000));
    let tree = Scene::new(&description).expect("a scene");
    let power = Scene::new(&description).expect("a scene").with_lights_by_power();
    println!("100,000 lamps in a city; both scenes read and built in {:.1} s", start.elapsed().as_secs_f64());
    let (reference, seconds) = image(&description, &tree, REFERENCE, 1 << 32);
    println!("reference: {REFERENCE} samples in {seconds:.0} s");
    let scenes = [("tree", &tree, SAMPLES[0]), ("power", &power, SAMPLES[1])];
    let mut found = [const { Vec::new() }; 2];
    for seed in 0..ROUNDS as u64 {
        for ((_, scene, samples), rounds) in scenes.iter().zip(&mut found) {
            let (image, seconds) = image(&description, scene, *samples, seed);
            let comparison = compare(&image, &reference).expect("one size");
            rounds.push([seconds, comparison.relmse, comparison.relmse_trimmed, comparison.mean_ratio]);
        }
    }
    println!("{:<8}{:>8}{:>10}{:>12}{:>12}{:>12}{:>10}", "", "samples", "ns/path", "relMSE", "trimmed", "efficiency", "mean");
    let mut efficiencies = vec![];
    for ((name, _, samples), rounds) in scenes.iter().zip(&found) {
        let of = |i: usize| median(rounds.iter().map(|round: &[f64; 4]| round[i]).collect());
        let efficiency = |i: usize| median(rounds.iter().map(|round| 1.0 / (round[0] * round[i])).collect());
        let per_path = of(0) * 1e9 / f64::from(samples * SIDE * SIDE);
        print!("{name:<8}{samples:>8}{per_path:>10.0}{:>12.3e}{:>12.3e}", of(1), of(2));
        println!("{:>12.3e}{:>10.4}", efficiency(1), of(3));
        efficiencies.push([efficiency(1), efficiency(2)]);
    }
    let ratio = |i: usize| efficiencies[0][i] / efficiencies[1][i];
    println!("the tree has {:.1} × the efficiency of the choice by power, {:.1} × trimmed", ratio(0), ratio(1));
}

fn few() {
    const SAMPLES: u32 = 64;
    println!("{:<8}{:>14}{:>14}{:>12}{:>12}", "lights", "ns/path", "by power", "ns/pick", "ns/chance");
    for count in [1, 4, 16, 17, 100, 1000, 10_000] {
        let description = read(&streets(count));
        let each = Scene::new(&description).expect("a scene");
        let power = Scene::new(&description).expect("a scene").with_lights_by_power();
        let mut times = [const { Vec::new() }; 2];
        for seed in 0..ROUNDS as u64 {
            for (scene, times) in [&each, &power].into_iter().zip(&mut times) {
                times.push(image(&description, scene, SAMPLES, seed).1 * 1e9 / f64::from(SAMPLES * SIDE * SIDE));
            }
        }
        let [each_time, power_time] = times.map(median);
        let (pick, chance) = calls(each.all_lights());
        println!("{count:<8}{each_time:>14.0}{power_time:>14.0}{pick:>12.0}{chance:>12.0}");
    }
}

/// Nanoseconds of one choice, and of asking for its chance.
fn calls(lights: &Lights) -> (f64, f64) {
    const COUNT: usize = 1 << 14;
    let sandbox = Sandbox::new(Default::default(), Strictness::Strict);
    let mut random = Random(5);
    let receivers: Vec<(Point, f32)> = (0..COUNT)
        .map(|_| {
            let position = Vec3::new(160.0 * random.unit() - 80.0, 0.0, 160.0 * random.unit() - 80.0);
            (Point::surface(position, Vec3::Y, Frame::from_z(Vec3::Y), Vec2::ZERO, 0.0), random.unit())
        })
        .collect();
    let picked: Vec<_> = receivers.iter().map(|(lit, u)| lights.pick(Some(lit), *u, &sandbox).map(|(id, _)| id)).collect();
    let time = |call: &dyn Fn(usize) -> f32| {
        let rounds = (0..ROUNDS).map(|_| {
            let start = ThreadTime::now();
            black_box((0..COUNT).map(call).sum::<f32>());
            start.elapsed().as_secs_f64() * 1e9 / COUNT as f64
        });
        rounds.fold(f64::INFINITY, f64::min)
    };
    let pick = time(&|i| lights.pick(Some(&receivers[i].0), receivers[i].1, &sandbox).map_or(0.0, |(_, chance)| chance.0));
    let chance = time(&|i| picked[i].map_or(0.0, |id| lights.chance(id, Some(&receivers[i].0), &sandbox).0));
    (pick, chance)
}

fn million() {
    let sandbox = Sandbox::new(Default::default(), Strictness::Strict);
    let mut random = Random(7);
    let profile = ProfileSource::Isotropic(Isotropic { intensity: Spectrum::ONE });
    let start = ThreadTime::now();
    let mut source = || {
        let position = Vec3::new(random.unit(), 0.1 * random.unit(), random.unit()) * 1000.0;
        LightSource::new(Seat::Point { position, frame: Frame::from_z(Vec3::Z) }, profile.clone(), &sandbox)
    };
    let sources: Vec<_> = (0..1_000_000).map(|_| source()).collect();
    let measured = start.elapsed().as_secs_f64();
    let start = ThreadTime::now();
    let lights = Lights::new(sources).0;
    let built = start.elapsed().as_secs_f64();
    println!("a million points: {measured:.1} s to measure their profiles, {built:.2} s to build the choice among them");
    let (pick, chance) = calls(&lights);
    println!("{pick:.0} ns/pick, {chance:.0} ns/chance");
}

fn image(description: &Description, scene: &Scene, samples: u32, seed: u64) -> (Image, f64) {
    let film = Film::new(&description.film).expect("a film");
    let job = Job {
        strategy: Strategy { techniques: Techniques::PATH, heuristic: Heuristic::Balance, max_depth: 4, rr_depth: 5 },
        seed,
        numbers: Numbers::default(),
        threads: 1,
        target: Target::Samples(samples),
        width: description.film.width,
        strictness: Strictness::Strict,
    };
    let status = render::render(scene, &film, &job, &AtomicBool::new(false), |_| None);
    assert!(status.fault.is_none() && status.samples == samples, "{:?}", status.fault);
    (film.develop(), status.cpu.as_secs_f64())
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn read(xml: &str) -> Description {
    load::load_str(xml, Path::new("bench.xml"), None, &[], &Library::default()).expect("a scene").description
}

struct Random(u64);

impl Random {
    fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 * 2.0_f32.powi(-24)
    }
}

/// Houses on a square of 160 m, and so many lamps above the streets and on the walls: panels that face down, and points; powers are
/// spread evenly over three decades of their logarithm.
fn streets(lamps: usize) -> String {
    let mut random = Random(11);
    let mut text = format!(
        r#"<scene version="3.0.0"><sensor type="perspective"><float name="fov" value="60"/>
            <film type="hdrfilm"><integer name="width" value="{SIDE}"/><integer name="height" value="{SIDE}"/><rfilter type="box"/></film>
            <transform name="to_world"><lookat origin="0, 9, 60" target="0, 2, 0" up="0, 1, 0"/></transform></sensor>
        <bsdf type="diffuse" id="stone"><rgb name="reflectance" value="0.5, 0.45, 0.4"/></bsdf>
        <bsdf type="diffuse" id="road"><rgb name="reflectance" value="0.25, 0.25, 0.27"/></bsdf>
        <shape type="rectangle"><transform name="to_world"><rotate x="1" angle="-90"/><scale value="80"/></transform><ref id="road"/></shape>"#
    );
    for (i, j) in (0..8).flat_map(|i| (0..8).map(move |j| (i, j))) {
        let (x, z, height) = (20.0 * i as f32 - 70.0, 20.0 * j as f32 - 70.0, 2.0 + 5.0 * random.unit());
        text += &format!(
            r#"<shape type="cube"><transform name="to_world"><scale value="6, {height}, 6"/><translate value="{x}, {height}, {z}"/>
                </transform><ref id="stone"/></shape>"#
        );
    }
    for i in 0..lamps {
        // A street every 20 m, 8 m wide, along x or z.
        let (along, across) = (160.0 * random.unit() - 80.0, 20.0 * (9.0 * random.unit()).floor() - 80.0 + 7.6 * (random.unit() - 0.5));
        let (x, z) = if random.unit() < 0.5 { (along, across) } else { (across, along) };
        let (x, y, z) = (x.clamp(-79.0, 79.0), 0.5 + 5.0 * random.unit(), z.clamp(-79.0, 79.0));
        let power = 1000.0_f32.powf(random.unit());
        if i % 2 == 0 {
            let level = 2.0 * power;
            text += &format!(
                r#"<shape type="rectangle"><transform name="to_world"><rotate x="1" angle="90"/><scale value="0.05"/>
                    <translate value="{x}, {y}, {z}"/></transform><ref id="stone"/>
                    <emitter type="area"><rgb name="radiance" value="{level}, {level}, {level}"/></emitter></shape>"#
            );
        } else {
            let level = 0.01 * power;
            text += &format!(
                r#"<emitter type="point"><point name="position" value="{x}, {y}, {z}"/>
                    <rgb name="intensity" value="{level}, {level}, {level}"/></emitter>"#
            );
        }
    }
    text + "</scene>"
}
