//! The plan: which techniques a render runs, how they share a path, and what it rests on: what a scene holds ([`contents`]),
//! what can happen to light in it ([`effects`]), which joins that leaves ([`joins`]), and what none of them finds ([`gaps`]).

pub mod contents;
pub mod effects;
pub mod gaps;
pub mod joins;

use std::path::Path;

use bidir_kernel::{Heuristic, Strategy, Techniques};
use serde::{Deserialize, Serialize};

use crate::{
    error::{Error, Result},
    scene::description::Integrator,
};

/// A plan as a file holds it. The same scene, seed, samples and plan give the same image bit for bit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plan {
    /// s = 0, a camera walk lands on a light: 0 or 1.
    pub light_hit: f64,
    /// s = 1: light points per vertex of a camera walk, a whole number.
    pub next_event: f64,
    /// s, t ≥ 2: 0 or 1.
    pub connection: f64,
    /// t = 1, a vertex of a light walk shown to the lens: 0 or 1.
    pub lens_splat: f64,
    /// t = 0, a light walk lands on the lens: 0 or 1.
    pub lens_hit: f64,
    /// How techniques share a path.
    pub heuristic: Sharing,
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
    /// Whatever suits the scene; today every technique.
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
    /// Its plan.
    pub fn plan(self) -> Plan {
        let techniques = match self {
            Self::Auto | Self::Bdpt => Techniques::BIDIRECTIONAL,
            Self::Path => Techniques::PATH,
            Self::Light => Techniques::LIGHT,
        };
        Plan {
            light_hit: techniques.light_hit,
            next_event: techniques.next_event,
            connection: techniques.connection,
            lens_splat: techniques.lens_splat,
            lens_hit: techniques.lens_hit,
            heuristic: Sharing::Balance,
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

impl Plan {
    /// Reads a plan; one light walk per camera walk is all that can be made today.
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
        let once =
            [("light_hit", plan.light_hit), ("connection", plan.connection), ("lens_splat", plan.lens_splat), ("lens_hit", plan.lens_hit)];
        for (name, effort) in once {
            if effort != 0.0 && effort != 1.0 {
                return Err(Error::in_file(path, format!("{name} is {effort}"), "make it 0 or 1"));
            }
        }
        if plan.next_event.fract() != 0.0 || !(0.0..=1024.0).contains(&plan.next_event) {
            return Err(Error::in_file(path, format!("next_event is {}", plan.next_event), "make it a whole number up to 1024"));
        }
        Ok(plan)
    }

    /// What the kernel is to do, as far as the scene's integrator wants paths to go.
    pub fn strategy(&self, integrator: &Integrator) -> Strategy {
        let Self { light_hit, next_event, connection, lens_splat, lens_hit, heuristic } = *self;
        Strategy {
            techniques: Techniques { light_hit, next_event, connection, lens_splat, lens_hit },
            heuristic: match heuristic {
                Sharing::Balance => Heuristic::Balance,
                Sharing::Power => Heuristic::Power,
            },
            max_depth: integrator.max_depth.unwrap_or(u32::MAX),
            rr_depth: integrator.rr_depth,
        }
    }
}
