//! What sampling a scene may need of the kernel.

use core::ops::BitOr;

/// Each is whether something may occur at all. Where a scene's [`EFFECTS`](crate::scene::Scene::EFFECTS) leave one out, the kernel is
/// compiled without it: what is absent costs nothing. Whatever more is left in, the samples are the same, bit for bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effects {
    /// Walks from lights: connections, lens splats and lens hits. Where they are left out, a strategy's are switched off.
    pub light_walks: bool,
    /// Other counts of light hits and next events than one of each at a vertex. Where it is left out, a strategy has one of each.
    pub other_counts: bool,
    /// Weights by another heuristic than the balance heuristic. Where it is left out, a strategy's is the balance heuristic.
    pub power_heuristic: bool,
    /// Light from infinitely far away all around: rays that escape land on it.
    pub environment: bool,
    /// Scattering into single directions.
    pub deltas: bool,
    /// Surfaces with more than one lobe: the BSDF's third number picks among them. Where it is left out, that number is 0.
    pub lobe_choice: bool,
    /// Surfaces that are dear to ask, as in a sandbox: a vertex then asks for next event and for the walk's next direction at once.
    pub dear_surfaces: bool,
    /// Light bends as it passes a surface: samples whose `eta` is not 1.
    pub refraction: bool,
    /// Frames whose z is not the geometric normal.
    pub shading_normals: bool,
    /// A lens with an area. Where it is left out, the numbers for a point of it are 0.
    pub finite_lens: bool,
    /// A camera that sees only from some distance on, or up to one.
    pub clipping: bool,
    /// Emitters that the lens does not see.
    pub hidden_emitters: bool,
}

impl Effects {
    /// Whatever may be.
    pub const ALL: Self = Self {
        light_walks: true,
        other_counts: true,
        power_heuristic: true,
        environment: true,
        deltas: true,
        lobe_choice: true,
        dear_surfaces: true,
        refraction: true,
        shading_normals: true,
        finite_lens: true,
        clipping: true,
        hidden_emitters: true,
    };

    /// Paths from the camera between surfaces of one lobe, lit by lights that have a place.
    pub const NONE: Self = Self {
        light_walks: false,
        other_counts: false,
        power_heuristic: false,
        environment: false,
        deltas: false,
        lobe_choice: false,
        dear_surfaces: false,
        refraction: false,
        shading_normals: false,
        finite_lens: false,
        clipping: false,
        hidden_emitters: false,
    };

    /// Whether these hold all of `needed`.
    pub const fn covers(self, needed: Self) -> bool {
        let mut covered = true;
        let (mine, theirs) = (self.each(), needed.each());
        let mut i = 0;
        while i < mine.len() {
            covered &= mine[i] || !theirs[i];
            i += 1;
        }
        covered
    }

    const fn each(self) -> [bool; 12] {
        let Self { light_walks, other_counts, power_heuristic, environment, deltas, lobe_choice, .. } = self;
        let Self { dear_surfaces, refraction, shading_normals, finite_lens, clipping, hidden_emitters, .. } = self;
        [
            light_walks,
            other_counts,
            power_heuristic,
            environment,
            deltas,
            lobe_choice,
            dear_surfaces,
            refraction,
            shading_normals,
            finite_lens,
            clipping,
            hidden_emitters,
        ]
    }
}

impl BitOr for Effects {
    type Output = Self;

    fn bitor(self, other: Self) -> Self {
        Self {
            light_walks: self.light_walks | other.light_walks,
            other_counts: self.other_counts | other.other_counts,
            power_heuristic: self.power_heuristic | other.power_heuristic,
            environment: self.environment | other.environment,
            deltas: self.deltas | other.deltas,
            lobe_choice: self.lobe_choice | other.lobe_choice,
            dear_surfaces: self.dear_surfaces | other.dear_surfaces,
            refraction: self.refraction | other.refraction,
            shading_normals: self.shading_normals | other.shading_normals,
            finite_lens: self.finite_lens | other.finite_lens,
            clipping: self.clipping | other.clipping,
            hidden_emitters: self.hidden_emitters | other.hidden_emitters,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn effects_cover_what_they_hold_and_nothing_else() {
        let clipping = Effects { clipping: true, ..Effects::NONE };
        let hidden = Effects { hidden_emitters: true, ..Effects::NONE };
        assert!(Effects::ALL.covers(Effects::ALL) && Effects::ALL.covers(clipping) && Effects::NONE.covers(Effects::NONE));
        assert!(!Effects::NONE.covers(clipping) && !clipping.covers(hidden) && !clipping.covers(Effects::ALL));
        assert!((clipping | hidden).covers(clipping) && (clipping | hidden).covers(hidden));
        assert_eq!(Effects::ALL | Effects::NONE, Effects::ALL);
    }
}
