//! The world in f64.
#![allow(clippy::useless_conversion, clippy::unnecessary_cast, reason = "the sources are those of the f32 world")]

pub use bidir_kernel_f64 as kernel;
pub use bidir_standard_f64 as standard;

#[path = "world/mod.rs"]
pub mod world;
