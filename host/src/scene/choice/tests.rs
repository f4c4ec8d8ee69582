//! The choice among lights, of all kinds and anywhere.

mod random;

use bidir_kernel::{Chance, Light as _, Point, Real, Spectrum, Vec3, math};
use bidir_standard::Area;

use self::random::{Random, all_kinds, far, point, receiver, sandbox};
use super::{shares::STEPS, *};
use crate::scene::{
    extent::{Flat, LightExtent, Parallelogram},
    lights::ProfileSource,
};

/// Sets of more than a few lights.
fn sets(sandbox: &Sandbox) -> Vec<(String, Lights)> {
    let about = |count: usize| all_kinds(count, 1.0, Vec3::ZERO, count as u64, sandbox);
    let mut sets: Vec<_> = [17, 40, 333].map(|count| (format!("{count} of all kinds"), about(count))).into();
    sets.push(("with a sky".into(), [about(60), far(0, sandbox)].concat()));
    sets.push(("with a sky and many suns".into(), [far(30, sandbox), about(40)].concat()));
    sets.push(("a sky and many suns".into(), far(30, sandbox)));
    sets.push(("one of them near".into(), [far(30, sandbox), about(1)].concat()));
    sets.into_iter().map(|(name, sources)| (name, Lights::new(sources).0)).collect()
}

fn chances(lights: &Lights, lit: &Point, sandbox: &Sandbox) -> Vec<f64> {
    (0..lights.sources.len() as u32).map(|id| f64::from(lights.chance(LightId(id), Some(lit), sandbox).0)).collect()
}

#[test]
fn what_is_picked_by_power_and_what_is_asked_agree_whatever_lights_are_black() {
    let intensities = [0.0, 1.0, 0.0, 1e-12, 3.0, 0.0];
    let sandbox = sandbox();
    let (lights, ids) = Lights::new(intensities.map(|intensity| point(Vec3::ZERO, intensity, &sandbox)).to_vec());
    assert_eq!(ids, [None, Some(LightId(0)), None, Some(LightId(1)), Some(LightId(2)), None]);
    let mut total = 0.0;
    for id in 0..3 {
        let Chance(chance) = lights.chance(LightId(id), None, &sandbox);
        // The first and the last number of the light's own.
        let first = f64::from(total);
        total += chance;
        for u in [first, f64::from(total) - 1.0 / STEPS as f64] {
            assert_eq!(lights.pick(None, u as Real, &sandbox), Some((LightId(id), Chance(chance))), "{u}");
        }
        assert!(chance > 0.0);
    }
    assert_eq!(total, 1.0);
}

#[test]
fn many_lights_share_all_the_chance_there_is() {
    let sandbox = sandbox();
    let (lights, _) = Lights::new((0..1000).map(|i| point(Vec3::ZERO, if i == 500 { 1e6 } else { 1e-6 }, &sandbox)).collect());
    let sum: f64 = (0..1000).map(|id| f64::from(lights.chance(LightId(id), None, &sandbox).0)).sum();
    assert_eq!(sum, 1.0);
}

#[test]
fn what_is_picked_and_what_is_asked_afterwards_agree_bit_for_bit() {
    let sandbox = sandbox();
    let mut random = Random(1);
    for (name, lights) in sets(&sandbox) {
        for _ in 0..4000 {
            let lit = random.receiver(1.0);
            let Some((id, Chance(picked))) = lights.pick(Some(&lit), random.unit(), &sandbox) else { continue };
            let Chance(asked) = lights.chance(id, Some(&lit), &sandbox);
            assert!(picked > 0.0 && picked <= 1.0 && picked.to_bits() == asked.to_bits(), "{name}: {id:?} {picked} {asked} {lit:?}");
        }
    }
}

#[test]
fn a_receiver_infinitely_far_away_has_the_choice_by_power() {
    let sandbox = sandbox();
    for (name, lights) in sets(&sandbox) {
        let lit = Point::distant(Vec3::ONE, Vec3::Z);
        for u in [0.0, 0.3, 0.99] {
            assert_eq!(lights.pick(Some(&lit), u, &sandbox), lights.pick(None, u, &sandbox), "{name}");
        }
        for id in (0..lights.sources.len() as u32).map(LightId) {
            assert_eq!(lights.chance(id, Some(&lit), &sandbox), lights.chance(id, None, &sandbox), "{name}");
        }
    }
}

#[test]
fn chances_add_up_to_one() {
    let sandbox = sandbox();
    let mut random = Random(2);
    for (name, lights) in sets(&sandbox) {
        for _ in 0..300 {
            let lit = random.receiver(1.0);
            let sum: f64 = chances(&lights, &lit, &sandbox).iter().sum();
            assert!((sum - 1.0).abs() < 1e-5, "{name}: {sum} {lit:?}");
        }
    }
}

/// χ² over lights with five expected picks at least and the rest together; its limit by Wilson and Hilferty 1931, at 5e-6 for each of 28.
#[test]
fn lights_are_picked_as_often_as_their_chances_say() {
    const PICKS: usize = 200_000;
    let sandbox = sandbox();
    let mut random = Random(3);
    for (name, lights) in sets(&sandbox) {
        for lit in (0..4).map(|_| random.receiver(1.0)).collect::<Vec<_>>() {
            let mut counts = vec![0_usize; lights.sources.len()];
            for _ in 0..PICKS {
                let (LightId(id), _) = lights.pick(Some(&lit), random.unit(), &sandbox).expect("a light");
                counts[id as usize] += 1;
            }
            let (mut chi, mut cells, mut rest) = (0.0, 0, (0.0, 0.0));
            let mut cell = |expected: f64, found: f64| {
                chi += (found - expected) * (found - expected) / expected;
                cells += 1;
            };
            for (chance, &count) in chances(&lights, &lit, &sandbox).into_iter().zip(&counts) {
                assert!(chance > 0.0 || count == 0, "{name}");
                let expected = chance * PICKS as f64;
                if expected >= 5.0 { cell(expected, count as f64) } else { rest = (rest.0 + expected, rest.1 + count as f64) }
            }
            if rest.0 >= 5.0 {
                cell(rest.0, rest.1);
            }
            let k = 2.0 / (9.0 * f64::from(cells - 1).max(1.0));
            let limit = f64::from(cells - 1).max(1.0) * (1.0 - k + 4.42 * k.sqrt()).powi(3);
            println!("{name}: χ² {chi:.1} of {limit:.1}, {cells} cells, {PICKS} picks");
            assert!(chi < limit, "{name}: χ² {chi} over {cells} cells, limit {limit}");
        }
    }
}

/// Picks of what a sampler's 24 bits cannot tell apart: 100,000 lights, most of which are chosen once in 2^26 or less each.
#[test]
fn chances_below_a_samplers_step_are_met_too() {
    let sandbox = sandbox();
    let mut random = Random(4);
    let faint = |i: usize| !i.is_multiple_of(100);
    let sources = (0..100_000).map(|i| point(random.cube(), if faint(i) { 1e-5 } else { 1.0 }, &sandbox));
    let (lights, _) = Lights::new(sources.collect());
    let (mut expected, mut found, mut picks) = (0.0, 0.0, 0.0);
    let lit = receiver(Vec3::new(8.0, 0.0, 0.0), Vec3::X);
    let all = chances(&lights, &lit, &sandbox);
    assert!(all.iter().all(|&chance| chance > 0.0) && all.iter().any(|&chance| chance < 0.25 / STEPS as f64));
    let per_pick: f64 = all.iter().enumerate().filter(|(i, _)| faint(*i)).map(|(_, chance)| chance).sum();
    for _ in 0..400_000 {
        let (LightId(id), _) = lights.pick(Some(&lit), random.unit(), &sandbox).expect("a light");
        found += f64::from(u8::from(faint(id as usize)));
        expected += per_pick;
        picks += 1.0;
    }
    let sigmas = (found - expected) / f64::sqrt(expected * (1.0 - per_pick));
    println!("{found} of {picks} picks for {expected:.0}: {sigmas:.2} σ");
    assert!(sigmas.abs() < 4.5, "{found} for {expected}");
}

#[test]
fn no_light_that_reaches_a_receiver_is_left_out() {
    let sandbox = sandbox();
    let mut random = Random(5);
    for (name, lights) in sets(&sandbox) {
        for _ in 0..200 {
            let lit = random.receiver(1.0);
            for (id, chance) in (0..).map(LightId).zip(chances(&lights, &lit, &sandbox)) {
                let mut brings = || {
                    let sampled = lights.get(id, &sandbox).illuminate(&lit, [random.unit(), random.unit()]);
                    sampled.is_some_and(|sampled| !sampled.weight.is_black() && sampled.weight.is_finite())
                };
                assert!(chance > 0.0 || !(0..8).any(|_| brings()), "{name}: {id:?} {:?} {lit:?}", lights.sources[id.0 as usize].seat);
            }
        }
    }
}

/// Powers go with areas, so that every light's share of what arrives stays. Sizes that are powers of two change no digit; elsewhere,
/// nodes are rounded by up to 1 % each.
#[test]
fn the_choice_is_the_same_at_any_size_and_place() {
    let sandbox = sandbox();
    let at = |scale: Real, about: Vec3| Lights::new(all_kinds(200, scale, about, 7, &sandbox)).0;
    let lights = at(1.0, Vec3::ZERO);
    let exact = [(1.0 / 1_048_576.0, Vec3::ZERO, 0.0), (1_048_576.0, Vec3::ZERO, 0.0)];
    let rounded = [(1e-6, Vec3::ZERO, 0.05), (1e6, Vec3::ZERO, 0.05), (1.0, Vec3::new(4.0, -2.0, 3.0), 0.05)];
    for (scale, about, slack) in exact.into_iter().chain(rounded) {
        let (other, mut random, mut same) = (at(scale, about), Random(8), 0);
        for _ in 0..300 {
            let lit = random.receiver(1.0);
            let moved = receiver(about + lit.position * scale, lit.normal);
            let all = chances(&lights, &lit, &sandbox).into_iter().zip(chances(&other, &moved, &sandbox));
            let apart: f64 = all.map(|(here, there)| 0.5 * (here - there).abs()).sum();
            assert!(apart <= slack, "scale {scale} about {about}: {apart} {lit:?}");
            let u = random.unit();
            let ids = [(&lights, &lit), (&other, &moved)].map(|(lights, lit)| lights.pick(Some(lit), u, &sandbox).map(|(id, _)| id));
            same += u32::from(ids[0] == ids[1]);
        }
        println!("scale {scale} about {about}: {same} of 300 picks are the same");
        assert!(same >= if slack == 0.0 { 299 } else { 280 }, "{same} of 300 picks");
    }
}

/// Chances are finite, add up, and are those of what is picked.
fn sound(name: &str, lights: &Lights, lit: &Point, sandbox: &Sandbox) {
    let all = chances(lights, lit, sandbox);
    let sum: f64 = all.iter().sum();
    assert!(all.iter().all(|chance| (0.0..=1.0).contains(chance)) && (sum - 1.0).abs() < 1e-5, "{name}: {sum} {lit:?}");
    for i in 0..64 {
        let (id, chance) = lights.pick(Some(lit), i as Real / 64.0, sandbox).expect("a light");
        assert_eq!(lights.chance(id, Some(lit), sandbox), chance, "{name}");
    }
}

#[test]
fn lights_and_receivers_in_extreme_places_are_chosen_among_soundly() {
    let sandbox = sandbox();
    let points = |at: &dyn Fn(usize) -> Vec3, count: usize| Lights::new((0..count).map(|i| point(at(i), 1.0, &sandbox)).collect()).0;
    let sets: [(&str, Lights); 6] = [
        ("in one place", points(&|_| Vec3::new(1.0, 2.0, 3.0), 40)),
        ("17 alike", points(&|_| Vec3::X, 17)),
        ("in a row", points(&|i| Vec3::X * i as Real, 100)),
        ("ever nearer", points(&|i| Vec3::X * math::pow(0.5, i as Real), 120)),
        ("tiny", points(&|i| Vec3::new(i as Real, (i * i % 7) as Real, 0.0) * 1e-6, 50)),
        ("huge", points(&|i| Vec3::new(i as Real, (i * i % 7) as Real, 0.0) * 1e6, 50)),
    ];
    let places = [Vec3::ZERO, Vec3::ONE, Vec3::splat(1e-20), Vec3::splat(1e18), Vec3::new(0.5, 1e-7, 0.0), Vec3::new(2.5e6, 1.0, 1.0)];
    for (name, lights) in &sets {
        for (position, normal) in places.into_iter().flat_map(|position| [(position, Vec3::Z), (position, Vec3::X)]) {
            sound(name, lights, &receiver(position, normal), &sandbox);
            sound(name, lights, &Point::free(position), &sandbox);
        }
    }
    // On a light among others, and on the only place that there is: nothing comes from there.
    sound("on one of a row", &sets[2].1, &receiver(Vec3::X * 7.0, Vec3::Z), &sandbox);
    assert_eq!(sets[1].1.pick(Some(&receiver(Vec3::X, Vec3::Z)), 0.5, &sandbox), None);
    // Lights alike are alike.
    for chance in chances(&sets[1].1, &receiver(Vec3::ZERO, Vec3::X), &sandbox) {
        assert!(chance > 0.02 && chance < 0.12, "{chance}");
    }
}

#[test]
fn a_receiver_behind_all_lights_is_sent_none() {
    let sandbox = sandbox();
    let panel = |i: usize| {
        let flat = Flat::new(Vec3::new(i as Real, 0.0, 0.0), Vec3::X * 0.1, Vec3::Y * 0.1, 1.0, 4.0);
        let profile = ProfileSource::Area(Area { radiance: Spectrum::ONE });
        LightSource::new(Seat::Shape(LightExtent::Parallelogram(Parallelogram(flat))), profile, &sandbox)
    };
    let (lights, _) = Lights::new((0..100).map(panel).collect());
    let behind = receiver(Vec3::new(40.0, 3.0, -70.0), Vec3::Z);
    assert_eq!(lights.pick(Some(&behind), 0.5, &sandbox), None);
    assert!(chances(&lights, &behind, &sandbox).iter().all(|&chance| chance == 0.0));
    assert!(lights.pick(Some(&receiver(Vec3::new(40.0, 3.0, 70.0), Vec3::Z)), 0.5, &sandbox).is_some());
}

/// What a tree is for: next to one of a thousand lamps, that one is mostly chosen.
#[test]
fn the_nearest_of_a_thousand_lamps_is_mostly_chosen() {
    let sandbox = sandbox();
    let (lights, _) = Lights::new((0..1024).map(|i| point(Vec3::new((i % 32) as Real, (i / 32) as Real, 3.0), 1.0, &sandbox)).collect());
    let lit = receiver(Vec3::new(10.0, 20.0, 2.9), Vec3::Z);
    let Chance(chance) = lights.chance(LightId(20 * 32 + 10), Some(&lit), &sandbox);
    assert!(chance > 0.5, "{chance}");
}
