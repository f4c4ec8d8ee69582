//! What one call of [`sample`](crate::sample::sample) is to do.

use crate::{
    effects::Effects,
    technique::{Heuristic, Join, Techniques},
};

/// The plan for a pass: which techniques, how they share, how far paths go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strategy {
    /// How much effort each kind of join gets.
    pub techniques: Techniques,
    /// How they share a path.
    pub heuristic: Heuristic,
    /// The longest path, in segments; `u32::MAX` is unlimited.
    pub max_depth: u32,
    /// Russian roulette begins after this many scattering events of a walk.
    pub rr_depth: u32,
}

impl Strategy {
    /// These techniques with the balance heuristic and roulette from the fifth scattering on.
    pub const fn new(techniques: Techniques, max_depth: u32) -> Self {
        Self { techniques, heuristic: Heuristic::Balance, max_depth, rr_depth: 5 }
    }

    /// As much of it as those effects leave: the loop that samples and the weight that divides both ask what this returns.
    #[inline(always)]
    pub(crate) fn within(&self, effects: Effects) -> Self {
        let Self { mut techniques, heuristic, max_depth, rr_depth } = *self;
        if !effects.light_walks {
            techniques = Techniques { connection: 0.0, lens_splat: 0.0, lens_hit: 0.0, ..techniques };
        }
        if !effects.other_counts {
            techniques = Techniques { light_hit: 1.0, next_event: 1.0, ..techniques };
        }
        Self { techniques, heuristic: if effects.power_heuristic { heuristic } else { Heuristic::Balance }, max_depth, rr_depth }
    }

    /// What these techniques and their heuristic need of the kernel.
    pub const fn effects(&self) -> Effects {
        Effects {
            light_walks: self.techniques.light_walk(),
            other_counts: self.techniques.light_hit != 1.0 || self.techniques.next_event != 1.0,
            power_heuristic: matches!(self.heuristic, Heuristic::Power),
            ..Effects::NONE
        }
    }

    /// The longest path that every technique may make when `stored` light vertices can be kept: a connection can only reach
    /// what was stored. Longer paths are left to s = 0 and s = 1, whose weights know it.
    #[inline(always)]
    pub(crate) fn joined_length(&self, stored: usize) -> u32 {
        if self.techniques.uses(Join::Connection) {
            u32::try_from(stored).unwrap_or(u32::MAX).saturating_add(1).min(self.max_depth)
        } else {
            self.max_depth
        }
    }
}
