//! The scene: what was written down, and what rays meet.

pub mod description;
