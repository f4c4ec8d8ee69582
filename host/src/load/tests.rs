//! Whole scenes, most of them one line long.

use std::path::Path;

use bidir_kernel::Spectrum;
use glam::DVec3;

use super::*;
use crate::{
    plugin::Library,
    scene::description::{EmitterKind, Filter, Geometry, Material, SensorKind, ShapeLight, Texture, Wrap},
};

const SENSOR: &str = "<sensor type=\"perspective\"/>";

fn read(content: &str) -> Result<Loaded> {
    load_str(&format!("<scene version=\"3.0.0\">{content}</scene>"), Path::new("s.xml"), None, &[], &Library::default())
}

/// A scene that has a sensor already.
fn scene(content: &str) -> Description {
    read(&format!("{SENSOR}{content}")).unwrap().description
}

fn error(content: &str) -> String {
    read(&format!("{SENSOR}{content}")).unwrap_err().to_string()
}

/// Errors for what stands inside an element.
fn error_in(tag: &str, kind: &str, content: &str) -> String {
    error(&format!("<{tag} type=\"{kind}\">{content}</{tag}>"))
}

fn with_sensor(kind: &str, content: &str) -> Result<Description> {
    read(&format!("<sensor type=\"{kind}\">{content}</sensor>")).map(|loaded| loaded.description)
}

fn fov_x(content: &str) -> f64 {
    match with_sensor("perspective", content).unwrap().sensor.kind {
        SensorKind::Perspective { fov_x, .. } => fov_x,
        SensorKind::Orthographic => panic!("not a perspective"),
    }
}

fn film(content: &str) -> Result<Description> {
    with_sensor("perspective", &format!("<film type=\"hdrfilm\">{content}</film>"))
}

#[test]
fn a_bare_sensor_has_mitsubas_defaults() {
    let scene = scene("");
    assert_eq!((scene.film.width, scene.film.height), (768, 576));
    assert_eq!(scene.film.filter, Filter::Gaussian { stddev: 0.5 });
    assert_eq!((scene.samples_per_pixel, scene.integrator.max_depth, scene.integrator.rr_depth), (4, None, 5));
    assert!((fov_x("") - 38.1848).abs() < 1e-4);
}

#[test]
fn a_scene_without_a_sensor_is_an_error() {
    assert!(read("").unwrap_err().to_string().contains("no sensor"));
}

#[test]
fn of_several_sensors_the_first_is_used_with_a_warning() {
    let loaded = read("<sensor type=\"orthographic\"/><sensor type=\"perspective\"/>").unwrap();
    assert_eq!(loaded.description.sensor.kind, SensorKind::Orthographic);
    assert_eq!(loaded.warnings.len(), 1);
}

#[test]
fn fields_of_view_are_turned_to_x_as_mitsuba_turns_them() {
    // Expected values as Mitsuba 3.9.1 reports them.
    let size = |w: u32, h: u32| {
        format!("<film type=\"hdrfilm\"><integer name=\"width\" value=\"{w}\"/><integer name=\"height\" value=\"{h}\"/></film>")
    };
    let wide = size(200, 100);
    let tall = size(100, 200);
    for (axis, in_wide, in_tall) in
        [("x", 40.0, 40.0), ("y", 72.1048, 20.6282), ("diagonal", 36.0648, 18.4902), ("smaller", 72.1048, 40.0), ("larger", 40.0, 20.6282)]
    {
        let fov = format!("<float name=\"fov\" value=\"40\"/><string name=\"fov_axis\" value=\"{axis}\"/>");
        assert!((fov_x(&format!("{fov}{wide}")) - in_wide).abs() < 1e-4, "{axis}");
        assert!((fov_x(&format!("{fov}{tall}")) - in_tall).abs() < 1e-4, "{axis}");
    }
    assert!((fov_x("<string name=\"focal_length\" value=\"35mm\"/>") - 52.6225).abs() < 1e-4);
}

#[test]
fn a_camera_that_scales_is_refused_and_a_mirrored_one_is_not() {
    let camera = |steps: &str| with_sensor("perspective", &format!("<transform name=\"to_world\">{steps}</transform>"));
    assert!(camera("<scale value=\"2\"/>").is_err());
    assert!(camera("<matrix value=\"1 1 0 0 1 0 0 0 1\"/>").is_err());
    assert!(camera("<scale x=\"-1\"/>").is_ok());
}

#[test]
fn a_film_without_pixels_or_with_too_many_is_one_clear_error() {
    for (content, thing) in [
        ("<integer name=\"width\" value=\"0\"/>", "width of film \"hdrfilm\" is 0"),
        ("<integer name=\"width\" value=\"1000000000\"/>", "width of film \"hdrfilm\" is 1000000000"),
        ("<integer name=\"width\" value=\"1000000\"/><integer name=\"height\" value=\"1000000\"/>", "2^30 pixels"),
        ("<integer name=\"crop_width\" value=\"0\"/>", "crop_width of film \"hdrfilm\" is 0"),
        ("<integer name=\"crop_offset_x\" value=\"700\"/>", "reaches beyond the image"),
        ("<integer name=\"crop_offset_x\" value=\"-1\"/>", "is -1"),
        ("<string name=\"pixel_format\" value=\"luminance\"/>", "luminance"),
        ("<rfilter type=\"lanczos\"><integer name=\"lobes\" value=\"99\"/></rfilter>", "must not be above"),
        ("<rfilter type=\"tent\"><float name=\"radius\" value=\"1e9\"/></rfilter>", "1000000000"),
    ] {
        let error = film(content).unwrap_err().to_string();
        assert!(error.contains(thing), "{error}");
    }
    assert!(film("<integer name=\"width\" value=\"8192\"/><integer name=\"height\" value=\"1\"/>").is_ok());
}

#[test]
fn depths_are_read_as_written() {
    let depth = |v: &str| read(&format!("{SENSOR}<integrator type=\"path\"><integer name=\"max_depth\" value=\"{v}\"/></integrator>"));
    assert_eq!(depth("0").unwrap().description.integrator.max_depth, Some(0));
    assert_eq!(depth("-1").unwrap().description.integrator.max_depth, None);
    assert!(depth("-2").is_err() && depth("1.0").is_err());
    assert_eq!(scene("<integrator type=\"direct\"/>").integrator.max_depth, Some(2));
    assert_eq!(scene("<integrator type=\"aov\"><integrator type=\"ptracer\"/></integrator>").integrator.kind, "ptracer");
    assert!(error("<integrator type=\"prb\"/>").contains("not supported"));
}

#[test]
fn an_unknown_parameter_tells_its_place_its_neighbour_and_all_there_are() {
    let text = "<scene version=\"3.0.0\"><sensor type=\"perspective\"/>\n<shape type=\"sphere\">\n  <float name=\"raduis\" value=\"1\"/></shape></scene>";
    let error = load_str(text, Path::new("s.xml"), None, &[], &Library::default()).unwrap_err().to_string();
    assert!(error.starts_with("s.xml:3:3: shape \"sphere\" has no parameter \"raduis\"; did you mean \"radius\"? it has "), "{error}");
    assert!(error.contains("center"), "{error}");
}

#[test]
fn a_parameter_of_the_wrong_type_is_told_with_the_right_one() {
    let error = error_in("shape", "sphere", "<string name=\"radius\" value=\"1\"/>");
    assert!(error.contains("radius of shape \"sphere\" is a string; write <float name=\"radius\""), "{error}");
}

#[test]
fn an_unknown_plugin_is_told_with_its_neighbour_and_a_known_one_with_what_to_use() {
    assert!(error("<bsdf type=\"ruffconductor\"/>").contains("did you mean \"roughconductor\"?"));
    assert!(error("<bsdf type=\"measured\"/>").contains("not supported; use"));
    assert!(error("<medium type=\"homogeneous\"/>").contains("media are not supported"));
}

#[test]
fn a_material_made_of_others_has_to_have_them() {
    let matt = "<bsdf type=\"diffuse\"/>";
    let hills = "<texture type=\"checkerboard\" name=\"hills\"/>";
    let glass = "<bsdf type=\"dielectric\"/>";
    let cases = [
        ("mask", String::new(), "mask holds 0 materials; put one <bsdf> into it"),
        ("blendbsdf", format!("{matt}<float name=\"weight\" value=\"0.5\"/>"), "blendbsdf holds 1 materials; put two <bsdf> into it"),
        ("blendbsdf", matt.repeat(2), "weight"),
        ("blendbsdf", format!("{}<float name=\"weight\" value=\"1.5\"/>", matt.repeat(2)), "every band must lie within 0 … 1"),
        ("normalmap", matt.to_owned(), "put one <texture type=\"bitmap\" name=\"normalmap\"> into it"),
        ("bumpmap", format!("{matt}{hills}"), "bumpmap takes a bitmap"),
        ("twosided", format!("<bsdf type=\"mask\">{matt}</bsdf>"), "twosided holds mask, which lets light through"),
        (
            "twosided",
            format!("<bsdf type=\"blendbsdf\"><float name=\"weight\" value=\"0.5\"/>{matt}{glass}</bsdf>"),
            "which lets light through",
        ),
        ("principled", "<float name=\"eta\" value=\"1.5\"/><float name=\"specular\" value=\"0.5\"/>".to_owned(), "keep either of them"),
        ("principled", "<float name=\"roughness\" value=\"2\"/>".to_owned(), "every band must lie within 0 … 1"),
        ("principledthin", "<float name=\"metallic\" value=\"1\"/>".to_owned(), "has no parameter \"metallic\""),
        ("roughplastic", "<float name=\"alpha\" value=\"-0.1\"/>".to_owned(), "write 0 or more"),
    ];
    for (kind, inside, words) in cases {
        let error = error_in("bsdf", kind, &inside);
        assert!(error.contains(words), "{kind}: {error}");
    }
}

#[test]
fn every_known_plugin_that_is_not_supported_is_refused() {
    for entry in catalog::entries()
        .filter(|e| e.instead.is_some() && !["film", "sampler", "rfilter", "texture", "medium", "sensor"].contains(&e.tag))
    {
        let error = error(&format!("<{} type=\"{}\"/>", entry.tag, entry.name));
        assert!(error.contains("is not supported"), "{error}");
    }
}

#[test]
fn a_shape_without_a_bsdf_is_diffuse_one_half_or_black_if_it_shines() {
    let lamp = "<shape type=\"disk\"><emitter type=\"area\"/></shape>";
    let scene = scene(&format!("<shape type=\"cube\"/><shape type=\"disk\"/>{lamp}{lamp}"));
    let reflectances: Vec<_> = scene
        .materials
        .iter()
        .map(|material| match material {
            Material::Diffuse { reflectance: Texture::Constant(c) } => *c,
            other => panic!("{other:?}"),
        })
        .collect();
    assert_eq!(reflectances, [0.5, 0.0].map(Spectrum::splat));
}

#[test]
fn references_may_come_first_and_share_what_they_name() {
    let scene = scene(
        "<shape type=\"cube\"><ref id=\"b\"/></shape><shape type=\"disk\"><ref id=\"c\"/></shape><bsdf type=\"null\" id=\"b\"/><alias id=\"b\" as=\"c\"/>",
    );
    assert_eq!(scene.materials.len(), 1);
    assert_eq!(scene.shapes[0].material, scene.shapes[1].material);
}

#[test]
fn references_to_nothing_to_themselves_and_ids_given_twice_are_errors() {
    assert!(error("<shape type=\"cube\"><ref id=\"b\"/></shape>").contains("nothing in the scene has the id \"b\""));
    assert!(error("<bsdf type=\"twosided\" id=\"b\"><ref id=\"b\"/></bsdf>").contains("refers to itself"));
    assert!(error("<bsdf type=\"null\" id=\"b\"/><bsdf type=\"null\" id=\"b\"/>").contains("is taken"));
}

#[test]
fn named_materials_resolve_to_mitsubas_numbers() {
    let scene = scene(
        "<bsdf type=\"dielectric\"/><bsdf type=\"plastic\"/><bsdf type=\"conductor\"/>\
         <bsdf type=\"roughconductor\"><string name=\"material\" value=\"Au\"/></bsdf>",
    );
    assert!(matches!(scene.materials[0], Material::Dielectric { eta, .. } if (eta - 1.50418).abs() < 1e-5));
    assert!(matches!(scene.materials[1], Material::Plastic { eta, nonlinear: false, .. } if (eta - 1.48959).abs() < 1e-5));
    assert!(matches!(scene.materials[2], Material::Conductor { eta, k, .. } if eta == Spectrum::BLACK && k == Spectrum::ONE));
    assert!(matches!(scene.materials[3], Material::RoughConductor { eta, .. } if eta == Spectrum([0.143036, 0.375307, 1.44205])));
}

#[test]
fn materials_that_make_no_sense_are_refused() {
    for (kind, content, thing) in [
        ("diffuse", "<rgb name=\"reflectance\" value=\"0.5 0.5 1.5\"/>", "0 … 1"),
        ("diffuse", "<float name=\"reflectance\" value=\"-0.1\"/>", "0 … 1"),
        ("diffuse", "<rgb name=\"reflectance\" value=\"nan\"/>", "not a finite number"),
        ("diffuse", "<spectrum name=\"reflectance\" value=\"400:0.1, 700:0.2\"/>", "by wavelength"),
        ("dielectric", "<float name=\"int_ior\" value=\"0\"/>", "above 0"),
        ("dielectric", "<string name=\"int_ior\" value=\"watr\"/>", "did you mean \"water\""),
        ("conductor", "<string name=\"material\" value=\"Gold\"/>", "is \"Gold\""),
        ("conductor", "<string name=\"material\" value=\"Au\"/><rgb name=\"eta\" value=\"1\"/>", "together"),
        ("roughconductor", "<float name=\"alpha\" value=\"-1\"/>", "not negative"),
        ("roughconductor", "<float name=\"alpha_u\" value=\"1\"/>", "needs a \"alpha_v\""),
        ("roughconductor", "<string name=\"distribution\" value=\"phong\"/>", "beckmann"),
        ("roughdielectric", "<float name=\"int_ior\" value=\"1\"/><float name=\"ext_ior\" value=\"1\"/>", "equal"),
        ("twosided", "", "holds 0 materials"),
        ("twosided", "<bsdf type=\"dielectric\"/>", "lets light through"),
    ] {
        let error = error_in("bsdf", kind, content);
        assert!(error.contains(thing), "{error}");
    }
}

#[test]
fn shapes_that_a_transform_would_break_are_refused() {
    let transform = |steps: &str| format!("<transform name=\"to_world\">{steps}</transform>");
    assert!(error_in("shape", "sphere", &transform("<scale value=\"1 2 1\"/>")).contains("ellipsoid"));
    assert!(error_in("shape", "cylinder", &transform("<scale value=\"1 2 1\"/>")).contains("squashes"));
    assert!(error_in("shape", "rectangle", &transform("<scale value=\"1 1 0\"/>")).contains("flattens"));
    assert!(error_in("shape", "cylinder", "<point name=\"p1\" value=\"0 0 0\"/>").contains("is p0"));
    assert!(error_in("shape", "sphere", "<point name=\"center\" value=\"1e300 0 0\"/>").contains("too large"));
    assert!(error_in("shape", "sphere", "<float name=\"radius\" value=\"1e-300\"/>").contains("above 0"));
    assert!(error_in("shape", "sphere", "<float name=\"radius\" value=\"-1\"/>").contains("above 0"));
    scene(&format!("<shape type=\"sphere\">{}</shape>", transform("<scale value=\"-2\"/><rotate y=\"1\" angle=\"33\"/>")));
    scene(&format!("<shape type=\"cylinder\">{}</shape>", transform("<scale value=\"2 2 5\"/><rotate y=\"1\" angle=\"33\"/>")));
}

const GROUP: &str = "<shape type=\"shapegroup\" id=\"g\"><shape type=\"cube\"/><shape type=\"disk\"/></shape>";

#[test]
fn a_group_is_read_once_however_many_instances_there_are() {
    let moved = "<shape type=\"instance\"><ref id=\"g\"/><transform name=\"to_world\"><translate x=\"2\"/></transform></shape>";
    let scene = scene(&format!("{moved}{GROUP}<shape type=\"instance\"><ref id=\"g\"/></shape><shape type=\"sphere\"/>"));
    assert_eq!((scene.shapes.len(), scene.groups.len(), scene.instances.len()), (1, 1, 2));
    assert_eq!(scene.groups[0].shapes.len(), 2);
    assert!(scene.instances.iter().all(|instance| instance.group.0 == 0));
    assert_eq!(scene.instances[0].to_world.translation, DVec3::new(2.0, 0.0, 0.0));
}

#[test]
fn a_group_that_holds_another_comes_after_it() {
    let outer = "<shape type=\"shapegroup\" id=\"h\"><shape type=\"instance\"><ref id=\"g\"/></shape></shape>";
    let scene = scene(&format!("{outer}{GROUP}<shape type=\"instance\"><ref id=\"h\"/></shape>"));
    assert_eq!((scene.groups[0].shapes.len(), scene.groups[1].instances.len()), (2, 1));
    assert_eq!((scene.groups[1].instances[0].group.0, scene.instances[0].group.0), (0, 1));
}

#[test]
fn a_group_without_an_instance_is_told_and_not_shown() {
    let loaded = read(&format!("{SENSOR}{GROUP}")).unwrap();
    assert!(loaded.description.shapes.is_empty() && loaded.description.instances.is_empty());
    assert_eq!(loaded.warnings.len(), 1);
    assert!(loaded.warnings[0].ends_with("no instance shows this group"), "{}", loaded.warnings[0]);
}

#[test]
fn groups_and_instances_that_make_no_sense_are_refused_where_they_stand() {
    let group = |content: &str| format!("<shape type=\"shapegroup\" id=\"h\">{content}</shape>{GROUP}");
    let instance = |content: &str| format!("{GROUP}<shape type=\"instance\">{content}</shape>");
    let transform = |step: &str| format!("<ref id=\"g\"/><transform name=\"to_world\">{step}</transform>");
    for (content, thing) in [
        (group("<shape type=\"disk\"><emitter type=\"area\"/></shape>"), "an emitter stands inside a group or an instance; take it out"),
        (group("<emitter type=\"point\"/>"), "an emitter stands inside a group or an instance; take it out"),
        (instance("<ref id=\"g\"/><emitter type=\"area\"/>"), "an emitter stands inside a group or an instance; take it out"),
        (instance("<ref id=\"g\"/><bsdf type=\"null\"/>"), "no material of its own; its shapes keep their own"),
        (group("<shape type=\"shapegroup\"><shape type=\"disk\"/></shape>"), "a group stands directly inside another; put its shapes here"),
        (group(""), "the group holds no shape; put one into it"),
        (group("<shape type=\"disk\"/><transform name=\"to_world\"/>"), "is not supported; give it to the shapes inside"),
        (group("<shape type=\"disk\"/><bsdf type=\"null\"/>"), "a <bsdf> means nothing inside shape \"shapegroup\""),
        (group("<shape type=\"instance\"><ref id=\"h\"/></shape>"), "the group on line 1 holds itself; take one"),
        (instance("<ref id=\"k\"/>"), "nothing in the scene has the id \"k\""),
        (instance(""), "the instance is of no group; write <ref"),
        (instance("<shape type=\"disk\"/>"), "the instance is of a shape of type \"disk\"; put that shape into a shapegroup"),
        (instance("<ref id=\"g\"/><ref id=\"g\"/>"), "has more than one <shape>"),
        (instance("<ref id=\"g\"/><boolean name=\"flip_normals\" value=\"true\"/>"), "has no parameter \"flip_normals\""),
        (instance(&transform("<scale x=\"0\"/>")), "to_world of shape \"instance\" flattens the group; scale every axis"),
    ] {
        let error = error(&content);
        assert!(error.starts_with("s.xml:1:") && error.contains(thing), "{error}");
    }
}

/// Reading goes as deep as groups may, and no deeper, whichever comes first in the file.
#[test]
fn groups_may_lie_eight_deep_in_each_other() {
    let nested = |levels: usize, innermost_first: bool| {
        let instance = |of: usize| format!("<shape type=\"instance\"><ref id=\"g{of}\"/></shape>");
        let group = |id: usize| {
            let content = if id == 1 { "<shape type=\"disk\"/>".to_owned() } else { instance(id - 1) };
            format!("<shape type=\"shapegroup\" id=\"g{id}\">{content}</shape>")
        };
        let groups: String = if innermost_first { (1..=levels).map(group).collect() } else { (1..=levels).rev().map(group).collect() };
        read(&format!("{SENSOR}{groups}{}", instance(levels)))
    };
    for innermost_first in [true, false] {
        assert_eq!(nested(8, innermost_first).unwrap().description.groups.len(), 8);
        for levels in [9, 10_000] {
            let error = nested(levels, innermost_first).unwrap_err().to_string();
            assert!(error.starts_with("s.xml:1:") && error.contains("instances lie within each other more than 8 deep; write"), "{error}");
        }
    }
}

#[test]
fn lights_have_mitsubas_defaults() {
    let scene = scene(
        "<emitter type=\"point\"/><emitter type=\"spot\"/><emitter type=\"directional\"/><emitter type=\"constant\"/>\
         <shape type=\"disk\"><emitter type=\"area\"/></shape>",
    );
    assert!(matches!(scene.emitters[0].kind, EmitterKind::Point { position: DVec3::ZERO, intensity: Spectrum::ONE }));
    assert!(matches!(scene.emitters[1].kind, EmitterKind::Spot { cutoff_angle: 20.0, beam_width: 15.0, .. }));
    assert!(matches!(scene.emitters[2].kind, EmitterKind::Directional { direction: DVec3::Z, .. }));
    assert!(matches!(scene.shapes[0].light, Some(ShapeLight::Area(Texture::Constant(Spectrum::ONE)))));
}

/// Mitsuba 3.9.1 gives 2.40959, 1.89658 and 1.81783.
#[test]
fn light_alike_at_every_wavelength_is_the_white_of_equal_energy() {
    let scene = scene("<emitter type=\"point\"><spectrum name=\"intensity\" value=\"2\"/></emitter>");
    let EmitterKind::Point { intensity, .. } = scene.emitters[0].kind else { panic!("no point") };
    assert!(intensity.0.iter().zip([2.40959, 1.89658, 1.81783]).all(|(a, b)| (a - b).abs() < 1e-4), "{intensity:?}");
}

#[test]
fn lights_that_make_no_sense_are_refused() {
    for (content, thing) in [
        ("<emitter type=\"constant\"/><emitter type=\"constant\"/>", "second environment"),
        ("<emitter type=\"constant\"><rgb name=\"radiance\" value=\"-1\"/></emitter>", "is negative"),
        ("<emitter type=\"constant\"><rgb name=\"radiance\" value=\"inf\"/></emitter>", "not a finite number"),
        ("<emitter type=\"directional\"><vector name=\"direction\" value=\"0\"/></emitter>", "is 0"),
        ("<shape type=\"disk\"><emitter type=\"point\"/></shape>", "move it out of the shape"),
        (
            "<emitter type=\"area\" id=\"e\"/><shape type=\"disk\"><ref id=\"e\"/></shape><shape type=\"cube\"><ref id=\"e\"/></shape>",
            "another shape already",
        ),
        ("<emitter type=\"envmap\"/>", "needs a \"filename\""),
        ("<emitter type=\"sunsky\"/>", "not supported"),
    ] {
        let error = error(content);
        assert!(error.contains(thing), "{error}");
    }
}

#[test]
fn an_embedded_scene_cannot_name_files() {
    assert!(error_in("shape", "ply", "<string name=\"filename\" value=\"a.ply\"/>").contains("not in a folder"));
}

/// A scene in a folder of its own, with one file beside it.
fn beside(name: &str, content: &[u8], scene: &str) -> Result<Loaded> {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join(name), content).unwrap();
    let path = folder.path().join("scene.xml");
    std::fs::write(&path, format!("<scene version=\"3.0.0\">{SENSOR}{scene}</scene>")).unwrap();
    load(&path, &[], &Library::default())
}

const OBJ: &str = "<shape type=\"obj\"><string name=\"filename\" value=\"m.obj\"/></shape>";

#[test]
fn a_mesh_named_twice_is_kept_once() {
    let loaded = beside("m.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 1 2\n", &OBJ.repeat(2)).unwrap();
    let mesh = |at: usize| match &loaded.description.shapes[at].geometry {
        Geometry::Mesh { mesh, .. } => mesh.clone(),
        _ => panic!("not a mesh"),
    };
    assert!(std::sync::Arc::ptr_eq(&mesh(0), &mesh(1)));
    assert_eq!(mesh(0).normals, [[0.0, 0.0, 1.0]; 3]);
    assert_eq!(loaded.warnings.len(), 1);
    assert!(loaded.warnings[0].contains("dropped 1 triangles"));
}

#[test]
fn a_broken_mesh_is_one_error_that_names_scene_and_mesh() {
    for (content, thing) in
        [("v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3", "none with an area"), ("", "has no triangles"), ("v 0 0 0\nf 1 1 1", "none with an area")]
    {
        let error = beside("m.obj", content.as_bytes(), OBJ).unwrap_err().to_string();
        assert!(error.contains("scene.xml:1:") && error.contains("m.obj") && error.contains(thing), "{error}");
    }
    assert!(beside("x.obj", b"", OBJ).unwrap_err().to_string().contains("there is no file"));
}

#[test]
fn an_objs_v_points_up_and_an_images_v_down() {
    let content = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.25 0.25\nf 1/1 2/1 3/1\n";
    let loaded = beside("m.obj", content, OBJ).unwrap();
    assert!(matches!(&loaded.description.shapes[0].geometry, Geometry::Mesh { mesh, .. } if mesh.uvs[0] == [0.25, 0.75]));
}

#[test]
fn a_bitmap_is_read_with_its_options() {
    let mut png = std::io::Cursor::new(Vec::new());
    image::RgbImage::from_raw(1, 2, vec![255, 0, 0, 128, 128, 128]).unwrap().write_to(&mut png, image::ImageFormat::Png).unwrap();
    let texture = |extra: &str| {
        format!(
            "<bsdf type=\"diffuse\"><texture type=\"bitmap\" name=\"reflectance\"><string name=\"filename\" value=\"t.png\"/>{extra}</texture></bsdf>"
        )
    };
    let options = "<boolean name=\"raw\" value=\"true\"/><string name=\"wrap_mode\" value=\"clamp\"/><string name=\"filter_type\" value=\"nearest\"/>\
                   <transform name=\"to_uv\"><scale value=\"2 3 1\"/><translate x=\"0.5\"/></transform>";
    let loaded = beside("t.png", png.get_ref(), &texture(options)).unwrap();
    let Material::Diffuse { reflectance: Texture::Bitmap(bitmap) } = &loaded.description.materials[0] else { panic!("not a bitmap") };
    assert_eq!((bitmap.width, bitmap.height, bitmap.nearest, bitmap.wrap), (1, 2, true, Wrap::Clamp));
    assert_eq!(bitmap.texels.iter().collect::<Vec<_>>(), [Spectrum([1.0, 0.0, 0.0]), Spectrum::splat(128.0 / 255.0)]);
    assert_eq!(bitmap.to_uv.0, [[2.0, 0.0, 0.5], [0.0, 3.0, 0.0]]);
    let error = beside("t.png", b"not an image", &texture("")).unwrap_err().to_string();
    assert!(error.contains("t.png") && error.contains("cannot be decoded"), "{error}");
}

#[test]
fn a_folder_and_a_missing_scene_are_errors() {
    let folder = tempfile::tempdir().unwrap();
    assert!(load(folder.path(), &[], &Library::default()).unwrap_err().to_string().contains("is not a file"));
    assert!(load(&folder.path().join("none.xml"), &[], &Library::default()).unwrap_err().to_string().contains("cannot be read"));
}

#[test]
fn a_scene_cut_short_or_garbled_anywhere_is_an_error_or_a_scene_but_never_a_panic() {
    let whole = format!(
        "<scene version=\"3.0.0\"><default name=\"a\" value=\"0.5\"/>{SENSOR}<bsdf type=\"roughconductor\" id=\"b\"><float name=\"alpha\" value=\"$a\"/></bsdf>\
         <shape type=\"cube\"><transform name=\"to_world\"><rotate y=\"1\" angle=\"$a\"/></transform><ref id=\"b\"/></shape></scene>"
    );
    for at in 0..whole.len() {
        let _either = load_str(&whole[..at], Path::new("s.xml"), None, &[], &Library::default());
        for other in ["\"", "<", ">", "$", "-", "9", "é", " "] {
            let _either =
                load_str(&format!("{}{other}{}", &whole[..at], &whole[at + 1..]), Path::new("s.xml"), None, &[], &Library::default());
        }
    }
}
