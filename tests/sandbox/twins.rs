//! Plugins in C, AssemblyScript and Zig make the picture that their twins in Rust make.
//!
//! Their sines, roots and sums are rounded otherwise, by some 1e-7 in each answer. A path whose directions are off by that brings as much
//! more or less in most pixels; where it passes an edge, or a number lies between two choices, it goes elsewhere and its pixel is another
//! one. So nearly all pixels must be equal up to rounding, and the means up to those few paths, of which there are too few to shift them.

use std::path::Path;

use bidir_kernel::Techniques;

use super::{build, image, library, root, text_of};
use crate::pictures::{BDPT, PATH, leave, mean_of};

const ESTIMATORS: [(&str, Techniques); 2] = [("path", PATH), ("bdpt", BDPT)];

/// What rounding may do to a pixel, as a share of it and of the mean.
const ROUNDING: f32 = 1e-3;
/// How many pixels may hold a path that went elsewhere.
const ELSEWHERE: f64 = 0.02;
/// What those may do to the mean.
const SHIFT: f64 = 2e-3;

fn same(folder: &str, kind: &str) {
    let folder = root().join("plugins").join(folder);
    let text = text_of(&folder.join("scene.xml"));
    let of = |text: &str, folder: &Path| build(text, folder, false, &library());
    let named = format!("type=\"{kind}\"");
    assert!(text.contains(&named));
    let [foreign, twin] = [of(&text, &folder), of(&text.replace(&named, &format!("type=\"{kind}-rust.wasm\"")), &folder)];
    for (estimator, techniques) in ESTIMATORS {
        let [found, wanted] = [&foreign, &twin].map(|subject| image(subject, techniques, 16, 1));
        let mean = mean_of(&wanted) as f32;
        let off = |(a, b): (&[f32; 3], &[f32; 3])| (0..3).any(|i| (a[i] - b[i]).abs() > ROUNDING * (b[i].abs() + mean));
        let share = found.pixels.iter().zip(&wanted.pixels).filter(|pair| off(*pair)).count() as f64 / wanted.pixels.len() as f64;
        let shift = mean_of(&found) / mean_of(&wanted) - 1.0;
        println!("{kind}, {estimator}: {:.3} % of pixels off, mean {shift:+.2e}, identical: {}", 100.0 * share, found == wanted);
        if share > ELSEWHERE || shift.abs() > SHIFT {
            let folder = leave(&format!("twins_{kind}_{estimator}"), &[("foreign", &found), ("rust", &wanted)]);
            panic!("{kind}, {estimator}: {share} of pixels, {shift} of the mean; see {}", folder.display());
        }
    }
}

#[test]
fn leaf_in_c_is_leaf_in_rust() {
    same("leaf", "leaf");
}

#[test]
fn iesspot_in_assemblyscript_is_iesspot_in_rust() {
    same("ies_spot", "iesspot");
}

#[test]
fn gobo_in_zig_is_gobo_in_rust() {
    same("gobo", "gobo");
}
