//! The weights of all ways to make one path.
//!
//! A path that bounces off surfaces of the BSDF is made by sampling, some of its vertices from the camera's side and some from the
//! light's. Each technique then weighs it as the renderer does: with what the camera walk was told at its vertices, what the light walk
//! was told at its own, and what `eval` says at the two that are joined. Every one of them asks about the same path from another
//! place, so the weights sum to 1 just if all answers fit together.

use bidir_kernel::{
    Bsdf, Carried, Chance, Heuristic, Join, Lobe, Made, Real, Scattered, Technique, Vec3,
    weight::{Rivals, Side, Step, share},
};

use super::view;
use crate::check::{
    case,
    dice::Dice,
    ledger::{Inputs, Ledger},
    subject::Set,
    tally::Tally,
    test::Test,
};

/// Vertices on surfaces of one path, at most.
const MOST: usize = 6;

/// Directions tried before a vertex is given up.
const TRIES: usize = 4;

/// Draws that look for the way back of a delta sample.
const DRAWS: usize = 256;

/// Chances below this are left alone: their way back is seldom drawn.
const RARE: f64 = 0.05;

/// A density or chance of going on, and of going back.
#[derive(Clone, Copy, Debug)]
struct Told {
    pdf: f64,
    pdf_rev: f64,
}

/// A surface that the path bounces off.
#[derive(Clone, Copy, Debug)]
struct Vertex {
    /// Towards the lens, and towards the light.
    wo: Vec3,
    wi: Vec3,
    /// Of a delta: what rounding of the directions does to its chances, relatively.
    delta: Option<f64>,
    /// What each walk is told when it goes through, and when it ends here to be joined.
    camera: Told,
    light: Told,
    camera_end: Told,
    light_end: Told,
}

/// A path: x_0 on a light, its vertices from there on, the last one on the lens.
struct Path {
    vertices: Vec<Vertex>,
    /// How densely the light and the lens send their walks out.
    emitted: f64,
    seen: f64,
    /// What turns a density at x_i into one of x_{i+1}, and at x_{i+1} into one of x_i.
    forward: Vec<f64>,
    backward: Vec<f64>,
}

pub(super) fn judge(bsdf: &dyn Bsdf, set: &Set, count: usize, ledger: &mut Ledger, dice: &mut Dice) {
    let mut tally = Tally::new(Test::Paths);
    for _ in 0..count {
        let Some(path) = Path::new(bsdf, dice) else { continue };
        for heuristic in [Heuristic::Balance, Heuristic::Power] {
            let spread = || path.vertices.iter().map(|vertex| vertex.spread(bsdf, dice)).sum();
            tally.take(path.sum(heuristic), 1.0, spread, |sum| path.described(sum, &set.words));
        }
    }
    tally.settle(ledger);
}

/// The sample as a walk through it is told; see `bidir_kernel`'s vertices for how a refracted bundle widens.
fn told(wo: Vec3, sample: &Scattered) -> Told {
    let (pdf, pdf_rev) = match sample.made {
        Made::Smooth { pdf, pdf_rev } => (f64::from(pdf.0), f64::from(pdf_rev.0)),
        Made::Delta { chance: Chance(chance), chance_rev: Chance(chance_rev) } => {
            let eta = f64::from(sample.eta);
            (f64::from(chance), f64::from(chance_rev) * f64::from(wo.z.abs()) / (eta * eta * f64::from(sample.wi.z.abs())))
        }
    };
    Told { pdf, pdf_rev }
}

/// What `eval` tells of a direction.
fn evaluated(bsdf: &dyn Bsdf, wo: Vec3, wi: Vec3, carried: Carried) -> Told {
    let scatter = bsdf.eval(wo, wi, carried);
    Told { pdf: f64::from(scatter.pdf.0), pdf_rev: f64::from(scatter.pdf_rev.0) }
}

impl Told {
    /// As seen by whoever comes the other way.
    fn turned(self) -> Self {
        Self { pdf: self.pdf_rev, pdf_rev: self.pdf }
    }

    fn apart(self, other: Self) -> f64 {
        let off = |a: f64, b: f64| if a == b { 0.0 } else { (a - b).abs() / a.abs().max(b.abs()) };
        off(self.pdf, other.pdf).max(off(self.pdf_rev, other.pdf_rev))
    }
}

impl Vertex {
    /// A vertex through which a walk of either kind was sampled.
    fn new(bsdf: &dyn Bsdf, dice: &mut Dice) -> Option<Self> {
        let (wo, u, from_camera) = (dice.direction(), dice.three(), dice.below(2) == 0);
        let (carried, other) =
            if from_camera { (Carried::Radiance, Carried::Importance) } else { (Carried::Importance, Carried::Radiance) };
        let sample = bsdf.sample(wo, u, carried)?;
        let wi = sample.wi;
        let there = told(wo, &sample);
        // No path goes where nothing is carried on.
        if sample.weight.is_black() || !(there.pdf > 0.0 && wi.z != 0.0 && wo.z != 0.0) {
            return None;
        }
        let (near, far) = (evaluated(bsdf, wo, wi, carried), evaluated(bsdf, wi, wo, other));
        let (back, delta) = if sample.lobe.intersects(Lobe::SMOOTH) {
            (far, None)
        } else if there.pdf < RARE {
            return None;
        } else {
            let (back, rounding) = way_back(bsdf, wo, &sample, other, dice)?;
            (back, Some(rounding))
        };
        Some(if from_camera {
            Self { wo, wi, delta, camera: there, light: back, camera_end: near, light_end: far }
        } else {
            Self { wo: wi, wi: wo, delta, camera: back, light: there, camera_end: far, light_end: near }
        })
    }

    /// What rounding of the directions does to any of its answers, relatively.
    fn spread(&self, bsdf: &dyn Bsdf, dice: &Dice) -> f64 {
        let of = |wo, wi| view::spread(bsdf, wo, wi, Carried::Radiance, dice);
        self.delta.unwrap_or_else(|| of(self.wo, self.wi).max(of(self.wi, self.wo)))
    }

    /// How far the two walks disagree.
    fn disagreement(&self) -> f64 {
        self.camera.apart(self.light.turned())
    }
}

/// What a walk is told that comes back through a delta sample, and what rounding may do to it. `None` where the way back is not found:
/// `reverse` asks for it.
fn way_back(bsdf: &dyn Bsdf, wo: Vec3, there: &Scattered, carried: Carried, dice: &mut Dice) -> Option<(Told, f64)> {
    let of = |wo: Vec3, u: [Real; 3]| bsdf.sample(wo, u, carried).filter(|sample| sample.lobe == there.lobe);
    let (u, found) = (0..DRAWS).find_map(|_| {
        let u = dice.three();
        of(there.wi, u).map(|sample| (u, sample))
    })?;
    let back = told(there.wi, &found);
    let mut spread: f64 = 0.0;
    for _ in 0..4 {
        // Beside the critical angle a neighbour may be reflected totally.
        let wi = dice.nudged(there.wi);
        spread = spread.max(of(wi, u).map_or(1.0, |moved| told(wi, &moved).apart(back)));
    }
    let grazing = f64::from(Real::EPSILON) / f64::from(wo.z.abs().min(there.wi.z.abs()));
    Some((back, spread + grazing))
}

impl Path {
    fn new(bsdf: &dyn Bsdf, dice: &mut Dice) -> Option<Self> {
        let count = 1 + dice.below(MOST);
        let vertices: Vec<_> = (0..count).filter_map(|_| (0..TRIES).find_map(|_| Vertex::new(bsdf, dice))).collect();
        let k = vertices.len() + 1;
        // Cosines at both ends of each segment over its squared length.
        let cosine = |i: usize, w: fn(&Vertex) -> Vec3| vertices.get(i).map_or(0.7, |vertex| f64::from(w(vertex).z.abs()));
        let squares: Vec<_> = (0..k).map(|_| 0.25 * 16f64.powf(dice.exact())).collect();
        let forward = (0..k).map(|i| cosine(i, |vertex| vertex.wi) / squares[i]).collect();
        let backward = (0..k).map(|i| i.checked_sub(1).map_or(0.7, |i| cosine(i, |vertex| vertex.wo)) / squares[i]).collect();
        (k > 1).then(|| Self { emitted: 0.3 * dice.exact() + 0.1, seen: 0.3 * dice.exact() + 0.1, vertices, forward, backward })
    }

    /// Its length: x_1 … x_{k−1} lie on surfaces.
    fn k(&self) -> usize {
        self.vertices.len() + 1
    }

    fn at(&self, i: usize) -> Option<&Vertex> {
        i.checked_sub(1).and_then(|i| self.vertices.get(i))
    }

    fn delta(&self, i: usize) -> bool {
        self.at(i).is_some_and(|vertex| vertex.delta.is_some())
    }

    /// The light walk's first s vertices.
    fn light_side(&self, s: usize, heuristic: Heuristic) -> Side {
        (1..s).fold(Side::start(heuristic, 1.0, Join::LightHit, 1.0), |side, i| {
            let told = self.at(i - 1).map_or(Told { pdf: self.emitted, pdf_rev: 0.0 }, |vertex| vertex.light);
            side.advance(heuristic, &self.step(told, i - 1, self.forward[i - 1], self.backward[i - 1]))
        })
    }

    /// The camera walk's first t vertices.
    fn camera_side(&self, t: usize, heuristic: Heuristic) -> Side {
        let k = self.k();
        (1..t).fold(Side::start(heuristic, 1.0, Join::LensHit, 1.0), |side, made| {
            let i = k - made;
            let told = self.at(i + 1).map_or(Told { pdf: self.seen, pdf_rev: 0.0 }, |vertex| vertex.camera);
            side.advance(heuristic, &self.step(told, i + 1, self.backward[i], self.forward[i]))
        })
    }

    fn step(&self, told: Told, from: usize, forward: f64, backward: f64) -> Step {
        Step { pdf: told.pdf, pdf_rev: told.pdf_rev, delta: self.delta(from), forward, backward, join: Join::Connection, effort: 1.0 }
    }

    /// The weight of the technique that makes s vertices from the light.
    fn weight(&self, s: usize, heuristic: Heuristic) -> f64 {
        let k = self.k();
        // A walk's own end: what it tells of going on from its newest vertex, joined to the other's.
        let near = self.at(s).map_or(Told { pdf: self.seen, pdf_rev: 0.0 }, |vertex| vertex.camera_end);
        let others = match (Technique { s: s as u32, t: (k + 1 - s) as u32 }).join() {
            // The end that is landed on tells how densely it would have sent out the walk.
            Join::LightHit => self.camera_side(k + 1, heuristic).sum(heuristic, 1.0, self.emitted),
            Join::LensHit => self.light_side(k + 1, heuristic).sum(heuristic, 1.0, self.seen),
            Join::NextEvent | Join::Connection | Join::LensSplat => {
                let far = self.at(s - 1).map_or(Told { pdf: self.emitted, pdf_rev: 0.0 }, |vertex| vertex.light_end);
                let (to_far, to_near) = (near.pdf * self.backward[s - 1], far.pdf * self.forward[s - 1]);
                let made_less = self.light_side(s, heuristic).sum(heuristic, to_far, far.pdf_rev);
                made_less.and(self.camera_side(k + 1 - s, heuristic).sum(heuristic, to_near, near.pdf_rev))
            }
        };
        share(1.0, others.total())
    }

    /// The sum of all techniques' weights.
    fn sum(&self, heuristic: Heuristic) -> f64 {
        let exists = |s: &usize| !(self.delta(*s) || *s > 0 && self.delta(s - 1));
        (0..=self.k() + 1).filter(exists).map(|s| self.weight(s, heuristic)).sum()
    }

    /// Where the walks disagree most, and in words what that comes to.
    fn described(&self, sum: f64, set: &str) -> (Inputs, String) {
        let odder = |a: &&Vertex, b: &&Vertex| a.disagreement().total_cmp(&b.disagreement());
        let Some(Vertex { wo, wi, .. }) = self.vertices.iter().max_by(odder) else { return Default::default() };
        let place = super::at(&[set, &view::angle(wo.to_array())]);
        let bounces = match self.vertices.len() {
            1 => "1 bounce".to_owned(),
            many => format!("{many} bounces"),
        };
        let words = format!(
            "the weights of all ways to make a path of {bounces} sum to {sum:.3}, and must to 1; there and back differ most{place}"
        );
        let carried = Some(case::word(Carried::Radiance));
        (Inputs { wo: Some(wo.to_array()), wi: Some(wi.to_array()), carried, ..Inputs::default() }, words)
    }
}
