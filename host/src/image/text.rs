//! Words in a picture.

use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};

use super::Image;

/// The height of a line, in pixels.
pub const LINE: u32 = 16;

const HEIGHT: RasterHeight = RasterHeight::Size16;
const WEIGHT: FontWeight = FontWeight::Regular;

/// How wide `text` comes out, in pixels.
pub fn width(text: &str) -> u32 {
    text.chars().count() as u32 * get_raster_width(WEIGHT, HEIGHT) as u32
}

/// Writes `text` with its upper left corner at (`x`, `y`), in `colour`; what falls outside the picture, or has no sign (beyond
/// Latin 1), is left out.
pub fn draw(image: &mut Image, (x, y): (u32, u32), text: &str, colour: [f32; 3]) {
    let advance = get_raster_width(WEIGHT, HEIGHT) as u32;
    for (place, letter) in text.chars().enumerate() {
        let Some(sign) = get_raster(letter, WEIGHT, HEIGHT) else { continue };
        let left = x + place as u32 * advance;
        for (row, line) in sign.rows().enumerate() {
            for (column, &cover) in line.iter().enumerate() {
                let (x, y) = (left + column as u32, y + row as u32);
                if x < image.width && y < image.height {
                    let pixel = &mut image.pixels[y as usize * image.width as usize + x as usize];
                    let cover = f32::from(cover) / 255.0;
                    for (value, ink) in pixel.iter_mut().zip(colour) {
                        *value += (ink - *value) * cover;
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_sign_of_a_label_is_drawn_and_nothing_beyond_the_edge() {
        for letter in "(0123456789,) k=×/spt".chars().filter(|c| *c != ' ') {
            let mut image = Image::black(width("x"), LINE);
            draw(&mut image, (0, 0), &letter.to_string(), [1.0; 3]);
            assert!(image.pixels.iter().any(|pixel| pixel[0] > 0.5), "{letter}");
            draw(&mut image, (3, 9), "beyond", [1.0; 3]);
        }
    }
}
