//! Meshes and images that a scene names, read by all cores before the scene itself is gone through.
//!
//! Nothing is decided here: what is wrong with a file is told where the scene is read that names it, and so is what is missing.

use std::{
    collections::{HashMap, HashSet},
    path::PathBuf,
    sync::{
        Mutex, PoisonError,
        atomic::{AtomicUsize, Ordering},
    },
};

use super::{
    context::Context,
    mesh::{self, Format, Parsed},
    xml::Element,
};
use crate::image::{
    read::{Encoding, packed},
    texels::Packed,
};

/// How far reading is: so many files of so many.
pub type Watch<'a> = &'a (dyn Fn(usize, usize) + Sync);

/// A file, and how it is to be read.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
enum File {
    Mesh(PathBuf, Format),
    Image(PathBuf, Encoding),
}

#[derive(Debug)]
enum Content {
    Mesh(Parsed),
    Image(Packed),
}

/// What was read and is not used yet.
#[derive(Debug, Default)]
pub(super) struct Ahead(HashMap<File, Content>);

impl Ahead {
    /// Reads every file below `root` that can be read.
    pub(super) fn read(root: &Element, context: &Context, watch: Watch) -> Self {
        let mut files = Vec::new();
        collect(root, context, &mut HashSet::new(), &mut files);
        // The largest ones first, so that no core is left alone with one in the end.
        files.sort_by_cached_key(|file| std::cmp::Reverse(file.size()));
        let threads = std::thread::available_parallelism().map_or(1, usize::from).min(files.len());
        let (next, done, found) = (AtomicUsize::new(0), AtomicUsize::new(0), Mutex::new(HashMap::new()));
        let work = || {
            while let Some(file) = files.get(next.fetch_add(1, Ordering::Relaxed)) {
                if let Some(content) = file.read() {
                    found.lock().unwrap_or_else(PoisonError::into_inner).insert(file.clone(), content);
                }
                watch(1 + done.fetch_add(1, Ordering::Relaxed), files.len());
            }
        };
        // One file is read no sooner for being read ahead.
        if threads > 1 {
            std::thread::scope(|scope| (0..threads).for_each(|_| _ = scope.spawn(work)));
        }
        Self(found.into_inner().unwrap_or_else(PoisonError::into_inner))
    }

    /// A mesh, if it was read.
    pub(super) fn mesh(&mut self, path: PathBuf, format: Format) -> Option<Parsed> {
        let Content::Mesh(mesh) = self.0.remove(&File::Mesh(path, format))? else { return None };
        Some(mesh)
    }

    /// An image, if it was read.
    pub(super) fn image(&mut self, path: PathBuf, encoding: Encoding) -> Option<Packed> {
        let Content::Image(image) = self.0.remove(&File::Image(path, encoding))? else { return None };
        Some(image)
    }
}

fn collect(element: &Element, context: &Context, seen: &mut HashSet<File>, files: &mut Vec<File>) {
    if let Some(file) = file(element, context)
        && seen.insert(file.clone())
    {
        files.push(file);
    }
    for child in &element.children {
        collect(child, context, seen, files);
    }
}

/// The file that an element names.
fn file(element: &Element, context: &Context) -> Option<File> {
    let value = |name| element.children.iter().find(|child| child.attribute("name") == Some(name))?.attribute("value");
    let path = || context.file(value("filename")?, &element.place).ok();
    match (element.tag.as_str(), element.attribute("type")?) {
        ("shape", kind) => {
            let index = value("shape_index").and_then(|index| index.parse().ok()).unwrap_or(0);
            Some(File::Mesh(path()?, Format::of(kind, index)?))
        }
        ("texture", "bitmap") => {
            let encoding = if value("raw") == Some("true") { Encoding::Linear } else { Encoding::Srgb };
            Some(File::Image(path()?, encoding))
        }
        _ => None,
    }
}

impl File {
    fn size(&self) -> u64 {
        let (Self::Mesh(path, _) | Self::Image(path, _)) = self;
        std::fs::metadata(path).map_or(0, |found| found.len())
    }

    fn read(&self) -> Option<Content> {
        match self {
            Self::Mesh(path, format) => mesh::read(path, *format).ok().map(Content::Mesh),
            Self::Image(path, encoding) => packed(path, *encoding).ok().map(Content::Image),
        }
    }
}
