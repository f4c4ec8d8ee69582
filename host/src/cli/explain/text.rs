//! A report in words.

use super::Report;
use crate::{
    plan::{
        contents::{Camera, Contents, Groups, Lights, Materials, Shapes},
        joins::State,
        words,
    },
    render::LONGEST_JOINED,
};

/// The whole report, without a newline at its end.
pub(super) fn of(report: &Report) -> String {
    let mut lines = vec![report.scene.display().to_string(), String::new()];
    contents(&mut lines, &report.contents);
    section(&mut lines, "Effects");
    let (present, absent): (Vec<_>, Vec<_>) = report.effects.list().into_iter().partition(|(_, present)| *present);
    let names = |list: Vec<(&'static str, bool)>| list.into_iter().map(|(name, _)| name).collect::<Vec<_>>().join(", ");
    lines.push(entry("present", &or_none(names(present))));
    lines.push(entry("absent", &or_none(names(absent))));

    section(&mut lines, "Techniques");
    for verdict in &report.techniques {
        let state = match verdict.state {
            State::On => "on",
            State::Off => "off",
            State::Impossible => "impossible",
        };
        let name = crate::plan::joins::name(verdict.join).replace('_', " ");
        lines.push(format!("  {name:<11} {:<13} {state:<11} {}", verdict.techniques, verdict.why));
    }

    if let Some(choice) = &report.choice {
        section(&mut lines, "The plan");
        lines.extend(words::card(choice).into_iter().map(|line| format!("  {line}")));
    }

    section(&mut lines, "Paths that no technique finds");
    if report.missing.is_empty() {
        lines.push("  none".to_owned());
    } else {
        lines.push(
            "  Where light can travel so in this scene, it is missing from the image (S: mirror or clear glass, D: any other surface)."
                .to_owned(),
        );
    }
    for gap in &report.missing {
        lines.push(format!("  {}, from {}: {}", gap.class, gap.lights, gap.what));
        lines.push(format!("    {}", gap.remedy));
    }

    section(&mut lines, "Unlike Mitsuba");
    lines.extend(report.differences.iter().map(|difference| format!("  {difference}")));
    if report.differences.is_empty() {
        lines.push("  nothing in this scene".to_owned());
    }
    lines.join("\n")
}

fn contents(lines: &mut Vec<String>, contents: &Contents) {
    let Contents { integrator, spp, seed, primitives, degenerate, unused_materials, black_lights, .. } = contents;
    lines.push(entry("camera", &camera(&contents.camera)));
    lines.push(entry("film", &film(&contents.camera)));
    let depth = match integrator.max_depth {
        Some(depth) => format!("paths of up to {depth} segments"),
        None => format!("paths of any length (joined up to {LONGEST_JOINED} segments)"),
    };
    let hidden = if integrator.hide_emitters { ", emitters hidden from the lens" } else { "" };
    lines.push(entry("integrator", &format!("{}: {depth}, roulette after {}{hidden}", integrator.kind, integrator.rr_depth)));
    lines.push(entry("sampler", &format!("{spp} samples per pixel, seed {seed}")));
    let shapes: Vec<_> = contents.shapes.iter().map(shape).collect();
    lines.push(entry("shapes", &or_none(shapes.join(", "))));
    if let Some(Groups { count: number, shapes, instances, written_out }) = contents.groups {
        let (groups, instances) = (count(number, "group"), count(instances, "instance"));
        lines.push(entry("groups", &format!("{groups} of {}, {instances}; written out, {written_out} shapes", count(shapes, "shape"))));
    }
    let dropped = if *degenerate > 0 { format!(", {degenerate} without area dropped") } else { String::new() };
    lines.push(entry("", &format!("{} to cast rays at{dropped}", count(*primitives, "primitive"))));
    listed(lines, "materials", contents.materials.iter().map(material));
    if *unused_materials > 0 {
        lines.push(entry("", &format!("{} on no shape", count(*unused_materials, "material"))));
    }
    listed(lines, "lights", contents.lights.iter().map(light));
    if *black_lights > 0 {
        lines.push(entry("", &format!("{} without power, left out", count(*black_lights, "light"))));
    }
}

fn camera(camera: &Camera) -> String {
    let mut parts = vec![camera.kind.to_owned()];
    parts.extend(camera.fov_x.map(|fov| format!("{} degrees across", short(fov))));
    parts.extend(camera.aperture_radius.map(|radius| format!("aperture radius {}", short(radius))));
    parts.extend(camera.focus_distance.map(|distance| format!("in focus at {}", short(distance))));
    parts.extend(camera.near_clip.map(|near| format!("near clip {}", short(near))));
    parts.extend(camera.far_clip.map(|far| format!("far clip {}", short(far))));
    parts.join(", ")
}

fn film(camera: &Camera) -> String {
    let crop = camera.crop.map_or(String::new(), |[x, y, width, height]| format!(", crop {width} × {height} at {x}, {y}"));
    format!("{} × {} pixels{crop}, filter {}", camera.width, camera.height, camera.filter)
}

fn shape(shapes: &Shapes) -> String {
    let words = count(shapes.count, shapes.kind);
    if shapes.triangles > 0 { format!("{words} ({})", count(shapes.triangles, "triangle")) } else { words }
}

fn material(materials: &Materials) -> String {
    let lobes = materials.lobes.join(", ").replace('_', " ");
    let lobes = if lobes.is_empty() { "black".to_owned() } else { lobes };
    let textured = if materials.textured > 0 { format!(", {} textured", materials.textured) } else { String::new() };
    format!("{} × {} on {}: {lobes}{textured}", materials.count, materials.kind, count(materials.shapes, "shape"))
}

fn light(lights: &Lights) -> String {
    format!("{} × {}: {} W, {:.1} % of the power", lights.count, lights.kind, short(lights.power), 100.0 * lights.share)
}

fn section(lines: &mut Vec<String>, title: &str) {
    lines.extend([String::new(), title.to_owned()]);
}

/// One line for each, the first with the name.
fn listed(lines: &mut Vec<String>, name: &str, items: impl Iterator<Item = String>) {
    let before = lines.len();
    for item in items {
        lines.push(entry(if lines.len() == before { name } else { "" }, &item));
    }
    if lines.len() == before {
        lines.push(entry(name, "none"));
    }
}

fn entry(name: &str, words: &str) -> String {
    format!("  {name:<11} {words}")
}

fn or_none(words: String) -> String {
    if words.is_empty() { "none".to_owned() } else { words }
}

fn count(number: usize, noun: &str) -> String {
    match (number, noun) {
        (1, _) => format!("1 {noun}"),
        (_, "mesh") => format!("{number} meshes"),
        _ => format!("{number} {noun}s"),
    }
}

/// Four digits.
fn short(value: f64) -> String {
    if value != 0.0 && !(1e-3..1e6).contains(&value.abs()) {
        return format!("{value:.3e}");
    }
    let decimals = (3 - value.abs().max(1e-3).log10().floor() as i32).max(0) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        for (value, text) in
            [(0.0, "0"), (60.0, "60"), (38.184_81, "38.18"), (0.002_5, "0.0025"), (123_456.7, "123457"), (1e-7, "1.000e-7")]
        {
            assert_eq!(short(value), text);
        }
    }
}
