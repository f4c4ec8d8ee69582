//! `<integrator>`: how far paths go.

use super::{
    catalog,
    context::Context,
    properties::Properties,
    suggest::{did_you_mean, list},
    xml::Element,
};
use crate::{
    error::{Error, Result},
    scene::description::{Aov, Integrator, Quantity, Words},
};

/// The integrator that an element describes.
pub(super) fn integrator(context: &mut Context, element: &Element) -> Result<Integrator> {
    let of = Properties::read(element, &context.ids)?;
    catalog::check("integrator", of.kind(), &element.place)?;
    of.pass_over(&["samples_per_pass", "block_size"]);
    if of.float("timeout")?.is_some_and(|t| t > 0.0) {
        return Err(of.error("timeout", "is not supported", "render with --time SECONDS"));
    }
    if of.kind() == "aov" {
        return around(context, of);
    }
    let hide_emitters = of.boolean("hide_emitters")?.unwrap_or(false);
    let mut found = Integrator { kind: of.kind().into(), hide_emitters, ..Integrator::default() };
    if of.kind() == "direct" {
        found.max_depth = Some(2);
        of.pass_over(&["shading_samples", "emitter_samples", "bsdf_samples"]);
    } else {
        found.max_depth = match of.whole("max_depth", -1)? {
            None | Some(-1) => None,
            Some(depth) => Some(depth as u32),
        };
        found.rr_depth = of.whole("rr_depth", 1)?.map_or(found.rr_depth, |depth| depth as u32);
    }
    of.finish()?;
    Ok(found)
}

/// What stands inside an `aov`.
fn around(context: &mut Context, of: Properties) -> Result<Integrator> {
    let place = of.place();
    let aovs = aovs(&of)?;
    let Some(inner) = of.object("integrator")? else {
        return Err(Error::at(place, "aov holds no integrator", "put one into it, such as <integrator type=\"path\"/>"));
    };
    if inner.attribute("type") == Some("aov") {
        return Err(Error::at(&inner.place, "an aov stands inside an aov", "keep one of them"));
    }
    of.finish()?;
    Ok(Integrator { aovs, ..integrator(context, inner)? })
}

/// `name:quantity` and so on, with commas or blanks between.
fn aovs(of: &Properties) -> Result<Vec<Aov>> {
    let Some(written) = of.text("aovs")? else { return Ok(Vec::new()) };
    let mut found: Vec<Aov> = Vec::new();
    for item in written.split(|c: char| c == ',' || c.is_whitespace()).filter(|item| !item.is_empty()) {
        let Some((name, quantity)) = item.split_once(':') else {
            return Err(of.error("aovs", format!("has \"{item}\""), "write a layer's name and what it holds, such as nn:sh_normal"));
        };
        let known = Quantity::ALL.map(Quantity::name);
        let Some(quantity) = Quantity::named(quantity) else {
            let remedy = format!("{}it can be {}", did_you_mean(quantity, &known), list(&known));
            return Err(of.error("aovs", format!("asks for \"{quantity}\""), remedy));
        };
        let aov = Aov { name: name.to_owned(), of: quantity, words: Words::Mitsuba };
        let taken = |one: &Aov| one.name == name && one.channels().iter().any(|channel| aov.channels().contains(channel));
        if !name.chars().all(|c| c.is_ascii_graphic()) || name.is_empty() || found.iter().any(taken) {
            let remedy = "give each layer a name of its own, of letters and digits";
            return Err(of.error("aovs", format!("names a layer \"{name}\""), remedy));
        }
        found.push(aov);
    }
    Ok(found)
}
