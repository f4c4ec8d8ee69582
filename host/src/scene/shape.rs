//! Shapes as rays meet them: from a hit to a point with its frames and surface coordinates.

use std::sync::Arc;

use bidir_kernel::{Effects, Frame, Mat3, Point, Real, Vec2, Vec3, math};
use glam::DMat3;

use crate::{
    rays::SurfacePoint,
    scene::{description::Mesh, lights::LightId, surface::Stretch},
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
    /// Whether anything asks how coordinates lie on the surface, or where in its mesh a hit is.
    pub detailed: bool,
}

/// What is needed to tell normals and coordinates at a hit.
#[derive(Clone, Debug)]
pub enum Form {
    /// Flat; its two half axes.
    Parallelogram(Vec3, Vec3),
    /// Flat; its two half axes.
    Disk(Vec3, Vec3),
    /// Round; its own axes in the world, and its radius.
    Sphere([Vec3; 3], Real),
    /// Round.
    Cylinder {
        /// Unit.
        axis: Vec3,
        /// From end to end.
        length: Real,
        /// About the axis.
        radius: Real,
        /// 1 where u goes round the axis as a right hand's fingers do, −1 where the shape is mirrored.
        turning: Real,
    },
    /// Triangles.
    Mesh(MeshForm),
}

/// A mesh's vertex data and how to bring it into the world, or into the coordinates of its group.
#[derive(Clone, Debug)]
pub struct MeshForm {
    /// In its own coordinates.
    pub mesh: Arc<Mesh>,
    /// Its own coordinates → the world.
    pub turn: Turn,
    /// Whether its vertices' normals are those of its triangles, and so tell no more than which side is out.
    flat: bool,
}

/// What a transform does to directions, up to scale.
#[derive(Clone, Copy, Debug)]
pub struct Turn {
    /// For directions along the surface.
    pub along: Mat3,
    /// For normals: the inverse transpose.
    pub normal: Mat3,
}

impl Turn {
    /// Of a transform that can be undone.
    pub fn of(to_world: &DMat3) -> Self {
        let m = to_world;
        // The cofactors are the inverse transpose times the determinant; its sign is kept out, so that mirroring leaves normals outside.
        let cofactors = DMat3::from_cols(m.y_axis.cross(m.z_axis), m.z_axis.cross(m.x_axis), m.x_axis.cross(m.y_axis));
        Self { along: m.as_mat3(), normal: scaled(&cofactors, m.determinant().signum()) }
    }

    /// Of an instance, whose scale may be any.
    fn of_instance(to_world: &DMat3) -> Self {
        Self { along: scaled(to_world, 1.0), ..Self::of(to_world) }
    }

    /// This, and `next` after it.
    fn then(&self, next: &Self) -> Self {
        Self { along: next.along * self.along, normal: next.normal * self.normal }
    }
}

/// The same point of a surface, put together from its parts: a call's answer lies in memory, parts need not.
#[inline(always)]
pub(super) fn in_parts(point: &Point) -> Point {
    Point::surface(point.position, point.normal, point.frame, point.uv, point.offset)
}

/// With a largest entry of 1, times `sign`.
fn scaled(matrix: &DMat3, sign: f64) -> Mat3 {
    let largest = matrix.to_cols_array().iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    let scale = sign / largest.max(f64::MIN_POSITIVE);
    Mat3::from_cols_array(&(*matrix * scale).to_cols_array().map(|v| v as f32))
}

const TURN: Real = 2.0 * std::f32::consts::PI;

impl Shape {
    /// What its form needs of the kernel.
    pub fn effects(&self) -> Effects {
        let shading_normals = matches!(&self.form, Form::Mesh(form) if !form.flat);
        Effects { shading_normals, ..Effects::NONE }
    }

    /// The point of a hit; `triangle` is the number within a mesh.
    #[inline(always)]
    pub fn point(&self, at: &SurfacePoint, triangle: u32) -> Point {
        self.turned(at, triangle, None)
    }

    /// The point of a hit in an instance, whose coordinates `to_world` brings into the world.
    pub fn point_in_instance(&self, at: &SurfacePoint, triangle: u32, to_world: &DMat3) -> Point {
        self.turned(at, triangle, Some(&Turn::of_instance(to_world)))
    }

    /// The same with coordinates and a tangent, whether anything asks for them or not.
    pub(super) fn point_in_full(&self, at: &SurfacePoint, triangle: u32, to_world: Option<&DMat3>) -> Point {
        in_parts(&self.told_apart(at, triangle, to_world.map(Turn::of_instance).as_ref()))
    }

    #[inline(always)]
    fn turned(&self, at: &SurfacePoint, triangle: u32, turn: Option<&Turn>) -> Point {
        if self.mapped || matches!(self.form, Form::Mesh(_)) {
            return in_parts(&self.told_apart(at, triangle, turn));
        }
        let normal = at.normal * self.facing;
        Point::surface(at.position, normal, Frame::from_z(normal), Vec2::ZERO, at.offset)
    }

    /// The point of a hit where more than the normal tells one from another: coordinates, a tangent, corners.
    #[inline(never)]
    fn told_apart(&self, at: &SurfacePoint, triangle: u32, turn: Option<&Turn>) -> Point {
        let local = at.local;
        let (tangent, uv) = match &self.form {
            Form::Parallelogram(tangent, _) => (*tangent, Vec2::new(local.x, local.y)),
            Form::Mesh(mesh) => {
                let whole = turn.map(|turn| mesh.turn.then(turn));
                return mesh.point(at, triangle, self, whole.as_ref().unwrap_or(&mesh.turn));
            }
            Form::Disk(x, y) => {
                let radius = math::sqrt(local.x * local.x + local.y * local.y);
                (*x * local.x + *y * local.y, Vec2::new(radius, share_of_turn(local.y, local.x)))
            }
            Form::Sphere(axes, _) => {
                let (uv, tangent) = round_mapping(axes, local);
                (tangent, uv)
            }
            Form::Cylinder { axis, turning, .. } => {
                // Normals go back by the transpose.
                let out = turn.map_or(at.normal, |turn| turn.along.transpose() * at.normal);
                (axis.cross(out) * *turning, Vec2::new(share_of_turn(local.y * turning, local.x), local.z))
            }
        };
        let tangent = turn.map_or(tangent, |turn| turn.along * tangent);
        let normal = at.normal * self.facing;
        Point::surface(at.position, normal, Frame::from_z_and_tangent(normal, tangent), uv, at.offset)
    }
}

/// How coordinates lie on a surface.
impl Shape {
    /// ∂p/∂u and ∂p/∂v of a hit in the world, about its shading normal; `to_world` is that of an instance that it is in.
    #[inline(never)]
    pub fn stretch(&self, at: &SurfacePoint, triangle: u32, to_world: Option<&DMat3>, frame: &Frame) -> Stretch {
        let local = at.local;
        let derivatives = match &self.form {
            Form::Parallelogram(x, y) => [*x * 2.0, *y * 2.0],
            Form::Mesh(mesh) => mesh.derivatives(triangle),
            Form::Disk(x, y) => {
                let radius = math::sqrt(local.x * local.x + local.y * local.y);
                let out = if radius > 0.0 { (*x * local.x + *y * local.y) / radius } else { *x };
                [out, (*y * local.x - *x * local.y) * TURN]
            }
            Form::Sphere([x, y, z], radius) => {
                let (a, b, c) = (math::dot(local, *x), math::dot(local, *y), math::dot(local, *z));
                let sin = math::sqrt(a * a + b * b);
                let down = if sin > 0.0 { (*x * a + *y * b) * (c / sin) - *z * sin } else { *x };
                [(*y * a - *x * b) * (TURN * radius), down * (0.5 * TURN * radius)]
            }
            Form::Cylinder { axis, length, radius, turning } => {
                // In an instance the normal that was met is the world's; the axes here are the group's.
                let out = to_world.map_or(at.normal, |m| math::normalize(m.transpose().as_mat3() * at.normal).unwrap_or(at.normal));
                [axis.cross(out) * (TURN * radius * turning), *axis * *length]
            }
        };
        let [u, v] = derivatives.map(|d| to_world.map_or(d, |m| (*m * d.as_dvec3()).as_vec3())).map(|d| frame.to_local(d));
        // The frame's x is along u, made perpendicular to the normal.
        Stretch { a: u.x, b: v.x, c: v.y }
    }
}

/// Surface coordinates of a sphere with those axes, and the direction in which u grows, where `out` leads from its centre.
pub fn round_mapping([x, y, z]: &[Vec3; 3], out: Vec3) -> (Vec2, Vec3) {
    let (a, b, c) = (math::dot(out, *x), math::dot(out, *y), math::dot(out, *z));
    (Vec2::new(share_of_turn(b, a), math::safe_acos(c) / std::f32::consts::PI), *y * a - *x * b)
}

/// The angle of (x, y) in 0 … 1.
fn share_of_turn(y: Real, x: Real) -> Real {
    let turn = math::atan2(y, x) / TURN;
    if turn < 0.0 { turn + 1.0 } else { turn }
}

/// Whether a triangle's vertices have no normals, or its own, to within rounding.
fn is_flat(mesh: &Mesh, corners: [u32; 3]) -> bool {
    if mesh.normals.is_empty() {
        return true;
    }
    let [n, other, another] = corners.map(|corner| mesh.normals[corner as usize]);
    let [a, b, c] = corners.map(|corner| Vec3::from(mesh.positions[corner as usize]).as_dvec3());
    let (normal, across) = (Vec3::from(n).as_dvec3(), (b - a).cross(c - a));
    let least = normal.length() * across.length();
    n == other && n == another && least > 0.0 && normal.cross(across).length() <= 1e-6 * least
}

impl MeshForm {
    /// A mesh that `turn` brings into the world.
    pub fn new(mesh: Arc<Mesh>, turn: Turn) -> Self {
        let flat = mesh.triangles.iter().all(|&corners| is_flat(&mesh, corners));
        Self { mesh, turn, flat }
    }

    fn corners<T: Copy>(&self, data: &[T], triangle: u32) -> Option<[T; 3]> {
        let [a, b, c] = self.mesh.triangles[triangle as usize];
        Some([*data.get(a as usize)?, *data.get(b as usize)?, *data.get(c as usize)?])
    }

    /// −1 where a triangle's winding disagrees with its vertex normals, which decide.
    pub fn facing(&self, triangle: u32, geometric: Vec3) -> Real {
        self.facing_in(triangle, geometric, &self.turn)
    }

    fn facing_in(&self, triangle: u32, geometric: Vec3, turn: &Turn) -> Real {
        match self.corners(&self.mesh.normals, triangle) {
            Some([a, b, c]) => {
                let sum = Vec3::from(a) + Vec3::from(b) + Vec3::from(c);
                if math::dot(turn.normal * sum, geometric) < 0.0 { -1.0 } else { 1.0 }
            }
            None => 1.0,
        }
    }

    fn point(&self, at: &SurfacePoint, triangle: u32, shape: &Shape, turn: &Turn) -> Point {
        let (b1, b2) = (at.local.x, at.local.y);
        let mut geometric = at.normal;
        let mut shading = None;
        if !self.mesh.normals.is_empty() {
            geometric *= self.facing_in(triangle, geometric, turn);
        }
        if !self.flat {
            shading = self.shading_normal_in(triangle, b1, b2, turn);
        }
        let shading = shading.unwrap_or(geometric) * shape.facing;
        let geometric = geometric * shape.facing;
        if !shape.mapped {
            return Point::surface(at.position, geometric, Frame::from_z(shading), Vec2::ZERO, at.offset);
        }
        let (uv, tangent) = self.mapping_in(triangle, b1, b2, turn);
        Point::surface(at.position, geometric, Frame::from_z_and_tangent(shading, tangent), uv, at.offset)
    }

    /// The normal between the vertices' own, unit; `None` without those, where they cancel, or where they are the triangle's.
    pub fn shading_normal(&self, triangle: u32, b1: Real, b2: Real) -> Option<Vec3> {
        if self.flat { None } else { self.shading_normal_in(triangle, b1, b2, &self.turn) }
    }

    fn shading_normal_in(&self, triangle: u32, b1: Real, b2: Real, turn: &Turn) -> Option<Vec3> {
        let [n0, n1, n2] = self.corners(&self.mesh.normals, triangle)?;
        let mixed = Vec3::from(n0) * (1.0 - b1 - b2) + Vec3::from(n1) * b1 + Vec3::from(n2) * b2;
        math::normalize(turn.normal * mixed)
    }

    /// Surface coordinates, and the direction in which u grows. A mesh without coordinates has its barycentric ones.
    pub fn mapping(&self, triangle: u32, b1: Real, b2: Real) -> (Vec2, Vec3) {
        self.mapping_in(triangle, b1, b2, &self.turn)
    }

    /// ∂p/∂u and ∂p/∂v in a triangle; of one without coordinates, its edges.
    fn derivatives(&self, triangle: u32) -> [Vec3; 2] {
        let Some([p0, p1, p2]) = self.corners(&self.mesh.positions, triangle).map(|corners| corners.map(Vec3::from)) else {
            return [Vec3::ZERO; 2];
        };
        let edges = [p1 - p0, p2 - p0];
        let along = |[u, v]: [Vec3; 2]| [self.turn.along * u, self.turn.along * v];
        let Some([t0, t1, t2]) = self.corners(&self.mesh.uvs, triangle).map(|corners| corners.map(Vec2::from)) else {
            return along(edges);
        };
        let (d1, d2, [e1, e2]) = (t1 - t0, t2 - t0, edges);
        let determinant = d1.x * d2.y - d1.y * d2.x;
        if determinant == 0.0 {
            return along(edges);
        }
        along([(e1 * d2.y - e2 * d1.y) / determinant, (e2 * d1.x - e1 * d2.x) / determinant])
    }

    fn mapping_in(&self, triangle: u32, b1: Real, b2: Real, turn: &Turn) -> (Vec2, Vec3) {
        let Some([p0, p1, p2]) = self.corners(&self.mesh.positions, triangle).map(|corners| corners.map(Vec3::from)) else {
            return (Vec2::ZERO, Vec3::ZERO);
        };
        let (e1, e2) = (p1 - p0, p2 - p0);
        let Some([t0, t1, t2]) = self.corners(&self.mesh.uvs, triangle).map(|corners| corners.map(Vec2::from)) else {
            return (Vec2::new(b1, b2), turn.along * e1);
        };
        let uv = t0 * (1.0 - b1 - b2) + t1 * b1 + t2 * b2;
        let (d1, d2) = (t1 - t0, t2 - t0);
        let determinant = d1.x * d2.y - d1.y * d2.x;
        let along_u = if determinant == 0.0 { e1 } else { (e1 * d2.y - e2 * d1.y) / determinant };
        (uv, turn.along * along_u)
    }
}
