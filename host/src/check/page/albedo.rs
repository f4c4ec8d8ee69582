//! What is scattered in all, and how much the weight of a sample varies, by the angle of incidence.

use bidir_kernel::{Bsdf, Carried, Lobe, Vec3};

use crate::check::dice::Dice;

/// In degrees.
const ANGLES: [f64; 20] =
    [0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0, 50.0, 55.0, 60.0, 65.0, 70.0, 75.0, 80.0, 84.0, 87.0, 89.0];

const SAMPLES: usize = 1 << 13;

/// The drawing's inner size.
const WIDTH: f64 = 200.0;
const HEIGHT: f64 = 110.0;

/// Noise above this leaves the drawing.
const NOISY: f64 = 4.0;

/// Of one angle: the bands' means, and the standard deviation of their mean.
type Found = ([f64; 3], f64);

pub(super) fn figure(bsdf: &dyn Bsdf, less: u32, dice: &mut Dice) -> String {
    let found = ANGLES.map(|degrees| at(bsdf, degrees, SAMPLES >> less, dice));
    let brightest = found.iter().flat_map(|(bands, _)| *bands).fold(0.0, f64::max);
    let noise = found.iter().map(|(_, deviation)| *deviation).fold(0.0, f64::max);
    let top = even(brightest.max(noise.min(NOISY)).max(1.0));
    let grey = found.iter().all(|([r, g, b], _)| (r - g).abs().max((g - b).abs()) < 0.01 * brightest);
    let mut curves = vec![("noise", found.map(|(_, deviation)| deviation))];
    if grey {
        curves.push(("grey", found.map(|(bands, _)| bands[1])));
    } else {
        curves.extend(["red", "green", "blue"].into_iter().enumerate().map(|(band, class)| (class, found.map(|(bands, _)| bands[band]))));
    }
    let curves: String = curves.into_iter().map(|(class, values)| curve(class, &values, top)).collect();
    format!(
        "<svg class=\"curve\" viewBox=\"-26 -12 238 144\" role=\"img\"><title>albedo and noise by angle of incidence</title>\n{}{curves}</svg>\n\
         <figcaption>albedo (solid) and standard deviation of the weight (dashed)</figcaption>",
        axes(top)
    )
}

fn at(bsdf: &dyn Bsdf, degrees: f64, samples: usize, dice: &mut Dice) -> Found {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let wo = Vec3::new(-sin as f32, 0.0, cos as f32);
    let (mut sums, mut sum, mut squares) = ([0.0; 3], 0.0, 0.0);
    for _ in 0..samples {
        let Some(sample) = bsdf.sample(wo, dice.three(), Carried::Radiance) else { continue };
        // Without what refraction does to radiance.
        let factor = if sample.lobe.intersects(Lobe::TRANSMISSION) { f64::from(sample.eta).powi(2) } else { 1.0 };
        let bands = sample.weight.0.map(|weight| factor * f64::from(weight));
        let mean = (bands[0] + bands[1] + bands[2]) / 3.0;
        (sum, squares) = (sum + mean, squares + mean * mean);
        (0..3).for_each(|band| sums[band] += bands[band]);
    }
    let count = samples.max(1) as f64;
    (sums.map(|sum| sum / count), (squares / count - (sum / count).powi(2)).max(0.0).sqrt())
}

/// 1, 2 or 5 times a power of 10, not below.
fn even(x: f64) -> f64 {
    let power = 10.0_f64.powf(x.log10().floor());
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|step| step * power).find(|even| *even >= x * 0.999).unwrap_or(x)
}

fn axes(top: f64) -> String {
    let mut out = String::new();
    for quarter in 0..=4 {
        let y = HEIGHT * (1.0 - f64::from(quarter) / 4.0);
        out += &format!("<line class=\"ring\" x1=\"0\" y1=\"{y:.1}\" x2=\"{WIDTH}\" y2=\"{y:.1}\"/>\n");
    }
    let one = HEIGHT * (1.0 - 1.0 / top);
    out += &format!("<line class=\"surface\" x1=\"0\" y1=\"{one:.1}\" x2=\"{WIDTH}\" y2=\"{one:.1}\"/>\n");
    let label = |value: f64| if value < 1e4 { format!("{value}") } else { format!("{value:.0e}") };
    for (y, value) in [(HEIGHT, 0.0), (0.5 * HEIGHT, 0.5 * top), (0.0, top)] {
        out += &format!("<text class=\"end\" x=\"-4\" y=\"{:.1}\">{}</text>\n", y + 3.5, label(value));
    }
    for degrees in [0, 30, 60, 90] {
        let x = WIDTH * f64::from(degrees) / 90.0;
        out += &format!("<text x=\"{x:.1}\" y=\"{:.1}\">{degrees}°</text>\n", HEIGHT + 14.0);
    }
    out
}

fn curve(class: &str, values: &[f64], top: f64) -> String {
    let point = |(degrees, value): (f64, &f64)| format!("{:.1},{:.1}", WIDTH * degrees / 90.0, HEIGHT * (1.0 - value.min(top) / top));
    let points: Vec<_> = ANGLES.into_iter().zip(values).map(point).collect();
    format!("<polyline class=\"line {class}\" points=\"{}\"/>\n", points.join(" "))
}

#[cfg(test)]
mod tests {
    use super::even;

    #[test]
    fn an_axis_ends_at_an_even_number_that_holds_all() {
        for (x, top) in [(1.0, 1.0), (1.2, 2.0), (3.9, 5.0), (8.0, 10.0), (1234.0, 2000.0)] {
            assert!((even(x) / top - 1.0).abs() < 1e-9, "{x}: {}", even(x));
        }
    }
}
