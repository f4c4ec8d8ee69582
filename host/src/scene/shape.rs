//! Shapes as rays meet them: from a hit to a point with its frames and surface coordinates.

use std::sync::Arc;

use bidir_kernel::{Frame, Mat3, Point, Real, Vec2, Vec3, math};

use crate::{
    rays::SurfacePoint,
    scene::{description::Mesh, lights::LightId},
};

/// What a scene keeps of a shape.
#[derive(Clone, Debug)]
pub struct Shape {
    /// Its form.
    pub form: Form,
    /// Its surface: an index into the scene's finishes.
    pub finish: u32,
    /// Its light.
    pub light: Option<LightId>,
    /// 1, or −1 where its normals are turned round from what the geometry says.
    pub facing: Real,
    /// Whether anything asks for surface coordinates and tangents.
    pub mapped: bool,
}

/// What is needed to tell normals and coordinates at a hit.
#[derive(Clone, Debug)]
pub enum Form {
    /// Flat; its tangent.
    Parallelogram(Vec3),
    /// Flat; its two half axes.
    Disk(Vec3, Vec3),
    /// Round; its own axes in the world.
    Sphere([Vec3; 3]),
    /// Round; its axis, unit.
    Cylinder(Vec3),
    /// Triangles.
    Mesh(MeshForm),
}

/// A mesh's vertex data and how to bring it into the world.
#[derive(Clone, Debug)]
pub struct MeshForm {
    /// In its own coordinates.
    pub mesh: Arc<Mesh>,
    /// For directions along the surface.
    pub to_world: Mat3,
    /// For normals: the inverse transpose, up to scale.
    pub normal_to_world: Mat3,
}

const TURN: Real = 2.0 * std::f32::consts::PI;

impl Shape {
    /// The point of a hit; `triangle` is the number within a mesh.
    #[inline]
    pub fn point(&self, at: &SurfacePoint, triangle: u32) -> Point {
        let normal = at.normal * self.facing;
        let flat = |normal: Vec3, tangent: Vec3, uv: Vec2| {
            let frame = if self.mapped { Frame::from_z_and_tangent(normal, tangent) } else { Frame::from_z(normal) };
            Point::surface(at.position, normal, frame, uv, at.offset)
        };
        let local = at.local;
        match &self.form {
            Form::Parallelogram(tangent) => flat(normal, *tangent, Vec2::new(local.x, local.y)),
            Form::Mesh(mesh) => mesh.point(at, triangle, self),
            _ if !self.mapped => flat(normal, Vec3::ZERO, Vec2::ZERO),
            Form::Disk(x, y) => {
                let radius = math::sqrt(local.x * local.x + local.y * local.y);
                flat(normal, *x * local.x + *y * local.y, Vec2::new(radius, turn(local.y, local.x)))
            }
            Form::Sphere(axes) => {
                let (uv, tangent) = round_mapping(axes, local);
                flat(normal, tangent, uv)
            }
            Form::Cylinder(axis) => flat(normal, axis.cross(at.normal), Vec2::new(turn(local.y, local.x), local.z)),
        }
    }
}

/// Surface coordinates of a sphere with those axes, and the direction in which u grows, where `out` leads from its centre.
pub fn round_mapping([x, y, z]: &[Vec3; 3], out: Vec3) -> (Vec2, Vec3) {
    let (a, b, c) = (math::dot(out, *x), math::dot(out, *y), math::dot(out, *z));
    (Vec2::new(turn(b, a), math::safe_acos(c) / std::f32::consts::PI), *y * a - *x * b)
}

/// The angle of (x, y) in 0 … 1.
fn turn(y: Real, x: Real) -> Real {
    let turn = math::atan2(y, x) / TURN;
    if turn < 0.0 { turn + 1.0 } else { turn }
}

impl MeshForm {
    fn corners<T: Copy>(&self, data: &[T], triangle: u32) -> Option<[T; 3]> {
        let [a, b, c] = self.mesh.triangles[triangle as usize];
        Some([*data.get(a as usize)?, *data.get(b as usize)?, *data.get(c as usize)?])
    }

    /// −1 where a triangle's winding disagrees with its vertex normals, which decide.
    pub fn facing(&self, triangle: u32, geometric: Vec3) -> Real {
        match self.corners(&self.mesh.normals, triangle) {
            Some([a, b, c]) => {
                let sum = Vec3::from(a) + Vec3::from(b) + Vec3::from(c);
                if math::dot(self.normal_to_world * sum, geometric) < 0.0 { -1.0 } else { 1.0 }
            }
            None => 1.0,
        }
    }

    fn point(&self, at: &SurfacePoint, triangle: u32, shape: &Shape) -> Point {
        let (b1, b2) = (at.local.x, at.local.y);
        let mut geometric = at.normal;
        let mut shading = None;
        if !self.mesh.normals.is_empty() {
            geometric *= self.facing(triangle, geometric);
            shading = self.shading_normal(triangle, b1, b2);
        }
        let shading = shading.unwrap_or(geometric) * shape.facing;
        let geometric = geometric * shape.facing;
        if !shape.mapped {
            return Point::surface(at.position, geometric, Frame::from_z(shading), Vec2::ZERO, at.offset);
        }
        let (uv, tangent) = self.mapping(triangle, b1, b2);
        Point::surface(at.position, geometric, Frame::from_z_and_tangent(shading, tangent), uv, at.offset)
    }

    /// The normal between the vertices' own, unit; `None` without those, or where they cancel.
    pub fn shading_normal(&self, triangle: u32, b1: Real, b2: Real) -> Option<Vec3> {
        let [n0, n1, n2] = self.corners(&self.mesh.normals, triangle)?;
        let mixed = Vec3::from(n0) * (1.0 - b1 - b2) + Vec3::from(n1) * b1 + Vec3::from(n2) * b2;
        math::normalize(self.normal_to_world * mixed)
    }

    /// Surface coordinates, and the direction in which u grows. A mesh without coordinates has its barycentric ones.
    pub fn mapping(&self, triangle: u32, b1: Real, b2: Real) -> (Vec2, Vec3) {
        let Some([p0, p1, p2]) = self.corners(&self.mesh.positions, triangle).map(|corners| corners.map(Vec3::from)) else {
            return (Vec2::ZERO, Vec3::ZERO);
        };
        let (e1, e2) = (p1 - p0, p2 - p0);
        let Some([t0, t1, t2]) = self.corners(&self.mesh.uvs, triangle).map(|corners| corners.map(Vec2::from)) else {
            return (Vec2::new(b1, b2), self.to_world * e1);
        };
        let uv = t0 * (1.0 - b1 - b2) + t1 * b1 + t2 * b2;
        let (d1, d2) = (t1 - t0, t2 - t0);
        let determinant = d1.x * d2.y - d1.y * d2.x;
        let along_u = if determinant == 0.0 { e1 } else { (e1 * d2.y - e2 * d1.y) / determinant };
        (uv, self.to_world * along_u)
    }
}
