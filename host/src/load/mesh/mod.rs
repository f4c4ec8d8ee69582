//! Meshes: from files, and the cube.

mod cube;
mod normals;
mod obj;
mod ply;
mod serialized;

use std::{path::Path, sync::Arc};

use super::{context::Context, properties::Properties, texture::named_here};
use crate::{
    error::{Error, Result},
    scene::description::{Mesh, Per},
};

/// The largest mesh file, in bytes.
const MAX_BYTES: u64 = 4 << 30;

/// How a mesh is written.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Format {
    /// Wavefront OBJ.
    Obj,
    /// Stanford PLY, ascii or binary.
    Ply,
    /// Mitsuba's own, which may hold several meshes.
    Serialized {
        /// Which, from 0.
        index: u32,
    },
}

impl Format {
    /// That of a shape of this type; `index` is which mesh of its file it shows.
    pub(super) fn of(kind: &str, index: u32) -> Option<Self> {
        match kind {
            "obj" => Some(Self::Obj),
            "ply" => Some(Self::Ply),
            "serialized" => Some(Self::Serialized { index }),
            _ => None,
        }
    }
}

/// A mesh out of a file.
#[derive(Clone, Debug)]
pub struct Parsed {
    /// As the file has it: finite, every index in range, every triangle with an area.
    pub mesh: Mesh,
    /// How many triangles were left out: without area, or with a corner that is no point.
    pub dropped: usize,
    /// Whether the file itself says that its triangles are flat.
    pub flat: bool,
}

/// Reads a mesh that is in memory already; messages call it `name`.
///
/// # Errors
/// If it is not in that format, or is no mesh of finite numbers with an area.
pub fn parse(bytes: &[u8], format: Format, name: &Path) -> Result<Parsed> {
    let (mut mesh, facets) = match format {
        Format::Obj => (obj::read(bytes, name)?, Facets::Smooth),
        Format::Ply => (ply::read(bytes, name)?, Facets::Smooth),
        Format::Serialized { index } => serialized::read(bytes, index, name)?,
    };
    let dropped = check(&mut mesh, name)?;
    Ok(Parsed { mesh, dropped, flat: facets == Facets::Flat })
}

/// Reads a mesh's file.
pub(super) fn read(path: &Path, format: Format) -> Result<Parsed> {
    if let Format::Serialized { index } = format
        && let Ok(Some(part)) = serialized::part(path, index)
    {
        return parse(&part, Format::Serialized { index: 0 }, path);
    }
    parse(&bytes(path)?, format, path)
}

/// Whether a mesh's v runs the other way than its file says.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum FlipV {
    Yes,
    No,
}

/// Whether each triangle keeps its own normal.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Facets {
    Flat,
    Smooth,
}

/// The mesh of a shape of type `cube`, `obj`, `ply` or `serialized`.
pub(super) fn mesh(context: &mut Context, of: &Properties) -> Result<Arc<Mesh>> {
    let facets = if of.boolean("face_normals")?.unwrap_or(false) { Facets::Flat } else { Facets::Smooth };
    if of.kind() == "cube" {
        return Ok(Arc::new(finish(cube::mesh(), facets)));
    }
    let index = if of.kind() == "serialized" { of.whole("shape_index", 0)?.unwrap_or(0) as u32 } else { 0 };
    let format = Format::of(of.kind(), index).unwrap_or(Format::Ply);
    // Mitsuba's defaults: an OBJ's v points up and its images' v points down, so one is turned. Its own format's never is.
    let flip = match format {
        Format::Serialized { .. } => false,
        _ => of.boolean("flip_tex_coords")?.unwrap_or(format == Format::Obj),
    };
    let flip = if flip { FlipV::Yes } else { FlipV::No };
    let path = context.file(of.required_text("filename")?, of.place_of("filename"))?;
    let key = format!("{format:?} {} {facets:?} {flip:?}", path.display());
    if let Some(known) = context.meshes.get(&key) {
        return Ok(known.clone());
    }
    let here = |error: Error| named_here(&error, of.place_of("filename"));
    let ready = context.ahead.mesh(path.clone(), format);
    let Parsed { mut mesh, dropped, flat } = ready.map_or_else(|| read(&path, format), Ok).map_err(here)?;
    let facets = if flat { Facets::Flat } else { facets };
    if flip == FlipV::Yes {
        mesh.uvs.iter_mut().for_each(|uv| uv[1] = 1.0 - uv[1]);
    }
    if dropped > 0 {
        let file = path.file_name().unwrap_or_default().to_string_lossy();
        context.warn(of.place(), format_args!("dropped {dropped} triangles from {file}: without area, or with a corner that is no point"));
    }
    let mesh = Arc::new(finish(mesh, facets));
    context.meshes.insert(key, mesh.clone());
    Ok(mesh)
}

fn bytes(path: &Path) -> Result<Vec<u8>> {
    let fail = |thing: String| Error::in_file(path, thing, "name a mesh that can be read");
    let found = std::fs::metadata(path).map_err(|e| fail(format!("cannot be read ({e})")))?;
    if !found.is_file() {
        return Err(fail("is not a file".into()));
    }
    if found.len() > MAX_BYTES {
        return Err(fail(format!("is larger than {} GiB", MAX_BYTES >> 30)));
    }
    std::fs::read(path).map_err(|e| fail(format!("cannot be read ({e})")))
}

/// Refuses vertices that are not there, and normals and coordinates that are not finite where a triangle has them; drops triangles without
/// area, and those with a corner that is no point, and says how many.
pub(super) fn check(mesh: &mut Mesh, path: &Path) -> Result<usize> {
    let remedy = "mend the mesh, or export it again";
    let not_finite = |what: &str, at: usize| Error::in_file(path, format!("{what} of vertex {at} (counted from 0) is not finite"), remedy);
    let count = mesh.positions.len();
    if let Some(at) = mesh.triangles.iter().position(|t| t.iter().any(|&v| v as usize >= count)) {
        let thing = format!("triangle {at} (counted from 0) names vertices {:?}, but there are only {count}", mesh.triangles[at]);
        return Err(Error::in_file(path, thing, remedy));
    }
    let before = mesh.triangles.len();
    let positions = &mesh.positions;
    // The bound keeps squares of differences within f64 and differences within f32.
    let is_point = |v: u32| positions[v as usize].iter().all(|x| x.abs() <= 1e30);
    let keep: Vec<bool> = (mesh.triangles.iter())
        .map(|&corners| corners.into_iter().all(is_point) && normals::doubled_area(positions, corners) > 0.0)
        .collect();
    retain(&mut mesh.triangles, &keep);
    for attribute in mesh.attributes.iter_mut().filter(|attribute| attribute.per == Per::Triangle) {
        retain(&mut attribute.values, &keep);
    }
    let Some(&[first, ..]) = mesh.triangles.first() else {
        let no_point = mesh.positions.iter().position(|position| !position.iter().all(|x| x.abs() <= 1e30));
        let but = no_point.map_or(String::new(), |at| format!("; vertex {at} (counted from 0) is no point"));
        let thing = if before == 0 { "has no triangles".into() } else { format!("has {before} triangles, and none with an area{but}") };
        return Err(Error::in_file(path, thing, "leave the shape out, or export it again"));
    };
    let mut used = vec![false; count];
    mesh.triangles.iter().flatten().for_each(|&v| used[v as usize] = true);
    if let Some(at) = (0..mesh.normals.len()).find(|&v| used[v] && mesh.normals[v].iter().any(|x| !x.is_finite())) {
        return Err(not_finite("the normal", at));
    }
    if let Some(at) = (0..mesh.uvs.len()).find(|&v| used[v] && mesh.uvs[v].iter().any(|x| !x.is_finite())) {
        return Err(not_finite("the texture coordinate", at));
    }
    // What no triangle names has no say in where the mesh lies.
    let first = first as usize;
    fill_unused(&mut mesh.positions, &used, first);
    fill_unused(&mut mesh.normals, &used, first);
    fill_unused(&mut mesh.uvs, &used, first);
    for attribute in mesh.attributes.iter_mut().filter(|attribute| attribute.per == Per::Vertex) {
        fill_unused(&mut attribute.values, &used, first);
    }
    Ok(before - mesh.triangles.len())
}

/// Leaves out what is not to be kept.
fn retain<T>(values: &mut Vec<T>, keep: &[bool]) {
    let mut keep = keep.iter();
    values.retain(|_| keep.next() == Some(&true));
}

/// Gives what no triangle names the value of a vertex that one does.
fn fill_unused<T: Copy>(values: &mut [T], used: &[bool], named: usize) {
    let Some(&value) = values.get(named) else { return };
    values.iter_mut().zip(used).filter(|(_, used)| !**used).for_each(|(unused, _)| *unused = value);
}

/// As Mitsuba has it: a mesh without normals gets smooth ones, and `face_normals` takes them away.
fn finish(mut mesh: Mesh, facets: Facets) -> Mesh {
    match facets {
        Facets::Flat => mesh.normals.clear(),
        Facets::Smooth if mesh.normals.is_empty() => mesh.normals = normals::smooth(&mesh),
        Facets::Smooth => {}
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle(z: f32) -> Mesh {
        let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, z], [2.0, 0.0, 0.0]];
        Mesh { positions, triangles: vec![[0, 1, 2], [0, 1, 3], [1, 1, 2]], ..Mesh::default() }
    }

    #[test]
    fn triangles_without_area_are_dropped_and_counted() {
        let mut mesh = triangle(0.0);
        assert_eq!(check(&mut mesh, Path::new("m.ply")), Ok(2));
        assert_eq!(mesh.triangles, [[0, 1, 2]]);
    }

    #[test]
    fn triangles_with_a_corner_that_is_no_point_are_dropped_and_counted() {
        for z in [f32::NAN, f32::INFINITY, 1e31] {
            let mut mesh = triangle(z);
            mesh.positions.push([0.0, 1.0, 0.0]);
            mesh.triangles.push([0, 1, 4]);
            mesh.normals = vec![[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [z; 3], [f32::NAN; 3], [0.0, 0.0, 1.0]];
            assert_eq!(check(&mut mesh, Path::new("m.ply")), Ok(3));
            assert_eq!(mesh.triangles, [[0, 1, 4]]);
            assert_eq!(mesh.positions[2..4], [[0.0; 3]; 2], "what nothing names lies where something does");
        }
    }

    #[test]
    fn a_normal_that_is_not_finite_is_one_error_that_names_the_vertex() {
        let mut mesh = triangle(0.0);
        mesh.normals = vec![[0.0, 0.0, 1.0], [0.0, f32::NAN, 1.0], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]];
        let error = check(&mut mesh, Path::new("m.ply")).unwrap_err().to_string();
        assert!(error.starts_with("m.ply: the normal of vertex 1"), "{error}");
    }

    #[test]
    fn an_index_out_of_range_is_an_error() {
        let mut mesh = triangle(0.0);
        mesh.triangles.push([0, 1, 4]);
        assert!(check(&mut mesh, Path::new("m.ply")).unwrap_err().to_string().contains("there are only 4"));
    }
}
