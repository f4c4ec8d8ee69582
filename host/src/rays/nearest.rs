//! The nearest hit so far, and who wins a tie.

/// A primitive's number with two bits about it: which half of a parallelogram this is, and whether lens rays pass it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Key(pub u32);

impl Key {
    /// A primitive in one piece.
    pub fn new(primitive: u32, hidden_from_lens: bool) -> Self {
        Self(primitive << 2 | u32::from(hidden_from_lens))
    }

    /// The same primitive's second half.
    pub fn second_half(self) -> Self {
        Self(self.0 | 2)
    }

    #[inline(always)]
    pub fn primitive(self) -> u32 {
        self.0 >> 2
    }

    #[inline(always)]
    pub fn is_second_half(self) -> bool {
        self.0 & 2 != 0
    }

    #[inline(always)]
    pub fn hidden_from_lens(self) -> bool {
        self.0 & 1 != 0
    }
}

/// The nearest hit so far.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearest {
    /// Its distance; where nothing is hit yet, the ray's end.
    pub t: f32,
    pub key: Key,
    /// Where the primitive is kept; `NOTHING` while nothing is hit.
    pub slot: u32,
    pub coordinates: (f32, f32),
}

const NOTHING: u32 = u32::MAX;

impl Nearest {
    /// Nothing hit before `limit`. Its key is the lowest, so a hit exactly at the limit loses.
    #[inline(always)]
    pub fn before(limit: f32) -> Self {
        Self { t: limit, key: Key(0), slot: NOTHING, coordinates: (0.0, 0.0) }
    }

    #[inline(always)]
    pub fn found(&self) -> bool {
        self.slot != NOTHING
    }

    /// Whether a hit would take the place of this one. NaN never does.
    #[inline(always)]
    pub fn loses_to(&self, t: f32, key: Key) -> bool {
        t > 0.0 && (t < self.t || (t == self.t && key.0 < self.key.0))
    }
}
