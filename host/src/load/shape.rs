//! `<shape>`: form, surface and light.

use glam::{DAffine3, DMat3, DVec3};

use super::{attribute::Wearer, bsdf, catalog, context::Context, emitter, mesh, properties::Properties, transform, xml::Element};
use crate::{
    error::{Error, Result},
    scene::description::{Geometry, Shape},
};

/// Whether a shape may shine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Light {
    Allowed,
    Refused,
}

/// What a group holds cannot shine.
pub(super) fn no_light(emitter: &Element) -> Error {
    Error::at(&emitter.place, "an emitter stands inside a group or an instance", "take it out, or put its shape beside the group")
}

/// The shape that an element describes.
pub(super) fn shape(context: &mut Context, element: &Element, light: Light) -> Result<Shape> {
    let of = Properties::read(element, &context.ids)?;
    catalog::check("shape", of.kind(), &element.place)?;
    let geometry = geometry(context, &of)?;
    of.pass_over(&["silhouette_sampling_weight"]);
    for (tag, name) in [("medium", "interior"), ("medium", "exterior"), ("subsurface", "subsurface")] {
        let nested = of.objects(tag);
        if let Some(medium) = nested.first() {
            return Err(Error::at(&medium.place, format!("{name} media are not supported"), "take the medium out"));
        }
    }
    let bsdf = of.object("bsdf")?;
    let light = match of.object("emitter")? {
        Some(emitter) if light == Light::Refused => return Err(no_light(emitter)),
        Some(light) => Some(emitter::area(context, light, &element.place)?),
        None => None,
    };
    let material = match bsdf {
        Some(bsdf) => {
            context.wearer = match &geometry {
                Geometry::Mesh { mesh, .. } => Wearer::Mesh(mesh.clone()),
                _ => Wearer::Other,
            };
            let material = bsdf::material(context, bsdf)?;
            context.wearer = Wearer::Nobody;
            material
        }
        None => bsdf::default(context, light.is_some()),
    };
    of.finish()?;
    let name = element.attribute("id").or(element.attribute("type")).unwrap_or("shape").to_owned();
    Ok(Shape { geometry, material, light, name, place: element.place.clone() })
}

fn geometry(context: &mut Context, of: &Properties) -> Result<Geometry> {
    let to_world = of.transform("to_world")?;
    let flip_normals = of.boolean("flip_normals")?.unwrap_or(false);
    if !transform::is_invertible(&to_world) {
        return Err(of.error("to_world", "flattens the shape", "scale every axis by something other than 0"));
    }
    Ok(match of.kind() {
        "rectangle" => Geometry::Rectangle { to_world, flip_normals },
        "disk" => Geometry::Disk { to_world, flip_normals },
        "sphere" => {
            let center = of.vector("center")?.unwrap_or(DVec3::ZERO);
            let radius = of.positive("radius")?.unwrap_or(1.0);
            if !transform::is_similar(&to_world) {
                return Err(of.error("to_world", "makes the sphere an ellipsoid", "scale all axes alike, or use a mesh"));
            }
            Geometry::Sphere { center, radius, to_world, flip_normals }
        }
        "cylinder" => {
            let p0 = of.vector("p0")?.unwrap_or(DVec3::ZERO);
            let p1 = of.vector("p1")?.unwrap_or(DVec3::Z);
            let radius = of.positive("radius")?.unwrap_or(1.0);
            let Some(axis) = (p1 - p0).try_normalize() else {
                return Err(of.error("p1", "is p0", "put the ends of the cylinder apart"));
            };
            if !stays_round(axis, &to_world) {
                return Err(of.error("to_world", "squashes or skews the cylinder", "scale the axes across it alike, or use a mesh"));
            }
            Geometry::Cylinder { p0, p1, radius, to_world, flip_normals }
        }
        _ => Geometry::Mesh { mesh: mesh::mesh(context, of)?, to_world, flip_normals },
    })
}

/// Whether a circle about `axis` is still one about where the axis goes.
fn stays_round(axis: DVec3, to_world: &DAffine3) -> bool {
    let (a, b) = axis.any_orthonormal_pair();
    let moved = to_world.matrix3 * DMat3::from_cols(a, b, axis);
    // With the axis brought to the others' length, only turning, mirroring and even scaling may be left.
    let Some(along) = moved.z_axis.try_normalize() else { return false };
    let even = DMat3::from_cols(moved.x_axis, moved.y_axis, along * moved.x_axis.length());
    transform::is_similar(&DAffine3::from_mat3(even))
}
