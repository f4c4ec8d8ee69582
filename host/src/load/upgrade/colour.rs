//! `<srgb>`: colours as screens show them.

use super::super::value;
use crate::error::{Error, Place, Result};

/// Whether a text is three numbers between commas or blanks.
pub(super) fn is_triple(text: &str) -> bool {
    let parts: Vec<&str> = text.split([',', ' ', '\t', '\n', '\r']).filter(|part| !part.is_empty()).collect();
    parts.len() == 3 && parts.iter().all(|part| part.parse::<f64>().is_ok())
}

/// `#rrggbb`, or numbers in 0 … 1, with the curve of sRGB undone.
pub(super) fn linear(text: &str, place: &Place) -> Result<String> {
    let text = text.trim();
    let bands = match text.strip_prefix('#') {
        Some(digits) => {
            bytes(digits).ok_or_else(|| Error::at(place, format!("\"{text}\" is no colour"), "write #rrggbb, six hexadecimal digits"))?
        }
        None => value::floats(text, place)?,
    };
    Ok(bands.into_iter().map(|v| undone(v).to_string()).collect::<Vec<_>>().join(" "))
}

fn bytes(digits: &str) -> Option<Vec<f64>> {
    if digits.len() != 6 || !digits.bytes().all(|digit| digit.is_ascii_hexdigit()) {
        return None;
    }
    let whole = u32::from_str_radix(digits, 16).ok()?;
    Some([16, 8, 0].map(|shift| f64::from(whole >> shift & 0xff) / 255.0).into())
}

/// IEC 61966-2-1.
fn undone(v: f64) -> f64 {
    if v <= 0.04045 { v / 12.92 } else { libm::pow((v + 0.055) / 1.055, 2.4) }
}
