//! The same paths in f32 and in f64, with the same random numbers: where do they part, and how far are they apart until then?
//!
//! One little world ([`setting`]) is compiled twice: [`single`] over the kernel and the shaders that users build,
//! [`double`] over their f64 twins of the same sources. Its geometry is exact in both, so that what differs is the kernel's
//! and the shaders' doing. A [`tape::Tape`] keeps what one sample met and contributed.
//!
//! How far apart may they be? As far as rounding explains. The f64 world runs a few times more with every number that goes
//! between kernel, shaders and scene moved by what f32 rounds away ([`nudge::Nudge`]). Where a path is ill-conditioned those
//! runs scatter as much as f32 does; a formula that loses digits of its own stands out. So no bound is tuned to a scene.
//!
//! ```text
//! setting → world (twice) → tape → parting → tally → held
//! ```

#![allow(clippy::duplicate_mod, reason = "the world is one source in two precisions")]
#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "`!(x <= bound)` holds for NaN too")]

pub mod case;
pub mod double;
pub mod geometry;
pub mod held;
pub mod nudge;
pub mod parting;
pub mod setting;
pub mod shader;
pub mod single;
pub mod tally;
pub mod tape;

pub use case::{Case, named};
pub use held::Held;
pub use tally::Tally;
