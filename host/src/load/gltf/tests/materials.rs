//! Materials and their textures.

use serde_json::{Value, json};

use super::*;
use crate::scene::description::{NormalMap, Principled, ShapeLight, Wrap};

/// A scene of one square of this material.
fn of(material: Value) -> Loaded {
    let mut model = Model::default();
    square_of(&mut model, material);
    loaded(&model)
}

/// What a shape is made of, unwrapped of what is about it: `twosided`, `mask` and `normalmap`.
fn innermost(scene: &Description, shape: usize) -> &Material {
    let mut material = &scene.materials[scene.shapes[shape].material.0 as usize];
    while let Some(part) = material.parts().last() {
        material = &scene.materials[part.0 as usize];
    }
    material
}

fn principled(scene: &Description) -> &Principled {
    match innermost(scene, 0) {
        Material::Principled(of) | Material::PrincipledThin(of) => of,
        other => panic!("{other:?}"),
    }
}

fn first(scene: &Description) -> &Material {
    &scene.materials[scene.shapes[0].material.0 as usize]
}

fn constant(texture: &Texture) -> [f32; 3] {
    match texture {
        Texture::Constant(color) => color.0,
        other => panic!("{other:?}"),
    }
}

const PIXELS: [[u8; 4]; 2] = [[255, 128, 0, 255], [0, 64, 255, 51]];

#[test]
fn factors_alone_are_numbers_and_both_sides_are_alike() {
    let pbr = json!({"baseColorFactor": [0.5, 0.25, 0.125, 1.0], "metallicFactor": 0.25, "roughnessFactor": 0.75});
    let scene = of(json!({"pbrMetallicRoughness": pbr})).description;
    let found = principled(&scene);
    assert_eq!(constant(&found.base_color), [0.5, 0.25, 0.125]);
    assert!(found.metallic.is(0.25) && found.roughness.is(0.75) && found.eta.is(1.5) && found.spec_trans.is(0.0));
    assert!(matches!(first(&scene), Material::TwoSided { sides: [a, b] } if a == b));
}

#[test]
fn a_primitive_without_a_material_is_a_white_rough_metal() {
    let mut model = Model::default();
    let of_mesh = model.square(json!({}));
    model.node(json!({"mesh": of_mesh}));
    let scene = scene(&model);
    let found = principled(&scene);
    assert!(constant(&found.base_color) == [1.0; 3] && found.metallic.is(1.0) && found.roughness.is(1.0));
}

#[test]
fn colours_are_srgb_and_roughness_is_linear_green_and_metal_blue() {
    let mut model = Model::default();
    let texture = model.texture(2, &PIXELS);
    let named = json!({"index": texture});
    let pbr = json!({"baseColorFactor": [1.0, 0.5, 1.0, 1.0], "baseColorTexture": named, "roughnessFactor": 0.5, "metallicRoughnessTexture": named});
    square_of(&mut model, json!({"pbrMetallicRoughness": pbr}));
    let scene = scene(&model);
    let found = principled(&scene);
    let base = bitmap(&found.base_color).texels.get(0).unwrap();
    // IEC 61966-2-1 of 128 / 255.
    assert!(base[0] == 1.0 && near(base[1].into(), 0.5 * 0.215_860_5) && base[2] == 0.0);
    assert_eq!(bitmap(&found.roughness).texels.get(1).unwrap()[0], 0.5 * (64.0 / 255.0));
    assert_eq!(bitmap(&found.metallic).texels.iter().map(|texel| texel[0]).collect::<Vec<_>>(), [0.0, 1.0]);
    assert_eq!(mesh(&scene, 0).0.uvs[3], [0.0, 0.0]);
}

#[test]
fn a_band_that_is_the_same_everywhere_is_a_number() {
    let mut model = Model::default();
    let texture = model.texture(2, &[[9, 51, 0, 255], [200, 51, 0, 255]]);
    square_of(&mut model, json!({"pbrMetallicRoughness": {"metallicRoughnessTexture": {"index": texture}}}));
    let scene = scene(&model);
    assert!(principled(&scene).roughness.is(0.2) && principled(&scene).metallic.is(0.0));
}

#[test]
fn alpha_is_an_opacity_where_it_blends_and_all_or_nothing_where_it_is_cut_off() {
    for (mode, cutoff, wanted) in [("BLEND", 0.5, vec![0.5, 0.1]), ("MASK", 0.4, vec![1.0, 0.0]), ("MASK", 0.05, vec![])] {
        let mut model = Model::default();
        let texture = model.texture(2, &PIXELS);
        let pbr = json!({"baseColorFactor": [1, 1, 1, 0.5], "baseColorTexture": {"index": texture}});
        let mut material = json!({"alphaMode": mode, "pbrMetallicRoughness": pbr});
        if mode == "MASK" {
            material["alphaCutoff"] = json!(cutoff);
        }
        square_of(&mut model, material);
        let scene = scene(&model);
        match first(&scene) {
            Material::Mask { opacity, .. } => {
                let found: Vec<_> = bitmap(opacity).texels.iter().map(|texel| texel[0]).collect();
                assert!(found.iter().zip(&wanted).all(|(a, b): (&f32, &f64)| near((*a).into(), *b)), "{found:?} {wanted:?}");
            }
            other => assert!(wanted.is_empty() && matches!(other, Material::TwoSided { .. }), "{other:?}"),
        }
    }
    let opaque = of(json!({"pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.5]}})).description;
    assert!(matches!(first(&opaque), Material::TwoSided { .. }));
    let half = of(json!({"alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.5]}})).description;
    assert!(matches!(first(&half), Material::Mask { opacity, .. } if opacity.is(0.5)));
}

#[test]
fn normals_are_scaled_along_the_surface_and_turned_where_coordinates_are_mirrored() {
    let mut model = Model::default();
    let texture = model.texture(2, &[[255, 0, 255, 255], [128, 128, 255, 255]]);
    let material = model.add("materials", json!({"normalTexture": {"index": texture, "scale": 0.5}}));
    // The right half's coordinates run back to the left.
    let positions = model.vectors(&[SQUARE[0], SQUARE[1], SQUARE[2], SQUARE[3]]);
    let uvs = model.vectors(&[[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [2.0, 0.0]]);
    let indices = model.indices(&[0, 1, 2, 0, 2, 3]);
    let attributes = json!({"POSITION": positions, "TEXCOORD_0": uvs});
    let of_mesh = model.add("meshes", json!({"primitives": [{"attributes": attributes, "indices": indices, "material": material}]}));
    model.node(json!({"mesh": of_mesh}));
    let scene = scene(&model);
    let map = |shape: usize| {
        let Material::TwoSided { sides } = &scene.materials[scene.shapes[shape].material.0 as usize] else { panic!("one-sided") };
        match &scene.materials[sides[0].0 as usize] {
            Material::Bent { map: NormalMap::Normals(map), bending, .. } if bending.flips => bitmap(map).texels.get(0).unwrap().0,
            other => panic!("{other:?}"),
        }
    };
    assert_eq!((map(0), map(1)), ([0.75, 0.25, 1.0], [0.75, 0.75, 1.0]));
    assert_eq!((mesh(&scene, 0).0.triangles.len(), mesh(&scene, 1).0.triangles.len()), (1, 1));
}

#[test]
fn samplers_say_how_images_go_on() {
    let mut model = Model::default();
    let texture = model.texture(2, &PIXELS);
    model.add("samplers", json!({"magFilter": 9728, "wrapS": 33071, "wrapT": 33648}));
    let other = model.add("textures", json!({"source": 0, "sampler": 0}));
    for index in [texture, other] {
        square_of(&mut model, json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": index}}}));
    }
    let found = loaded(&model);
    let maps: Vec<_> = (0..2)
        .map(|shape| match innermost(&found.description, shape) {
            Material::Principled(of) => bitmap(&of.base_color),
            other => panic!("{other:?}"),
        })
        .collect();
    assert_eq!((maps[0].nearest, maps[0].wrap), (false, Wrap::Repeat));
    assert_eq!((maps[1].nearest, maps[1].wrap), (true, Wrap::Clamp));
    warning(&found, "texture 1 goes on as Clamp along u and as Mirror along v");
}

/// The specification's example: the lower left quadrant, turned clockwise.
#[test]
fn a_texture_transform_shows_the_quadrant_of_the_specification() {
    let mut model = Model::default();
    let texture = model.texture(2, &PIXELS);
    let transform = json!({"offset": [0.0, 1.0], "rotation": std::f32::consts::FRAC_PI_2, "scale": [0.5, 0.5]});
    let named = json!({"index": texture, "extensions": {"KHR_texture_transform": transform}});
    square_of(&mut model, json!({"pbrMetallicRoughness": {"baseColorTexture": named}}));
    let scene = scene(&model);
    let [[a, b, c], [d, e, f]] = bitmap(&principled(&scene).base_color).to_uv.0;
    let at = |u: f32, v: f32| (f64::from(a * u + b * v + c), f64::from(d * u + e * v + f));
    for (uv, wanted) in [((0.0, 0.0), (0.0, 1.0)), ((1.0, 0.0), (0.0, 0.5)), ((0.0, 1.0), (0.5, 1.0)), ((1.0, 1.0), (0.5, 0.5))] {
        let found = at(uv.0, uv.1);
        assert!(near(found.0, wanted.0) && near(found.1, wanted.1), "{uv:?}: {found:?}");
    }
}

#[test]
fn emission_is_factor_times_strength_and_its_texture() {
    let strength = json!({"KHR_materials_emissive_strength": {"emissiveStrength": 4.0}});
    let found = of(json!({"emissiveFactor": [1.0, 0.5, 0.0], "extensions": strength, "doubleSided": true}));
    let Some(ShapeLight::Area(radiance)) = &found.description.shapes[0].light else { panic!("dark") };
    assert_eq!(constant(radiance), [4.0, 2.0, 0.0]);
    assert!(found.description.emitters.is_empty());
    warning(&found, "shines from its front only");

    let mut model = Model::default();
    let texture = model.texture(2, &[[255, 255, 0, 255], [255, 0, 0, 255]]);
    square_of(&mut model, json!({"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": texture}}));
    let found = loaded(&model);
    let Some(ShapeLight::Area(radiance)) = &found.description.shapes[0].light else { panic!("dark") };
    assert_eq!(bitmap(radiance).texels.iter().collect::<Vec<_>>(), [Spectrum([1.0, 1.0, 0.0]), Spectrum([1.0, 0.0, 0.0])]);
}

#[test]
fn transmission_is_thin_without_a_volume_and_solid_with_one() {
    let through = |more: Value, metallic: f32| {
        let mut extensions = json!({"KHR_materials_transmission": {"transmissionFactor": 0.75}, "KHR_materials_ior": {"ior": 1.25}});
        for (name, value) in more.as_object().unwrap() {
            extensions[name] = value.clone();
        }
        of(json!({"pbrMetallicRoughness": {"metallicFactor": metallic}, "extensions": extensions}))
    };
    let thin = through(json!({}), 0.0).description;
    assert!(matches!(first(&thin), Material::PrincipledThin(of) if of.spec_trans.is(0.75) && of.eta.is(1.25)));
    let metal = through(json!({}), 0.5).description;
    assert!(matches!(first(&metal), Material::Blend { weight, .. } if weight.is(0.5)));
    crate::scene::Scene::new(&metal).unwrap();
    let solid = through(json!({"KHR_materials_volume": {"thicknessFactor": 1.0, "attenuationColor": [1, 0, 0]}}), 0.0);
    assert!(matches!(first(&solid.description), Material::Principled(of) if of.spec_trans.is(0.75)));
    warning(&solid, "what a volume absorbs");
    let leaf = json!({"KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 0.5}});
    let leaf = of(json!({"pbrMetallicRoughness": {"metallicFactor": 0.0}, "extensions": leaf})).description;
    assert!(matches!(first(&leaf), Material::PrincipledThin(of) if of.diff_trans.is(1.0) && of.spec_trans.is(0.0)));
}

#[test]
fn coats_sheen_and_weaker_reflections_are_told() {
    let extensions = json!({
        "KHR_materials_clearcoat": {"clearcoatFactor": 0.5, "clearcoatRoughnessFactor": 0.0},
        "KHR_materials_sheen": {"sheenColorFactor": [0.25, 0.5, 0.0]},
        "KHR_materials_specular": {"specularFactor": 0.25},
    });
    let scene = of(json!({"extensions": extensions})).description;
    let found = principled(&scene);
    assert!(found.clearcoat.is(0.5) && found.clearcoat_gloss.is(1.0) && found.sheen.is(0.5));
    // A quarter of 4 % is the square of 0.1.
    assert!(near(constant(&found.eta)[0].into(), 1.1 / 0.9));
    let unlit = of(json!({"extensions": {"KHR_materials_unlit": {}}}));
    assert!(matches!(innermost(&unlit.description, 0), Material::Diffuse { .. }));
    warning(&unlit, "is unlit");
}

#[test]
fn textures_that_take_other_coordinates_are_listed() {
    let mut model = Model::default();
    let texture = model.texture(2, &PIXELS);
    let named = |set: u32| json!({"index": texture, "texCoord": set});
    square_of(
        &mut model,
        json!({"emissiveTexture": named(0), "pbrMetallicRoughness": {"baseColorTexture": named(1), "metallicRoughnessTexture": named(0)}}),
    );
    let found = loaded(&model);
    warning(&found, "second sets of texture coordinates");
    warning(&found, "has textures and no TEXCOORD_1");
    assert_eq!(mesh(&found.description, 0).0.uvs, [[0.0; 2]; 4]);
}

#[test]
fn numbers_out_of_range_are_errors_that_name_the_material() {
    for (material, word) in [
        (json!({"name": "x", "pbrMetallicRoughness": {"baseColorFactor": [1, 2, 1, 1]}}), "baseColorFactor of material 0 \"x\" is 2"),
        (json!({"pbrMetallicRoughness": {"roughnessFactor": -1}}), "roughnessFactor of material 0 is -1"),
        (json!({"emissiveFactor": [-1, 0, 0]}), "material 0 sends out [-1.0, 0.0, 0.0]"),
        (json!({"alphaMode": "SOMETIMES"}), "alphaMode of material 0"),
        (json!({"normalTexture": {"index": 7}}), "texture 7 is named and is not there"),
        (json!({"extensions": {"KHR_materials_ior": {"ior": 0.5}}}), "index of refraction of material 0 is 0.5"),
        (json!({"extensions": {"KHR_materials_ior": {"ior": "glass"}}}), "KHR_materials_ior of material 0 cannot be read"),
    ] {
        let mut model = Model::default();
        square_of(&mut model, material);
        let error = error(&model);
        assert!(error.contains("m.gltf: ") && error.contains(word), "{error}");
    }
}
