//! Classes of paths that exist in a scene and that no technique of a plan can find.
//!
//! A path is written from the light to the lens: L, then D where a surface with a smooth lobe scatters and S where one sends light
//! into one direction, then E (Heckbert 1990). A technique joins two neighbours, both of which must be open to it: D always,
//! S never, L and E as far as they are. So what is found follows from the letters.

use serde::Serialize;

use super::{Stage, effects::Effects};

/// A class of paths that is missing from the image.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Gap {
    /// Its letters; + is one or more.
    pub class: String,
    /// From which lights.
    pub lights: &'static str,
    /// What one would have seen.
    pub what: String,
    /// What to do.
    pub remedy: String,
}

/// How many scatterings are looked at: enough for every pattern that is not a longer one's part repeated.
const MOST_BENDS: usize = 3;

/// Whether a path scatters smoothly, bend by bend.
type Bends = Vec<bool>;

/// What `plan` cannot find. Whether such a path also meets the scene's geometry is not asked: it is said of what light and surfaces allow.
pub fn gaps(effects: &Effects, plan: &Stage, max_depth: Option<u32>) -> Vec<Gap> {
    let mut found: Vec<Gap> = Vec::new();
    for (lights, landable) in [("area lights or the environment", true), ("point, spot or directional lights", false)] {
        if !(if landable { effects.landable_lights() } else { effects.dirac_lights }) {
            continue;
        }
        for bends in patterns(effects, max_depth) {
            let nothing_to_see = if landable { bends.is_empty() && effects.hidden_emitters } else { seen_straight(effects, &bends) };
            if nothing_to_see || finds(effects, plan, landable, &bends) {
                continue;
            }
            let class = class(&bends, |longer| !finds(effects, plan, landable, longer));
            if !found.iter().any(|gap| gap.class == class && gap.lights == lights) {
                let remedy = remedy(effects, plan, landable, &bends);
                found.push(Gap { class, lights, what: what(effects, &bends), remedy });
            }
        }
    }
    found
}

/// Whether some technique of the plan can make a path with these bends.
fn finds(effects: &Effects, plan: &Stage, landable: bool, bends: &[bool]) -> bool {
    let open = |bend: Option<&bool>| bend.is_some_and(|&smooth| smooth);
    let uses = |effort: f64| effort > 0.0;
    // The light's own point is shown to the lens where the camera has a point, or the light a place.
    let shown = landable && (effects.area_lights || !effects.parallel_rays);
    uses(plan.light_hit) && landable
        || uses(plan.lens_hit) && effects.finite_lens
        || uses(plan.next_event) && open(bends.first())
        || uses(plan.lens_splat) && (open(bends.last()) || bends.is_empty() && shown)
        || uses(plan.connection) && bends.windows(2).any(|pair| pair == [true, true])
}

/// A light without a size is not seen itself, nor through what does not bend light; no renderer of its kind shows it.
fn seen_straight(effects: &Effects, bends: &[bool]) -> bool {
    let bent = effects.delta_reflection || effects.delta_transmission && effects.refraction;
    bends.is_empty() || !bent && bends.iter().all(|&smooth| !smooth)
}

/// Every sequence of bends that the surfaces allow, shortest first.
fn patterns(effects: &Effects, max_depth: Option<u32>) -> Vec<Bends> {
    let letters: Vec<bool> =
        [(true, effects.smooth()), (false, effects.delta())].into_iter().filter_map(|(l, has)| has.then_some(l)).collect();
    let most = max_depth.map_or(MOST_BENDS, |depth| MOST_BENDS.min((depth as usize).saturating_sub(1)));
    if max_depth == Some(0) {
        return Vec::new();
    }
    let mut all: Vec<Bends> = vec![Vec::new()];
    let mut last = all.clone();
    for _ in 0..most {
        last = last.iter().flat_map(|bends| letters.iter().map(|&letter| [bends.as_slice(), &[letter]].concat())).collect();
        all.extend_from_slice(&last);
    }
    all
}

/// The letters, repeated ones once; without + where a D more makes it a path that is found.
fn class(bends: &[bool], is_missing: impl Fn(&[bool]) -> bool) -> String {
    let mut runs = bends.to_vec();
    runs.dedup();
    let letters = |(at, &smooth): (usize, &bool)| match smooth {
        false => "S+ ",
        true if is_missing(&[&runs[..at], &[true], &runs[at..]].concat()) => "D+ ",
        true => "D ",
    };
    let middle: String = runs.iter().enumerate().map(letters).collect();
    format!("L {middle}E")
}

fn what(effects: &Effects, bends: &[bool]) -> String {
    let through = match (effects.delta_reflection, effects.delta_transmission) {
        (true, true) => "in a mirror or through clear glass",
        (true, false) => "in a mirror",
        _ => "through clear glass",
    };
    let mut runs = bends.to_vec();
    runs.dedup();
    match runs.as_slice() {
        [] => "the lights themselves".to_owned(),
        [true] => "what is lit".to_owned(),
        [false] => format!("the lights themselves, seen {through}"),
        [true, false] => format!("what is lit, seen {through}"),
        [false, true] => "caustics".to_owned(),
        [false, true, false] => format!("caustics, seen {through}"),
        _ => "light that a surface scatters towards a mirror or clear glass, and the caustic of that".to_owned(),
    }
}

/// What would bring the class into the image.
fn remedy(effects: &Effects, plan: &Stage, landable: bool, bends: &[bool]) -> String {
    const EVERY: &str = "use every technique (--integrator bdpt)";
    let all = Stage::BIDIRECTIONAL;
    if finds(effects, &all, landable, bends) {
        return EVERY.to_owned();
    }
    let size = "give the light an area (a small shape with an area emitter), or the camera a lens (thinlens), or the mirror or glass a little \
                roughness";
    // Two D in a row are open to connections, if there are any.
    let connects = bends.contains(&true) && plan.connection == 0.0;
    if connects { format!("{size}; where two D follow each other, {EVERY}") } else { size.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::Named;

    fn classes(effects: Effects, plan: Named, depth: Option<u32>) -> Vec<String> {
        gaps(&effects, &plan.stage().unwrap(), depth).into_iter().map(|gap| gap.class).collect()
    }

    /// A point light over a glass ball on a floor, seen by a pinhole.
    fn point() -> Effects {
        Effects {
            dirac_lights: true,
            diffuse: true,
            delta_reflection: true,
            delta_transmission: true,
            refraction: true,
            ..Effects::default()
        }
    }

    #[test]
    fn a_point_lights_caustic_in_a_mirror_is_out_of_a_pinholes_reach() {
        assert_eq!(classes(point(), Named::Bdpt, None), ["L S+ E", "L S+ D S+ E"]);
        assert_eq!(classes(point(), Named::Bdpt, Some(3)), ["L S+ E"]);
        let gaps = gaps(&point(), &Named::Bdpt.stage().unwrap(), None);
        assert!(gaps.iter().all(|gap| gap.remedy.contains("area emitter")));
    }

    #[test]
    fn a_lens_or_an_area_light_finds_everything() {
        assert_eq!(classes(Effects { finite_lens: true, ..point() }, Named::Bdpt, None), [""; 0]);
        assert_eq!(classes(Effects { dirac_lights: false, area_lights: true, ..point() }, Named::Bdpt, None), [""; 0]);
        assert_eq!(classes(Effects { delta_reflection: false, delta_transmission: false, ..point() }, Named::Bdpt, None), [""; 0]);
    }

    #[test]
    fn a_plan_of_fewer_techniques_misses_more() {
        assert_eq!(classes(point(), Named::Path, None), ["L S+ E", "L S+ D+ E", "L S+ D+ S+ E"]);
        assert!(gaps(&point(), &Named::Path.stage().unwrap(), None)[1].remedy.contains("bdpt"));
        let lamp = Effects { dirac_lights: false, area_lights: true, ..point() };
        assert_eq!(classes(lamp, Named::Light, None), ["L S+ E", "L D+ S+ E", "L S+ D+ S+ E"]);
    }

    #[test]
    fn two_matt_surfaces_in_a_row_are_connected_if_anything_is() {
        let splats = Stage { connection: 0.0, ..Stage::BIDIRECTIONAL };
        let [.., gap] = &gaps(&point(), &splats, None)[..] else { panic!("a gap") };
        assert_eq!(gap.class, "L S+ D+ S+ E");
        assert!(gap.remedy.contains("area emitter") && gap.remedy.contains("bdpt"), "{}", gap.remedy);
    }

    #[test]
    fn a_light_that_is_seen_straight_is_no_gap() {
        let null =
            Effects { dirac_lights: true, diffuse: true, delta_transmission: true, straight_transmission: true, ..Effects::default() };
        assert_eq!(classes(null, Named::Bdpt, None), ["L S+ D S+ E"]);
    }
}
