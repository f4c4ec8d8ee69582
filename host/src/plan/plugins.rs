//! What plugins have to do with a choice: how much of a sample's time their calls take, and what would be chosen if they took none.

use serde::Serialize;

use super::{
    Stage,
    choice::{Candidate, Choice, Costs},
};

/// What a pilot measured of a scene's plugins.
#[derive(Clone, Debug, Default)]
pub struct Measured {
    /// Every module, called or not.
    pub modules: Vec<Calls>,
    /// What samples would cost if no call took any time.
    pub without: Costs,
}

/// A module's calls, in the parts that a sample is made of.
#[derive(Clone, Debug)]
pub struct Calls {
    /// The name of its file.
    pub module: String,
    /// How many there are, in place of nanoseconds.
    pub calls: Costs,
    /// Their time.
    pub time: Costs,
}

/// A module's part in the chosen plan.
#[derive(Clone, Debug, Serialize)]
pub struct Plugin {
    /// The name of its file.
    pub module: String,
    /// Calls in a sample of the chosen plan.
    pub calls: f64,
    /// Nanoseconds of a call there; of any part's where that plan has none.
    pub nanoseconds: f64,
    /// Its part of the time of a sample.
    pub share: f64,
    /// Calls in each part that a sample may have, whether the plan has it or not.
    pub calls_in: Costs,
}

impl Choice {
    /// The same choice with what there is to say of plugins.
    pub fn with_plugins(self, measured: &Measured) -> Self {
        let Candidate { stage, cost, .. } = &self.chosen;
        let share = (1.0 - measured.without.of(stage) / cost.max(f64::MIN_POSITIVE)).max(0.0);
        let time: f64 = measured.modules.iter().map(|module| module.time.of(stage)).sum();
        let called = measured.modules.iter().filter(|module| all(&module.calls) > 0.0);
        let plugins: Vec<_> = called.map(|module| module.in_plan(stage, share / time.max(f64::MIN_POSITIVE))).collect();
        let without_plugins = (!plugins.is_empty()).then(|| self.at(&measured.without));
        Self { plugins, without_plugins, ..self }
    }
}

impl Calls {
    fn in_plan(&self, stage: &Stage, share_per_nanosecond: f64) -> Plugin {
        let (calls, time) = (self.calls.of(stage), self.time.of(stage));
        let nanoseconds = if calls > 0.0 { time / calls } else { all(&self.time) / all(&self.calls) };
        Plugin { module: self.module.clone(), calls, nanoseconds, share: time * share_per_nanosecond, calls_in: self.calls }
    }
}

fn all(costs: &Costs) -> f64 {
    costs.camera_path + costs.light_path + costs.connections
}
