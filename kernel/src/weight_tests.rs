#[path = "weight_tests/oracle.rs"]
mod oracle;

use super::*;
use crate as kernel;
use oracle::{Numbers, Path, distances, sets};

fn worst_error(longest: usize, decades: f64, deltas: f64, seed: u64) -> f64 {
    let mut numbers = Numbers(seed);
    (0..400).fold(0.0, |worst: f64, turn| {
        let path = Path::random(1 + turn % longest, decades, deltas, &mut numbers);
        let (apart, from_one) = distances::<Side<Together>>(&path, &sets(&mut numbers));
        assert!(!apart.is_nan() && !from_one.is_nan());
        worst.max(apart).max(from_one)
    })
}

#[test]
fn weights_match_the_definition_and_sum_to_one() {
    let worst = worst_error(12, 3.0, 0.0, 1);
    assert!(worst < 1e-9, "{worst}");
}

#[test]
fn weights_match_the_definition_on_paths_with_diracs() {
    let worst = worst_error(12, 3.0, 0.4, 2);
    assert!(worst < 1e-9, "{worst}");
}

#[test]
fn weights_match_the_definition_on_64_vertices_of_wild_densities() {
    // Each area density spans 60 decades, its square 120; along 64 vertices even f64 ends at both ends.
    std::thread::scope(|scope| {
        for seed in 3..8 {
            scope.spawn(move || {
                let worst = worst_error(63, 15.0, 0.2, seed);
                assert!(worst < 1e-9, "{worst}");
            });
        }
    });
}

#[test]
fn sums_by_kind_of_join_are_those_that_one_kind_alone_would_have() {
    let mut numbers = Numbers(9);
    for turn in 0..200 {
        let path = Path::random(2 + turn % 10, 3.0, 0.2, &mut numbers);
        for techniques in sets(&mut numbers) {
            for (s, heuristic) in (1..=path.k()).flat_map(|s| [(s, Heuristic::Balance), (s, Heuristic::Power)]) {
                let split: ByJoin = path.light_side::<Side<ByJoin>>(s, &techniques, heuristic).sum(heuristic, 0.7, 0.3);
                for join in Join::ALL {
                    let alone = path.light_side::<Side<Together>>(s, &techniques.only(join), heuristic).sum(heuristic, 0.7, 0.3).total();
                    assert!((split.of(join) - alone).abs() <= 1e-12 * alone, "{join:?}: {} and {alone}", split.of(join));
                }
            }
        }
    }
}

#[test]
fn rivals_beyond_all_numbers_are_of_the_kind_that_they_are() {
    let far = (0..4).fold(ByJoin::NONE.with(Join::Connection, 1.0), |sum, _| sum.times(1e300));
    let near = ByJoin::NONE.with(Join::NextEvent, 2.0);
    let both = near.and(far);
    assert_eq!([Join::NextEvent, Join::Connection, Join::LensSplat].map(|join| both.of(join)), [0.0, f64::INFINITY, 0.0]);
    assert_eq!(both.total(), f64::INFINITY);
}
