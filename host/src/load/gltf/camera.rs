//! The camera and its film.

use ::gltf::json::{Camera as Source, camera::Type, validation::Checked};
use glam::{DAffine3, DMat3, DVec2, DVec3};

use super::{
    Reader,
    asset::{DAMAGED, label},
    node::Placed,
};
use crate::{
    error::Result,
    load::defines::Defines,
    scene::description::{Crop, FilmSettings, Filter, Sensor, SensorKind},
};

/// The longer side of an image, in pixels, unless `--define size=…` says otherwise.
const SIZE: &str = "1280";
const MAX_SIZE: u32 = 1 << 15;
/// Width over height where nothing says it.
const ASPECT: f64 = 16.0 / 9.0;
/// Of a camera that the file does not have: its vertical field of view, in degrees.
const FOV: f64 = 35.0;
/// How much further away it is than it need be.
const MARGIN: f64 = 1.1;

impl Reader<'_> {
    /// The first camera among the nodes, or one that sees all of the scene, which lies within the bounds.
    pub(super) fn camera(&mut self, nodes: &[Placed], bounds: Option<[DVec3; 2]>) -> Result<(Sensor, f64)> {
        let mut cameras = nodes.iter().filter_map(|placed| Some((placed, placed.node.camera?)));
        let Some((placed, index)) = cameras.next() else {
            self.warn("there is no camera; one is put where it sees everything");
            return Ok((self.framing(bounds.unwrap_or([DVec3::NEG_ONE, DVec3::ONE])), ASPECT));
        };
        let Some(source) = self.asset.root.get(index) else { return Err(self.asset.missing(&format!("camera {}", index.value()))) };
        let name = label("camera", index.value(), source.name.as_ref());
        let others = cameras.count();
        if others > 0 {
            self.warn(format_args!("there are {} cameras; {name}, the first, is used", others + 1));
        }
        let Some(to_world) = placed.looking() else {
            return Err(self.asset.error(format!("{}, which holds {name}, has axes that fall together", placed.label()), DAMAGED));
        };
        self.sensor(source, to_world, &name)
    }

    fn sensor(&self, source: &Source, to_world: DAffine3, name: &str) -> Result<(Sensor, f64)> {
        let fail = |thing: String| Err(self.asset.error(format!("{thing} of {name}"), "write what the camera sees, more than nothing"));
        match (source.type_, &source.perspective, &source.orthographic) {
            (Checked::Valid(Type::Perspective), Some(of), _) => {
                let aspect = of.aspect_ratio.map_or(ASPECT, f64::from);
                if !(1e-3..=1e3).contains(&aspect) {
                    return fail(format!("aspectRatio {aspect}"));
                }
                let fov_x = 2.0 * libm::atan(libm::tan(0.5 * f64::from(of.yfov)) * aspect).to_degrees();
                if !(of.yfov > 0.0 && f64::from(of.yfov) < std::f64::consts::PI && (1e-6..=179.99999).contains(&fov_x)) {
                    return fail(format!("yfov {}", of.yfov));
                }
                Ok((self.looking(perspective(fov_x), to_world), aspect))
            }
            (Checked::Valid(Type::Orthographic), _, Some(of)) => {
                let (half, aspect) = (f64::from(of.xmag).abs(), f64::from(of.xmag).abs() / f64::from(of.ymag).abs());
                if !((1e-15..=1e15).contains(&half) && (1e-3..=1e3).contains(&aspect)) {
                    return fail(format!("xmag {} and ymag {}", of.xmag, of.ymag));
                }
                let scaled = DAffine3 { matrix3: to_world.matrix3 * half, ..to_world };
                Ok((self.looking(SensorKind::Orthographic, scaled), aspect))
            }
            _ => Err(self.asset.error(format!("{name} is neither perspective nor orthographic"), DAMAGED)),
        }
    }

    /// Clip planes are a rasterizer's; rays have none.
    fn looking(&self, kind: SensorKind, to_world: DAffine3) -> Sensor {
        let place = self.asset.place();
        Sensor { kind, to_world, principal_point_offset: DVec2::ZERO, near_clip: None, far_clip: None, place }
    }

    /// From the front, which is +z, a little from the right and from above, as near as all corners of the box are seen.
    fn framing(&self, [min, max]: [DVec3; 2]) -> Sensor {
        let back = DVec3::new(0.5, 0.35, 1.0).normalize();
        let ahead = -back;
        let up = (DVec3::Y - ahead * ahead.dot(DVec3::Y)).normalize();
        let left = up.cross(ahead);
        let high = libm::tan((0.5 * FOV).to_radians());
        let wide = high * ASPECT;
        let half = 0.5 * (max - min);
        let corners = (0..8).map(|corner| half * DVec3::from_array([0, 1, 2].map(|axis| f64::from(2 * (corner >> axis & 1) - 1))));
        let distances = corners.map(|corner| (corner.dot(left).abs() / wide).max(corner.dot(up).abs() / high) - corner.dot(ahead));
        let distance = MARGIN * distances.fold(1e-9, f64::max);
        let fov_x = 2.0 * libm::atan(wide).to_degrees();
        let translation = 0.5 * (min + max) + back * distance;
        self.looking(perspective(fov_x), DAffine3 { matrix3: DMat3::from_cols(left, up, ahead), translation })
    }

    /// A film of that aspect; its longer side is `$size`.
    pub(super) fn film(&self, aspect: f64, defines: &mut Defines) -> Result<FilmSettings> {
        defines.set_default("size", SIZE.into());
        let place = self.asset.place();
        let text = defines.apply("$size", &place)?;
        let size = text.trim().parse().ok().filter(|size| (1..=MAX_SIZE).contains(size));
        let Some(size) = size else {
            let remedy = format!("write how many pixels the longer side has, 1 … {MAX_SIZE}");
            return Err(self.asset.error(format!("size is \"{text}\""), remedy));
        };
        let side = |share: f64| ((f64::from(size) * share).round() as u32).max(1);
        let (width, height) = if aspect < 1.0 { (side(aspect), size) } else { (size, side(1.0 / aspect)) };
        let crop = Crop { x: 0, y: 0, width, height };
        Ok(FilmSettings { width, height, crop, filter: Filter::Gaussian { stddev: 0.5 } })
    }
}

fn perspective(fov_x: f64) -> SensorKind {
    SensorKind::Perspective { fov_x, aperture_radius: 0.0, focus_distance: 1e4 }
}
