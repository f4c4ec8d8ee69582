//! The host of `bidir`: it reads scenes, casts rays, and writes images and reports.
//!
//! Data flows one way: scene file → [`load`] → [`scene`] → [`plan`] → [`render`] → [`film`] → [`image`]. A module uses only what
//! stands before it in the list below, and a test keeps it so.

pub mod error;

pub mod partial;

pub mod image;

pub mod rays;

pub mod scene;

pub mod load;

pub mod plan;

pub mod film;

pub mod render;

pub mod compare;

pub mod cli;
