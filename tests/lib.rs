//! What the tests share, and the hard cases, which a page shows as well as tests.

pub mod estimators;
pub mod hard;
pub mod pictures;
pub mod scenes;
pub mod statistics;
