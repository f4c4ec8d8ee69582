//! Plugins: BSDFs and lights in WebAssembly, in a sandbox.
//!
//! A [`Module`] is read, checked and compiled once; a [`Roster`] holds the shaders (modules with parameters) of a scene;
//! a [`Sandbox`] is one thread's instances of them, and gives out things that are the kernel's own [`bidir_kernel::Bsdf`] and
//! [`bidir_kernel::Profile`]. `plugins/README.md` says what a module has to be. This module knows of no scene, ray or file format,
//! so that another engine can take it alone (`default-features = false`):
//!
//! ```no_run
//! # use std::{path::Path, sync::Arc};
//! # use bidir::plugin::{Engine, Module, Roster, Sandbox, Strictness};
//! # use bidir_kernel::{Bsdf, Carried, Vec3};
//! let velvet = Arc::new(Module::load(&Engine::new()?, Path::new("velvet.wasm"))?);
//! let mut roster = Roster::default();
//! let red = roster.shader(&velvet, &[("tint", [0.6, 0.1, 0.1].into())])?;
//! let roster = Arc::new(roster);
//! // In each thread:
//! let sandbox = Sandbox::new(roster, Strictness::Lenient);
//! sandbox.begin_tile(0);
//! let scatter = sandbox.bsdf(red).eval(Vec3::Z, Vec3::Z, Carried::Radiance);
//! if let Some(fault) = sandbox.fault() {
//!     eprintln!("{fault}");
//! }
//! # Ok::<(), bidir::error::Error>(())
//! ```
//!
//! What can go wrong: a module that is not as it has to be is an error when it is loaded; an answer that cannot be is left out
//! and counted ([`Sandbox::quarantine`]); a call that traps or does not end is a [`Fault`], after which answers are black.

pub(crate) mod answer;
mod engine;
mod fault;
mod instance;
mod library;
mod manifest;
mod meter;
mod module;
mod outline;
mod parameters;
mod quarantine;
mod sandbox;

pub use answer::Flaw;
pub use engine::Engine;
pub use fault::{Cause, Fault};
pub use instance::{CALL_LIMIT, TILE_LIMIT};
pub use library::{Library, VARIABLE, is_module, modules};
pub use manifest::{EmitsFrom, Kind, Manifest, Parameter, ParameterType};
pub use meter::Metered;
pub use module::{Module, describe};
pub use parameters::Value;
pub use quarantine::{Asked, Quarantine, Quarantined};
pub use sandbox::{Roster, Sandbox, SandboxedBsdf, SandboxedProfile, ShaderId, Strictness};
