//! Which joins can make a path at all in a scene, and what a plan does with them.

use bidir_kernel::{Join, Technique, Techniques};
use serde::Serialize;

use super::{Stage, effects::Effects};

/// What becomes of a kind of join.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum State {
    /// The plan samples it, and it can make paths.
    On,
    /// It could make paths, and the plan leaves it out.
    Off,
    /// Nothing in the scene can be joined so, whatever the plan says.
    Impossible,
}

/// A kind of join, what becomes of it, and why.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Verdict {
    /// Which join.
    #[serde(serialize_with = "by_name")]
    pub join: Join,
    /// The techniques it makes.
    pub techniques: &'static str,
    /// On, off or impossible.
    pub state: State,
    /// How often the plan samples it, per camera path or per vertex of one.
    pub effort: f64,
    /// The reason.
    pub why: String,
}

/// As a plan's file spells it.
pub fn name(join: Join) -> &'static str {
    match join {
        Join::LightHit => "light_hit",
        Join::NextEvent => "next_event",
        Join::Connection => "connection",
        Join::LensSplat => "lens_splat",
        Join::LensHit => "lens_hit",
    }
}

/// Its techniques, in s and t.
fn techniques(join: Join) -> &'static str {
    match join {
        Join::LightHit => "s = 0",
        Join::NextEvent => "s = 1, t ≥ 2",
        Join::Connection => "s ≥ 2, t ≥ 2",
        Join::LensSplat => "t = 1",
        Join::LensHit => "t = 0",
    }
}

fn by_name<S: serde::Serializer>(join: &Join, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(name(*join))
}

/// What a plan's stage comes to in a scene with these effects, with paths of up to `max_depth` segments (`None`: any).
pub fn judge(effects: &Effects, plan: &Stage, max_depth: Option<u32>) -> Vec<Verdict> {
    let verdict = |join| {
        let effort = plan.effort(join);
        let (state, why) = match can(effects, max_depth, join) {
            Err(why) => (State::Impossible, why),
            Ok(_) if effort == 0.0 => (State::Off, "the plan leaves it out".to_owned()),
            Ok(why) => (State::On, why.to_owned()),
        };
        Verdict { join, techniques: techniques(join), state, effort, why }
    };
    Join::ALL.into_iter().map(verdict).collect()
}

/// Whether some path of the scene can be made so: what speaks for it, or what rules it out.
fn can(effects: &Effects, max_depth: Option<u32>, join: Join) -> Result<&'static str, String> {
    let no = |why: &str| Err(why.to_owned());
    if !effects.lights() {
        return no("nothing in the scene shines");
    }
    let seen = effects.landable_lights() && !effects.hidden_emitters;
    let shortest = match join {
        Join::LightHit | Join::LensHit => 1,
        Join::LensSplat => {
            if seen {
                1
            } else {
                2
            }
        }
        Join::NextEvent => 2,
        Join::Connection => 3,
    };
    if let Some(depth) = max_depth.filter(|&depth| depth < shortest) {
        return Err(format!("max_depth is {depth}, and its shortest paths have {shortest} segments"));
    }
    const NO_SMOOTH: &str = "no surface has a smooth lobe, and mirrors and clear glass send light only where they choose";
    match join {
        Join::LightHit if !effects.landable_lights() => no("every light is one point or one direction, which no ray lands on"),
        Join::LightHit => Ok("rays can land on a light"),
        Join::NextEvent if !effects.smooth() => no(NO_SMOOTH),
        Join::NextEvent => Ok("surfaces with a smooth lobe can be lit from any point of a light"),
        Join::Connection if !effects.smooth() => no(NO_SMOOTH),
        Join::Connection => Ok("two surfaces with smooth lobes can be joined"),
        Join::LensSplat if !effects.smooth() && !seen => no(NO_SMOOTH),
        Join::LensSplat if !effects.smooth() => Ok("the lens can be shown the lights themselves"),
        Join::LensSplat => Ok("the lens can be shown any surface with a smooth lobe"),
        Join::LensHit if effects.finite_lens => Ok("the lens has an area that light can land on"),
        Join::LensHit if effects.parallel_rays => no("a camera of parallel rays is one direction, and cannot be hit"),
        Join::LensHit => no("a pinhole cannot be hit"),
    }
}

/// These counts, those of joins that cannot make any path in a scene with these effects left out.
pub fn possible(effects: &Effects, max_depth: Option<u32>, counts: &Techniques) -> Techniques {
    let count = |join| if can(effects, max_depth, join).is_ok() { counts.effort(join) } else { 0.0 };
    Techniques {
        light_hit: count(Join::LightHit),
        next_event: count(Join::NextEvent),
        connection: count(Join::Connection),
        lens_splat: count(Join::LensSplat),
        lens_hit: count(Join::LensHit),
    }
}

/// Whether one technique can make a path in a scene with these effects.
pub fn exists(effects: &Effects, technique: Technique) -> bool {
    let length = technique.length();
    if can(effects, Some(length), technique.join()).is_err() {
        return false;
    }
    match length {
        1 if effects.hidden_emitters => false,
        // What leaves infinitely far away is not shown to a camera of one direction.
        1 if technique.join() == Join::LensSplat => effects.area_lights || (effects.environment && !effects.parallel_rays),
        1 => effects.landable_lights(),
        // Longer paths scatter somewhere; what is joined by landing alone scatters at any surface.
        _ => match technique.join() {
            Join::LensSplat => effects.smooth(),
            _ => effects.smooth() || effects.delta(),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::Named;

    /// A room with a lamp, seen by a pinhole.
    const ROOM: Effects = Effects { area_lights: true, diffuse: true, ..Effects::NONE };

    fn impossible(effects: Effects, depth: Option<u32>) -> Vec<Join> {
        let verdicts = judge(&effects, &Named::Bdpt.stage().unwrap(), depth);
        verdicts.into_iter().filter(|v| v.state == State::Impossible).map(|v| v.join).collect()
    }

    #[test]
    fn joins_that_a_scene_rules_out_are_impossible() {
        assert_eq!(impossible(ROOM, None), [Join::LensHit]);
        assert_eq!(impossible(Effects { finite_lens: true, ..ROOM }, None), []);
        assert_eq!(impossible(Effects { area_lights: false, dirac_lights: true, ..ROOM }, None), [Join::LightHit, Join::LensHit]);
        let mirrors = Effects { diffuse: false, delta_reflection: true, ..ROOM };
        assert_eq!(impossible(mirrors, None), [Join::NextEvent, Join::Connection, Join::LensHit]);
        let hidden = Effects { hidden_emitters: true, ..mirrors };
        assert_eq!(impossible(hidden, None), [Join::NextEvent, Join::Connection, Join::LensSplat, Join::LensHit]);
        assert_eq!(impossible(ROOM, Some(2)), [Join::Connection, Join::LensHit]);
        assert_eq!(impossible(Effects { area_lights: false, ..ROOM }, None), Join::ALL);
    }

    #[test]
    fn joins_that_a_plan_leaves_out_are_off() {
        let verdicts = judge(&ROOM, &Named::Path.stage().unwrap(), None);
        let states: Vec<_> = verdicts.iter().map(|v| v.state).collect();
        assert_eq!(states, [State::On, State::On, State::Off, State::Off, State::Impossible]);
    }

    #[test]
    fn single_techniques_follow_their_join_and_length() {
        let listed =
            |effects: Effects, k: u32| -> Vec<u32> { (0..=k + 1).filter(|&s| exists(&effects, Technique { s, t: k + 1 - s })).collect() };
        assert_eq!(listed(ROOM, 1), [0, 1]);
        assert_eq!(listed(ROOM, 3), [0, 1, 2, 3]);
        let point = Effects { area_lights: false, dirac_lights: true, ..ROOM };
        assert_eq!(listed(point, 1), [0; 0]);
        assert_eq!(listed(point, 2), [1, 2]);
        let sky = Effects { area_lights: false, environment: true, parallel_rays: true, ..ROOM };
        assert_eq!(listed(sky, 1), [0]);
        let mirrors = Effects { diffuse: false, delta_reflection: true, ..ROOM };
        assert_eq!(listed(mirrors, 3), [0]);
        assert_eq!(listed(Effects { finite_lens: true, ..ROOM }, 2), [0, 1, 2, 3]);
        assert_eq!(listed(Effects { hidden_emitters: true, ..ROOM }, 1), [0; 0]);
    }
}
