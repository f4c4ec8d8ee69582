//! The ways of sampling that costs are told from. A part cannot be timed alone as it is within a sample; but ways of sampling that differ
//! in it can.

use bidir_kernel::Techniques;

use crate::plan::choice::{Costs, RATION};

/// How many ways there are.
pub(super) const WAYS: usize = 7;

/// All of them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ways([Techniques; WAYS]);

const PATH: usize = 0;
const BARE: usize = 1;
const ALONE: usize = 2;
const BESIDE: usize = 3;
const FEW: usize = 4;
const ALL: usize = 5;
const RATIONED: usize = 6;

impl Ways {
    /// For plans that have some or all of these techniques.
    pub(super) fn of(all: &Techniques) -> Self {
        let Techniques { light_hit, next_event, connection, lens_splat, lens_hit } = *all;
        let path = Techniques { light_hit, next_event, ..Techniques::NONE };
        let mut ways = [path; WAYS];
        ways[BARE] = Techniques { next_event: 0.0, ..path };
        ways[ALONE] = Techniques { lens_splat, lens_hit, ..Techniques::NONE };
        ways[BESIDE] = Techniques { lens_splat, lens_hit, ..path };
        ways[FEW] = Techniques { lens_splat: RATION * lens_splat, lens_hit: RATION * lens_hit, ..path };
        ways[ALL] = *all;
        ways[RATIONED] = Techniques { connection: RATION * connection, ..*all };
        Self(ways)
    }

    /// All techniques.
    pub(super) fn all(&self) -> Techniques {
        self.0[ALL]
    }

    /// The ways that differ from those before them.
    pub(super) fn measured(&self) -> impl Iterator<Item = (usize, Techniques)> {
        self.0.into_iter().enumerate().filter(|(way, _)| self.first(*way) == *way)
    }

    /// The first way that is the same.
    fn first(&self, way: usize) -> usize {
        self.0.iter().position(|other| *other == self.0[way]).unwrap_or(way)
    }

    /// What the parts of a sample cost, from what samples of each way that is measured do.
    pub(super) fn parts(&self, each: [f64; WAYS]) -> Costs {
        let of = |way| each[self.first(way)];
        let light_path = (of(BESIDE) - of(FEW)) / (1.0 - RATION);
        let connections = (of(ALL) - of(BESIDE)).max(0.0);
        Costs {
            camera_path: of(PATH),
            next_event: (of(PATH) - of(BARE)).max(0.0),
            beside: of(BESIDE) - light_path - of(PATH),
            light_path,
            alone: of(ALONE),
            connections,
            rationed: (of(RATIONED) - of(BESIDE) - RATION * connections).max(0.0),
        }
    }
}
