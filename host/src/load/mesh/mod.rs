//! Meshes: from files, and the cube.

mod cube;
mod normals;
mod obj;
mod ply;

use std::{path::Path, sync::Arc};

use super::{context::Context, properties::Properties, texture::named_here};
use crate::{
    error::{Error, Result},
    scene::description::Mesh,
};

/// The largest mesh file, in bytes.
const MAX_BYTES: u64 = 4 << 30;

/// How a mesh is written.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Format {
    /// Wavefront OBJ.
    Obj,
    /// Stanford PLY, ascii or binary.
    Ply,
}

/// A mesh out of a file.
#[derive(Clone, Debug)]
pub struct Parsed {
    /// As the file has it: finite, every index in range, every triangle with an area.
    pub mesh: Mesh,
    /// How many triangles without area were left out.
    pub dropped: usize,
}

/// Reads a mesh that is in memory already; messages call it `name`.
///
/// # Errors
/// If it is not in that format, or is no mesh of finite numbers with an area.
pub fn parse(bytes: &[u8], format: Format, name: &Path) -> Result<Parsed> {
    let mut mesh = match format {
        Format::Obj => obj::read(bytes, name)?,
        Format::Ply => ply::read(bytes, name)?,
    };
    let dropped = check(&mut mesh, name)?;
    Ok(Parsed { mesh, dropped })
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

/// The mesh of a shape of type `cube`, `obj` or `ply`.
pub(super) fn mesh(context: &mut Context, of: &Properties) -> Result<Arc<Mesh>> {
    let facets = if of.boolean("face_normals")?.unwrap_or(false) { Facets::Flat } else { Facets::Smooth };
    if of.kind() == "cube" {
        return Ok(Arc::new(finish(cube::mesh(), facets)));
    }
    let format = if of.kind() == "obj" { Format::Obj } else { Format::Ply };
    // Mitsuba's defaults: an OBJ's v points up and its images' v points down, so one is turned.
    let flip = of.boolean("flip_tex_coords")?.unwrap_or(format == Format::Obj);
    let flip = if flip { FlipV::Yes } else { FlipV::No };
    let path = context.file(of.required_text("filename")?, of.place_of("filename"))?;
    let key = format!("{format:?} {} {facets:?} {flip:?}", path.display());
    if let Some(known) = context.meshes.get(&key) {
        return Ok(known.clone());
    }
    let here = |error: Error| named_here(&error, of.place_of("filename"));
    let bytes = bytes(&path).map_err(here)?;
    let Parsed { mut mesh, dropped } = parse(&bytes, format, &path).map_err(here)?;
    if flip == FlipV::Yes {
        mesh.uvs.iter_mut().for_each(|uv| uv[1] = 1.0 - uv[1]);
    }
    if dropped > 0 {
        let file = path.file_name().unwrap_or_default().to_string_lossy();
        context.warn(of.place(), format_args!("dropped {dropped} triangles without area from {file}"));
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

/// Refuses what is not finite or names vertices that are not there; drops triangles without area and says how many.
fn check(mesh: &mut Mesh, path: &Path) -> Result<usize> {
    let remedy = "mend the mesh, or export it again";
    let not_finite = |what: &str, at: usize| Error::in_file(path, format!("{what} of vertex {at} (counted from 0) is not finite"), remedy);
    // The bound keeps squares of differences within f64 and differences within f32.
    if let Some(at) = mesh.positions.iter().position(|p| p.iter().any(|v| v.is_nan() || v.abs() > 1e30)) {
        return Err(not_finite("the position", at));
    }
    if let Some(at) = mesh.normals.iter().position(|n| n.iter().any(|v| !v.is_finite())) {
        return Err(not_finite("the normal", at));
    }
    if let Some(at) = mesh.uvs.iter().position(|uv| uv.iter().any(|v| !v.is_finite())) {
        return Err(not_finite("the texture coordinate", at));
    }
    let count = mesh.positions.len();
    if let Some(at) = mesh.triangles.iter().position(|t| t.iter().any(|&v| v as usize >= count)) {
        let thing = format!("triangle {at} (counted from 0) names vertices {:?}, but there are only {count}", mesh.triangles[at]);
        return Err(Error::in_file(path, thing, remedy));
    }
    let before = mesh.triangles.len();
    let positions = &mesh.positions;
    mesh.triangles.retain(|&corners| normals::doubled_area(positions, corners) > 0.0);
    if mesh.triangles.is_empty() {
        let thing = if before == 0 { "has no triangles".into() } else { format!("has {before} triangles, none with an area") };
        return Err(Error::in_file(path, thing, "leave the shape out, or export it again"));
    }
    Ok(before - mesh.triangles.len())
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
    fn what_is_not_finite_is_one_error_that_names_the_vertex() {
        for z in [f32::NAN, f32::INFINITY, 1e31] {
            let error = check(&mut triangle(z), Path::new("m.ply")).unwrap_err().to_string();
            assert!(error.starts_with("m.ply: the position of vertex 2"), "{error}");
        }
    }

    #[test]
    fn an_index_out_of_range_is_an_error() {
        let mut mesh = triangle(0.0);
        mesh.triangles.push([0, 1, 4]);
        assert!(check(&mut mesh, Path::new("m.ply")).unwrap_err().to_string().contains("there are only 4"));
    }
}
