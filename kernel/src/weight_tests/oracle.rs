//! The definition of the weights, kept beside the fast sums: every density multiplied out, in f64 and in the log domain.
//!
//! The kernel's own tests hold its sums against it, and so do those that ask what f32 would do.

extern crate std;

use std::vec::Vec;

use super::kernel::{
    technique::{Heuristic, Join, Technique, Techniques},
    weight::{Rivals, Side, Step, share},
};

/// What adds up the techniques on one side of a join: [`Side`], or another form of it.
pub trait Sums: Sized {
    /// See [`Side::start`].
    fn start(heuristic: Heuristic, end: f64, join: Join, hit: f64) -> Self;
    /// See [`Side::advance`].
    fn advance(&self, heuristic: Heuristic, step: &Step) -> Self;
    /// See [`Side::sum`].
    fn sum(&self, heuristic: Heuristic, across: f64, pdf_rev: f64) -> f64;
    /// See [`Side::sum_of_hit`].
    fn sum_of_hit(&self, heuristic: Heuristic, end: f64, pdf_rev: f64, instead: (Join, f64)) -> f64;
}

impl<R: Rivals> Sums for Side<R> {
    fn start(heuristic: Heuristic, end: f64, join: Join, hit: f64) -> Self {
        Side::start(heuristic, end, join, hit)
    }

    fn advance(&self, heuristic: Heuristic, step: &Step) -> Self {
        Side::advance(self, heuristic, step)
    }

    fn sum(&self, heuristic: Heuristic, across: f64, pdf_rev: f64) -> f64 {
        Side::sum(self, heuristic, across, pdf_rev).total()
    }

    fn sum_of_hit(&self, heuristic: Heuristic, end: f64, pdf_rev: f64, instead: (Join, f64)) -> f64 {
        Side::sum_of_hit(self, heuristic, end, pdf_rev, instead).total()
    }
}

/// A path of length k in numbers alone. Index i is vertex x_i, x_0 on the light, x_k on the lens.
pub struct Path {
    /// Per direction (or chance): how densely x_i sends the light walk on to x_{i+1}, and the camera walk on to x_{i−1}.
    pub to_lens: Vec<f64>,
    /// See `to_lens`.
    pub to_light: Vec<f64>,
    /// What turns a density at x_i into one of x_{i+1} (`forward`), at x_{i+1} into one of x_i (`backward`).
    pub forward: Vec<f64>,
    /// See `forward`.
    pub backward: Vec<f64>,
    /// Whether the scattering at x_i is a Dirac; the endpoints': whether they cannot be hit.
    pub delta: Vec<bool>,
    /// Density of x_0, by emission.
    pub light_end: f64,
    /// Of x_0, by next event.
    pub next_event_end: f64,
    /// Of x_k.
    pub lens_end: f64,
}

/// Random numbers.
pub struct Numbers(pub u64);

impl Numbers {
    /// In [0, 1).
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
    /// A power of ten between two.
    pub fn decades(&mut self, low: f64, high: f64) -> f64 {
        libm::exp10(low + (high - low) * self.unit())
    }
}

impl Path {
    /// Densities and conversions at random, each over twice so many decades; Diracs with a chance.
    pub fn random(k: usize, decades: f64, deltas: f64, numbers: &mut Numbers) -> Self {
        let mut many = |n: usize| (0..n).map(|_| numbers.decades(-decades, decades)).collect::<Vec<_>>();
        let (to_lens, to_light, forward, backward) = (many(k + 1), many(k + 1), many(k), many(k));
        let delta = (0..=k).map(|_| numbers.unit() < deltas).collect();
        let mut one = || numbers.decades(-decades, decades);
        Self { to_lens, to_light, forward, backward, delta, light_end: one(), next_event_end: one(), lens_end: one() }
    }

    /// Its length.
    pub fn k(&self) -> usize {
        self.delta.len() - 1
    }

    /// L_i.
    fn made_by_light(&self, i: usize) -> f64 {
        if i == 0 { self.light_end } else { self.to_lens[i - 1] * self.forward[i - 1] }
    }

    /// E_i.
    fn made_by_camera(&self, i: usize) -> f64 {
        if i == self.k() { self.lens_end } else { self.to_light[i + 1] * self.backward[i] }
    }

    /// c_s: both ends of the join must have a density, and an endpoint that is landed on must not be a Dirac.
    fn exists(&self, s: usize) -> bool {
        let k = self.k();
        match s {
            0 => !self.delta[0],
            s if s == k + 1 => !self.delta[k],
            s => (s == 1 || !self.delta[s - 1]) && (s == k || !self.delta[s]),
        }
    }

    fn technique(&self, s: usize) -> Technique {
        Technique { s: s as u32, t: (self.k() + 1 - s) as u32 }
    }

    /// ln(n_s p_s), every density multiplied out, in the log domain: the definition. Next event makes x_0 with a density of its own.
    pub fn log_effort(&self, s: usize, techniques: &Techniques) -> Option<f64> {
        let technique = self.technique(s);
        let effort = techniques.effort(technique.join());
        if !self.exists(s) || effort <= 0.0 {
            return None;
        }
        let mut sum = libm::log(effort);
        for i in 0..=self.k() {
            let density = if i >= s {
                self.made_by_camera(i)
            } else if i == 0 && technique.join() == Join::NextEvent {
                self.next_event_end
            } else {
                self.made_by_light(i)
            };
            sum += libm::log(density);
        }
        Some(sum)
    }

    /// The weight, as it is defined.
    pub fn definition(&self, s: usize, techniques: &Techniques, heuristic: Heuristic) -> f64 {
        let power = if heuristic == Heuristic::Power { 2.0 } else { 1.0 };
        let Some(own) = self.log_effort(s, techniques) else { return 0.0 };
        let sum: f64 =
            (0..=self.k() + 1).filter_map(|j| self.log_effort(j, techniques)).map(|other| libm::exp(power * (other - own))).sum();
        1.0 / sum
    }

    /// The light walk's first `s` vertices.
    pub fn light_side<S: Sums>(&self, s: usize, techniques: &Techniques, heuristic: Heuristic) -> S {
        let mut side = S::start(heuristic, self.light_end, Join::LightHit, if self.delta[0] { 0.0 } else { techniques.light_hit });
        for i in 1..s {
            let (join, effort) = match i {
                i if i == self.k() => (Join::LensSplat, techniques.lens_splat),
                1 => (Join::NextEvent, techniques.next_event * self.next_event_end / self.light_end),
                _ => (Join::Connection, techniques.connection),
            };
            side = side.advance(
                heuristic,
                &Step {
                    pdf: self.to_lens[i - 1],
                    pdf_rev: if i == 1 { 0.0 } else { self.to_light[i - 1] },
                    delta: i > 1 && self.delta[i - 1],
                    forward: self.forward[i - 1],
                    backward: self.backward[i - 1],
                    join,
                    effort,
                },
            );
        }
        side
    }

    /// The camera walk's first `t` vertices.
    pub fn camera_side<S: Sums>(&self, t: usize, techniques: &Techniques, heuristic: Heuristic) -> S {
        let k = self.k();
        let mut side = S::start(heuristic, self.lens_end, Join::LensHit, if self.delta[k] { 0.0 } else { techniques.lens_hit });
        for made in 1..t {
            let i = k - made;
            let join = if made == 1 { Join::LensSplat } else { Join::Connection };
            side = side.advance(
                heuristic,
                &Step {
                    pdf: self.to_light[i + 1],
                    pdf_rev: if made == 1 { 0.0 } else { self.to_lens[i + 1] },
                    delta: made > 1 && self.delta[i + 1],
                    forward: self.backward[i],
                    backward: self.forward[i],
                    join,
                    effort: techniques.effort(join),
                },
            );
        }
        side
    }

    /// The weight as the walks compute it, join by join.
    pub fn weight<S: Sums>(&self, s: usize, techniques: &Techniques, heuristic: Heuristic) -> f64 {
        let k = self.k();
        if self.log_effort(s, techniques).is_none() {
            return 0.0;
        }
        let join = self.technique(s).join();
        let own = heuristic.of(techniques.effort(join));
        let light =
            |s: usize| self.light_side::<S>(s, techniques, heuristic).sum(heuristic, self.made_by_camera(s - 1), self.to_light[s - 1]);
        let camera =
            |s: usize| self.camera_side::<S>(k + 1 - s, techniques, heuristic).sum(heuristic, self.made_by_light(s), self.to_lens[s]);
        match join {
            Join::LightHit => {
                let side = self.camera_side::<S>(k + 1, techniques, heuristic);
                let smooth = k == 1 || !self.delta[1];
                let instead = match (smooth, k) {
                    (false, _) => (Join::NextEvent, 0.0),
                    (true, 1) => (Join::LensSplat, heuristic.of(techniques.lens_splat * self.light_end)),
                    (true, _) => (Join::NextEvent, heuristic.of(techniques.next_event * self.next_event_end)),
                };
                share(own, side.sum_of_hit(heuristic, self.light_end, self.to_lens[0], instead))
            }
            Join::NextEvent => {
                let hit = if self.delta[0] { 0.0 } else { heuristic.of(techniques.light_hit * self.made_by_camera(0)) };
                share(heuristic.of(techniques.next_event * self.next_event_end), hit + heuristic.of(self.light_end) * camera(1))
            }
            Join::LensHit => share(own, light(k + 1)),
            Join::LensSplat => {
                let hit = if self.delta[k] { 0.0 } else { heuristic.of(techniques.lens_hit * self.made_by_light(k) / self.lens_end) };
                share(own, light(k) + hit)
            }
            Join::Connection => share(own, light(s) + camera(s)),
        }
    }
}

/// Sets of joins with counts: the three that have a name, and others at random.
pub fn sets(numbers: &mut Numbers) -> Vec<Techniques> {
    let mut sets = std::vec![Techniques::PATH, Techniques::LIGHT, Techniques::BIDIRECTIONAL];
    for _ in 0..5 {
        let mut count = || [0.0, 0.25, 1.0, 4.0][(numbers.unit() * 4.0) as usize];
        sets.push(Techniques { light_hit: count(), next_event: count(), connection: count(), lens_splat: count(), lens_hit: count() });
    }
    sets
}

/// Of every technique of a path, under these sets and both heuristics: the largest distance of a weight from its definition, and of
/// their sum from 1.
pub fn distances<S: Sums>(path: &Path, sets: &[Techniques]) -> (f64, f64) {
    let (mut apart, mut from_one) = (0.0, 0.0);
    // Not a number is farther than any.
    let worse = |a: f64, b: f64| if a.is_nan() || b <= a { a } else { b };
    for techniques in sets {
        for heuristic in [Heuristic::Balance, Heuristic::Power] {
            let exist: Vec<_> = (0..=path.k() + 1).filter(|s| path.log_effort(*s, techniques).is_some()).collect();
            let mut sum = 0.0;
            for &s in &exist {
                let fast = path.weight::<S>(s, techniques, heuristic);
                apart = worse(apart, (fast - path.definition(s, techniques, heuristic)).abs());
                sum += fast;
            }
            if !exist.is_empty() {
                from_one = worse(from_one, (sum - 1.0).abs());
            }
        }
    }
    (apart, from_one)
}
