//! The plan: which techniques a render runs, how they share a path, and what it rests on: what a scene holds ([`contents`]),
//! what can happen to light in it ([`effects`]), which joins that leaves ([`joins`]), what none of them finds ([`gaps`]),
//! and what a pilot measured ([`evidence`], [`plugins`]), from which the best is chosen ([`choice`]).

pub mod choice;
pub mod contents;
pub mod effects;
pub mod evidence;
pub mod gaps;
pub mod joins;
pub mod plugins;
pub mod words;

use std::path::Path;

use bidir_kernel::{Heuristic, Join, Strategy, Techniques};
use serde::{Deserialize, Serialize};

use crate::{
    error::{Error, Result},
    scene::description::Integrator,
};

/// A plan as a file holds it. The same scene, seed, samples and plan give the same image bit for bit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plan {
    /// What is sampled, in the order of their `from`; the first from 0 on.
    pub stages: Vec<Stage>,
}

/// What is sampled from some sample of every pixel on.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stage {
    /// The first sample of every pixel that is taken so.
    #[serde(default)]
    pub from: u32,
    /// s = 0, a camera walk lands on a light: 0 or 1.
    pub light_hit: f64,
    /// s = 1: light points per vertex of a camera walk, a whole number.
    pub next_event: f64,
    /// s, t ≥ 2: how often each pair of vertices is connected, in the mean; at most the number of light paths.
    pub connection: f64,
    /// t = 1, a vertex of a light walk shown to the lens: light paths per camera path, or 0.
    pub lens_splat: f64,
    /// t = 0, a light walk lands on the lens: light paths per camera path, or 0.
    pub lens_hit: f64,
    /// How techniques share a path.
    pub heuristic: Sharing,
    /// How much each of its samples counts in the image, where another stage's counts more or less.
    #[serde(default = "once")]
    pub weight: f64,
}

fn once() -> f64 {
    1.0
}

/// Names of the heuristics.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Sharing {
    /// By density.
    #[default]
    Balance,
    /// By density squared.
    Power,
}

/// The plans that have a name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Named {
    /// Whatever a pilot finds best for the scene.
    #[default]
    Auto,
    /// From the camera alone, with next event estimation.
    Path,
    /// From the lights alone.
    Light,
    /// From both ends, joined in every way.
    Bdpt,
}

impl Named {
    /// Its one stage, unless the scene decides.
    pub fn stage(self) -> Option<Stage> {
        match self {
            Self::Auto => None,
            Self::Path => Some(Stage::of(&Techniques::PATH)),
            Self::Light => Some(Stage::of(&Techniques::LIGHT)),
            Self::Bdpt => Some(Stage::BIDIRECTIONAL),
        }
    }

    /// As the command line spells it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Path => "path",
            Self::Light => "light",
            Self::Bdpt => "bdpt",
        }
    }
}

/// The most light paths per camera path, and light points per vertex.
const MOST: f64 = 1024.0;
/// The most that a sample may count.
const MOST_WEIGHT: f64 = 1e6;

impl Stage {
    /// Every technique, once.
    pub const BIDIRECTIONAL: Self = Self::of(&Techniques::BIDIRECTIONAL);

    /// These techniques from the first sample on, by the balance heuristic.
    pub const fn of(techniques: &Techniques) -> Self {
        let Techniques { light_hit, next_event, connection, lens_splat, lens_hit } = *techniques;
        Self { from: 0, light_hit, next_event, connection, lens_splat, lens_hit, heuristic: Sharing::Balance, weight: 1.0 }
    }

    /// Its counts.
    pub fn techniques(&self) -> Techniques {
        let Self { light_hit, next_event, connection, lens_splat, lens_hit, .. } = *self;
        Techniques { light_hit, next_event, connection, lens_splat, lens_hit }
    }

    /// How often it samples a kind of join.
    pub fn effort(&self, join: Join) -> f64 {
        self.techniques().effort(join)
    }

    /// What the kernel is to do, as far as the scene's integrator wants paths to go.
    pub fn strategy(&self, integrator: &Integrator) -> Strategy {
        Strategy {
            techniques: self.techniques(),
            heuristic: match self.heuristic {
                Sharing::Balance => Heuristic::Balance,
                Sharing::Power => Heuristic::Power,
            },
            max_depth: integrator.max_depth.unwrap_or(u32::MAX),
            rr_depth: integrator.rr_depth,
        }
    }

    /// What keeps it from being sampled, and the remedy.
    fn fault(&self) -> Option<(String, &'static str)> {
        let walks = self.techniques().light_walks();
        if self.light_hit != 0.0 && self.light_hit != 1.0 {
            return Some((format!("light_hit is {}", self.light_hit), "make it 0 or 1"));
        }
        if self.next_event.fract() != 0.0 || !(0.0..=MOST).contains(&self.next_event) {
            return Some((format!("next_event is {}", self.next_event), "make it a whole number up to 1024"));
        }
        let counts = [("connection", self.connection), ("lens_splat", self.lens_splat), ("lens_hit", self.lens_hit)];
        if let Some((name, count)) = counts.into_iter().find(|(_, count)| !(0.0..=MOST).contains(count)) {
            return Some((format!("{name} is {count}"), "make it a number up to 1024"));
        }
        if !(1.0 / MOST_WEIGHT..=MOST_WEIGHT).contains(&self.weight) {
            return Some((format!("weight is {}", self.weight), "make it a number from 1e-6 to 1e6"));
        }
        let shown = [("lens_splat", self.lens_splat), ("lens_hit", self.lens_hit)];
        let (name, count) = shown.into_iter().find(|(_, count)| *count != 0.0 && *count != walks)?;
        Some((format!("{name} is {count}, where there are {walks} light paths per camera path"), "make it that many, or 0"))
    }
}

impl Plan {
    /// One stage from beginning to end.
    pub fn fixed(stage: Stage) -> Self {
        Self { stages: vec![stage] }
    }

    /// The stage of a sample, and the first sample that is not of that stage.
    pub fn at(&self, sample: u32) -> Option<(&Stage, u32)> {
        let next = self.stages.partition_point(|stage| stage.from <= sample);
        let stage = self.stages.get(next.checked_sub(1)?)?;
        Some((stage, self.stages.get(next).map_or(u32::MAX, |stage| stage.from)))
    }

    /// The stage that comes last.
    pub fn last(&self) -> Option<&Stage> {
        self.stages.last()
    }

    /// Light paths per pixel that so many samples have, in the mean.
    pub fn light_paths(&self, samples: u32) -> f64 {
        let ends = self.stages.iter().skip(1).map(|stage| stage.from).chain([u32::MAX]);
        let of = |(stage, end): (&Stage, u32)| stage.techniques().light_walks() * f64::from(end.min(samples).saturating_sub(stage.from));
        self.stages.iter().zip(ends).map(of).sum()
    }

    /// Reads a plan.
    pub fn read(path: &Path) -> Result<Self> {
        let text = std::fs::read_to_string(path).map_err(|error| {
            Error::in_file(
                path,
                format!("the plan cannot be read: {error}"),
                "name a file that `--stats` or `explain --json` wrote a plan to",
            )
        })?;
        let plan: Self = serde_json::from_str(&text)
            .map_err(|error| Error::in_file(path, format!("this is no plan: {error}"), "see `plan` in the output of `explain --json`"))?;
        if plan.stages.first().is_none_or(|stage| stage.from != 0) {
            return Err(Error::in_file(path, "the first stage does not begin with sample 0", "give it `\"from\": 0`"));
        }
        if let Some(pair) = plan.stages.windows(2).find(|pair| pair[0].from >= pair[1].from) {
            let thing = format!("a stage from sample {} comes after one from {}", pair[1].from, pair[0].from);
            return Err(Error::in_file(path, thing, "list stages in the order of their `from`"));
        }
        match plan.stages.iter().find_map(Stage::fault) {
            Some((thing, remedy)) => Err(Error::in_file(path, thing, remedy)),
            None => Ok(plan),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Plan> {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), text).unwrap();
        Plan::read(file.path())
    }

    const BDPT: &str = r#""light_hit": 1, "next_event": 1, "connection": 1, "lens_splat": 1, "lens_hit": 1, "heuristic": "balance""#;

    #[test]
    fn a_sample_belongs_to_the_last_stage_that_began() {
        let plan = read(&format!(r#"{{"stages": [{{{BDPT}}}, {{"from": 8, {BDPT}}}]}}"#)).unwrap();
        let at = |sample| plan.at(sample).map(|(stage, end)| (stage.from, end));
        assert_eq!([at(0), at(7), at(8), at(100)], [Some((0, 8)), Some((0, 8)), Some((8, u32::MAX)), Some((8, u32::MAX))]);
    }

    #[test]
    fn what_cannot_be_sampled_is_refused_with_a_remedy() {
        let with = |from: &str, to: &str| read(&format!(r#"{{"stages": [{{{}}}]}}"#, BDPT.replace(from, to)));
        let refused = [
            (with("\"light_hit\": 1", "\"light_hit\": 2"), "0 or 1"),
            (with("\"next_event\": 1", "\"next_event\": 0.5"), "whole number"),
            (with("\"connection\": 1", "\"connection\": -1"), "up to 1024"),
            (with("\"light_hit\"", "\"weight\": 0, \"light_hit\""), "from 1e-6"),
            (with("\"lens_splat\": 1", "\"lens_splat\": 0.5"), "make it that many, or 0"),
            (with("\"connection\": 1", "\"connection\": 2"), "make it that many, or 0"),
            (with("\"light_hit\"", "\"from\": 3, \"light_hit\""), "sample 0"),
            (read(r#"{"stages": []}"#), "sample 0"),
            (read(&format!(r#"{{"stages": [{{{BDPT}}}, {{{BDPT}}}]}}"#)), "in the order"),
        ];
        for (result, words) in refused {
            let error = result.unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        }
        assert!(with("\"connection\": 1", "\"connection\": 0.25").is_ok());
        assert!(with("\"lens_hit\": 1", "\"lens_hit\": 0").is_ok());
    }
}
