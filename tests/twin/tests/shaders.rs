//! Shader by shader.

use bidir_twin::{Held, shader};

use super::hold;

/// The worst of every shader is told; those beyond their bounds fail.
fn worst_first(what: &str, held: impl Iterator<Item = Held>) {
    let mut held: Vec<Held> = held.collect();
    held.sort_by(|a, b| b.worst.total_cmp(&a.worst));
    hold(what, &held);
    for held in held {
        assert!(held.parted < 0.2, "hardly an answer is compared: {held}");
    }
}

#[test]
fn surfaces_evaluate_to_the_same_in_f64() {
    worst_first("surfaces", shader::surfaces().iter().map(|(name, material)| shader::evaluated(name, material)));
}

#[test]
fn surfaces_sample_the_same_in_f64() {
    worst_first("surfaces", shader::surfaces().iter().map(|(name, material)| shader::sampled(name, material)));
}

#[test]
fn functions_of_the_kernel_are_the_same_in_f64() {
    worst_first("functions", shader::FUNCTIONS.into_iter().map(shader::computed));
}

#[test]
fn profiles_are_the_same_in_f64() {
    let profiles = shader::profiles();
    worst_first("profiles", profiles.iter().map(|(name, gleam)| shader::profile_evaluated(name, gleam)));
    worst_first("profiles", profiles.iter().map(|(name, gleam)| shader::profile_sampled(name, gleam)));
}
