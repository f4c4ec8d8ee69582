//! The scene's camera.

use bidir_kernel::{
    Camera, Effects, Point, Real, Seen, Vec2, Vec3,
    camera::{FilmPlane, Orthographic, Perspective},
};
use glam::{DAffine3, DVec3};

use crate::{
    error::{Error, Result},
    scene::description::{FilmSettings, Sensor, SensorKind},
};

/// Whichever camera the scene has.
#[derive(Clone, Copy, Debug)]
pub enum SceneCamera {
    /// Pinhole or thin lens.
    Perspective(Perspective),
    /// Parallel rays.
    Orthographic(Orthographic),
}

impl SceneCamera {
    /// The sensor in a scene whose origin was moved to `origin`.
    pub fn new(sensor: &Sensor, film: &FilmSettings, origin: DVec3) -> Result<Self> {
        let (axes, lengths) = axes(&sensor.to_world).ok_or_else(|| {
            Error::at(&sensor.place, "the sensor's to_world is degenerate or sheared", "give it three axes perpendicular to each other")
        })?;
        let position = (sensor.to_world.translation - origin).as_vec3();
        let near = sensor.near_clip.unwrap_or(0.0) as Real;
        let far = sensor.far_clip.map_or(Real::INFINITY, |far| far as Real);
        let plane = |half: Vec2| film_plane(sensor, film, half);
        let aspect = f64::from(film.height) / f64::from(film.width);
        Ok(match sensor.kind {
            SensorKind::Perspective { fov_x, aperture_radius, focus_distance } => {
                let half = (0.5 * fov_x).to_radians();
                let half = libm::tan(half);
                Self::Perspective(Perspective {
                    position,
                    axes,
                    film: plane(Vec2::new(half as Real, (half * aspect) as Real)),
                    lens_radius: aperture_radius as Real,
                    focus_distance: focus_distance as Real,
                    near,
                    far,
                })
            }
            SensorKind::Orthographic => Self::Orthographic(Orthographic {
                position,
                axes,
                film: plane(Vec2::new(lengths.x as Real, (lengths.y * aspect) as Real)),
                near,
                far,
            }),
        })
    }

    /// A sphere about the camera that holds all of it.
    pub fn reach(&self) -> (Vec3, Real) {
        match self {
            Self::Perspective(camera) => (camera.position, camera.lens_radius),
            Self::Orthographic(camera) => (camera.position, camera.film.half.length()),
        }
    }

    /// What it needs of the kernel.
    pub fn effects(&self) -> Effects {
        let (near, far) = match self {
            Self::Perspective(camera) => (camera.near, camera.far),
            Self::Orthographic(camera) => (camera.near, camera.far),
        };
        Effects { finite_lens: self.has_lens(), clipping: near > 0.0 || far < Real::INFINITY, ..Effects::NONE }
    }

    /// Whether the lens has an area that light can land on.
    pub fn has_lens(&self) -> bool {
        matches!(self, Self::Perspective(camera) if camera.lens_radius > 0.0)
    }
}

/// The unit axes of a transform whose axes are perpendicular, and their lengths; `None` for any other transform.
fn axes(to_world: &DAffine3) -> Option<([Vec3; 3], DVec3)> {
    let m = to_world.matrix3;
    let lengths = DVec3::new(m.x_axis.length(), m.y_axis.length(), m.z_axis.length());
    if !(lengths.min_element() > 0.0 && lengths.is_finite()) {
        return None;
    }
    let [x, y, z] = [m.x_axis / lengths.x, m.y_axis / lengths.y, m.z_axis / lengths.z];
    let square = |a: DVec3, b: DVec3| a.dot(b).abs() <= 1e-4;
    (square(x, y) && square(y, z) && square(z, x)).then(|| ([x.as_vec3(), y.as_vec3(), z.as_vec3()], lengths))
}

fn film_plane(sensor: &Sensor, film: &FilmSettings, half: Vec2) -> FilmPlane {
    let crop = film.crop;
    FilmPlane {
        half,
        resolution: Vec2::new(film.width as Real, film.height as Real),
        window_min: Vec2::new(crop.x as Real, crop.y as Real),
        window_max: Vec2::new((crop.x + crop.width) as Real, (crop.y + crop.height) as Real),
        // Mitsuba's offset moves the image over the axis, not the axis over the image.
        principal: -sensor.principal_point_offset.as_vec2(),
    }
}

macro_rules! of_camera {
    ($self:ident, $camera:ident => $call:expr) => {
        match $self {
            SceneCamera::Perspective($camera) => $call,
            SceneCamera::Orthographic($camera) => $call,
        }
    };
}

impl Camera for SceneCamera {
    #[inline]
    fn look(&self, raster: Vec2, lens: [Real; 2]) -> Seen {
        of_camera!(self, camera => camera.look(raster, lens))
    }

    #[inline]
    fn see(&self, from: &Point, lens: [Real; 2]) -> Option<Seen> {
        of_camera!(self, camera => camera.see(from, lens))
    }

    #[inline]
    fn hit(&self, origin: Vec3, direction: Vec3, t_max: Real) -> Option<Seen> {
        of_camera!(self, camera => camera.hit(origin, direction, t_max))
    }
}
