//! What `<ref id>` and `<alias>` mean.

use std::collections::HashMap;

use super::{
    properties::{OBJECTS, line},
    suggest::did_you_mean,
    xml::Element,
};
use crate::error::{Error, Place, Result};

/// Objects by their ids, wherever in the scene they stand.
#[derive(Debug, Default)]
pub(super) struct Ids<'s>(HashMap<&'s str, &'s Element>);

impl<'s> Ids<'s> {
    /// Every id of a scene.
    pub(super) fn collect(root: &'s Element) -> Result<Self> {
        let mut ids = Self::default();
        ids.objects(root)?;
        for alias in root.children.iter().filter(|e| e.tag == "alias") {
            alias.only(&["id", "as"])?;
            alias.no_children()?;
            let object = ids.find(alias.required("id")?, &alias.place)?;
            ids.insert(alias.required("as")?, object, &alias.place)?;
        }
        Ok(ids)
    }

    /// The object with this id.
    pub(super) fn find(&self, id: &str, place: &Place) -> Result<&'s Element> {
        self.0.get(id).copied().ok_or_else(|| {
            let mut known: Vec<&str> = self.0.keys().copied().collect();
            known.sort_unstable();
            Error::at(
                place,
                format!("nothing in the scene has the id \"{id}\""),
                format!("{}give one the id=\"{id}\"", did_you_mean(id, &known)),
            )
        })
    }

    fn objects(&mut self, element: &'s Element) -> Result<()> {
        if OBJECTS.contains(&element.tag.as_str())
            && let Some(id) = element.attribute("id")
        {
            self.insert(id, element, &element.place)?;
        }
        element.children.iter().try_for_each(|child| self.objects(child))
    }

    fn insert(&mut self, id: &'s str, object: &'s Element, place: &Place) -> Result<()> {
        match self.0.insert(id, object) {
            None => Ok(()),
            Some(first) => {
                let thing = format!("the id \"{id}\" is taken, on line {}", line(&first.place));
                Err(Error::at(place, thing, "give one of them another"))
            }
        }
    }
}
