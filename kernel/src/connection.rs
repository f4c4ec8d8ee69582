//! Connections (s, t ≥ 2): every vertex of the camera walk with every one of the light walk.
//!
//! Pairs are looked at in blocks, so that a vertex is asked about all its directions at once: see [`Bsdf::eval_n`].

use crate::{
    bsdf::{BATCH, Bsdf, Scatter},
    density::conversions,
    film::{Contribution, Film},
    point::{Ray, Segment},
    real::{Real, Vec3},
    scene::Scene,
    strategy::Strategy,
    technique::Technique,
    vertex::Vertex,
    walk::WalkVertex,
    weight::share,
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
type Path<'a, 's, S> = &'a [Option<WalkVertex<'s, S>>];

/// Connects the two walks' vertices.
pub(crate) fn connect<'s, S: Scene>(
    scene: &S,
    strategy: &Strategy,
    joined_length: u32,
    (camera_path, light_path): (Path<'_, 's, S>, Path<'_, 's, S>),
    film: &mut impl Film,
) {
    for near in camera_path.chunks(BATCH) {
        for far in light_path.chunks(BATCH) {
            let mut block = paired(near, far, joined_length);
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
fn paired<'s, S: Scene>(near: Path<'_, 's, S>, far: Path<'_, 's, S>, joined_length: u32) -> Block {
    let mut block = [[None; BATCH]; BATCH];
    for (near, row) in near.iter().flatten().zip(&mut block) {
        for (far, slot) in far.iter().flatten().zip(row) {
            if near.length.saturating_add(far.length) < joined_length {
                *slot = pair(&near.vertex, &far.vertex);
            }
        }
    }
    block
}

#[inline]
fn pair<B: Bsdf>(near: &Vertex<B>, far: &Vertex<B>) -> Option<Pair> {
    let (direction, squared_distance) = near.point.direction_to(&far.point)?;
    let local = [near.local(direction)?, far.local(-direction)?];
    Some(Pair { directions: [direction, -direction], squared_distance, local, scatters: [Scatter::NONE; 2] })
}

/// Asks a vertex about its pairs, which lie in the block at `place`, and drops those between which it scatters nothing.
#[inline]
fn ask<B: Bsdf>(vertex: &Vertex<B>, end: usize, block: &mut Block, place: impl Fn(usize) -> (usize, usize)) {
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
            match scatters.next().and_then(|scatter| vertex.scattered(pair.directions[end], scatter)) {
                Some(scatter) => pair.scatters[end] = scatter,
                None => *slot = None,
            }
        }
    }
}

fn join<'s, S: Scene>(
    scene: &S,
    strategy: &Strategy,
    near: &WalkVertex<'s, S>,
    far: &WalkVertex<'s, S>,
    pair: &Pair,
    film: &mut impl Film,
) {
    let Strategy { techniques, heuristic, .. } = *strategy;
    let ([here, there], points) = (&pair.scatters, (&near.vertex.point, &far.vertex.point));
    let value = near.throughput * here.value * (there.value * far.throughput) / pair.squared_distance;
    if value.is_black() || !Ray::keeps_sides(points.0, points.1) || !scene.unoccluded(points.0, points.1, Segment::Inner) {
        return;
    }
    let (there_per, here_per) = conversions(points.0, points.1, pair.directions[NEAR]);
    let to_far = f64::from(here.pdf.0) * there_per;
    let to_near = f64::from(there.pdf.0) * here_per;
    let others = far.side.sum(heuristic, to_far, f64::from(there.pdf_rev.0)) + near.side.sum(heuristic, to_near, f64::from(here.pdf_rev.0));
    film.add(Contribution {
        value,
        weight: share(heuristic.of(techniques.connection), others) as Real,
        technique: Technique { s: far.length + 1, t: near.length + 1 },
    });
}
