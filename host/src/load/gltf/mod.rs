//! Reading glTF 2.0, `.gltf` and `.glb`, into a [`Description`].
//!
//! `docs/gltf.md` says what becomes of what. What is left out is listed in one warning; what is taken for something else has one of its own.

mod accessor;
mod asset;
mod camera;
pub mod extension;
mod light;
mod material;
mod mesh;
mod node;
mod principled;
mod shape;
mod texture;
mod uri;

use std::{
    collections::{BTreeSet, HashMap, HashSet},
    fmt::Display,
    io::Read,
    path::Path,
    rc::Rc,
};

use bidir_kernel::Spectrum;

use self::{
    asset::Asset,
    material::{Laid, Surface},
    shape::Shapes,
    texture::Decoded,
};
use super::{Loaded, defines::Defines};
use crate::{
    error::Result,
    image::read::Encoding,
    scene::description::{Description, Emitter, EmitterKind, Integrator, Material, Texture},
};

/// A glTF half read.
struct Reader<'a> {
    asset: &'a Asset,
    warnings: Vec<String>,
    said: HashSet<String>,
    left_out: BTreeSet<String>,
    materials: Vec<Material>,
    /// By the number of the material, `None` for that of primitives without one.
    surfaces: HashMap<(Option<usize>, Laid), Surface>,
    /// By everything that changes what is read.
    textures: HashMap<String, Texture>,
    /// The image that was decoded last.
    decoded: Option<((usize, Encoding), Rc<Decoded>)>,
    /// Memory of all textures.
    bytes: usize,
    /// Vertices and corners of all meshes.
    elements: usize,
}

/// Whether a file is one by its ending, or by its first bytes.
pub(super) fn is_meant(path: &Path) -> bool {
    let ending = path.extension().map(|ending| ending.to_ascii_lowercase());
    if ending.is_some_and(|ending| ending == "gltf" || ending == "glb") {
        return true;
    }
    if !path.is_file() {
        return false;
    }
    let mut magic = [0; 4];
    let read = std::fs::File::open(path).and_then(|mut file| file.read_exact(&mut magic));
    read.is_ok() && magic == *b"glTF"
}

/// Reads a glTF. Of `defines` it knows `size`, the pixels of the image's longer side, and `lights`, which multiplies its punctual lights.
pub(super) fn load(path: &Path, defines: &[(String, String)]) -> Result<Loaded> {
    let asset = Asset::open(path)?;
    let mut reader = Reader {
        asset: &asset,
        warnings: Vec::new(),
        said: HashSet::new(),
        left_out: BTreeSet::new(),
        materials: Vec::new(),
        surfaces: HashMap::new(),
        textures: HashMap::new(),
        decoded: None,
        bytes: 0,
        elements: 0,
    };
    let mut defines = Defines::new(defines);
    let description = reader.description(&mut defines)?;
    defines.check_used(path)?;
    Ok(Loaded { description, warnings: reader.warnings() })
}

impl Reader<'_> {
    fn description(&mut self, defines: &mut Defines) -> Result<Description> {
        self.list_extensions();
        let root = &self.asset.root;
        if !root.animations.is_empty() {
            self.leave_out("animations");
        }
        if root.scenes.len() > 1 {
            self.leave_out("all scenes but one");
        }
        let nodes = self.asset.nodes()?;
        let Shapes { shapes, groups, instances, bounds } = self.shapes(&nodes)?;
        let (sensor, aspect) = self.camera(&nodes, bounds)?;
        let film = self.film(aspect, defines)?;
        let mut emitters = self.lights(&nodes, defines)?;
        if emitters.is_empty() && shapes.iter().all(|shape| shape.light.is_none()) {
            self.warn("nothing shines; light of radiance 1 is put all around");
            emitters.push(Emitter { kind: EmitterKind::Constant { radiance: Spectrum::ONE }, place: self.asset.place() });
        }
        Ok(Description {
            sensor,
            film,
            integrator: Integrator::default(),
            samples_per_pixel: 4,
            seed: 0,
            materials: std::mem::take(&mut self.materials),
            shapes,
            groups,
            instances,
            emitters,
        })
    }

    /// Keeps a warning for the user; the same one once.
    fn warn(&mut self, warning: impl Display) {
        let warning = format!("{}: {warning}", self.asset.place());
        if self.said.insert(warning.clone()) {
            self.warnings.push(warning);
        }
    }

    /// Something is left out, to be listed in the end.
    fn leave_out(&mut self, what: &str) {
        self.left_out.insert(what.to_owned());
    }

    fn warnings(mut self) -> Vec<String> {
        if !self.left_out.is_empty() {
            let all = std::mem::take(&mut self.left_out).into_iter().collect::<Vec<_>>().join(", ");
            self.warn(format_args!("left out: {all}"));
        }
        self.warnings
    }
}

#[cfg(test)]
mod tests;
