//! What one sample met and contributed, in numbers of neither world.

/// What contributions are compared from on; lights send out about 1.
const NOTHING: f64 = 1e-18;

/// f32 has lost digits below 1e-38. A lobe's far tail reaches there, and is multiplied by 1/d² only then.
const LEAST: f64 = 1e-34;

/// One sample, from beginning to end.
#[derive(Clone, Debug, Default)]
pub struct Tape {
    /// What each walk did, in order: the camera's, then the light's.
    pub walks: [Vec<Event>; 2],
    /// What was handed to the film.
    pub given: Vec<Given>,
}

/// One step of a walk. The first vertex after the start is met, then left, then the next is met, and so on.
#[derive(Clone, Copy, Debug)]
pub enum Event {
    /// A ray's end.
    Met {
        /// Which thing, by its place in the setting; `None` escaped.
        thing: Option<usize>,
        /// How far from the thing's edge (of a ball: its outline), relative to its size.
        edge: f64,
    },
    /// How a surface sent the walk on: the bits of its lobe, 0 if it took it.
    Left {
        /// The kernel's `Lobe`.
        lobe: u32,
    },
}

impl Event {
    /// Whether both say the same; how near an edge was may differ.
    pub fn agrees(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Met { thing: a, .. }, Self::Met { thing: b, .. }) => a == b,
            (Self::Left { lobe: a }, Self::Left { lobe: b }) => a == b,
            _ => false,
        }
    }
}

/// One contribution.
#[derive(Clone, Copy, Debug)]
pub struct Given {
    /// Vertices made from the light.
    pub s: u32,
    /// Vertices made from the camera.
    pub t: u32,
    /// f/p under the technique alone.
    pub value: [f64; 3],
    /// The technique's share.
    pub weight: f64,
}

impl Given {
    /// What the film makes of it, over the bands.
    pub fn light(&self) -> f64 {
        self.weight * self.value.iter().sum::<f64>() / 3.0
    }
}

impl Tape {
    /// Keeps a contribution, if it is more than nothing in a world of this scale, or no number.
    pub fn give(&mut self, given: Given, scale: f64) {
        let nothing = NOTHING.max(LEAST / (scale * scale));
        if !given.value.iter().all(|band| band.abs() <= nothing) {
            self.given.push(given);
        }
    }

    /// What this technique gave, if it did. With efforts of 1 it gives at most once.
    pub fn by(&self, s: u32, t: u32) -> Option<&Given> {
        self.given.iter().find(|given| (given.s, given.t) == (s, t))
    }
}
