//! A BSDF and a light as an author writes them, linked natively.

mod weave {
    use bidir_sdk::{Bsdf, Carried, Chance, Lobe, Made, Real, Scatter, Scattered, Spectrum, Vec3};

    bidir_sdk::parameters! {
        /// Cloth that "shines",
        /// in two lines.
        ///
        /// And what only readers of the code are told.
        pub struct Weave {
            /// Colour of the sheen.
            tint: rgb(min 0.0, max 1.0, texturable, label "Tint") = [0.5, 0.1, 0.2];
            scale: rgb = 2.0;
            /// Width of the sheen.
            roughness: float(label "Roughness", texturable, max 1.0, min -1.0) = -0.25;
            layers: int(min 1, max 8) = 3;
            flipped: bool = true;
            distribution: choice Distribution { Beckmann = "beckmann", Ggx = "ggx" } = "ggx";
        }
    }

    /// Passes light on with the numbers of its block as its weight, so that tests see them.
    impl Bsdf for Weave {
        fn eval(&self, _: Vec3, wi: Vec3, _: Carried) -> Scatter {
            Scatter { value: self.tint * wi.z, ..Scatter::NONE }
        }

        fn sample(&self, wo: Vec3, u: [Real; 3], carried: Carried) -> Option<Scattered> {
            let chance = |value| Chance(if carried == Carried::Importance { value } else { 1.0 });
            (u[0] < 0.5).then_some(Scattered {
                wi: -wo,
                weight: Spectrum::splat(self.roughness),
                made: Made::Delta { chance: chance(0.25), chance_rev: chance(0.75) },
                eta: 1.5,
                lobe: Lobe::DELTA_TRANSMISSION,
            })
        }

        fn lobes(&self) -> Lobe {
            Lobe::DELTA_TRANSMISSION
        }
    }

    bidir_sdk::bsdf! { Weave, lobes: [delta_transmission, diffuse_reflection], reciprocal: false, name: "weave" }
}

mod lamp {
    use bidir_sdk::{Emitted, PerSolidAngle, Profile, Real, Spectrum, Vec2, Vec3, math::vec3, profile::Profiled};

    bidir_sdk::parameters! { pub struct Dials { power: float(min 0.0) = 1.0; } }

    #[derive(Clone, Copy)]
    struct Lamp {
        radiance: Spectrum,
    }

    impl Profile for Lamp {
        fn eval(&self, uv: Vec2, direction: Vec3) -> Profiled {
            Profiled { radiance: self.radiance * direction.z, pdf: PerSolidAngle(uv.y) }
        }

        fn emit(&self, uv: Vec2, u: [Real; 2]) -> Option<Emitted> {
            let direction = vec3(0.0, 0.0, 1.0);
            (u[1] < 0.5).then_some(Emitted { direction, profiled: self.eval(uv, direction) })
        }
    }

    bidir_sdk::light! { Dials => |dials: &Dials| Lamp { radiance: Spectrum::splat(2.0 * dials.power) }, emits_from: [point, area] }
}

use bidir_sdk::{Parameters, Spectrum, answer};
use serde_json::{Value, json};
use weave::{Distribution, Weave};

#[test]
fn a_bsdf_s_manifest_says_what_was_declared() {
    let manifest: Value = serde_json::from_str(weave::MANIFEST).expect("JSON");
    let expected = json!({
        "name": "weave", "kind": "bsdf", "description": "Cloth that \"shines\", in two lines.",
        "lobes": ["diffuse_reflection", "delta_transmission"], "reciprocal": false, "isotropic": false,
        "params": [
            {"name": "tint", "type": "rgb", "offset": 0, "default": [0.5, 0.1, 0.2], "min": 0.0, "max": 1.0, "texturable": true,
             "label": "Tint", "help": "Colour of the sheen."},
            {"name": "scale", "type": "rgb", "offset": 12, "default": [2.0, 2.0, 2.0]},
            {"name": "roughness", "type": "float", "offset": 24, "default": -0.25, "min": -1.0, "max": 1.0, "texturable": true,
             "label": "Roughness", "help": "Width of the sheen."},
            {"name": "layers", "type": "int", "offset": 28, "default": 3, "min": 1, "max": 8},
            {"name": "flipped", "type": "bool", "offset": 32, "default": true},
            {"name": "distribution", "type": "enum", "offset": 36, "default": "ggx", "values": ["beckmann", "ggx"]},
        ],
    });
    assert_eq!(manifest, expected);
}

#[test]
fn a_light_s_manifest_says_where_it_shines_from() {
    let manifest: Value = serde_json::from_str(lamp::MANIFEST).expect("JSON");
    let params = json!([{"name": "power", "type": "float", "offset": 0, "default": 1.0, "min": 0.0}]);
    let expected = json!({"name": "plugins", "kind": "light", "description": "", "emits_from": ["area", "point"], "params": params});
    assert_eq!(manifest, expected);
}

#[test]
fn defaults_are_those_declared() {
    let expected = Weave {
        tint: Spectrum([0.5, 0.1, 0.2]),
        scale: Spectrum::splat(2.0),
        roughness: -0.25,
        layers: 3,
        flipped: true,
        distribution: Distribution::Ggx,
    };
    assert_eq!(Weave::default(), expected);
}

/// Ten words: the floats 1 … 7, then -4, 2 and `distribution`.
fn block(distribution: i32) -> Vec<u8> {
    let floats = (1..8u8).flat_map(|v| f32::from(v).to_le_bytes());
    floats.chain([-4_i32, 2, distribution].into_iter().flat_map(i32::to_le_bytes)).collect()
}

#[test]
fn a_block_is_read_at_the_manifest_s_offsets() {
    assert_eq!(Weave::BYTES, 40);
    let expected = Weave {
        tint: Spectrum([1.0, 2.0, 3.0]),
        scale: Spectrum([4.0, 5.0, 6.0]),
        roughness: 7.0,
        layers: -4,
        flipped: true,
        distribution: Distribution::Beckmann,
    };
    assert_eq!(Weave::from_block(&block(0)), expected);
}

#[test]
fn an_index_outside_a_choice_is_its_first_value() {
    for index in [-1, 2, i32::MIN] {
        assert_eq!(Weave::from_block(&block(index)).distribution, Distribution::Beckmann);
    }
    assert_eq!(Weave::from_block(&block(1)).distribution, Distribution::Ggx);
}

#[test]
fn a_short_block_ends_in_zeros() {
    let short = Weave::from_block(&block(1)[..20]);
    assert_eq!((short.scale, short.layers), (Spectrum([4.0, 5.0, 0.0]), 0));
}

#[test]
fn the_chances_of_a_delta_lobe_stand_where_densities_do() {
    let bsdf = weave::bsdf(&block(0));
    let out = answer::sample(&bsdf, 1, [0.0, 0.6, 0.8], [0.25, 0.0, 0.0]);
    assert_eq!((out.wi, out.weight), ([0.0, -0.6, -0.8], [7.0; 3]));
    assert_eq!((out.pdf, out.pdf_rev, out.lobe, out.eta), (0.25, 0.75, 32, 1.5));
}

#[test]
fn no_sample_is_lobe_0_and_a_record_of_zeros() {
    let out = answer::sample(&weave::bsdf(&block(0)), 0, [0.0, 0.6, 0.8], [0.75, 0.0, 0.0]);
    assert_eq!(out.to_bytes(), [0; 40]);
}

#[test]
fn the_lobes_answers_lie_in_the_record() {
    let out = answer::eval(&weave::bsdf(&block(0)), 0, [0.0, 0.0, 1.0], [0.0, 0.0, 0.5]);
    assert_eq!((out.value, out.pdf, out.pdf_rev), ([0.5, 1.0, 1.5], 0.0, 0.0));
}

#[test]
fn a_light_of_another_type_is_made_from_its_parameters() {
    let light = lamp::light(&3.0_f32.to_le_bytes());
    let out = answer::profile(&light, [0.0, 0.5], [0.0, 0.0, 0.5]);
    assert_eq!((out.radiance, out.pdf), ([3.0; 3], 0.5));
    let out = answer::emit(&light, [0.0, 0.5], [0.0, 0.25]);
    assert_eq!((out.direction, out.radiance, out.pdf), ([0.0, 0.0, 1.0], [6.0; 3], 0.5));
    assert_eq!(answer::emit(&light, [0.0, 0.5], [0.0, 0.75]).to_bytes(), [0; 28]);
}
