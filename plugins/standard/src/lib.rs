//! Every built-in shader, written against the kernel's traits like any plugin: a surface or a light is a small
//! `Copy` struct of numbers, all textures already looked up.
//!
//! | surface | |
//! |---|---|
//! | [`Diffuse`] | scatters alike in every direction |
//! | [`Conductor`] | a smooth metal |
//! | [`RoughConductor`] | a metal of microfacets |
//! | [`Dielectric`] | a smooth boundary between two media |
//! | [`ThinDielectric`] | both boundaries of a thin slab at once |
//! | [`RoughDielectric`] | a boundary of microfacets between two media |
//! | [`Plastic`] | a smooth dielectric coat over a diffuse base |
//! | [`RoughPlastic`] | a rough dielectric coat over a diffuse base |
//! | [`Principled`] | what artists steer materials with |
//! | [`PrincipledThin`] | the same for thin things |
//! | [`Null`] | lets light pass as if nothing were there |
//! | [`Blend`] | two surfaces in one, or a mask |
//! | [`Bent`] | a surface whose normal is turned |
//!
//! | light | |
//! |---|---|
//! | [`Area`] | a profile: the same radiance in every direction of the hemisphere |
//! | [`Isotropic`] | a profile: the same intensity in every direction |
//! | [`Spot`] | a profile: a cone that falls off towards its edge |
//! | [`Constant`] | a profile: the same radiance from everywhere |
//! | [`Envmap`] | a profile: an image of the surroundings |
//! | [`Directional`] | a light: parallel rays from infinitely far away |
//!
//! Surfaces live in the shading frame of [`bidir_sdk::Bsdf`]. Those without transmission scatter only on the
//! side that the normal points to. The definitions are those of Mitsuba 3, so that one scene gives one image in both.
//!
//! Each of them that fits ABI 1.0 is also built as a module of its own, from `modules/`: the same code on the same
//! numbers, so the same image to the last bit. Some do not fit: [`Directional`], since a profile of the ABI has no deltas,
//! [`Envmap`], since a plugin is given numbers and no images, [`RoughPlastic`], since its table would be made for every call, [`Blend`] and
//! [`Bent`], since they are made of others. [`Principled`] and [`PrincipledThin`] are no modules yet.
#![no_std]
#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "`!(x > 0.0)` refuses NaN too")]
#[cfg(test)]
extern crate std;

pub mod bent;
pub mod blend;
pub mod conductor;
pub mod dielectric;
pub mod diffuse;
pub mod fresnel;
pub mod light;
pub mod microfacet;
pub mod null;
pub mod plastic;
pub mod principled;
pub mod principled_thin;
pub mod rough_conductor;
pub mod rough_dielectric;
pub mod rough_plastic;
pub mod thin_dielectric;

#[cfg(test)]
mod tests;

pub use bent::Bent;
pub use blend::Blend;
pub use conductor::Conductor;
pub use dielectric::Dielectric;
pub use diffuse::Diffuse;
pub use light::{Area, Constant, Directional, Envmap, Isotropic, Spot};
pub use microfacet::{Distribution, Microfacet};
pub use null::Null;
pub use plastic::Plastic;
pub use principled::Principled;
pub use principled_thin::PrincipledThin;
pub use rough_conductor::RoughConductor;
pub use rough_dielectric::RoughDielectric;
pub use rough_plastic::RoughPlastic;
pub use thin_dielectric::ThinDielectric;
