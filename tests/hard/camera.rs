//! Rows 42 to 57: cameras, films, estimators.

use std::{
    path::Path,
    sync::atomic::{AtomicBool, Ordering},
};

use bidir::{
    error::Error,
    film::{Exposure, Film, Store},
    load,
    plugin::Library,
    render::{self, Job, Target},
    scene::Scene,
};
use bidir_kernel::{Contribution, Film as _, Heuristic, Spectrum, Technique, Techniques, Vec2, weight::Side};

use super::{
    Case, Form, Held,
    chains::{Chain, GLOSSY, SPECULAR},
    file,
    files::{bad, different, image},
    native,
    transforms::alike,
};
use crate::statistics::worse;
use crate::{
    pictures::{BDPT, LIGHT, PATH, Pictures, Subject},
    scenes::{area, ball, camera, depth, diffuse, emitter, film, film_with, float, panel, pinhole, read, rgb, room},
    statistics::threshold,
};

pub(super) const CASES: &[Case] = &[
    Case { number: 42, what: "lens radius → 0", seen: "–", must: "the pinhole's picture", run: small_lens },
    file!(43, "field of view → 179.9°, 0.01°", "–", "finite; estimators agree"),
    file!(44, "orthographic light tracing", "LuxCore 667, mitsuba3 198", "estimators agree"),
    file!(45, "a light at the lens; the camera on a wall", "–", "finite splats"),
    Case {
        number: 46,
        what: "dark edges, a pixel's shift between the light's buffer and the camera's",
        seen: "LuxCore 237",
        must: "estimators agree pixel by pixel",
        run: every_pixel,
    },
    Case {
        number: 47,
        what: "crop window",
        seen: "pbrt-v4 347",
        must: "the whole image, cropped: bit for bit under the box filter, and inside a wide one's reach",
        run: cropped,
    },
    Case {
        number: 48,
        what: "NaN or infinity reaching the accumulator",
        seen: "Tungsten, LuxCore",
        must: "refused, counted, the denominator kept",
        run: refused,
    },
    Case {
        number: 49,
        what: "a chain of 64 specular bounces at α = 1e-6",
        seen: "f32 ratios",
        must: "|Σw − 1| < 1e-5",
        run: |form| chain(form, SPECULAR),
    },
    Case {
        number: 50,
        what: "64 glossy bounces at scale 1e-6, power heuristic",
        seen: "f32 dVCM",
        must: "|Σw − 1| < 1e-5",
        run: |form| chain(form, GLOSSY),
    },
    file!(51, "roulette with survival → 0", "–", "bounded weight, unbiased"),
    Case { number: 52, what: "no light paths", seen: "SeeSharp tests it", must: "path tracing exactly", run: no_light_paths },
    file!(54, "light through 1, 2, 3 blocks of glass", "LuxCore 678", "brightness as Fresnel says"),
    Case { number: 56, what: "denormal contributions", seen: "Cycles", must: "the same result", run: denormal },
    Case {
        number: 57,
        what: "1×1 and 8192×1 images, 0 and 2³¹ samples, depths 0, 1, 10⁶",
        seen: "–",
        must: "an image or a clear error",
        run: odd_sizes,
    },
];

fn seen_by(sensor: &str) -> Subject {
    read(&[depth(5), sensor.to_owned(), room(), ball(&diffuse("0.6, 0.4, 0.3")), panel()].concat())
}

fn chain(form: Form, chain: Chain) -> Vec<Held> {
    native(form, || chain.held::<Side>())
}

fn small_lens(form: Form) -> Vec<Held> {
    native(form, || {
        let lens =
            |radius: f64| seen_by(&camera("thinlens", &(float("aperture_radius", radius) + &float("focus_distance", 4.0) + &film(16))));
        [1e-4, 1e-7, 1e-20]
            .into_iter()
            .flat_map(|radius| alike(&format!("radius {radius:e}"), &seen_by(&pinhole()), &lens(radius)))
            .collect()
    })
}

/// Path tracing knows the camera's buffer alone, and light tracing the light's.
fn every_pixel(form: Form) -> Vec<Held> {
    native(form, || {
        let held = |filter: &str| {
            let subject = edges(filter);
            let of = |techniques, samples, seed| subject.pictures(subject.strategy(techniques, Heuristic::Balance), samples, seed);
            pixel_by_pixel(filter, &of(PATH, 64, 1), &of(LIGHT, 512, 2))
        };
        [BOX, r#"<rfilter type="gaussian"/>"#].map(held).to_vec()
    })
}

/// The box filter.
pub const BOX: &str = r#"<rfilter type="box"/>"#;

/// A lamp before a dark floor, with its edges.
pub fn edges(filter: &str) -> Subject {
    let lamp =
        crate::scenes::shape("rectangle", r#"<scale value="0.35"/><translate value="0.2, 0.9, 0"/>"#, &(diffuse("0, 0, 0") + &area(3.0)));
    let sensor = camera("perspective", &film_with(16, 12, filter));
    read(&[depth(2), sensor, room(), lamp].concat())
}

/// The worst pixel of two pictures of [`edges`].
pub fn pixel_by_pixel(what: &str, one: &Pictures, other: &Pictures) -> Held {
    let pixels = (0..12).flat_map(|y| (0..16).map(move |x| [x, y, 1, 1]));
    let deviation = |pixel| {
        let (one, other) = (one.mean(pixel, &[0, 1, 2]), other.mean(pixel, &[0, 1, 2]));
        let apart = other.minus(&one);
        apart.deviation(one.mean) / threshold(192, apart.degrees)
    };
    Held::new(format!("{what}: worst pixel's deviation, as a share of what chance explains"), pixels.map(deviation).fold(0.0, worse), 1.0)
}

fn cropped(form: Form) -> Vec<Held> {
    native(form, || {
        let window = [("crop_offset_x", 9), ("crop_offset_y", 5), ("crop_width", 20), ("crop_height", 18)];
        let window = window.map(|(name, value)| format!(r#"<integer name="{name}" value="{value}"/>"#)).concat();
        let held = |(filter, border): (&str, u32)| {
            let whole = image(&seen_by(&camera("perspective", &film_with(40, 30, filter))), PATH, 4);
            let part = image(&seen_by(&camera("perspective", &film_with(40, 30, &(window.clone() + filter)))), PATH, 4);
            let inside = (border..18 - border).flat_map(|y| (border..20 - border).map(move |x| (x, y)));
            let differ = inside.filter(|(x, y)| part.at(*x, *y) != whole.at(x + 9, y + 5)).count();
            Held::none(format!("{filter}: pixels that differ"), differ)
        };
        let splats = |techniques| {
            let of = |content: &str, seed| {
                let subject = seen_by(&camera("perspective", &film_with(40, 30, content)));
                subject.pictures(subject.strategy(techniques, Heuristic::Balance), 16, seed)
            };
            let (whole, part) = (of(BOX, 1), of(&(window.clone() + BOX), 2));
            let (wanted, found) = (whole.mean([9, 5, 20, 18], &[0, 1, 2]), part.mean(part.whole(), &[0, 1, 2]));
            let apart = found.minus(&wanted);
            let deviation = apart.deviation(wanted.mean) / threshold(2, apart.degrees);
            Held::new("the window's mean with splats: deviation, as a share of what chance explains", deviation, 1.0)
        };
        let bits = [(BOX, 0), (r#"<rfilter type="gaussian"/>"#, 2)].map(held);
        [&bits[..], &[splats(LIGHT), splats(BDPT)]].concat()
    })
}

/// One sample in four of every pixel is no number.
fn refused(form: Form) -> Vec<Held> {
    native(form, || {
        let subject = seen_by(&pinhole());
        let film = Film::new(&subject.description.film).expect("a film");
        let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
        let brings = |value: f32| Contribution { value: Spectrum::splat(value), weight: 1.0, technique: Technique { s: 0, t: 2 } };
        let mut brought = 0;
        while let Some(mut buffer) = film.claim(4) {
            let unit = buffer.unit();
            for (x, y) in film.pixels(&unit) {
                let raster = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
                buffer.begin(raster);
                if unit.sample % 4 == 3 {
                    odd.iter().for_each(|value| buffer.add(brings(*value)));
                    odd.iter().for_each(|value| buffer.splat(raster, brings(*value)));
                    brought += 6;
                } else {
                    buffer.add(brings(1.0));
                }
                buffer.end();
            }
            film.commit(buffer);
        }
        let picture = film.develop();
        let off = picture.pixels.iter().flatten().map(|value| f64::from((value - 0.75).abs())).fold(0.0, worse);
        vec![
            Held::none("contributions that are no numbers and were not counted", film.refused().abs_diff(brought) as usize),
            Held::new("distance of pixels from 3/4: three samples of 1, one refused", off, 1e-6),
            Held::none("values that are no finite number", bad(&picture)),
        ]
    })
}

fn no_light_paths(form: Form) -> Vec<Held> {
    native(form, || {
        let none = Techniques { connection: 0.0, lens_splat: 0.0, lens_hit: 0.0, ..BDPT };
        let subject = read(&[depth(-1), pinhole(), room(), ball(&diffuse("0.6, 0.4, 0.3")), panel()].concat());
        vec![Held::none("pixels that differ from path tracing's", different(&image(&subject, none, 32), &image(&subject, PATH, 32)))]
    })
}

/// A power of two changes no digit of a number that is not denormal.
fn denormal(form: Form) -> Vec<Held> {
    native(form, || {
        let lit = |radiance: String| {
            let light = emitter("constant", &rgb("radiance", &radiance));
            read(&[depth(5), pinhole(), room(), ball(&diffuse("0.05, 0.05, 0.05")), light].concat())
        };
        let factor = 2.0_f64.powi(-124);
        let (dim, plain) = (lit(format!("{:e}", factor)), lit("1".to_owned()));
        let mut off = 0.0;
        for techniques in [PATH, LIGHT, BDPT] {
            let (dim, plain) = (image(&dim, techniques, 16), image(&plain, techniques, 16));
            for (dim, plain) in dim.pixels.iter().flatten().zip(plain.pixels.iter().flatten()) {
                off = worse(off, (f64::from(*dim) / factor - f64::from(*plain)).abs());
            }
        }
        // The least number that an f32 tells apart is 2⁻¹⁴⁹; a pixel adds up some of them.
        vec![Held::new("change of pixels about 1 under a light of 2⁻¹²⁴, turned back", off, 64.0 * 2.0_f64.powi(-149 + 124))]
    })
}

/// A scene of that size; an error is fine if it says what and where, and what to do.
fn tried(width: u32, height: u32, samples: u32, depth_: i64) -> Result<(), Error> {
    let sensor = camera("perspective", &film_with(width, height, r#"<rfilter type="box"/>"#));
    let sensor =
        sensor.replace("<film", &format!(r#"<sampler type="independent"><integer name="sample_count" value="{samples}"/></sampler><film"#));
    let integrator = format!(r#"<integrator type="path"><integer name="max_depth" value="{depth_}"/></integrator>"#);
    let text = format!(r#"<scene version="3.0.0">{integrator}{sensor}{}{}</scene>"#, room(), panel());
    let description = load::load_str(&text, Path::new("size.xml"), None, &[], &Library::default())?.description;
    let scene = Scene::new(&description)?;
    let film = Film::new(&description.film)?;
    let subject = Subject { description, scene };
    for techniques in [PATH, BDPT] {
        let job = Job { target: Target::Samples(samples), ..subject.job(subject.strategy(techniques, Heuristic::Balance), samples, 1) };
        let enough = AtomicBool::new(false);
        let status = render::render(&subject.scene, &film, &job, &enough, |status| {
            enough.store(status.samples >= 1, Ordering::Relaxed);
            None
        });
        let picture = film.develop();
        assert!(!status.failed && bad(&picture) == 0 && (picture.width, picture.height) == (width, height));
    }
    Ok(())
}

fn odd_sizes(form: Form) -> Vec<Held> {
    native(form, || {
        let mut neither = 0;
        let mut errors = Vec::new();
        for (width, height) in [(1, 1), (8192, 1)] {
            for samples in [0, 1, 1 << 31] {
                for depth in [0, 1, 1_000_000] {
                    match std::panic::catch_unwind(|| tried(width, height, samples, depth)) {
                        Ok(Ok(())) => {}
                        Ok(Err(error)) => errors.push(error.to_string()),
                        Err(_) => neither += 1,
                    }
                }
            }
        }
        let unclear = errors.iter().filter(|error| !(error.starts_with("size.xml:") && error.contains("sample_count"))).count();
        vec![
            Held::none("of 18 odd sizes, those that give neither an image nor an error", neither),
            Held::none(format!("of {} errors, those that do not name file, line and thing", errors.len()), unclear),
        ]
    })
}
