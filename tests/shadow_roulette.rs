//! Roulette on shadow rays: fewer of them, the same picture in the mean, and the same bits however a render is cut up.

use std::sync::atomic::AtomicBool;

use bidir::{
    film::Film,
    image::Image,
    plan::{Plan, Stage},
    render::{self, Director, Given, Job, Leg, Status, Target},
    scene::Scene,
};
use bidir_kernel::{Heuristic, Techniques};

use crate::{
    pictures::{BATCHES, BDPT, LIGHT, PATH, Pictures, Subject},
    scenes::*,
    statistics::threshold,
};

const ESTIMATORS: [(&str, Techniques); 3] = [("path", PATH), ("light", LIGHT), ("bdpt", BDPT)];

fn subject(size: u32) -> Subject {
    let camera = camera("perspective", &film_with(size, size, r#"<rfilter type="gaussian"/>"#));
    read(&[depth(6), camera, room(), ball(&bsdf("plastic", "")), panel()].concat())
}

fn stage(techniques: Techniques, share: f64) -> Stage {
    Stage { shadow_roulette: share, ..Stage::of(&techniques) }
}

fn given(subject: &Subject, stages: &[Stage]) -> Given {
    Given { plan: Plan { stages: stages.to_vec() }, integrator: subject.description.integrator.clone() }
}

fn rendered(subject: &Subject, mut director: impl Director, samples: u32, seed: u64, threads: usize) -> (Image, Status) {
    let film = Film::new(&subject.description.film).expect("a film");
    let job = Job { threads, ..subject.job(subject.strategy(Techniques::NONE, Heuristic::Balance), samples, seed) };
    let status = render::directed(&subject.scene, &film, &job, &mut director, &AtomicBool::new(false), |_| None);
    assert!(status.fault.is_none() && status.samples == samples && film.refused() == 0);
    (film.develop(), status)
}

fn pictures(subject: &Subject, stage: Stage, samples: u32, seed: u64) -> Pictures {
    let batch = |i| rendered(subject, given(subject, &[stage]), samples, seed * 1000 + u64::from(i), 1).0;
    Pictures { batches: (0..BATCHES).map(batch).collect() }
}

/// What each batch has more than the other.
fn apart(found: &Pictures, wanted: &Pictures) -> Pictures {
    let minus = |a: &[f32; 3], b: &[f32; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    let one = |(a, b): (&Image, &Image)| Image { pixels: a.pixels.iter().zip(&b.pixels).map(|(a, b)| minus(a, b)).collect(), ..*a };
    Pictures { batches: found.batches.iter().zip(&wanted.batches).map(one).collect() }
}

/// The same walks with and without: what is left of their difference is roulette's alone. Under a share of 100, one contribution in a
/// hundred or fewer casts a ray: noisy, and still right.
#[test]
fn any_share_leaves_the_mean_as_it_is() {
    const SHARES: [(f64, f64); 3] = [(0.1, 0.0005), (1.0, 0.003), (100.0, 0.05)];
    let subject = subject(16);
    for (seed, (name, techniques)) in (1..).zip(ESTIMATORS) {
        let wanted = pictures(&subject, stage(techniques, 0.0), 32, seed);
        for (share, doubt) in SHARES {
            let found = apart(&pictures(&subject, stage(techniques, share), 32, seed), &wanted);
            let places = || std::iter::once(wanted.whole()).chain(wanted.blocks());
            for place in places() {
                let (mean, apart) = (wanted.mean(place, &[0, 1, 2]).mean, found.mean(place, &[0, 1, 2]));
                let comparisons = ESTIMATORS.len() * SHARES.len() * places().count();
                let (deviation, limit) = (apart.deviation(mean), threshold(comparisons, apart.degrees));
                let (off, error) = (100.0 * apart.mean / mean, 100.0 * apart.error / mean);
                println!("{name}, share {share}, {place:?}: {off:+.4} % ± {error:.4} %, {deviation:.2} σ of {limit:.2}");
                assert!(deviation < limit, "{name}, share {share}, {place:?}: {apart:?} of {mean}");
                assert!(place != wanted.whole() || apart.error < doubt * mean, "too little to tell: {apart:?} of {mean}");
            }
        }
    }
}

/// Walks take no notice of it: they cast the same rays.
#[test]
fn it_spares_shadow_rays_and_no_others() {
    let subject = subject(24);
    for ((name, techniques), most) in ESTIMATORS.into_iter().zip([0.95, 0.95, 0.75]) {
        let rays = |share| rendered(&subject, given(&subject, &[stage(techniques, share)]), 16, 1, 1).1.rays;
        let (all, fewer) = (rays(0.0), rays(0.3));
        let left = fewer.any as f64 / all.any as f64;
        println!("{name}: {:.1} % of the shadow rays are left", 100.0 * left);
        assert_eq!(all.closest, fewer.closest);
        assert!(left < most, "{name}: {all:?} {fewer:?}");
    }
}

/// Ends a pass after every so many samples.
struct Cut(Given, u32);

impl Director for Cut {
    fn next(&mut self, scene: &Scene, job: &Job, status: &Status) -> Leg {
        let leg = self.0.next(scene, job, status);
        Leg { end: leg.end.min(status.samples + self.1), ..leg }
    }
}

#[test]
fn threads_and_passes_change_no_bit() {
    let subject = subject(40);
    for (name, techniques) in ESTIMATORS {
        let stages = [stage(techniques, 0.2), Stage { from: 3, ..stage(techniques, 0.0) }, Stage { from: 5, ..stage(techniques, 0.4) }];
        let (once, _) = rendered(&subject, given(&subject, &stages), 11, 7, 1);
        assert_ne!(once, rendered(&subject, given(&subject, &stages[1..2]), 11, 7, 1).0, "{name}: no roulette was played");
        for threads in [2, 3] {
            assert!(rendered(&subject, given(&subject, &stages), 11, 7, threads).0 == once, "{name}, {threads} threads");
        }
        for every in [1, 3] {
            let cut = Cut(given(&subject, &stages), every);
            assert!(rendered(&subject, cut, 11, 7, 2).0 == once, "{name}, passes of {every}");
        }
    }
}

/// Ctrl-C during a pass ends it after a sample that nobody planned.
#[test]
fn an_interrupted_render_is_a_shorter_one() {
    let subject = subject(40);
    let stage = stage(BDPT, 0.2);
    let film = Film::new(&subject.description.film).expect("a film");
    let job = Job { threads: 2, target: Target::Samples(1 << 20), ..subject.job(subject.strategy(BDPT, Heuristic::Balance), 1, 7) };
    let flag = AtomicBool::new(false);
    let status = std::thread::scope(|scope| {
        let under_way = scope.spawn(|| render::directed(&subject.scene, &film, &job, &mut given(&subject, &[stage]), &flag, |_| None));
        std::thread::sleep(std::time::Duration::from_millis(300));
        flag.store(true, std::sync::atomic::Ordering::Relaxed);
        under_way.join().expect("a render")
    });
    println!("interrupted after {} samples", status.samples);
    assert!(status.interrupted && status.samples > 0);
    assert!(rendered(&subject, given(&subject, &[stage]), status.samples, 7, 1).0 == film.develop());
}
