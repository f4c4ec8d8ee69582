//! The host of `bidir`: it reads scenes, casts rays, and writes images and reports.

pub mod error;
pub mod image;
pub mod load;
pub mod scene;
