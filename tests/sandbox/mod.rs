//! Plugins are right: what a module answers is what the same shader answers natively, and every technique makes the same picture of it.

mod batches;
mod bits;
mod delta;
mod lights;
mod metered;
mod natively;
mod twins;

use std::{
    fs,
    path::{Path, PathBuf},
};

use bidir::{
    image::Image,
    load,
    plugin::Library,
    render::Job,
    scene::{Scene, description::Material},
};
use bidir_kernel::{Heuristic, Sampler, Techniques, Vec3, sampler::Independent};

use crate::pictures::Subject;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The modules that are committed.
fn library() -> Library {
    Library::new(vec![root().join("plugins/prebuilt")])
}

/// The text of a whole scene whose files are in `folder`; built-ins that it names with `$kind` are modules where `sandboxed`.
fn build(text: &str, folder: &Path, sandboxed: bool, library: &Library) -> Subject {
    let switches = [("kind", if sandboxed { ".wasm" } else { "" }), ("res", "32")];
    let known = |name: &str| text.contains(&format!("<default name=\"{name}\""));
    let defines: Vec<_> = switches.into_iter().filter(|(name, _)| known(name)).map(|(name, value)| (name.into(), value.into())).collect();
    let description = load::load_str(text, Path::new("test.xml"), Some(folder), &defines, library).expect("a good scene").description;
    let plugin = |material: &&Material| matches!(material, Material::Plugin(_) | Material::TwoSided { .. });
    if sandboxed {
        assert_eq!(description.materials.iter().filter(plugin).count(), description.materials.len(), "a material is not a module");
    }
    let scene = Scene::new(&description).expect("a scene");
    Subject { description, scene }
}

/// A small scene of what [`crate::scenes`] gives, with modules from `library`.
fn read(content: &str, library: &Library) -> Subject {
    let text = format!("<scene version=\"3.0.0\">{content}</scene>");
    let description = load::load_str(&text, Path::new("test.xml"), None, &[], library).expect("a good scene").description;
    let scene = Scene::new(&description).expect("a scene");
    Subject { description, scene }
}

fn text_of(path: &Path) -> String {
    fs::read_to_string(path).expect("a scene")
}

fn image(subject: &Subject, techniques: Techniques, samples: u32, threads: usize) -> Image {
    let job = subject.job(subject.strategy(techniques, Heuristic::Balance), samples, 5);
    subject.image(&Job { threads, ..job })
}

/// Uniform over the sphere.
fn direction(numbers: &mut Independent) -> Vec3 {
    let (z, phi) = (2.0 * numbers.next() - 1.0, std::f32::consts::TAU * numbers.next());
    let r = (1.0 - z * z).sqrt();
    Vec3::new(r * phi.cos(), r * phi.sin(), z)
}
