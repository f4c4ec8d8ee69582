//! ABI 1.0 between a plugin and its host, as plain data: version, names, records, limits.
//!
//! A plugin is one WebAssembly module without imports. It exports one `memory` and the functions of [`export`],
//! and says what it is in the custom section [`manifest::SECTION`]. Everything is little-endian, and f32 unless said.
//! `plugins/README.md` is the page to read; this crate depends on nothing and does nothing.
#![no_std]
#[cfg(test)]
extern crate std;

pub mod carried;
pub mod export;
pub mod limit;
pub mod lobe;
pub mod manifest;
pub mod record;
pub mod version;

pub use record::{EmitOut, EvalOut, EvalRecord, ProfileOut, SampleOut, VertexOut};
pub use version::{VERSION, Version};
