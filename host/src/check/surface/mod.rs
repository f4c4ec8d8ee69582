//! The tests of BSDFs, cut into pieces.

mod batches;
mod delta;
mod edges;
mod pairs;
mod paths;
mod purity;
mod statistics;
mod view;

use bidir_kernel::{Carried, Lobe, Vec3};

pub(super) use self::edges::{corners, directions};
use self::view::View;
use super::{
    case::Case,
    dice::{Dice, stream},
    ledger::{Inputs, Ledger},
    report::names,
    subject::{Instance, Promises, Surfaces},
    test::Test,
};
use crate::plugin::{Asked, Flaw};

/// A piece of a check: one set of parameters, seen from one direction, or where there is none, all over.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    pub(super) set: usize,
    pub(super) stream: u64,
    pub(super) view: Option<(Vec3, Carried)>,
}

/// Angles to the normal, in degrees: on the front, and on the back.
const FRONT: [f64; 9] = [0.0, 15.0, 30.0, 45.0, 60.0, 75.0, 85.0, 89.0, 89.9];
const BACK: [f64; 4] = [0.0, 30.0, 60.0, 85.0];

/// Every piece of a check.
pub(super) fn pieces(sets: usize, seed: u64) -> Vec<Piece> {
    let mut pieces = Vec::new();
    for set in 0..sets {
        let next = |pieces: &Vec<Piece>| stream(seed, pieces.len() as u64);
        let whole = Piece { set, stream: next(&pieces), view: None };
        pieces.push(whole);
        for (at, (angle, side)) in FRONT.map(|angle| (angle, 1.0)).into_iter().chain(BACK.map(|angle| (angle, -1.0))).enumerate() {
            let stream = next(&pieces);
            let phi = std::f64::consts::TAU * Dice::new(stream).exact();
            let (sin, cos) = angle.to_radians().sin_cos();
            let wo = Vec3::new((sin * phi.cos()) as f32, (sin * phi.sin()) as f32, (side * cos) as f32);
            let carried = if (set + at).is_multiple_of(2) { Carried::Radiance } else { Carried::Importance };
            pieces.push(Piece { set, stream, view: Some((wo, carried)) });
        }
    }
    pieces
}

/// Does a piece with 2 to the power of `effort` samples.
pub(super) fn run(surfaces: &dyn Surfaces, piece: &Piece, effort: u32) -> Ledger {
    let (mut ledger, mut dice) = (Ledger::default(), Dice::new(piece.stream));
    let (surface, set) = (surfaces.open(), &surfaces.sets()[piece.set]);
    match piece.view {
        Some((wo, carried)) => {
            let bsdf = surface.bsdf(piece.set);
            let view = View { bsdf: &*bsdf, set, wo, carried, promises: surfaces.promises() };
            let samples = 1 << effort;
            statistics::judge(&view, samples, &mut ledger, &mut dice);
            pairs::judge(&view, samples / 32, &mut ledger, &mut dice);
            delta::judge(&view, samples, &mut ledger, &mut dice);
            batches::judge(&view, &mut ledger, &mut dice);
        }
        None => {
            edges::ask(&*surface.bsdf(piece.set), &mut ledger);
            purity::judge(surfaces, piece.set, &mut ledger, &mut dice);
            paths::judge(&*surface.bsdf(piece.set), set, (1 << effort) / 32, &mut ledger, &mut dice);
        }
    }
    answered(&*surface, &set.words, &mut ledger);
    let case = |test| Case { test, stream: piece.stream, effort, view: piece.view, parameters: set.name.clone() };
    ledger.signed(case)
}

/// What went wrong with the answers themselves.
pub(super) fn answered<I: Instance + ?Sized>(instance: &I, words: &str, ledger: &mut Ledger) {
    let refusals = instance.refusals();
    for test in [Test::Range, Test::Lobes] {
        let of = |flaw: &Flaw| if matches!(flaw, Flaw::WrongLobe(_)) { Test::Lobes } else { Test::Range };
        let worst = refusals.iter().filter(|refusal| of(&refusal.flaw) == test).max_by_key(|refusal| refusal.count);
        if test == Test::Lobes && worst.is_none() {
            continue;
        }
        ledger.demand(test, worst.is_none(), || match worst {
            None => Default::default(),
            Some(refusal) => {
                (inputs(&refusal.asked), format!("{}: {}{}", refusal.asked.export(), refusal.flaw, place_of(&refusal.asked, words)))
            }
        });
    }
    let broken = instance.broken();
    ledger.demand(Test::Calls, broken.is_none(), || (Inputs::default(), format!("{}{}", broken.unwrap_or_default(), at(&[words]))));
}

/// ` at …, …`, of the parts that say something.
pub(super) fn at(parts: &[&str]) -> String {
    let parts: Vec<_> = parts.iter().copied().filter(|part| !part.is_empty()).collect();
    if parts.is_empty() { String::new() } else { format!(" at {}", parts.join(", ")) }
}

fn place_of(asked: &Asked, words: &str) -> String {
    let wo = match asked {
        Asked::Eval { wo, .. } | Asked::Sample { wo, .. } => view::angle(*wo),
        Asked::Emit { u, .. } => format!("u = {u:?}"),
        Asked::Profile { w, .. } => format!("w = {w:?}"),
    };
    at(&[words, &wo])
}

fn inputs(asked: &Asked) -> Inputs {
    let word = |carried: &Carried| Some(super::case::word(*carried));
    match asked {
        Asked::Eval { wo, wi, carried } => Inputs { wo: Some(*wo), wi: Some(*wi), carried: word(carried), ..Inputs::default() },
        Asked::Sample { wo, u, carried } => Inputs { wo: Some(*wo), u: Some(*u), carried: word(carried), ..Inputs::default() },
        Asked::Emit { uv, u } => Inputs { uv: Some(*uv), u: Some([u[0], u[1], 0.0]), ..Inputs::default() },
        Asked::Profile { uv, w } => Inputs { uv: Some(*uv), direction: Some(*w), ..Inputs::default() },
    }
}

/// Whether each declared lobe was observed: what only all pieces together can tell.
pub(super) fn lobes(promises: Promises, ledger: &mut Ledger) {
    let missing = Lobe(promises.lobes.0 & !ledger.observed);
    ledger.demand(Test::Lobes, missing == Lobe::NONE, || {
        (Inputs::default(), format!("{} is declared, and no sample came from it with any parameters", names(missing).join(", ")))
    });
}
