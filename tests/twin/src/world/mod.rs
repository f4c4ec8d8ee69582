//! The world, written once and compiled twice: nothing here knows how long its numbers are.

mod ask;
mod extent;
mod eye;
mod lamp;
mod record;
mod scene;
mod surface;

pub use ask::{Answer, computed, evaluated, profile_evaluated, profile_sampled, sampled};
pub use scene::World;

use super::kernel::{Real, Vec3, math::vec3};
use crate::{nudge::Nudge, setting::rounded};

/// A parameter, which both worlds hold alike.
fn number(x: f64) -> Real {
    rounded(x) as Real
}

/// Three of them.
fn vector(v: [f64; 3]) -> Vec3 {
    vec3(number(v[0]), number(v[1]), number(v[2]))
}

/// What this world holds of an exact vector.
fn narrowed(v: bidir_kernel_f64::Vec3) -> Vec3 {
    vec3(v.x as Real, v.y as Real, v.z as Real)
}

fn widened(v: Vec3) -> bidir_kernel_f64::Vec3 {
    bidir_kernel_f64::Vec3::new(f64::from(v.x), f64::from(v.y), f64::from(v.z))
}

/// A direction as it would be if it had been rounded on its way.
fn turned(nudge: &Nudge, v: Vec3) -> Vec3 {
    narrowed(nudge.vector(widened(v).to_array(), 1.0).into())
}

/// The same of a position.
fn moved(nudge: &Nudge, v: Vec3) -> Vec3 {
    narrowed(nudge.vector(widened(v).to_array(), f64::from(v.abs().max_element())).into())
}

/// Random numbers, moved.
fn drawn<const N: usize>(nudge: &Nudge, u: [Real; N]) -> [Real; N] {
    u.map(|u| nudge.random(f64::from(u)) as Real)
}

/// A density, a chance or a value, moved relatively.
fn scaled(nudge: &Nudge, x: Real) -> Real {
    nudge.number(f64::from(x)) as Real
}
