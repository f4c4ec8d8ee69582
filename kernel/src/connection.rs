//! Connections (s, t ≥ 2): every vertex of the camera walk with every one of the light walk.
//!
//! Pairs are looked at in blocks, so that a vertex is asked about all its directions at once: see [`Bsdf::eval_n`].

use crate::{
    bsdf::{BATCH, Bsdf, Scatter},
    density::conversions,
    film::{Contribution, Film},
    math::floor,
    point::{Ray, Segment},
    real::{Real, Vec3},
    scene::Scene,
    strategy::Strategy,
    technique::Technique,
    vertex::Vertex,
    walk::WalkVertex,
    weight::{Rivals, share},
};

/// Two vertices that see each other, as far as their surfaces go.
#[derive(Clone, Copy)]
struct Pair {
    /// From the camera's vertex to the light's, and back.
    directions: [Vec3; 2],
    squared_distance: Real,
    /// The directions in each vertex's shading frame.
    local: [Vec3; 2],
    scatters: [Scatter; 2],
}

/// Which end of a pair.
const NEAR: usize = 0;
const FAR: usize = 1;

/// Rows are vertices of the camera walk, columns those of the light walk.
type Block = [[Option<Pair>; BATCH]; BATCH];

/// A walk's vertices.
type Path<'a, 's, S, R> = &'a [Option<WalkVertex<'s, S, R>>];

/// Which pairs of vertices are joined, where not all of them are.
#[derive(Clone, Copy)]
pub(crate) struct Ration {
    /// The chance of each pair.
    pub chance: Real,
    /// In [0, 1): picks among them.
    pub u: Real,
}

impl Ration {
    /// Whether the pair of that number is joined; neighbours are spread over the unit interval by the golden ratio.
    fn grants(&self, pair: usize) -> bool {
        const GOLDEN: Real = 0.618_034;
        let u = self.u + GOLDEN * (pair % 1024) as Real;
        u - floor(u) < self.chance
    }
}

/// Connects the two walks' vertices: all of them, or as many as they are rationed to.
pub(crate) fn connect<'s, S: Scene, F: Film>(
    scene: &S,
    strategy: &Strategy,
    joined_length: u32,
    ration: Option<Ration>,
    (camera_path, light_path): (Path<'_, 's, S, F::Rivals>, Path<'_, 's, S, F::Rivals>),
    film: &mut F,
) {
    let mut number = 0;
    let mut granted = || {
        number += 1;
        ration.is_none_or(|ration| ration.grants(number))
    };
    for near in camera_path.chunks(BATCH) {
        for far in light_path.chunks(BATCH) {
            let mut block = paired(near, far, joined_length, &mut granted);
            for (row, vertex) in near.iter().flatten().enumerate() {
                ask(&vertex.vertex, NEAR, &mut block, |i| (row, i));
            }
            for (column, vertex) in far.iter().flatten().enumerate() {
                ask(&vertex.vertex, FAR, &mut block, |i| (i, column));
            }
            for (near, row) in near.iter().flatten().zip(&block) {
                for (far, pair) in far.iter().flatten().zip(row) {
                    if let Some(pair) = pair {
                        join(scene, strategy, near, far, pair, film);
                    }
                }
            }
        }
    }
}

/// The pairs whose surfaces can scatter light from one to the other.
#[inline]
fn paired<'s, S: Scene, R>(
    near: Path<'_, 's, S, R>,
    far: Path<'_, 's, S, R>,
    joined_length: u32,
    mut granted: impl FnMut() -> bool,
) -> Block {
    let mut block = [[None; BATCH]; BATCH];
    for (near, row) in near.iter().flatten().zip(&mut block) {
        for (far, slot) in far.iter().flatten().zip(row) {
            if near.length.saturating_add(far.length) < joined_length && granted() {
                *slot = pair(&near.vertex, &far.vertex);
            }
        }
    }
    block
}

#[inline]
fn pair<S: Scene>(near: &Vertex<'_, S>, far: &Vertex<'_, S>) -> Option<Pair> {
    let (direction, squared_distance) = near.point.direction_to(&far.point)?;
    let local = [near.local(direction)?, far.local(-direction)?];
    Some(Pair { directions: [direction, -direction], squared_distance, local, scatters: [Scatter::NONE; 2] })
}

/// Asks a vertex about its pairs, which lie in the block at `place`, and drops those between which it scatters nothing.
#[inline]
fn ask<S: Scene>(vertex: &Vertex<'_, S>, end: usize, block: &mut Block, place: impl Fn(usize) -> (usize, usize)) {
    let (mut wi, mut scatters, mut count) = ([Vec3::ZERO; BATCH], [Scatter::NONE; BATCH], 0);
    for (row, column) in (0..BATCH).map(&place) {
        if let Some(pair) = &block[row][column] {
            wi[count] = pair.local[end];
            count += 1;
        }
    }
    if count == 0 {
        return;
    }
    vertex.bsdf.eval_n(vertex.wo, &wi[..count], vertex.carried, &mut scatters[..count]);
    let mut scatters = scatters.into_iter();
    for (row, column) in (0..BATCH).map(place) {
        let slot = &mut block[row][column];
        if let Some(pair) = slot {
            match scatters.next().map(|scatter| vertex.scattered(pair.directions[end], scatter)) {
                Some(scatter) if !scatter.value.is_black() => pair.scatters[end] = scatter,
                _ => *slot = None,
            }
        }
    }
}

fn join<'s, S: Scene, F: Film>(
    scene: &S,
    strategy: &Strategy,
    near: &WalkVertex<'s, S, F::Rivals>,
    far: &WalkVertex<'s, S, F::Rivals>,
    pair: &Pair,
    film: &mut F,
) {
    let Strategy { techniques, heuristic, .. } = *strategy;
    let ([here, there], points) = (&pair.scatters, (&near.vertex.point, &far.vertex.point));
    let value = near.throughput * here.value * (there.value * far.throughput) / (pair.squared_distance * techniques.connection as Real);
    if value.is_black() || !Ray::keeps_sides(points.0, points.1) || !scene.unoccluded(points.0, points.1, Segment::Inner) {
        return;
    }
    let (there_per, here_per) = conversions(points.0, points.1, pair.directions[NEAR]);
    let to_far = f64::from(here.pdf.0) * there_per;
    let to_near = f64::from(there.pdf.0) * here_per;
    let made_less = far.side.sum(heuristic, to_far, f64::from(there.pdf_rev.0));
    let others = made_less.and(near.side.sum(heuristic, to_near, f64::from(here.pdf_rev.0)));
    let own = heuristic.of(techniques.connection);
    film.weighed(own, others);
    film.add(Contribution {
        value,
        weight: share(own, others.total()) as Real,
        technique: Technique { s: far.length + 1, t: near.length + 1 },
    });
}
