//! The host of `bidir`: it reads scenes, casts rays, and writes images and reports.

pub mod cli;
pub mod compare;
pub mod error;
pub mod film;
pub mod image;
pub mod scene;
