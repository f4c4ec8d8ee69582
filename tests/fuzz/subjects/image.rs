//! Images in files, as textures and surroundings take them.

use std::{path::Path, sync::Arc};

use bidir::{
    image::read::{Encoding, Limits, Pixels, decode},
    scene::{description::EnvironmentImage, lights::EnvironmentTables},
};

use crate::told;

/// So small that the largest image is decoded soon.
const LIMITS: Limits = Limits { pixels: 1 << 16, bytes: 8 << 20 };

/// OpenEXR, whose pixels may be anything.
pub fn exr(data: &[u8]) {
    if data.starts_with(&[0x76, 0x2f, 0x31, 0x01]) {
        image(data, "fuzz.exr", |_| true);
    }
}

/// Radiance HDR, which has only what light can be.
pub fn hdr(data: &[u8]) {
    image(data, "fuzz.hdr", |v| v.is_finite() && v >= 0.0);
}

/// PNG, whose pixels are fractions. What is something else behind that name is read as that.
pub fn png(data: &[u8]) {
    let promised: fn(f32) -> bool = if data.starts_with(b"\x89PNG") { |v| (0.0..=1.0).contains(&v) } else { |_| true };
    image(data, "fuzz.png", promised);
}

/// An image is refused with a remedy, or has all its pixels, each of them as its format promises, and can light a scene once it is cleaned.
fn image(data: &[u8], name: &str, promised: fn(f32) -> bool) {
    for encoding in [Encoding::Srgb, Encoding::Linear] {
        let mut pixels = match decode(data, Path::new(name), encoding, &LIMITS) {
            Ok(packed) => packed.unpack(),
            Err(error) => return told(&error),
        };
        let count = u64::from(pixels.width) * u64::from(pixels.height);
        assert!((1..=LIMITS.pixels).contains(&count) && pixels.values.len() as u64 == count);
        assert!(pixels.values.iter().all(|value| value.0.into_iter().all(promised)));
        let cleaned = pixels.clean();
        assert!(pixels.values.iter().all(|value| value.0.iter().all(|v| (0.0..=1e30).contains(v))));
        assert!(cleaned as u64 <= count && pixels.clean() == 0);
        shines(pixels);
    }
}

fn shines(Pixels { width, height, values }: Pixels) {
    let tables = EnvironmentTables::new(Arc::new(EnvironmentImage { width, height, texels: values }), 1.0).expect("pixels");
    let total = tables.total();
    assert!(total.is_finite() && total >= 0.0, "all of it together gives {total}");
}
