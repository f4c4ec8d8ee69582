//! How much of a path one technique may claim: multiple importance sampling by closed sums.
//!
//! With L_i and E_i the densities of making x_i from the light and from the camera, the techniques that make fewer
//! vertices from the light than s add up, relative to technique s, to
//!
//! ```text
//! A(0) = 0,   A(s+1) = (E_s / L_s) · (c_s n_s + A(s))
//! ```
//!
//! and the camera's side is the mirror image. The weight is n_s / (n_s + A_light + A_camera).
//! E_{s−1} and E_{s−2} depend on what a walk is joined to; everything before is closed when its vertex is made, so a vertex
//! stores four numbers and a joint costs O(1). All of it is f64: ratios of densities span hundreds of decades, and
//! an f32 sum that underflowed once would stay wrong for the rest of the walk. Along 64 vertices their squares leave even f64, and
//! may come back; what is summed along the walk has an exponent of its own.
//! The definition, every density multiplied out, is kept in `weight_tests/oracle.rs`.

use crate::{
    math::times,
    technique::{Heuristic, Join},
    wide::Wide,
};

/// What other techniques would have put into a path, relative to the one that made it: Σ n_j p_j / p_s, taken through the heuristic.
pub trait Rivals: Copy {
    /// No other technique.
    const NONE: Self;

    /// One technique more, of this kind.
    fn with(self, join: Join, effort: f64) -> Self;

    /// These and those.
    fn and(self, others: Self) -> Self;

    /// Each of them times x; 0 for 0 · ∞.
    fn times(self, x: f64) -> Self;

    /// All of them together.
    fn total(self) -> f64;
}

/// [`Rivals`] in one sum, as a weight needs them.
#[derive(Clone, Copy, Debug)]
pub struct Together(Wide);

impl Rivals for Together {
    const NONE: Self = Self(Wide::ZERO);

    #[inline]
    fn with(self, _: Join, effort: f64) -> Self {
        Self(self.0.plus(effort))
    }

    #[inline]
    fn and(self, others: Self) -> Self {
        Self(self.0.plus(others.0.get()))
    }

    #[inline]
    fn times(self, x: f64) -> Self {
        Self(self.0.times(x))
    }

    #[inline]
    fn total(self) -> f64 {
        self.0.get()
    }
}

/// [`Rivals`] by kind of join, for whoever asks what other counts would have made of a path: their sum, to the last bit as
/// [`Together`] has it, and the part that each kind has in it, which what all are multiplied by does not change.
#[derive(Clone, Copy, Debug)]
pub struct ByJoin {
    all: Wide,
    parts: [f64; Join::COUNT],
}

impl ByJoin {
    /// Those of one kind.
    pub fn of(&self, join: Join) -> f64 {
        times(self.all.get(), self.parts[join as usize])
    }
}

impl Rivals for ByJoin {
    const NONE: Self = Self { all: Wide::ZERO, parts: [0.0; Join::COUNT] };

    #[inline]
    fn with(self, join: Join, effort: f64) -> Self {
        let all = self.all.plus(effort);
        let kept = self.all.part_of(all);
        let mut parts = self.parts.map(|part| part * kept);
        parts[join as usize] += Wide::ZERO.plus(effort).part_of(all);
        Self { all, parts }
    }

    #[inline]
    fn and(self, others: Self) -> Self {
        // As far as f64 goes, like their sum: what is beyond is all there is, and its part is 1.
        let other = others.all.get();
        let all = self.all.plus(other);
        let (own, other) = (self.all.part_of(all), Wide::ZERO.plus(other).part_of(all));
        Self { all, parts: core::array::from_fn(|join| self.parts[join] * own + others.parts[join] * other) }
    }

    #[inline]
    fn times(self, x: f64) -> Self {
        Self { all: self.all.times(x), ..self }
    }

    #[inline]
    fn total(self) -> f64 {
        self.all.get()
    }
}

/// What the newest vertex of a walk knows of the techniques that would have made less of the path from this side.
/// Written for the light walk (densities L forward, E backward); the camera walk swaps the letters.
#[derive(Clone, Copy, Debug)]
pub struct Side<R = Together> {
    /// 1 / L_{s−1}.
    per_forward: f64,
    /// c_{s−1} n_{s−1}: joining the walk's last two vertices.
    here: f64,
    /// Which join that would be.
    join: Join,
    /// What turns the newest vertex's pdf_rev into E_{s−2} / L_{s−2}.
    back: f64,
    /// c_{s−2} n_{s−2} + A(s−2).
    earlier: R,
}

/// How a walk went on from one vertex to the next.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// The density, or chance, of the direction taken.
    pub pdf: f64,
    /// That of the reverse direction, for a walk coming the other way.
    pub pdf_rev: f64,
    /// Whether the direction was a Dirac.
    pub delta: bool,
    /// Turns `pdf` into the density of the new vertex.
    pub forward: f64,
    /// Turns the new vertex's densities into those of the vertex left behind.
    pub backward: f64,
    /// How the vertex left behind would be joined to the new one.
    pub join: Join,
    /// The effort of that.
    pub effort: f64,
}

impl<R: Rivals> Side<R> {
    /// A walk's first vertex, made with density `end`; `hit` is the effort of landing on it from the other side, 0 if that cannot be.
    #[inline]
    pub fn start(heuristic: Heuristic, end: f64, join: Join, hit: f64) -> Self {
        Self { per_forward: heuristic.of(1.0 / end), here: heuristic.of(hit), join, back: 0.0, earlier: R::NONE }
    }

    /// What is left of [`Side::advance`] where no technique makes less of the path from this side: how the newest vertex was made.
    #[inline]
    pub fn alone(heuristic: Heuristic, step: &Step) -> Self {
        Self { per_forward: heuristic.of(1.0 / (step.pdf * step.forward)), here: 0.0, join: step.join, back: 0.0, earlier: R::NONE }
    }

    /// The walk's next vertex.
    #[inline]
    pub fn advance(&self, heuristic: Heuristic, step: &Step) -> Self {
        let (joined, effort) = if step.delta { (0.0, 0.0) } else { (self.here, step.effort) };
        Self {
            per_forward: heuristic.of(1.0 / (step.pdf * step.forward)),
            here: heuristic.of(effort),
            join: step.join,
            back: times(heuristic.of(step.backward), self.per_forward),
            earlier: self.closed(heuristic, step.pdf_rev).with(self.join, joined),
        }
    }

    /// E_{s−2}/L_{s−2} · (c_{s−2} n_{s−2} + A(s−2)), once the reverse density at the newest vertex is known.
    #[inline]
    fn closed(&self, heuristic: Heuristic, pdf_rev: f64) -> R {
        self.earlier.times(times(heuristic.of(pdf_rev), self.back))
    }

    /// A(s): the newest vertex is joined to one that makes it with density `across` and has it make the vertex before with `pdf_rev`.
    #[inline]
    pub fn sum(&self, heuristic: Heuristic, across: f64, pdf_rev: f64) -> R {
        self.closed(heuristic, pdf_rev).with(self.join, self.here).times(times(heuristic.of(across), self.per_forward))
    }

    /// A(s) where the newest vertex ends the path, as one that is made with density `end`. What joining the walk's last two vertices
    /// would have done is `instead`, n E_{s−1} taken through the heuristic.
    #[inline]
    pub fn sum_of_hit(&self, heuristic: Heuristic, end: f64, pdf_rev: f64, (join, instead): (Join, f64)) -> R {
        self.closed(heuristic, pdf_rev).times(heuristic.of(end)).with(join, instead).times(self.per_forward)
    }
}

/// n / (n + others), 0 where the technique has no share.
#[inline]
pub fn share(own: f64, others: f64) -> f64 {
    if own > 0.0 { 1.0 / (1.0 + others / own) } else { 0.0 }
}

#[cfg(test)]
#[path = "weight_tests.rs"]
mod tests;
