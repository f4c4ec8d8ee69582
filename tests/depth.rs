//! How far paths go: no light is lost where they end, where storage ends, or where roulette ends them.

use std::sync::atomic::AtomicBool;

use bidir::{
    film::{Exposure, Film, Store},
    plugin::Strictness,
    render,
    scene::view::View,
};
use bidir_kernel::{Heuristic, Sampler, Strategy, Vec2, Walk, sample, sampler::Independent};

use crate::{
    pictures::{BATCHES, BDPT, LIGHT, PATH, Subject, mean_of},
    scenes::*,
    statistics::{Estimate, assert_is, threshold},
};

/// A ball of radius 1 and albedo ρ that shines with radiance 1 − ρ: seen from within, it is 1.
fn bright_ball(depth_: i32) -> Subject {
    let content = r#"<boolean name="flip_normals" value="true"/>"#.to_owned()
        + &diffuse("0.9, 0.9, 0.9")
        + &emitter("area", &rgb("radiance", "0.1, 0.1, 0.1"));
    let transform = r#"<transform name="to_world"><lookat origin="0.3, 0, 0" target="1, 0, 0.1" up="0, 1, 0"/></transform>"#;
    let sensor = format!(r#"<sensor type="perspective">{}{}{transform}</sensor>"#, float("fov", 100.0), film(2));
    read(&[depth(depth_), sensor, shape("sphere", "", &content)].concat())
}

#[test]
fn depth_0_is_black() {
    let subject = bright_ball(0);
    for techniques in [PATH, LIGHT, BDPT] {
        assert_eq!(mean_of(&subject.image(&subject.job(subject.strategy(techniques, Heuristic::Balance), 16, 1))), 0.0);
    }
}

#[test]
fn depth_1_shows_emitters_only() {
    let subject =
        read(&[depth(1), pinhole(), room(), panel_of("rectangle"), shape("sphere", r#"<scale value="0.5"/>"#, &area(2.0))].concat());
    let path = subject.image(&subject.job(subject.strategy(PATH, Heuristic::Balance), 64, 1));
    assert!(path.pixels.iter().all(|p| p[0] <= 12.0 && (p[0] == 0.0 || (p[1] / p[0] - 0.9).abs() < 1e-5)));
    assert!(mean_of(&path) > 0.0 && path.pixels.contains(&[0.0; 3]));
}

/// Σ 0.1 · 0.9^(k−1) up to k = 20, and without end: most of the light comes by long paths.
#[test]
fn long_paths_bring_all_their_light() {
    for depth_ in [20, -1] {
        let wanted = if depth_ < 0 { 1.0 } else { 1.0 - 0.9_f64.powi(depth_) };
        let subject = bright_ball(depth_);
        for (name, techniques, samples) in [("path", PATH, 2048), ("light", LIGHT, 4096), ("bdpt", BDPT, 256)] {
            let found = subject.pictures(subject.strategy(techniques, Heuristic::Balance), samples, 1);
            assert_is(&format!("depth {depth_}, {name}"), &found.mean(found.whole(), &[0, 1, 2]), wanted, 6, 0.01);
        }
    }
}

/// The kernel with storage for `stored` light vertices.
fn with_storage(subject: &Subject, strategy: &Strategy, stored: usize, samples: u32, seed: u64) -> f64 {
    let film = Film::new(&subject.description.film).expect("a film");
    let view = View::new(&subject.scene, Strictness::Strict);
    let [mut seen, mut lit] = [0; 2].map(|_| (0..stored).map(|_| None).collect::<Vec<_>>());
    while let Some(mut buffer) = film.claim(samples) {
        let unit = buffer.unit();
        for (x, y) in film.pixels(&unit) {
            let mut numbers = Independent::new(seed, u64::from(y * 2 + x), u64::from(unit.sample));
            numbers.seek(Walk::Camera, 0);
            let [dx, dy] = numbers.next_pair();
            let raster = Vec2::new(x as f32 + dx, y as f32 + dy);
            buffer.begin(raster);
            sample(&view, strategy, &mut numbers, raster, &mut seen, &mut lit, &mut buffer);
            buffer.end();
        }
        film.commit(buffer);
    }
    mean_of(&film.develop())
}

/// Paths longer than what was stored are left to s = 0 and s = 1, whose weights know it.
#[test]
fn any_storage_brings_all_the_light() {
    let subject = bright_ball(-1);
    for heuristic in [Heuristic::Balance, Heuristic::Power] {
        let strategy = subject.strategy(BDPT, heuristic);
        for stored in [0, 1, 2, 3, 8] {
            let batch = |seed| with_storage(&subject, &strategy, stored, 192, 50 + u64::from(seed));
            let found = Estimate::of(&(0..BATCHES).map(batch).collect::<Vec<_>>());
            assert_is(&format!("{stored} stored, {heuristic:?}"), &found, 1.0, 10, 0.02);
        }
    }
}

/// Roulette from the first vertex on, against next to none.
#[test]
fn roulette_loses_nothing() {
    let subject = read(&[depth(12), pinhole(), room(), ball(&bsdf("dielectric", "")), panel()].concat());
    for (name, techniques, samples) in [("path", PATH, 64), ("light", LIGHT, 64), ("bdpt", BDPT, 16)] {
        let [early, late] = [(1, 1), (1000, 2)].map(|(rr_depth, seed)| {
            let found = subject.pictures(Strategy { rr_depth, ..subject.strategy(techniques, Heuristic::Balance) }, samples, seed);
            found.mean(found.whole(), &[0, 1, 2])
        });
        let apart = early.minus(&late);
        let (deviation, limit) = (apart.deviation(late.mean), threshold(3, apart.degrees));
        println!("{name}: {:.5} and {:.5}, {deviation:.2} σ of {limit:.2}", early.mean, late.mean);
        assert!(deviation < limit && apart.error < 0.02 * late.mean, "{name}: {early:?} {late:?}");
    }
}

/// Ctrl-C ends a render after the sample under way, for every pixel.
#[test]
fn an_interrupted_render_is_whole() {
    let subject = bright_ball(6);
    let film = Film::new(&subject.description.film).expect("a film");
    let job = subject.job(subject.strategy(BDPT, Heuristic::Balance), 1000, 1);
    let interrupt = AtomicBool::new(false);
    let status = render::render(&subject.scene, &film, &job, &interrupt, |status| {
        interrupt.store(status.samples >= 4, std::sync::atomic::Ordering::Relaxed);
        None
    });
    assert!(status.interrupted && status.samples < 1000 && film.samples() == u64::from(status.samples) * 4);
    assert_eq!(film.develop(), subject.image(&subject.job(job.strategy, status.samples, 1)));
}
