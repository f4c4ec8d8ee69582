//! What the program reads, and what it knows of and does not.

use std::collections::BTreeMap;

use crate::load::{
    catalog::{Entry, entries},
    gltf::extension::{EXTENSIONS, Support},
};

/// Of one element: the types that are read, and those that are not, each with what to do instead.
#[derive(Clone, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub(super) struct Types {
    supported: Vec<&'static str>,
    unsupported: BTreeMap<&'static str, &'static str>,
}

/// By element.
pub(super) fn by_tag() -> BTreeMap<&'static str, Types> {
    let mut all: BTreeMap<&'static str, Types> = BTreeMap::new();
    for Entry { tag, name, instead } in entries() {
        let types = all.entry(tag).or_default();
        match instead {
            None => types.supported.push(name),
            Some(instead) => {
                types.unsupported.insert(name, instead);
            }
        }
    }
    all
}

/// As a table, in the catalog's order.
pub(super) fn list() -> String {
    let mut tags: Vec<&str> = Vec::new();
    for Entry { tag, .. } in entries() {
        if !tags.contains(&tag) {
            tags.push(tag);
        }
    }
    let all = by_tag();
    let mut lines = vec!["This program reads Mitsuba 3's XML with these types:".to_owned(), String::new()];
    for tag in &tags {
        let supported = &all[tag].supported;
        let words = if supported.is_empty() { "none".to_owned() } else { supported.join(", ") };
        lines.push(format!("  {tag:<11} {words}"));
    }
    lines.extend([String::new(), "It knows these, and refuses them:".to_owned(), String::new()]);
    for tag in &tags {
        for (instead, names) in groups(tag) {
            lines.push(format!("  {tag:<11} {}: {instead}", names.join(", ")));
        }
    }
    let read = EXTENSIONS.iter().filter(|(_, support)| !matches!(support, Support::LeftOut(_))).map(|(name, _)| *name);
    let heading = "It reads glTF 2.0 too (.gltf, .glb), with these extensions; what is left out is listed where it is met:";
    lines.extend([String::new(), heading.to_owned(), String::new()]);
    lines.extend(read.map(|name| format!("  {name}")));
    lines.extend([String::new(), "Anything else is an error that says where it stands and what there is.".to_owned()]);
    lines.join("\n")
}

/// The types that are refused, with those of one remedy side by side.
fn groups(tag: &str) -> Vec<(&'static str, Vec<&'static str>)> {
    let mut groups: Vec<(&'static str, Vec<&'static str>)> = Vec::new();
    for entry in entries().filter(|entry| entry.tag == tag) {
        let Some(instead) = entry.instead else { continue };
        match groups.iter_mut().find(|(known, _)| *known == instead) {
            Some((_, names)) => names.push(entry.name),
            None => groups.push((instead, vec![entry.name])),
        }
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_entry_is_listed() {
        let (words, all) = (list(), by_tag());
        for Entry { tag, name, instead } in entries() {
            assert!(words.contains(name), "{name}");
            assert_eq!(all[tag].supported.contains(&name), instead.is_none());
            assert_eq!(all[tag].unsupported.get(name).copied(), instead);
        }
    }
}
