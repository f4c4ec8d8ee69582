//! What a host takes at most.

/// Bytes of a module's file.
pub const MAX_FILE_BYTES: u64 = 1 << 20;

/// Functions of a module.
pub const MAX_FUNCTIONS: u32 = 10_000;

/// Bytes of a module's memory.
pub const MAX_MEMORY_BYTES: usize = 16 << 20;

/// Entries of a module's tables.
pub const MAX_TABLE_ENTRIES: usize = 10_000;

/// Bytes of a parameter block.
pub const MAX_PARAMETER_BYTES: usize = 4096;

/// What the address of the scratch region is a multiple of; the host puts parameters and records at multiples of 4 in it.
pub const SCRATCH_ALIGNMENT: usize = 16;

/// Bytes of the stack that a call has on the host's side.
pub const MAX_STACK_BYTES: usize = 256 << 10;

/// Milliseconds that one call has, about.
pub const CALL_MILLISECONDS: u64 = 50;
