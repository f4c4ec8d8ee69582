//! What shapes belong to; `<shape type="shapegroup">` and `<shape type="instance">`: geometry that is kept once and stands in many places.

use std::sync::Arc;

use super::{
    context::Context,
    merge,
    properties::{Properties, line},
    shape, transform,
    xml::Element,
};
use crate::{
    error::{Error, Result},
    rays::LEVELS,
    scene::description::{Group, GroupId, Instance, Shape},
};

/// A group that was read.
#[derive(Clone, Copy, Debug)]
pub(super) struct Known {
    id: GroupId,
    /// How many instances lie within each other in it.
    levels: usize,
}

/// What shapes belong to.
pub(super) enum Whole<'a> {
    /// The scene.
    Scene,
    /// A group that is being read.
    Group(&'a mut Known),
}

impl Whole<'_> {
    /// The same, for what stands deeper in it.
    fn same(&mut self) -> Whole<'_> {
        match self {
            Self::Scene => Whole::Scene,
            Self::Group(known) => Whole::Group(known),
        }
    }
}

/// Reads shapes and instances; groups that stand among them are for instances to refer to.
pub(super) fn shapes(context: &mut Context, elements: &[&Element], mut whole: Whole) -> Result<(Vec<Shape>, Vec<Instance>)> {
    let (mut shapes, mut instances) = (Vec::new(), Vec::new());
    for element in elements {
        match (element.attribute("type"), &mut whole) {
            (Some("instance"), whole) => instances.push(instance(context, element, whole)?),
            (Some("merge"), whole) => {
                let inside = merge::shapes(context, element)?;
                context.merges_open += 1;
                let (more, placed) = self::shapes(context, &inside, whole.same())?;
                context.merges_open -= 1;
                shapes.extend(more);
                instances.extend(placed);
            }
            (Some("shapegroup"), Whole::Scene) => _ = group(context, element)?,
            (Some("shapegroup"), Whole::Group(_)) => {
                let remedy = "put its shapes here, or an instance of it";
                return Err(Error::at(&element.place, "a group stands directly inside another", remedy));
            }
            (_, Whole::Scene) => shapes.push(shape::shape(context, element, shape::Light::Allowed)?),
            (_, Whole::Group(_)) => shapes.push(shape::shape(context, element, shape::Light::Refused)?),
        }
    }
    Ok((shapes, instances))
}

/// The group that an element describes; once for each element, however many instances there are.
fn group(context: &mut Context, element: &Element) -> Result<Known> {
    match context.groups_read.get(&element.serial) {
        Some(Some(known)) => return Ok(*known),
        Some(None) => {
            let thing = format!("the group on line {} holds itself", line(&element.place));
            return Err(Error::at(&element.place, thing, "take one of the instances out"));
        }
        None => {}
    }
    context.groups_read.insert(element.serial, None);
    context.groups_open += 1;
    let of = Properties::read(element, &context.ids)?;
    of.refuse("to_world", "give it to the shapes inside, or to the instances")?;
    if let Some(light) = of.objects("emitter").first() {
        return Err(shape::no_light(light));
    }
    let mut known = Known { id: GroupId(0), levels: 0 };
    let (shapes, instances) = shapes(context, &of.objects("shape"), Whole::Group(&mut known))?;
    of.finish()?;
    if shapes.is_empty() && instances.is_empty() {
        return Err(Error::at(&element.place, "the group holds no shape", "put one into it, or take it out"));
    }
    context.groups_open -= 1;
    // What is in it stands before it.
    known.id = GroupId(context.groups.len() as u32);
    context.groups.push(Arc::new(Group { shapes, instances, place: element.place.clone() }));
    context.groups_read.insert(element.serial, Some(known));
    Ok(known)
}

fn instance(context: &mut Context, element: &Element, within: &mut Whole) -> Result<Instance> {
    let of = Properties::read(element, &context.ids)?;
    let to_world = of.transform("to_world")?;
    if !transform::is_invertible(&to_world) {
        return Err(of.error("to_world", "flattens the group", "scale every axis by something other than 0"));
    }
    if let Some(bsdf) = of.objects("bsdf").first() {
        let remedy = "its shapes keep their own; put it on them, inside the group";
        return Err(Error::at(&bsdf.place, "an instance has no material of its own", remedy));
    }
    if let Some(light) = of.objects("emitter").first() {
        return Err(shape::no_light(light));
    }
    let Some(shown) = of.object("shape")? else {
        return Err(Error::at(
            &element.place,
            "the instance is of no group",
            "write <ref id=\"…\"/> with the id of a shapegroup inside it",
        ));
    };
    if shown.attribute("type") != Some("shapegroup") {
        let thing = format!("the instance is of a shape of type \"{}\"", shown.attribute("type").unwrap_or(""));
        return Err(Error::at(&element.place, thing, "put that shape into a shapegroup"));
    }
    let too_deep = || {
        let thing = format!("instances lie within each other more than {LEVELS} deep");
        Error::at(&element.place, thing, "write the shapes of the innermost groups out")
    };
    // Asked before the group is read, so that reading does not go deeper either.
    if context.groups_open >= LEVELS {
        return Err(too_deep());
    }
    let known = group(context, shown)?;
    of.finish()?;
    if let Whole::Group(outer) = within {
        outer.levels = outer.levels.max(known.levels + 1);
        if outer.levels >= LEVELS {
            return Err(too_deep());
        }
    }
    Ok(Instance { group: known.id, to_world, place: element.place.clone() })
}
