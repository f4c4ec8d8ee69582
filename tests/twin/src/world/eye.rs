//! The cameras as one type.

use super::{
    super::kernel::{
        Camera, Frame, Point, Real, Seen, Vec2, Vec3,
        camera::{FilmPlane, Orthographic, Perspective},
        math::{dot, normalize, sqrt, vec2},
    },
    drawn, moved, number, turned, vector,
};
use crate::{
    nudge::Nudge,
    setting::{Eye, Lens},
};

/// The film's width and height, in pixels.
pub const RESOLUTION: Real = 16.0;

/// Any camera, whose answers are rounded on their way.
#[derive(Clone, Copy, Debug)]
pub struct Watched<'a> {
    kind: Kind,
    nudge: &'a Nudge,
}

#[derive(Clone, Copy, Debug)]
enum Kind {
    Perspective(Perspective),
    Parallel(Orthographic),
}

impl<'a> Watched<'a> {
    pub fn new(eye: &Eye, nudge: &'a Nudge) -> Self {
        let position = vector(eye.from);
        let along = vector(eye.to) - position;
        let frame = Frame::from_z_and_tangent(normalize(along).unwrap_or(Vec3::Z), Vec3::Y.cross(along));
        let film = FilmPlane::centred(vec2(RESOLUTION, RESOLUTION), number(eye.half_width));
        let axes = [frame.x, frame.y, frame.z];
        let kind = match eye.lens {
            Lens::Pinhole => Kind::Perspective(Perspective::pinhole(position, axes, film)),
            Lens::Thin(radius) => Kind::Perspective(Perspective {
                lens_radius: number(radius),
                focus_distance: sqrt(dot(along, along)),
                ..Perspective::pinhole(position, axes, film)
            }),
            Lens::Parallel => Kind::Parallel(Orthographic { position, axes, film, near: 0.0, far: Real::INFINITY }),
        };
        Self { kind, nudge }
    }

    fn moved(&self, seen: Seen) -> Seen {
        let point = Point { position: moved(self.nudge, seen.point.position), ..seen.point };
        Seen { point, direction: turned(self.nudge, seen.direction), ..seen }
    }
}

impl Camera for Watched<'_> {
    fn look(&self, raster: Vec2, lens: [Real; 2]) -> Seen {
        let lens = drawn(self.nudge, lens);
        self.moved(match &self.kind {
            Kind::Perspective(camera) => camera.look(raster, lens),
            Kind::Parallel(camera) => camera.look(raster, lens),
        })
    }

    fn see(&self, from: &Point, lens: [Real; 2]) -> Option<Seen> {
        let (from, lens) = (Point { position: moved(self.nudge, from.position), ..*from }, drawn(self.nudge, lens));
        let seen = match &self.kind {
            Kind::Perspective(camera) => camera.see(&from, lens),
            Kind::Parallel(camera) => camera.see(&from, lens),
        };
        seen.map(|seen| self.moved(seen))
    }

    fn hit(&self, origin: Vec3, direction: Vec3, t_max: Real) -> Option<Seen> {
        let (origin, direction) = (moved(self.nudge, origin), turned(self.nudge, direction));
        let seen = match &self.kind {
            Kind::Perspective(camera) => camera.hit(origin, direction, t_max),
            Kind::Parallel(camera) => camera.hit(origin, direction, t_max),
        };
        seen.map(|seen| self.moved(seen))
    }
}
