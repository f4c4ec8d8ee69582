//! Is f32 as good as f64, but for what rounding explains?

mod partings;
mod paths;
mod shaders;

use bidir_twin::Held;

/// Prints every figure, and fails where one is out of its bound.
fn hold(what: &str, held: &[Held]) {
    for held in held {
        println!("{what}: {held}");
    }
    let out: Vec<String> = held.iter().filter(|held| !held.holds()).map(Held::to_string).collect();
    assert!(out.is_empty(), "{what}:\n{}", out.join("\n"));
}
