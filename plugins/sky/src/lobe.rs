//! The lobes that directions are made from. h is 1 − cos of the angle to the lobe's axis: it keeps its digits near it.

use bidir_sdk::{
    Frame, Real, Vec3,
    math::{safe_sqrt, sin, sin_cos, sqr, sqrt, vec3},
    real::PI,
};

/// A disk that fades linearly in h towards its rim: ∫ pdf = 1, so what sends E in all is E · pdf bright.
#[derive(Clone, Copy, Debug)]
pub struct Cap {
    /// h of the rim.
    rim: Real,
}

impl Cap {
    /// `radius` is half the angle that it takes up.
    pub fn new(radius: Real) -> Self {
        Self { rim: 2.0 * sqr(sin(0.5 * radius)) }
    }

    pub fn pdf(&self, h: Real) -> Real {
        (1.0 - h / self.rim).max(0.0) / (PI * self.rim)
    }

    pub fn sample(&self, u: Real) -> Real {
        self.rim * (u / (1.0 + sqrt(1.0 - u)))
    }
}

/// The glow about the sun: density as 1/(1 + k h)², on the whole sphere.
const GLOW: Real = 9.0;

pub fn glow_pdf(h: Real) -> Real {
    (0.5 + GLOW) / (2.0 * PI * sqr(1.0 + GLOW * h))
}

pub fn sample_glow(u: Real) -> Real {
    u / (0.5 + GLOW * (1.0 - u))
}

/// The dome: density as 1/(1 + k z)² above the horizon, where a clear sky is brightest.
const DOME: Real = 2.0;

pub fn dome_pdf(z: Real) -> Real {
    if z > 0.0 { (1.0 + DOME) / (2.0 * PI * sqr(1.0 + DOME * z)) } else { 0.0 }
}

pub fn sample_dome(u: Real) -> Real {
    u / (1.0 + DOME * (1.0 - u))
}

/// The ground: alike everywhere below the horizon.
pub fn ground_pdf(z: Real) -> Real {
    if z > 0.0 { 0.0 } else { 1.0 / (2.0 * PI) }
}

/// The direction at this cosine to z.
pub fn at_height(z: Real, u: Real) -> Vec3 {
    about(safe_sqrt((1.0 - z) * (1.0 + z)), z, u)
}

/// The direction at this h from `axis`.
pub fn about_axis(axis: Vec3, h: Real, u: Real) -> Vec3 {
    Frame::from_z(axis).to_world(about(safe_sqrt(h * (2.0 - h)), 1.0 - h, u))
}

fn about(r: Real, z: Real, u: Real) -> Vec3 {
    let (sin, cos) = sin_cos(2.0 * PI * u);
    vec3(r * cos, r * sin, z)
}
