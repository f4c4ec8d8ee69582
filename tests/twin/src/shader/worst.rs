//! The worst answer of one shader, in units of what moved inputs explain.

use std::ops::Range;

use crate::{
    double::world::Answer,
    held::{Held, relative},
    nudge::Nudge,
};

/// Runs of the f64 shader with moved inputs; and as many where those do not explain a difference, since a few moves at random
/// may all be small, or miss an edge that lies near.
const FEW: u64 = 8;
const MANY: u64 = 512;

/// What differences are measured in is never less than this, relatively: a few operations of f32.
const FLOOR: f64 = 4.0 * f32::EPSILON as f64;

/// In such units: no chain of operations in a shader is longer.
const BOUND: f64 = 8.0;

/// The worst answer of one shader.
pub struct Worst {
    measure: &'static str,
    name: String,
    asked: u64,
    edges: u64,
    score: f64,
    what: String,
}

impl Worst {
    pub fn new(measure: &'static str, name: &str) -> Self {
        Self { measure, name: name.to_owned(), asked: 0, edges: 0, score: 0.0, what: String::new() }
    }

    /// Scores an answer by a few moved ones, or by many.
    pub fn see(
        &mut self,
        found: Option<&[f64]>,
        exact: Option<&Answer>,
        moved: &dyn Fn(&Nudge) -> Option<Answer>,
        groups: &[Range<usize>],
        asked: impl Fn() -> String,
    ) {
        self.asked += 1;
        let moves = |count: u64| (0..count).map(|k| moved(&Nudge::new(Some(self.asked * count + k)))).collect::<Vec<_>>();
        let mut scored = score(found, exact, &moves(FEW), groups);
        if scored.as_ref().is_some_and(|(score, _)| *score > 0.5 * BOUND) {
            scored = score(found, exact, &moves(MANY), groups);
        }
        let Some((score, group)) = scored else {
            self.edges += 1;
            return;
        };
        if !(score <= self.score) {
            let said = |numbers: Option<&[f64]>| format!("{:?}", numbers.map(|numbers| &numbers[group.clone()]));
            let (single, double) = (said(found), said(exact.map(|exact| &exact.numbers[..])));
            self.what = format!("{}, numbers {group:?}: {single} in f32, {double} in f64", asked());
            self.score = score;
        }
    }

    pub fn held(self) -> Held {
        let what = format!("{}, {}", self.name, self.what);
        Held { measure: self.measure, worst: self.score, bound: BOUND, parted: self.edges as f64 / self.asked as f64, what }
    }
}

/// The worst group of numbers that belong together, in units of what moved inputs explain. `None` where they lead to another
/// lobe or to nothing: which one it is is for rounding to say.
fn score(found: Option<&[f64]>, exact: Option<&Answer>, moved: &[Option<Answer>], groups: &[Range<usize>]) -> Option<(f64, Range<usize>)> {
    let nothing = |numbers: &[f64]| numbers[groups[0].clone()].iter().all(|x| *x == 0.0);
    let kind = |answer: Option<&Answer>| answer.map(|answer| (answer.lobe, nothing(&answer.numbers)));
    if moved.iter().any(|answer| kind(answer.as_ref()) != kind(exact)) {
        return None;
    }
    let (Some(found), Some(exact)) = (found, exact) else {
        let worst = if found.is_some() || exact.is_some() { f64::INFINITY } else { 0.0 };
        return Some((worst, groups[0].clone()));
    };
    let scored = groups.iter().map(|group| {
        let off = |numbers: &[f64]| relative(&numbers[group.clone()], &exact.numbers[group.clone()]);
        let unit = moved.iter().flatten().map(|answer| off(&answer.numbers)).fold(FLOOR, f64::max);
        let worst = off(found) / unit;
        (if worst.is_nan() { f64::INFINITY } else { worst }, group.clone())
    });
    scored.max_by(|a, b| a.0.total_cmp(&b.0))
}
