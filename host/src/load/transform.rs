//! `<transform>`: steps applied one after the other, in f64.

use glam::{DAffine3, DMat3, DVec3};

use super::{suggest::list, value, xml::Element};
use crate::error::{Error, Place, Result};

const STEPS: [&str; 5] = ["translate", "scale", "rotate", "lookat", "matrix"];

/// The transform that an element's children describe, the first applied first.
pub(super) fn read(element: &Element) -> Result<DAffine3> {
    let mut whole = DAffine3::IDENTITY;
    for step in &element.children {
        step.no_children()?;
        let next = match step.tag.as_str() {
            "translate" => {
                step.only(&["value", "x", "y", "z"])?;
                DAffine3::from_translation(value::vector(step, Some(0.0))?)
            }
            "scale" => {
                step.only(&["value", "x", "y", "z"])?;
                DAffine3::from_scale(value::vector(step, Some(1.0))?)
            }
            "rotate" => {
                step.only(&["value", "x", "y", "z", "angle"])?;
                rotate(value::vector(step, Some(0.0))?, value::float(step.required("angle")?, &step.place)?, &step.place)?
            }
            "lookat" => {
                step.only(&["origin", "target", "up"])?;
                lookat(step)?
            }
            "matrix" => {
                step.only(&["value"])?;
                matrix(step)?
            }
            other => {
                let thing = format!("<{other}> stands inside <transform>");
                return Err(Error::at(&step.place, thing, format!("a transform is made of {}", list(&STEPS))));
            }
        };
        whole = next * whole;
    }
    let numbers = whole.to_cols_array();
    if numbers.iter().any(|v| !v.is_finite() || v.abs() > 1e30) {
        return Err(Error::at(&element.place, "the transform's numbers are too large", "keep them below 1e30"));
    }
    Ok(whole)
}

/// By `angle` degrees about `axis`, counter-clockwise against its direction.
fn rotate(axis: DVec3, angle: f64, place: &Place) -> Result<DAffine3> {
    let Some(axis) = axis.try_normalize() else {
        return Err(Error::at(place, "a rotation about no axis", "write one, such as <rotate y=\"1\" angle=\"90\"/>"));
    };
    // Quarter turns are exact, so that what is parallel stays so.
    let (sin, cos) = match angle.rem_euclid(360.0) {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        other => (libm::sin(other.to_radians()), libm::cos(other.to_radians())),
    };
    let column = |e: DVec3| e * cos + axis.cross(e) * sin + axis * (axis.dot(e) * (1.0 - cos));
    Ok(DAffine3::from_mat3(DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z))))
}

/// z towards the target, y as near to `up` as can be, x to the left.
fn lookat(step: &Element) -> Result<DAffine3> {
    let point = |name: &str| value::triple(step.required(name)?, &step.place);
    let (origin, target) = (point("origin")?, point("target")?);
    let Some(forward) = (target - origin).try_normalize() else {
        return Err(Error::at(&step.place, "origin and target are the same point", "look somewhere else"));
    };
    let up = match step.attribute("up") {
        Some(text) => value::triple(text, &step.place)?,
        None => any_up(forward),
    };
    let left = up.try_normalize().map(|up| up.cross(forward)).filter(|left| left.length() > 1e-9);
    let Some(left) = left.and_then(DVec3::try_normalize) else {
        return Err(Error::at(&step.place, "up is parallel to the direction of view", "choose another up, such as \"0, 0, 1\""));
    };
    Ok(DAffine3::from_mat3_translation(DMat3::from_cols(left, forward.cross(left), forward), origin))
}

/// What Mitsuba takes for up where a scene does not say (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
fn any_up(n: DVec3) -> DVec3 {
    let sign = 1.0_f64.copysign(n.z);
    let a = -1.0 / (sign + n.z);
    DVec3::new(1.0 + sign * n.x * n.x * a, sign * n.x * n.y * a, -sign * n.x)
}

/// Rows of a 4×4 or 3×3 matrix.
fn matrix(step: &Element) -> Result<DAffine3> {
    let v = value::floats(step.required("value")?, &step.place)?;
    let (width, translation) = match v.len() {
        9 => (3, DVec3::ZERO),
        16 if v[12..] == [0.0, 0.0, 0.0, 1.0] => (4, DVec3::new(v[3], v[7], v[11])),
        16 => return Err(Error::at(&step.place, "the matrix is not affine", "make its last row 0 0 0 1")),
        n => return Err(Error::at(&step.place, format!("a matrix of {n} numbers"), "write 16 (4×4) or 9 (3×3), row by row")),
    };
    let column = |c: usize| DVec3::new(v[c], v[width + c], v[2 * width + c]);
    Ok(DAffine3::from_mat3_translation(DMat3::from_cols(column(0), column(1), column(2)), translation))
}

/// How far a matrix may be from a rotation and still be taken for one.
const RIGID: f64 = 1e-3;

/// Whether this moves and mirrors only.
pub(super) fn is_rigid(to_world: &DAffine3) -> bool {
    is_similar(to_world) && (to_world.matrix3.x_axis.length() - 1.0).abs() < RIGID
}

/// Whether this moves, mirrors and scales evenly only.
pub(super) fn is_similar(to_world: &DAffine3) -> bool {
    let [x, y, z] = [to_world.matrix3.x_axis, to_world.matrix3.y_axis, to_world.matrix3.z_axis];
    let size = x.length();
    let even = |v: DVec3| (v.length() / size - 1.0).abs() < RIGID;
    let across = |a: DVec3, b: DVec3| (a.dot(b) / (size * size)).abs() < RIGID;
    size > 0.0 && even(y) && even(z) && across(x, y) && across(y, z) && across(z, x)
}

/// Whether this can be undone.
pub(super) fn is_invertible(to_world: &DAffine3) -> bool {
    let [x, y, z] = [to_world.matrix3.x_axis, to_world.matrix3.y_axis, to_world.matrix3.z_axis];
    match (x.try_normalize(), y.try_normalize(), z.try_normalize()) {
        (Some(x), Some(y), Some(z)) => x.cross(y).dot(z).abs() > 1e-12,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::load::xml;

    fn transform(steps: &str) -> Result<DAffine3> {
        let text = format!("<scene version=\"3.0.0\"><transform name=\"t\">{steps}</transform></scene>");
        read(&xml::read(&text, Path::new("s.xml"), None, &[])?.root.children[0])
    }

    #[test]
    fn steps_apply_in_the_order_of_the_file() {
        let t = transform("<translate x=\"1\" y=\"2\" z=\"3\"/><rotate y=\"1\" angle=\"90\"/>").unwrap();
        assert_eq!(t.transform_point3(DVec3::ZERO), DVec3::new(3.0, 2.0, -1.0));
    }

    #[test]
    fn lookat_points_z_at_the_target_and_x_to_the_left() {
        let t = transform("<lookat origin=\"0 0 4\" target=\"0 0 0\" up=\"0 1 0\"/>").unwrap();
        assert_eq!(t.transform_vector3(DVec3::Z), DVec3::NEG_Z);
        assert_eq!(t.transform_vector3(DVec3::X), DVec3::NEG_X);
        assert_eq!(t.translation, DVec3::new(0.0, 0.0, 4.0));
    }

    #[test]
    fn without_an_up_lookat_takes_the_one_that_mitsuba_takes() {
        let t = transform("<lookat origin=\"1 2 3\" target=\"0 0 0\"/>").unwrap();
        assert!(t.matrix3.y_axis.abs_diff_eq(DVec3::new(0.960357, -0.0792865, -0.267261), 1e-5));
        assert!(t.matrix3.x_axis.abs_diff_eq(DVec3::new(-0.0792865, 0.841427, -0.534522), 1e-5));
    }

    #[test]
    fn a_matrix_is_read_row_by_row() {
        let t = transform("<matrix value=\"1 2 3 4 5 6 7 8 9 10 11 12 0 0 0 1\"/>").unwrap();
        assert_eq!(t.transform_point3(DVec3::ONE), DVec3::new(10.0, 26.0, 42.0));
        assert!(transform("<matrix value=\"1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 1\"/>").is_err());
        assert_eq!(transform("<matrix value=\"1 2 3 4 5 6 7 8 9\"/>").unwrap().transform_point3(DVec3::X), DVec3::new(1.0, 4.0, 7.0));
    }

    #[test]
    fn what_describes_no_transform_is_refused() {
        for steps in [
            "<rotate angle=\"9\"/>",
            "<lookat origin=\"0 1 0\" target=\"0 0 0\" up=\"0 1 0\"/>",
            "<lookat origin=\"0 1 0\" target=\"0 1 0\"/>",
            "<look_at origin=\"0 1 0\" target=\"0 0 0\"/>",
            "<scale value=\"1e200\"/>",
            "<scale value=\"nan\"/>",
        ] {
            assert!(transform(steps).is_err(), "{steps}");
        }
    }
}
