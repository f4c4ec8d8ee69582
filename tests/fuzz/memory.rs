//! The subjects, with a bound on their memory: an input that takes more is a crash, and kept.

use std::alloc::System;

use cap::Cap;

pub use bidir_fuzz_subjects::*;

/// All that one input may take at once, with what is kept between inputs, in bytes.
const MOST: usize = 512 << 20;

#[global_allocator]
static MEMORY: Cap<System> = Cap::new(System, MOST);
