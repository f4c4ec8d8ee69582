//! What reading a scene builds up, and what is shared between its elements.

use std::{
    collections::{HashMap, HashSet},
    path::{Path, PathBuf},
    sync::Arc,
};

use super::{ahead::Ahead, attribute::Wearer, group::Known, ids::Ids, properties::line, xml, xml::Element};
use crate::{
    error::{Error, Place, Result},
    plugin::Library,
    scene::description::{Bitmap, EnvironmentImage, Group, Material, MaterialId, Mesh},
};

/// A scene half read.
pub(super) struct Context<'s> {
    pub(super) ids: Ids<'s>,
    pub(super) library: &'s Library,
    pub(super) warnings: Vec<String>,
    pub(super) materials: Vec<Material>,
    /// By the serial of the element, and [`Wearer::key`] where attributes of a mesh are asked for.
    pub(super) material_ids: HashMap<(u32, Option<usize>), MaterialId>,
    /// The serials of the elements whose materials are being read, each inside the one before.
    pub(super) materials_open: Vec<u32>,
    /// What wears the material that is being read.
    pub(super) wearer: Wearer,
    /// Whether what is being read asks for attributes of the mesh that wears it.
    pub(super) attributes_asked: bool,
    pub(super) groups: Vec<Arc<Group>>,
    /// By the serial of the element; `None` while the group is being read.
    pub(super) groups_read: HashMap<u32, Option<Known>>,
    /// How many groups are being read, each inside the one before.
    pub(super) groups_open: usize,
    /// Merges that were read, by the serial of the element.
    pub(super) merged: HashSet<u32>,
    /// How many merges are being read, each inside the one before.
    pub(super) merges_open: usize,
    pub(super) default_materials: [Option<MaterialId>; 2],
    /// By the file and everything that changes what is read from it.
    pub(super) bitmaps: HashMap<String, Arc<Bitmap>>,
    pub(super) environments: HashMap<PathBuf, Arc<EnvironmentImage>>,
    pub(super) meshes: HashMap<String, Arc<Mesh>>,
    /// Files that are read already.
    pub(super) ahead: Ahead,
    /// Area lights that a shape has, by the serial of the element, and where that shape stands.
    attached: HashMap<u32, Place>,
    base: Option<PathBuf>,
    search: Vec<PathBuf>,
}

impl<'s> Context<'s> {
    pub(super) fn new(ids: Ids<'s>, library: &'s Library, base: Option<&Path>, search: &[PathBuf]) -> Self {
        Self {
            ids,
            library,
            warnings: Vec::new(),
            materials: Vec::new(),
            material_ids: HashMap::new(),
            materials_open: Vec::new(),
            wearer: Wearer::Nobody,
            attributes_asked: false,
            groups: Vec::new(),
            groups_read: HashMap::new(),
            groups_open: 0,
            merged: HashSet::new(),
            merges_open: 0,
            default_materials: [None; 2],
            bitmaps: HashMap::new(),
            environments: HashMap::new(),
            meshes: HashMap::new(),
            ahead: Ahead::default(),
            attached: HashMap::new(),
            base: base.map(Path::to_owned),
            search: search.to_vec(),
        }
    }

    /// The file that `filename` means: beside the file that names it, beside the scene, or where `<path>` says.
    pub(super) fn file(&self, filename: &str, place: &Place) -> Result<PathBuf> {
        if self.base.is_none() {
            return Err(xml::no_files(place));
        }
        if filename.trim().is_empty() {
            return Err(Error::at(place, "the file name is empty", "name a file"));
        }
        let mut paths = self.folders(place).into_iter().map(|folder| folder.join(filename));
        let first = paths.next().unwrap_or_default();
        if first.exists() {
            return Ok(first);
        }
        paths.find(|path| path.exists()).ok_or_else(|| {
            Error::at(place, format!("there is no file {}", first.display()), "check the name, or give its folder with <path value=\"…\"/>")
        })
    }

    /// Where files are that are named at `place`: beside the file that names them, beside the scene, or where `<path>` says. Nowhere,
    /// if the scene may name no files.
    pub(super) fn folders(&self, place: &Place) -> Vec<PathBuf> {
        let Some(base) = &self.base else { return Vec::new() };
        let beside = place.file.parent().unwrap_or(Path::new(""));
        let mut folders = vec![beside.to_owned()];
        folders.extend([base].into_iter().chain(&self.search).filter(|folder| *folder != beside).cloned());
        folders
    }

    /// Keeps `warning` for the user.
    pub(super) fn warn(&mut self, place: &Place, warning: impl std::fmt::Display) {
        self.warnings.push(format!("{place}: {warning}"));
    }

    /// An error if a shape has this light already.
    pub(super) fn attach(&mut self, emitter: &Element, shape: &Place) -> Result<()> {
        match self.attached.insert(emitter.serial, shape.clone()) {
            None => Ok(()),
            Some(first) => {
                let thing = format!("the emitter on line {} is on another shape already, on line {}", line(&emitter.place), line(&first));
                Err(Error::at(shape, thing, "write a second emitter"))
            }
        }
    }
}
