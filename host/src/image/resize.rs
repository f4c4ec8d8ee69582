//! Pictures in other sizes.

use super::Image;

/// `image` at `width` × `height` pixels, each the mean of what it covers.
pub fn resize(image: &Image, width: u32, height: u32) -> Image {
    if (width, height) == (image.width, image.height) {
        return image.clone();
    }
    let (columns, rows) = (covers(image.width, width), covers(image.height, height));
    let mut out = Image::black(width, height);
    for (pixel, (row, column)) in out.pixels.iter_mut().zip(rows.iter().flat_map(|row| columns.iter().map(move |column| (row, column)))) {
        let mut sum = [0.0_f64; 3];
        for &(y, down) in row {
            for &(x, across) in column {
                for (sum, value) in sum.iter_mut().zip(image.at(x, y)) {
                    *sum += f64::from(value) * down * across;
                }
            }
        }
        *pixel = sum.map(|value| value as f32);
    }
    out
}

/// For each of `to` pixels: which of `from` it covers, and by how much of itself.
fn covers(from: u32, to: u32) -> Vec<Vec<(u32, f64)>> {
    let scale = f64::from(from) / f64::from(to);
    let cover = |pixel: u32| {
        let (start, end) = (f64::from(pixel) * scale, f64::from(pixel + 1) * scale);
        let last = (end.ceil() as u32).clamp(1, from);
        let share = |x: u32| (f64::from(x + 1).min(end) - f64::from(x).max(start)).max(0.0) / scale;
        (start as u32..last).map(|x| (x, share(x))).filter(|(_, share)| *share > 0.0).collect()
    };
    (0..to).map(cover).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_stays_whatever_the_size() {
        let mut image = Image::black(7, 5);
        image.pixels.iter_mut().enumerate().for_each(|(i, pixel)| *pixel = [i as f32, 1.0, (i * i) as f32]);
        let mean = |image: &Image, band: usize| image.pixels.iter().map(|p| f64::from(p[band])).sum::<f64>() / image.pixels.len() as f64;
        for (width, height) in [(7, 5), (3, 2), (14, 10), (1, 1), (9, 4)] {
            let resized = resize(&image, width, height);
            assert_eq!((resized.width, resized.height), (width, height));
            for band in 0..3 {
                assert!((mean(&resized, band) / mean(&image, band) - 1.0).abs() < 1e-5, "{width}×{height}");
            }
        }
    }
}
