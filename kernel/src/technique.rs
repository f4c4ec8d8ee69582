//! The ways a path can come about, and how much effort goes into each.

/// s vertices made from the light, t from the camera; the path has length k = s + t − 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Technique {
    /// Vertices of the light walk.
    pub s: u32,
    /// Vertices of the camera walk.
    pub t: u32,
}

/// How the two ends of a path meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Join {
    /// s = 0: the camera walk lands on a light.
    LightHit,
    /// s = 1, t ≥ 2: a point of a light is chosen for a vertex of the camera walk.
    NextEvent,
    /// s ≥ 2, t ≥ 2: a vertex of each walk.
    Connection,
    /// t = 1, s ≥ 1: a vertex of the light walk is shown to the lens.
    LensSplat,
    /// t = 0: the light walk lands on the lens.
    LensHit,
}

impl Join {
    /// How many kinds there are.
    pub const COUNT: usize = 5;
    /// Every kind.
    pub const ALL: [Self; Self::COUNT] = [Self::LightHit, Self::NextEvent, Self::Connection, Self::LensSplat, Self::LensHit];
}

impl Technique {
    /// The path's length, in segments.
    #[inline(always)]
    pub const fn length(self) -> u32 {
        self.s + self.t - 1
    }

    /// Which join makes it.
    #[inline(always)]
    pub const fn join(self) -> Join {
        match (self.s, self.t) {
            (0, _) => Join::LightHit,
            (_, 0) => Join::LensHit,
            (_, 1) => Join::LensSplat,
            (1, _) => Join::NextEvent,
            _ => Join::Connection,
        }
    }
}

/// How many samples per camera path each kind of join gets; 0 switches it off. This is the one answer to
/// "is this technique used": the loop that samples and the weight that divides both ask [`Techniques::effort`].
///
/// There are n light paths per camera path, the largest of the last three counts; whatever uses them at all shows each of them to the
/// lens, and so has the count n or 0. Connections alone may be fewer: then each pair of vertices is joined with a chance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Techniques {
    /// s = 0: 0 or 1.
    pub light_hit: f64,
    /// s = 1: light points per camera vertex, a whole number.
    pub next_event: f64,
    /// s, t ≥ 2: times each pair of vertices is joined, in the mean.
    pub connection: f64,
    /// t = 1: light paths per camera path.
    pub lens_splat: f64,
    /// t = 0: light paths per camera path.
    pub lens_hit: f64,
}

impl Techniques {
    /// Nothing.
    pub const NONE: Self = Self { light_hit: 0.0, next_event: 0.0, connection: 0.0, lens_splat: 0.0, lens_hit: 0.0 };
    /// Path tracing with next event estimation.
    pub const PATH: Self = Self { light_hit: 1.0, next_event: 1.0, connection: 0.0, lens_splat: 0.0, lens_hit: 0.0 };
    /// Light tracing: everything that a light walk can show the lens or land on it; emitters the lens sees directly, by both.
    pub const LIGHT: Self = Self { light_hit: 0.0, next_event: 0.0, connection: 0.0, lens_splat: 1.0, lens_hit: 1.0 };
    /// Every technique.
    pub const BIDIRECTIONAL: Self = Self { light_hit: 1.0, next_event: 1.0, connection: 1.0, lens_splat: 1.0, lens_hit: 1.0 };

    /// Samples per camera path of one kind of join.
    #[inline(always)]
    pub const fn effort(&self, join: Join) -> f64 {
        match join {
            Join::LightHit => self.light_hit,
            Join::NextEvent => self.next_event,
            Join::Connection => self.connection,
            Join::LensSplat => self.lens_splat,
            Join::LensHit => self.lens_hit,
        }
    }

    /// Whether one kind of join is sampled at all.
    #[inline(always)]
    pub const fn uses(&self, join: Join) -> bool {
        self.effort(join) > 0.0
    }

    /// One kind of join with its count, and no other.
    pub const fn only(&self, join: Join) -> Self {
        let mut one = Self::NONE;
        match join {
            Join::LightHit => one.light_hit = self.light_hit,
            Join::NextEvent => one.next_event = self.next_event,
            Join::Connection => one.connection = self.connection,
            Join::LensSplat => one.lens_splat = self.lens_splat,
            Join::LensHit => one.lens_hit = self.lens_hit,
        }
        one
    }

    /// Light paths per camera path.
    #[inline(always)]
    pub const fn light_walks(&self) -> f64 {
        self.connection.max(self.lens_splat).max(self.lens_hit)
    }

    /// Whether any technique needs a light walk.
    #[inline(always)]
    pub const fn light_walk(&self) -> bool {
        self.light_walks() > 0.0
    }

    /// Whether any technique needs a camera walk.
    #[inline(always)]
    pub const fn camera_walk(&self) -> bool {
        self.uses(Join::LightHit) || self.uses(Join::NextEvent) || self.uses(Join::Connection)
    }
}

/// How techniques share a path that several of them can make (Veach 1997, 9.2).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Heuristic {
    /// w_s = n_s p_s / Σ n_j p_j.
    Balance,
    /// w_s = (n_s p_s)² / Σ (n_j p_j)².
    Power,
}

impl Heuristic {
    /// What this heuristic adds up: x or x².
    #[inline(always)]
    pub fn of(self, x: f64) -> f64 {
        match self {
            Self::Balance => x,
            Self::Power => x * x,
        }
    }
}
