//! Numbers and words as they stand in attributes, read strictly: nothing may trail, and every number is finite.

use bidir_kernel::{BANDS, Spectrum};
use glam::DVec3;

use super::xml::Element;
use crate::error::{Error, Place, Result};

/// The largest number that may be written: its square is still within f64, and itself within f32.
const LARGEST: f64 = 1e30;

/// A number; neither infinite nor too large to reckon with.
pub(super) fn float(text: &str, place: &Place) -> Result<f64> {
    let trimmed = text.trim();
    match trimmed.parse::<f64>() {
        Ok(value) if value.abs() <= LARGEST => Ok(value),
        Ok(value) if value.is_finite() => Err(Error::at(place, format!("\"{trimmed}\" is too large"), "keep numbers within ±1e30")),
        Ok(_) => Err(Error::at(place, format!("\"{trimmed}\" is not a finite number"), "write a finite one, such as 0.5")),
        Err(_) => Err(Error::at(place, format!("\"{trimmed}\" is not a number"), "write one, such as 0.5")),
    }
}

/// A whole number.
pub(super) fn integer(text: &str, place: &Place) -> Result<i64> {
    let trimmed = text.trim();
    trimmed.parse().map_err(|_| Error::at(place, format!("\"{trimmed}\" is not a whole number"), "write one, such as 64"))
}

/// `true` or `false`, in any case.
pub(super) fn boolean(text: &str, place: &Place) -> Result<bool> {
    match text.trim().to_ascii_lowercase().as_str() {
        "true" => Ok(true),
        "false" => Ok(false),
        other => Err(Error::at(place, format!("\"{other}\" is neither true nor false"), "write true or false")),
    }
}

/// Numbers between commas or blanks.
pub(super) fn floats(text: &str, place: &Place) -> Result<Vec<f64>> {
    text.split([',', ' ', '\t', '\n', '\r']).filter(|part| !part.is_empty()).map(|part| float(part, place)).collect()
}

/// One number for every band, or one for each.
pub(super) fn color(text: &str, place: &Place) -> Result<Spectrum> {
    let numbers = floats(text, place)?;
    let bands = match numbers.as_slice() {
        [one] => [*one; BANDS],
        [r, g, b] => [*r, *g, *b],
        _ => {
            let thing = format!("a colour of {} numbers", numbers.len());
            return Err(Error::at(place, thing, "write one number, or three: linear red, green, blue"));
        }
    };
    Ok(spectrum(bands))
}

/// `bands` as they are stored.
pub(super) fn spectrum(bands: [f64; BANDS]) -> Spectrum {
    Spectrum(bands.map(|v| v as f32))
}

/// What `<spectrum value>` says: one number, the same in every band.
pub(super) fn uniform(element: &Element) -> Result<Spectrum> {
    let remedy = "write <rgb> with three numbers, or one number that holds for every wavelength";
    if element.attribute("filename").is_some() {
        return Err(Error::at(&element.place, "spectra from files are not supported", remedy));
    }
    let text = element.required("value")?;
    if text.contains(':') {
        return Err(Error::at(&element.place, "spectra given by wavelength are not supported", remedy));
    }
    Ok(spectrum([float(text, &element.place)?; BANDS]))
}

/// `x`, `y`, `z`, each `absent` if it is missing, or `value` with one number or three.
pub(super) fn vector(element: &Element, absent: Option<f64>) -> Result<DVec3> {
    let place = &element.place;
    let Some(value) = element.attribute("value") else {
        let axis = |name| match (element.attribute(name), absent) {
            (Some(text), _) => float(text, place),
            (None, Some(absent)) => Ok(absent),
            (None, None) => element.required(name).map(|_| 0.0),
        };
        return Ok(DVec3::new(axis("x")?, axis("y")?, axis("z")?));
    };
    if ["x", "y", "z"].iter().any(|name| element.attribute(name).is_some()) {
        return Err(Error::at(place, format!("<{}> has both \"value\" and x, y, z", element.tag), "keep one of them"));
    }
    triple(value, place)
}

/// Three numbers, or one for all three.
pub(super) fn triple(text: &str, place: &Place) -> Result<DVec3> {
    match floats(text, place)?.as_slice() {
        [x, y, z] => Ok(DVec3::new(*x, *y, *z)),
        [all] => Ok(DVec3::splat(*all)),
        other => Err(Error::at(place, format!("a vector of {} numbers", other.len()), "write three, such as \"0, 1, 0\"")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place() -> Place {
        Place { file: "s.xml".into(), position: None }
    }

    #[test]
    fn what_is_not_a_finite_number_is_refused() {
        for text in ["", "1x", "nan", "inf", "1e999", "1 2", "0x10", "1,"] {
            assert!(float(text, &place()).is_err(), "{text}");
        }
        assert_eq!(float(" -1.5e-3 ", &place()), Ok(-1.5e-3));
    }

    #[test]
    fn a_whole_number_has_no_point() {
        assert!(integer("1.0", &place()).is_err());
        assert_eq!(integer(" -1 ", &place()), Ok(-1));
    }

    #[test]
    fn a_colour_is_one_number_or_three_between_commas_or_blanks() {
        assert_eq!(color("0.5", &place()), Ok(Spectrum::splat(0.5)));
        assert_eq!(color("1, 2 3", &place()), Ok(Spectrum([1.0, 2.0, 3.0])));
        assert!(color("1 2", &place()).is_err());
        assert!(color("#ff0000", &place()).is_err());
        assert!(color("1e300", &place()).is_err());
    }
}
