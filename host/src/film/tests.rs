use bidir_kernel::{Contribution, Film as _, Spectrum, Technique, Vec2};

use super::*;
use crate::{
    image::Image,
    scene::description::{Crop, Filter},
};

const FILTERS: [Filter; 6] = [
    Filter::Box,
    Filter::Tent { radius: 1.0 },
    Filter::Gaussian { stddev: 0.5 },
    Filter::Gaussian { stddev: 1.1 },
    Filter::Cubic { b: 1.0 / 3.0, c: 1.0 / 3.0 },
    Filter::Lanczos { lobes: 3.0 },
];
const CROPS: [Crop; 4] = [
    Crop { x: 0, y: 0, width: 40, height: 70 },
    Crop { x: 5, y: 9, width: 19, height: 3 },
    Crop { x: 39, y: 69, width: 1, height: 1 },
    Crop { x: 7, y: 0, width: 2, height: 70 },
];

fn film(crop: Crop, filter: Filter) -> Film {
    Film::new(&FilmSettings { width: 40, height: 70, crop, filter }).expect("a window inside the image")
}

fn light(value: [f32; 3]) -> Contribution {
    Contribution { value: Spectrum(value), weight: 1.0, technique: Technique { s: 1, t: 2 } }
}

/// The centre of the n-th of `grid`² squares of a pixel.
fn stratum(pixel: (u32, u32), n: u32, grid: u32) -> Vec2 {
    let within = |i: u32| (i as f32 + 0.5) / grid as f32;
    Vec2::new(pixel.0 as f32 + within(n % grid), pixel.1 as f32 + within(n / grid % grid))
}

/// A stand-in for a sampler: a number in 0 … 1 from anything.
fn hash(pixel: (u32, u32), sample: u32, dimension: u32) -> f32 {
    let mut h = (u64::from(pixel.0) << 40) ^ (u64::from(pixel.1) << 20) ^ (u64::from(sample) << 3) ^ u64::from(dimension);
    for _ in 0..3 {
        h = (h ^ (h >> 29)).wrapping_add(0x9e37_79b9_7f4a_7c15).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        h ^= h >> 32;
    }
    (h >> 40) as f32 / (1u64 << 24) as f32
}

/// Exposes `end` samples per pixel in order.
fn expose(film: &Film, end: u32, mut sample: impl FnMut(&mut TileBuffer, (u32, u32), u32)) {
    while let Some(mut buffer) = film.claim(end) {
        let unit = buffer.unit();
        for pixel in film.pixels(&unit) {
            sample(&mut buffer, pixel, unit.sample);
        }
        film.commit(buffer);
    }
}

/// Random camera samples and splats, a function of pixel and sample number alone.
fn random_sample(crop: Crop) -> impl Fn(&mut TileBuffer, (u32, u32), u32) + Copy {
    move |buffer, pixel, n| {
        let u = |dimension| hash(pixel, n, dimension);
        buffer.weigh([1.0, 1.0 / 3.0][(n / 2 % 2) as usize]);
        buffer.begin(Vec2::new(pixel.0 as f32 + u(0), pixel.1 as f32 + u(1)));
        buffer.add(light([u(2), u(3), u(4)]));
        buffer.add(light([u(5) * 1e-3, 0.1, 1e4 * u(6)]));
        for k in 0..2 {
            let x = crop.x as f32 + u(7 + 2 * k) * crop.width as f32 * 0.999;
            let y = crop.y as f32 + u(8 + 2 * k) * crop.height as f32 * 0.999;
            buffer.splat(Vec2::new(x, y), light([u(11), 1.0 / 3.0, u(12)]));
        }
        buffer.end();
    }
}

fn largest_difference(image: &Image, expected: impl Fn(u32, u32) -> f32) -> f32 {
    let pixels = (0..image.height).flat_map(|y| (0..image.width).map(move |x| (x, y)));
    pixels.map(|(x, y)| (image.at(x, y)[0] - expected(x, y)).abs()).fold(0.0, f32::max)
}

#[test]
fn camera_samples_keep_a_flat_field_exactly() {
    for (filter, crop) in FILTERS.into_iter().flat_map(|f| CROPS.map(|c| (f, c))) {
        let film = film(crop, filter);
        expose(&film, 3, |buffer, pixel, n| {
            buffer.begin(Vec2::new(pixel.0 as f32 + hash(pixel, n, 0), pixel.1 as f32 + hash(pixel, n, 1)));
            buffer.add(light([1.0; 3]));
            buffer.end();
        });
        assert_eq!(largest_difference(&film.develop(), |_, _| 1.0), 0.0, "{filter:?} {crop:?}");
        assert_eq!(film.samples(), 3 * u64::from(crop.width * crop.height));
    }
}

/// One splat of value 1 in each of 16² squares of every pixel: the mean over the window is 1 by the law of the film, and every
/// pixel, on the border too, is 1 up to the midpoint rule's error (none for the box and the tent, whose kinks lie on the squares' edges).
#[test]
fn splats_keep_a_flat_field_to_the_border() {
    for (filter, crop) in FILTERS.into_iter().flat_map(|f| CROPS.map(|c| (f, c))) {
        let film = film(crop, filter);
        expose(&film, 256, |buffer, pixel, n| {
            buffer.begin(stratum(pixel, n, 16));
            buffer.splat(stratum(pixel, n, 16), light([1.0; 3]));
            buffer.end();
        });
        let worst = largest_difference(&film.develop(), |_, _| 1.0);
        let allowed = match filter {
            Filter::Box | Filter::Tent { .. } => 2e-7,
            // (1/16)² / 24 of the change of its slope over a pixel, 3.4, along either axis.
            Filter::Lanczos { .. } => 1.2e-3,
            _ => 1e-3,
        };
        assert!(worst <= allowed, "{filter:?} {crop:?}: {worst}");
        let [even, odd] = film.halves();
        assert!(largest_difference(&even, |x, y| 2.0 - odd.at(x, y)[0]) < 2.0 * allowed);
    }
}

/// Camera samples and splats of the same field, a steep ramp: a shift by one pixel in either buffer shows in every pixel.
#[test]
fn splats_and_camera_samples_land_in_the_same_pixels() {
    let field = |at: Vec2| 1.0 + at.x * 3.0 + at.y * 7.0;
    for (filter, crop) in FILTERS.into_iter().flat_map(|f| CROPS.map(|c| (f, c))) {
        let (camera, splats) = (film(crop, filter), film(crop, filter));
        for (film, by_splat) in [(&camera, false), (&splats, true)] {
            expose(film, 256, |buffer, pixel, n| {
                let at = stratum(pixel, n, 16);
                buffer.begin(at);
                if by_splat {
                    buffer.splat(at, light([field(at); 3]))
                } else {
                    buffer.add(light([field(at); 3]))
                }
                buffer.end();
            });
        }
        let (camera, splats) = (camera.develop(), splats.develop());
        for (a, b) in camera.pixels.iter().zip(&splats.pixels) {
            assert!((a[0] - b[0]).abs() < 1.5e-3 * a[0], "{filter:?} {crop:?}: {a:?} {b:?}");
        }
    }
}

#[test]
fn commit_order_threads_and_passes_do_not_change_a_bit() {
    for (filter, crop) in [(FILTERS[0], CROPS[0]), (FILTERS[2], CROPS[0]), (FILTERS[3], CROPS[1])] {
        let sample = random_sample(crop);
        let ordered = film(crop, filter);
        expose(&ordered, 7, sample);

        let backwards = film(crop, filter);
        for end in [3, 4, 7] {
            let mut buffers: Vec<_> = std::iter::from_fn(|| backwards.claim(end)).collect();
            buffers.sort_by_key(|buffer| (hash((buffer.unit().index as u32, 0), 0, 0) * 1e6) as u32);
            for mut buffer in buffers {
                let unit = buffer.unit();
                backwards.pixels(&unit).for_each(|pixel| sample(&mut buffer, pixel, unit.sample));
                backwards.commit(buffer);
            }
        }

        let threaded = film(crop, filter);
        for end in [1, 2, 7] {
            std::thread::scope(|scope| (0..5).for_each(|_| drop(scope.spawn(|| expose(&threaded, end, sample)))));
        }
        for film in [&backwards, &threaded] {
            assert_eq!(film.samples(), ordered.samples());
            assert_eq!(film.develop(), ordered.develop());
            assert_eq!(film.halves(), ordered.halves());
            assert_eq!(film.noise(), ordered.noise());
        }
    }
}

/// The box: bit for bit everywhere. Wide filters: away from the crop's border, where samples outside are missing.
#[test]
fn a_crop_is_the_full_image_cropped() {
    let crop = Crop { x: 3, y: 21, width: 30, height: 40 };
    for filter in FILTERS {
        let (full, part) = (film(CROPS[0], filter), film(crop, filter));
        for film in [&full, &part] {
            expose(film, 5, |buffer, pixel, n| {
                buffer.begin(Vec2::new(pixel.0 as f32 + hash(pixel, n, 0), pixel.1 as f32 + hash(pixel, n, 1)));
                buffer.add(light([hash(pixel, n, 2); 3]));
                buffer.end();
            });
        }
        let (full, part) = (full.develop(), part.develop());
        let reach =
            layout::Layout::new(&FilmSettings { width: 40, height: 70, crop, filter }).expect("a window inside the image").profile.reach();
        for y in reach..crop.height - reach {
            for x in reach..crop.width - reach {
                let (a, b) = (part.at(x, y)[0], full.at(x + crop.x, y + crop.y)[0]);
                assert!(a == b || reach > 0 && (a - b).abs() <= f32::EPSILON, "{filter:?} {x} {y}: {a} {b}");
            }
        }
    }
}

/// Samples of value 0 or 2 with even chance: variance 1, so a picture of n samples (box) has a variance of 1/n, and with n odd the
/// halves differ in size. 2,800 pixels · 3 bands: the estimate's own relative deviation is √(2/2800) ≈ 2.7 %; 4 of them are allowed.
#[test]
fn the_halves_estimate_the_variance_without_bias() {
    for n in [2, 5, 16] {
        let film = film(CROPS[0], Filter::Box);
        let value = |pixel, n, k| if hash(pixel, n, k) < 0.5 { 0.0 } else { 2.0 };
        expose(&film, n, |buffer, pixel, n| {
            buffer.begin(stratum(pixel, 0, 1));
            buffer.add(light([value(pixel, n, 2), value(pixel, n, 3), value(pixel, n, 4)]));
            buffer.splat(stratum(pixel, 0, 1), light([1.0; 3]));
            buffer.end();
        });
        let noise = film.noise().expect("two samples");
        assert!((noise.mse * f64::from(n) - 1.0).abs() < 4.0 * 0.027 / 3f64.sqrt() * 1.5, "{n}: {}", noise.mse);
    }
    assert_eq!(film(CROPS[0], Filter::Box).noise(), None);
}

/// Both camera samples and splats, and each half by itself.
#[test]
fn a_sample_that_counts_more_is_that_many_samples() {
    let film = film(CROPS[0], Filter::Box);
    expose(&film, 4, |buffer, pixel, n| {
        buffer.weigh(if n < 2 { 1.0 } else { 3.0 });
        let (raster, value) = (stratum(pixel, 0, 1), light([[2.0, 4.0, 6.0, 8.0][n as usize]; 3]));
        buffer.begin(raster);
        buffer.add(value);
        buffer.splat(raster, value);
        buffer.end();
    });
    let off = |image: &Image, mean: f32| largest_difference(image, |_, _| 2.0 * mean);
    let [even, odd] = film.halves();
    let differences = [
        off(&film.develop(), (2.0 + 4.0 + 3.0 * (6.0 + 8.0)) / 8.0),
        off(&even, (2.0 + 3.0 * 6.0) / 4.0),
        off(&odd, (4.0 + 3.0 * 8.0) / 4.0),
    ];
    assert!(differences.iter().all(|&off| off < 1e-5), "{differences:?}");
    assert_eq!(film.samples(), 4 * u64::from(CROPS[0].width * CROPS[0].height));
}

#[test]
fn what_is_not_finite_is_refused_and_its_sample_still_counts() {
    let film = film(CROPS[1], FILTERS[2]);
    expose(&film, 2, |buffer, pixel, n| {
        buffer.begin(stratum(pixel, 0, 1));
        buffer.add(light([1.0; 3]));
        let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY][(pixel.0 % 3) as usize];
        buffer.add(light([0.0, bad, 0.0]));
        buffer.add(Contribution { weight: f32::NAN, ..light([1.0; 3]) });
        buffer.splat(stratum(pixel, 0, 1), light([bad; 3]));
        buffer.splat(Vec2::new(bad, 0.0), light([1.0; 3]));
        buffer.splat(Vec2::new(0.0, 0.0), light([1.0; 3])); // outside of this crop
        if n == 1 {
            buffer.add(light([1.0; 3]));
        }
        buffer.end();
    });
    assert_eq!(largest_difference(&film.develop(), |_, _| 1.5), 0.0);
    assert_eq!(film.refused(), 5 * 2 * 19 * 3);
}

#[test]
fn nothing_exposed_is_black_and_a_bad_window_is_refused() {
    let film = film(CROPS[1], FILTERS[2]);
    assert_eq!(film.develop(), Image::black(19, 3));
    let outside = Crop { x: 39, y: 0, width: 2, height: 1 };
    for crop in [outside, Crop { width: 0, ..outside }, Crop { x: u32::MAX, ..outside }] {
        assert!(Film::new(&FilmSettings { width: 40, height: 70, crop, filter: Filter::Box }).is_err());
    }
}
