//! Surfaces whose normal is turned: what holds of others holds of them, but that their two ends differ.

use std::{format, vec::Vec};

use bidir_sdk::{Bsdf, Carried, Made, Real, Vec3, math::normalize};

use super::{close, direction, directions, numbers, surfaces};
use crate::{Bent, Blend, Conductor, Diffuse};

fn normals() -> Vec<Vec3> {
    [(0.0, 0.0), (0.3, 1.0), (0.9, 4.0), (1.5, 2.5)].map(|(tilt, phi): (Real, Real)| direction(tilt.cos(), phi)).to_vec()
}

fn all() -> Vec<(std::string::String, std::boxed::Box<dyn Bsdf>)> {
    let gold = surfaces::gold(surfaces::microfacets(&[(0.2, 0.4)])[0]);
    let mut all: Vec<(_, std::boxed::Box<dyn Bsdf>)> = Vec::new();
    for normal in normals() {
        for (flips, shadowed) in [(true, true), (false, false), (true, false)] {
            let name = |what: &str| format!("{what} about {normal}, flips {flips}, shadowed {shadowed}");
            let matt = Diffuse { reflectance: gold.specular_reflectance };
            all.push((name("matt"), std::boxed::Box::new(Bent::new(normal, flips, shadowed, matt))));
            all.push((name("gold"), std::boxed::Box::new(Bent::new(normal, flips, shadowed, gold))));
            let both = Blend { weight: 0.3, first: matt, second: gold };
            all.push((name("both"), std::boxed::Box::new(Bent::new(normal, flips, shadowed, both))));
        }
    }
    all
}

#[test]
fn a_walk_from_either_end_sees_the_same_surface() {
    for (name, bsdf) in all() {
        for camera in directions() {
            for index in 0..200 {
                let u = numbers(3, index);
                let light = direction(2.0 * u[0] - 1.0, 6.3 * u[1]);
                let (there, back) = (bsdf.eval(camera, light, Carried::Radiance), bsdf.eval(light, camera, Carried::Importance));
                let scale = (camera.z / light.z).abs();
                let alike = there.value.0.iter().zip(back.value.0).all(|(&there, back)| close(there * scale, back, 1e-3));
                assert!(alike, "{name}, {camera} to {light}: {there:?} {back:?}");
                assert!(close(there.pdf.0, back.pdf_rev.0, 1e-3), "{name}, {camera} to {light}: {there:?} {back:?}");
                assert!(close(there.pdf_rev.0, back.pdf.0, 1e-3), "{name}, {camera} to {light}: {there:?} {back:?}");
            }
        }
    }
}

#[test]
fn samples_have_the_weights_and_densities_that_are_asked_afterwards() {
    for (name, bsdf) in all() {
        for wo in directions() {
            for carried in [Carried::Radiance, Carried::Importance] {
                for index in 0..200 {
                    let Some(sample) = bsdf.sample(wo, numbers(2, index), carried) else { continue };
                    let Made::Smooth { pdf, pdf_rev } = sample.made else { panic!("{name}: {sample:?}") };
                    let scatter = bsdf.eval(wo, sample.wi, carried);
                    let alike = sample.weight.0.iter().zip(scatter.value.0).all(|(&weight, value)| close(weight * pdf.0, value, 2e-3));
                    assert!(alike, "{name}, wo {wo}, {carried:?}: {sample:?} against {scatter:?}");
                    assert!(close(pdf.0, scatter.pdf.0, 2e-3), "{name}, wo {wo}, {carried:?}: {sample:?} against {scatter:?}");
                    assert!(close(pdf_rev.0, scatter.pdf_rev.0, 2e-3), "{name}, wo {wo}, {carried:?}: {sample:?} against {scatter:?}");
                }
            }
        }
    }
}

#[test]
fn a_mirror_is_found_from_both_ends_with_one_chance() {
    let mirror = Conductor { eta: bidir_sdk::Spectrum::BLACK, k: bidir_sdk::Spectrum::ONE, specular_reflectance: bidir_sdk::Spectrum::ONE };
    let mut found = 0;
    for normal in normals() {
        let bent = Bent::new(normal, true, false, mirror);
        for camera in directions().into_iter().filter(|camera| camera.z > 0.0) {
            let Some(there) = bent.sample(camera, [0.5; 3], Carried::Radiance) else { continue };
            let Made::Delta { chance, chance_rev } = there.made else { panic!("{there:?}") };
            let again: Vec<_> =
                [0.01, 0.99].into_iter().filter_map(|u| bent.sample(there.wi, [0.5, 0.5, u], Carried::Importance)).collect();
            let back = again.iter().find(|back| normalize(back.wi - camera).is_none_or(|_| (back.wi - camera).length() < 1e-3));
            let Some(back) = back else { panic!("{normal}, {camera}: {there:?} {again:?}") };
            let Made::Delta { chance: light, chance_rev: light_rev } = back.made else { panic!("{back:?}") };
            assert!(close(chance.0, light_rev.0, 1e-5) && close(chance_rev.0, light.0, 1e-5), "{there:?} {back:?}");
            let scale = chance.0 / light.0 * (camera.z / there.wi.z).abs();
            // f |cos θ| / chance, whose f is the same mirror's.
            assert!(close(back.weight[0], there.weight[0] * scale, 1e-3), "{normal}, {camera}: {there:?} {back:?}");
            found += 1;
        }
    }
    assert!(found > 10);
}
