//! `<integrator>`: how far paths go.

use super::{catalog, context::Context, properties::Properties, xml::Element};
use crate::{
    error::{Error, Result},
    scene::description::Integrator,
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
    if of.text("aovs")?.is_some_and(|aovs| !aovs.trim().is_empty()) {
        context.warn(of.place_of("aovs"), "aovs are not written");
    }
    let Some(inner) = of.object("integrator")? else {
        return Err(Error::at(place, "aov holds no integrator", "put one into it, such as <integrator type=\"path\"/>"));
    };
    if inner.attribute("type") == Some("aov") {
        return Err(Error::at(&inner.place, "an aov stands inside an aov", "keep one of them"));
    }
    of.finish()?;
    integrator(context, inner)
}
