//! One module at work: an instance in a store of its own, asked through records in its memory.

use std::time::Duration;

use bidir_abi::{EvalRecord, Version, export, limit};
use bidir_kernel::{BATCH, Vec3};
use wasmtime::{Instance as Wasm, InstancePre, Memory, Store, StoreLimits, StoreLimitsBuilder, Trap, TypedFunc, UpdateDeadline};

use super::{
    engine::{Clock, TICK},
    fault::Cause,
    manifest::Kind,
};

/// How long one call may take.
pub const CALL_LIMIT: Duration = Duration::from_millis(limit::CALL_MILLISECONDS);

/// How long all calls of one tile may take together.
pub const TILE_LIMIT: Duration = Duration::from_secs(10);

/// Slices of time that a call may be seen in. The first one may have begun before the call did.
const CALL_SLICES: u32 = (CALL_LIMIT.as_millis() / TICK.as_millis()) as u32;

const TILE_TICKS: u64 = (TILE_LIMIT.as_millis() / TICK.as_millis()) as u64;

/// ω_o, ω_i or numbers, after the addresses of record and parameters and the code of what is carried.
type OfBsdf = TypedFunc<(u32, u32, i32, f32, f32, f32, f32, f32, f32), ()>;
/// The addresses of the records, their number, the address of the parameters and the code of what is carried.
type OfPairs = TypedFunc<(u32, u32, u32, i32), ()>;
/// As [`OfBsdf`], with ω_o, ω_i and numbers.
type OfVertex = TypedFunc<(u32, u32, i32, f32, f32, f32, f32, f32, f32, f32, f32, f32), ()>;
/// After the addresses of record and parameters: surface coordinates and two numbers.
type Emit = TypedFunc<(u32, u32, f32, f32, f32, f32), ()>;
/// After the addresses of record and parameters: surface coordinates and a direction.
type Profile = TypedFunc<(u32, u32, f32, f32, f32, f32, f32), ()>;

/// The export that failed, and how. It is boxed, so that answers need not make room for it.
pub(super) type Failure = Box<(&'static str, Cause)>;

#[cold]
fn failure(export: &'static str, cause: Cause) -> Failure {
    Box::new((export, cause))
}

/// Bytes at the region's start for the record of one answer.
const RECORD: u32 = 64;

/// As many bytes more, for the records of many pairs, if the module takes them.
const PAIRS: u32 = (BATCH * EvalRecord::BYTES).next_multiple_of(16) as u32;

/// What a store knows of the call under way.
#[derive(Debug)]
pub(super) struct State {
    limits: StoreLimits,
    /// Times the clock found this call running.
    slices: u32,
}

/// A module at work.
pub(super) struct Instance {
    store: Store<State>,
    memory: Memory,
    functions: Functions,
    clock: Clock,
    /// Where the host's region begins.
    region: u32,
    /// Where the parameter blocks begin.
    blocks: u32,
    /// Ticks spent in calls.
    spent: u64,
    /// Calls so far.
    calls: u64,
}

enum Functions {
    Bsdf { eval: OfBsdf, sample: OfBsdf, eval_n: Option<OfPairs>, vertex: Option<OfVertex> },
    Light { emit: Emit, eval: Profile },
}

impl Instance {
    /// An instance of its own memory, with `blocks` of parameters written one after another from [`Instance::block`] (0) on.
    pub(super) fn new(module: &InstancePre<State>, clock: Clock, kind: Kind, blocks: &[u8]) -> Result<Self, Failure> {
        let mut store = store(module.module().engine());
        let wasm = module.instantiate(&mut store).map_err(|error| failure("start", cause(&error, Cause::Unready)))?;
        let missing = |name| failure(name, Cause::Unready("the export is missing".to_owned()));
        let memory = wasm.get_memory(&mut store, export::MEMORY).ok_or_else(|| missing(export::MEMORY))?;
        let functions = Functions::of(kind, &wasm, &mut store)?;
        let scratch = typed::<u32, u32>(&wasm, &mut store, export::SCRATCH)?;
        let records = RECORD + if functions.take_pairs() { PAIRS } else { 0 };
        let bytes = records + blocks.len() as u32;
        begin(&mut store);
        let region = scratch.call(&mut store, bytes).map_err(|error| failure(export::SCRATCH, cause(&error, Cause::Trap)))?;
        let mut instance = Self { store, memory, functions, clock, region, blocks: region.saturating_add(records), spent: 0, calls: 0 };
        instance.take_region(bytes)?;
        instance.write(instance.block(0), blocks);
        Ok(instance)
    }

    /// Whether all of the region that the module gave lies in its memory.
    fn take_region(&self, bytes: u32) -> Result<(), Failure> {
        let refused = |why: String| Err(failure(export::SCRATCH, Cause::Unready(why)));
        let size = self.memory.data_size(&self.store);
        match self.region {
            0 => refused(format!("it has no room for the {bytes} bytes of records and parameters")),
            region if !region.is_multiple_of(limit::SCRATCH_ALIGNMENT as u32) => {
                refused(format!("it gave address {region}, which is not a multiple of 16"))
            }
            region if region as usize + bytes as usize > size => {
                refused(format!("it gave {bytes} bytes at address {region}, but its memory ends at {size}"))
            }
            _ => Ok(()),
        }
    }

    /// The address of the parameters that were written `offset` bytes into the blocks.
    #[inline]
    pub(super) fn block(&self, offset: u32) -> u32 {
        self.blocks + offset
    }

    /// Of its memory, as large as it is now.
    pub(super) fn memory_bytes(&self) -> usize {
        self.memory.data_size(&self.store)
    }

    /// How often it was called.
    pub(super) fn calls(&self) -> u64 {
        self.calls
    }

    /// Writes parameters. The place must lie in the host's region.
    #[inline]
    pub(super) fn write(&mut self, address: u32, bytes: &[u8]) {
        if let Some(place) = self.memory.data_mut(&mut self.store).get_mut(address as usize..address as usize + bytes.len()) {
            place.copy_from_slice(bytes);
        }
    }

    /// `bidir_abi`'s answer.
    pub(super) fn version(module: &InstancePre<State>) -> Result<Version, Failure> {
        let mut store = store(module.module().engine());
        let wasm = module.instantiate(&mut store).map_err(|error| failure("start", cause(&error, Cause::Unready)))?;
        let version = typed::<(), i32>(&wasm, &mut store, export::ABI)?;
        begin(&mut store);
        version.call(&mut store, ()).map(Version::unpack).map_err(|error| failure(export::ABI, cause(&error, Cause::Trap)))
    }

    /// Asks `bsdf_eval`; the answer is an [`Instance::record`].
    #[inline]
    pub(super) fn bsdf_eval(&mut self, block: u32, carried: i32, wo: [f32; 3], wi: [f32; 3]) -> Result<(), Failure> {
        let Functions::Bsdf { eval, .. } = &self.functions else { return Err(absent(export::BSDF_EVAL)) };
        let start = self.clock.now();
        begin(&mut self.store);
        let done = eval.call(&mut self.store, (self.region, block, carried, wo[0], wo[1], wo[2], wi[0], wi[1], wi[2]));
        self.end(export::BSDF_EVAL, start, done)
    }

    /// Asks `bsdf_sample`; the answer is an [`Instance::record`].
    #[inline]
    pub(super) fn bsdf_sample(&mut self, block: u32, carried: i32, wo: [f32; 3], u: [f32; 3]) -> Result<(), Failure> {
        let Functions::Bsdf { sample, .. } = &self.functions else { return Err(absent(export::BSDF_SAMPLE)) };
        let start = self.clock.now();
        begin(&mut self.store);
        let done = sample.call(&mut self.store, (self.region, block, carried, wo[0], wo[1], wo[2], u[0], u[1], u[2]));
        self.end(export::BSDF_SAMPLE, start, done)
    }

    /// Asks `bsdf_vertex`; the answer is an [`Instance::record`]. False if the module has none.
    #[inline]
    pub(super) fn bsdf_vertex(&mut self, block: u32, carried: i32, wo: [f32; 3], wi: [f32; 3], u: [f32; 3]) -> Result<bool, Failure> {
        let Functions::Bsdf { vertex: Some(vertex), .. } = &self.functions else { return Ok(false) };
        let start = self.clock.now();
        begin(&mut self.store);
        let arguments = (self.region, block, carried, wo[0], wo[1], wo[2], wi[0], wi[1], wi[2], u[0], u[1], u[2]);
        let done = vertex.call(&mut self.store, arguments);
        self.end(export::BSDF_VERTEX, start, done).map(|()| true)
    }

    /// Asks `bsdf_eval_n` about ω_o and each of `wi`, at most [`BATCH`]; the answers are the [`Instance::pairs`]. False if the module has none.
    #[inline]
    pub(super) fn bsdf_eval_n(&mut self, block: u32, carried: i32, wo: [f32; 3], wi: &[Vec3]) -> Result<bool, Failure> {
        let Functions::Bsdf { eval_n: Some(eval_n), .. } = &self.functions else { return Ok(false) };
        let pairs = self.region + RECORD;
        let records = self.memory.data_mut(&mut self.store).get_mut(pairs as usize..).unwrap_or_default();
        for (record, wi) in records.as_chunks_mut::<{ EvalRecord::BYTES }>().0.iter_mut().zip(wi) {
            for (place, number) in record.as_chunks_mut().0.iter_mut().zip([wo[0], wo[1], wo[2], wi.x, wi.y, wi.z]) {
                *place = number.to_le_bytes();
            }
        }
        let start = self.clock.now();
        begin(&mut self.store);
        let done = eval_n.call(&mut self.store, (pairs, wi.len() as u32, block, carried));
        self.end(export::BSDF_EVAL_N, start, done).map(|()| true)
    }

    /// Asks `light_emit`; the answer is an [`Instance::record`].
    #[inline]
    pub(super) fn light_emit(&mut self, block: u32, uv: [f32; 2], u: [f32; 2]) -> Result<(), Failure> {
        let Functions::Light { emit, .. } = &self.functions else { return Err(absent(export::LIGHT_EMIT)) };
        let start = self.clock.now();
        begin(&mut self.store);
        let done = emit.call(&mut self.store, (self.region, block, uv[0], uv[1], u[0], u[1]));
        self.end(export::LIGHT_EMIT, start, done)
    }

    /// Asks `light_eval`; the answer is an [`Instance::record`].
    #[inline]
    pub(super) fn light_eval(&mut self, block: u32, uv: [f32; 2], w: [f32; 3]) -> Result<(), Failure> {
        let Functions::Light { eval, .. } = &self.functions else { return Err(absent(export::LIGHT_EVAL)) };
        let start = self.clock.now();
        begin(&mut self.store);
        let done = eval.call(&mut self.store, (self.region, block, uv[0], uv[1], w[0], w[1], w[2]));
        self.end(export::LIGHT_EVAL, start, done)
    }

    /// The record that the last call left. A memory never becomes smaller, so it is there.
    #[inline(always)]
    pub(super) fn record<const N: usize>(&self) -> &[u8; N] {
        let bytes = self.memory.data(&self.store).get(self.region as usize..);
        bytes.and_then(<[u8]>::first_chunk).unwrap_or(&[0; N])
    }

    /// What the last [`Instance::bsdf_eval_n`] answered.
    #[inline(always)]
    pub(super) fn pairs(&self) -> &[[u8; EvalRecord::BYTES]] {
        self.memory.data(&self.store).get((self.region + RECORD) as usize..).unwrap_or_default().as_chunks().0
    }

    /// What a call cost.
    #[inline(always)]
    fn end(&mut self, export: &'static str, start: u64, done: wasmtime::Result<()>) -> Result<(), Failure> {
        if let Err(error) = done {
            return Err(failure(export, cause(&error, Cause::Trap)));
        }
        self.calls += 1;
        self.spent += self.clock.now() - start;
        if self.spent > TILE_TICKS { Err(failure(export, Cause::Slow)) } else { Ok(()) }
    }
}

impl Functions {
    fn of(kind: Kind, wasm: &Wasm, store: &mut Store<State>) -> Result<Self, Failure> {
        Ok(match kind {
            Kind::Bsdf => Self::Bsdf {
                eval: typed(wasm, store, export::BSDF_EVAL)?,
                sample: typed(wasm, store, export::BSDF_SAMPLE)?,
                eval_n: wasm.get_typed_func(&mut *store, export::BSDF_EVAL_N).ok(),
                vertex: wasm.get_typed_func(&mut *store, export::BSDF_VERTEX).ok(),
            },
            Kind::Light => Self::Light { emit: typed(wasm, store, export::LIGHT_EMIT)?, eval: typed(wasm, store, export::LIGHT_EVAL)? },
        })
    }

    fn take_pairs(&self) -> bool {
        matches!(self, Self::Bsdf { eval_n: Some(_), .. })
    }
}

#[cold]
fn absent(export: &'static str) -> Failure {
    failure(export, Cause::Unready("the module is of another kind".to_owned()))
}

fn typed<P: wasmtime::WasmParams, R: wasmtime::WasmResults>(
    wasm: &Wasm,
    store: &mut Store<State>,
    name: &'static str,
) -> Result<TypedFunc<P, R>, Failure> {
    wasm.get_typed_func(store, name).map_err(|error| failure(name, Cause::Unready(error.to_string())))
}

fn store(engine: &wasmtime::Engine) -> Store<State> {
    let limits = StoreLimitsBuilder::new()
        .memory_size(limit::MAX_MEMORY_BYTES)
        .table_elements(limit::MAX_TABLE_ENTRIES)
        .instances(1)
        .memories(1)
        .tables(1)
        .build();
    let mut store = Store::new(engine, State { limits, slices: 0 });
    store.limiter(|state| &mut state.limits);
    store.epoch_deadline_callback(|mut context| {
        let state = context.data_mut();
        state.slices += 1;
        // Slices are counted, not ticks: a thread that had to wait for a processor is not to blame for that.
        if state.slices > CALL_SLICES { Err(Trap::Interrupt.into()) } else { Ok(UpdateDeadline::Continue(1)) }
    });
    store.set_epoch_deadline(1);
    store
}

#[inline(always)]
fn begin(store: &mut Store<State>) {
    store.data_mut().slices = 0;
}

/// What an error of the sandbox means; `other` says it where it is no trap.
#[cold]
fn cause(error: &wasmtime::Error, other: fn(String) -> Cause) -> Cause {
    let Some(trap) = error.downcast_ref::<Trap>() else { return other(error.root_cause().to_string()) };
    Cause::Trap(match trap {
        Trap::Interrupt => return Cause::Endless,
        Trap::StackOverflow => "it ran out of stack".to_owned(),
        Trap::MemoryOutOfBounds => "it reached outside its memory".to_owned(),
        Trap::IntegerDivisionByZero => "it divided an integer by 0".to_owned(),
        Trap::UnreachableCodeReached => "it gave up (an unreachable instruction; a panic, in Rust)".to_owned(),
        other => other.to_string(),
    })
}
