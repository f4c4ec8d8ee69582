//! Reading scenes: Mitsuba 3's XML, or glTF 2.0, into a [`Description`]. Nothing is built and nothing rendered here.
//!
//! What is written in XML is either read as Mitsuba 3 reads it, or an error says where it stands, what it is and what to do instead. What a glTF
//! holds beyond that is listed in a warning.

mod ahead;
mod attribute;
mod bsdf;
pub mod catalog;
mod context;
mod defines;
mod emitter;
mod film;
pub mod gltf;
mod group;
mod ids;
mod integrator;
mod ior;
mod merge;
pub mod mesh;
mod plugin;
mod properties;
mod sensor;
mod shape;
pub(crate) mod suggest;
mod texture;
mod transform;
mod upgrade;
mod value;
mod xml;

use std::path::Path;

pub use self::ahead::Watch;
use self::{ahead::Ahead, attribute::Wearer, context::Context, ids::Ids, properties::Properties};
use crate::{
    error::{Error, Result},
    plugin::Library,
    scene::description::{Description, Emitter, Instance, Integrator},
};

/// A scene, and what the user should know about it.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The scene.
    pub description: Description,
    /// What was changed or left out, one sentence each, with its place.
    pub warnings: Vec<String>,
}

/// Reads the scene file `path`, XML unless it ends in `.gltf` or `.glb` or begins as the latter does; `defines` are names and values for
/// its `$name`s, and `library` is where plugins are that are not beside the scene.
///
/// # Errors
/// If anything in the file, or in the files that it names, cannot be read exactly as it is meant.
pub fn load(path: &Path, defines: &[(String, String)], library: &Library) -> Result<Loaded> {
    load_watched(path, defines, library, &|_, _| {})
}

/// As [`load`]; `watch` is told how many of the files that the scene names are read, by whichever thread has read one.
///
/// # Errors
/// As [`load`].
pub fn load_watched(path: &Path, defines: &[(String, String)], library: &Library, watch: Watch) -> Result<Loaded> {
    if gltf::is_meant(path) {
        return gltf::load(path, defines);
    }
    let text = xml::read_text(path, None)?;
    read(&text, path, Some(path.parent().unwrap_or(Path::new(""))), defines, library, watch)
}

/// Reads the text of a scene; `name` is what messages call it, and `base_dir` where files are that it names, if it may name any.
///
/// # Errors
/// As [`load`].
pub fn load_str(text: &str, name: &Path, base_dir: Option<&Path>, defines: &[(String, String)], library: &Library) -> Result<Loaded> {
    read(text, name, base_dir, defines, library, &|_, _| {})
}

fn read(text: &str, name: &Path, base_dir: Option<&Path>, defines: &[(String, String)], library: &Library, watch: Watch) -> Result<Loaded> {
    let tree = xml::read(text, name, base_dir, defines)?;
    let ids = Ids::collect(&tree.root)?;
    let scene = Properties::read(&tree.root, &ids)?;
    let mut context = Context::new(ids, library, base_dir, &tree.search);
    context.warnings.extend(tree.notes.iter().cloned());
    context.ahead = Ahead::read(&tree.root, &context, watch);

    let integrator = match scene.object("integrator")? {
        Some(element) => integrator::integrator(&mut context, element)?,
        None => Integrator::default(),
    };
    let sensors = scene.objects("sensor");
    let Some(first) = sensors.first() else {
        return Err(Error::at(scene.place(), "the scene has no sensor", "add one, such as <sensor type=\"perspective\">"));
    };
    let equipment = sensor::sensor(&context.ids, first)?;
    if let Some(second) = sensors.get(1) {
        context.warn(&second.place, format_args!("the scene has {} sensors; the first one is used", sensors.len()));
    }
    context.wearer = Wearer::Declared;
    for element in scene.objects("bsdf") {
        bsdf::material(&mut context, element)?;
    }
    for element in scene.objects("texture") {
        texture::texture(&mut context, element, texture::Range::NOT_NEGATIVE, &element.place)?;
    }
    context.wearer = Wearer::Nobody;
    let (shapes, instances) = group::shapes(&mut context, &scene.objects("shape"), group::Whole::Scene)?;
    warn_of_unused_groups(&mut context, &instances);
    let emitters = emitters(&mut context, &scene)?;
    for tag in ["medium", "volume", "phase", "film", "sampler", "rfilter"] {
        if let Some(element) = scene.objects(tag).first() {
            if tag == "medium" {
                catalog::check(tag, element.attribute("type").unwrap_or(""), &element.place)?;
            }
            let remedy =
                if tag == "medium" { "media are not supported; take it out" } else { "move it to where it belongs, or take it out" };
            return Err(Error::at(&element.place, format!("a <{tag}> stands directly inside the scene"), remedy));
        }
    }
    scene.finish()?;
    let description = Description {
        sensor: equipment.sensor,
        film: equipment.film,
        integrator,
        samples_per_pixel: equipment.samples_per_pixel,
        seed: equipment.seed,
        materials: context.materials,
        shapes,
        groups: context.groups,
        instances,
        emitters,
    };
    Ok(Loaded { description, warnings: context.warnings })
}

fn warn_of_unused_groups(context: &mut Context, instances: &[Instance]) {
    let mut shown = vec![false; context.groups.len()];
    let inner = context.groups.iter().flat_map(|group| &group.instances);
    for instance in instances.iter().chain(inner) {
        shown[instance.group.0 as usize] = true;
    }
    let unused: Vec<_> = context.groups.iter().zip(shown).filter(|(_, shown)| !shown).map(|(group, _)| group.place.clone()).collect();
    for place in unused {
        context.warn(&place, "no instance shows this group");
    }
}

fn emitters(context: &mut Context, scene: &Properties) -> Result<Vec<Emitter>> {
    let mut emitters = Vec::new();
    let mut environment = None;
    for element in scene.objects("emitter") {
        // One for shapes to refer to shines from nowhere itself.
        let Some(emitter) = emitter::emitter(context, element)? else { continue };
        if emitter.kind.is_environment()
            && let Some(first) = environment.replace(properties::line(&element.place))
        {
            let thing = format!("the scene has a second environment; the first is on line {first}");
            return Err(Error::at(&element.place, thing, "keep one of them"));
        }
        emitters.push(emitter);
    }
    Ok(emitters)
}

#[cfg(test)]
mod tests;
