//! Meshes in files.

use std::{path::Path, sync::Arc};

use bidir::{
    error::Place,
    load::{
        self,
        mesh::{Format, Parsed, parse},
    },
    plugin::Library,
    scene::description::{Description, Geometry, MaterialId, Mesh, Per, Shape, ShapeLight, Texture},
};
use bidir_kernel::{Ray, Scene as _, Segment, Spectrum};
use glam::{DAffine3, DVec3};

use crate::{told, trace};

/// The most triangles of a mesh that is built.
const MOST_TRIANGLES: usize = 10_000;

/// How many of its triangles are looked at.
const LOOKED_AT: usize = 16;

/// Wavefront OBJ.
pub fn obj(data: &[u8]) {
    mesh(data, Format::Obj);
}

/// Stanford PLY.
pub fn ply(data: &[u8]) {
    mesh(data, Format::Ply);
}

/// Mitsuba's own meshes, which are packed.
pub fn serialized(data: &[u8]) {
    let index = u32::from(data.last().is_some_and(|byte| byte % 2 == 1));
    mesh(data, Format::Serialized { index });
}

/// What a byte of a packed file may become.
const UNPACKED: usize = 256;

/// A mesh is refused with a remedy, or has finite vertices and corners that are there, is no larger than its file, and can be lit and hit.
fn mesh(data: &[u8], format: Format) {
    let Parsed { mesh, dropped, .. } = match parse(data, format, Path::new("fuzz.mesh")) {
        Ok(parsed) => parsed,
        Err(error) => return told(&error),
    };
    let count = mesh.positions.len();
    assert!(!mesh.triangles.is_empty());
    let most = data.len() * if let Format::Serialized { .. } = format { UNPACKED } else { 1 };
    assert!(count <= most && mesh.triangles.len() + dropped <= most, "the mesh is larger than its file");
    assert!(mesh.positions.as_flattened().iter().all(|v| v.abs() <= 1e30));
    assert!(mesh.normals.as_flattened().iter().chain(mesh.uvs.as_flattened()).all(|v| v.is_finite()));
    assert!([0, count].contains(&mesh.normals.len()) && [0, count].contains(&mesh.uvs.len()));
    let length = |per| if per == Per::Vertex { count } else { mesh.triangles.len() };
    assert!(mesh.attributes.iter().all(|attribute| attribute.values.len() == length(attribute.per)));
    assert!(mesh.triangles.as_flattened().iter().all(|corner| (*corner as usize) < count));
    if mesh.triangles.len() <= MOST_TRIANGLES {
        hit(Arc::new(mesh));
    }
}

/// Builds a scene of the mesh, which shines, and looks at its first triangles from straight above.
fn hit(mesh: Arc<Mesh>) {
    let Some(scene) = trace::built(&scene(&mesh)) else { return };
    let view = trace::view(&scene);
    for triangle in mesh.triangles.iter().take(LOOKED_AT) {
        let [a, b, c] = triangle.map(|corner| DVec3::from_array(mesh.positions[corner as usize].map(f64::from)));
        let across = (b - a).cross(c - a).normalize_or_zero() * (b - a).length();
        let middle = (a + b + c) / 3.0 - scene.origin();
        let (origin, direction) = ((middle + across).as_vec3(), -across.as_vec3());
        let ray = Ray { origin, direction, t_max: f32::INFINITY, segment: Segment::Inner };
        if let Some((point, _)) = view.intersect(&ray) {
            trace::plausible(&point);
        }
    }
}

/// A camera, a sky and the mesh.
fn scene(mesh: &Arc<Mesh>) -> Description {
    const REST: &str = r#"<scene version="3.0.0">
        <sensor type="perspective"><transform name="to_world"><lookat origin="0 1 4" target="0 0 0" up="0 1 0"/></transform></sensor>
        <bsdf type="diffuse"/>
        <emitter type="constant"/>
    </scene>"#;
    let name = Path::new("fuzz.xml");
    let mut description = load::load_str(REST, name, None, &[], &Library::default()).expect("a good scene").description;
    description.shapes.push(Shape {
        geometry: Geometry::Mesh { mesh: mesh.clone(), to_world: DAffine3::IDENTITY, flip_normals: false },
        material: MaterialId(0),
        light: Some(ShapeLight::Area(Texture::Constant(Spectrum::ONE))),
        name: "mesh".to_owned(),
        place: Place { file: name.to_owned(), position: None },
    });
    description
}
