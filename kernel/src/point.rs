//! Where a path bends: points, and the straight segments between them.

use crate::{
    frame::Frame,
    math::{dot, normalize},
    real::{Real, Vec2, Vec3},
};

/// What kind of place a point is; it decides how densities convert there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// On a surface: areas are measured on it, with |cos| of its geometric normal.
    Surface,
    /// In empty space (a point light, a pinhole): no normal, no cosine.
    Free,
    /// Infinitely far away (an environment, a directional light, an orthographic camera): a direction rather than a place.
    Distant,
}

/// A point that a path goes through.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    /// In the world. For a distant point: where light that comes from there enters the scene.
    pub position: Vec3,
    /// The unit geometric normal. For a distant point: the unit direction from it into the scene. Zero for a free point.
    pub normal: Vec3,
    /// The shading frame: z is the shading normal, on the geometric normal's side; x follows the u coordinate.
    pub frame: Frame,
    /// Surface coordinates, for textures and profiles.
    pub uv: Vec2,
    /// How far along the normal a ray has to start to clear the rounding error of `position`; at least 0.
    /// For a distant point: how far behind `position` things still stand in its light; infinite, or 0 for a camera's plane.
    pub offset: Real,
    /// What kind of place this is.
    pub place: Place,
}

impl Point {
    /// A point of a surface; `offset` bounds the rounding error of `position` along the normal.
    #[inline]
    pub fn surface(position: Vec3, normal: Vec3, frame: Frame, uv: Vec2, offset: Real) -> Self {
        Self { position, normal, frame, uv, offset, place: Place::Surface }
    }

    /// A point in empty space.
    #[inline]
    pub fn free(position: Vec3) -> Self {
        Self { position, normal: Vec3::ZERO, frame: Frame::from_z(Vec3::Z), uv: Vec2::ZERO, offset: 0.0, place: Place::Free }
    }

    /// Infinitely far away; light from there travels along the unit vector `inward`.
    #[inline]
    pub fn distant(position: Vec3, inward: Vec3) -> Self {
        Self { position, normal: inward, frame: Frame::from_z(inward), uv: Vec2::ZERO, offset: Real::INFINITY, place: Place::Distant }
    }

    /// As much of it as a light may ask of a receiver.
    #[inline(always)]
    pub(crate) fn as_receiver(&self) -> Receiver {
        Receiver { position: self.position, normal: self.normal, place: self.place }
    }

    /// Whether directions at this point are measured against a surface.
    #[inline(always)]
    pub fn is_surface(&self) -> bool {
        self.place == Place::Surface
    }

    /// The unit direction from here towards `other`, and the square of the distance (1 if either is infinitely far away);
    /// `None` where the two coincide.
    #[inline(always)]
    pub fn direction_to(&self, other: &Point) -> Option<(Vec3, Real)> {
        if other.place == Place::Distant {
            return Some((-other.normal, 1.0));
        }
        if self.place == Place::Distant {
            return Some((self.normal, 1.0));
        }
        let d = other.position - self.position;
        let squared = dot(d, d);
        Some((normalize(d)?, squared))
    }

    /// Whether the unit world direction `w` lies on the same side of the geometric and of the shading normal.
    /// Directions that do not are refused, so that light does not leak through surfaces.
    #[inline(always)]
    pub fn same_side(&self, w: Vec3) -> bool {
        dot(w, self.normal) * dot(w, self.frame.z) > 0.0
    }

    /// Where a ray that leaves along `direction` starts: moved off the surface, to the side it leaves on.
    #[inline(always)]
    pub fn leave(&self, direction: Vec3) -> Vec3 {
        if !self.is_surface() {
            return self.position;
        }
        let out = if dot(direction, self.normal) < 0.0 { -self.offset } else { self.offset };
        self.position + self.normal * out
    }
}

/// What a walk keeps of the point it left: all that a light may ask of a receiver.
#[derive(Clone, Copy)]
pub(crate) struct Receiver {
    pub position: Vec3,
    normal: Vec3,
    place: Place,
}

impl Receiver {
    /// The point again, but for what no light asks.
    #[inline(always)]
    pub fn point(&self) -> Point {
        let Self { position, normal, place } = *self;
        Point { position, normal, frame: Frame { x: Vec3::ZERO, y: Vec3::ZERO, z: normal }, uv: Vec2::ZERO, offset: 0.0, place }
    }
}

/// Which part of a path a ray is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Segment {
    /// Between two points of the scene.
    Inner,
    /// Ends on the lens. A scene that hides its emitters lets such a ray pass through them.
    Lens,
}

/// A half-open line segment: origin + t · direction, 0 < t < t_max.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// In the world, already moved off the surface it leaves.
    pub origin: Vec3,
    /// In the world, of any length but 0.
    pub direction: Vec3,
    /// In units of the direction's length.
    pub t_max: Real,
    /// Which part of a path this is.
    pub segment: Segment,
}

impl Ray {
    /// The ray that leaves `from` along `direction`, without an end.
    #[inline(always)]
    pub fn leaving(from: &Point, direction: Vec3, segment: Segment) -> Self {
        Self { origin: from.leave(direction), direction, t_max: Real::INFINITY, segment }
    }

    /// The segment between two points, both ends moved off their surfaces; t runs from 0 to 1 unless one of them is infinitely far away.
    #[inline(always)]
    pub fn between(a: &Point, b: &Point, segment: Segment) -> Self {
        let (a, b) = if a.place == Place::Distant && b.place != Place::Distant { (b, a) } else { (a, b) };
        let direction = if b.place == Place::Distant {
            let outward = -b.normal;
            if b.offset == Real::INFINITY {
                return Self::leaving(a, outward, segment);
            }
            outward * dot(b.position - a.position, outward)
        } else {
            b.position - a.position
        };
        let origin = a.leave(direction);
        let end = if b.is_surface() { b.leave(-direction) } else { a.position + direction };
        Self { origin, direction: end - origin, t_max: 1.0, segment }
    }

    /// Whether the segment from `a` to `b`, once both ends are moved off their surfaces, still lies on the sides of them that it did.
    /// Of two points nearly in one plane, rounding alone may tell which side of a surface the one is on from the other: one on the front
    /// and one on the back would then see each other through the surface, which is edge-on to the ray. What is refused with them, of
    /// pairs on one side, has a cosine as small as a rounding.
    #[inline]
    pub fn keeps_sides(a: &Point, b: &Point) -> bool {
        let (before, after) = (b.position - a.position, Self::between(a, b, Segment::Inner).direction);
        let keeps = |at: &Point| !at.is_surface() || dot(before, at.normal) * dot(after, at.normal) > 0.0;
        a.place == Place::Distant || b.place == Place::Distant || (keeps(a) && keeps(b))
    }
}
