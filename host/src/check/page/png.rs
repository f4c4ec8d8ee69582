//! Small pictures inside the page.

use image::{ExtendedColorType, ImageEncoder, codecs::png};

use super::markup::base64;

/// A data URI of 8-bit R, G, B, A, rows from the top.
pub(crate) fn uri(width: usize, height: usize, rgba: &[u8]) -> String {
    let mut bytes = Vec::new();
    let encoder = png::PngEncoder::new_with_quality(&mut bytes, png::CompressionType::Best, png::FilterType::Adaptive);
    // It can fail only for bytes that are no `width` × `height` pixels, or for a full disk, and memory is none.
    match encoder.write_image(rgba, width as u32, height as u32, ExtendedColorType::Rgba8) {
        Ok(()) => format!("data:image/png;base64,{}", base64(&bytes)),
        Err(_) => "data:,".to_owned(),
    }
}

/// Linear → 8-bit sRGB (IEC 61966-2-1), after a shoulder that lets bright colours keep some of their hue; NaN is black.
pub(crate) fn toned(linear: f64) -> u8 {
    let v = 1.0 - (-1.6 * linear.max(0.0)).exp();
    let encoded = if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 };
    (encoded * 255.0 + 0.5) as u8
}
