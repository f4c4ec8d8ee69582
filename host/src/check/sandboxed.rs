//! Plugins as what can be checked.

use std::sync::Arc;

use bidir_kernel::{Bsdf, Profile};

use super::{
    parameters::{self, Block},
    subject::{Instance, Lamp, Lamps, Promises, Refusal, Set, Surface, Surfaces},
};
use crate::{
    error::Result,
    plugin::{EmitsFrom, Module, Roster, Sandbox, ShaderId, Strictness, Value},
};

/// A plugin with many sets of parameters, each instance in a sandbox of its own.
#[derive(Clone, Debug)]
pub struct Plugin {
    module: Arc<Module>,
    roster: Arc<Roster>,
    sets: Vec<Set>,
    shaders: Vec<ShaderId>,
    left_out: Vec<String>,
}

impl Plugin {
    /// A module with parameters all over the space that its manifest declares; those that are `given` stay as they are.
    ///
    /// # Errors
    /// If the module has no such parameter, or a value is not of its type or out of its range.
    pub fn new(module: &Arc<Module>, given: &[(String, Value)], seed: u64) -> Result<Self> {
        // The roster says what is wrong with a value.
        let given: Vec<_> = given.iter().map(|(name, value)| (name.as_str(), value.clone())).collect();
        Roster::default().shader(module, &given)?;
        let left_out = parameters::narrowed(module.manifest(), &given);
        Ok(Self { left_out, ..Self::of(module, parameters::all_over(module.manifest(), &given, seed)) })
    }

    /// A module with one set of parameters, the rest at their defaults.
    ///
    /// # Errors
    /// As [`Plugin::new`].
    pub fn with(module: &Arc<Module>, given: &[(String, Value)]) -> Result<Self> {
        let given: Vec<_> = given.iter().map(|(name, value)| (name.as_str(), value.clone())).collect();
        Roster::default().shader(module, &given)?;
        Ok(Self::of(module, vec![parameters::one(module.manifest(), &given)]))
    }

    fn of(module: &Arc<Module>, blocks: Vec<Block>) -> Self {
        let mut roster = Roster::default();
        let shaders = blocks.iter().map(|block| roster.add(module, &block.bytes)).collect();
        let sets = blocks.into_iter().map(|block| block.set).collect();
        Self { module: Arc::clone(module), roster: Arc::new(roster), sets, shaders, left_out: Vec::new() }
    }

    fn instance(&self) -> Sandboxed<'_> {
        let sandbox = Sandbox::new(Arc::clone(&self.roster), Strictness::Lenient);
        Sandboxed { sandbox, shaders: &self.shaders }
    }
}

impl Surfaces for Plugin {
    fn sets(&self) -> &[Set] {
        &self.sets
    }

    fn promises(&self) -> Promises {
        let manifest = self.module.manifest();
        Promises { lobes: manifest.lobes(), reciprocal: manifest.reciprocal, isotropic: manifest.isotropic }
    }

    fn left_out(&self) -> Vec<String> {
        self.left_out.clone()
    }

    fn open(&self) -> Box<dyn Surface + '_> {
        Box::new(self.instance())
    }
}

impl Lamps for Plugin {
    fn sets(&self) -> &[Set] {
        &self.sets
    }

    fn on_surfaces(&self) -> bool {
        self.module.manifest().emits_from.contains(&EmitsFrom::Area)
    }

    fn left_out(&self) -> Vec<String> {
        self.left_out.clone()
    }

    fn open(&self) -> Box<dyn Lamp + '_> {
        Box::new(self.instance())
    }
}

struct Sandboxed<'a> {
    sandbox: Sandbox,
    shaders: &'a [ShaderId],
}

impl Instance for Sandboxed<'_> {
    fn refusals(&self) -> Vec<Refusal> {
        let quarantined = self.sandbox.quarantine().0.into_iter();
        quarantined.map(|entry| Refusal { asked: entry.asked, flaw: entry.flaw, count: entry.count }).collect()
    }

    fn broken(&self) -> Option<String> {
        self.sandbox.fault().map(|fault| format!("{}: {}", fault.export, fault.cause))
    }

    fn memory_bytes(&self) -> Option<usize> {
        self.shaders.first().and_then(|shader| self.sandbox.memory_bytes(*shader))
    }
}

impl Surface for Sandboxed<'_> {
    fn bsdf(&self, set: usize) -> Box<dyn Bsdf + '_> {
        Box::new(self.sandbox.bsdf(self.shaders[set]))
    }
}

impl Lamp for Sandboxed<'_> {
    fn profile(&self, set: usize) -> Box<dyn Profile + '_> {
        Box::new(self.sandbox.profile(self.shaders[set]))
    }
}
