//! What the user sees of a run.

pub mod progress;
