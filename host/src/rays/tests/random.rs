//! Random rays and meshes, from a fixed seed.

use bidir_kernel::{Ray, Segment, Vec3};

use crate::rays::{Bvh, Primitives, Visibility};

pub use super::generator::Random;

/// A ray without an end.
pub fn ray(origin: Vec3, direction: Vec3) -> Ray {
    Ray { origin, direction, t_max: f32::INFINITY, segment: Segment::Inner }
}

/// The segment between two points.
pub fn segment(from: Vec3, to: Vec3) -> Ray {
    Ray { origin: from, direction: to - from, t_max: 1.0, segment: Segment::Inner }
}

/// A closed sphere of triangles; the corners and which three make a face.
pub fn sphere_mesh(centre: Vec3, radius: f32, rings: u32) -> (Vec<Vec3>, Vec<[usize; 3]>) {
    let sectors = 2 * rings;
    let mut corners = vec![centre + Vec3::Y * radius];
    for ring in 1..rings {
        let (sin, cos) = (std::f32::consts::PI * ring as f32 / rings as f32).sin_cos();
        for sector in 0..sectors {
            let (s, c) = (std::f32::consts::TAU * sector as f32 / sectors as f32).sin_cos();
            corners.push(centre + Vec3::new(sin * c, cos, sin * s) * radius);
        }
    }
    corners.push(centre - Vec3::Y * radius);
    let last = corners.len() - 1;
    let at = |ring: u32, sector: u32| 1 + ((ring - 1) * sectors + sector % sectors) as usize;
    let mut faces = vec![];
    for sector in 0..sectors {
        faces.push([0, at(1, sector + 1), at(1, sector)]);
        faces.push([last, at(rings - 1, sector), at(rings - 1, sector + 1)]);
        for ring in 1..rings - 1 {
            let (a, b, c, d) = (at(ring, sector), at(ring, sector + 1), at(ring + 1, sector), at(ring + 1, sector + 1));
            faces.push([a, b, d]);
            faces.push([a, d, c]);
        }
    }
    (corners, faces)
}

/// The tree of a mesh.
pub fn tree(corners: &[Vec3], faces: &[[usize; 3]]) -> Bvh {
    let mut primitives = Primitives::new();
    for face in faces {
        primitives.triangle(face.map(|corner| corners[corner]), Visibility::Everywhere);
    }
    Bvh::build(primitives)
}
