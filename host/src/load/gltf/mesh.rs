//! Primitives of meshes: triangles with their normals and coordinates.

use ::gltf::json::{
    Index, Mesh as Source,
    mesh::{Mode, Primitive, Semantic},
    validation::Checked,
};

use super::{Reader, asset::DAMAGED, material::Surface};
use crate::{error::Result, load::mesh::check, scene::description::Mesh};

/// The most triangles and vertices of all meshes together: what a tree holds.
const MAX_ELEMENTS: usize = 1 << 28;

impl Reader<'_> {
    /// The triangles of a primitive; `None` if it has none to see.
    pub(super) fn triangles(&mut self, primitive: &Primitive, surface: &Surface, name: &str) -> Result<Option<Mesh>> {
        let asset = self.asset;
        let attribute = |semantic| primitive.attributes.get(&Checked::Valid(semantic)).copied();
        let Checked::Valid(mode) = primitive.mode else {
            return Err(asset.error(format!("{name} has a mode that is none of glTF's"), DAMAGED));
        };
        if matches!(mode, Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip) {
            self.leave_out("points and lines");
            return Ok(None);
        }
        let Some(positions) = attribute(Semantic::Positions) else {
            self.leave_out("primitives without POSITION");
            return Ok(None);
        };
        if attribute(Semantic::Colors(0)).is_some() {
            self.leave_out("vertex colours (COLOR_0)");
        }
        if primitive.targets.as_ref().is_some_and(|targets| !targets.is_empty()) {
            self.leave_out("morph targets");
        }
        let positions = asset.floats::<3>(positions, "positions")?;
        let corners = match primitive.indices {
            Some(indices) => asset.whole(indices, "indices")?,
            None => (0..positions.len() as u32).collect(),
        };
        self.elements = self.elements.saturating_add(positions.len()).saturating_add(corners.len());
        if self.elements > MAX_ELEMENTS {
            return Err(asset.error("its meshes have more than 2^28 vertices and corners", "split the model"));
        }
        let normals = attribute(Semantic::Normals).map(|index| asset.floats::<3>(index, "normals")).transpose()?.unwrap_or_default();
        // Kept without textures too, as from any mesh: what shines follows u.
        let uvs = match (attribute(Semantic::TexCoords(surface.uv_set.unwrap_or(0))), surface.uv_set) {
            (Some(index), _) => asset.floats::<2>(index, "texture coordinates")?,
            (None, Some(set)) => {
                self.warn(format_args!("{name} has textures and no TEXCOORD_{set}; it is taken as 0, 0 everywhere"));
                vec![[0.0; 2]; positions.len()]
            }
            (None, None) => Vec::new(),
        };
        for (what, count) in [("normals", normals.len()), ("texture coordinates", uvs.len())] {
            if count != 0 && count != positions.len() {
                return Err(asset.error(format!("{name} has {} positions and {count} {what}", positions.len()), DAMAGED));
            }
        }
        let triangles = assembled(&corners, mode);
        if triangles.is_empty() {
            self.leave_out("primitives without triangles");
            return Ok(None);
        }
        let mut mesh = Mesh { positions, normals, uvs, triangles, ..Mesh::default() };
        let dropped = check(&mut mesh, &asset.path).map_err(|e| asset.error(format!("{name}: {}", e.thing), e.remedy))?;
        if dropped > 0 {
            self.warn(format_args!("dropped {dropped} triangles of {name}: without area, or with a corner that is no point"));
        }
        Ok(Some(compact(mesh)))
    }

    /// What messages call a primitive.
    pub(super) fn primitive_label(&self, mesh: Index<Source>, source: &Source, primitive: usize) -> String {
        let mesh = super::asset::label("mesh", mesh.value(), source.name.as_ref());
        if source.primitives.len() == 1 { mesh } else { format!("{mesh}, primitive {primitive}") }
    }
}

/// Corners put together to triangles, all turning the same way (glTF 2.0, §3.7.2.1).
fn assembled(corners: &[u32], mode: Mode) -> Vec<[u32; 3]> {
    match mode {
        Mode::TriangleStrip => {
            let turned = |(at, c): (usize, &[u32])| if at % 2 == 0 { [c[0], c[1], c[2]] } else { [c[0], c[2], c[1]] };
            corners.windows(3).enumerate().map(turned).collect()
        }
        Mode::TriangleFan => corners.get(1..).unwrap_or_default().windows(2).map(|c| [c[0], c[1], corners[0]]).collect(),
        _ => corners.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
    }
}

/// Without the vertices that no triangle names: primitives often share one long list of them.
fn compact(mesh: Mesh) -> Mesh {
    let mut places = vec![u32::MAX; mesh.positions.len()];
    for &vertex in mesh.triangles.iter().flatten() {
        places[vertex as usize] = 0;
    }
    let kept: Vec<usize> = (0..places.len()).filter(|&vertex| places[vertex] == 0).collect();
    if kept.len() == places.len() {
        return mesh;
    }
    for (place, &vertex) in kept.iter().enumerate() {
        places[vertex] = place as u32;
    }
    Mesh {
        positions: picked(&mesh.positions, &kept),
        normals: picked(&mesh.normals, &kept),
        uvs: picked(&mesh.uvs, &kept),
        triangles: mesh.triangles.iter().map(|corners| corners.map(|vertex| places[vertex as usize])).collect(),
        ..Mesh::default()
    }
}

fn picked<T: Copy>(values: &[T], kept: &[usize]) -> Vec<T> {
    if values.is_empty() { Vec::new() } else { kept.iter().map(|&vertex| values[vertex]).collect() }
}

/// Triangles whose coordinates lie as an image does that is seen from outside, and those where it is seen in a mirror.
pub(super) fn by_handedness(mesh: &Mesh) -> [Mesh; 2] {
    let mirrored = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|vertex| mesh.uvs.get(vertex as usize).map_or([0.0; 2], |uv| uv.map(f64::from)));
        // v points down.
        (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]) > 0.0
    };
    let (turned, straight): (Vec<_>, Vec<_>) = mesh.triangles.iter().copied().partition(mirrored);
    [straight, turned].map(|triangles| match triangles.len() {
        0 => Mesh::default(),
        all if all == mesh.triangles.len() => mesh.clone(),
        _ => compact(Mesh { triangles, ..mesh.clone() }),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_and_fans_turn_as_their_first_triangle_does() {
        assert_eq!(assembled(&[0, 1, 2, 3, 4], Mode::TriangleStrip), [[0, 1, 2], [1, 3, 2], [2, 3, 4]]);
        assert_eq!(assembled(&[0, 1, 2, 3], Mode::TriangleFan), [[1, 2, 0], [2, 3, 0]]);
        assert_eq!(assembled(&[0, 1, 2, 3], Mode::Triangles), [[0, 1, 2]]);
        assert!(assembled(&[0, 1], Mode::TriangleStrip).is_empty() && assembled(&[], Mode::TriangleFan).is_empty());
    }

    #[test]
    fn what_no_triangle_names_is_not_kept() {
        let positions = vec![[0.0; 3], [9.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let uvs = vec![[0.0; 2], [9.0; 2], [1.0, 0.0], [0.0, 1.0]];
        let mesh = compact(Mesh { positions, uvs, triangles: vec![[0, 2, 3]], ..Mesh::default() });
        assert_eq!((mesh.positions.len(), mesh.triangles[0], mesh.uvs[1]), (3, [0, 1, 2], [1.0, 0.0]));
    }
}
