//! The plugins of a scene, and one thread's instances of them.

use std::{
    cell::{Cell, RefCell},
    fmt,
    path::Path,
    sync::Arc,
    time::Instant,
};

use bidir_abi::{EmitOut, EvalOut, EvalRecord, ProfileOut, SampleOut, VertexOut, carried};
use bidir_kernel::{BATCH, Bsdf, Carried, Emitted, Lobe, Profile, Real, Scatter, Scattered, Spectrum, Vec2, Vec3, profile::Profiled};

use super::{
    answer::{self, Flaw},
    fault::{Cause, Fault},
    instance::{Failure, Instance},
    meter::{Meter, Metered},
    module::Module,
    parameters::Value,
    quarantine::{Asked, Quarantine, Quarantined},
};
use crate::error::{Error, Result};

/// A plugin with its parameters: a shader. Valid in the [`Roster`] that gave it, and in its sandboxes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShaderId {
    module: u32,
    /// Where its parameter block begins, among the module's blocks.
    offset: u32,
}

/// The plugins that a scene uses, each with all its parameter blocks. Threads share it.
#[derive(Clone, Debug, Default)]
pub struct Roster {
    entries: Vec<Entry>,
}

#[derive(Clone, Debug)]
struct Entry {
    module: Arc<Module>,
    blocks: Vec<u8>,
    lobes: Lobe,
}

impl Roster {
    /// Adds a shader: a module with values for its parameters, by name; those left out have their defaults.
    ///
    /// # Errors
    /// If the module has no such parameter, or the value is not of its type or out of its range.
    pub fn shader(&mut self, module: &Arc<Module>, values: &[(&str, Value)]) -> Result<ShaderId> {
        let mut block = module.manifest().defaults();
        for (name, value) in values {
            let refused = |thing: String, remedy: &str| Error::in_file(module.file(), thing, remedy);
            let Some(parameter) = module.manifest().parameter(name) else {
                let known: Vec<_> = module.manifest().params.iter().map(|parameter| parameter.name.as_str()).collect();
                return Err(refused(format!("there is no parameter \"{name}\""), &format!("it has {}", known.join(", "))));
            };
            parameter.write(value, &mut block).map_err(|why| refused(format!("parameter \"{name}\" {why}"), "give another value"))?;
        }
        Ok(self.add(module, &block))
    }

    /// Adds a shader whose parameter block is written already.
    pub fn add(&mut self, module: &Arc<Module>, block: &[u8]) -> ShaderId {
        let known = self.entries.iter().position(|entry| Arc::ptr_eq(&entry.module, module));
        let index = known.unwrap_or_else(|| {
            self.entries.push(Entry { module: Arc::clone(module), blocks: Vec::new(), lobes: module.manifest().lobes() });
            self.entries.len() - 1
        });
        let blocks = &mut self.entries[index].blocks;
        let offset = blocks.len() as u32;
        blocks.extend_from_slice(block);
        // Blocks begin at multiples of 16, whatever their length.
        blocks.resize(blocks.len().next_multiple_of(16), 0);
        ShaderId { module: index as u32, offset }
    }
}

/// What a bad answer does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Strictness {
    /// It is left out, and counted.
    #[default]
    Lenient,
    /// It is a fault.
    Strict,
}

/// One thread's plugins. Answers are black once there is a [`Sandbox::fault`].
pub struct Sandbox {
    roster: Arc<Roster>,
    slots: Vec<RefCell<Slot>>,
    strictness: Strictness,
    tile: Cell<u64>,
    /// Whether a call broke off or calls are metered: all that a question has to look at beforehand.
    unusual: Cell<bool>,
    faulted: Cell<bool>,
    fault: RefCell<Option<Fault>>,
    quarantine: RefCell<Quarantine>,
    meter: RefCell<Option<Meter>>,
}

#[derive(Default)]
struct Slot {
    instance: Option<Instance>,
}

impl fmt::Debug for Sandbox {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Sandbox").field("roster", &self.roster).finish_non_exhaustive()
    }
}

impl Sandbox {
    /// A sandbox with no instance yet: each is made when it is first asked.
    pub fn new(roster: Arc<Roster>, strictness: Strictness) -> Self {
        Self {
            slots: roster.entries.iter().map(|_| RefCell::default()).collect(),
            roster,
            strictness,
            tile: Cell::new(0),
            unusual: Cell::new(false),
            faulted: Cell::new(false),
            fault: RefCell::new(None),
            quarantine: RefCell::default(),
            meter: RefCell::default(),
        }
    }

    /// Begins a piece of work, all instances forgotten: what a plugin kept from earlier calls cannot reach this one,
    /// so that an image does not depend on which thread does which piece. `tile` is the piece's number. Begin one now and then: all calls
    /// of a piece may take [`super::TILE_LIMIT`] together.
    pub fn begin_tile(&self, tile: u64) {
        self.tile.set(tile);
        for slot in &self.slots {
            slot.borrow_mut().instance = None;
        }
    }

    /// Whether a call broke off. Cheap: look after every path, and discard that path.
    #[inline(always)]
    pub fn faulted(&self) -> bool {
        self.faulted.get()
    }

    /// The first call that broke off.
    pub fn fault(&self) -> Option<Fault> {
        self.fault.borrow().clone()
    }

    /// The bad answers so far.
    pub fn quarantine(&self) -> Quarantine {
        self.quarantine.borrow().clone()
    }

    /// The modules' files, in the order of [`Sandbox::metered`].
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        self.roster.entries.iter().map(|entry| entry.module.file())
    }

    /// Does some work, and tells what each module was asked in it. A clock is read around each question, so the work takes longer;
    /// without this, nothing is spent on telling.
    pub fn metered<T>(&self, work: impl FnOnce() -> T) -> (T, Vec<Metered>) {
        self.meter.replace(Some(Meter::new(self.slots.len())));
        self.unusual.set(true);
        let done = work();
        self.unusual.set(self.faulted.get());
        (done, self.meter.take().map(Meter::read).unwrap_or_default())
    }

    /// The shader as a surface.
    #[inline]
    pub fn bsdf(&self, id: ShaderId) -> SandboxedBsdf<'_> {
        SandboxedBsdf { sandbox: self, id }
    }

    /// The shader as an emission profile.
    #[inline]
    pub fn profile(&self, id: ShaderId) -> SandboxedProfile<'_> {
        SandboxedProfile { sandbox: self, id }
    }

    /// Changes parameters of a shader in this thread, such as those that a texture decides, until the tile ends:
    /// for each, its offset in the block, its value, and how many channels of that it has.
    #[inline]
    pub fn set(&self, id: ShaderId, values: impl IntoIterator<Item = (u32, Spectrum, usize)>) {
        self.ask(id, |instance, block| {
            for (offset, value, channels) in values {
                let mut bytes = [[0; 4]; 3];
                for (bytes, channel) in bytes.iter_mut().zip(value.0) {
                    *bytes = channel.to_le_bytes();
                }
                instance.write(block + offset, bytes[..channels.min(3)].as_flattened());
            }
            Ok(())
        });
    }

    /// How large the memory of a shader's instance is; `None` after a fault.
    pub fn memory_bytes(&self, id: ShaderId) -> Option<usize> {
        self.ask(id, |instance, _| Ok(instance.memory_bytes()))
    }

    /// Calls into a shader's instance.
    #[inline]
    fn ask<T>(&self, id: ShaderId, question: impl FnOnce(&mut Instance, u32) -> std::result::Result<T, Failure>) -> Option<T> {
        if self.unusual.get() { self.ask_metered(id, question) } else { self.put(id, question) }
    }

    /// The same with a look at the clock before and after, but for what it takes to make an instance.
    #[cold]
    #[inline(never)]
    fn ask_metered<T>(&self, id: ShaderId, question: impl FnOnce(&mut Instance, u32) -> std::result::Result<T, Failure>) -> Option<T> {
        if self.faulted.get() {
            return None;
        }
        self.put(id, |instance, block| {
            let (before, start) = (instance.calls(), Instant::now());
            let done = question(instance, block);
            let took = start.elapsed();
            if let Some(meter) = &mut *self.meter.borrow_mut() {
                meter.add(id.module as usize, instance.calls() - before, took);
            }
            done
        })
    }

    #[inline(always)]
    fn put<T>(&self, id: ShaderId, question: impl FnOnce(&mut Instance, u32) -> std::result::Result<T, Failure>) -> Option<T> {
        let mut slot = self.slots[id.module as usize].borrow_mut();
        let done = match &mut slot.instance {
            Some(instance) => {
                let block = instance.block(id.offset);
                question(instance, block)
            }
            none => self.made(id).and_then(|instance| {
                let instance = none.insert(instance);
                let block = instance.block(id.offset);
                question(instance, block)
            }),
        };
        match done {
            Ok(answer) => Some(answer),
            Err(failure) => {
                self.break_off(id, failure);
                None
            }
        }
    }

    #[cold]
    fn made(&self, id: ShaderId) -> std::result::Result<Instance, Failure> {
        let Entry { module, blocks, .. } = &self.roster.entries[id.module as usize];
        module.instance(blocks)
    }

    #[cold]
    fn break_off(&self, id: ShaderId, failure: Failure) {
        self.faulted.set(true);
        self.unusual.set(true);
        self.fault.borrow_mut().get_or_insert_with(|| self.roster.entries[id.module as usize].module.fault(*failure));
    }

    /// Leaves a bad answer out.
    #[cold]
    fn refuse(&self, id: ShaderId, asked: Asked, flaw: Flaw) {
        let Entry { module, blocks, .. } = &self.roster.entries[id.module as usize];
        let parameters = module.manifest().words(&blocks[id.offset as usize..]);
        let entry = Quarantined { file: module.file().to_owned(), asked, flaw, parameters, count: 1, tile: self.tile.get() };
        if self.strictness == Strictness::Strict {
            self.break_off(id, Box::new((asked.export(), Cause::Refused(format!("{flaw}, for {asked}")))));
        }
        self.quarantine.borrow_mut().add(entry);
    }
}

/// A plugin as a surface.
#[derive(Clone, Copy, Debug)]
pub struct SandboxedBsdf<'a> {
    sandbox: &'a Sandbox,
    id: ShaderId,
}

impl Bsdf for SandboxedBsdf<'_> {
    #[inline]
    fn eval(&self, wo: Vec3, wi: Vec3, carried: Carried) -> Scatter {
        let answered = self.sandbox.ask(self.id, |instance, block| {
            instance.bsdf_eval(block, code(carried), wo.to_array(), wi.to_array())?;
            Ok(self.evaluated(&EvalOut::from_bytes(instance.record()), wo, wi, carried))
        });
        answered.unwrap_or(Scatter::NONE)
    }

    #[inline]
    fn sample(&self, wo: Vec3, u: [Real; 3], carried: Carried) -> Option<Scattered> {
        let answered = self.sandbox.ask(self.id, |instance, block| {
            instance.bsdf_sample(block, code(carried), wo.to_array(), u)?;
            Ok(self.sampled(&SampleOut::from_bytes(instance.record()), wo, u, carried))
        });
        answered.flatten()
    }

    #[inline]
    fn lobes(&self) -> Lobe {
        self.sandbox.roster.entries[self.id.module as usize].lobes
    }

    #[inline]
    fn eval_n(&self, wo: Vec3, wi: &[Vec3], carried: Carried, scatters: &mut [Scatter]) {
        if (2..=BATCH).contains(&wi.len()) {
            let answered = self.sandbox.ask(self.id, |instance, block| {
                let asked = instance.bsdf_eval_n(block, code(carried), wo.to_array(), wi)?;
                if asked {
                    for ((scatter, record), wi) in scatters.iter_mut().zip(instance.pairs()).zip(wi) {
                        *scatter = self.evaluated(&EvalRecord::from_bytes(record).out, wo, *wi, carried);
                    }
                }
                Ok(asked)
            });
            match answered {
                Some(true) => return,
                None => return scatters.fill(Scatter::NONE),
                Some(false) => {}
            }
        }
        for (scatter, wi) in scatters.iter_mut().zip(wi) {
            *scatter = self.eval(wo, *wi, carried);
        }
    }

    #[inline]
    fn eval_and_sample(&self, wo: Vec3, wi: Vec3, u: [Real; 3], carried: Carried) -> (Scatter, Option<Scattered>) {
        // The answer is written where it is wanted: what a call answers is moved as little as it can be.
        let mut answer = (Scatter::NONE, None);
        let asked = self.sandbox.ask(self.id, |instance, block| {
            let asked = instance.bsdf_vertex(block, code(carried), wo.to_array(), wi.to_array(), u)?;
            if asked {
                let VertexOut { eval, sample } = VertexOut::from_bytes(instance.record());
                answer = (self.evaluated(&eval, wo, wi, carried), self.sampled(&sample, wo, u, carried));
            }
            Ok(asked)
        });
        if asked == Some(false) {
            answer = (self.eval(wo, wi, carried), self.sample(wo, u, carried));
        }
        answer
    }
}

impl SandboxedBsdf<'_> {
    #[inline(always)]
    fn evaluated(&self, out: &EvalOut, wo: Vec3, wi: Vec3, carried: Carried) -> Scatter {
        answer::scatter(out).unwrap_or_else(|flaw| {
            self.sandbox.refuse(self.id, Asked::Eval { wo: wo.to_array(), wi: wi.to_array(), carried }, flaw);
            Scatter::NONE
        })
    }

    #[inline(always)]
    fn sampled(&self, out: &SampleOut, wo: Vec3, u: [Real; 3], carried: Carried) -> Option<Scattered> {
        answer::scattered(out, wo.z, self.lobes()).unwrap_or_else(|flaw| {
            self.sandbox.refuse(self.id, Asked::Sample { wo: wo.to_array(), u, carried }, flaw);
            None
        })
    }
}

#[inline(always)]
fn code(carried: Carried) -> i32 {
    match carried {
        Carried::Radiance => carried::RADIANCE,
        Carried::Importance => carried::IMPORTANCE,
    }
}

/// A plugin as an emission profile.
#[derive(Clone, Copy, Debug)]
pub struct SandboxedProfile<'a> {
    sandbox: &'a Sandbox,
    id: ShaderId,
}

const DARK: Profiled = Profiled { radiance: Spectrum::BLACK, pdf: bidir_kernel::PerSolidAngle(0.0) };

impl Profile for SandboxedProfile<'_> {
    #[inline]
    fn eval(&self, uv: Vec2, direction: Vec3) -> Profiled {
        let (uv, w) = (uv.to_array(), direction.to_array());
        let answered = self.sandbox.ask(self.id, |instance, block| {
            instance.light_eval(block, uv, w)?;
            Ok(answer::profiled(&ProfileOut::from_bytes(instance.record())).unwrap_or_else(|flaw| {
                self.sandbox.refuse(self.id, Asked::Profile { uv, w }, flaw);
                DARK
            }))
        });
        answered.unwrap_or(DARK)
    }

    #[inline]
    fn emit(&self, uv: Vec2, u: [Real; 2]) -> Option<Emitted> {
        let uv = uv.to_array();
        let answered = self.sandbox.ask(self.id, |instance, block| {
            instance.light_emit(block, uv, u)?;
            Ok(answer::emitted(&EmitOut::from_bytes(instance.record())).unwrap_or_else(|flaw| {
                self.sandbox.refuse(self.id, Asked::Emit { uv, u }, flaw);
                None
            }))
        });
        answered.flatten()
    }
}
