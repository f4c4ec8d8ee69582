//! What the author of a plugin uses: the kernel's traits and numbers, parameters, and one macro that makes a module.
//!
//! ```
//! use bidir_sdk::{Bsdf, Carried, Lobe, Made, PerSolidAngle, Real, Scatter, Scattered, Vec3, real::INV_PI, warp};
//!
//! bidir_sdk::parameters! {
//!     /// Scatters alike in every direction, above.
//!     pub struct Chalk {
//!         /// Albedo.
//!         color: rgb(min 0.0, max 1.0, texturable, label "Color") = [0.9, 0.9, 0.8];
//!     }
//! }
//!
//! impl Bsdf for Chalk {
//!     fn eval(&self, wo: Vec3, wi: Vec3, _: Carried) -> Scatter {
//!         if !(wo.z > 0.0 && wi.z > 0.0) {
//!             return Scatter::NONE;
//!         }
//!         let density = |w: Vec3| PerSolidAngle(warp::cosine_hemisphere_pdf(w.z));
//!         Scatter { value: self.color * (wi.z * INV_PI), pdf: density(wi), pdf_rev: density(wo) }
//!     }
//!
//!     fn sample(&self, wo: Vec3, u: [Real; 3], carried: Carried) -> Option<Scattered> {
//!         let wi = warp::cosine_hemisphere([u[0], u[1]]);
//!         let Scatter { pdf, pdf_rev, .. } = self.eval(wo, wi, carried);
//!         let made = Made::Smooth { pdf, pdf_rev };
//!         (wo.z > 0.0).then_some(Scattered { wi, weight: self.color, made, eta: 1.0, lobe: Lobe::DIFFUSE_REFLECTION })
//!     }
//!
//!     fn lobes(&self) -> Lobe {
//!         Lobe::DIFFUSE_REFLECTION
//!     }
//! }
//!
//! bidir_sdk::bsdf! { Chalk, lobes: [diffuse_reflection], isotropic: true }
//! # fn main() {}
//! ```
//!
//! The crate type is `["cdylib", "rlib"]`: built for `wasm32-unknown-unknown` it is the module, and every other crate can
//! link it natively; both give the same bits. Take every function of numbers from [`math`]: those of std differ between machines.
//!
//! Everything of [`bidir_kernel`] is here under its own name: [`Bsdf`] is a surface, [`Profile`] a light.
#![no_std]
#[cfg(test)]
extern crate std;

pub use bidir_abi as abi;
pub use bidir_kernel::*;

pub mod answer;
mod declare;
pub mod export;
#[doc(hidden)]
pub mod json;
pub mod manifest;
pub mod parameter;
mod plugin;

pub use manifest::Manifest;
pub use parameter::{Parameter, Parameters};
