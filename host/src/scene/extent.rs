//! Shapes as lights see them: points to sample, and how densely.

use bidir_kernel::{
    Frame, PerArea, Point, Real, Vec2, Vec3,
    light::{Extent, per_area},
    math, warp,
};

/// A bound on the rounding error of a sum whose terms add up to `magnitude` in absolute value, measured along `normal`;
/// twice the bound of eight roundings, so that both ends of a segment clear it.
pub fn rounding(magnitude: Vec3, normal: Vec3) -> Real {
    const GAMMA: Real = 16.0 * (Real::EPSILON / 2.0);
    GAMMA * (magnitude.x * normal.x.abs() + magnitude.y * normal.y.abs() + magnitude.z * normal.z.abs())
}

/// The extent of a shape that shines.
#[derive(Clone, Debug)]
pub enum LightExtent {
    /// See [`Parallelogram`].
    Parallelogram(Parallelogram),
    /// See [`Ellipse`].
    Ellipse(Ellipse),
    /// See [`Ball`].
    Ball(Ball),
    /// See [`Tube`].
    Tube(Tube),
    /// See [`Surface`].
    Surface(Surface),
}

/// A centre and two half edges; the normal is their cross product's, unless turned round.
#[derive(Clone, Copy, Debug)]
pub struct Parallelogram {
    /// In the world.
    pub center: Vec3,
    /// From the centre to the middle of the u = 1 edge.
    pub a: Vec3,
    /// From the centre to the middle of the v = 1 edge.
    pub b: Vec3,
    /// Unit.
    pub normal: Vec3,
}

/// A centre and two half axes.
#[derive(Clone, Copy, Debug)]
pub struct Ellipse {
    /// In the world.
    pub center: Vec3,
    /// First half axis.
    pub a: Vec3,
    /// Second half axis.
    pub b: Vec3,
    /// Unit.
    pub normal: Vec3,
}

/// A sphere.
#[derive(Clone, Copy, Debug)]
pub struct Ball {
    /// In the world.
    pub center: Vec3,
    /// In the world.
    pub radius: Real,
    /// Its normals point outwards: 1, inwards: −1.
    pub outward: Real,
}

/// The side of a circular cylinder.
#[derive(Clone, Copy, Debug)]
pub struct Tube {
    /// One end of the axis.
    pub base: Vec3,
    /// From there to the other end.
    pub axis: Vec3,
    /// Of the circle.
    pub radius: Real,
    /// Its normals point outwards: 1, inwards: −1.
    pub outward: Real,
}

/// Triangles, chosen by area.
#[derive(Clone, Debug)]
pub struct Surface {
    /// Corners, in the world, and the unit normal.
    pub triangles: Vec<([Vec3; 3], Vec3)>,
    /// The areas added up: `cumulative[i]` is that of the first i + 1 triangles.
    pub cumulative: Vec<f64>,
    /// The centre of its bounding box.
    pub center: Vec3,
}

impl Parallelogram {
    fn area(&self) -> Real {
        4.0 * self.a.cross(self.b).length()
    }
}

impl Ellipse {
    fn area(&self) -> Real {
        std::f32::consts::PI * self.a.cross(self.b).length()
    }
}

impl Tube {
    fn area(&self) -> Real {
        2.0 * std::f32::consts::PI * self.radius * self.axis.length()
    }
}

impl Surface {
    fn area(&self) -> Real {
        self.cumulative.last().map_or(0.0, |&area| area as Real)
    }
}

impl LightExtent {
    /// In the world's unit, squared.
    pub fn area(&self) -> Real {
        match self {
            Self::Parallelogram(shape) => shape.area(),
            Self::Ellipse(shape) => shape.area(),
            Self::Ball(ball) => 4.0 * std::f32::consts::PI * ball.radius * ball.radius,
            Self::Tube(tube) => tube.area(),
            Self::Surface(surface) => surface.area(),
        }
    }
}

/// A point of a plane figure about `center`.
fn on_plane(center: Vec3, along: Vec3, across: Vec3, tangent: Vec3, normal: Vec3, uv: Vec2) -> Point {
    let offset = rounding(center.abs() + along.abs() + across.abs(), normal);
    Point::surface(center + along + across, normal, Frame::from_z_and_tangent(normal, tangent), uv, offset)
}

impl Extent for Parallelogram {
    fn sample(&self, u: [Real; 2]) -> (Point, PerArea) {
        let (x, y) = (2.0 * u[0] - 1.0, 2.0 * u[1] - 1.0);
        (on_plane(self.center, self.a * x, self.b * y, self.a, self.normal, Vec2::new(u[0], u[1])), PerArea(1.0 / self.area()))
    }

    fn density(&self, _: &Point) -> PerArea {
        PerArea(1.0 / self.area())
    }
}

impl Extent for Ellipse {
    fn sample(&self, u: [Real; 2]) -> (Point, PerArea) {
        let d = warp::disk(u);
        let r = math::sqrt(warp::radius_squared(d));
        let turn = math::atan2(d.y, d.x) / (2.0 * std::f32::consts::PI);
        let uv = Vec2::new(r, if turn < 0.0 { turn + 1.0 } else { turn });
        (on_plane(self.center, self.a * d.x, self.b * d.y, self.a, self.normal, uv), PerArea(1.0 / self.area()))
    }

    fn density(&self, _: &Point) -> PerArea {
        PerArea(1.0 / self.area())
    }
}

impl Ball {
    fn uniform(&self) -> Real {
        1.0 / (4.0 * std::f32::consts::PI * self.radius * self.radius)
    }

    fn at(&self, out: Vec3) -> Point {
        let arm = out * self.radius;
        let normal = out * self.outward;
        Point::surface(self.center + arm, normal, Frame::from_z(normal), Vec2::ZERO, rounding(self.center.abs() + arm.abs(), normal))
    }

    /// 1 − cos of the cone in which `lit` sees the ball, and the squared sine; `None` from inside.
    /// A ball that faces inwards is seen from inside only, from its own surface too, wherever that rounds to.
    fn cone(&self, lit: &Point) -> Option<(Real, Real)> {
        if self.outward < 0.0 {
            return None;
        }
        let to_center = self.center - lit.position;
        let squared = math::dot(to_center, to_center);
        let sin_squared = self.radius * self.radius / squared;
        (sin_squared < 1.0).then(|| (warp::one_minus_cos(sin_squared), sin_squared))
    }
}

impl Extent for Ball {
    fn sample(&self, u: [Real; 2]) -> (Point, PerArea) {
        (self.at(warp::sphere(u)), PerArea(self.uniform()))
    }

    fn density(&self, _: &Point) -> PerArea {
        PerArea(self.uniform())
    }

    /// From outside, uniform in the cone that the ball fills (Wang 1992); the point on the ball from the angles alone,
    /// so that a ball 1e7 radii away keeps its digits (pbrt-v4, 6.2.4).
    fn sample_toward(&self, lit: &Point, u: [Real; 2]) -> Option<(Point, PerArea, Real)> {
        let Some((one_minus_cos, sin_squared)) = self.cone(lit) else {
            let (point, PerArea(p)) = self.sample(u);
            let (direction, squared) = lit.direction_to(&point)?;
            return Some((point, PerArea(p), math::dot(point.normal, direction).abs() / (squared * p)));
        };
        let w = warp::cone(u, one_minus_cos);
        let sin_theta_squared = w.x * w.x + w.y * w.y;
        let cos_alpha = sin_theta_squared / math::sqrt(sin_squared) + w.z * math::safe_sqrt(1.0 - sin_theta_squared / sin_squared);
        let sin_alpha = math::safe_sqrt(1.0 - cos_alpha * cos_alpha);
        let flat = math::sqrt(sin_theta_squared);
        let (x, y) = if flat > 0.0 { (w.x / flat, w.y / flat) } else { (1.0, 0.0) };
        let frame = Frame::from_z(math::normalize(lit.position - self.center)?);
        let point = self.at(frame.to_world(Vec3::new(x * sin_alpha, y * sin_alpha, cos_alpha)));
        let pdf = warp::cone_pdf(one_minus_cos);
        Some((point, per_area(pdf, lit, &point), 1.0 / pdf))
    }

    fn density_toward(&self, at: &Point, lit: &Point) -> PerArea {
        match self.cone(lit) {
            Some((one_minus_cos, _)) => per_area(warp::cone_pdf(one_minus_cos), lit, at),
            None => self.density(at),
        }
    }
}

impl Extent for Tube {
    fn sample(&self, u: [Real; 2]) -> (Point, PerArea) {
        let (sin, cos) = math::sin_cos(2.0 * std::f32::consts::PI * u[0]);
        let frame = Frame::from_z(math::normalize(self.axis).unwrap_or(Vec3::Z));
        let out = frame.x * cos + frame.y * sin;
        let normal = out * self.outward;
        let (along, arm) = (self.axis * u[1], out * self.radius);
        let offset = rounding(self.base.abs() + along.abs() + arm.abs(), normal);
        let tangent = frame.z.cross(out);
        let point =
            Point::surface(self.base + along + arm, normal, Frame::from_z_and_tangent(normal, tangent), Vec2::new(u[0], u[1]), offset);
        (point, PerArea(1.0 / self.area()))
    }

    fn density(&self, _: &Point) -> PerArea {
        PerArea(1.0 / self.area())
    }
}

impl Extent for Surface {
    fn sample(&self, u: [Real; 2]) -> (Point, PerArea) {
        let total = self.cumulative.last().copied().unwrap_or(0.0);
        let target = f64::from(u[0]) * total;
        let index = self.cumulative.partition_point(|&sum| sum <= target).min(self.cumulative.len().saturating_sub(1));
        let below = if index == 0 { 0.0 } else { self.cumulative[index - 1] };
        let rest =
            ((target - below) / (self.cumulative[index] - below)).clamp(0.0, f64::from(bidir_kernel::real::ONE_MINUS_EPSILON)) as Real;
        let ([p0, p1, p2], normal) = self.triangles[index];
        let b = warp::triangle([rest, u[1]]);
        let (q0, q1, q2) = (p0 * (1.0 - b.x - b.y), p1 * b.x, p2 * b.y);
        let offset = rounding(q0.abs() + q1.abs() + q2.abs(), normal);
        let point = Point::surface(q0 + q1 + q2, normal, Frame::from_z_and_tangent(normal, p1 - p0), b, offset);
        (point, PerArea(1.0 / self.area()))
    }

    fn density(&self, _: &Point) -> PerArea {
        PerArea(1.0 / self.area())
    }
}

macro_rules! of_extent {
    ($self:ident, $shape:ident => $call:expr) => {
        match $self {
            LightExtent::Parallelogram($shape) => $call,
            LightExtent::Ellipse($shape) => $call,
            LightExtent::Ball($shape) => $call,
            LightExtent::Tube($shape) => $call,
            LightExtent::Surface($shape) => $call,
        }
    };
}

impl Extent for &LightExtent {
    fn sample(&self, u: [Real; 2]) -> (Point, PerArea) {
        of_extent!(self, shape => shape.sample(u))
    }

    fn density(&self, at: &Point) -> PerArea {
        of_extent!(self, shape => shape.density(at))
    }

    fn sample_toward(&self, lit: &Point, u: [Real; 2]) -> Option<(Point, PerArea, Real)> {
        of_extent!(self, shape => shape.sample_toward(lit, u))
    }

    fn density_toward(&self, at: &Point, lit: &Point) -> PerArea {
        of_extent!(self, shape => shape.density_toward(at, lit))
    }
}
