//! What stands inside an element, typed, each entry remembering whether anybody asked for it.

use std::{
    cell::{Cell, RefCell},
    collections::HashMap,
};

use bidir_kernel::{BANDS, Spectrum};
use glam::{DAffine3, DVec3};

use super::{
    ids::Ids,
    suggest::{did_you_mean, list},
    transform, value,
    xml::Element,
};
use crate::error::{Error, Place, Result};

/// Elements that make something of a plugin.
pub(super) const OBJECTS: [&str; 14] = [
    "scene",
    "integrator",
    "sensor",
    "film",
    "rfilter",
    "sampler",
    "bsdf",
    "texture",
    "shape",
    "emitter",
    "medium",
    "phase",
    "volume",
    "subsurface",
];
/// Light alike at every wavelength, in linear sRGB: what a `<spectrum>` of 1 is where it is light and no reflectance.
const EQUAL_ENERGY: [f32; BANDS] = [1.204_794, 0.948_291, 0.908_916];

const PLAIN: [&str; 9] = ["float", "integer", "boolean", "string", "rgb", "spectrum", "point", "vector", "transform"];

/// Elements of Mitsuba before 3, and what to write today.
const FORMERLY: [(&str, &str); 4] = [
    ("luminaire", "<emitter>"),
    ("camera", "<sensor>"),
    ("blackbody", "<rgb> with the colour that it has"),
    ("srgb", "<rgb> with linear numbers"),
];

/// What a property holds.
#[derive(Debug)]
pub(super) enum Value<'s> {
    Float(f64),
    Integer(i64),
    Boolean(bool),
    Text(String),
    Color(Spectrum),
    Vector(DVec3),
    Transform(DAffine3),
    Object(&'s Element),
}

#[derive(Debug)]
struct Property<'s> {
    name: Option<&'s str>,
    value: Value<'s>,
    element: &'s Element,
    used: Cell<bool>,
}

/// An element's properties and nested objects.
#[derive(Debug)]
pub(super) struct Properties<'s> {
    element: &'s Element,
    entries: Vec<Property<'s>>,
    /// Every name that was asked for: the parameters there are.
    known: RefCell<Vec<String>>,
}

impl<'s> Properties<'s> {
    /// Reads what stands inside `element`; what is ill-formed is an error now, what is unknown once [`Self::finish`] is called.
    pub(super) fn read(element: &'s Element, ids: &Ids<'s>) -> Result<Self> {
        if element.tag != "scene" {
            element.only(&["type", "id", "name"])?;
            element.required("type")?;
        }
        let mut entries: Vec<Property> = Vec::with_capacity(element.children.len());
        let mut named = HashMap::new();
        for child in element.children.iter().filter(|child| child.tag != "alias") {
            let name = child.attribute("name");
            if let Some(name) = name
                && let Some(first) = named.insert(name, &child.place)
            {
                let thing = format!("\"{name}\" is given twice, first on line {}", line(first));
                return Err(Error::at(&child.place, thing, "keep one of them"));
            }
            let value = read_value(child, ids)?;
            entries.push(Property { name, value, element: child, used: Cell::new(false) });
        }
        Ok(Self { element, entries, known: RefCell::new(Vec::new()) })
    }

    /// The `type`.
    pub(super) fn kind(&self) -> &'s str {
        self.element.attribute("type").unwrap_or("")
    }

    /// Whether everything inside has a name, and each is such a one.
    pub(super) fn are_all(&self, known: impl Fn(&str) -> bool) -> bool {
        self.entries.iter().all(|entry| entry.name.is_some_and(&known))
    }

    /// Where the element stands.
    pub(super) fn place(&self) -> &'s Place {
        &self.element.place
    }

    /// What the element is called in messages.
    pub(super) fn label(&self) -> String {
        match self.kind() {
            "" => "the scene".into(),
            kind => format!("{} \"{kind}\"", self.element.tag),
        }
    }

    /// Where a parameter stands, or the element if it is absent.
    pub(super) fn place_of(&self, name: &str) -> &'s Place {
        self.entries.iter().find(|e| e.name == Some(name)).map_or(&self.element.place, |e| &e.element.place)
    }

    /// An error about a parameter.
    pub(super) fn error(&self, name: &str, thing: impl std::fmt::Display, remedy: impl Into<String>) -> Error {
        Error::at(self.place_of(name), format!("{name} of {} {thing}", self.label()), remedy)
    }

    /// A parameter of any type.
    pub(super) fn any(&self, name: &str) -> Option<&Value<'s>> {
        if !self.known.borrow().iter().any(|known| known == name) {
            self.known.borrow_mut().push(name.to_owned());
        }
        let entry = self.entries.iter().find(|e| e.name == Some(name))?;
        entry.used.set(true);
        Some(&entry.value)
    }

    /// Whether a parameter is written.
    pub(super) fn has(&self, name: &str) -> bool {
        self.any(name).is_some()
    }

    /// A number.
    pub(super) fn float(&self, name: &str) -> Result<Option<f64>> {
        match self.any(name) {
            None => Ok(None),
            Some(Value::Float(v)) => Ok(Some(*v)),
            Some(Value::Integer(v)) => Ok(Some(*v as f64)),
            Some(other) => Err(self.wrong_type(name, other, "float")),
        }
    }

    /// A number above 0.
    pub(super) fn positive(&self, name: &str) -> Result<Option<f64>> {
        match self.float(name)? {
            // Smaller ones are 0 in f32.
            Some(v) if v < 1e-30 => Err(self.error(name, format!("is {v:e}"), "it must lie above 0 (1e-30 … 1e30)")),
            other => Ok(other),
        }
    }

    /// A whole number that is at least `least`.
    pub(super) fn whole(&self, name: &str, least: i64) -> Result<Option<i64>> {
        match self.any(name) {
            None => Ok(None),
            Some(Value::Integer(v)) if *v < least || *v > i64::from(u32::MAX) => {
                Err(self.error(name, format!("is {v}"), format!("it must lie within {least} … {}", u32::MAX)))
            }
            Some(Value::Integer(v)) => Ok(Some(*v)),
            Some(other) => Err(self.wrong_type(name, other, "integer")),
        }
    }

    /// True or false.
    pub(super) fn boolean(&self, name: &str) -> Result<Option<bool>> {
        match self.any(name) {
            None => Ok(None),
            Some(Value::Boolean(v)) => Ok(Some(*v)),
            Some(other) => Err(self.wrong_type(name, other, "boolean")),
        }
    }

    /// A text.
    pub(super) fn text(&self, name: &str) -> Result<Option<&str>> {
        match self.any(name) {
            None => Ok(None),
            Some(Value::Text(v)) => Ok(Some(v)),
            Some(other) => Err(self.wrong_type(name, other, "string")),
        }
    }

    /// One word out of several, in any case; the first where it is not written.
    pub(super) fn choice<T: Copy>(&self, name: &str, words: &[(&str, T)]) -> Result<T> {
        let Some(text) = self.text(name)? else { return Ok(words[0].1) };
        let found = words.iter().find(|(word, _)| word.eq_ignore_ascii_case(text.trim()));
        let names: Vec<&str> = words.iter().map(|(word, _)| *word).collect();
        found.map(|(_, value)| *value).ok_or_else(|| {
            let remedy = format!("{}there are {}", did_you_mean(text, &names), list(&names));
            self.error(name, format!("is \"{text}\""), remedy)
        })
    }

    /// A text that must be there.
    pub(super) fn required_text(&self, name: &str) -> Result<&str> {
        self.text(name)?.ok_or_else(|| self.missing(name, "string"))
    }

    /// A colour: one number or one for each band.
    pub(super) fn color(&self, name: &str) -> Result<Option<Spectrum>> {
        match self.any(name) {
            None => Ok(None),
            Some(Value::Color(v)) => Ok(Some(*v)),
            Some(Value::Float(v)) => Ok(Some(value::spectrum([*v; BANDS]))),
            Some(Value::Integer(v)) => Ok(Some(value::spectrum([*v as f64; BANDS]))),
            Some(Value::Object(object)) if object.tag == "texture" => {
                Err(self.error(name, "is a texture, which is not supported here", "write <rgb> or <float>"))
            }
            Some(other) => Err(self.wrong_type(name, other, "rgb")),
        }
    }

    /// How much light something gives; 1 in every band where it is not written.
    pub(super) fn radiance(&self, name: &str) -> Result<Spectrum> {
        let mut color = self.color(name)?.unwrap_or(Spectrum::ONE);
        if self.entries.iter().any(|property| property.name == Some(name) && property.element.tag == "spectrum") {
            (0..BANDS).for_each(|band| color.0[band] *= EQUAL_ENERGY[band]);
        }
        if color.0.iter().any(|v| *v < 0.0) {
            return Err(self.error(name, "is negative", "light cannot be less than 0"));
        }
        Ok(color)
    }

    /// A point or a direction.
    pub(super) fn vector(&self, name: &str) -> Result<Option<DVec3>> {
        match self.any(name) {
            None => Ok(None),
            Some(Value::Vector(v)) => Ok(Some(*v)),
            Some(other) => Err(self.wrong_type(name, other, "point")),
        }
    }

    /// A transform; the identity where it is not written.
    pub(super) fn transform(&self, name: &str) -> Result<DAffine3> {
        match self.any(name) {
            None => Ok(DAffine3::IDENTITY),
            Some(Value::Transform(v)) => Ok(*v),
            Some(other) => Err(self.wrong_type(name, other, "transform")),
        }
    }

    /// Nested objects of one kind, named or not.
    pub(super) fn objects(&self, tag: &str) -> Vec<&'s Element> {
        let fits = |e: &&Property<'s>| matches!(e.value, Value::Object(o) if o.tag == tag) && !e.used.get();
        let found = self.entries.iter().filter(fits).filter_map(|e| match e.value {
            Value::Object(object) => {
                e.used.set(true);
                Some(object)
            }
            _ => None,
        });
        found.collect()
    }

    /// The one nested object of a kind, if there is one.
    pub(super) fn object(&self, tag: &str) -> Result<Option<&'s Element>> {
        let all = self.objects(tag);
        match all.as_slice() {
            [] => Ok(None),
            [one] => Ok(Some(one)),
            [_, second, ..] => Err(Error::at(&second.place, format!("{} has more than one <{tag}>", self.label()), "keep one of them")),
        }
    }

    /// A parameter that Mitsuba has and that cannot be passed over.
    pub(super) fn refuse(&self, name: &str, remedy: &str) -> Result<()> {
        if self.entries.iter().any(|e| e.name == Some(name)) {
            return Err(self.error(name, "is not supported", remedy));
        }
        Ok(())
    }

    /// Parameters that Mitsuba has and that change no image here.
    pub(super) fn pass_over(&self, names: &[&str]) {
        for name in names {
            self.any(name);
        }
    }

    /// A parameter is missing.
    pub(super) fn missing(&self, name: &str, tag: &str) -> Error {
        Error::at(
            self.place(),
            format!("{} needs a \"{name}\"", self.label()),
            format!("write <{tag} name=\"{name}\" value=\"…\"/> inside it"),
        )
    }

    /// An error if something is there that nobody asked for.
    pub(super) fn finish(self) -> Result<()> {
        let Some(entry) = self.entries.iter().find(|e| !e.used.get()) else { return Ok(()) };
        let known = self.known.borrow();
        let known: Vec<&str> = known.iter().map(String::as_str).collect();
        let place = &entry.element.place;
        let owner = self.label();
        match (&entry.value, entry.name) {
            (Value::Object(object), _) if !known.iter().any(|k| Some(*k) == entry.name) && entry.name.is_none() => {
                let thing = format!("a <{}> means nothing inside {owner}", object.tag);
                Err(Error::at(place, thing, "take it out, or give it the name of a parameter"))
            }
            (_, name) => {
                let name = name.unwrap_or("");
                let thing = format!("{owner} has no parameter \"{name}\"");
                let has = if known.is_empty() { "it has none".into() } else { format!("it has {}", list(&known)) };
                Err(Error::at(place, thing, format!("{}{has}", did_you_mean(name, &known))))
            }
        }
    }

    pub(super) fn wrong_type(&self, name: &str, value: &Value, tag: &str) -> Error {
        let is = match value {
            Value::Float(_) => "a float",
            Value::Integer(_) => "an integer",
            Value::Boolean(_) => "a boolean",
            Value::Text(_) => "a string",
            Value::Color(_) => "a colour",
            Value::Vector(_) => "a point or vector",
            Value::Transform(_) => "a transform",
            Value::Object(object) => {
                return self.error(name, format!("is a <{}>", object.tag), format!("write <{tag} name=\"{name}\" …/>"));
            }
        };
        self.error(name, format!("is {is}"), format!("write <{tag} name=\"{name}\" …/>"))
    }
}

/// The line of a place, for messages.
pub(super) fn line(place: &Place) -> u32 {
    place.position.map_or(0, |(line, _)| line)
}

fn read_value<'s>(child: &'s Element, ids: &Ids<'s>) -> Result<Value<'s>> {
    let tag = child.tag.as_str();
    let place = &child.place;
    if tag == "ref" {
        child.only(&["id", "name"])?;
        child.no_children()?;
        return Ok(Value::Object(ids.find(child.required("id")?, place)?));
    }
    if OBJECTS.contains(&tag) {
        return Ok(Value::Object(child));
    }
    if tag == "spectrum" && child.attribute("type").is_some() {
        return Err(Error::at(place, "spectrum plugins are not supported", "write <rgb> with three numbers"));
    }
    if !PLAIN.contains(&tag) {
        let known = [&PLAIN[..], &OBJECTS[1..], &["ref", "default", "include", "alias", "path"]].concat();
        let remedy = match FORMERLY.iter().find(|(old, _)| *old == tag) {
            Some((_, now)) => format!("write {now}"),
            None => format!("{}there are {}", did_you_mean(tag, &known), list(&known)),
        };
        return Err(Error::at(place, format!("<{tag}> is unknown here"), remedy));
    }
    child.required("name")?;
    if tag != "transform" {
        child.no_children()?;
    }
    match tag {
        "point" | "vector" => {
            child.only(&["name", "value", "x", "y", "z"])?;
            return value::vector(child, None).map(Value::Vector);
        }
        "transform" => {
            child.only(&["name"])?;
            return transform::read(child).map(Value::Transform);
        }
        "spectrum" => {
            child.only(&["name", "value", "filename"])?;
            return value::uniform(child).map(Value::Color);
        }
        _ => child.only(&["name", "value"])?,
    }
    let text = child.required("value")?;
    match tag {
        "float" => value::float(text, place).map(Value::Float),
        "integer" => value::integer(text, place).map(Value::Integer),
        "boolean" => value::boolean(text, place).map(Value::Boolean),
        "rgb" => value::color(text, place).map(Value::Color),
        _ => Ok(Value::Text(text.to_owned())),
    }
}
