//! Random numbers that can be asked for in any order.

use crate::real::Real;

/// Which of a sample's two walks asks for numbers; each has dimensions of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Walk {
    /// From the camera.
    Camera,
    /// From a light.
    Light,
}

/// The numbers of one sample. Each vertex of each walk reads from a fixed dimension on, so that what one vertex consumes never shifts another's.
pub trait Sampler {
    /// Goes to a dimension of a walk.
    fn seek(&mut self, walk: Walk, dimension: u32);

    /// The number of this dimension, in [0, 1); goes on to the next.
    fn next(&mut self) -> Real;

    /// The numbers of this dimension and the one after it.
    #[inline(always)]
    fn next_pair(&mut self) -> [Real; 2] {
        [self.next(), self.next()]
    }
}

/// How many dimensions a walk's start and each of its vertices own. What belongs together lies within four from a multiple of
/// four on, so that a sampler that stratifies four dimensions at a time stratifies it.
pub const DIMENSIONS_PER_VERTEX: u32 = 8;

/// The dimensions of a walk's start.
pub(crate) mod start {
    /// Of a camera walk: the lens, two; the two before are the caller's.
    pub const LENS: u32 = 2;
    /// Of a camera walk: which of its vertices are joined to those of the first light walk, of the second, …
    pub const RATION: u32 = 4;
    /// Of a light walk: the point on the light, two, and the choice of the light.
    pub const LIGHT: u32 = 0;
    /// Of a sample's light walks: how many there are.
    pub const COUNT: u32 = 3;
    /// Of a light walk: the direction, two.
    pub const DIRECTION: u32 = 4;
    /// Of a light walk: the lens for its own first vertex, two.
    pub const SPLAT: u32 = 6;
}

/// The dimensions of a vertex, from the vertex's first one on.
pub(crate) mod vertex {
    /// Of a camera walk: next event's point, two, and its choice of the light. Of a light walk: the lens, two.
    pub const ENDPOINT: u32 = 0;
    /// Russian roulette.
    pub const ROULETTE: u32 = 3;
    /// The BSDF, three.
    pub const BSDF: u32 = 4;
}

/// Independent numbers: SplitMix64 (Steele, Lea & Flood 2014) as a function of a counter, so that any dimension of any sample is one hash away.
#[derive(Clone, Copy, Debug)]
pub struct Independent {
    keys: [u64; 2],
    state: u64,
}

const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

#[inline]
fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

impl Independent {
    /// The numbers of sample `index` of pixel `pixel` under `seed`.
    #[inline]
    pub fn new(seed: u64, pixel: u64, index: u64) -> Self {
        let base = mix(mix(mix(seed ^ GOLDEN).wrapping_add(pixel)).wrapping_add(index.wrapping_mul(GOLDEN)));
        Self { keys: [base, mix(base ^ 0x6a09_e667_f3bc_c909)], state: base }
    }
}

impl Sampler for Independent {
    #[inline]
    fn seek(&mut self, walk: Walk, dimension: u32) {
        self.state = self.keys[walk as usize].wrapping_add(u64::from(dimension).wrapping_mul(GOLDEN));
    }

    #[inline]
    fn next(&mut self) -> Real {
        self.state = self.state.wrapping_add(GOLDEN);
        // 24 bits fill an f32 exactly and keep the same numbers in f64.
        (mix(self.state) >> 40) as Real * (1.0 / 16_777_216.0)
    }
}
