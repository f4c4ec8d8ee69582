//! Pinhole and thin lens.

use crate::{
    camera::{Camera, FilmPlane, Seen},
    density::{Chance, EndDensity, PerArea, PerSolidAngle, Spread},
    frame::Frame,
    math::{dot, normalize, vec2, vec3},
    point::Point,
    real::{PI, Real, Vec2, Vec3},
    spectrum::Spectrum,
    warp,
};

/// A perspective camera: a pinhole if its lens radius is 0, a thin lens otherwise.
#[derive(Clone, Copy, Debug)]
pub struct Perspective {
    /// The lens's centre, in the world.
    pub position: Vec3,
    /// The camera's axes in the world: x to the image's left, y up, z into the scene. Orthonormal; a mirrored camera is left-handed.
    pub axes: [Vec3; 3],
    /// The image plane at distance 1.
    pub film: FilmPlane,
    /// In world units; 0 is a pinhole.
    pub lens_radius: Real,
    /// Distance of the plane that is in focus, along z.
    pub focus_distance: Real,
    /// What lies nearer than this along z is not seen; 0 unless the scene clips.
    pub near: Real,
    /// Nor what lies farther; infinite unless the scene clips.
    pub far: Real,
}

impl Perspective {
    /// A pinhole at `position` that looks along `axes[2]`.
    pub fn pinhole(position: Vec3, axes: [Vec3; 3], film: FilmPlane) -> Self {
        Self { position, axes, film, lens_radius: 0.0, focus_distance: 1.0, near: 0.0, far: Real::INFINITY }
    }

    #[inline(always)]
    fn in_world(&self, v: Vec3) -> Vec3 {
        self.axes[0] * v.x + self.axes[1] * v.y + self.axes[2] * v.z
    }

    fn in_camera(&self, v: Vec3) -> Vec3 {
        vec3(dot(v, self.axes[0]), dot(v, self.axes[1]), dot(v, self.axes[2]))
    }

    #[inline(always)]
    fn lens_point(&self, lens: Vec2) -> (Point, EndDensity) {
        if self.lens_radius <= 0.0 {
            return (Point::free(self.position), EndDensity::Chance(Chance(1.0)));
        }
        let normal = self.axes[2];
        let position = self.position + self.axes[0] * lens.x + self.axes[1] * lens.y;
        let frame = Frame { x: self.axes[0], y: normal.cross(self.axes[0]), z: normal };
        // The lens is no surface of the scene: nothing is to be cleared.
        let point = Point::surface(position, normal, frame, Vec2::ZERO, 0.0);
        (point, EndDensity::Area(PerArea(1.0 / (PI * self.lens_radius * self.lens_radius))))
    }

    /// The ray from the lens point `lens` along `direction`, unit and in the camera's axes.
    #[inline(always)]
    fn seen(&self, raster: Vec2, lens: Vec2, direction: Vec3) -> Seen {
        let (point, end) = self.lens_point(lens);
        let cos = direction.z;
        // Uniform on the window at distance 1, seen under θ: d²/(A cos θ) with d = 1/cos θ. A thin lens images the window
        // onto the plane in focus, where f² cancels.
        let pdf = 1.0 / (self.film.window_area() * cos * cos * cos);
        Seen {
            raster,
            point,
            direction: self.in_world(direction),
            weight: Spectrum::ONE,
            end,
            spread: Spread::SolidAngle(PerSolidAngle(pdf)),
            near: self.near / cos,
            far: self.far / cos,
        }
    }

    /// Where the ray from `lens` along `direction` exposes the film.
    fn raster(&self, lens: Vec2, direction: Vec3) -> Option<Vec2> {
        let slope = vec2(direction.x, direction.y) / direction.z;
        // The point in focus, brought back to distance 1.
        let at = if self.lens_radius > 0.0 { slope + lens / self.focus_distance } else { slope };
        self.film.raster(at)
    }
}

impl Camera for Perspective {
    #[inline(always)]
    fn look(&self, raster: Vec2, lens: [Real; 2]) -> Seen {
        let at = self.film.at(raster);
        let (lens, slope) = if self.lens_radius > 0.0 {
            let lens = warp::disk(lens) * self.lens_radius;
            (lens, at - lens / self.focus_distance)
        } else {
            (Vec2::ZERO, at)
        };
        let direction = vec3(slope.x, slope.y, 1.0);
        let direction = direction / crate::math::sqrt(dot(direction, direction));
        self.seen(raster, lens, direction)
    }

    fn see(&self, from: &Point, lens: [Real; 2]) -> Option<Seen> {
        let lens = if self.lens_radius > 0.0 { warp::disk(lens) * self.lens_radius } else { Vec2::ZERO };
        let (point, _) = self.lens_point(lens);
        let (direction, _) = point.direction_to(from)?;
        let direction = self.in_camera(direction);
        if direction.z <= 0.0 {
            return None;
        }
        Some(self.seen(self.raster(lens, direction)?, lens, direction))
    }

    fn hit(&self, origin: Vec3, direction: Vec3, t_max: Real) -> Option<Seen> {
        if self.lens_radius <= 0.0 {
            return None;
        }
        let o = self.in_camera(origin - self.position);
        let d = self.in_camera(direction);
        // Only light that travels against the viewing direction, from in front, reaches the film.
        if d.z >= 0.0 || o.z <= 0.0 {
            return None;
        }
        let t = -o.z / d.z;
        let lens = vec2(o.x + t * d.x, o.y + t * d.y);
        if t >= t_max || warp::radius_squared(lens) >= self.lens_radius * self.lens_radius {
            return None;
        }
        let back = normalize(-d)?;
        Some(self.seen(self.raster(lens, back)?, lens, back))
    }
}

/// A perspective camera whose lens is a point, whatever its radius: for scenes known to have no other.
#[derive(Clone, Copy, Debug)]
pub struct Pinhole(pub Perspective);

impl Pinhole {
    #[inline(always)]
    fn as_perspective(&self) -> Perspective {
        Perspective { lens_radius: 0.0, ..self.0 }
    }
}

impl Camera for Pinhole {
    #[inline(always)]
    fn look(&self, raster: Vec2, lens: [Real; 2]) -> Seen {
        self.as_perspective().look(raster, lens)
    }

    fn see(&self, from: &Point, lens: [Real; 2]) -> Option<Seen> {
        self.as_perspective().see(from, lens)
    }

    fn hit(&self, _: Vec3, _: Vec3, _: Real) -> Option<Seen> {
        None
    }
}
