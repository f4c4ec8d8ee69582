//! `<texture type="mesh_attribute">`: what a mesh's file says of its vertices or triangles. It is read anew for each mesh that wears it.

use std::sync::Arc;

use bidir_kernel::Spectrum;

use super::{
    context::Context,
    properties::Properties,
    suggest::{did_you_mean, list},
    texture::Range,
};
use crate::{
    error::{Error, Place, Result},
    scene::description::{Mesh, Texture},
};

/// What wears the material that is being read.
#[derive(Clone, Debug, Default)]
pub(super) enum Wearer {
    /// Nothing: it is not a material that is being read.
    #[default]
    Nobody,
    /// Nothing yet: a material or texture that stands by itself, for others to refer to.
    Declared,
    /// A mesh.
    Mesh(Arc<Mesh>),
    /// A shape that has no attributes.
    Other,
}

impl Wearer {
    /// Tells apart what materials with attributes are read for.
    pub(super) fn key(&self) -> usize {
        match self {
            Self::Nobody | Self::Declared => 0,
            Self::Other => 1,
            Self::Mesh(mesh) => Arc::as_ptr(mesh).addr(),
        }
    }
}

/// An attribute of the mesh that wears it, in `range`.
pub(super) fn texture(context: &mut Context, of: &Properties, range: Range, user: &Place) -> Result<Texture> {
    let name = of.required_text("name")?;
    let scale = of.float("scale")?.unwrap_or(1.0) as f32;
    if !["vertex_", "face_"].iter().any(|kind| name.starts_with(kind)) {
        return Err(of.error("name", format!("is \"{name}\""), "write one that begins with vertex_ or face_, such as vertex_color"));
    }
    context.attributes_asked = true;
    let mesh = match &context.wearer {
        Wearer::Mesh(mesh) => mesh.clone(),
        // Nothing will wear what is read now.
        Wearer::Declared => return Ok(Texture::Constant(Spectrum::splat(0.5))),
        Wearer::Nobody => return Err(Error::at(of.place(), "a mesh_attribute stands outside of a material", "write <rgb> or <float>")),
        Wearer::Other => {
            return Err(Error::at(
                of.place(),
                "a mesh_attribute is worn by a shape without attributes",
                "use it on a ply or serialized mesh",
            ));
        }
    };
    let Some(index) = mesh.attributes.iter().position(|attribute| attribute.name == name) else {
        let known: Vec<&str> = mesh.attributes.iter().map(|attribute| attribute.name.as_str()).collect();
        let remedy = format!("{}its mesh has {}", did_you_mean(name, &known), list(&known));
        return Err(of.error("name", format!("is \"{name}\", which a mesh that wears it does not have"), remedy));
    };
    let values = mesh.attributes[index].values.iter().map(|value| Spectrum(*value) * scale);
    if let Some((at, value)) = values.enumerate().find(|(_, value)| !range.holds(value)) {
        let thing = format!("{name} times {scale} is out of range, first {:?} at {at} (counted from 0)", value.0);
        return Err(Error::at(user, thing, format!("{}; \"scale\" of the texture multiplies it", range.remedy())));
    }
    Ok(Texture::Attribute { mesh, index, scale })
}

#[cfg(test)]
mod tests {
    use crate::{
        load::{Loaded, load},
        plugin::Library,
        scene::description::{Material, Texture},
    };

    const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float r\n\
                       property float g\nproperty float b\nelement face 1\nproperty list uchar int vertex_index\nproperty uchar heat_x\nend_header\n\
                       0 0 0 1 0 0\n1 0 0 0 1 0\n0 1 0 0 0 1\n3 0 1 2 200\n";

    fn read(scene: &str) -> crate::error::Result<Loaded> {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("a.ply"), PLY).unwrap();
        std::fs::write(folder.path().join("b.ply"), PLY).unwrap();
        let path = folder.path().join("scene.xml");
        std::fs::write(&path, format!("<scene version=\"3.0.0\"><sensor type=\"perspective\"/>{scene}</scene>")).unwrap();
        load(&path, &[], &Library::default())
    }

    fn paint(attribute: &str, scale: f64) -> String {
        format!(
            "<bsdf type=\"twosided\" id=\"paint\"><bsdf type=\"diffuse\"><texture type=\"mesh_attribute\" name=\"reflectance\">\
             <string name=\"name\" value=\"{attribute}\"/><float name=\"scale\" value=\"{scale}\"/></texture></bsdf></bsdf>"
        )
    }

    fn mesh(file: &str, material: &str) -> String {
        format!("<shape type=\"ply\"><string name=\"filename\" value=\"{file}.ply\"/>{material}</shape>")
    }

    #[test]
    fn a_material_is_read_once_for_each_mesh_that_wears_it() {
        let worn = "<ref id=\"paint\"/>";
        let scene = [paint("vertex_color", 0.5), mesh("a", worn), mesh("b", worn), mesh("a", worn)].concat();
        let scene = read(&scene).unwrap().description;
        let worn: Vec<_> = scene.shapes.iter().map(|shape| shape.material).collect();
        assert!(worn[0] == worn[2] && worn[0] != worn[1], "{worn:?}");
        let Material::TwoSided { sides } = &scene.materials[worn[0].0 as usize] else { panic!("not twosided") };
        let Material::Diffuse { reflectance } = &scene.materials[sides[0].0 as usize] else { panic!("not diffuse") };
        let Texture::Attribute { mesh, index, scale } = reflectance else { panic!("not an attribute") };
        assert_eq!((mesh.attributes[*index].values[1], *scale), ([0.0, 1.0, 0.0], 0.5));
    }

    #[test]
    fn what_the_mesh_does_not_have_or_the_parameter_does_not_take_is_told() {
        let bare = paint("vertex_color", 1.0);
        for (scene, thing) in [
            (
                mesh("a", &paint("vertex_colour", 1.0)),
                "does not have; did you mean \"vertex_color\"? its mesh has vertex_color and face_heat",
            ),
            (mesh("a", &paint("colour", 1.0)), "is \"colour\"; write one that begins with vertex_ or face_"),
            (mesh("a", &paint("face_heat", 1.0)), "face_heat times 1 is out of range, first [200.0, 200.0, 200.0] at 0"),
            (format!("<shape type=\"sphere\">{bare}</shape>"), "worn by a shape without attributes; use it on a ply"),
            (paint("", 1.0), "is \"\"; write one"),
        ] {
            let error = read(&scene).unwrap_err().to_string();
            assert!(error.contains(thing), "{error}");
        }
        assert!(read(&mesh("a", &paint("face_heat", 0.004))).is_ok());
    }

    #[test]
    fn only_materials_have_attributes() {
        let texture = "<texture type=\"mesh_attribute\" id=\"t\"><string name=\"name\" value=\"vertex_color\"/></texture>";
        assert!(read(texture).is_ok());
        let light = "<emitter type=\"area\"><ref id=\"t\" name=\"radiance\"/></emitter>";
        assert!(read(&format!("{texture}{}", mesh("a", light))).is_err());
    }
}
