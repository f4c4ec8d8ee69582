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

use crate::{math::times, technique::Heuristic, wide::Wide};

/// What the newest vertex of a walk knows of the techniques that would have made less of the path from this side.
/// Written for the light walk (densities L forward, E backward); the camera walk swaps the letters.
#[derive(Clone, Copy, Debug)]
pub struct Side {
    /// 1 / L_{s−1}.
    per_forward: f64,
    /// c_{s−1} n_{s−1}: joining the walk's last two vertices.
    here: f64,
    /// What turns the newest vertex's pdf_rev into E_{s−2} / L_{s−2}.
    back: f64,
    /// c_{s−2} n_{s−2} + A(s−2).
    earlier: Wide,
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
    /// The effort of joining the vertex left behind to the new one.
    pub effort: f64,
}

impl Side {
    /// A walk's first vertex, made with density `end`; `hit` is the effort of landing on it from the other side, 0 if that cannot be.
    #[inline]
    pub fn start(heuristic: Heuristic, end: f64, hit: f64) -> Self {
        Self { per_forward: heuristic.of(1.0 / end), here: heuristic.of(hit), back: 0.0, earlier: Wide::ZERO }
    }

    /// The walk's next vertex.
    #[inline]
    pub fn advance(&self, heuristic: Heuristic, step: &Step) -> Self {
        let (joined, effort) = if step.delta { (0.0, 0.0) } else { (self.here, step.effort) };
        Self {
            per_forward: heuristic.of(1.0 / (step.pdf * step.forward)),
            here: heuristic.of(effort),
            back: times(heuristic.of(step.backward), self.per_forward),
            earlier: self.closed(heuristic, step.pdf_rev).plus(joined),
        }
    }

    /// E_{s−2}/L_{s−2} · (c_{s−2} n_{s−2} + A(s−2)), once the reverse density at the newest vertex is known.
    #[inline]
    fn closed(&self, heuristic: Heuristic, pdf_rev: f64) -> Wide {
        self.earlier.times(times(heuristic.of(pdf_rev), self.back))
    }

    /// A(s): the newest vertex is joined to one that makes it with density `across` and has it make the vertex before with `pdf_rev`.
    #[inline]
    pub fn sum(&self, heuristic: Heuristic, across: f64, pdf_rev: f64) -> f64 {
        self.closed(heuristic, pdf_rev).plus(self.here).times(times(heuristic.of(across), self.per_forward)).get()
    }

    /// A(s) where the newest vertex ends the path, as one that is made with density `end`. What joining the walk's last two vertices
    /// would have done is `instead`, n E_{s−1} taken through the heuristic.
    #[inline]
    pub fn sum_of_hit(&self, heuristic: Heuristic, end: f64, pdf_rev: f64, instead: f64) -> f64 {
        self.closed(heuristic, pdf_rev).times(heuristic.of(end)).plus(instead).times(self.per_forward).get()
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
