//! Plugins inside another program: its geometry (balls on the ground), its path tracer and its sky take their materials from `.wasm` files.
//! `cargo run --release -p bidir-example-plugin` writes plugin.png.
use bidir::plugin::{Engine, Module, Roster, Sandbox, ShaderId, Strictness};
use bidir_kernel::{Bsdf, Carried, Frame, Sampler, Spectrum, Vec3, sampler::Independent};
use std::{path::Path, sync::Arc};

struct Ball(Vec3, f32, ShaderId); // centre, radius, material

/// The nearest ball along a ray: where it is met, and the normal there.
fn meet(balls: &[Ball], from: Vec3, along: Vec3) -> Option<(Vec3, Vec3, ShaderId)> {
    let distance = |ball: &Ball| {
        let to = from - ball.0;
        let (half, apart) = (to.dot(along), to.dot(to) - ball.1 * ball.1);
        let root = (half * half - apart).sqrt(); // NaN where the ray misses
        [-half - root, -half + root].into_iter().find(|t| *t > 1e-3)
    };
    let (t, ball) = balls.iter().filter_map(|ball| Some((distance(ball)?, ball))).min_by(|a, b| a.0.total_cmp(&b.0))?;
    let at = from + along * t;
    Some((at, (at - ball.0) / ball.1, ball.2))
}

const LAMP: Vec3 = Vec3::new(-6.0, 7.0, 3.0);
fn sky(along: Vec3) -> Spectrum {
    Spectrum([0.35, 0.45, 0.65]) * (0.4 + 0.6 * along.y.max(0.0))
}

/// What arrives at `from` against `along`: the lamp by next event, the sky by chance.
fn radiance(balls: &[Ball], plugins: &Sandbox, mut from: Vec3, mut along: Vec3, random: &mut Independent) -> Spectrum {
    let (mut found, mut share) = (Spectrum::BLACK, Spectrum::ONE);
    for _ in 0..8 {
        let Some((at, normal, material)) = meet(balls, from, along) else { return found + share * sky(along) };
        // A plugin is an ordinary BSDF of the kernel: directions are in the frame of the normal and point away.
        let (frame, bsdf) = (Frame::from_z(normal), plugins.bsdf(material));
        let wo = frame.to_local(-along);
        let (to_lamp, direction) = (LAMP - at, (LAMP - at).normalize());
        if meet(balls, at, direction).is_none() {
            let scatter = bsdf.eval(wo, frame.to_local(direction), Carried::Radiance);
            found += share * scatter.value * (160.0 / to_lamp.dot(to_lamp));
        }
        let Some(sample) = bsdf.sample(wo, [random.next(), random.next(), random.next()], Carried::Radiance) else { return found };
        share *= sample.weight;
        (from, along) = (at, frame.to_world(sample.wi));
    }
    found
}

const SIZE: [u32; 2] = [480, 270];
const SAMPLES: u64 = 128;

fn pixel(balls: &[Ball], plugins: &Sandbox, x: u32, y: u32) -> [u8; 3] {
    if x == 0 {
        plugins.begin_tile(u64::from(y)); // each row on fresh instances: no plugin can carry anything from row to row
    }
    let mut sum = Spectrum::BLACK;
    for i in 0..SAMPLES {
        let mut random = Independent::new(0, u64::from(y * SIZE[0] + x), i);
        let of_centre = |pixel: u32, within: f32, size: u32| (pixel as f32 + within - 0.5 * size as f32) / SIZE[1] as f32;
        let (right, down) = (of_centre(x, random.next(), SIZE[0]), of_centre(y, random.next(), SIZE[1]));
        sum += radiance(balls, plugins, Vec3::new(0.0, 1.6, 6.0), Vec3::new(right, -down - 0.12, -1.9).normalize(), &mut random);
    }
    sum.0.map(|value| (255.0 * (value / SAMPLES as f32).min(1.0).powf(1.0 / 2.2)) as u8)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (folder, engine) = (Path::new(env!("CARGO_MANIFEST_DIR")).join("../../plugins/prebuilt"), Engine::new()?);
    let load = |name: &str| Module::load(&engine, &folder.join(name)).map(Arc::new);
    let (velvet, metal, matt) = (load("velvet.wasm")?, load("thinfilm.wasm")?, load("diffuse.wasm")?);
    // All shaders, by the names that their manifests give to parameters. A wrong one is an error that says what there is.
    let mut roster = Roster::default();
    let red = roster.shader(&velvet, &[("reflectance", [0.1, 0.0, 0.01].into()), ("tint", [0.9, 0.15, 0.12].into())])?;
    let (film, grey) = (roster.shader(&metal, &[])?, roster.shader(&matt, &[])?);
    let [left, right, below] = [Vec3::new(-1.05, 1.0, 0.0), Vec3::new(1.05, 1.0, 0.0), Vec3::new(0.0, -1000.0, 0.0)];
    let balls = [Ball(left, 1.0, red), Ball(right, 1.0, film), Ball(below, 1000.0, grey)];
    // One sandbox per thread; here there is one.
    let plugins = Sandbox::new(Arc::new(roster), Strictness::Lenient);
    let picture = image::RgbImage::from_fn(SIZE[0], SIZE[1], |x, y| image::Rgb(pixel(&balls, &plugins, x, y)));
    plugins.fault().map_or(Ok(()), Err)?; // a call trapped or did not end; answers are black from there on
    plugins.quarantine().0.iter().for_each(|bad| eprintln!("{bad}")); // answers that could not be, left out
    Ok(picture.save("plugin.png")?)
}
