//! Rows 1 to 16: surfaces.

use std::{f32::consts::TAU, sync::Arc};

use bidir::{
    check::{self, Linked, Plugin, Promises, Report, Set, Settings, Surfaces, Test},
    plugin::{Engine, Module, Strictness, Value},
    scene::view::View,
};
use bidir_kernel::{
    Bsdf, Camera, Carried, Light, Lobe, Made, Point, Ray, Sampler, Scattered, Scene as _, Segment, Spectrum, Vec2, Vec3,
    real::ONE_MINUS_EPSILON, sampler::Independent,
};
use bidir_standard::{Distribution, Microfacet, Plastic, RoughConductor, RoughDielectric};

use super::{
    Case, Form, Held, file,
    files::{self, different, image, library, of_case, read},
};
use crate::statistics::worse;
use crate::{
    pictures::{BDPT, PATH, Subject, mean_of},
    scenes::{self, bsdf, float, rgb},
};

pub(super) const CASES: &[Case] = &[
    Case {
        number: 1,
        what: "GGX with α = 1e-4",
        seen: "Cycles 125750, 108125",
        must: "every pixel finite; ∫ pdf = 1",
        run: |form| [files::run(1, form), narrow(form)].concat(),
    },
    Case {
        number: 2,
        what: "α = 1e-6 against a delta lobe",
        seen: "pbrt-v3 214",
        must: "nears the mirror's picture monotonically",
        run: |form| [to_the_mirror(form), to_its_picture(form)].concat(),
    },
    Case {
        number: 3,
        what: "α = 0 exactly",
        seen: "GLSL-PathTracer 83",
        must: "treated as delta, never 0/0",
        run: |form| [files::run(3, form), no_roughness(form)].concat(),
    },
    Case {
        number: 4,
        what: "u in the corners of every sampling routine",
        seen: "pbrt-v3, pbrt-v4",
        must: "finite, in the right hemisphere",
        run: |form| [corners(form), if form == Form::Native { corners_of_ends() } else { Vec::new() }].concat(),
    },
    Case {
        number: 5,
        what: "grazing ω_o, cos = 1e-7",
        seen: "pbrt-r4 77",
        must: "finite; in the right hemisphere or no sample",
        run: grazing,
    },
    Case { number: 6, what: "η = 1", seen: "Cycles 117611, mitsuba3 1781, three-gpu 844", must: "passes straight through", run: straight },
    Case { number: 7, what: "η = 1 ± 1e-6", seen: "mitsuba-blender 33", must: "continuous in η", run: nearly_straight },
    Case {
        number: 8,
        what: "total reflection at the critical angle",
        seen: "GLSL-PathTracer 25",
        must: "R → 1 continuously",
        run: critical,
    },
    file!(9, "η² for radiance and importance", "a lecture's figure", "inside glass = outside · η²; estimators agree"),
    Case {
        number: 10,
        what: "nested and coincident dielectrics",
        seen: "appleseed 1756",
        must: "independent of hit order: of two in one place, the first in the file",
        run: nested,
    },
    file!(11, "camera inside glass", "mitsuba3 1824", "estimators agree"),
    file!(12, "reflectance exactly 1; albedo 0", "pbrt-v4", "loses nothing; ends, without light"),
    Case {
        number: 13,
        what: "ω_i = −ω_o; n·v slightly above 1",
        seen: "three-gpu 844, Q2RTX 23",
        must: "0, or a number where light passes; never NaN",
        run: degenerate,
    },
    Case {
        number: 14,
        what: "a chance of picking a lobe that differs forward and back",
        seen: "SmallVCM asserts it away",
        must: "weights sum to 1",
        run: uneven,
    },
    file!(15, "closed furnace of albedo 1, 1,000 bounces", "–", "analytic energy; roulette unbiased"),
    file!(16, "several lobes in a furnace", "bevy 23203", "energy as the lobes' shares"),
];

/// A surface that scenes name, at some point of it; `$kind` is `.wasm` in the sandbox.
fn asked<T>(form: Form, material: &str, ask: impl FnOnce(&dyn Bsdf) -> T) -> T {
    let kind = if form == Form::Sandbox { ".wasm" } else { "" };
    let sheet = scenes::shape("rectangle", "", &material.replace("$kind", kind));
    let Subject { scene, .. } = files::read_text(&(scenes::pinhole() + &sheet));
    let view = View::new(&scene, Strictness::Strict);
    let down = Ray {
        origin: Vec3::new(0.1, 0.2, 1.0) - scene.origin().as_vec3(),
        direction: Vec3::NEG_Z,
        t_max: f32::INFINITY,
        segment: Segment::Inner,
    };
    let (point, hit) = view.intersect(&down).expect("the sheet");
    let answer = ask(&view.bsdf(&point, hit));
    assert_eq!(view.sandbox().fault(), None);
    answer
}

fn of(kind: &str, content: &str) -> String {
    bsdf(&format!("{kind}$kind"), content)
}

fn ggx(alpha: f64) -> String {
    float("alpha", alpha) + r#"<string name="distribution" value="ggx"/>"#
}

fn glass(eta: f64) -> String {
    float("int_ior", eta) + &float("ext_ior", 1.0)
}

/// Every kind of surface, with easy parameters and hard ones.
fn all() -> Vec<String> {
    let beckmann = |alpha: f64| float("alpha", alpha) + r#"<string name="distribution" value="beckmann"/>"#;
    let gold = rgb("eta", "0.14, 0.37, 1.44") + &rgb("k", "3.98, 2.38, 1.6");
    let brushed = float("alpha_u", 0.5) + &float("alpha_v", 1e-3);
    let mut all = vec![of("diffuse", ""), of("conductor", &gold), of("plastic", ""), of("null", "")];
    all.push(of("roughconductor", &brushed));
    for alpha in [1e-4, 0.1, 1.0] {
        all.extend([of("roughconductor", &ggx(alpha)), of("roughconductor", &beckmann(alpha))]);
        all.extend([of("roughdielectric", &(glass(1.5) + &ggx(alpha))), of("roughdielectric", &(glass(0.7) + &beckmann(alpha)))]);
    }
    for eta in [1.5, 1.0, 1.000_001, 0.6] {
        all.extend([of("dielectric", &glass(eta)), of("thindielectric", &glass(eta))]);
    }
    all.push(bsdf("twosided", &of("diffuse", &rgb("reflectance", "1, 1, 1"))));
    all
}

/// Whether a sample is one: finite, unit, on the side that its lobe says.
fn good(wo: Vec3, sample: &Scattered) -> bool {
    let made = match sample.made {
        Made::Smooth { pdf, pdf_rev } => pdf.0.is_finite() && pdf.0 > 0.0 && pdf_rev.0.is_finite() && pdf_rev.0 >= 0.0,
        Made::Delta { chance, chance_rev } => chance.0 > 0.0 && chance.0 <= 1.0 && (0.0..=1.0).contains(&chance_rev.0),
    };
    let side = if sample.lobe.intersects(Lobe::REFLECTION) { sample.wi.z * wo.z >= 0.0 } else { sample.wi.z * wo.z <= 0.0 };
    made && side && (sample.wi.length() - 1.0).abs() < 1e-3 && sample.weight.is_finite() && sample.weight.0.iter().all(|w| *w >= 0.0)
}

fn good_value(bsdf: &dyn Bsdf, wo: Vec3, wi: Vec3, carried: Carried) -> bool {
    let scatter = bsdf.eval(wo, wi, carried);
    let number = |x: f32| x.is_finite() && x >= 0.0;
    scatter.value.0.into_iter().all(number) && number(scatter.pdf.0) && number(scatter.pdf_rev.0)
}

const BOTH: [Carried; 2] = [Carried::Radiance, Carried::Importance];

fn slanted(cos: f32, phi: f32) -> Vec3 {
    let sin = (1.0 - cos * cos).max(0.0).sqrt();
    Vec3::new(sin * phi.cos(), sin * phi.sin(), cos)
}

/// Bad answers of every surface; `count` counts those of one.
fn bad_answers(form: Form, what: &str, count: impl Fn(&dyn Bsdf) -> usize) -> Vec<Held> {
    let all = all();
    vec![Held::none(format!("bad answers of {} surfaces{what}", all.len()), all.iter().map(|surface| asked(form, surface, &count)).sum())]
}

fn report(form: Form, kind: &str, given: &[(&str, Value)], native: &dyn Surfaces) -> Report {
    let settings = Settings { seed: 3, threads: 2, effort: Some(12) };
    if form == Form::Native {
        return check::bsdfs(native, &settings);
    }
    let module = module(kind);
    let given: Vec<_> = given.iter().map(|(name, value)| ((*name).to_owned(), value.clone())).collect();
    check::bsdfs(&Plugin::with(&module, &given).expect("parameters"), &settings)
}

fn module(kind: &str) -> Arc<Module> {
    let file = library().find(kind, &[]).expect("a module");
    Arc::new(Module::load(&Engine::new().expect("an engine"), &file).expect("a module"))
}

fn verdict(what: &str, report: &Report, test: Test) -> Held {
    let verdict = report.verdict(test).expect("a verdict");
    Held::new(format!("{what}: {}", test.promise()), verdict.statistic / verdict.threshold, 1.0)
}

/// The shaders that are linked in to be checked.
#[derive(Clone, Copy)]
enum Native {
    Metal(RoughConductor),
    Glass(RoughDielectric),
    Plastic(Plastic),
}

impl Native {
    fn get(&self) -> &dyn Bsdf {
        match self {
            Self::Metal(it) => it,
            Self::Glass(it) => it,
            Self::Plastic(it) => it,
        }
    }

    fn linked(self) -> Linked<impl Fn(usize) -> Self + Sync> {
        let promises = Promises { lobes: self.get().lobes(), reciprocal: true, isotropic: true };
        Linked::bsdfs(vec![Set::named("it")], promises, move |_| self)
    }
}

impl Bsdf for Native {
    fn eval(&self, wo: Vec3, wi: Vec3, carried: Carried) -> bidir_kernel::Scatter {
        self.get().eval(wo, wi, carried)
    }

    fn sample(&self, wo: Vec3, u: [f32; 3], carried: Carried) -> Option<Scattered> {
        self.get().sample(wo, u, carried)
    }

    fn lobes(&self) -> Lobe {
        self.get().lobes()
    }
}

fn narrow(form: Form) -> Vec<Held> {
    let microfacet = Microfacet { distribution: Distribution::Ggx, alpha_u: 1e-4, alpha_v: 1e-4 };
    let white = Spectrum::ONE;
    let metal = RoughConductor { eta: Spectrum::BLACK, k: white, specular_reflectance: white, microfacet };
    let glass = RoughDielectric { eta: 1.5, specular_reflectance: white, specular_transmittance: white, microfacet };
    let rough = [("alpha", Value::Float(1e-4)), ("distribution", Value::from("ggx"))];
    let index = [("int_ior", Value::Float(1.5)), ("ext_ior", Value::Float(1.0))];
    let metal = report(form, "roughconductor", &rough, &Native::Metal(metal).linked());
    let glass = report(form, "roughdielectric", &[rough, index].concat(), &Native::Glass(glass).linked());
    [("metal", metal), ("glass", glass)].map(|(what, report)| verdict(what, &report, Test::Mass)).to_vec()
}

/// Mean distances of sampled directions, and of their weights, from the mirror's.
fn to_the_mirror(form: Form) -> Vec<Held> {
    let alphas = [0.3, 0.1, 0.03, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 0.0];
    let wo = slanted(0.6, 0.4);
    let mirrored = Vec3::new(-wo.x, -wo.y, wo.z);
    let distance = |alpha: f64| {
        asked(form, &of("roughconductor", &ggx(alpha)), |bsdf| {
            let mut numbers = Independent::new(1, 2, 3);
            let far = |sample: Option<Scattered>| match sample {
                Some(sample) => f64::from((sample.wi - mirrored).length() + (1.0 - sample.weight.mean()).abs()),
                None => 2.0,
            };
            (0..2000).map(|_| far(bsdf.sample(wo, std::array::from_fn(|_| numbers.next()), Carried::Radiance))).sum::<f64>() / 2000.0
        })
    };
    let distances = alphas.map(distance);
    let growth = distances.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::NEG_INFINITY, worse);
    vec![
        Held::new("largest step away from the mirror as α falls from 0.3 to 0", growth, 0.0),
        Held::new("mean distance from the mirror at α = 1e-6", distances[7], 1e-5),
    ]
}

/// Mean distances of pixels from those of a mirror, under an even gradient, as shares of the mean.
fn to_its_picture(form: Form) -> Vec<Held> {
    let kind = if form == Form::Sandbox { ".wasm" } else { "" };
    let picture = |material: String| {
        let sky = scenes::emitter("envmap", r#"<string name="filename" value="sky.exr"/>"#);
        let content = [scenes::depth(2), scenes::pinhole(), scenes::ball(&material.replace("$kind", kind)), sky].concat();
        image(&files::read_text(&content), PATH, 256)
    };
    let mirror = picture(of("conductor", ""));
    let mean = mean_of(&mirror);
    let distance = |alpha: f64| {
        let rough = picture(of("roughconductor", &ggx(alpha)));
        let off = mirror.pixels.iter().flatten().zip(rough.pixels.iter().flatten()).map(|(a, b)| f64::from((a - b).abs()));
        off.sum::<f64>() / (3.0 * mirror.pixels.len() as f64 * mean)
    };
    let distances = [0.3, 0.1, 0.03, 0.01, 1e-6].map(distance);
    let growth = distances.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::NEG_INFINITY, worse);
    vec![
        Held::new("largest step of the picture away from the mirror's as α falls from 0.3 to 1e-6", growth, 0.0),
        Held::new("distance of the picture from the mirror's at α = 1e-6, relatively", distances[4], 1e-4),
    ]
}

/// A rough surface without roughness is the smooth one, bit by bit.
fn no_roughness(form: Form) -> Vec<Held> {
    let pairs = [
        (of("roughconductor", &ggx(0.0)), of("conductor", "")),
        (of("roughdielectric", &(glass(1.5) + &ggx(0.0))), of("dielectric", &glass(1.5))),
    ];
    let differ = |(rough, smooth): &(String, String)| {
        let answers = |material: &str| {
            asked(form, material, |bsdf| {
                let mut numbers = Independent::new(1, 2, 3);
                let ask = |_| bsdf.sample(slanted(numbers.next() - 0.5, 1.0), [0.1, 0.7, numbers.next()], Carried::Radiance);
                (0..1000).map(ask).map(|sample| sample.map(|sample| (sample.wi, sample.made))).collect::<Vec<_>>()
            })
        };
        answers(rough).iter().zip(answers(smooth)).filter(|(a, b)| **a != *b).count()
    };
    vec![Held::none("samples of 2,000 that differ from the smooth surface's", pairs.iter().map(differ).sum())]
}

fn ends() -> Vec<[f32; 3]> {
    let ends = [0.0, 0.5, ONE_MINUS_EPSILON];
    let pairs = ends.iter().flat_map(|&x| ends.iter().map(move |&y| (x, y)));
    pairs.flat_map(|(x, y)| ends.iter().map(move |&z| [x, y, z])).collect()
}

const COSINES: [f32; 11] = [1.0, 0.9, 0.5, 1e-3, 1e-7, 1e-12, -1e-12, -1e-7, -1e-3, -0.5, -1.0];

fn corners(form: Form) -> Vec<Held> {
    bad_answers(form, ", u in all corners", |bsdf| {
        let directions = COSINES.iter().flat_map(|cos| [slanted(*cos, 0.3), slanted(*cos, 2.1)]);
        let samples = directions.flat_map(|wo| ends().into_iter().flat_map(move |u| BOTH.map(|carried| (wo, u, carried))));
        samples.filter(|(wo, u, carried)| bsdf.sample(*wo, *u, *carried).is_some_and(|sample| !good(*wo, &sample))).count()
    })
}

/// Lights and lenses, asked in all corners.
fn corners_of_ends() -> Vec<Held> {
    let mut bad = 0;
    for file in of_case(22) {
        let subject = read(&file, Form::Native);
        let view = View::new(&subject.scene, Strictness::Strict);
        let lit = Point::free(Vec3::new(0.1, 0.3, 0.2));
        let unit = |w: Vec3| (w.length() - 1.0).abs() < 1e-3;
        let lights = (0..subject.scene.all_lights().sources().len()).map(|i| bidir::scene::lights::LightId(i as u32));
        for (id, u) in lights.flat_map(|id| ends().into_iter().map(move |u| (id, u))) {
            let light = view.light(id);
            for w in [0.0, ONE_MINUS_EPSILON] {
                let emitted = light.emit([u[0], u[1], u[2], w]);
                bad += usize::from(emitted.is_some_and(|e| !(unit(e.direction) && e.weight.is_finite() && e.point.position.is_finite())));
            }
            let arrived = light.illuminate(&lit, [u[0], u[1]]);
            bad += usize::from(arrived.is_some_and(|i| !(unit(i.direction) && i.weight.is_finite() && i.point.position.is_finite())));
        }
        for [x, y, z] in ends() {
            let seen = view.camera().look(Vec2::new(16.0 * x, 16.0 * y), [z, x]);
            bad += usize::from(!(unit(seen.direction) && seen.point.position.is_finite() && seen.weight.is_finite()));
            let shown = view.camera().see(&lit, [x, y]);
            bad += usize::from(shown.is_some_and(|seen| !(unit(seen.direction) && seen.weight.is_finite())));
        }
    }
    vec![Held::none("bad answers of lights and lenses, u in all corners", bad)]
}

fn grazing(form: Form) -> Vec<Held> {
    bad_answers(form, " at cos = ±1e-7", |bsdf| {
        let mut numbers = Independent::new(7, 1, 1);
        let mut bad = 0;
        for turn in 0..500 {
            let wo = slanted(if turn % 2 == 0 { 1e-7 } else { -1e-7 }, TAU * numbers.next());
            let u = std::array::from_fn(|_| numbers.next());
            let wi = slanted(2.0 * numbers.next() - 1.0, TAU * numbers.next());
            for carried in BOTH {
                bad += usize::from(bsdf.sample(wo, u, carried).is_some_and(|sample| !good(wo, &sample)));
                bad += usize::from(!good_value(bsdf, wo, wi, carried) || !good_value(bsdf, wi, wo, carried));
            }
        }
        bad
    })
}

/// How far samples stray from the straight way, and their weights from 1, at most; and the energy that is missing.
fn strays(form: Form, material: &str) -> (f64, f64) {
    asked(form, material, |bsdf| {
        let mut numbers = Independent::new(8, 1, 1);
        let (mut stray, mut energy) = (0.0, 0.0);
        for _ in 0..4000 {
            let cos = 0.1 + 0.9 * numbers.next();
            let wo = slanted(if numbers.next() < 0.5 { cos } else { -cos }, TAU * numbers.next());
            let sample = bsdf.sample(wo, std::array::from_fn(|_| numbers.next()), Carried::Radiance);
            let Some(sample) = sample else { continue };
            energy += f64::from(sample.weight.mean());
            stray = worse(stray, f64::from((sample.wi + wo).length()));
        }
        (stray, (energy / 4000.0 - 1.0).abs())
    })
}

fn straight_by(form: Form, eta: f64, bound: f64) -> Vec<Held> {
    let mut kinds = vec![("dielectric", glass(eta)), ("thindielectric", glass(eta))];
    // A rough boundary that is none is refused, as in Mitsuba.
    if eta != 1.0 {
        kinds.push(("roughdielectric", glass(eta) + &ggx(0.3)));
    }
    let held = |(kind, content): (&str, String)| {
        let (stray, missing) = strays(form, &of(kind, &content));
        [
            Held::new(format!("{kind}, η = {eta}: largest distance from the straight way"), stray, bound),
            Held::new(format!("{kind}, η = {eta}: energy off"), missing, bound),
        ]
    };
    kinds.into_iter().flat_map(held).collect()
}

fn straight(form: Form) -> Vec<Held> {
    straight_by(form, 1.0, 1e-6)
}

/// An index off by δ bends a ray by δ tan θ, and tan θ ≤ 10 here; facets at α = 0.3 lean further.
fn nearly_straight(form: Form) -> Vec<Held> {
    [1.000_001, 0.999_999].into_iter().flat_map(|eta| straight_by(form, eta, 1e-4)).collect()
}

/// From within, about the critical angle, in steps of one rounding: between what the two neighbouring cosines reflect in f64.
fn critical(form: Form) -> Vec<Held> {
    let reflectance = |cos: f64| {
        let squared = 1.0 - 2.25 * (1.0 - cos * cos);
        let inner = squared.max(0.0).sqrt();
        let (s, p) = ((1.5 * cos - inner) / (1.5 * cos + inner), (cos - 1.5 * inner) / (cos + 1.5 * inner));
        0.5 * (s * s + p * p)
    };
    let outside = asked(form, &of("dielectric", &glass(1.5)), |bsdf| {
        let mut worst = 0.0;
        let first = (1.0 - 1.0 / 2.25_f64).sqrt() as f32;
        for step in -20_000_i32..20_000 {
            let cos = f32::from_bits((first.to_bits() as i32 + step) as u32);
            let sample = bsdf.sample(slanted(-cos, 0.0), [0.5, 0.5, 0.0], Carried::Radiance).expect("a sample");
            let Made::Delta { chance, .. } = sample.made else { panic!("no delta") };
            let chance = f64::from(chance.0);
            let found = if sample.lobe == Lobe::DELTA_REFLECTION { chance } else { 1.0 - chance };
            // A direction's three coordinates are each rounded.
            let [low, high] = [2.0, -2.0].map(|ulps: f64| reflectance(f64::from(cos) + ulps * f64::from(f32::EPSILON)));
            worst = worse(worst, (low - found).max(found - high));
        }
        worst
    });
    vec![Held::new("reflectance outside what its neighbours in f64 have", outside, 1e-5)]
}

fn nested(form: Form) -> Vec<Held> {
    let kind = if form == Form::Sandbox { ".wasm" } else { "" };
    let shell = |radius: f64, inside: f64, outside: f64| {
        let content = of("dielectric", &(float("int_ior", inside) + &float("ext_ior", outside)));
        scenes::shape("sphere", &format!(r#"<scale value="{radius}"/><translate value="0, 0.9, 0"/>"#), &content)
    };
    let block = |eta| scenes::shape("cube", r#"<scale value="0.3"/><translate value="1, 0.3, 0.8"/>"#, &of("dielectric", &glass(eta)));
    // Of two in one place the first in the file is met; whatever else is in the file does not matter.
    let parts = [shell(0.8, 1.5, 1.0), shell(0.6, 1.33, 1.5), shell(0.4, 1.0, 1.33), block(1.5), block(1.33)];
    let picture = |order: &[usize]| {
        let things: String = order.iter().map(|i| parts[*i].as_str()).collect();
        let content = [scenes::depth(12), scenes::pinhole(), things, scenes::room(), scenes::panel()].concat().replace("$kind", kind);
        let subject = files::read_text(&content);
        [PATH, BDPT].map(|techniques| image(&subject, techniques, 16))
    };
    let first = picture(&[0, 1, 2, 3, 4]);
    let orders: [&[usize]; 3] = [&[2, 1, 0, 3, 4], &[1, 3, 0, 4, 2], &[3, 2, 4, 1, 0]];
    let differ = |order: &&[usize]| first.iter().zip(picture(order)).map(|(a, b)| different(a, &b)).sum::<usize>();
    vec![Held::none("pixels that change with the order of the shapes", orders.iter().map(differ).sum())]
}

fn degenerate(form: Form) -> Vec<Held> {
    bad_answers(form, " at ω_i = −ω_o and above n·v = 1", |bsdf| {
        let mut bad = 0;
        let longer = Vec3::new(1e-4, 0.0, 1.000_000_1);
        for wo in COSINES.iter().flat_map(|cos| [slanted(*cos, 0.0), slanted(*cos, 0.7)]).chain([longer, -longer]) {
            for (wi, carried) in [-wo, wo, longer, -longer].into_iter().flat_map(|wi| BOTH.map(|carried| (wi, carried))) {
                bad += usize::from(!good_value(bsdf, wo, wi, carried));
                let passes = bsdf.lobes().intersects(Lobe::SMOOTH_TRANSMISSION);
                bad += usize::from(wi == -wo && !passes && !bsdf.eval(wo, wi, carried).value.is_black());
                bad += usize::from(bsdf.sample(wo, [0.3, 0.6, 0.9], carried).is_some_and(|sample| !good(wo, &sample)));
            }
        }
        bad
    })
}

fn uneven(form: Form) -> Vec<Held> {
    let plastic = Native::Plastic(Plastic::new(1.5, Spectrum([0.6, 0.2, 0.1]), Spectrum::ONE, false));
    let block = module("coatedmirror").manifest().defaults();
    let lobes = Lobe::GLOSSY_REFLECTION | Lobe::DELTA_REFLECTION;
    let promises = Promises { lobes, reciprocal: true, isotropic: true };
    let coated = Linked::bsdfs(vec![Set::named("it")], promises, |_| coatedmirror::bsdf(&block));
    let plastic = report(form, "plastic", &[], &plastic.linked());
    let coated = report(form, "coatedmirror", &[], &coated);
    [("plastic", plastic), ("coatedmirror", coated)].map(|(what, report)| verdict(what, &report, Test::Paths)).to_vec()
}
