//! Shapes as lights see them: points to sample, and how densely.

use bidir_kernel::{
    Frame, PerArea, Point, Real, Vec2, Vec3,
    density::conversion,
    light::{Extent, Toward, per_area},
    math, warp,
};

use crate::scene::shape::{MeshForm, round_mapping};

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

/// A plane figure with what every sample of it shares.
#[derive(Clone, Copy, Debug)]
pub struct Flat {
    /// Its middle, in the world.
    pub center: Vec3,
    /// From the centre to the middle of the u = 1 edge, or to the rim.
    pub a: Vec3,
    /// From the centre to the middle of the v = 1 edge, or to the rim.
    pub b: Vec3,
    /// z is the normal, x along `a`.
    pub frame: Frame,
    /// In the world's unit, squared.
    pub area: Real,
    /// Whether it shines behind its normal too.
    both_sides: bool,
    /// Bounds the rounding error of any of its points along the normal.
    offset: Real,
    per_area: PerArea,
}

impl Flat {
    /// A figure of `share` times the area |a × b|; its normal is a × b, or turned round where `facing` is −1.
    pub fn new(center: Vec3, a: Vec3, b: Vec3, facing: Real, share: Real) -> Self {
        let cross = a.cross(b);
        let normal = math::normalize(cross).unwrap_or(Vec3::Z) * facing;
        let area = share * math::sqrt(math::dot(cross, cross));
        let offset = rounding(center.abs() + a.abs() + b.abs(), normal);
        Self { center, a, b, frame: Frame::from_z_and_tangent(normal, a), area, both_sides: false, offset, per_area: PerArea(1.0 / area) }
    }

    #[inline(always)]
    fn at(&self, x: Real, y: Real, uv: Vec2) -> Point {
        Point::surface(self.center + self.a * x + self.b * y, self.frame.z, self.frame, uv, self.offset)
    }

    /// Whether the figure shines where `lit` lies.
    #[inline(always)]
    fn faces(&self, lit: &Point) -> bool {
        self.both_sides || math::dot(lit.position - self.center, self.frame.z) > 0.0
    }

    /// Whether it shines behind its normal too.
    pub fn both_sides(&self) -> bool {
        self.both_sides
    }
}

/// −1 … 1 along both half edges.
#[derive(Clone, Copy, Debug)]
pub struct Parallelogram(pub Flat);

/// Up to 1 from the centre.
#[derive(Clone, Copy, Debug)]
pub struct Ellipse(pub Flat);

/// A sphere.
#[derive(Clone, Copy, Debug)]
pub struct Ball {
    /// In the world.
    pub center: Vec3,
    /// In the world.
    pub radius: Real,
    /// Its own axes, unit, in the world: coordinates and tangents follow them.
    pub axes: [Vec3; 3],
    /// Its normals point outwards: 1, inwards: −1.
    pub outward: Real,
    /// Whether it shines behind its normals too.
    pub both_sides: bool,
}

/// The side of a circular cylinder.
#[derive(Clone, Copy, Debug)]
pub struct Tube {
    /// One end of the axis.
    pub base: Vec3,
    /// From there to the other end.
    pub axis: Vec3,
    /// Where the angle is 0; what is perpendicular to the axis counts.
    pub x: Vec3,
    /// Of the circle.
    pub radius: Real,
    /// Its normals point outwards: 1, inwards: −1.
    pub outward: Real,
    /// 1 where u goes round the axis as a right hand's fingers do, −1 where the shape is mirrored.
    pub turning: Real,
}

/// Triangles, chosen by area.
#[derive(Clone, Debug)]
pub struct Surface {
    /// Corners, in the world, and the unit normal.
    pub triangles: Vec<([Vec3; 3], Vec3)>,
    /// The triangles' numbers in the mesh.
    pub numbers: Vec<u32>,
    /// The mesh: its coordinates and tangents.
    pub form: MeshForm,
    /// Its normals point outwards: 1, inwards: −1.
    pub outward: Real,
    /// The areas added up: `cumulative[i]` is that of the first i + 1 triangles.
    pub cumulative: Vec<f64>,
    /// The centre of its bounding box.
    pub center: Vec3,
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
    /// The same extent, of a light that shines behind its normals too.
    pub fn shining_both_ways(self) -> Self {
        match self {
            Self::Parallelogram(Parallelogram(flat)) => Self::Parallelogram(Parallelogram(Flat { both_sides: true, ..flat })),
            Self::Ellipse(Ellipse(flat)) => Self::Ellipse(Ellipse(Flat { both_sides: true, ..flat })),
            Self::Ball(ball) => Self::Ball(Ball { both_sides: true, ..ball }),
            // These are sampled all over for whoever asks.
            other @ (Self::Tube(_) | Self::Surface(_)) => other,
        }
    }

    /// In the world's unit, squared.
    pub fn area(&self) -> Real {
        match self {
            Self::Parallelogram(Parallelogram(flat)) | Self::Ellipse(Ellipse(flat)) => flat.area,
            Self::Ball(ball) => 4.0 * std::f32::consts::PI * ball.radius * ball.radius,
            Self::Tube(tube) => tube.area(),
            Self::Surface(surface) => surface.area(),
        }
    }
}

impl Extent for Parallelogram {
    #[inline(always)]
    fn sample(&self, u: [Real; 2]) -> (Point, PerArea) {
        (self.0.at(2.0 * u[0] - 1.0, 2.0 * u[1] - 1.0, Vec2::new(u[0], u[1])), self.0.per_area)
    }

    #[inline(always)]
    fn density(&self, _: &Point) -> PerArea {
        self.0.per_area
    }

    #[inline(always)]
    fn sample_toward(&self, lit: &Point, u: [Real; 2]) -> Option<Toward> {
        toward(&self.0, lit, || self.sample(u).0)
    }
}

impl Extent for Ellipse {
    #[inline]
    fn sample(&self, u: [Real; 2]) -> (Point, PerArea) {
        let d = warp::disk(u);
        let r = math::sqrt(warp::radius_squared(d));
        let turn = math::atan2(d.y, d.x) / (2.0 * std::f32::consts::PI);
        let uv = Vec2::new(r, if turn < 0.0 { turn + 1.0 } else { turn });
        let flat = &self.0;
        let frame = Frame::from_z_and_tangent(flat.frame.z, flat.a * d.x + flat.b * d.y);
        (Point { frame, ..flat.at(d.x, d.y, uv) }, flat.per_area)
    }

    #[inline]
    fn density(&self, _: &Point) -> PerArea {
        self.0.per_area
    }

    #[inline]
    fn sample_toward(&self, lit: &Point, u: [Real; 2]) -> Option<Toward> {
        toward(&self.0, lit, || self.sample(u).0)
    }
}

/// A point of a flat light for a receiver on the side that it faces; none for others (Veach 1997, 10.3.4.2). A light's
/// density stays that of its whole surface: from behind, nothing is lit that the other techniques would have to share.
#[inline(always)]
fn toward(flat: &Flat, lit: &Point, point: impl FnOnce() -> Point) -> Option<Toward> {
    if !flat.faces(lit) {
        return None;
    }
    let point = point();
    let (direction, squared) = lit.direction_to(&point)?;
    let weight = math::dot(point.normal, direction).abs() * flat.area / squared;
    Some(Toward { point, density: flat.per_area, direction, weight })
}

impl Ball {
    fn uniform(&self) -> Real {
        1.0 / (4.0 * std::f32::consts::PI * self.radius * self.radius)
    }

    fn at(&self, out: Vec3) -> Point {
        let arm = out * self.radius;
        let normal = out * self.outward;
        let (uv, tangent) = round_mapping(&self.axes, out);
        let frame = Frame::from_z_and_tangent(normal, tangent);
        Point::surface(self.center + arm, normal, frame, uv, rounding(self.center.abs() + arm.abs(), normal))
    }

    /// 1 − cos of the cone in which `lit` sees the ball, and the squared sine; `None` from inside.
    /// A ball that shines inwards is seen from inside, from its own surface too, wherever that rounds to.
    fn cone(&self, lit: &Point) -> Option<(Real, Real)> {
        if self.outward < 0.0 || self.both_sides {
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
    fn sample_toward(&self, lit: &Point, u: [Real; 2]) -> Option<Toward> {
        let Some((one_minus_cos, sin_squared)) = self.cone(lit) else {
            let (point, PerArea(p)) = self.sample(u);
            let (direction, squared) = lit.direction_to(&point)?;
            return Some(Toward {
                point,
                density: PerArea(p),
                direction,
                weight: math::dot(point.normal, direction).abs() / (squared * p),
            });
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
        let (direction, _) = lit.direction_to(&point)?;
        let density = PerArea((f64::from(pdf) * conversion(lit, &point, direction)) as Real);
        Some(Toward { point, density, direction, weight: 1.0 / pdf })
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
        let frame = Frame::from_z_and_tangent(math::normalize(self.axis).unwrap_or(Vec3::Z), self.x);
        let out = frame.x * cos + frame.y * (sin * self.turning);
        let normal = out * self.outward;
        let (along, arm) = (self.axis * u[1], out * self.radius);
        let offset = rounding(self.base.abs() + along.abs() + arm.abs(), normal);
        let tangent = frame.z.cross(out) * self.turning;
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
        let (uv, tangent) = self.form.mapping(self.numbers[index], b.x, b.y);
        let shading = self.form.shading_normal(self.numbers[index], b.x, b.y).map_or(normal, |shading| shading * self.outward);
        let point = Point::surface(q0 + q1 + q2, normal, Frame::from_z_and_tangent(shading, tangent), uv, offset);
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
    #[inline]
    fn sample(&self, u: [Real; 2]) -> (Point, PerArea) {
        of_extent!(self, shape => shape.sample(u))
    }

    #[inline]
    fn density(&self, at: &Point) -> PerArea {
        of_extent!(self, shape => shape.density(at))
    }

    #[inline]
    fn sample_toward(&self, lit: &Point, u: [Real; 2]) -> Option<Toward> {
        of_extent!(self, shape => shape.sample_toward(lit, u))
    }

    #[inline]
    fn density_toward(&self, at: &Point, lit: &Point) -> PerArea {
        of_extent!(self, shape => shape.density_toward(at, lit))
    }
}
