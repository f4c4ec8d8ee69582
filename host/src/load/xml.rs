//! A scene file as a tree of elements: parameters filled in, includes spliced in, and every element knowing its place.

use std::{
    cell::Cell,
    path::{Path, PathBuf},
};

use super::{defines::Defines, suggest::list, upgrade::Upgrade};
use crate::error::{Error, Place, Result};

/// How deep elements may nest, included files counted in.
const MAX_DEPTH: usize = 64;
/// How deep files may include files.
const MAX_INCLUDES: usize = 16;
/// The largest scene file, in bytes.
const MAX_BYTES: u64 = 256 << 20;
/// How many elements a scene may have, included ones counted as often as they are included.
const MAX_ELEMENTS: u32 = 4_000_000;

/// An element of a scene.
#[derive(Debug)]
pub(super) struct Element {
    pub(super) tag: String,
    pub(super) attributes: Vec<(String, String)>,
    pub(super) children: Vec<Element>,
    pub(super) place: Place,
    /// Tells elements apart.
    pub(super) serial: u32,
}

impl Element {
    /// The value of an attribute.
    pub(super) fn attribute(&self, name: &str) -> Option<&str> {
        self.attributes.iter().find(|(n, _)| n == name).map(|(_, v)| v.as_str())
    }

    /// The value of an attribute that must be there.
    pub(super) fn required(&self, name: &str) -> Result<&str> {
        let thing = || format!("<{}> has no \"{name}\"", self.tag);
        self.attribute(name).ok_or_else(|| Error::at(&self.place, thing(), format!("write <{} {name}=\"…\">", self.tag)))
    }

    /// An error if there is an attribute that is not one of these.
    pub(super) fn only(&self, known: &[&str]) -> Result<()> {
        match self.attributes.iter().find(|(n, _)| !known.contains(&n.as_str())) {
            None => Ok(()),
            Some((n, _)) => {
                let thing = format!("<{}> has an unknown attribute \"{n}\"", self.tag);
                Err(Error::at(&self.place, thing, format!("it takes {}", list(known))))
            }
        }
    }

    /// An error if there is anything inside.
    pub(super) fn no_children(&self) -> Result<()> {
        match self.children.first() {
            None => Ok(()),
            Some(child) => {
                Err(Error::at(&child.place, format!("<{}> stands inside <{}>, which holds nothing", child.tag, self.tag), "move it out"))
            }
        }
    }
}

/// A scene file and what it includes.
#[derive(Debug)]
pub(super) struct Tree {
    pub(super) root: Element,
    /// Where `<path>` says to look for files.
    pub(super) search: Vec<PathBuf>,
    /// What was read as something else, a sentence for each file.
    pub(super) notes: Vec<String>,
}

/// Reads `text`, the content of the scene file `name`.
pub(super) fn read(text: &str, name: &Path, base: Option<&Path>, defines: &[(String, String)]) -> Result<Tree> {
    let (including, search, notes) = (Vec::new(), Vec::new(), Vec::new());
    let mut reader = Reader { defines: Defines::new(defines), base, including, search, count: 0, upgrade: None, notes };
    reader.including.extend(name.canonicalize().ok());
    let mut roots = Vec::new();
    reader.file(text, name, 0, &mut roots)?;
    let Some(root) = roots.pop() else {
        return Err(Error::in_file(name, "the file holds no element", "start it with <scene version=\"3.0.0\">"));
    };
    if root.tag != "scene" {
        return Err(Error::at(
            &root.place,
            format!("the outermost element is <{}>", root.tag),
            "put everything inside <scene version=\"3.0.0\">",
        ));
    }
    root.only(&["version"])?;
    reader.defines.check_used(name)?;
    Ok(Tree { root, search: reader.search, notes: reader.notes })
}

/// The text of a scene file.
pub(super) fn read_text(path: &Path, place: Option<&Place>) -> Result<String> {
    let fail = |thing: String, remedy: &str| match place {
        Some(place) => Error::at(place, format!("{}: {thing}", path.display()), remedy),
        None => Error::in_file(path, thing, remedy),
    };
    let found = std::fs::metadata(path).map_err(|e| fail(format!("cannot be read ({e})"), "check the path"))?;
    if !found.is_file() {
        return Err(fail("is not a file".into(), "name a Mitsuba 3 scene, such as scene.xml"));
    }
    if found.len() > MAX_BYTES {
        return Err(fail(format!("is larger than {} MiB", MAX_BYTES >> 20), "keep meshes in files of their own"));
    }
    let bytes = std::fs::read(path).map_err(|e| fail(format!("cannot be read ({e})"), "check its permissions"))?;
    String::from_utf8(bytes).map_err(|e| {
        let line = 1 + e.as_bytes()[..e.utf8_error().valid_up_to()].iter().filter(|&&b| b == b'\n').count();
        fail(format!("is not UTF-8 text (line {line})"), "name a Mitsuba 3 scene, an XML file in UTF-8")
    })
}

struct Reader<'a> {
    defines: Defines,
    base: Option<&'a Path>,
    including: Vec<PathBuf>,
    search: Vec<PathBuf>,
    count: u32,
    /// For the file that is being read, if it is an older one.
    upgrade: Option<Upgrade>,
    notes: Vec<String>,
}

impl Reader<'_> {
    /// Appends the root of a file to `out`.
    fn file(&mut self, text: &str, name: &Path, depth: usize, out: &mut Vec<Element>) -> Result<()> {
        if text.trim().is_empty() {
            return Err(Error::in_file(name, "the file is empty", "start it with <scene version=\"3.0.0\">"));
        }
        let document = roxmltree::Document::parse(text).map_err(|e| {
            let place = Place { file: name.to_owned(), position: Some((e.pos().row, e.pos().col)) };
            // Their message repeats the position at its end.
            let message = e.to_string();
            let message = message.rsplit_once(" at ").map_or(message.as_str(), |(m, _)| m);
            Error::at(&place, format!("broken XML: {message}"), "mend the file")
        })?;
        let places = Places { name, text, lines: text.match_indices('\n').map(|(at, _)| at + 1).collect(), last: Cell::new((0, 1)) };
        let root = document.root_element();
        let upgrade = upgrade_of(root, &places.of(root))?;
        let outer = std::mem::replace(&mut self.upgrade, upgrade);
        self.node(root, &places, depth, out)?;
        let upgrade = std::mem::replace(&mut self.upgrade, outer);
        self.notes.extend(upgrade.and_then(|upgrade| upgrade.note()));
        Ok(())
    }

    /// Appends what a node stands for to `out`.
    fn node(&mut self, node: roxmltree::Node, places: &Places, depth: usize, out: &mut Vec<Element>) -> Result<()> {
        if node.is_text() && node.text().is_some_and(|t| !t.trim().is_empty()) {
            return Err(Error::at(&places.of(node), "text between elements means nothing", "delete it, or make it a comment"));
        }
        if !node.is_element() {
            return Ok(());
        }
        let place = places.of(node);
        if depth > MAX_DEPTH {
            return Err(Error::at(&place, format!("elements nest more than {MAX_DEPTH} deep"), "flatten the scene"));
        }
        self.count += 1;
        if self.count > MAX_ELEMENTS {
            return Err(Error::at(&place, format!("the scene has more than {MAX_ELEMENTS} elements"), "keep meshes in files of their own"));
        }
        let attributes = node.attributes().map(|a| Ok((a.name().to_owned(), self.defines.apply(a.value(), &place)?)));
        let mut element = Element {
            tag: node.tag_name().name().to_owned(),
            attributes: attributes.collect::<Result<_>>()?,
            children: Vec::new(),
            place,
            serial: self.count,
        };
        for child in node.children() {
            self.node(child, places, depth + 1, &mut element.children)?;
        }
        match element.tag.as_str() {
            "default" => {
                element.only(&["name", "value"])?;
                element.no_children()?;
                self.defines.set_default(element.required("name")?, element.required("value")?.to_owned());
            }
            "path" => {
                element.only(&["value"])?;
                element.no_children()?;
                let folder = self.beside(&element)?.join(element.required("value")?);
                self.search.push(folder);
            }
            "include" => self.include(&element, depth, out)?,
            _ => {
                if let Some(upgrade) = &mut self.upgrade {
                    upgrade.element(&mut element)?;
                }
                out.push(element);
            }
        }
        Ok(())
    }

    fn include(&mut self, element: &Element, depth: usize, out: &mut Vec<Element>) -> Result<()> {
        element.only(&["filename"])?;
        element.no_children()?;
        let filename = element.required("filename")?;
        let mut folders = vec![self.beside(element)?];
        folders.extend(self.search.iter().cloned());
        let path = folders.iter().map(|f| f.join(filename)).find(|p| p.exists()).unwrap_or_else(|| folders[0].join(filename));
        let text = read_text(&path, Some(&element.place))?;
        let same = path.canonicalize().unwrap_or_else(|_| path.clone());
        if self.including.contains(&same) || self.including.len() > MAX_INCLUDES {
            let thing = format!("{filename} includes itself, or files include files more than {MAX_INCLUDES} deep");
            return Err(Error::at(&element.place, thing, "take this <include> out"));
        }
        self.including.push(same);
        let mut roots = Vec::new();
        self.file(&text, &path, depth + 1, &mut roots)?;
        self.including.pop();
        for root in roots {
            if root.tag == "scene" {
                out.extend(root.children);
            } else {
                out.push(Element { attributes: root.attributes.into_iter().filter(|(n, _)| n != "version").collect(), ..root });
            }
        }
        Ok(())
    }

    /// The folder that an element's file is in.
    fn beside(&self, element: &Element) -> Result<PathBuf> {
        if self.including.len() <= 1 {
            return self.base.map(Path::to_owned).ok_or_else(|| no_files(&element.place));
        }
        Ok(element.place.file.parent().unwrap_or(Path::new("")).to_owned())
    }
}

/// Where nodes stand.
struct Places<'a> {
    name: &'a Path,
    text: &'a str,
    /// Where each line but the first begins.
    lines: Vec<usize>,
    /// The last place, in bytes, and its column: nodes come in order, so a long line is counted just once.
    last: Cell<(usize, usize)>,
}

impl Places<'_> {
    fn of(&self, node: roxmltree::Node) -> Place {
        let at = node.range().start.min(self.text.len());
        let line = self.lines.partition_point(|&start| start <= at);
        let start = if line == 0 { 0 } else { self.lines[line - 1] };
        let (from, before) = match self.last.get() {
            (last, column) if (start..=at).contains(&last) => (last, column),
            _ => (start, 1),
        };
        let column = before + self.text.get(from..at).map_or(0, |t| t.chars().count());
        self.last.set((at, column));
        Place { file: self.name.to_owned(), position: Some((line as u32 + 1, column as u32)) }
    }
}

/// An embedded scene named a file.
pub(super) fn no_files(place: &Place) -> Error {
    Error::at(place, "this scene is not in a folder, so it cannot name files", "save it to a file first")
}

/// What a file of that version needs; nothing if it is one of today.
fn upgrade_of(root: roxmltree::Node, place: &Place) -> Result<Option<Upgrade>> {
    let remedy = "write <scene version=\"3.0.0\">; bidir reads the scenes of Mitsuba 3, and those of 0.4 to 0.6 as far as Mitsuba 3 does";
    let Some(version) = root.attribute("version") else {
        return Err(Error::at(place, format!("<{}> does not say its version", root.tag_name().name()), remedy));
    };
    let parts: Option<Vec<u32>> = version.split('.').map(|p| p.trim().parse().ok()).collect();
    match parts.as_deref() {
        Some([2 | 3, _, _]) => Ok(None),
        Some([0 | 1, _, _]) => Ok(Some(Upgrade::new(place.clone(), version))),
        Some([major, minor]) => {
            let thing = format!("version \"{version}\" of the scene language is not supported: it has three numbers");
            Err(Error::at(place, thing, format!("write {major}.{minor}.0")))
        }
        _ => Err(Error::at(place, format!("version \"{version}\" of the scene language is not supported"), remedy)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_here(text: &str, folder: &Path) -> Result<Tree> {
        read(text, &folder.join("main.xml"), Some(folder), &[])
    }

    fn message(text: &str) -> String {
        read(text, Path::new("s.xml"), None, &[]).unwrap_err().to_string()
    }

    #[test]
    fn places_count_lines_and_characters_from_one() {
        let tree = read("<scene version=\"3.0.0\">\n  <!-- ä --><shape type=\"cube\"/></scene>", Path::new("s.xml"), None, &[]).unwrap();
        assert_eq!(tree.root.children[0].place.position, Some((2, 13)));
    }

    #[test]
    fn broken_xml_is_one_error_with_its_place() {
        assert!(message("<scene version=\"3.0.0\">\n<shape></scene>").starts_with("s.xml:2:"));
        assert!(message("").contains("empty"));
        assert!(message("hello").contains("broken XML"));
    }

    #[test]
    fn deep_nesting_is_refused_without_using_up_the_stack() {
        for depth in [100, 1_000_000] {
            let text = format!("<scene version=\"3.0.0\">{}{}</scene>", "<bsdf>".repeat(depth), "</bsdf>".repeat(depth));
            assert!(message(&text).contains("nest more than"));
        }
    }

    #[test]
    fn unknown_versions_are_refused() {
        for version in ["0.6", "3.0", "4.0.0", "x"] {
            assert!(message(&format!("<scene version=\"{version}\"/>")).contains("not supported"));
        }
        assert!(message("<scene/>").contains("does not say its version"));
    }

    #[test]
    fn an_included_file_keeps_its_own_places_and_gives_its_defaults() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(
            folder.path().join("a.xml"),
            "<scene version=\"3.0.0\">\n<default name=\"t\" value=\"cube\"/><shape type=\"disk\"/></scene>",
        )
        .unwrap();
        let tree = read_here("<scene version=\"3.0.0\"><include filename=\"a.xml\"/><shape type=\"$t\"/></scene>", folder.path()).unwrap();
        assert_eq!(tree.root.children[0].place, Place { file: folder.path().join("a.xml"), position: Some((2, 33)) });
        assert_eq!(tree.root.children[1].attribute("type"), Some("cube"));
    }

    #[test]
    fn each_file_has_its_own_version() {
        let folder = tempfile::tempdir().unwrap();
        let shape = "<shape type=\"disk\"><transform name=\"toWorld\"/></shape>";
        std::fs::write(folder.path().join("old.xml"), format!("<scene version=\"0.5.0\">{shape}</scene>")).unwrap();
        let tree = read_here(&format!("<scene version=\"3.0.0\"><include filename=\"old.xml\"/>{shape}</scene>"), folder.path()).unwrap();
        let name = |i: usize| tree.root.children[i].children[0].attribute("name");
        assert_eq!((name(0), name(1)), (Some("to_world"), Some("toWorld")));
        assert_eq!(tree.notes.len(), 1);
    }

    #[test]
    fn a_file_that_includes_itself_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let text = "<scene version=\"3.0.0\"><include filename=\"main.xml\"/></scene>";
        std::fs::write(folder.path().join("main.xml"), text).unwrap();
        assert!(read_here(text, folder.path()).unwrap_err().to_string().contains("includes itself"));
    }
}
