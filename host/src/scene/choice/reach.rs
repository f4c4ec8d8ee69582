//! About how much of a light reaches a receiver: what next event weighs a few lights by.

use bidir_kernel::{
    Point, Profile, Real, Vec2, Vec3, math,
    real::{INV_PI, PI},
};

use crate::{
    plugin::Sandbox,
    scene::{
        extent::{Ellipse, Flat, LightExtent, Parallelogram},
        lights::{LightSource, Seat},
    },
};

impl LightSource {
    /// About how much reaches `lit`, W/m², mean of the bands; 0 only where nothing does. What next event chooses by.
    #[inline]
    pub(super) fn reaching(&self, lit: &Point, sandbox: &Sandbox) -> Real {
        match &self.seat {
            Seat::Shape(extent) => self.outflow.exitance as Real * INV_PI * solid_angle(extent, lit),
            Seat::Point { position, frame } => {
                let away = lit.position - *position;
                let Some(direction) = math::normalize(away) else { return 0.0 };
                let intensity = self.profile.asked(sandbox).eval(Vec2::ZERO, frame.to_local(direction)).radiance.mean();
                intensity / math::dot(away, away).max(Real::MIN_POSITIVE)
            }
            // Surroundings are brighter on one side than on the other.
            Seat::Environment { .. } => 0.5 * self.outflow.total as Real,
            Seat::Directional(light) => light.irradiance.mean(),
        }
    }

    /// The same for a light that is infinitely far away, and so the same for every receiver; `None` for others.
    pub(super) fn reaching_all(&self) -> Option<f64> {
        match &self.seat {
            Seat::Shape(_) | Seat::Point { .. } => None,
            Seat::Environment { .. } => Some(0.5 * self.outflow.total),
            Seat::Directional(_) => Some(self.outflow.total),
        }
    }
}

#[inline]
fn distance_squared(position: Vec3, lit: &Point) -> Real {
    let d = position - lit.position;
    math::dot(d, d).max(Real::MIN_POSITIVE)
}

/// About the solid angle under which `lit` sees a light's front; 0 only behind a flat one.
#[inline]
fn solid_angle(extent: &LightExtent, lit: &Point) -> Real {
    let flat = |shape: &Flat| {
        let area = shape.area;
        let d = lit.position - shape.center;
        let height = math::dot(d, shape.frame.z);
        let height = if shape.both_sides() { height.abs() } else { height };
        if height <= 0.0 && !shape.both_sides() {
            return 0.0;
        }
        let squared = math::dot(d, d);
        // Near by, a flat light fills at most the hemisphere, and its edges stand higher than its middle.
        let cos = (height / math::sqrt(squared)).max(0.05);
        2.0 * PI * (area * cos) / (area * cos + 2.0 * PI * squared)
    };
    let round = |center: Vec3, area: Real| 4.0 * PI * area / (area + 16.0 * PI * distance_squared(center, lit));
    match extent {
        LightExtent::Parallelogram(Parallelogram(shape)) | LightExtent::Ellipse(Ellipse(shape)) => flat(shape),
        LightExtent::Ball(ball) => round(ball.center, extent.area()),
        LightExtent::Tube(tube) => round(tube.base + tube.axis * 0.5, extent.area()),
        LightExtent::Surface(surface) => round(surface.center, extent.area()),
    }
}
