//! `<shape type="merge">`: shapes that stand where it stands. Mitsuba makes one mesh of those that are alike, for speed; the image is the
//! same without.

use super::{
    context::Context,
    properties::{Properties, line},
    xml::Element,
};
use crate::error::{Error, Result};

/// How deep merges may stand in each other, references followed.
pub(super) const MAX_DEPTH: usize = 16;

/// What stands in a merge.
pub(super) fn shapes<'e, 's: 'e>(context: &mut Context<'s>, element: &'e Element) -> Result<Vec<&'e Element>> {
    let of = Properties::read(element, &context.ids)?;
    of.refuse("to_world", "give it to the shapes inside, or put them into a shapegroup and show it by an instance")?;
    for (tag, thing) in [("bsdf", "a merge has no material of its own"), ("emitter", "a merge does not shine itself")] {
        if let Some(inner) = of.objects(tag).first() {
            return Err(Error::at(&inner.place, thing, "put it on the shapes inside"));
        }
    }
    let inside = of.objects("shape");
    of.finish()?;
    // Twice in one place, or in itself.
    if !context.merged.insert(element.serial) {
        let thing = format!("the merge on line {} is referred to from within itself, or twice", line(&element.place));
        return Err(Error::at(&element.place, thing, "take one of the references out, or use a shapegroup and instances"));
    }
    if context.merges_open >= MAX_DEPTH {
        return Err(Error::at(&element.place, format!("merges stand in each other more than {MAX_DEPTH} deep"), "flatten them"));
    }
    Ok(inside)
}
