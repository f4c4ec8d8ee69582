//! Rows 30 to 41: lights.

use std::path::Path;

use bidir::{
    image::{Image, write},
    load,
    plugin::{Library, Strictness},
    scene::{
        Scene,
        description::{Emitter, EmitterKind},
        lights::LightId,
        view::View,
    },
};
use bidir_kernel::{Heuristic, Point, Scene as _, Spectrum, Vec3};
use glam::DVec3;

use super::{
    Case, Form, Held, file,
    files::{bad, different, image},
    native,
};
use crate::statistics::worse;
use crate::{
    estimators::{ALL, Agreement, DOUBT, difference},
    pictures::{BDPT, LIGHT, PATH, Subject},
    scenes::{ball, depth, diffuse, emitter, panel, pinhole, read, rgb, room, shape},
};

pub(super) const CASES: &[Case] = &[
    Case { number: 30, what: "a light without area", seen: "LuxCore", must: "no selection mass", run: no_area },
    Case { number: 31, what: "an area light of size 1e-8", seen: "Cycles, three-gpu 244", must: "the point light's limit", run: tiny },
    file!(32, "a distant sphere light (1 − cos cancels)", "pbrt-v3 212, LuxCore 446", "the irradiance is analytic"),
    file!(33, "a receiver inside a sphere light", "–", "estimators agree"),
    file!(34, "a point light on a surface, or 1e-7 from it", "Mitsuba 0.6 132", "finite; all of its light is there: no clamp"),
    file!(35, "a spot's cone → 0 and → 180°", "Cycles", "finite; estimators agree"),
    Case {
        number: 36,
        what: "an environment with one texel of 1e6; half a texel off; poles",
        seen: "pbrt-v3 62, 63",
        must: "estimators agree",
        run: one_texel,
    },
    Case {
        number: 37,
        what: "an environment with NaN, infinite, negative, black, 1×1 texels",
        seen: "three-gpu 541, LuxCore",
        must: "cleaned with a message; finite",
        run: odd_texels,
    },
    file!(38, "an environment and a point light", "LuxCore 68", "estimators agree"),
    file!(39, "no lights; no shapes; nothing", "pbrt-v3, Mitsuba 0.6 80", "black without a crash; the environment visible"),
    Case {
        number: 40,
        what: "1e5 lights with powers over 12 decades",
        seen: "Cycles 74816",
        must: "chances sum to 1; what is picked and what is asked agree",
        run: many,
    },
    Case {
        number: 41,
        what: "a black light; a light behind its own surface",
        seen: "–",
        must: "finite; estimators agree",
        run: |form| [super::files::run(41, form), black(form)].concat(),
    },
];

/// Random numbers (SplitMix64).
#[derive(Clone, Debug)]
pub struct Dice(u64);

impl Dice {
    /// Those of a seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// 64 bits.
    pub fn roll(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// Less than `end`.
    pub fn below(&mut self, end: usize) -> usize {
        (self.roll() % end as u64) as usize
    }

    /// In [0, 1).
    pub fn number(&mut self) -> f32 {
        (self.roll() >> 40) as f32 / (1 << 24) as f32
    }
}

fn clay() -> String {
    diffuse("0.6, 0.4, 0.3")
}

fn lit_by(lights: &str) -> Subject {
    read(&[depth(5), pinhole(), room(), ball(&clay()), lights.to_owned()].concat())
}

/// Pixels that a thing changes that should change none, by every estimator.
fn changes(lights: &str, thing: &str) -> usize {
    let (without, with) = (lit_by(lights), lit_by(&(lights.to_owned() + thing)));
    [PATH, LIGHT, BDPT].map(|techniques| different(&image(&without, techniques, 16), &image(&with, techniques, 16))).iter().sum()
}

fn lamp(radiance: &str) -> String {
    emitter("area", &rgb("radiance", radiance))
}

fn no_area(form: Form) -> Vec<Held> {
    native(form, || {
        let speck = shape("sphere", r#"<scale value="1e-30"/><translate value="0, 1, 1"/>"#, &lamp("9, 9, 9"));
        vec![Held::none("pixels that a light changes whose area is 0 in f32", changes(&panel(), &speck))]
    })
}

/// Of two pictures with errors: the largest deviation as a share of what chance explains, and the means' relative difference.
fn apart(what: &str, one: &Subject, other: &Subject, samples: u32) -> Vec<Held> {
    let (mut deviation, mut share) = (0.0, 0.0);
    for techniques in [PATH, BDPT] {
        let of = |subject: &Subject, seed| subject.pictures(subject.strategy(techniques, Heuristic::Balance), samples, seed);
        let found = difference(&of(other, 1), &of(one, 2));
        deviation = worse(deviation, found.deviation / found.threshold);
        share = worse(share, found.whole.abs());
    }
    vec![
        Held::new(format!("{what}: deviation, as a share of what chance explains"), deviation, 1.0),
        Held::new(format!("{what}: relative difference of the means"), share, 0.01),
    ]
}

/// L π r² = I for a small ball.
fn tiny(form: Form) -> Vec<Held> {
    native(form, || {
        let radiance = 5.0 / (std::f64::consts::PI * 1e-16);
        let place = r#"<translate value="0.8, 2.2, 1"/>"#;
        let bulb = shape("sphere", &format!(r#"<scale value="1e-8"/>{place}"#), &(diffuse("0, 0, 0") + &lamp(&format!("{radiance:e}"))));
        let point = emitter("point", &(rgb("intensity", "5") + r#"<point name="position" value="0.8, 2.2, 1"/>"#));
        apart("a ball of 1e-8 against a point", &lit_by(&point), &lit_by(&bulb), 32)
    })
}

/// A scene under an image of the surroundings, and what was said of that.
fn under(image: &Image) -> (Subject, Vec<String>) {
    let folder = tempfile::tempdir().expect("a folder");
    write::write(&folder.path().join("sky.exr"), &image.into()).expect("an image");
    let turn = r#"<transform name="to_world"><rotate y="1" angle="50"/><rotate x="1" angle="10"/></transform>"#;
    let light = emitter("envmap", &(r#"<string name="filename" value="sky.exr"/>"#.to_owned() + turn));
    let content = [depth(5), pinhole(), room(), ball(&clay()), light].concat();
    let text = format!(r#"<scene version="3.0.0">{content}</scene>"#);
    let loaded = load::load_str(&text, Path::new("sky.xml"), Some(folder.path()), &[], &Library::default()).expect("a good scene");
    let scene = Scene::new(&loaded.description).expect("a scene");
    (Subject { description: loaded.description, scene }, loaded.warnings)
}

/// The bright texel at the pole, at the seam, and in between.
fn one_texel(form: Form) -> Vec<Held> {
    native(form, || {
        let held = |(x, y): (usize, usize)| {
            let mut sky = Image::black(32, 16);
            sky.pixels.fill([0.1; 3]);
            sky.pixels[y * 32 + x] = [1e6; 3];
            let agreement = Agreement::of(&under(&sky).0, ALL, 2);
            [
                Held::new(format!("texel ({x}, {y}): deviation, as a share of what chance explains"), agreement.worst(), 1.0),
                Held::new(format!("texel ({x}, {y}): standard error of a mean, as a share of it"), agreement.doubt(), DOUBT),
            ]
        };
        [(9, 3), (31, 2), (4, 0)].into_iter().flat_map(held).collect()
    })
}

fn odd_texels(form: Form) -> Vec<Held> {
    native(form, || {
        let mut odd = Image::black(8, 4);
        odd.pixels.fill([0.5; 3]);
        for (at, value) in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -3.0].into_iter().enumerate() {
            odd.pixels[3 + 8 * at % 32] = [value, 0.5, 0.5];
        }
        let (subject, said) = under(&odd);
        let mut held = vec![Held::none(
            "warnings about four texels that no light can be",
            usize::from(!said.iter().any(|said| said.contains("4 pixels of sky.exr"))),
        )];
        let single = Image { width: 1, height: 1, pixels: vec![[0.5; 3]] };
        for (what, subject) in [("odd texels", subject), ("black", under(&Image::black(4, 2)).0), ("1×1", under(&single).0)] {
            let found = [PATH, LIGHT, BDPT].map(|techniques| bad(&image(&subject, techniques, 16))).iter().sum();
            held.push(Held::none(format!("{what}: values that are no finite number"), found));
        }
        held
    })
}

fn many(form: Form) -> Vec<Held> {
    native(form, || {
        let mut description = lit_by("").description;
        let place = description.sensor.place.clone();
        let mut dice = Dice::new(4);
        for _ in 0..100_000 {
            let [x, y, z] = std::array::from_fn(|_| f64::from(dice.number()));
            let power = 10.0_f32.powf(12.0 * dice.number() - 6.0);
            let kind = EmitterKind::Point { position: DVec3::new(4.0 * x - 2.0, 1.0 + y, 2.0 * z), intensity: Spectrum::splat(power) };
            description.emitters.push(Emitter { kind, place: place.clone() });
        }
        let scene = Scene::new(&description).expect("a scene");
        let view = View::new(&scene, Strictness::Strict);
        let lit = Point::free(Vec3::new(0.1, 0.2, 0.3));
        let mut sum_off = 0.0;
        let (mut disagreements, mut never) = (0, 0);
        for receiver in [None, Some(&lit)] {
            let chances: Vec<_> = (0..100_000).map(|i| f64::from(view.light_chance(LightId(i), receiver).0)).collect();
            sum_off = worse(sum_off, (chances.iter().sum::<f64>() - 1.0).abs());
            never += chances.iter().filter(|chance| **chance <= 0.0).count();
            for _ in 0..20_000 {
                let picked = view.pick_light(receiver, || dice.number());
                disagreements +=
                    usize::from(!picked.is_some_and(|(id, chance)| chance.0 > 0.0 && view.light_chance(id, receiver) == chance));
            }
        }
        vec![
            Held::new("distance of the sum of 1e5 chances from 1", sum_off, 1e-6),
            Held::none("lights that shine and are never picked", never),
            Held::none("of 40,000 picks, those whose chance is 0 or another when asked afterwards", disagreements),
        ]
    })
}

fn black(form: Form) -> Vec<Held> {
    native(form, || {
        let place = r#"<scale value="0.2"/><translate value="0.9, 0.7, 1"/>"#;
        let dark = shape("sphere", place, &(diffuse("0.5, 0.5, 0.5") + &lamp("0, 0, 0")));
        let plain = shape("sphere", place, &diffuse("0.5, 0.5, 0.5"));
        let [plain, dark] = [plain, dark].map(|thing| lit_by(&(panel() + &thing)));
        let differ = [PATH, LIGHT, BDPT].map(|techniques| different(&image(&plain, techniques, 16), &image(&dark, techniques, 16)));
        vec![Held::none("pixels that a black light changes", differ.iter().sum())]
    })
}
