//! The plugins of the scene language: those we read, and those we know of and do not read.

use super::suggest::{did_you_mean, list};
use crate::error::{Error, Place, Result};

/// A plugin of the scene language.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// The element it stands in, such as `bsdf`.
    pub tag: &'static str,
    /// Its `type`.
    pub name: &'static str,
    /// `None` if it is supported, else what to use instead.
    pub instead: Option<&'static str>,
}

/// What may be written, and what is known and may not, by element.
pub fn entries() -> impl Iterator<Item = Entry> {
    let supported = SUPPORTED.iter().flat_map(|(tag, names)| names.iter().map(|name| Entry { tag, name, instead: None }));
    let others = UNSUPPORTED.iter().flat_map(|(tag, names, instead)| names.iter().map(|name| Entry { tag, name, instead: Some(instead) }));
    supported.chain(others)
}

/// The types that an element may have.
pub fn supported(tag: &str) -> &'static [&'static str] {
    SUPPORTED.iter().find(|(t, _)| *t == tag).map_or(&[], |(_, names)| *names)
}

const SUPPORTED: &[(&str, &[&str])] = &[
    ("integrator", &["path", "direct", "ptracer", "volpath", "volpathmis", "aov"]),
    ("sampler", &["independent", "stratified", "multijitter", "orthogonal", "ldsampler"]),
    ("sensor", &["perspective", "thinlens", "orthographic"]),
    ("film", &["hdrfilm"]),
    ("rfilter", &["gaussian", "box", "tent", "mitchell", "catmullrom", "lanczos"]),
    (
        "bsdf",
        &[
            "diffuse",
            "conductor",
            "roughconductor",
            "dielectric",
            "thindielectric",
            "roughdielectric",
            "plastic",
            "roughplastic",
            "principled",
            "principledthin",
            "twosided",
            "mask",
            "blendbsdf",
            "normalmap",
            "bumpmap",
            "null",
        ],
    ),
    ("texture", &["bitmap", "checkerboard", "mesh_attribute"]),
    ("shape", &["rectangle", "disk", "sphere", "cube", "cylinder", "obj", "ply", "serialized", "merge", "shapegroup", "instance"]),
    ("emitter", &["area", "point", "spot", "directional", "constant", "envmap"]),
];

/// Of Mitsuba 0.5 and 0.6.
const OLD_INTEGRATORS: &[&str] = &[
    "volpath_simple",
    "bdpt",
    "pssmlt",
    "mlt",
    "erpt",
    "photonmapper",
    "ppm",
    "sppm",
    "vpl",
    "irrcache",
    "adaptive",
    "multichannel",
    "field",
];

type Unsupported = (&'static str, &'static [&'static str], &'static str);
const UNSUPPORTED: &[Unsupported] = &[
    ("integrator", &["prb", "prb_basic", "prbvolpath", "direct_projective", "prb_projective"], "use path; there are no derivatives here"),
    ("integrator", &["depth", "moment", "stokes", "volprim_rf_basic"], "use path"),
    ("integrator", OLD_INTEGRATORS, "use path; which techniques run is --integrator's to say"),
    ("sampler", &["halton", "hammersley", "sobol"], "use independent; which numbers are drawn is --sampler's to say"),
    ("sensor", &["distant", "irradiancemeter", "radiancemeter", "batch"], "use perspective, thinlens or orthographic"),
    ("sensor", &["telecentric", "spherical", "fluencemeter", "perspective_rdist"], "use perspective, thinlens or orthographic"),
    ("film", &["specfilm"], "use hdrfilm; light is RGB here"),
    ("film", &["ldrfilm", "tiledhdrfilm", "mfilm"], "use hdrfilm; how a picture is written, -o says"),
    ("bsdf", &["pplastic"], "light is not polarized here; use plastic or roughplastic"),
    ("bsdf", &["measured", "measured_polarized", "hair", "irawan"], "use roughconductor or diffuse"),
    ("bsdf", &["circular", "linear_polarizer", "polarizer", "retarder"], "light is not polarized here; use null"),
    ("bsdf", &["roughdiffuse"], "use diffuse"),
    ("bsdf", &["phong", "ward"], "use roughconductor or roughplastic"),
    ("bsdf", &["coating", "roughcoating"], "use plastic or roughplastic, or principled with a clearcoat"),
    ("bsdf", &["mixturebsdf"], "use blendbsdf"),
    ("bsdf", &["difftrans", "hk"], "use principledthin with diff_trans"),
    ("texture", &["gridtexture"], "use checkerboard or bitmap"),
    ("texture", &["scale"], "multiply what is inside by it"),
    ("texture", &["vertexcolors"], "use mesh_attribute with the name vertex_color"),
    ("texture", &["wireframe", "curvature"], "use bitmap"),
    ("texture", &["volume", "area_attribute"], "use bitmap"),
    ("shape", &["blender"], "save it as ply or obj"),
    ("shape", &["bsplinecurve", "linearcurve", "sdfgrid", "ellipsoids", "ellipsoidsmesh"], "save it as a mesh in ply or obj"),
    ("shape", &["heightfield", "hair"], "save it as a mesh in ply or obj"),
    ("emitter", &["sunsky", "sun", "sky", "timed_sunsky"], "bake it into an image for envmap"),
    ("emitter", &["projector"], "use spot"),
    ("emitter", &["collimated"], "use spot or directional"),
    ("emitter", &["directionalarea"], "use area, spot or directional"),
    ("emitter", &["volumelight"], "use area"),
    ("medium", &["homogeneous", "heterogeneous"], "media are not supported; take it out"),
];

/// An error unless `<tag type="kind">` is supported.
pub(super) fn check(tag: &str, kind: &str, place: &Place) -> Result<()> {
    let known = supported(tag);
    if known.contains(&kind) {
        return Ok(());
    }
    if let Some((_, _, instead)) = UNSUPPORTED.iter().find(|(t, names, _)| *t == tag && names.contains(&kind)) {
        return Err(Error::at(place, format!("{tag} type \"{kind}\" is not supported"), *instead));
    }
    let all: Vec<&str> = entries().filter(|e| e.tag == tag && e.instead.is_none()).map(|e| e.name).collect();
    let plugin = if matches!(tag, "bsdf" | "emitter") { super::plugin::hint(kind) } else { String::new() };
    let remedy = format!("{}there are {}{plugin}", did_you_mean(kind, &all), list(known));
    Err(Error::at(place, format!("{tag} type \"{kind}\" is unknown"), remedy))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `docs/mitsuba.md` has a row for each plugin, in the part of its element.
    #[test]
    fn the_table_in_the_docs_is_this_one() {
        let table = include_str!("../../../docs/mitsuba.md");
        let parts: Vec<(&str, &str)> = table.split("\n## ").skip(1).filter_map(|part| part.split_once('\n')).collect();
        for Entry { tag, name, instead } in entries() {
            let rows = parts.iter().find(|(of, _)| *of == tag).map_or("", |(_, rows)| rows);
            let row = rows.lines().find(|line| line.starts_with(&format!("| `{name}` | "))).unwrap_or("");
            match instead {
                Some(instead) => assert!(row.contains(&format!("refused: {instead}")), "{tag} {name}: {row}"),
                None => assert!(!row.is_empty() && !row.contains("refused:"), "{tag} {name}: {row}"),
            }
        }
        let rows = parts.iter().map(|(_, rows)| rows.lines().filter(|line| line.starts_with("| `")).count()).sum::<usize>();
        assert_eq!(rows, entries().count());
    }

    #[test]
    fn no_plugin_is_listed_twice() {
        let mut all: Vec<_> = entries().map(|e| (e.tag, e.name)).collect();
        let count = all.len();
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), count);
    }
}
