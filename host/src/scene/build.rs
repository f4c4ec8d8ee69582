//! From a description to a scene: world coordinates about the scene's own centre, the trees, the lights.

use std::sync::Arc;

use bidir_kernel::{Effects, Frame, Real, Vec3};
use bidir_standard as standard;
use glam::{DAffine3, DVec3};

use crate::{
    error::{Error, Result},
    plugin::{Roster, Sandbox, Strictness},
    rays::{Bvh, Geometry as _, Quality, Visibility},
    scene::{
        Scene,
        camera::SceneCamera,
        centre::centre,
        choice::Lights,
        collection::Collection,
        description::{self, Description, EmitterKind, MaterialId, PluginShader, ShapeLight, Texture},
        extent::LightExtent,
        group::Group,
        lights::{EnvironmentTables, LightId, LightSource, PluginProfile, ProfileSource, Seat, TexturedArea, environment_frame},
        plain::Parts,
        shape::Shape,
        surface::Finish,
    },
};

struct Builder<'a> {
    description: &'a Description,
    quality: Quality,
    groups: Vec<Group>,
    /// The groups' shapes; in the end they follow the others.
    in_groups: Vec<Shape>,
    finishes: Vec<Finish>,
    roster: Roster,
    sources: Vec<(Seat, ProfileSource)>,
}

impl Scene {
    /// Builds the scene; what it drops on the way it counts in [`Scene::degenerate`].
    pub fn new(description: &Description) -> Result<Self> {
        Self::with_quality(description, Quality::default())
    }

    /// The same with trees of that quality.
    pub fn with_quality(description: &Description, quality: Quality) -> Result<Self> {
        Self::build(description, quality, None)
    }

    /// The scene of a description in which something has changed. The trees of groups whose [`Arc`] has not, nor that of any
    /// group within them, are not built again but shared; the outermost tree is built, with what stands in no group.
    pub fn rebuilt(&self, description: &Description) -> Result<Self> {
        Ok(Self::build(description, Quality::default(), Some(self))?.with_triangles(self.geometry.triangles()))
    }

    fn build(description: &Description, quality: Quality, before: Option<&Self>) -> Result<Self> {
        let mut roster = Roster::default();
        let ids = 0..description.materials.len() as u32;
        let finishes = ids.map(|id| Finish::new(&description.materials, MaterialId(id), &mut roster));
        let finishes = finishes.collect::<Option<Vec<_>>>().ok_or_else(|| {
            Error::new("a material names one that is not there, or a twosided one inside another", "give each side a plain material")
        })?;
        let (groups, in_groups, sources) = (Vec::new(), Vec::new(), Vec::new());
        let mut builder = Builder { description, quality, groups, in_groups, finishes, roster, sources };
        builder.groups(before)?;
        builder.finish()
    }
}

impl Builder<'_> {
    /// Builds the groups' trees, or takes those that are there already.
    fn groups(&mut self, before: Option<&Scene>) -> Result<()> {
        let mut kept = Vec::new();
        for (index, source) in self.description.groups.iter().enumerate() {
            let known = before.and_then(|scene| Some((scene, scene.groups.get(index)?)));
            let known = known.filter(|(_, known)| {
                Arc::ptr_eq(&known.source, source) && source.instances.iter().all(|inner| kept.get(inner.group.0 as usize) == Some(&true))
            });
            kept.push(known.is_some());
            let group = match known {
                Some((scene, known)) => {
                    let shapes = &scene.shapes[known.shapes.start as usize..known.shapes.end as usize];
                    Group { shapes: self.add_to_groups(shapes.to_vec()), ..known.clone() }
                }
                None => self.group(source)?,
            };
            self.groups.push(group);
        }
        Ok(())
    }

    fn group(&mut self, source: &Arc<description::Group>) -> Result<Group> {
        let description::Group { shapes, instances, .. } = &**source;
        let origin = centre(shapes, instances, &self.groups).unwrap_or(DVec3::ZERO);
        let mut all = Collection::new(origin, shapes, instances, &self.groups)?;
        for shape in shapes {
            if shape.light.is_some() {
                let thing = format!("{} shines, and stands in a group", shape.name);
                return Err(Error::at(&shape.place, thing, "take its emitter out, or put it beside the group"));
            }
            all.shape(shape, Visibility::Everywhere)?;
        }
        for instance in instances {
            all.instance(instance)?;
        }
        let Collection { primitives, owners, shapes, degenerate, .. } = all;
        let geometry = Arc::new(Bvh::build_as(primitives, self.quality));
        let shapes = self.add_to_groups(shapes);
        Ok(Group { source: source.clone(), geometry, owners: owners.into(), shapes, origin, degenerate })
    }

    /// Adds a group's shapes to those of the groups before it; where they are.
    fn add_to_groups(&mut self, shapes: Vec<Shape>) -> std::ops::Range<u32> {
        let first = self.in_groups.len() as u32;
        self.in_groups.extend(shapes);
        first..self.in_groups.len() as u32
    }

    fn finish(mut self) -> Result<Scene> {
        let Description { shapes, instances, sensor, film, integrator, .. } = self.description;
        let groups = std::mem::take(&mut self.groups);
        let origin = centre(shapes, instances, &groups).unwrap_or(sensor.to_world.translation);
        let mut all = Collection::new(origin, shapes, instances, &groups)?;
        for shape in shapes {
            let hidden = shape.light.as_ref().is_some_and(|light| !light.is_black()) && integrator.hide_emitters;
            let visibility = if hidden { Visibility::HiddenFromLens } else { Visibility::Everywhere };
            let extent = all.shape(shape, visibility)?;
            if let (Some(extent), Some(light), Some(built)) = (extent, &shape.light, all.shapes.last_mut()) {
                built.light = Some(self.light(light, extent));
            }
        }
        for instance in instances {
            all.instance(instance)?;
        }
        let Collection { primitives, owners, mut shapes, degenerate, .. } = all;
        let camera = SceneCamera::new(sensor, film, origin)?;
        let geometry = Bvh::build_as(primitives, self.quality);
        let (center, radius) = ball(&geometry);
        for emitter in &self.description.emitters {
            let source = self.emitter(emitter, origin, center, radius)?;
            self.sources.push(source);
        }
        let roster = Arc::new(self.roster);
        let sandbox = Sandbox::new(Arc::clone(&roster), Strictness::Lenient);
        let sources = self.sources.into_iter().map(|(seat, profile)| LightSource::new(seat, profile, &sandbox)).collect();
        if let Some(fault) = sandbox.fault() {
            return Err(fault.into());
        }
        let (lights, ids) = Lights::new(sources);
        let first = shapes.len() as u32;
        shapes.extend(self.in_groups);
        for shape in &mut shapes {
            shape.light = shape.light.and_then(|id| ids[id.0 as usize]);
            // A profile may depend on coordinates and tangent, and every light's are alike, whether it is a plugin or not.
            let finish = self.finishes.get(shape.finish as usize);
            shape.mapped = shape.light.is_some() || finish.is_some_and(Finish::mapped);
            shape.detailed = finish.is_some_and(Finish::detailed);
        }
        let moved = |group: Group| Group { shapes: group.shapes.start + first..group.shapes.end + first, ..group };
        let degenerate = degenerate + groups.iter().map(|group| group.degenerate).sum::<usize>();
        let plain = Parts::of(&camera, &shapes, &self.finishes, &lights);
        let effects = effects(&camera, &shapes, &self.finishes, &lights, integrator.hide_emitters);
        Ok(Scene {
            camera,
            origin,
            geometry,
            owners,
            groups: groups.into_iter().map(moved).collect(),
            shapes,
            finishes: self.finishes,
            lights,
            roster,
            hides_emitters: integrator.hide_emitters,
            degenerate,
            effects,
            plain,
        })
    }

    /// The light of a shape. Their final names come once the black ones are dropped.
    fn light(&mut self, light: &ShapeLight, extent: LightExtent) -> LightId {
        let profile = match light {
            ShapeLight::Area(Texture::Constant(radiance)) => ProfileSource::Area(standard::Area { radiance: *radiance }),
            ShapeLight::Area(radiance) => ProfileSource::Textured(TexturedArea::new(radiance.clone(), &extent)),
            ShapeLight::Plugin(shader) => self.profile(shader),
        };
        self.sources.push((Seat::Shape(extent), profile));
        LightId(self.sources.len() as u32 - 1)
    }

    /// A plugin's profile, added to the roster.
    fn profile(&mut self, shader: &PluginShader) -> ProfileSource {
        let id = self.roster.add(&shader.module, &shader.block);
        ProfileSource::Plugin(PluginProfile { id, textures: shader.textures.clone(), name: shader.name() })
    }

    fn emitter(&mut self, emitter: &description::Emitter, origin: DVec3, center: Vec3, radius: Real) -> Result<(Seat, ProfileSource)> {
        let degenerate =
            || Error::at(&emitter.place, "the emitter's transform or direction is degenerate", "give it a direction of some length");
        let axes = |to_world: &DAffine3| -> Result<[Vec3; 3]> {
            let m = to_world.matrix3;
            let axis = |v: DVec3| v.try_normalize().map(|v| v.as_vec3()).ok_or_else(degenerate);
            Ok([axis(m.x_axis)?, axis(m.y_axis)?, axis(m.z_axis)?])
        };
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

/// What the parts of a scene need of the kernel.
fn effects(camera: &SceneCamera, shapes: &[Shape], finishes: &[Finish], lights: &Lights, hides_emitters: bool) -> Effects {
    let environment = lights.environment().is_some();
    let own = Effects { environment, hidden_emitters: hides_emitters, ..camera.effects() };
    shapes.iter().fold(own, |all, shape| all | shape.effects() | finishes[shape.finish as usize].effects())
}

/// Centre and radius of a sphere that holds everything.
fn ball(geometry: &Bvh) -> (Vec3, Real) {
    let bounds = geometry.bounds();
    if bounds.is_empty() {
        return (Vec3::ZERO, 1.0);
    }
    let half = 0.5 * (bounds.max - bounds.min);
    // Rounding must not leave a corner outside.
    (0.5 * (bounds.max + bounds.min), half.length() * (1.0 + 1e-5))
}
