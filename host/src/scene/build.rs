//! From a description to a scene: world coordinates about the scene's own centre, the tree, the lights.

use std::sync::Arc;

use bidir_kernel::{Frame, Mat3, Real, Vec3, math};
use bidir_standard as standard;
use glam::{DAffine3, DMat3, DVec3};

use crate::{
    error::{Error, Result},
    plugin::{Roster, Sandbox, Strictness},
    rays::{self, Bvh, Geometry as _, Primitives, Visibility},
    scene::{
        Scene,
        camera::SceneCamera,
        choice::Lights,
        description::{self, Description, EmitterKind, Geometry, MaterialId, PluginShader, ShapeLight},
        extent::{Ball, Ellipse, Flat, LightExtent, Parallelogram, Surface, Tube},
        lights::{EnvironmentTables, LightSource, PluginProfile, ProfileSource, Seat, environment_frame},
        shape::{Form, MeshForm, Shape},
        surface::Finish,
    },
};

struct Builder<'a> {
    description: &'a Description,
    /// What becomes (0, 0, 0).
    origin: DVec3,
    primitives: Primitives,
    owners: Vec<(u32, u32)>,
    shapes: Vec<Shape>,
    finishes: Vec<Finish>,
    roster: Roster,
    sources: Vec<(Seat, ProfileSource)>,
    degenerate: usize,
}

impl Scene {
    /// Builds the scene; what it drops on the way it counts in [`Scene::degenerate`].
    pub fn new(description: &Description) -> Result<Self> {
        let mut roster = Roster::default();
        let ids = 0..description.materials.len() as u32;
        let finishes = ids.map(|id| Finish::new(&description.materials, MaterialId(id), &mut roster));
        let finishes = finishes.collect::<Option<Vec<_>>>().ok_or_else(|| {
            Error::new("a material names one that is not there, or a twosided one inside another", "give each side a plain material")
        })?;
        let mut builder = Builder {
            description,
            origin: centre(description),
            primitives: Primitives::new(),
            owners: Vec::new(),
            shapes: Vec::new(),
            finishes,
            roster,
            sources: Vec::new(),
            degenerate: 0,
        };
        for shape in &description.shapes {
            builder.shape(shape)?;
        }
        builder.finish()
    }
}

/// The middle of everything that has a place.
fn centre(description: &Description) -> DVec3 {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let mut extend = |p: DVec3| (low, high) = (low.min(p), high.max(p));
    for shape in &description.shapes {
        match &shape.geometry {
            Geometry::Mesh { mesh, to_world, .. } => {
                mesh.positions.iter().for_each(|&[x, y, z]| extend(to_world.transform_point3(DVec3::new(x.into(), y.into(), z.into()))));
            }
            Geometry::Rectangle { to_world, .. } | Geometry::Disk { to_world, .. } => {
                for (x, y) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)] {
                    extend(to_world.transform_point3(DVec3::new(x, y, 0.0)));
                }
            }
            Geometry::Sphere { center, radius, to_world, .. } => {
                let r = DVec3::splat(radius * to_world.matrix3.x_axis.length());
                let c = to_world.transform_point3(*center);
                extend(c - r);
                extend(c + r);
            }
            Geometry::Cylinder { p0, p1, radius, to_world, .. } => {
                let r = DVec3::splat(radius * to_world.matrix3.x_axis.length());
                for p in [p0, p1].map(|p| to_world.transform_point3(*p)) {
                    extend(p - r);
                    extend(p + r);
                }
            }
        }
    }
    if low.is_finite() && high.is_finite() { 0.5 * (low + high) } else { description.sensor.to_world.translation }
}

impl Builder<'_> {
    fn place(&self, to_world: &DAffine3) -> DAffine3 {
        DAffine3 { translation: to_world.translation - self.origin, ..*to_world }
    }

    fn shape(&mut self, shape: &description::Shape) -> Result<()> {
        let index = self.shapes.len() as u32;
        let hidden = shape.light.as_ref().is_some_and(|light| !light.is_black()) && self.description.integrator.hide_emitters;
        let visibility = if hidden { Visibility::HiddenFromLens } else { Visibility::Everywhere };
        let facing = |flip: bool| if flip { -1.0 } else { 1.0 };
        let (form, facing, extent) = match &shape.geometry {
            Geometry::Rectangle { to_world, flip_normals } => {
                let Some((center, a, b, mirror)) = self.plane(to_world) else { return Ok(()) };
                let corner = center - a - b;
                self.owners.push((index, 0));
                self.primitives.parallelogram(rays::Parallelogram { corner, x: a * 2.0, y: b * 2.0 }, visibility);
                let facing = facing(*flip_normals) * mirror;
                (Form::Parallelogram(a), facing, LightExtent::Parallelogram(Parallelogram(Flat::new(center, a, b, facing, 4.0))))
            }
            Geometry::Disk { to_world, flip_normals } => {
                let Some((center, a, b, mirror)) = self.plane(to_world) else { return Ok(()) };
                self.owners.push((index, 0));
                self.primitives.disk(rays::Disk { centre: center, x: a, y: b }, visibility);
                let facing = facing(*flip_normals) * mirror;
                (Form::Disk(a, b), facing, LightExtent::Ellipse(Ellipse(Flat::new(center, a, b, facing, std::f32::consts::PI))))
            }
            Geometry::Sphere { center, radius, to_world, flip_normals } => {
                let (axes, scale) = similarity(to_world).ok_or_else(|| unequal(shape, "sphere"))?;
                let (center, radius) = (self.place(to_world).transform_point3(*center).as_vec3(), (radius * scale) as Real);
                if !(radius > 0.0 && radius.is_finite()) {
                    self.degenerate += 1;
                    return Ok(());
                }
                self.owners.push((index, 0));
                self.primitives.sphere(rays::Sphere { centre: center, radius }, visibility);
                let outward = facing(*flip_normals) * to_world.matrix3.determinant().signum() as Real;
                (Form::Sphere(axes), outward, LightExtent::Ball(Ball { center, radius, axes, outward, both_sides: false }))
            }
            Geometry::Cylinder { p0, p1, radius, to_world, flip_normals } => {
                let (_, scale) = similarity(to_world).ok_or_else(|| unequal(shape, "cylinder"))?;
                let placed = self.place(to_world);
                let [base, end] = [p0, p1].map(|p| placed.transform_point3(*p).as_vec3());
                let radius = (radius * scale) as Real;
                let Some(axis) = math::normalize(end - base).filter(|_| radius > 0.0 && radius.is_finite()) else {
                    self.degenerate += 1;
                    return Ok(());
                };
                self.owners.push((index, 0));
                let x = to_world.transform_vector3(local_x(*p1 - *p0)).as_vec3();
                self.primitives.cylinder(rays::Cylinder { p0: base, p1: end, x, radius }, visibility);
                let outward = facing(*flip_normals);
                (Form::Cylinder(axis), outward, LightExtent::Tube(Tube { base, axis: end - base, x, radius, outward }))
            }
            Geometry::Mesh { mesh, to_world, flip_normals } => {
                let form = mesh_form(mesh.clone(), to_world);
                let outward = facing(*flip_normals);
                let surface = self.mesh(&form, to_world, index, visibility, outward, shape.light.is_some());
                (Form::Mesh(form), outward, LightExtent::Surface(surface))
            }
        };
        let light = shape.light.as_ref().map(|light| {
            let profile = match light {
                ShapeLight::Area(radiance) => ProfileSource::Area(standard::Area { radiance: *radiance }),
                ShapeLight::Plugin(shader) => self.profile(shader),
            };
            self.sources.push((Seat::Shape(extent), profile));
            // Their final names come once the black ones are dropped.
            crate::scene::lights::LightId(self.sources.len() as u32 - 1)
        });
        let finish = shape.material.0;
        // A profile may depend on coordinates and tangent, and every light's are alike, whether it is a plugin or not.
        let mapped = light.is_some() || self.finishes.get(finish as usize).is_some_and(Finish::mapped);
        self.shapes.push(Shape { form, finish, light, facing, mapped });
        Ok(())
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

    fn mesh(&mut self, form: &MeshForm, to_world: &DAffine3, index: u32, visibility: Visibility, outward: Real, shines: bool) -> Surface {
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
            self.owners.push((index, number as u32));
            self.primitives.triangle([a, b, c], visibility);
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

    fn finish(mut self) -> Result<Scene> {
        let camera = SceneCamera::new(&self.description.sensor, &self.description.film, self.origin)?;
        let geometry = Bvh::build(std::mem::take(&mut self.primitives));
        let bounds = geometry.bounds();
        let (center, radius) = if bounds.is_empty() {
            (Vec3::ZERO, 1.0)
        } else {
            let half = 0.5 * (bounds.max - bounds.min);
            // Rounding must not leave a corner outside.
            (0.5 * (bounds.max + bounds.min), half.length() * (1.0 + 1e-5))
        };
        for emitter in &self.description.emitters {
            let source = self.emitter(emitter, center, radius)?;
            self.sources.push(source);
        }
        let roster = Arc::new(self.roster);
        let sandbox = Sandbox::new(Arc::clone(&roster), Strictness::Lenient);
        let sources = self.sources.into_iter().map(|(seat, profile)| LightSource::new(seat, profile, &sandbox)).collect();
        if let Some(fault) = sandbox.fault() {
            return Err(fault.into());
        }
        let (lights, ids) = Lights::new(sources);
        for shape in &mut self.shapes {
            shape.light = shape.light.and_then(|id| ids[id.0 as usize]);
        }
        Ok(Scene {
            camera,
            geometry,
            owners: self.owners,
            shapes: self.shapes,
            finishes: self.finishes,
            lights,
            roster,
            hides_emitters: self.description.integrator.hide_emitters,
            degenerate: self.degenerate,
        })
    }

    /// A plugin's profile, added to the roster.
    fn profile(&mut self, shader: &PluginShader) -> ProfileSource {
        let id = self.roster.add(&shader.module, &shader.block);
        ProfileSource::Plugin(PluginProfile { id, textures: shader.textures.clone(), name: shader.name() })
    }

    fn emitter(&mut self, emitter: &description::Emitter, center: Vec3, radius: Real) -> Result<(Seat, ProfileSource)> {
        let degenerate =
            || Error::at(&emitter.place, "the emitter's transform or direction is degenerate", "give it a direction of some length");
        let axes = |to_world: &DAffine3| -> Result<[Vec3; 3]> {
            let m = to_world.matrix3;
            let axis = |v: DVec3| v.try_normalize().map(|v| v.as_vec3()).ok_or_else(degenerate);
            Ok([axis(m.x_axis)?, axis(m.y_axis)?, axis(m.z_axis)?])
        };
        let origin = self.origin;
        let point = |to_world: &DAffine3| -> Result<Seat> {
            let [x, _, z] = axes(to_world)?;
            Ok(Seat::Point { position: (to_world.translation - origin).as_vec3(), frame: Frame::from_z_and_tangent(z, x) })
        };
        let around = |to_world: &DAffine3| -> Result<Seat> {
            let [x, y, z] = axes(to_world)?;
            Ok(Seat::Environment { center, radius, frame: environment_frame(x, y, z) })
        };
        Ok(match &emitter.kind {
            EmitterKind::Point { position, intensity } => {
                (point(&DAffine3::from_translation(*position))?, ProfileSource::Isotropic(standard::Isotropic { intensity: *intensity }))
            }
            EmitterKind::Spot { to_world, intensity, cutoff_angle, beam_width } => {
                let spot = standard::Spot::from_degrees(*intensity, *cutoff_angle as Real, *beam_width as Real);
                (point(to_world)?, ProfileSource::Spot(spot))
            }
            EmitterKind::Directional { direction, irradiance } => {
                let direction = direction.try_normalize().ok_or_else(degenerate)?.as_vec3();
                let light = standard::Directional { direction, irradiance: *irradiance, center, radius };
                (Seat::Directional(light), ProfileSource::Constant(standard::Constant { radiance: *irradiance }))
            }
            EmitterKind::Constant { radiance } => {
                (around(&DAffine3::IDENTITY)?, ProfileSource::Constant(standard::Constant { radiance: *radiance }))
            }
            EmitterKind::Envmap { image, scale, to_world } => {
                let tables = EnvironmentTables::new(image.clone(), *scale as Real).ok_or_else(|| {
                    Error::at(&emitter.place, "the environment's image has no pixels", "use an image of at least one pixel")
                })?;
                (around(to_world)?, ProfileSource::Envmap(tables))
            }
            EmitterKind::PluginPoint { to_world, shader } => (point(to_world)?, self.profile(shader)),
            EmitterKind::PluginEnvironment { to_world, shader } => (around(to_world)?, self.profile(shader)),
        })
    }
}

fn unequal(shape: &description::Shape, what: &str) -> Error {
    Error::at(&shape.place, format!("a {what} cannot be scaled unequally or sheared"), "scale it alike along every axis, or use a mesh")
}

fn mesh_form(mesh: std::sync::Arc<description::Mesh>, to_world: &DAffine3) -> MeshForm {
    let m = to_world.matrix3;
    // The cofactors are the inverse transpose times the determinant; its sign is kept out, so that mirroring leaves normals outside.
    let cofactors = DMat3::from_cols(m.y_axis.cross(m.z_axis), m.z_axis.cross(m.x_axis), m.x_axis.cross(m.y_axis));
    let largest = cofactors.to_cols_array().iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    let scale = m.determinant().signum() / largest.max(f64::MIN_POSITIVE);
    MeshForm { mesh, to_world: m.as_mat3(), normal_to_world: Mat3::from_cols_array(&(cofactors * scale).to_cols_array().map(|v| v as f32)) }
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
