//! What may not change a picture, and what must change it in one way only.

use bidir::{
    film::Film,
    image::Image,
    plugin::Strictness,
    render::{self, Job, Numbers, Target},
};
use bidir_kernel::{Heuristic, Strategy, Techniques};
use std::sync::atomic::AtomicBool;

use crate::{
    pictures::{BDPT, LIGHT, PATH, Subject, mean_of},
    scenes::*,
    statistics::threshold,
};

const ESTIMATORS: [Techniques; 3] = [PATH, LIGHT, BDPT];

fn scene_with(camera: &str, depth_: i32, radiance: f64) -> String {
    let light = panel().replace(&area(12.0), &area(radiance));
    [depth(depth_), camera.to_owned(), room(), ball(&bsdf("plastic", "")), light].concat()
}

fn gaussian(size: u32) -> String {
    camera("perspective", &film_with(size, size, r#"<rfilter type="gaussian"/>"#))
}

fn image(subject: &Subject, techniques: Techniques, samples: u32, seed: u64) -> Image {
    subject.image(&subject.job(subject.strategy(techniques, Heuristic::Balance), samples, seed))
}

/// Renders onto one film in as many goes as `ends` has entries.
fn in_goes(subject: &Subject, strategy: Strategy, ends: &[u32], threads: usize) -> Image {
    let film = Film::new(&subject.description.film).expect("a film");
    for &end in ends {
        let job = Job { threads, target: Target::Samples(end), ..subject.job(strategy, end, 7) };
        render::render(&subject.scene, &film, &job, &AtomicBool::new(false), |_| None);
    }
    film.develop()
}

#[test]
fn twice_the_light_is_twice_the_picture_bit_by_bit() {
    let [one, two] = [3.0, 6.0].map(|radiance| read(&scene_with(&gaussian(16), 5, radiance)));
    for techniques in ESTIMATORS {
        let (one, two) = (image(&one, techniques, 8, 1), image(&two, techniques, 8, 1));
        assert!(mean_of(&one) > 0.0);
        assert!(one.pixels.iter().zip(&two.pixels).all(|(a, b)| a.map(|v| 2.0 * v) == *b), "{techniques:?}");
    }
}

/// Light walks on and unused would still cost time: without them, every plan that is path tracing is `path`.
#[test]
fn a_plan_without_light_walks_is_path_tracing() {
    let subject = read(&scene_with(&gaussian(16), -1, 3.0));
    let none = Techniques { connection: 0.0, lens_splat: 0.0, lens_hit: 0.0, ..BDPT };
    assert_eq!(image(&subject, none, 8, 1), image(&subject, PATH, 8, 1));
}

#[test]
fn any_number_of_threads_makes_the_same_bits() {
    let subject = read(&scene_with(&gaussian(70), 5, 3.0));
    for techniques in ESTIMATORS {
        let strategy = subject.strategy(techniques, Heuristic::Balance);
        let one = in_goes(&subject, strategy, &[6], 1);
        for threads in [2, 3, 5] {
            assert_eq!(in_goes(&subject, strategy, &[6], threads), one, "{techniques:?}, {threads} threads");
        }
    }
}

/// One film that is exposed to its end at once, or added up from whatever passes lie before it.
#[test]
fn any_division_into_passes_makes_the_same_bits() {
    let subject = read(&scene_with(&gaussian(40), 5, 3.0));
    let strategy = subject.strategy(BDPT, Heuristic::Balance);
    let film = Film::new(&subject.description.film).expect("a film");
    let by_hand = |film: &Film, ends: &[u32]| {
        use bidir::film::{Exposure, Store};
        use bidir::scene::view::View;
        use bidir_kernel::{Sampler, Vec2, Walk, sample, sampler::Independent};
        let view = View::new(&subject.scene, Strictness::Strict);
        let [mut seen, mut lit] = [0; 2].map(|_| (0..4).map(|_| None).collect::<Vec<_>>());
        for &end in ends {
            while let Some(mut buffer) = film.claim(end) {
                let unit = buffer.unit();
                for (x, y) in film.pixels(&unit) {
                    let mut numbers = Independent::new(7, u64::from(y) * 40 + u64::from(x), u64::from(unit.sample));
                    numbers.seek(Walk::Camera, 0);
                    let [dx, dy] = numbers.next_pair();
                    let raster = Vec2::new(x as f32 + dx, y as f32 + dy);
                    buffer.begin(raster);
                    sample(&view, &strategy, &mut numbers, raster, &mut seen, &mut lit, &mut buffer);
                    buffer.end();
                }
                film.commit(buffer);
            }
        }
        film.develop()
    };
    let once = by_hand(&film, &[7]);
    for ends in [vec![1, 2, 3, 4, 5, 6, 7], vec![3, 7]] {
        assert!(by_hand(&Film::new(&subject.description.film).expect("a film"), &ends) == once, "{ends:?}");
    }
    let own = Film::new(&subject.description.film).expect("a film");
    let job = Job { threads: 2, numbers: Numbers::Independent, ..subject.job(strategy, 7, 7) };
    render::render(&subject.scene, &own, &job, &AtomicBool::new(false), |_| None);
    assert!(own.develop() == once, "the renderer's own passes");
}

#[test]
fn the_seed_alone_decides_the_noise() {
    let subject = read(&scene_with(&gaussian(16), 5, 3.0));
    for techniques in ESTIMATORS {
        let again = |seed| image(&subject, techniques, 4, seed);
        assert_eq!(again(1), again(1));
        assert_ne!(again(1), again(2));
    }
}

fn window(filter: &str) -> String {
    let crop = [("crop_offset_x", 9), ("crop_offset_y", 5), ("crop_width", 20), ("crop_height", 18)]
        .map(|(name, value)| format!(r#"<integer name="{name}" value="{value}"/>"#))
        .concat();
    camera("perspective", &film_with(40, 30, &(crop + filter)))
}

/// Pixels of the window that lie `border` inside it, against those of the whole image.
fn cropped(filter: &str, border: u32) {
    let whole = read(&scene_with(&camera("perspective", &film_with(40, 30, filter)), 5, 3.0));
    let part = read(&scene_with(&window(filter), 5, 3.0));
    let (whole, part) = (image(&whole, PATH, 4, 1), image(&part, PATH, 4, 1));
    assert_eq!((part.width, part.height), (20, 18));
    for (x, y) in (border..18 - border).flat_map(|y| (border..20 - border).map(move |x| (x, y))) {
        assert_eq!(part.at(x, y), whole.at(x + 9, y + 5), "({x}, {y})");
    }
}

#[test]
fn a_crop_window_is_cut_out_bit_by_bit_under_the_box_filter() {
    cropped(r#"<rfilter type="box"/>"#, 0);
}

#[test]
fn a_crop_window_is_cut_out_bit_by_bit_within_the_reach_of_the_gaussian_filter() {
    cropped(r#"<rfilter type="gaussian"/>"#, 2);
}

/// The same numbers make the same paths but for rounding: of those that change side at an edge there are few.
fn looks_alike(a: &Subject, b: &Subject, what: &str) {
    for techniques in ESTIMATORS {
        let (one, other) = (image(a, techniques, 64, 1), image(b, techniques, 64, 1));
        let share = mean_of(&other) / mean_of(&one) - 1.0;
        let off = one.pixels.iter().zip(&other.pixels).map(|(a, b)| f64::from((a[1] - b[1]).abs())).sum::<f64>() / one.pixels.len() as f64;
        println!("{what}: mean {:+.4} %, pixels off by {:.3} % on average", 100.0 * share, 100.0 * off / mean_of(&one));
        assert!(share.abs() < 0.01 && off / mean_of(&one) < 0.03, "{what}, {techniques:?}: {share} {off}");
    }
}

/// The scene with everything in it moved by a transform that is written behind each of its own.
fn moved(by: &str) -> Subject {
    read(&scene_with(&pinhole(), 5, 3.0).replace("</transform>", &format!("{by}</transform>")))
}

#[test]
fn moving_everything_changes_nothing() {
    looks_alike(&moved(""), &moved(r#"<translate value="300, -200, 500"/>"#), "moved by 100 rooms");
    looks_alike(&moved(""), &moved(r#"<translate value="3e4, -2e4, 5e4"/>"#), "moved by 10,000 rooms");
}

/// A frame about a normal is not turned with it, so the same numbers make other paths: equal up to noise.
#[test]
fn turning_everything_changes_nothing_but_the_noise() {
    let (still, turned) = (moved(""), moved(r#"<rotate x="1" y="2" z="-1" angle="77"/>"#));
    for techniques in ESTIMATORS {
        let pictures = |subject: &Subject| subject.pictures(subject.strategy(techniques, Heuristic::Balance), 16, 1);
        let (still, turned) = (pictures(&still), pictures(&turned));
        for block in still.blocks() {
            let [one, other] = [&still, &turned].map(|pictures| pictures.mean(block, &[0, 1, 2]));
            let apart = other.minus(&one);
            let (deviation, limit) = (apart.deviation(one.mean), threshold(12, apart.degrees));
            println!("{block:?}: {:+.3} %, {deviation:.2} σ of {limit:.2}", 100.0 * apart.mean / one.mean);
            assert!(deviation < limit && apart.error < 0.03 * one.mean, "{techniques:?} {block:?}: {one:?} {other:?}");
        }
    }
}

/// Not the camera: Mitsuba's may not be scaled, so it is moved alone.
#[test]
fn scaling_everything_changes_nothing() {
    for scale in [1e-6, 1e-3, 1e3, 1e6] {
        let sensor = pinhole();
        let scaled = sensor
            .replace("0, 1.2, 4", &format!("0, {}, {}", 1.2 * scale, 4.0 * scale))
            .replace("0, 0.8, 0", &format!("0, {}, 0", 0.8 * scale));
        let rest = scene_with("", 5, 3.0).replace("</transform>", &format!(r#"<scale value="{scale}"/></transform>"#));
        looks_alike(&moved(""), &read(&(scaled + &rest)), &format!("scaled by {scale:e}"));
    }
}

/// Paths of up to k segments are the layers 1 … k of a longer render, when roulette begins later than both end.
#[test]
fn a_depth_limit_is_the_sum_of_the_layers_up_to_it() {
    let longer = read(&scene_with(&pinhole(), 5, 3.0));
    for techniques in [PATH, BDPT] {
        let pyramids = longer.pyramids(longer.strategy(techniques, Heuristic::Balance), 16, 3, 5);
        for depth_ in 0..=5 {
            let shorter = read(&scene_with(&pinhole(), depth_ as i32, 3.0));
            let found = shorter.pictures(shorter.strategy(techniques, Heuristic::Balance), 16, 4);
            let found = found.mean(found.whole(), &[0, 1, 2]);
            let wanted = (1..=depth_)
                .map(|length| pyramids.length(length))
                .fold((0.0, 0.0), |(mean, square), length| (mean + length.mean, square + length.error * length.error));
            // Lengths share their walks, so their errors may add up straight.
            let error = found.error.hypot(wanted.1.sqrt() * f64::from(depth_.max(1)).sqrt());
            let apart = (found.mean - wanted.0).abs();
            println!("depth {depth_}: {:.5} for {:.5} ± {error:.5}", found.mean, wanted.0);
            assert!(apart <= 4.0 * error, "depth {depth_}, {techniques:?}: {} for {}", found.mean, wanted.0);
        }
    }
}
