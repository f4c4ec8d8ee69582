//! With all its shaders in the sandbox, a scene makes the same bits as natively, at any number of threads.

use std::path::Path;

use bidir::image::Image;
use bidir_kernel::Techniques;

use super::{build, image, library, root, text_of};
use crate::{
    pictures::{BDPT, PATH, leave, mean_of},
    scenes::*,
};

const ESTIMATORS: [(&str, Techniques); 2] = [("path", PATH), ("bdpt", BDPT)];

/// Holds the scene with modules against the scene without.
fn same(name: &str, text: &str, folder: &Path, samples: u32) {
    let [native, sandboxed] = [false, true].map(|sandboxed| build(text, folder, sandboxed, &library()));
    for (estimator, techniques) in ESTIMATORS {
        let wanted = image(&native, techniques, samples, 1);
        assert!(mean_of(&wanted) > 0.0, "{name}: black");
        for threads in [1, 2] {
            let found = image(&sandboxed, techniques, samples, threads);
            let off = differing(&wanted, &found);
            if off > 0 {
                let folder = leave(&format!("bits_{name}_{estimator}"), &[("sandboxed", &found), ("native", &wanted)]);
                panic!("{name}, {estimator}, {threads} threads: {off} pixels of {}; see {}", wanted.pixels.len(), folder.display());
            }
        }
    }
}

fn differing(a: &Image, b: &Image) -> usize {
    let bits = |pixel: &[f32; 3]| pixel.map(f32::to_bits);
    assert_eq!((a.width, a.height), (b.width, b.height));
    a.pixels.iter().zip(&b.pixels).filter(|(a, b)| bits(a) != bits(b)).count()
}

fn example(name: &str) {
    let path = root().join("examples/scenes").join(name);
    same(&name.replace('/', "_"), &text_of(&path), path.parent().expect("a folder"), 4);
}

#[test]
fn welcome_is_the_same() {
    example("welcome.xml");
}

#[test]
fn cornell_is_the_same() {
    example("cornell/scene.xml");
}

#[test]
fn torchiere_is_the_same() {
    example("torchiere/scene.xml");
}

#[test]
fn caustic_sphere_is_the_same() {
    example("caustic_sphere/scene.xml");
}

#[test]
fn veach_mis_is_the_same() {
    example("veach_mis/scene.xml");
}

#[test]
fn env_glossy_is_the_same() {
    example("env_glossy/scene.xml");
}

#[test]
fn dof_glossy_is_the_same() {
    example("dof_glossy/scene.xml");
}

/// The room with a ball of `material` under `lights`; what is named `…$kind` is switched, and so are the walls.
fn small(name: &str, material: &str, lights: &str) {
    let content = [depth(6), pinhole(), room(), ball(material), lights.to_owned()].concat().replace("\"diffuse\"", "\"diffuse$kind\"");
    let text = format!(r#"<scene version="3.0.0"><default name="kind" value=""/>{content}</scene>"#);
    same(name, &text, &root().join("plugins/leaf"), 8);
}

fn switched_panel() -> String {
    panel().replace("\"area\"", "\"area$kind\"")
}

/// A material under a panel of light.
fn lit(name: &str, material: &str) {
    small(name, material, &switched_panel());
}

const CHECKS: &str = r#"<rgb name="color0" value="0.9, 0.5, 0.3"/><rgb name="color1" value="0.11, 0.2, 0.7"/><transform name="to_uv"><scale value="9, 7, 1"/></transform></texture>"#;

fn checks(name: &str) -> String {
    format!(r#"<texture type="checkerboard" name="{name}">{CHECKS}"#)
}

const GOLD: &str = r#"<rgb name="eta" value="0.143036, 0.375307, 1.44205"/><rgb name="k" value="3.983, 2.38556, 1.60336"/>"#;

fn odd_indices() -> String {
    float("int_ior", 1.4973) + &float("ext_ior", 1.000277)
}

#[test]
fn glass_of_odd_indices_is_the_same() {
    for kind in ["dielectric$kind", "thindielectric$kind", "roughdielectric$kind", "plastic$kind"] {
        lit(kind.trim_end_matches("$kind"), &bsdf(kind, &odd_indices()));
        lit(kind.trim_end_matches("$kind"), &bsdf(kind, &float("int_ior", 1.2345678)));
        lit(kind.trim_end_matches("$kind"), &bsdf(kind, ""));
    }
}

#[test]
fn textured_glass_is_the_same() {
    for kind in ["dielectric$kind", "thindielectric$kind"] {
        lit("textured", &bsdf(kind, &(odd_indices() + &checks("specular_reflectance") + &checks("specular_transmittance"))));
    }
    lit("textured_rough", &bsdf("roughdielectric$kind", &(odd_indices() + &checks("alpha") + &checks("specular_transmittance"))));
    lit("textured_plastic", &bsdf("plastic$kind", &(checks("diffuse_reflectance") + r#"<boolean name="nonlinear" value="true"/>"#)));
}

#[test]
fn nothing_is_the_same() {
    lit("null", &bsdf("null$kind", ""));
}

#[test]
fn a_picture_on_a_wall_is_the_same() {
    let bitmap = r#"<texture type="bitmap" name="reflectance"><string name="filename" value="front.png"/></texture>"#;
    lit("bitmap", &bsdf("diffuse$kind", bitmap));
}

#[test]
fn metals_are_the_same() {
    lit("conductor", &bsdf("conductor$kind", &(GOLD.to_owned() + &checks("specular_reflectance"))));
    lit("mirror", &bsdf("conductor$kind", ""));
    for distribution in ["beckmann", "ggx"] {
        let of = |content: &str| bsdf("roughconductor$kind", &format!(r#"<string name="distribution" value="{distribution}"/>{content}"#));
        lit("rough", &of(GOLD));
        lit("anisotropic", &of(&(GOLD.to_owned() + &float("alpha_u", 0.05) + &float("alpha_v", 0.313))));
        lit("anisotropic_texture", &of(&(checks("alpha_u") + &float("alpha_v", 0.313))));
        lit("smooth", &of(&(GOLD.to_owned() + &float("alpha", 0.0))));
        lit("textured", &of(&(checks("alpha") + &checks("specular_reflectance"))));
    }
}

#[test]
fn two_sides_are_the_same() {
    let front = bsdf("roughconductor$kind", GOLD);
    let back = bsdf("plastic$kind", &rgb("diffuse_reflectance", "0.2, 0.6, 0.3"));
    lit("twosided_both", &bsdf("twosided", &front));
    let turned = bsdf("twosided", &(back + &front));
    let disk = shape("disk", r#"<scale value="0.7"/><rotate y="1" angle="140"/><translate value="-0.8, 0.9, 0.9"/>"#, &turned);
    small("twosided", &turned, &(switched_panel() + &disk));
}

fn point() -> String {
    emitter("point$kind", &(rgb("intensity", "3.1, 2.3, 1.7") + r#"<point name="position" value="-0.7, 1.9, 1"/>"#))
}

fn spot(beam: &str) -> String {
    let aim = r#"<transform name="to_world"><lookat origin="1, 2.5, 1.5" target="0, 0.4, 0" up="0, 1, 0"/></transform>"#;
    emitter("spot$kind", &(rgb("intensity", "40, 38, 30") + &float("cutoff_angle", 33.3) + beam + aim))
}

fn surroundings() -> String {
    emitter("constant$kind", &rgb("radiance", "0.11, 0.23, 0.31"))
}

/// The chance of a light is its power: estimated, for a module, and still the same.
#[test]
fn lights_are_the_same() {
    let matt = diffuse("0.6, 0.4, 0.3");
    small("point", &matt, &point());
    small("spot", &matt, &spot(""));
    small("spot_with_beam", &matt, &spot(&float("beam_width", 7.7)));
    small("constant", &matt, &surroundings());
    small("together", &matt, &[switched_panel(), point(), spot(""), surroundings()].concat());
}

#[test]
fn forty_lights_are_the_same() {
    let lights: String = (0..40)
        .map(|i| {
            let (x, z) = (f64::from(i % 8) * 0.4 - 1.4, f64::from(i / 8) * 0.5 - 1.0);
            let transform = format!(r#"<scale value="0.1"/><rotate x="1" angle="90"/><translate value="{x}, 2.4, {z}"/>"#);
            shape("disk", &transform, &(diffuse("0.3, 0.3, 0.3") + &area(3.3 + f64::from(i % 5) * 6.1)))
                .replace("\"area\"", "\"area$kind\"")
        })
        .collect();
    small("forty", &diffuse("0.6, 0.4, 0.3"), &[lights, point(), spot(""), surroundings()].concat());
}
