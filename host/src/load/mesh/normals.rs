//! Normals for meshes that come without.

use glam::DVec3;

use crate::scene::description::Mesh;

fn corner(positions: &[[f32; 3]], vertex: u32) -> DVec3 {
    DVec3::from_array(positions[vertex as usize].map(f64::from))
}

/// Twice a triangle's area.
pub(super) fn doubled_area(positions: &[[f32; 3]], [a, b, c]: [u32; 3]) -> f64 {
    let [a, b, c] = [a, b, c].map(|v| corner(positions, v));
    (b - a).cross(c - a).length()
}

/// One normal per vertex: the triangles' own, weighted by their angles there (Thürmer & Wüthrich 1998).
pub(super) fn smooth(mesh: &Mesh) -> Vec<[f32; 3]> {
    let mut sums = vec![DVec3::ZERO; mesh.positions.len()];
    for triangle in &mesh.triangles {
        let p = triangle.map(|v| corner(&mesh.positions, v));
        let Some(normal) = (p[1] - p[0]).cross(p[2] - p[0]).try_normalize() else { continue };
        for i in 0..3 {
            let (a, b) = ((p[(i + 1) % 3] - p[i]).normalize_or_zero(), (p[(i + 2) % 3] - p[i]).normalize_or_zero());
            // Twice the arctangent of half the angle: exact near 0 and π, where the arccosine is not.
            sums[triangle[i] as usize] += normal * (2.0 * libm::atan2((a - b).length(), (a + b).length()));
        }
    }
    sums.into_iter().map(|sum| sum.normalize_or_zero().as_vec3().to_array()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_vertex_leans_by_angle_and_not_by_area() {
        // Two walls meet at the z axis at right angles; one is nine times as large.
        let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 9.0, 0.0]];
        let mesh = Mesh { positions, triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() };
        let normal = smooth(&mesh)[0];
        assert!((normal[0] - normal[1]).abs() < 1e-6, "{normal:?}");
    }
}
