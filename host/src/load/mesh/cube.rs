//! The cube from −1 to 1.

use crate::scene::description::Mesh;

/// For each side: its normal, and its corners counter-clockwise from outside, so that uv runs (0,1) (1,1) (1,0) (0,0) as Mitsuba's does.
const SIDES: [([f32; 3], [[f32; 3]; 4]); 6] = [
    ([0.0, -1.0, 0.0], [[1.0, -1.0, -1.0], [1.0, -1.0, 1.0], [-1.0, -1.0, 1.0], [-1.0, -1.0, -1.0]]),
    ([0.0, 1.0, 0.0], [[1.0, 1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, 1.0, 1.0], [1.0, 1.0, 1.0]]),
    ([1.0, 0.0, 0.0], [[1.0, -1.0, -1.0], [1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [1.0, -1.0, 1.0]]),
    ([0.0, 0.0, 1.0], [[1.0, -1.0, 1.0], [1.0, 1.0, 1.0], [-1.0, 1.0, 1.0], [-1.0, -1.0, 1.0]]),
    ([-1.0, 0.0, 0.0], [[-1.0, -1.0, 1.0], [-1.0, 1.0, 1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, -1.0]]),
    ([0.0, 0.0, -1.0], [[1.0, 1.0, -1.0], [1.0, -1.0, -1.0], [-1.0, -1.0, -1.0], [-1.0, 1.0, -1.0]]),
];

/// Twelve triangles, four vertices to a side.
pub(super) fn mesh() -> Mesh {
    let corner = |side: u32, corners: [u32; 3]| corners.map(|c| 4 * side + c);
    Mesh {
        positions: SIDES.iter().flat_map(|(_, corners)| *corners).collect(),
        normals: SIDES.iter().flat_map(|(normal, _)| [*normal; 4]).collect(),
        uvs: SIDES.iter().flat_map(|_| [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]]).collect(),
        triangles: (0..6).flat_map(|side| [corner(side, [0, 1, 2]), corner(side, [3, 0, 2])]).collect(),
        attributes: Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    #[test]
    fn every_triangle_turns_the_way_of_its_normal() {
        let mesh = mesh();
        for triangle in &mesh.triangles {
            let [a, b, c] = triangle.map(|v| Vec3::from_array(mesh.positions[v as usize]));
            let normal = Vec3::from_array(mesh.normals[triangle[0] as usize]);
            assert_eq!((b - a).cross(c - a), normal * 4.0);
        }
    }
}
