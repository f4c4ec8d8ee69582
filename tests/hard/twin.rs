//! What the f64 twin says of a case: the kernel and the standard shaders, compiled a second time in f64 and held against f32 with the
//! same random numbers, path by path and shader by shader (`tests/twin`). Figures are in units of what rounding explains.

use bidir_twin::{
    Tally,
    case::{hard, matrix},
    shader::{self, Function},
};

use super::Held;

/// Of the case of that number; empty where the twin has nothing of what is hard about it: it knows no files, no modules, no host.
pub fn of_case(number: u32) -> Vec<Held> {
    match number {
        1 => [shaders(&["1e-4", "0.0001"]), paths(&["conductor of α = 1e-4/", "dielectric of α"])].concat(),
        4 | 5 | 13 => shaders(&[""]),
        6 => exactly(&["dielectric 1", "thin dielectric 1", "plastic 1"]),
        7 => [shaders(&["1.000001", "0.999999", "weak"]), paths(&["weak dielectric/"])].concat(),
        8 => shaders(&["dielectric"]),
        9 => paths(&["dielectric/", "thin dielectric/"]),
        12 => [shaders(&["conductor"]), paths(&["conductor/"])].concat(),
        14 | 16 => [shaders(&["plastic"]), paths(&["plastic/", "rough dielectric/"])].concat(),
        15 => paths(&["diffuse/"]),
        22 => [hard_paths("/scale 1e-6"), hard_paths("/scale 1e6"), hard_paths("1e3 sizes away")].concat(),
        // A bent tile stands in every room.
        24 | 25 => paths(&["diffuse/rectangle", "rough conductor/rectangle", "rough dielectric/rectangle"]),
        32 => [Function::Cone, Function::OneMinusCos].map(|function| held(shader::computed(function))).to_vec(),
        35 => [profiles(&["spot"]), paths(&["diffuse/spot/"])].concat(),
        38 => paths(&["diffuse/sky/", "diffuse/all lights/"]),
        44 => paths(&["/all lights/parallel/"]),
        49 => hard_paths("chain of 64"),
        50 => hard_paths("64 glossy bounces"),
        52 => path_tracing(),
        _ => Vec::new(),
    }
}

fn held(held: bidir_twin::Held) -> Held {
    let bidir_twin::Held { measure, worst, bound, parted, what } = held;
    Held::new(format!("{measure}, {:.3} % of the paths part: {what}", 100.0 * parted), worst, bound)
}

fn any(name: &str, parts: &[&str]) -> bool {
    parts.iter().any(|part| name.contains(part))
}

/// The worst of `eval` and of `sample`, of the shaders whose names hold one of these parts.
fn shaders(parts: &[&str]) -> Vec<Held> {
    of_surfaces(|name| any(name, parts))
}

fn exactly(names: &[&str]) -> Vec<Held> {
    of_surfaces(|name| names.contains(&name))
}

fn of_surfaces(meant: impl Fn(&str) -> bool) -> Vec<Held> {
    let surfaces = shader::surfaces();
    let meant = || surfaces.iter().filter(|(name, _)| meant(name));
    assert!(meant().next().is_some(), "no surface is meant");
    let evaluated = meant().map(|(name, material)| shader::evaluated(name, material));
    let sampled = meant().map(|(name, material)| shader::sampled(name, material));
    [worst(evaluated), worst(sampled)].into_iter().flatten().collect()
}

fn profiles(parts: &[&str]) -> Vec<Held> {
    let profiles = shader::profiles();
    let meant = || profiles.iter().filter(|(name, _)| any(name, parts));
    let evaluated = meant().map(|(name, gleam)| shader::profile_evaluated(name, gleam));
    let sampled = meant().map(|(name, gleam)| shader::profile_sampled(name, gleam));
    [worst(evaluated), worst(sampled)].into_iter().flatten().collect()
}

fn worst(all: impl Iterator<Item = bidir_twin::Held>) -> Option<Held> {
    all.map(held).max_by(|a, b| a.worst.total_cmp(&b.worst))
}

fn pooled(cases: impl Iterator<Item = bidir_twin::Case>) -> Vec<Held> {
    let mut all = Tally::default();
    cases.for_each(|case| all.merge(Tally::of(&case)));
    assert!(all.compared > 0, "no path is compared");
    all.held().into_iter().map(held).collect()
}

/// Bidirectional paths, by both heuristics, through rooms whose names hold one of these parts.
fn paths(parts: &[&str]) -> Vec<Held> {
    let names = |name: &str| name.contains("/bidirectional/") && any(name, parts);
    pooled(matrix().filter(|case| names(&case.name)))
}

fn path_tracing() -> Vec<Held> {
    pooled(matrix().filter(|case| case.name.starts_with("diffuse/") && case.name.contains("/path/")))
}

fn hard_paths(part: &str) -> Vec<Held> {
    pooled(hard().filter(|case| case.name.contains(part)))
}
