//! The world in f32.

pub use bidir_kernel as kernel;
pub use bidir_standard as standard;

#[path = "world/mod.rs"]
pub mod world;
