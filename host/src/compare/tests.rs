use super::*;

fn flat(width: u32, height: u32, pixel: [f32; 3]) -> Image {
    Image { width, height, pixels: vec![pixel; (width * height) as usize] }
}

fn close(found: f64, wanted: f64) {
    assert!((found - wanted).abs() < 1e-9 * wanted.abs().max(1.0), "{found} instead of {wanted}");
}

/// Pixel by pixel: 1 against (1, 2, 0): squares 0, 1, 1 over 1.01, 4.01, 0.01; |x − r| / (|x| + |r| + 0.01) = 0, 1/3.01, 1/1.01.
#[test]
fn the_measures_are_what_they_say() -> Result<()> {
    let found = compare(&flat(40, 20, [1.0; 3]), &flat(40, 20, [1.0, 2.0, 0.0]))?;
    close(found.relmse, (1.0 / 4.01 + 1.0 / 0.01) / 3.0);
    close(found.relmse_trimmed, found.relmse);
    close(found.smape, (1.0 / 3.01 + 1.0 / 1.01) / 3.0);
    close(found.mean_ratio, 1.0);
    close(found.bias_rgb[1], -0.5);
    assert_eq!(found.bias_rgb[2], f64::INFINITY);
    assert_eq!((found.worst_block.deviation, found.block_rms, found.nonfinite), (0.0, 0.0, 0));
    Ok(())
}

/// 48×32 pixels are 3×2 blocks, and the incomplete ones beyond do not count. One pixel of 1 + 256 makes its block 2 against 1.
#[test]
fn the_worst_block_is_found_and_one_firefly_trimmed() -> Result<()> {
    let reference = flat(50, 40, [1.0; 3]);
    let mut image = reference.clone();
    image.pixels[20 * 50 + 35] = [257.0; 3];
    image.pixels[39 * 50 + 49] = [1e6; 3];
    let found = compare(&image, &reference)?;
    assert_eq!(found.worst_block, Block { x: 32, y: 16, deviation: 1.0 });
    close(found.block_rms, (1.0_f64 / 6.0).sqrt());
    // 0.1 % of 2,000 pixels are the two.
    assert_eq!(found.relmse_trimmed, 0.0);
    let darker = compare(&flat(50, 40, [0.9; 3]), &reference)?;
    close(darker.bias, f64::from(0.9_f32) - 1.0);
    close(darker.worst_block.deviation, f64::from(0.9_f32) - 1.0);
    Ok(())
}

/// A black block counts as 5 % of the mean (½ · 5 % here): 0.1 more is off by 4.
#[test]
fn dark_blocks_are_held_against_the_mean() -> Result<()> {
    let half =
        |dark: f32| Image { width: 32, height: 16, pixels: (0..32 * 16).map(|i| if i % 32 < 16 { [dark; 3] } else { [1.0; 3] }).collect() };
    let found = compare(&half(0.1), &half(0.0))?;
    close(found.worst_block.deviation, f64::from(0.1_f32) / 0.025);
    Ok(())
}

/// Halves r ± d of a reference r, against r itself: (x − a)(x − b) = −d², over r² + 0.01.
#[test]
fn halves_take_the_references_own_noise_out() -> Result<()> {
    let found = against_halves(&flat(8, 8, [1.0; 3]), [&flat(8, 8, [1.25; 3]), &flat(8, 8, [0.75; 3])])?;
    close(found.relmse, -0.0625 / 1.01);
    assert_eq!((found.bias, found.smape), (0.0, 0.0));
    Ok(())
}

#[test]
fn pixels_that_are_not_finite_count_as_black() -> Result<()> {
    let (mut image, reference) = (flat(16, 16, [1.0; 3]), flat(16, 16, [1.0; 3]));
    image.pixels[3] = [1.0, f32::NAN, 1.0];
    image.pixels[4] = [f32::INFINITY; 3];
    let found = compare(&image, &reference)?;
    assert_eq!((found.nonfinite, found.nonfinite_reference), (2, 0));
    close(found.mean_ratio, 254.0 / 256.0);
    assert_eq!(compare(&reference, &image)?.nonfinite_reference, 2);
    Ok(())
}

#[test]
fn sizes_must_match_and_small_ones_work() -> Result<()> {
    let error = compare(&flat(3, 4, [0.0; 3]), &flat(4, 3, [0.0; 3])).err().map(|e| e.to_string());
    assert_eq!(error.as_deref(), Some("images of 3×4 and 4×3 pixels cannot be compared; render both at one size"));
    assert!(compare(&flat(0, 0, [0.0; 3]), &flat(0, 0, [0.0; 3])).is_err());
    let black = compare(&flat(1, 1, [0.0; 3]), &flat(1, 1, [0.0; 3]))?;
    assert_eq!((black.relmse_trimmed, black.bias, black.worst_block.deviation), (0.0, 0.0, 0.0));
    Ok(())
}
