//! Geometry on its way into a tree.

use bidir_kernel::{Frame, Real, Vec3, math};
use glam::{DAffine3, DVec3};

use super::{
    description::{self, Geometry},
    extent::{Ball, Ellipse, Flat, LightExtent, Parallelogram, Surface, Tube},
    group::{Group, Owner},
    shape::{Form, MeshForm, Shape, Turn},
};
use crate::{
    error::{Error, Result},
    rays::{self, PrimitiveId, Primitives, Visibility},
};

/// What goes into one tree.
pub(super) struct Collection<'a> {
    groups: &'a [Group],
    /// What becomes (0, 0, 0).
    pub origin: DVec3,
    pub primitives: Primitives,
    /// Of each primitive.
    pub owners: Vec<Owner>,
    /// Without their lights, and without being told whether anything is mapped onto them.
    pub shapes: Vec<Shape>,
    /// How many triangles and shapes without area were dropped.
    pub degenerate: usize,
}

impl<'a> Collection<'a> {
    /// Room for shapes, and for instances of these groups; an error if there are more of them than a tree holds.
    pub fn new(origin: DVec3, shapes: &[description::Shape], instances: &[description::Instance], groups: &'a [Group]) -> Result<Self> {
        check_count(shapes, instances)?;
        let (primitives, owners, shapes) = (Primitives::new(), Vec::new(), Vec::new());
        Ok(Self { groups, origin, primitives, owners, shapes, degenerate: 0 })
    }

    /// Where a transform leads in the tree's coordinates.
    fn place(&self, to_world: &DAffine3) -> DAffine3 {
        DAffine3 { translation: to_world.translation - self.origin, ..*to_world }
    }

    /// Every primitive was counted before, so there is room for it.
    fn own(&mut self, inserted: Option<PrimitiveId>, owner: Owner) {
        self.owners.extend(inserted.map(|_| owner));
    }

    /// Adds an instance.
    pub fn instance(&mut self, instance: &description::Instance) -> Result<()> {
        let Some(group) = self.groups.get(instance.group.0 as usize) else {
            let thing = format!("the instance is of group {}, which does not stand before it", instance.group.0);
            return Err(Error::at(&instance.place, thing, "name a group that does"));
        };
        if group.geometry.stats().primitives == 0 {
            self.degenerate += 1;
            return Ok(());
        }
        let to_world = self.place(&instance.to_world) * DAffine3::from_translation(group.origin);
        let Some(placed) = rays::Instance::new(group.geometry.clone(), to_world) else {
            let thing =
                format!("the instance flattens its group, reaches farther than 1e30 or is one of more than {} levels", rays::LEVELS);
            return Err(Error::at(&instance.place, thing, "mend its transform, or write the group out"));
        };
        let inserted = self.primitives.instance(placed, Visibility::Everywhere);
        self.own(inserted, Owner::instance(instance.group.0));
        Ok(())
    }

    /// Adds a shape; answers how lights see it, or `None` where it has no area.
    pub fn shape(&mut self, shape: &description::Shape, visibility: Visibility) -> Result<Option<LightExtent>> {
        let owner = Owner::shape(self.shapes.len() as u32, 0);
        let facing = |flip: bool| if flip { -1.0 } else { 1.0 };
        let (form, facing, extent) = match &shape.geometry {
            Geometry::Rectangle { to_world, flip_normals } => {
                let Some((center, a, b, mirror)) = self.plane(to_world) else { return Ok(None) };
                let corner = center - a - b;
                let inserted = self.primitives.parallelogram(rays::Parallelogram { corner, x: a * 2.0, y: b * 2.0 }, visibility);
                self.own(inserted, owner);
                let facing = facing(*flip_normals) * mirror;
                (Form::Parallelogram(a, b), facing, LightExtent::Parallelogram(Parallelogram(Flat::new(center, a, b, facing, 4.0))))
            }
            Geometry::Disk { to_world, flip_normals } => {
                let Some((center, a, b, mirror)) = self.plane(to_world) else { return Ok(None) };
                let inserted = self.primitives.disk(rays::Disk { centre: center, x: a, y: b }, visibility);
                self.own(inserted, owner);
                let facing = facing(*flip_normals) * mirror;
                (Form::Disk(a, b), facing, LightExtent::Ellipse(Ellipse(Flat::new(center, a, b, facing, std::f32::consts::PI))))
            }
            Geometry::Sphere { center, radius, to_world, flip_normals } => {
                let (axes, scale) = similarity(to_world).ok_or_else(|| unequal(shape, "sphere"))?;
                let (center, radius) = (self.place(to_world).transform_point3(*center).as_vec3(), (radius * scale) as Real);
                if !(radius > 0.0 && radius.is_finite()) {
                    self.degenerate += 1;
                    return Ok(None);
                }
                let inserted = self.primitives.sphere(rays::Sphere { centre: center, radius }, visibility);
                self.own(inserted, owner);
                let outward = facing(*flip_normals) * to_world.matrix3.determinant().signum() as Real;
                (Form::Sphere(axes, radius as Real), outward, LightExtent::Ball(Ball { center, radius, axes, outward, both_sides: false }))
            }
            Geometry::Cylinder { p0, p1, radius, to_world, flip_normals } => {
                let (_, scale) = similarity(to_world).ok_or_else(|| unequal(shape, "cylinder"))?;
                let placed = self.place(to_world);
                let [base, end] = [p0, p1].map(|p| placed.transform_point3(*p).as_vec3());
                let radius = (radius * scale) as Real;
                let Some(axis) = math::normalize(end - base).filter(|_| radius > 0.0 && radius.is_finite()) else {
                    self.degenerate += 1;
                    return Ok(None);
                };
                let x = to_world.transform_vector3(local_x(*p1 - *p0)).as_vec3();
                let inserted = self.primitives.cylinder(rays::Cylinder { p0: base, p1: end, x, radius }, visibility);
                self.own(inserted, owner);
                let (outward, turning) = (facing(*flip_normals), to_world.matrix3.determinant().signum() as Real);
                (
                    Form::Cylinder { axis, length: (end - base).length() as Real, radius: radius as Real, turning },
                    outward,
                    LightExtent::Tube(Tube { base, axis: end - base, x, radius, outward, turning }),
                )
            }
            Geometry::Mesh { mesh, to_world, flip_normals } => {
                let form = MeshForm::new(mesh.clone(), Turn::of(&to_world.matrix3));
                let outward = facing(*flip_normals);
                let surface = self.mesh(&form, to_world, visibility, outward, shape.light.is_some());
                (Form::Mesh(form), outward, LightExtent::Surface(surface))
            }
        };
        self.shapes.push(Shape { form, finish: shape.material.0, light: None, facing, mapped: false, detailed: false });
        Ok(Some(extent))
    }

    /// Centre and half edges of the unit square, and −1 if the transform mirrors; `None`, counted, where they span no area.
    fn plane(&mut self, to_world: &DAffine3) -> Option<(Vec3, Vec3, Vec3, Real)> {
        let m = to_world.matrix3;
        let (a, b) = (m.x_axis.as_vec3(), m.y_axis.as_vec3());
        let center = self.place(to_world).translation.as_vec3();
        let area = a.cross(b).length();
        if !(area > 0.0 && area.is_finite() && center.is_finite()) {
            self.degenerate += 1;
            return None;
        }
        Some((center, a, b, if m.determinant() < 0.0 { -1.0 } else { 1.0 }))
    }

    fn mesh(&mut self, form: &MeshForm, to_world: &DAffine3, visibility: Visibility, outward: Real, shines: bool) -> Surface {
        let index = self.shapes.len() as u32;
        let placed = self.place(to_world);
        let position = |&[x, y, z]: &[f32; 3]| placed.transform_point3(DVec3::new(x.into(), y.into(), z.into())).as_vec3();
        let positions: Vec<Vec3> = form.mesh.positions.iter().map(position).collect();
        let (triangles, numbers, cumulative) = (Vec::new(), Vec::new(), Vec::new());
        let mut surface = Surface { triangles, numbers, form: form.clone(), outward, cumulative, center: Vec3::ZERO };
        let (mut sum, mut low, mut high) = (0.0, Vec3::INFINITY, Vec3::NEG_INFINITY);
        self.primitives.reserve_triangles(form.mesh.triangles.len());
        for (number, corners) in form.mesh.triangles.iter().enumerate() {
            let [a, b, c] = corners.map(|i| positions[i as usize]);
            let cross = (b - a).as_dvec3().cross((c - a).as_dvec3());
            let area = 0.5 * cross.length();
            if !(area > 0.0 && area.is_finite()) {
                self.degenerate += 1;
                continue;
            }
            let inserted = self.primitives.triangle([a, b, c], visibility);
            self.own(inserted, Owner::shape(index, number as u32));
            if shines {
                let normal = (cross / (2.0 * area)).as_vec3();
                sum += area;
                surface.triangles.push(([a, b, c], normal * (form.facing(number as u32, normal) * outward)));
                surface.numbers.push(number as u32);
                surface.cumulative.push(sum);
                (low, high) = (low.min(a).min(b).min(c), high.max(a).max(b).max(c));
            }
        }
        if shines && sum > 0.0 {
            surface.center = 0.5 * (low + high);
        }
        surface
    }
}

/// An error if there are more than one tree holds; asked before anything is copied.
fn check_count(shapes: &[description::Shape], instances: &[description::Instance]) -> Result<()> {
    let shapes = shapes.iter().map(|shape| (primitives_of(shape), &shape.place));
    let mut count = 0;
    for (more, place) in shapes.chain(instances.iter().map(|instance| (1, &instance.place))) {
        count += more;
        if count > Primitives::MOST {
            let thing = format!("with this there are more than {} triangles and other shapes (2^28 − 1) in one tree", Primitives::MOST);
            let remedy = "put some of them into a shapegroup, which has a tree of its own, and place it with an instance";
            return Err(Error::at(place, thing, remedy));
        }
    }
    Ok(())
}

/// How much of a tree a shape takes.
fn primitives_of(shape: &description::Shape) -> usize {
    match &shape.geometry {
        Geometry::Mesh { mesh, .. } => mesh.triangles.len(),
        Geometry::Rectangle { .. } => 2,
        Geometry::Disk { .. } | Geometry::Sphere { .. } | Geometry::Cylinder { .. } => 1,
    }
}

fn unequal(shape: &description::Shape, what: &str) -> Error {
    Error::at(&shape.place, format!("a {what} cannot be scaled unequally or sheared"), "scale it alike along every axis, or use a mesh")
}

/// The unit axes of a rotation (perhaps mirrored) with one scale, and that scale.
fn similarity(to_world: &DAffine3) -> Option<([Vec3; 3], f64)> {
    let m = to_world.matrix3;
    let (x, y, z) = (m.x_axis.length(), m.y_axis.length(), m.z_axis.length());
    let near = |a: f64, b: f64| (a - b).abs() <= 1e-4 * x;
    let square = |a: DVec3, b: DVec3| a.dot(b).abs() <= 1e-4 * x * x;
    let similar =
        x > 0.0 && near(x, y) && near(x, z) && square(m.x_axis, m.y_axis) && square(m.y_axis, m.z_axis) && square(m.z_axis, m.x_axis);
    similar.then(|| ([(m.x_axis / x).as_vec3(), (m.y_axis / x).as_vec3(), (m.z_axis / x).as_vec3()], x))
}

/// Where a cylinder's angle is 0, before its transform.
fn local_x(axis: DVec3) -> DVec3 {
    let z = axis.normalize_or(DVec3::Z).as_vec3();
    Frame::from_z(z).x.as_dvec3()
}
