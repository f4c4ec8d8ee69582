//! The transport mathematics of `bidir`: it samples paths from the camera and from the lights, joins them
//! in every way, and weighs each way once.
//!
//! The kernel never names a material, never allocates, and does no I/O; it keeps no clock, thread or global.
//! Everything it transports light through is behind a trait: [`Scene`], [`Bsdf`], [`Light`], [`Camera`],
//! [`Sampler`], [`Film`]. `README.md` beside this crate is the notation table.
#![no_std]
#[cfg(feature = "std")]
extern crate std;

pub mod bsdf;
pub mod camera;
mod camera_walk;
mod connection;
pub mod density;
pub mod effects;
pub mod film;
pub mod frame;
pub mod light;
mod light_walk;
pub mod math;
pub mod point;
pub mod profile;
pub mod real;
mod roulette;
pub mod sample;
pub mod sampler;
pub mod scene;
pub mod spectrum;
pub mod strategy;
pub mod technique;
mod vertex;
mod walk;
pub mod warp;
pub mod weight;
mod wide;

pub use bsdf::{BATCH, Bsdf, Carried, Lobe, Made, Scatter, Scattered};
pub use camera::{Camera, Seen};
pub use density::{Chance, EndDensity, PerArea, PerSolidAngle, Spread};
pub use effects::Effects;
pub use film::{Contribution, Film};
pub use frame::Frame;
pub use light::{Emission, Exit, Illumination, Light};
pub use point::{Place, Point, Ray, Segment};
pub use profile::{Emitted, Profile};
pub use real::{Mat3, Real, Vec2, Vec3};
pub use sample::sample;
pub use sampler::{Sampler, Walk};
pub use scene::Scene;
pub use spectrum::{BANDS, Spectrum};
pub use strategy::Strategy;
pub use technique::{Heuristic, Join, Technique, Techniques};
pub use walk::WalkVertex;
pub use weight::{ByJoin, Rivals, Together};
