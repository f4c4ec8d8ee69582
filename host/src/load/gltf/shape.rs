//! Meshes where nodes put them: shapes, groups and their instances.

use std::{collections::HashMap, sync::Arc};

use ::gltf::json::{Accessor, Index, Mesh as Source};
use glam::{DAffine3, DVec3};
use serde::Deserialize;

use super::{
    Reader,
    asset::DAMAGED,
    material::Laid,
    mesh::by_handedness,
    node::{Placed, placed, turn},
};
use crate::{
    error::Result,
    load::transform,
    scene::description::{Geometry, Group, GroupId, Instance, MaterialId, Mesh, Shape, ShapeLight},
};

/// The most places of all meshes together: one list of them may be named by many nodes.
const MAX_PLACES: usize = 1 << 24;

/// `EXT_mesh_gpu_instancing`
#[derive(Deserialize)]
struct Instancing {
    attributes: HashMap<String, Index<Accessor>>,
}

/// What a primitive becomes.
#[derive(Clone)]
struct Part {
    mesh: Arc<Mesh>,
    material: MaterialId,
    light: Option<ShapeLight>,
    name: String,
}

/// Everything with a surface.
#[derive(Default)]
pub(super) struct Shapes {
    pub(super) shapes: Vec<Shape>,
    pub(super) groups: Vec<Arc<Group>>,
    pub(super) instances: Vec<Instance>,
    /// The corners of the box about all of it.
    pub(super) bounds: Option<[DVec3; 2]>,
}

impl Reader<'_> {
    /// The shapes of a scene. A mesh that stands in several places is kept once, but for what shines of it.
    pub(super) fn shapes(&mut self, nodes: &[Placed]) -> Result<Shapes> {
        let mut places: Vec<Vec<DAffine3>> = vec![Vec::new(); self.asset.root.meshes.len()];
        let (mut order, mut count) = (Vec::new(), 0);
        for placed in nodes {
            let Some(mesh) = placed.node.mesh.map(|mesh| mesh.value()) else { continue };
            if placed.node.skin.is_some() {
                self.leave_out("skins");
            }
            let Some(of_mesh) = places.get_mut(mesh) else { return Err(self.asset.missing(&format!("mesh {mesh}"))) };
            if of_mesh.is_empty() {
                order.push(mesh);
            }
            let instances = self.instances(placed)?;
            count += instances.len();
            if count > MAX_PLACES {
                return Err(self.asset.error("its meshes stand in more than 2^24 places", "split the model"));
            }
            for to_world in instances {
                if !transform::is_invertible(&to_world) {
                    self.leave_out("what a scale of 0 flattens");
                } else {
                    of_mesh.push(to_world);
                }
            }
        }
        let mut all = Shapes::default();
        for mesh in order {
            let places = std::mem::take(&mut places[mesh]);
            if !places.is_empty() {
                let parts = self.parts(mesh)?;
                self.put(&parts, &places, &mut all);
            }
        }
        Ok(all)
    }

    fn put(&self, parts: &[Part], places: &[DAffine3], all: &mut Shapes) {
        let place = self.asset.place();
        let shape = |part: &Part, to_world: DAffine3| Shape {
            geometry: Geometry::Mesh { mesh: part.mesh.clone(), to_world, flip_normals: false },
            material: part.material,
            light: part.light.clone(),
            name: part.name.clone(),
            place: place.clone(),
        };
        for (part, to_world) in parts.iter().flat_map(|part| places.iter().map(move |to_world| (part, to_world))) {
            all.widen(&part.mesh, to_world);
        }
        let alone = places.len() == 1;
        let (shown, kept): (Vec<_>, Vec<_>) = parts.iter().partition(|part| alone || part.light.is_some());
        all.shapes.extend(places.iter().flat_map(|to_world| shown.iter().map(|part| shape(part, *to_world))));
        if !kept.is_empty() {
            let group = GroupId(all.groups.len() as u32);
            let shapes = kept.iter().map(|part| shape(part, DAffine3::IDENTITY)).collect();
            all.groups.push(Arc::new(Group { shapes, instances: Vec::new(), place: place.clone() }));
            all.instances.extend(places.iter().map(|to_world| Instance { group, to_world: *to_world, place: place.clone() }));
        }
    }

    /// Where a node puts its mesh: in one place, or where EXT_mesh_gpu_instancing says.
    fn instances(&self, at: &Placed) -> Result<Vec<DAffine3>> {
        let asset = self.asset;
        let others = at.node.extensions.as_ref().map(|all| &all.others);
        let Some(Instancing { attributes }) = asset.extension(others, "EXT_mesh_gpu_instancing", &at.label())? else {
            return Ok(vec![at.to_world]);
        };
        let vectors = |name: &str| attributes.get(name).map(|index| asset.floats::<3>(*index, name)).transpose();
        let (translations, scales) = (vectors("TRANSLATION")?, vectors("SCALE")?);
        let rotations = attributes.get("ROTATION").map(|index| asset.floats::<4>(*index, "ROTATION")).transpose()?;
        let counts = [translations.as_ref().map(Vec::len), rotations.as_ref().map(Vec::len), scales.as_ref().map(Vec::len)];
        let count = counts.into_iter().flatten().max().unwrap_or(0);
        let fail = |thing: &str| asset.error(format!("EXT_mesh_gpu_instancing of {} {thing}", at.label()), DAMAGED);
        if counts.into_iter().flatten().any(|other| other != count) {
            return Err(fail("has attributes of different lengths"));
        }
        let vector =
            |of: &Option<Vec<[f32; 3]>>, i: usize, otherwise| of.as_ref().map_or(otherwise, |of| DVec3::from_array(of[i].map(f64::from)));
        let mut all = Vec::with_capacity(count);
        for i in 0..count {
            let rotation = rotations.as_ref().map_or([0.0, 0.0, 0.0, 1.0], |of| of[i]);
            let rotation = turn(rotation).ok_or_else(|| fail("has a rotation that is none"))?;
            let to_world = at.to_world * placed(vector(&translations, i, DVec3::ZERO), rotation, vector(&scales, i, DVec3::ONE));
            if !to_world.to_cols_array().iter().all(|v| v.abs() <= 1e30) {
                return Err(fail("puts something nowhere: its numbers are not finite or beyond 1e30"));
            }
            all.push(to_world);
        }
        Ok(all)
    }

    /// The primitives of a mesh. Where normals are mapped, one whose coordinates are partly seen in a mirror becomes two.
    fn parts(&mut self, mesh: usize) -> Result<Vec<Part>> {
        let index: Index<Source> = Index::new(mesh as u32);
        let asset = self.asset;
        let Some(source) = asset.root.get(index) else { return Err(asset.missing(&format!("mesh {mesh}"))) };
        let mut parts = Vec::new();
        for (number, primitive) in source.primitives.iter().enumerate() {
            let name = self.primitive_label(index, source, number);
            let surface = self.surface(primitive.material, Laid::Straight)?;
            let Some(mesh) = self.triangles(primitive, &surface, &name)? else { continue };
            let mut part = |mesh: Mesh, material| {
                if !mesh.triangles.is_empty() {
                    parts.push(Part { mesh: Arc::new(mesh), material, light: surface.light.clone(), name: name.clone() });
                }
            };
            if !surface.has_normals {
                part(mesh, surface.material);
                continue;
            }
            let [straight, mirrored] = by_handedness(&mesh);
            let other =
                if mirrored.triangles.is_empty() { surface.material } else { self.surface(primitive.material, Laid::Mirrored)?.material };
            part(straight, surface.material);
            part(mirrored, other);
        }
        Ok(parts)
    }
}

impl Shapes {
    fn widen(&mut self, mesh: &Mesh, to_world: &DAffine3) {
        let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for position in &mesh.positions {
            let position = DVec3::from_array(position.map(f64::from));
            (min, max) = (min.min(position), max.max(position));
        }
        for corner in 0..8 {
            let pick = |axis: usize| if corner >> axis & 1 == 0 { min[axis] } else { max[axis] };
            let corner = to_world.transform_point3(DVec3::new(pick(0), pick(1), pick(2)));
            let [low, high] = self.bounds.unwrap_or([corner; 2]);
            self.bounds = Some([low.min(corner), high.max(corner)]);
        }
    }
}
