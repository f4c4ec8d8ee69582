//! Scenes written for Mitsuba 0.5 and 0.6, read as Mitsuba 3 reads them: parameters in camelCase are those of today, and a texture's
//! `uoffset` … `vscale` are its `to_uv`. What else is renamed or left out here means the same; everything that does not is refused as it
//! is in a scene of today.

mod colour;

use super::{catalog, properties::OBJECTS, xml::Element};
use crate::error::{Place, Result};

/// Types by another name: those that differ in how the picture is written, or in which numbers are drawn.
const TYPES: [(&str, &str, &str); 13] = [
    ("film", "ldrfilm", "hdrfilm"),
    ("sampler", "halton", "independent"),
    ("sampler", "hammersley", "independent"),
    ("sampler", "sobol", "independent"),
    // Of integrators the depths count, and which techniques run is not theirs to say.
    ("integrator", "bdpt", "path"),
    ("integrator", "mlt", "path"),
    ("integrator", "pssmlt", "path"),
    ("integrator", "erpt", "path"),
    ("integrator", "ppm", "path"),
    ("integrator", "sppm", "path"),
    ("integrator", "photonmapper", "path"),
    ("integrator", "vpl", "path"),
    ("integrator", "volpath_simple", "volpath"),
];

/// Parameters, spelled as today, that change no image here, by element and type; "" is any.
const WITHOUT_EFFECT: [(&str, &str, &[&str]); 6] = [
    // A direction on different sides of the true and of the shading normal is always refused.
    ("integrator", "", &["strict_normals"]),
    ("sampler", "", &["scramble", "dimension"]),
    ("film", "", &["attach_log"]),
    ("film", "ldrfilm", &["gamma", "exposure", "key", "burn", "tonemap_method", "file_format"]),
    ("texture", "bitmap", &["cache", "max_anisotropy"]),
    ("emitter", "envmap", &["cache"]),
];

/// What was read of an older file as something else.
#[derive(Debug)]
pub(super) struct Upgrade {
    /// Of the root.
    place: Place,
    version: String,
    renamed: Vec<Change>,
    left_out: Vec<Change>,
}

/// The first time that something was changed.
#[derive(Debug)]
struct Change {
    old: String,
    new: String,
    line: u32,
}

impl Upgrade {
    /// For a file with that root.
    pub(super) fn new(place: Place, version: &str) -> Self {
        Self { place, version: version.trim().to_owned(), renamed: Vec::new(), left_out: Vec::new() }
    }

    /// What to tell the user, if anything was changed.
    pub(super) fn note(&self) -> Option<String> {
        let at = |change: &Change| format!("{} (line {})", change.old, change.line);
        let renamed = in_order(&self.renamed).into_iter().enumerate().map(|(i, change)| {
            let is_read = if i == 0 { "is read " } else { "" };
            format!("{} {is_read}as {}", at(change), change.new)
        });
        let renamed = renamed.collect::<Vec<_>>().join(", ");
        let left_out = in_order(&self.left_out).into_iter().map(at).collect::<Vec<_>>().join(", ");
        let left_out = if left_out.is_empty() { left_out } else { format!("without effect: {left_out}") };
        let both = [renamed, left_out].into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join("; ");
        (!both.is_empty()).then(|| format!("{}: written for Mitsuba {}: {both}", self.place.file.display(), self.version))
    }

    /// Makes an element, which holds all that it will, one of today.
    pub(super) fn element(&mut self, element: &mut Element) -> Result<()> {
        match element.tag.as_str() {
            "lookAt" => {
                self.renamed("lookAt", "lookat", &element.place);
                element.tag = "lookat".into();
            }
            "srgb" => {
                let linear = colour::linear(element.required("value")?, &element.place)?;
                self.renamed("srgb", "linear rgb", &element.place);
                set(element, "value", linear);
                element.tag = "rgb".into();
            }
            "spectrum" if element.attribute("value").is_some_and(colour::is_triple) => {
                self.renamed("spectrum of three numbers", "rgb", &element.place);
                element.tag = "rgb".into();
            }
            tag if OBJECTS.contains(&tag) => self.object(element),
            _ => {}
        }
        Ok(())
    }

    fn object(&mut self, element: &mut Element) {
        let (tag, kind) = (element.tag.clone(), element.attribute("type").unwrap_or("").to_owned());
        let known = catalog::entries().any(|entry| entry.tag == tag && entry.name == kind);
        // A module's parameters are called what its manifest calls them.
        if matches!(tag.as_str(), "bsdf" | "emitter") && !known {
            return;
        }
        self.leave_out(element, &tag, &kind);
        for child in &mut element.children {
            let Some(old) = child.attribute("name").map(str::to_owned) else { continue };
            let new = match underscored(&old) {
                new if kind == "diffuse" && new == "diffuse_reflectance" => "reflectance".into(),
                new => new,
            };
            if new != old {
                self.renamed(&old, &new, &child.place);
                set(child, "name", new);
            }
        }
        if tag == "texture" {
            self.offset_and_scale(element);
            self.bitmap(element);
        }
        if let Some((_, old, new)) = TYPES.into_iter().find(|(of, old, _)| *of == tag && *old == kind) {
            self.renamed(old, new, &element.place);
            set(element, "type", new.into());
            if tag == "integrator" {
                self.keep_depths(element);
            }
        }
    }

    /// What else an integrator says is about techniques.
    fn keep_depths(&mut self, element: &mut Element) {
        element.children.retain(|child| {
            let name = child.attribute("name").unwrap_or("");
            let kept = ["max_depth", "rr_depth", "hide_emitters"].contains(&underscored(name).as_str());
            if !kept {
                note(&mut self.left_out, name, "", &child.place);
            }
            kept
        });
    }

    fn leave_out(&mut self, element: &mut Element, tag: &str, kind: &str) {
        let rows = WITHOUT_EFFECT.into_iter().filter(|(of, only, _)| *of == tag && ["", kind].contains(only));
        let names: Vec<&str> = rows.flat_map(|(.., names)| names).copied().collect();
        element.children.retain(|child| {
            let Some(name) = child.attribute("name").filter(|name| names.contains(&underscored(name).as_str())) else { return true };
            note(&mut self.left_out, name, "", &child.place);
            false
        });
    }

    /// As Mitsuba 3 has it, the offset is scaled too.
    fn offset_and_scale(&mut self, element: &mut Element) {
        let taken = |name: &str| {
            element
                .children
                .iter()
                .position(|child| ["float", "integer"].contains(&child.tag.as_str()) && child.attribute("name") == Some(name))
        };
        let found = ["uoffset", "voffset", "uscale", "vscale"].map(taken);
        let Some(first) = found.into_iter().flatten().min() else { return };
        let value = |at: Option<usize>| at.and_then(|at| element.children[at].attribute("value")).map(str::to_owned);
        let [u, v, across, down] = found.map(value);
        let place = element.children[first].place.clone();
        for at in found.into_iter().flatten() {
            let child = &element.children[at];
            self.renamed(child.attribute("name").unwrap_or(""), "to_uv", &child.place);
        }
        let step = |tag: &str, x: Option<String>, y: Option<String>| {
            let attributes = [("x", x), ("y", y)].into_iter().filter_map(|(name, value)| Some((name.to_owned(), value?)));
            Element { tag: tag.into(), attributes: attributes.collect(), children: Vec::new(), place: place.clone(), serial: 0 }
        };
        let steps = vec![step("translate", u, v), step("scale", across, down)];
        let attributes = vec![("name".to_owned(), "to_uv".to_owned())];
        element.children[first] = Element { tag: "transform".into(), attributes, children: steps, place: place.clone(), serial: 0 };
        let mut at = 0;
        element.children.retain(|_| {
            at += 1;
            !found.contains(&Some(at - 1)) || at - 1 == first
        });
    }

    /// A `gamma` of 1 is linear, and one of −1 is the file's own; between texels there is one way for all that filtered.
    fn bitmap(&mut self, element: &mut Element) {
        element.children.retain_mut(|child| {
            let value = child.attribute("value").unwrap_or("").trim().to_owned();
            match child.attribute("name") {
                Some("gamma") if value.parse::<f64>() == Ok(-1.0) => {
                    note(&mut self.left_out, "gamma", "", &child.place);
                    return false;
                }
                Some("gamma") if value.parse::<f64>() == Ok(1.0) => {
                    note(&mut self.renamed, "gamma 1", "raw", &child.place);
                    child.tag = "boolean".into();
                    child.attributes = [("name", "raw"), ("value", "true")].map(|(name, value)| (name.to_owned(), value.to_owned())).into();
                }
                Some("filter_type") if ["ewa", "trilinear"].contains(&value.as_str()) => {
                    note(&mut self.renamed, &value, "bilinear", &child.place);
                    set(child, "value", "bilinear".into());
                }
                _ => {}
            }
            true
        });
    }

    fn renamed(&mut self, old: &str, new: &str, place: &Place) {
        note(&mut self.renamed, old, new, place);
    }
}

/// As they stand in the file: what is inside an element is changed before what it stands in.
fn in_order(changes: &[Change]) -> Vec<&Change> {
    let mut changes: Vec<_> = changes.iter().collect();
    changes.sort_by_key(|change| change.line);
    changes
}

/// Keeps a change, unless it was made before.
fn note(changes: &mut Vec<Change>, old: &str, new: &str, place: &Place) {
    if !changes.iter().any(|change| change.old == old && change.new == new) {
        let line = place.position.map_or(0, |(line, _)| line);
        changes.push(Change { old: old.into(), new: new.into(), line });
    }
}

fn set(element: &mut Element, name: &str, value: String) {
    element.attributes.retain(|(n, _)| n != name);
    element.attributes.push((name.into(), value));
}

/// camelCase as camel_case, a run of capitals as one word.
fn underscored(name: &str) -> String {
    let mut out = String::with_capacity(name.len() + 4);
    let (mut before, mut in_run) = (' ', false);
    for c in name.chars() {
        let starts = before.is_ascii_lowercase() && c.is_ascii_uppercase();
        in_run = starts || in_run && c.is_ascii_uppercase();
        if starts {
            out.push('_');
        }
        out.push(if in_run { c.to_ascii_lowercase() } else { c });
        before = c;
    }
    out
}

#[cfg(test)]
mod tests;
