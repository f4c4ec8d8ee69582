//! Random rays and meshes, from a fixed seed.

use bidir_kernel::{Ray, Segment, Vec3};

use crate::rays::{Bvh, Primitives, Visibility};

/// The generator of Steele, Lea and Flood 2014 (SplitMix64).
pub struct Random(pub u64);

impl Random {
    /// In 0 … 1.
    pub fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = self.0;
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((x ^ (x >> 31)) >> 40) as f32 * 2.0_f32.powi(-24)
    }

    /// In −1 … 1, thrice.
    pub fn cube(&mut self) -> Vec3 {
        Vec3::new(self.unit(), self.unit(), self.unit()) * 2.0 - 1.0
    }

    /// On the unit sphere.
    pub fn direction(&mut self) -> Vec3 {
        loop {
            let v = self.cube();
            if (0.01..1.0).contains(&v.length_squared()) {
                return v.normalize();
            }
        }
    }
}

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
