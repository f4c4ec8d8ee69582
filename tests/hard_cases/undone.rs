//! Ten cases with their guard undone: each has to turn red, or it guards nothing.

use bidir::{
    film::{Exposure, Film, Store, TileBuffer},
    plugin::Strictness,
    rays::Triangles,
    scene::{Scene, view::View},
};
use bidir_kernel::{
    Bsdf, Carried, Chance, Contribution, Film as _, Heuristic, Lobe, Point, Ray, Real, Sampler, Scatter, Scattered, Segment, Spectrum,
    Strategy, Technique, Techniques, Together, Vec2, Vec3, Walk, sample, sampler::Independent,
};
use bidir_tests::{
    estimators::difference,
    hard::{
        Form, Held, camera, chains, files, geometry,
        single::SingleSide,
        transforms::{Change, alike, changed},
    },
    pictures::{BATCHES, BDPT, LIGHT, PATH, Pictures, Subject},
};
use glam::DVec3;

/// What is taken away.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Guard {
    /// Nothing.
    None,
    /// What a shading normal does to importance.
    Adjoint,
    /// The η² of radiance.
    EtaSquared,
    /// Offsets that follow the rounding of a hit; this one does not.
    Offset(Real),
    /// The light's buffer is where the camera's is; this one is a pixel to the right.
    Place,
}

/// A scene without a guard.
struct Undone<'a> {
    view: View<'a>,
    guard: Guard,
}

#[derive(Clone, Copy)]
struct UndoneBsdf<B> {
    bsdf: B,
    point: Point,
    guard: Guard,
}

impl<B: Bsdf> UndoneBsdf<B> {
    fn factor(&self, wo: Vec3, wi: Vec3, carried: Carried, eta: Real) -> Real {
        let Point { normal, frame, .. } = &self.point;
        match self.guard {
            Guard::Adjoint if carried == Carried::Importance => {
                let above = |w: Vec3| frame.to_world(w).dot(*normal).abs();
                (above(wo) * wi.z.abs()) / (wo.z.abs() * above(wi)).max(1e-20)
            }
            Guard::EtaSquared if carried == Carried::Radiance => eta * eta,
            _ => 1.0,
        }
    }
}

impl<B: Bsdf> Bsdf for UndoneBsdf<B> {
    fn eval(&self, wo: Vec3, wi: Vec3, carried: Carried) -> Scatter {
        let scatter = self.bsdf.eval(wo, wi, carried);
        Scatter { value: scatter.value * self.factor(wo, wi, carried, 1.0), ..scatter }
    }

    fn sample(&self, wo: Vec3, u: [Real; 3], carried: Carried) -> Option<Scattered> {
        let sample = self.bsdf.sample(wo, u, carried)?;
        Some(Scattered { weight: sample.weight * self.factor(wo, sample.wi, carried, sample.eta), ..sample })
    }

    fn lobes(&self) -> Lobe {
        self.bsdf.lobes()
    }
}

impl<'v> bidir_kernel::Scene for Undone<'v> {
    type Hit = <View<'v> as bidir_kernel::Scene>::Hit;
    type LightId = <View<'v> as bidir_kernel::Scene>::LightId;
    type Camera = <View<'v> as bidir_kernel::Scene>::Camera;
    type Bsdf<'a>
        = UndoneBsdf<<View<'v> as bidir_kernel::Scene>::Bsdf<'a>>
    where
        Self: 'a;
    type Light<'a>
        = <View<'v> as bidir_kernel::Scene>::Light<'a>
    where
        Self: 'a;

    fn camera(&self) -> &Self::Camera {
        self.view.camera()
    }

    fn intersect(&self, ray: &Ray) -> Option<(Point, Self::Hit)> {
        let (point, hit) = self.view.intersect(ray)?;
        let offset = if let Guard::Offset(fixed) = self.guard { fixed } else { point.offset };
        Some((Point { offset, ..point }, hit))
    }

    fn unoccluded(&self, a: &Point, b: &Point, segment: Segment) -> bool {
        self.view.unoccluded(a, b, segment)
    }

    fn bsdf(&self, point: &Point, hit: Self::Hit) -> Self::Bsdf<'_> {
        UndoneBsdf { bsdf: self.view.bsdf(point, hit), point: *point, guard: self.guard }
    }

    fn light(&self, id: Self::LightId) -> Self::Light<'_> {
        self.view.light(id)
    }

    fn light_id_at(&self, hit: Self::Hit) -> Option<Self::LightId> {
        self.view.light_id_at(hit)
    }

    fn environment(&self) -> Option<Self::LightId> {
        self.view.environment()
    }

    fn pick_light(&self, lit: Option<&Point>, u: impl FnOnce() -> Real) -> Option<(Self::LightId, Chance)> {
        self.view.pick_light(lit, u)
    }

    fn light_chance(&self, id: Self::LightId, lit: Option<&Point>) -> Chance {
        self.view.light_chance(id, lit)
    }
}

/// A buffer that may be a pixel beside the other.
struct Exposed<'a>(&'a mut TileBuffer, Guard);

impl bidir_kernel::Film for Exposed<'_> {
    type Rivals = Together;

    fn add(&mut self, contribution: Contribution) {
        self.0.add(contribution);
    }

    fn splat(&mut self, raster: Vec2, contribution: Contribution) {
        let shift = if self.1 == Guard::Place { 1.0 } else { 0.0 };
        self.0.splat(Vec2::new((raster.x + shift).min(15.99), raster.y), contribution);
    }
}

/// Pictures without a guard.
fn pictures(subject: &Subject, guard: Guard, techniques: Techniques, samples: u32) -> Pictures {
    let strategy = subject.strategy(techniques, Heuristic::Balance);
    Pictures { batches: (0..BATCHES).map(|seed| picture(subject, guard, &strategy, samples, u64::from(seed))).collect() }
}

fn picture(subject: &Subject, guard: Guard, strategy: &Strategy, samples: u32, seed: u64) -> bidir::image::Image {
    let scene = Undone { view: View::new(&subject.scene, Strictness::Strict), guard };
    let film = Film::new(&subject.description.film).expect("a film");
    let [mut seen, mut lit] = [0; 2].map(|_| (0..8).map(|_| None).collect::<Vec<_>>());
    while let Some(mut buffer) = film.claim(samples) {
        let unit = buffer.unit();
        for (x, y) in film.pixels(&unit) {
            let mut numbers = Independent::new(seed, u64::from(y * subject.description.film.width + x), u64::from(unit.sample));
            numbers.seek(Walk::Camera, 0);
            let [dx, dy] = numbers.next_pair();
            let raster = Vec2::new(x as f32 + dx, y as f32 + dy);
            buffer.begin(raster);
            sample(&scene, strategy, &mut numbers, raster, &mut seen, &mut lit, &mut Exposed(&mut buffer, guard));
            buffer.end();
        }
        film.commit(buffer);
    }
    film.develop()
}

fn scene(name: &str) -> Subject {
    let number = name[..2].parse().expect("a number");
    let file = files::of_case(number).into_iter().find(|file| file.file_stem().is_some_and(|stem| stem == name)).expect("a scene");
    files::read(&file, Form::Native)
}

fn turns_red(what: &str, held: &[Held]) {
    for held in held {
        println!("{what}, {}: {:e}, at most {:e}", held.what, held.worst, held.bound);
    }
    assert!(held.iter().any(|held| !held.holds()), "{what} is not noticed: {held:#?}");
}

fn stays_green(what: &str, held: &[Held]) {
    assert!(held.iter().all(Held::holds), "{what}: {held:#?}");
}

/// The other estimator's deviation from path tracing.
fn agreement(subject: &Subject, guard: Guard, techniques: Techniques) -> Vec<Held> {
    let (path, other) = (pictures(subject, guard, PATH, 64), pictures(subject, guard, techniques, 64));
    let found = difference(&other, &path);
    vec![Held::new("deviation, as a share of what chance explains", found.deviation / found.threshold, 1.0)]
}

#[test]
fn case_09_without_the_squared_index_of_radiance() {
    let subject = scene("09_inside_glass");
    let held = |guard| {
        let found = pictures(&subject, guard, PATH, 256);
        files::known("path", &found.mean(found.whole(), &[0, 1, 2]), 2.25, 0.01)
    };
    stays_green("with the guard", &held(Guard::None));
    turns_red("without η²", &held(Guard::EtaSquared));
}

#[test]
fn case_14_with_the_other_lobes_chance_on_the_way_back() {
    use bidir::check::{self, Linked, Promises, Set, Settings, Test};
    let held = |mistake| {
        let clear = move |_| wrong::Wrong::new(mistake, wrong::Base::Clear, 0.2, Spectrum::ONE);
        let promises = Promises { lobes: Lobe::DELTA_REFLECTION | Lobe::DELTA_TRANSMISSION, reciprocal: true, isotropic: true };
        let report =
            check::bsdfs(&Linked::bsdfs(vec![Set::named("glass")], promises, clear), &Settings { seed: 1, threads: 2, effort: Some(12) });
        let verdict = report.verdict(Test::Paths).expect("a verdict");
        vec![Held::new("weights' sum", verdict.statistic / verdict.threshold, 1.0)]
    };
    stays_green("with the guard", &held(0));
    turns_red("the other lobe's chance", &held(30));
}

#[test]
fn case_21_in_coordinates_that_do_not_begin_in_the_middle() {
    let subject = scene("22_lights");
    let as_it_is = changed(&subject, &Change::scaled(1.0));
    let far = Change::moved(1e5).of(&subject.description, 4.0);
    let away = DVec3::new(0.64, -0.48, 0.6) * 4e5;
    let apart = |description: bidir::scene::description::Description| {
        let scene = Scene::new(&description).expect("a scene");
        alike("4e5 away", &as_it_is, &Subject { description, scene })
    };
    stays_green("with the guard", &apart(far.clone()));
    turns_red("with a thing on the other side of the origin", &apart(geometry::anchored(far, away)));
}

#[test]
fn case_22_with_one_offset_for_all_sizes() {
    let subject = scene("22_lens");
    let small = changed(&subject, &Change::scaled(1e-6));
    let strategy = subject.strategy(BDPT, Heuristic::Balance);
    let held = |guard| {
        let mean = |subject| bidir_tests::pictures::mean_of(&picture(subject, guard, &strategy, 64, 1));
        vec![Held::new("the mean's relative change", (mean(&small) / mean(&subject) - 1.0).abs(), 0.01)]
    };
    stays_green("with the guard", &held(Guard::None));
    turns_red("an offset of 1e-4", &held(Guard::Offset(1e-4)));
}

#[test]
fn case_24_without_the_adjoint_factor() {
    let subject = scene("24_matt");
    stays_green("with the guard", &agreement(&subject, Guard::None, LIGHT));
    turns_red("without the adjoint factor", &agreement(&subject, Guard::Adjoint, LIGHT));
}

#[test]
fn case_29_with_a_test_that_is_not_watertight() {
    let lost = |triangles| vec![Held::none("rays that get out", geometry::lost_rays(1.0, 1e3, 1_000_000, triangles))];
    stays_green("with the guard", &lost(Triangles::Watertight));
    turns_red("the fast test", &lost(Triangles::Fast));
}

#[test]
fn case_46_with_the_lights_buffer_a_pixel_to_the_right() {
    let subject = camera::edges(camera::BOX);
    let held = |guard| vec![camera::pixel_by_pixel("box", &pictures(&subject, guard, PATH, 64), &pictures(&subject, guard, LIGHT, 512))];
    stays_green("with the guard", &held(Guard::None));
    turns_red("a pixel to the right", &held(Guard::Place));
}

/// A sum that takes whatever comes, in place of the film.
#[test]
fn case_48_with_a_sum_that_takes_whatever_comes() {
    let subject = scene("22_lens");
    let film = Film::new(&subject.description.film).expect("a film");
    let mut buffer = film.claim(1).expect("a buffer");
    let mut plain = Spectrum::BLACK;
    buffer.begin(Vec2::new(0.5, 0.5));
    for value in [1.0, Real::NAN, Real::INFINITY] {
        let contribution = Contribution { value: Spectrum::splat(value), weight: 1.0, technique: Technique { s: 0, t: 2 } };
        buffer.add(contribution);
        plain += contribution.value * contribution.weight;
    }
    buffer.end();
    film.commit(buffer);
    let bad = |values: &[Real]| vec![Held::none("values that are no finite number", values.iter().filter(|v| !v.is_finite()).count())];
    stays_green("the film", &bad(film.develop().pixels.as_flattened()));
    turns_red("a plain sum", &bad(&plain.0));
}

#[test]
fn case_49_with_sums_in_f32() {
    turns_red("sums in f32", &chains::SPECULAR.held::<SingleSide>());
}

#[test]
fn case_50_with_sums_in_f32() {
    turns_red("sums in f32", &chains::GLOSSY.held::<SingleSide>());
}
