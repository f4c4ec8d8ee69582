//! What compiles and runs modules, and the clock that stops those that run on.

use std::{
    fmt,
    sync::{
        Arc,
        atomic::{AtomicU64, Ordering},
    },
    thread,
    time::Duration,
};

use bidir_abi::limit;
use wasmtime::{Config, InstanceAllocationStrategy, OptLevel, PoolingAllocationConfig, Strategy};

use crate::error::{Error, Result};

/// How long the clock waits between its ticks.
pub const TICK: Duration = Duration::from_millis(10);

/// How many instances there can be at once: threads times modules.
const INSTANCES: u32 = 2048;

/// Compiles and runs modules. Clones are the same engine; its clock stands still once the last of them, and the last module, is gone.
#[derive(Clone)]
pub struct Engine {
    wasm: wasmtime::Engine,
    ticks: Arc<AtomicU64>,
}

impl Engine {
    /// Compiles for this machine and starts the clock.
    ///
    /// # Errors
    /// If the machine is none that WebAssembly is compiled for, or gives no memory or thread.
    pub fn new() -> Result<Self> {
        let failed = |error: &dyn fmt::Display| {
            Error::new(format!("WebAssembly cannot be run on this machine: {error}"), "render without plugins, or elsewhere")
        };
        let mut pooled = configuration();
        pooled.allocation_strategy(pool());
        // A pool takes a long stretch of addresses; where they are scarce, every instance asks for its own.
        let wasm = wasmtime::Engine::new(&pooled).or_else(|_| wasmtime::Engine::new(&configuration())).map_err(|error| failed(&error))?;
        let ticks = Arc::new(AtomicU64::new(0));
        let (weak, clock) = (wasm.weak(), Arc::clone(&ticks));
        let tick = move || {
            while let Some(engine) = weak.upgrade() {
                clock.fetch_add(1, Ordering::Relaxed);
                engine.increment_epoch();
                drop(engine);
                thread::sleep(TICK);
            }
        };
        thread::Builder::new().name("plugin clock".to_owned()).spawn(tick).map_err(|error| failed(&error))?;
        Ok(Self { wasm, ticks })
    }

    pub(super) fn wasm(&self) -> &wasmtime::Engine {
        &self.wasm
    }

    pub(super) fn clock(&self) -> Clock {
        Clock(Arc::clone(&self.ticks))
    }
}

impl fmt::Debug for Engine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Engine").finish_non_exhaustive()
    }
}

/// Tells the time in ticks.
#[derive(Clone, Debug)]
pub(super) struct Clock(Arc<AtomicU64>);

impl Clock {
    #[inline]
    pub(super) fn now(&self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }
}

/// Addresses enough that no access needs a check, and one result on every machine.
fn configuration() -> Config {
    let mut config = Config::new();
    config
        .strategy(Strategy::Cranelift)
        .cranelift_opt_level(OptLevel::Speed)
        .epoch_interruption(true)
        .max_wasm_stack(limit::MAX_STACK_BYTES)
        .memory_reservation(4 << 30)
        .memory_guard_size(2 << 30)
        .memory_may_move(false)
        .wasm_simd(true)
        .wasm_relaxed_simd(false)
        .wasm_memory64(false)
        .wasm_multi_memory(false)
        .wasm_tail_call(false);
    config
}

/// Memory for instances, kept from one to the next: a new one takes 4 µs instead of 22.
fn pool() -> InstanceAllocationStrategy {
    let mut pool = PoolingAllocationConfig::default();
    pool.total_core_instances(INSTANCES)
        .total_memories(INSTANCES)
        .total_tables(INSTANCES)
        .max_tables_per_module(1)
        .max_memories_per_module(1)
        .max_core_instance_size(1 << 20)
        .max_memory_size(limit::MAX_MEMORY_BYTES)
        .table_elements(limit::MAX_TABLE_ENTRIES)
        .linear_memory_keep_resident(128 << 10)
        .table_keep_resident(4 << 10);
    InstanceAllocationStrategy::Pooling(pool)
}
