//! The file: its JSON and its buffers.
//!
//! The crate `gltf` knows the schema, and the container of a `.glb`. How it walks a document trusts what the file says of itself, so that a
//! hostile one could make it panic; here everything is looked up, and what is not there is an error.

use std::path::{Path, PathBuf};

use ::gltf::{
    Glb,
    json::{Index, Root, buffer},
};
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

use super::{extension, uri::Uri};
use crate::error::{Error, Place, Result};

/// The largest file, and the most that all buffers come to, in bytes.
const MAX_BYTES: u64 = 4 << 30;

pub(super) const DAMAGED: &str = "the file is damaged; export it again";

/// A glTF with its buffers.
pub(super) struct Asset {
    pub(super) root: Root,
    pub(super) path: PathBuf,
    /// `None` where a buffer has no bytes, as those have that only an extension fills.
    buffers: Vec<Option<Vec<u8>>>,
}

impl Asset {
    /// Reads a file and the buffers that it names.
    pub(super) fn open(path: &Path) -> Result<Self> {
        let bytes = bytes(path).map_err(|thing| Error::in_file(path, thing, "name a glTF file, .gltf or .glb"))?;
        let (json, binary) = if bytes.starts_with(b"glTF") { chunks(&bytes, path)? } else { (bytes, None) };
        let root = serde_json::from_slice(&json).map_err(|e| not_gltf(path, &e))?;
        let mut asset = Self { root, path: path.to_owned(), buffers: Vec::new() };
        let version = &asset.root.asset.version;
        if !version.starts_with("2.") {
            return Err(asset.error(format!("is glTF {version}"), "convert it to glTF 2.0"));
        }
        extension::check_required(&asset)?;
        asset.read_buffers(binary)?;
        Ok(asset)
    }

    fn read_buffers(&mut self, mut binary: Option<Vec<u8>>) -> Result<()> {
        let mut total = 0;
        for (at, buffer) in self.root.buffers.iter().enumerate() {
            let label = format!("buffer {at}");
            let bytes = match &buffer.uri {
                Some(uri) => Some(self.fetch(uri, &label)?),
                None if at == 0 => binary.take(),
                None => None,
            };
            if let Some(bytes) = &bytes {
                total += bytes.len() as u64;
                if (bytes.len() as u64) < buffer.byte_length.0 {
                    let thing = format!("{label} has {} bytes, and should have {}", bytes.len(), buffer.byte_length.0);
                    return Err(self.error(thing, DAMAGED));
                }
            }
            if total > MAX_BYTES {
                return Err(self.error(format!("its buffers come to more than {} GiB", MAX_BYTES >> 30), "split the model"));
            }
            self.buffers.push(bytes);
        }
        Ok(())
    }

    /// What a URI stands for.
    pub(super) fn fetch(&self, uri: &str, label: &str) -> Result<Vec<u8>> {
        let folder = self.path.parent().unwrap_or(Path::new(""));
        let meant = Uri::read(uri, folder);
        match meant.map_err(|thing| self.error(format!("{label} {thing}"), "put it into the file, or into one beside it"))? {
            Uri::Data(bytes) => Ok(bytes),
            Uri::Files(files) => {
                let file = files.iter().find(|file| file.exists()).unwrap_or(&files[0]);
                let missing =
                    |thing| self.error(format!("{label}: {} {thing}", file.display()), "put it there, or export a .glb, which holds all");
                bytes(file).map_err(missing)
            }
        }
    }

    /// The bytes of a buffer view.
    pub(super) fn view(&self, index: Index<buffer::View>) -> Result<&[u8]> {
        let label = format!("buffer view {}", index.value());
        let Some(view) = self.root.get(index) else { return Err(self.missing(&label)) };
        let buffer = view.buffer.value();
        let bytes = self.buffers.get(buffer).ok_or_else(|| self.missing(&format!("buffer {buffer}")))?;
        let Some(bytes) = bytes else { return Err(self.error(format!("buffer {buffer} has no bytes"), DAMAGED)) };
        let start = view.byte_offset.unwrap_or_default().0;
        let range =
            start.checked_add(view.byte_length.0).and_then(|end| bytes.get(usize::try_from(start).ok()?..usize::try_from(end).ok()?));
        range.ok_or_else(|| {
            let thing = format!("{label} is {} bytes from {start} of buffer {buffer}, which has {}", view.byte_length.0, bytes.len());
            self.error(thing, DAMAGED)
        })
    }

    /// Where messages say that something stands: glTF has no lines to speak of.
    pub(super) fn place(&self) -> Place {
        Place { file: self.path.clone(), position: None }
    }

    pub(super) fn error(&self, thing: impl Into<String>, remedy: impl Into<String>) -> Error {
        Error::in_file(&self.path, thing, remedy)
    }

    /// Something names a thing that is not there.
    pub(super) fn missing(&self, label: &str) -> Error {
        self.error(format!("{label} is named and is not there"), DAMAGED)
    }

    /// What an extension says; `others` are all that an object has.
    pub(super) fn extension<T: DeserializeOwned>(&self, others: Option<&Map<String, Value>>, name: &str, label: &str) -> Result<Option<T>> {
        let Some(value) = others.and_then(|others| others.get(name)) else { return Ok(None) };
        let read = serde_json::from_value(value.clone());
        read.map(Some).map_err(|e| self.error(format!("{name} of {label} cannot be read ({e})"), DAMAGED))
    }
}

/// What messages call a thing: its kind, its number and its name.
pub(super) fn label(kind: &str, index: usize, name: Option<&String>) -> String {
    match name {
        Some(name) if !name.is_empty() => format!("{kind} {index} \"{}\"", name.chars().take(60).collect::<String>()),
        _ => format!("{kind} {index}"),
    }
}

fn not_gltf(path: &Path, error: &serde_json::Error) -> Error {
    let place = Place { file: path.to_owned(), position: Some((error.line() as u32, error.column() as u32)) };
    let said = error.to_string();
    let said = said.split(" at line").next().unwrap_or_default();
    Error::at(&place, format!("is no glTF ({said})"), "name a glTF file, .gltf or .glb; if it is one, export it again")
}

/// JSON and binary of a GLB.
fn chunks(bytes: &[u8], path: &Path) -> Result<(Vec<u8>, Option<Vec<u8>>)> {
    let fail = |thing: String| Error::in_file(path, thing, DAMAGED);
    // The crate trusts that the length counts the header.
    let length = bytes.get(8..12).and_then(|b| Some(u32::from_le_bytes(b.try_into().ok()?))).unwrap_or(0);
    if length < 12 || length as usize > bytes.len() {
        return Err(fail(format!("says that it has {length} bytes, and has {}", bytes.len())));
    }
    let glb = Glb::from_slice(bytes).map_err(|e| fail(format!("is no GLB that can be read ({e})")))?;
    Ok((glb.json.into_owned(), glb.bin.map(|bin| bin.into_owned())))
}

fn bytes(path: &Path) -> std::result::Result<Vec<u8>, String> {
    let found = std::fs::metadata(path).map_err(|e| format!("cannot be read ({e})"))?;
    if !found.is_file() {
        return Err("is not a file".into());
    }
    if found.len() > MAX_BYTES {
        return Err(format!("is larger than {} GiB", MAX_BYTES >> 30));
    }
    std::fs::read(path).map_err(|e| format!("cannot be read ({e})"))
}
