//! What a scene holds, counted.

use std::collections::BTreeMap;

use bidir_kernel::Lobe;
use serde::Serialize;

use super::effects::{lobes, with_parts};
use crate::scene::{
    Scene,
    description::{Crop, Description, Filter, Geometry, Instance, Integrator, Material, MaterialId, NormalMap, SensorKind, Shape, Texture},
    lights::ProfileSource,
};

/// A scene in numbers.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Contents {
    /// The camera and its film.
    pub camera: Camera,
    /// How far paths go.
    pub integrator: Depths,
    /// Samples per pixel that the scene asks for.
    pub spp: u32,
    /// Of the random numbers.
    pub seed: u64,
    /// By kind, only those there are.
    pub shapes: Vec<Shapes>,
    /// Groups and their instances, if there are any.
    pub groups: Option<Groups>,
    /// What rays are cast at, triangles and other shapes; those of a group once.
    pub primitives: usize,
    /// Triangles and shapes without area, dropped.
    pub degenerate: usize,
    /// By kind and lobes, only those that a shape wears.
    pub materials: Vec<Materials>,
    /// Materials that no shape wears.
    pub unused_materials: usize,
    /// By kind, only those that shine.
    pub lights: Vec<Lights>,
    /// Lights without power, left out.
    pub black_lights: usize,
}

/// The camera and its film.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Camera {
    /// pinhole, thin lens or orthographic.
    pub kind: &'static str,
    /// Horizontal field of view, degrees.
    pub fov_x: Option<f64>,
    /// World units; of a thin lens.
    pub aperture_radius: Option<f64>,
    /// World units; of a thin lens.
    pub focus_distance: Option<f64>,
    /// Where the scene writes it.
    pub near_clip: Option<f64>,
    /// Where the scene writes it.
    pub far_clip: Option<f64>,
    /// The whole image, pixels.
    pub width: u32,
    /// The whole image, pixels.
    pub height: u32,
    /// x, y, width, height of what is rendered, if that is not the whole image.
    pub crop: Option<[u32; 4]>,
    /// The reconstruction filter.
    pub filter: String,
}

/// How far paths go.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Depths {
    /// The `type` as written.
    pub kind: String,
    /// Segments; `None` is unlimited.
    pub max_depth: Option<u32>,
    /// Segments after which roulette begins.
    pub rr_depth: u32,
    /// Whether the lens sees through emitters.
    pub hide_emitters: bool,
}

/// Groups and their instances.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Groups {
    /// How many groups.
    pub count: usize,
    /// How many shapes are in them; they are counted among the scene's as well.
    pub shapes: usize,
    /// How many instances are written, in groups as well.
    pub instances: usize,
    /// How many shapes the scene would have if each instance were written out.
    pub written_out: u64,
}

/// Shapes of one kind.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Shapes {
    /// mesh, rectangle, disk, sphere or cylinder.
    pub kind: &'static str,
    /// How many.
    pub count: usize,
    /// Of all meshes together, as written.
    pub triangles: usize,
}

/// Materials of one kind with the same lobes.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Materials {
    /// As the scene language calls it; a twosided one by what is on its sides.
    pub kind: String,
    /// How many.
    pub count: usize,
    /// How many shapes wear them.
    pub shapes: usize,
    /// Every lobe they have anywhere.
    pub lobes: Vec<&'static str>,
    /// How many of them vary over the surface.
    pub textured: usize,
}

/// Lights of one kind.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Lights {
    /// As the scene language calls it.
    pub kind: String,
    /// How many.
    pub count: usize,
    /// W, mean of the bands; of far away ones, what they send through a disk around the scene.
    pub power: f64,
    /// Of the power of all lights.
    pub share: f64,
}

impl Contents {
    /// Those of a scene, and of the description it was built from.
    pub fn of(description: &Description, scene: &Scene) -> Self {
        let Integrator { kind, max_depth, rr_depth, hide_emitters, .. } = description.integrator.clone();
        let (materials, worn) = materials(description);
        let (lights, stats) = (lights(scene), scene.build_stats());
        let shining: usize = lights.iter().map(|light| light.count).sum();
        let written = description.emitters.len() + description.shapes.iter().filter(|shape| shape.light.is_some()).count();
        Self {
            camera: camera(description),
            integrator: Depths { kind, max_depth, rr_depth, hide_emitters },
            spp: description.samples_per_pixel,
            seed: description.seed,
            shapes: shapes(description),
            groups: groups(description),
            primitives: stats.primitives - stats.instances,
            degenerate: scene.degenerate(),
            materials,
            unused_materials: description.materials.len() - worn,
            lights,
            black_lights: written.saturating_sub(shining),
        }
    }
}

fn camera(description: &Description) -> Camera {
    let (sensor, film) = (&description.sensor, &description.film);
    let Crop { x, y, width, height } = film.crop;
    let (kind, fov_x, lens) = match sensor.kind {
        SensorKind::Orthographic => ("orthographic", None, None),
        SensorKind::Perspective { fov_x, aperture_radius, focus_distance } if aperture_radius > 0.0 => {
            ("thin lens", Some(fov_x), Some((aperture_radius, focus_distance)))
        }
        SensorKind::Perspective { fov_x, .. } => ("pinhole", Some(fov_x), None),
    };
    Camera {
        kind,
        fov_x,
        aperture_radius: lens.map(|lens| lens.0),
        focus_distance: lens.map(|lens| lens.1),
        near_clip: sensor.near_clip,
        far_clip: sensor.far_clip,
        width: film.width,
        height: film.height,
        crop: ((width, height) != (film.width, film.height)).then_some([x, y, width, height]),
        filter: match film.filter {
            Filter::Box => "box".to_owned(),
            Filter::Tent { radius } => format!("tent, radius {radius}"),
            Filter::Gaussian { stddev } => format!("gaussian, stddev {stddev}"),
            Filter::Cubic { b: 0.0, c: 0.5 } => "catmullrom".to_owned(),
            Filter::Cubic { b, c } => format!("mitchell, B {b:.3}, C {c:.3}"),
            Filter::Lanczos { lobes } => format!("lanczos, {lobes} lobes"),
        },
    }
}

fn groups(description: &Description) -> Option<Groups> {
    // A group's instances are of groups before it.
    let mut sizes: Vec<u64> = Vec::with_capacity(description.groups.len());
    let size = |shapes: &[Shape], instances: &[Instance], sizes: &[u64]| {
        let inner = instances.iter().map(|instance| sizes.get(instance.group.0 as usize).copied().unwrap_or(0));
        inner.fold(shapes.len() as u64, u64::saturating_add)
    };
    for group in &description.groups {
        sizes.push(size(&group.shapes, &group.instances, &sizes));
    }
    let groups = Groups {
        count: description.groups.len(),
        shapes: description.groups.iter().map(|group| group.shapes.len()).sum(),
        instances: description.instances.len() + description.groups.iter().map(|group| group.instances.len()).sum::<usize>(),
        written_out: size(&description.shapes, &description.instances, &sizes),
    };
    (groups.count > 0).then_some(groups)
}

fn shapes(description: &Description) -> Vec<Shapes> {
    let mut kinds = ["mesh", "rectangle", "disk", "sphere", "cylinder"].map(|kind| Shapes { kind, count: 0, triangles: 0 });
    for shape in description.all_shapes() {
        let (kind, triangles) = match &shape.geometry {
            Geometry::Mesh { mesh, .. } => (0, mesh.triangles.len()),
            Geometry::Rectangle { .. } => (1, 0),
            Geometry::Disk { .. } => (2, 0),
            Geometry::Sphere { .. } => (3, 0),
            Geometry::Cylinder { .. } => (4, 0),
        };
        kinds[kind].count += 1;
        kinds[kind].triangles += triangles;
    }
    kinds.into_iter().filter(|kind| kind.count > 0).collect()
}

/// The materials that shapes wear, and how many of the description's they account for: what one is made of is in use with it.
fn materials(description: &Description) -> (Vec<Materials>, usize) {
    let all = &description.materials;
    let mut wearers: BTreeMap<u32, usize> = BTreeMap::new();
    for shape in description.all_shapes() {
        *wearers.entry(shape.material.0).or_default() += 1;
    }
    let mut used: Vec<u32> = Vec::new();
    let mut kinds: Vec<Materials> = Vec::new();
    for (&id, &shapes) in &wearers {
        let id = MaterialId(id);
        let parts = with_parts(all, id);
        used.extend(parts.iter().map(|(part, _)| part.0));
        let (kind, lobes) = (kind(all, id), lobe_names(lobes(all, id)));
        let varies =
            |(_, material): &(MaterialId, &Material)| material.textures().iter().any(|texture| !matches!(texture, Texture::Constant(_)));
        let textured = usize::from(parts.iter().any(varies));
        match kinds.iter_mut().find(|known| known.kind == kind && known.lobes == lobes) {
            Some(known) => {
                known.count += 1;
                known.shapes += shapes;
                known.textured += textured;
            }
            None => kinds.push(Materials { kind, count: 1, shapes, lobes, textured }),
        }
    }
    used.sort_unstable();
    used.dedup();
    (kinds, used.len())
}

/// What a material is, and what it is made of.
fn kind(materials: &[Material], id: MaterialId) -> String {
    let Some(material) = materials.get(id.0 as usize) else { return String::new() };
    let mut parts: Vec<_> = material.parts().iter().map(|part| kind(materials, *part)).collect();
    parts.dedup();
    let parts = parts.join(" and ");
    match material {
        Material::Plugin(shader) => format!("{} (plugin)", shader.name()),
        Material::Diffuse { .. } => "diffuse".to_owned(),
        Material::Conductor { .. } => "conductor".to_owned(),
        Material::RoughConductor { .. } => "roughconductor".to_owned(),
        Material::Dielectric { .. } => "dielectric".to_owned(),
        Material::ThinDielectric { .. } => "thindielectric".to_owned(),
        Material::RoughDielectric { .. } => "roughdielectric".to_owned(),
        Material::Plastic { .. } => "plastic".to_owned(),
        Material::RoughPlastic { .. } => "roughplastic".to_owned(),
        Material::Principled(_) => "principled".to_owned(),
        Material::PrincipledThin(_) => "principledthin".to_owned(),
        Material::Null => "null".to_owned(),
        Material::TwoSided { .. } => format!("twosided {parts}"),
        Material::Mask { .. } => format!("mask of {parts}"),
        Material::Blend { .. } => format!("blendbsdf of {parts}"),
        Material::Bent { map: NormalMap::Normals(_), .. } => format!("normalmap on {parts}"),
        Material::Bent { map: NormalMap::Heights(..), .. } => format!("bumpmap on {parts}"),
    }
}

/// The lobes of a set, by the names that plugins give them.
fn lobe_names(lobes: Lobe) -> Vec<&'static str> {
    let all = [
        (Lobe::DIFFUSE_REFLECTION, "diffuse_reflection"),
        (Lobe::GLOSSY_REFLECTION, "glossy_reflection"),
        (Lobe::DELTA_REFLECTION, "delta_reflection"),
        (Lobe::DIFFUSE_TRANSMISSION, "diffuse_transmission"),
        (Lobe::GLOSSY_TRANSMISSION, "glossy_transmission"),
        (Lobe::DELTA_TRANSMISSION, "delta_transmission"),
    ];
    all.into_iter().filter(|(lobe, _)| lobes.intersects(*lobe)).map(|(_, name)| name).collect()
}

fn lights(scene: &Scene) -> Vec<Lights> {
    let built_in = ["area", "point", "spot", "directional", "constant", "envmap"];
    let mut kinds: Vec<Lights> = built_in.map(|kind| Lights { kind: kind.to_owned(), count: 0, power: 0.0, share: 0.0 }).into();
    for light in scene.all_lights().sources() {
        let kind = match &light.profile {
            ProfileSource::Plugin(plugin) => format!("{} (plugin)", plugin.name),
            _ => light.kind().to_owned(),
        };
        let at = kinds.iter().position(|known| known.kind == kind).unwrap_or_else(|| {
            kinds.push(Lights { kind, count: 0, power: 0.0, share: 0.0 });
            kinds.len() - 1
        });
        kinds[at].count += 1;
        kinds[at].power += light.power();
    }
    let total: f64 = kinds.iter().map(|kind| kind.power).sum();
    let with_share = |kind: Lights| Lights { share: kind.power / total, ..kind };
    kinds.into_iter().filter(|kind| kind.count > 0).map(with_share).collect()
}
