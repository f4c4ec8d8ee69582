use std::path::Path;

use super::*;
use crate::{
    load::{Loaded, load_str},
    plugin::Library,
    scene::description::{Filter, Geometry, Material, SensorKind, Texture},
};

fn old(content: &str) -> Result<Loaded> {
    let text = format!("<scene version=\"0.6.0\">\n{content}\n<sensor type=\"perspective\"/></scene>");
    load_str(&text, Path::new("s.xml"), None, &[], &Library::default())
}

#[test]
fn camel_case_is_turned_as_mitsuba_turns_it() {
    for (camel, underscore) in [
        ("toWorld", "to_world"),
        ("intIOR", "int_ior"),
        ("alphaU", "alpha_u"),
        ("cropOffsetX", "crop_offset_x"),
        ("B", "B"),
        ("rr_depth", "rr_depth"),
    ] {
        assert_eq!(underscored(camel), underscore);
    }
}

#[test]
fn one_warning_lists_each_name_once_with_its_first_line() {
    let shape = "<shape type=\"sphere\"><boolean name=\"flipNormals\" value=\"true\"/><transform name=\"toWorld\"/></shape>";
    let loaded = old(&format!(
        "<integrator type=\"path\"><integer name=\"maxDepth\" value=\"4\"/><boolean name=\"strictNormals\" value=\"true\"/></integrator>\n{shape}\n{shape}"
    ))
    .unwrap();
    assert_eq!(
        loaded.warnings,
        ["s.xml: written for Mitsuba 0.6.0: maxDepth (line 2) is read as max_depth, flipNormals (line 3) as flip_normals, \
          toWorld (line 3) as to_world; without effect: strictNormals (line 2)"]
    );
    assert_eq!(loaded.description.integrator.max_depth, Some(4));
    assert!(matches!(loaded.description.shapes[0].geometry, Geometry::Sphere { flip_normals: true, .. }));
}

#[test]
fn a_scene_of_today_keeps_its_names_and_an_older_one_without_old_names_is_not_mentioned() {
    let new = "<scene version=\"3.0.0\"><sensor type=\"perspective\"/><shape type=\"sphere\"><transform name=\"toWorld\"/></shape></scene>";
    assert!(load_str(new, Path::new("s.xml"), None, &[], &Library::default()).is_err());
    assert!(old("<shape type=\"sphere\"><point name=\"center\" x=\"1\" y=\"0\" z=\"0\"/></shape>").unwrap().warnings.is_empty());
}

#[test]
fn a_whole_scene_of_mitsuba_0_6_is_read() {
    let text = "<scene version=\"0.5.0\"><integrator type=\"path\"><integer name=\"rrDepth\" value=\"7\"/></integrator>
        <sensor type=\"thinlens\"><string name=\"fovAxis\" value=\"y\"/><float name=\"fov\" value=\"30\"/>
        <float name=\"apertureRadius\" value=\"0.1\"/><float name=\"focusDistance\" value=\"3\"/><float name=\"nearClip\" value=\"0.1\"/>
        <transform name=\"toWorld\"><lookAt origin=\"0, 0, 4\" target=\"0, 0, 0\" up=\"0, 1, 0\"/></transform>
        <film type=\"ldrfilm\"><integer name=\"width\" value=\"8\"/><integer name=\"height\" value=\"8\"/><string name=\"fileFormat\" value=\"png\"/>
        <string name=\"pixelFormat\" value=\"rgb\"/><float name=\"gamma\" value=\"2.2\"/><rfilter type=\"tent\"/></film>
        <sampler type=\"sobol\"><integer name=\"sampleCount\" value=\"16\"/></sampler></sensor>
        <bsdf type=\"diffuse\" id=\"myClay\"><srgb name=\"diffuseReflectance\" value=\"#ff8000\"/></bsdf>
        <bsdf type=\"plastic\" id=\"b\"><float name=\"intIOR\" value=\"1.5\"/><spectrum name=\"specularReflectance\" value=\"0.1, 0.2, 0.3\"/></bsdf>
        <shape type=\"cube\"><ref id=\"myClay\"/></shape></scene>";
    let scene = load_str(text, Path::new("s.xml"), None, &[], &Library::default()).unwrap().description;
    assert_eq!((scene.samples_per_pixel, scene.integrator.rr_depth, scene.film.filter), (16, 7, Filter::Tent { radius: 1.0 }));
    assert!(matches!(scene.sensor.kind, SensorKind::Perspective { aperture_radius: 0.1, focus_distance: 3.0, .. }));
    let Material::Diffuse { reflectance: Texture::Constant(clay) } = &scene.materials[0] else { panic!("not clay") };
    assert!((clay[0], clay[2]) == (1.0, 0.0) && (clay[1] - 0.215_860_5).abs() < 1e-6, "{clay:?}");
    let Material::Plastic { specular_reflectance: Texture::Constant(coat), .. } = &scene.materials[1] else { panic!("not plastic") };
    assert_eq!(coat.0, [0.1, 0.2, 0.3]);
}

#[test]
fn offsets_and_scales_are_to_uv_as_mitsuba_3_puts_them_together() {
    let numbers =
        [("uoffset", 0.25), ("uscale", 2.0), ("vscale", 3.0)].map(|(name, value)| format!("<float name=\"{name}\" value=\"{value}\"/>"));
    let loaded =
        old(&format!("<bsdf type=\"diffuse\"><texture type=\"checkerboard\" name=\"reflectance\">{}</texture></bsdf>", numbers.concat()))
            .unwrap();
    let Material::Diffuse { reflectance: Texture::Checkerboard { to_uv, .. } } = &loaded.description.materials[0] else {
        panic!("no squares")
    };
    assert_eq!(to_uv.0, [[2.0, 0.0, 0.5], [0.0, 3.0, 0.0]]);
    assert!(loaded.warnings[0].contains("uoffset (line 2) is read as to_uv, uscale (line 2) as to_uv"), "{:?}", loaded.warnings);
}

#[test]
fn an_older_integrator_counts_for_its_depths() {
    let depth = "<integer name=\"maxDepth\" value=\"4\"/><boolean name=\"lightImage\" value=\"true\"/>";
    let loaded = old(&format!("<integrator type=\"bdpt\">{depth}</integrator>")).unwrap();
    assert_eq!(loaded.description.integrator.max_depth, Some(4));
    assert!(
        loaded.warnings[0].contains("bdpt (line 2)") && loaded.warnings[0].contains("without effect: light_image"),
        "{:?}",
        loaded.warnings
    );
}

#[test]
fn what_is_no_longer_there_is_refused_with_what_to_write_instead() {
    for (content, thing) in [
        ("<bsdf type=\"phong\"/>", "bsdf type \"phong\" is not supported; use"),
        ("<emitter type=\"sunsky\"/>", "emitter type \"sunsky\" is not supported; bake"),
        ("<integrator type=\"irrcache\"/>", "integrator type \"irrcache\" is not supported; use path"),
        ("<luminaire type=\"constant\"/>", "<luminaire> is unknown here; write <emitter>"),
        ("<camera type=\"perspective\"/>", "<camera> is unknown here; write <sensor>"),
        (
            "<emitter type=\"constant\"><blackbody name=\"radiance\" temperature=\"5000K\"/></emitter>",
            "<blackbody> is unknown here; write <rgb>",
        ),
        ("<bsdf type=\"diffuse\"><srgb name=\"reflectance\" value=\"#12345\"/></bsdf>", "\"#12345\" is no colour"),
        ("<bsdf type=\"diffuse\"><spectrum name=\"reflectance\" value=\"400:1, 700:2\"/></bsdf>", "by wavelength"),
        ("<shape type=\"sphere\"><float name=\"fooBar\" value=\"1\"/></shape>", "has no parameter \"foo_bar\""),
    ] {
        let error = old(content).unwrap_err().to_string();
        assert!(error.contains(thing), "{error}");
    }
}
