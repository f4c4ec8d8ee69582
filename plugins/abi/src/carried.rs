//! What the walk that meets a surface carries, as the number that BSDF calls are given.

/// The walk came from the camera: value and weight of refraction hold the factor (η_o/η_i)².
pub const RADIANCE: i32 = 0;

/// The walk came from a light: no factor.
pub const IMPORTANCE: i32 = 1;
