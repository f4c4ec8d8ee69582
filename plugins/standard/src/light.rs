//! What lights send where.

mod area;
mod constant;
mod directional;
mod envmap;
mod isotropic;
mod spot;

pub use area::Area;
pub use constant::Constant;
pub use directional::Directional;
pub use envmap::{Envmap, EnvmapSizes};
pub use isotropic::Isotropic;
pub use spot::Spot;
