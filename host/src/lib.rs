//! The host of `bidir`: it reads scenes, casts rays, and writes images and reports.
//!
//! Data flows one way: scene file → [`load`] → [`scene`] → [`plan`] → [`render`] → [`film`] → [`image`]. A module uses only what
//! stands before it in the list below, and a test keeps it so.

pub mod error;

#[cfg(feature = "renderer")]
pub mod partial;

#[cfg(feature = "renderer")]
pub mod image;

#[cfg(feature = "renderer")]
pub mod rays;

pub mod plugin;

#[cfg(feature = "renderer")]
pub mod scene;

#[cfg(feature = "renderer")]
pub mod load;

#[cfg(feature = "renderer")]
pub mod plan;

#[cfg(feature = "renderer")]
pub mod film;

#[cfg(feature = "renderer")]
pub mod render;

#[cfg(feature = "renderer")]
pub mod compare;

pub mod check;

#[cfg(feature = "renderer")]
pub mod cost;

#[cfg(feature = "renderer")]
pub mod cli;
