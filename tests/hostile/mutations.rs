//! Valid modules with random damage: whatever comes of them, the process neither panics, hangs nor grows.
//!
//! `BIDIR_MUTATIONS=100000` makes as many as that.

use std::{
    fs,
    path::Path,
    sync::atomic::{AtomicU64, Ordering},
    time::{Duration, Instant},
};

use bidir::plugin::{Kind, Strictness};
use bidir_kernel::{Bsdf, Carried, Profile, Vec2, Vec3};

use super::{Dice, load_bytes, sandbox};

const EVALUATIONS: usize = 100;

/// Bytes before the first section.
const HEADER: usize = 8;

/// Every module of the renderer.
fn originals() -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../plugins/prebuilt");
    let files = fs::read_dir(folder).expect("the prebuilt modules").map(|entry| entry.expect("an entry").path());
    let mut modules: Vec<_> = files.filter(|path| path.extension().is_some_and(|extension| extension == "wasm")).collect();
    modules.sort();
    modules.iter().map(|path| fs::read(path).expect("a module")).collect()
}

/// A place anywhere, but seldom in the header.
fn place(dice: &mut Dice, length: usize) -> usize {
    if length > HEADER && dice.below(50) > 0 { HEADER + dice.below(length - HEADER) } else { dice.below(length) }
}

/// Begins and ends in order.
fn range(dice: &mut Dice, length: usize) -> (usize, usize) {
    let begin = place(dice, length);
    (begin, begin + dice.below((length - begin).min(200)))
}

/// One to four pieces of damage.
fn damage(dice: &mut Dice, originals: &[Vec<u8>]) -> Vec<u8> {
    let mut bytes = originals[dice.below(originals.len())].clone();
    for _ in 0..=dice.below(4) {
        let at = place(dice, bytes.len());
        match dice.below(10) {
            0..=3 => bytes[at] ^= 1 << dice.below(8),
            4..=6 => bytes[at] = dice.below(256) as u8,
            7 => {
                let other = &originals[dice.below(originals.len())];
                let (begin, end) = range(dice, other.len());
                let until = (at + end - begin).min(bytes.len());
                bytes.splice(at..until, other[begin..end].iter().copied());
            }
            8 => {
                let (begin, end) = range(dice, bytes.len());
                let copy = bytes[begin..end].to_vec();
                bytes.splice(at..at, copy);
            }
            _ => {
                let (begin, end) = range(dice, bytes.len());
                bytes.drain(begin..end);
                if bytes.len() < 2 * HEADER || dice.below(4) == 0 {
                    bytes.truncate(at.max(1));
                }
            }
        }
        if bytes.is_empty() {
            break;
        }
    }
    bytes
}

#[derive(Default)]
struct Outcomes {
    refused: AtomicU64,
    faulted: AtomicU64,
    quarantined: AtomicU64,
    answered: AtomicU64,
}

/// Loads a module, and asks it if it can be asked.
fn attempt(dice: &mut Dice, bytes: &[u8], outcomes: &Outcomes) {
    let count = |of: &AtomicU64| of.fetch_add(1, Ordering::Relaxed);
    let Ok(module) = load_bytes(bytes) else {
        count(&outcomes.refused);
        return;
    };
    let (sandbox, shader) = sandbox(&module, &module.manifest().defaults(), Strictness::Lenient);
    for _ in 0..EVALUATIONS / 2 {
        let direction = |dice: &mut Dice| Vec3::new(dice.number() - 0.5, dice.number() - 0.5, dice.number() - 0.3).normalize();
        let (wo, wi) = (direction(dice), direction(dice));
        let u = [dice.number(), dice.number(), dice.number()];
        if module.manifest().kind == Kind::Bsdf {
            let scatter = sandbox.bsdf(shader).eval(wo, wi, Carried::Radiance);
            assert!(scatter.value.0.iter().chain([&scatter.pdf.0]).all(|value| value.is_finite() && *value >= 0.0));
            let scattered = sandbox.bsdf(shader).sample(wo, u, Carried::Importance);
            assert!(scattered.is_none_or(|scattered| scattered.weight.0.iter().all(|value| value.is_finite() && *value >= 0.0)));
        } else {
            let profiled = sandbox.profile(shader).eval(Vec2::new(u[0], u[1]), wi);
            assert!(profiled.radiance.0.iter().all(|value| value.is_finite() && *value >= 0.0));
            let emitted = sandbox.profile(shader).emit(Vec2::new(u[0], u[1]), [u[1], u[2]]);
            assert!(emitted.is_none_or(|emitted| emitted.profiled.radiance.0.iter().all(|value| value.is_finite() && *value >= 0.0)));
        }
        if let Some(fault) = sandbox.fault() {
            assert!(fault.to_string().starts_with("hostile.wasm: "), "{fault}");
            count(&outcomes.faulted);
            return;
        }
    }
    count(if sandbox.quarantine().count() > 0 { &outcomes.quarantined } else { &outcomes.answered });
}

/// The most memory that this process has had, MB; `None` where the system does not say.
fn peak() -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.split_whitespace().next()?.parse().ok().map(|kilobytes: u64| kilobytes / 1024)
}

/// Loading and a hundred calls that each take nearly all their time, on a machine that does other things as well.
const LONG: Duration = Duration::from_secs(30);

#[test]
fn random_damage_to_modules_does_no_harm() {
    let total: u64 = std::env::var("BIDIR_MUTATIONS").map_or(2_000, |count| count.parse().expect("BIDIR_MUTATIONS is a number"));
    let (originals, next, outcomes) = (originals(), AtomicU64::new(0), Outcomes::default());
    let start = Instant::now();
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    if index >= total {
                        break;
                    }
                    let (mut dice, start) = (Dice(index << 32), Instant::now());
                    let bytes = damage(&mut dice, &originals);
                    attempt(&mut dice, &bytes, &outcomes);
                    assert!(start.elapsed() < LONG, "mutation {index} took {:?}", start.elapsed());
                }
            });
        }
    });
    let [refused, faulted, quarantined, answered] =
        [outcomes.refused, outcomes.faulted, outcomes.quarantined, outcomes.answered].map(AtomicU64::into_inner);
    println!("{total} mutations of {} modules in {:?}; peak memory {:?} MB", originals.len(), start.elapsed(), peak());
    println!("{refused} refused, {faulted} faulted, {quarantined} gave bad answers, {answered} answered");
    assert_eq!(refused + faulted + quarantined + answered, total);
    // Damage that is always noticed, or never, would test nothing.
    assert!(refused > total / 20 && answered > total / 20);
    assert!(peak().is_none_or(|megabytes| megabytes < 2048), "{:?} MB", peak());
}
