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
//! an f32 sum that underflowed once would stay wrong for the rest of the walk.
//! The definition, every density multiplied out, is kept in the tests of this file.

use crate::{math::times, technique::Heuristic};

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
    earlier: f64,
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
        Self { per_forward: heuristic.of(1.0 / end), here: heuristic.of(hit), back: 0.0, earlier: 0.0 }
    }

    /// The walk's next vertex.
    #[inline]
    pub fn advance(&self, heuristic: Heuristic, step: &Step) -> Self {
        let (joined, effort) = if step.delta { (0.0, 0.0) } else { (self.here, step.effort) };
        Self {
            per_forward: heuristic.of(1.0 / (step.pdf * step.forward)),
            here: heuristic.of(effort),
            back: times(heuristic.of(step.backward), self.per_forward),
            earlier: joined + self.closed(heuristic, step.pdf_rev),
        }
    }

    /// E_{s−2}/L_{s−2} · (c_{s−2} n_{s−2} + A(s−2)), once the reverse density at the newest vertex is known.
    #[inline]
    pub fn closed(&self, heuristic: Heuristic, pdf_rev: f64) -> f64 {
        times(times(heuristic.of(pdf_rev), self.back), self.earlier)
    }

    /// A(s): the newest vertex is joined to one that makes it with density `across` and has it make the vertex before with `pdf_rev`.
    #[inline]
    pub fn sum(&self, heuristic: Heuristic, across: f64, pdf_rev: f64) -> f64 {
        self.sum_instead(heuristic, across, pdf_rev, self.here)
    }

    /// [`Side::sum`] where joining the walk's last two vertices has another effort than the walk knew, already taken through the heuristic.
    #[inline]
    pub fn sum_instead(&self, heuristic: Heuristic, across: f64, pdf_rev: f64, here: f64) -> f64 {
        times(times(heuristic.of(across), self.per_forward), here + self.closed(heuristic, pdf_rev))
    }

    /// 1/L_{s−1}, taken through the heuristic.
    #[inline]
    pub fn per_forward(&self) -> f64 {
        self.per_forward
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
