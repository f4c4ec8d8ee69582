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

#[cfg(test)]
mod tests {
    use std::path::Path;

    use crate::{
        error::Result,
        load::{Loaded, load_str},
        plugin::Library,
    };

    fn read(content: &str) -> Result<Loaded> {
        let text = format!("<scene version=\"3.0.0\"><sensor type=\"perspective\"/>{content}</scene>");
        load_str(&text, Path::new("s.xml"), None, &[], &Library::default())
    }

    #[test]
    fn what_a_merge_holds_stands_where_the_merge_does() {
        let inner = "<shape type=\"merge\"><shape type=\"cube\"/><shape type=\"merge\"><shape type=\"disk\"/></shape></shape>";
        let group = format!("<shape type=\"shapegroup\" id=\"g\">{inner}</shape>");
        let scene = read(&format!("{group}<shape type=\"merge\">{inner}<shape type=\"instance\"><ref id=\"g\"/></shape></shape>"))
            .unwrap()
            .description;
        assert_eq!((scene.shapes.len(), scene.instances.len(), scene.groups[0].shapes.len()), (2, 1, 2));
    }

    #[test]
    fn what_would_mean_something_else_is_refused() {
        let deep = |levels: usize| {
            let of = |i: usize| format!("<shape type=\"merge\" id=\"m{i}\"><ref id=\"m{}\"/></shape>", i + 1);
            let inner: String = (1..levels).map(of).collect();
            format!("<shape type=\"shapegroup\"><ref id=\"m1\"/></shape>{inner}<shape type=\"merge\" id=\"m{levels}\"/>")
        };
        let of = |content: &str| format!("<shape type=\"merge\" id=\"m\">{content}</shape>");
        for (content, thing) in [
            (of("<transform name=\"to_world\"/>"), "to_world of shape \"merge\" is not supported; give it to the shapes inside"),
            (of("<bsdf type=\"null\"/>"), "no material of its own; put it on the shapes inside"),
            (of("<emitter type=\"area\"/>"), "does not shine itself; put it on the shapes inside"),
            (of("<boolean name=\"flip_normals\" value=\"true\"/>"), "has no parameter \"flip_normals\""),
            (of("<ref id=\"m\"/>"), "is referred to from within itself, or twice"),
            (of("") + "<shape type=\"merge\"><ref id=\"m\"/></shape>", "is referred to from within itself, or twice"),
            (deep(100_000), "merges stand in each other more than 16 deep"),
        ] {
            let error = read(&content).unwrap_err().to_string();
            assert!(error.starts_with("s.xml:1:") && error.contains(thing), "{error}");
        }
    }
}
