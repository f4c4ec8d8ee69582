//! Path by path.

use bidir_twin::{
    Tally,
    case::{Case, hard, matrix},
    named,
    setting::{Set, Sharing},
};

use super::hold;

/// All cases together. A pool's worst is the worst of its cases, and says which.
fn pooled(what: &str, cases: impl Iterator<Item = Case>) -> Tally {
    let mut all = Tally::default();
    let mut count = 0;
    for case in cases {
        all.merge(Tally::of(&case));
        count += 1;
    }
    println!(
        "{what}: {count} cases, {} samples, {} contributions {:?} by join, {} more at edges, largest |w32 − w64| {:.1e}",
        all.samples, all.compared, all.joins, all.edges, all.weight_difference
    );
    hold(what, &all.held());
    all
}

fn planned(techniques: Set, heuristic: Sharing) -> impl Iterator<Item = Case> {
    matrix().filter(move |case| case.plan.techniques == techniques && case.plan.heuristic == heuristic)
}

fn hard_with(part: &'static str) -> impl Iterator<Item = Case> {
    hard().filter(move |case| case.name.contains(part))
}

#[test]
fn path_tracing_is_the_same_in_f64() {
    pooled("path tracing, balance", planned(Set::Path, Sharing::Balance));
    pooled("path tracing, power", planned(Set::Path, Sharing::Power));
}

#[test]
fn light_tracing_is_the_same_in_f64() {
    pooled("light tracing, balance", planned(Set::Light, Sharing::Balance));
    pooled("light tracing, power", planned(Set::Light, Sharing::Power));
}

#[test]
fn bidirectional_paths_with_the_balance_heuristic_are_the_same_in_f64() {
    let all = pooled("bidirectional, balance", planned(Set::Bidirectional, Sharing::Balance));
    assert!(all.joins.iter().all(|count| *count > 0), "a join is never compared: {:?}", all.joins);
}

#[test]
fn bidirectional_paths_with_the_power_heuristic_are_the_same_in_f64() {
    pooled("bidirectional, power", planned(Set::Bidirectional, Sharing::Power));
}

/// Row 49 of the hard cases.
#[test]
fn chains_of_64_mirrors_are_the_same_in_f64() {
    pooled("chains of mirrors", hard_with("chain of 64"));
}

/// Row 50 of the hard cases.
#[test]
fn glossy_chains_are_the_same_in_f64_at_any_scale() {
    pooled("glossy chains", hard_with("64 glossy bounces"));
}

#[test]
fn small_and_large_worlds_are_the_same_in_f64() {
    pooled("scale 1e-6", hard_with("/scale 1e-6"));
    pooled("scale 1e6", hard_with("/scale 1e6"));
}

#[test]
fn worlds_far_away_are_the_same_in_f64() {
    pooled("1e3 sizes away", hard_with("1e3 sizes away"));
}

/// What a page asks for.
#[test]
fn a_case_is_found_by_its_name() {
    let case = named("diffuse/rectangle/pinhole/bidirectional/power").expect("a case");
    hold(&case.name, &case.run());
    assert!(named("diffuse/rectangle").is_none());
}
