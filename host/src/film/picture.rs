//! The pyramid as one picture: a row for each path length, s from the left and t from the right (Veach 1997, figures 10.3 and 10.4).

use bidir_kernel::Technique;

use crate::image::{
    Image,
    montage::{self, Cell, Row},
    resize::resize,
    text,
};

/// The widest picture, in pixels.
const WIDEST: u32 = 2400;
/// The widest label, in letters.
const LABEL: &str = "× 1/1048576";
/// The share of a cell's pixels that are exposed below [`BRIGHT`], black ones aside: a caustic alone in its cell is to be seen too.
const QUANTILE: f64 = 0.95;
/// Cells with less than this of what the fullest one of their row holds have no say in how it is exposed.
const FULL: f64 = 0.1;
/// What the cell that decides over its row is exposed to: linear, and nearly white.
const BRIGHT: f64 = 0.85;

/// Which cell decides how a row is exposed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Deciding {
    /// The brightest: weights keep noise from it.
    Brightest,
    /// The middle one of those that are not black: without weights, the brightest may be nothing but noise.
    Middle,
}

/// One technique's part, ready to be shown.
#[derive(Clone, Debug)]
pub struct Layer {
    /// Which.
    pub technique: Technique,
    /// Of the size that [`cell_size`] says.
    pub image: Image,
}

/// The size of a cell, if the longest row has `columns` of them: that of the image, or less where the picture would grow too wide,
/// or a multiple of it where captions would not fit below.
pub fn cell_size(width: u32, height: u32, columns: u32) -> (u32, u32) {
    let room = montage::cell_width(WIDEST, columns, text::width(LABEL)).max(1);
    let caption = text::width("(10,10)");
    let scaled = if width < caption { width * caption.div_ceil(width.max(1)) } else { width.min(room) };
    let rows = (f64::from(height) * f64::from(scaled) / f64::from(width)).round() as u32;
    (scaled, rows.max(1))
}

/// The layer at that size.
pub fn layer(technique: Technique, image: &Image, (width, height): (u32, u32)) -> Layer {
    Layer { technique, image: resize(image, width, height) }
}

/// How a row is exposed: 2 to this power.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stops(pub i32);

impl Stops {
    /// What radiance is multiplied by.
    pub fn factor(self) -> f64 {
        2.0_f64.powi(self.0)
    }
}

impl std::fmt::Display for Stops {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let power = 1_u64 << self.0.unsigned_abs().min(60);
        if self.0 >= 0 { write!(f, "× {power}") } else { write!(f, "× 1/{power}") }
    }
}

/// Draws the layers, and says how the rows of each path length are exposed. As paths grow longer, rows are only ever exposed more.
pub fn draw(layers: &[Layer], deciding: Deciding) -> (Image, Vec<(u32, Stops)>) {
    let mut lengths: Vec<u32> = layers.iter().map(|layer| layer.technique.length()).collect();
    lengths.sort_unstable();
    lengths.dedup();
    let mut exposures: Vec<(u32, Stops)> = Vec::new();
    let mut rows = Vec::new();
    for length in lengths {
        let mut row: Vec<&Layer> = layers.iter().filter(|layer| layer.technique.length() == length).collect();
        row.sort_by_key(|layer| layer.technique.s);
        let before = exposures.last().map(|(_, stops)| *stops);
        let stops = match (stops(&row, deciding), before) {
            (Some(stops), Some(before)) => Stops(stops.0.max(before.0)),
            (stops, before) => stops.or(before).unwrap_or(Stops(0)),
        };
        exposures.push((length, stops));
        let cell = |layer: &&Layer| Cell {
            image: exposed(&layer.image, stops.factor() as f32),
            caption: format!("({},{})", layer.technique.s, layer.technique.t),
        };
        rows.push(Row { label: vec![format!("k = {length}"), stops.to_string()], cells: row.iter().map(cell).collect() });
    }
    (montage::compose(&rows), exposures)
}

/// The exposure that shows the deciding cell of a row well; `None` if the row is black.
fn stops(row: &[&Layer], deciding: Deciding) -> Option<Stops> {
    let cells: Vec<(f64, f64)> = row.iter().filter_map(|layer| lit(&layer.image)).collect();
    let fullest = cells.iter().map(|cell| cell.0).fold(0.0, f64::max);
    let mut levels: Vec<f64> = cells.iter().filter(|cell| cell.0 >= FULL * fullest).map(|cell| cell.1).collect();
    levels.sort_unstable_by(f64::total_cmp);
    let level = match deciding {
        Deciding::Brightest => levels.last(),
        Deciding::Middle => levels.get(levels.len() / 2),
    };
    Some(Stops((BRIGHT / level?).log2().round().clamp(-60.0, 60.0) as i32))
}

/// What a picture holds in all, and how bright the brighter of its pixels are; `None` for a black one.
fn lit(image: &Image) -> Option<(f64, f64)> {
    let mean = |pixel: &[f32; 3]| pixel.iter().map(|&v| f64::from(v)).sum::<f64>() / 3.0;
    let mut values: Vec<f64> = image.pixels.iter().map(mean).filter(|&value| value > 0.0).collect();
    let index = ((values.len() as f64 * QUANTILE) as usize).min(values.len().checked_sub(1)?);
    let total = values.iter().sum();
    Some((total, *values.select_nth_unstable_by(index, f64::total_cmp).1))
}

fn exposed(image: &Image, factor: f32) -> Image {
    Image { pixels: image.pixels.iter().map(|pixel| pixel.map(|v| v * factor)).collect(), ..*image }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flat(s: u32, t: u32, value: f32) -> Layer {
        Layer { technique: Technique { s, t }, image: Image { width: 80, height: 60, pixels: vec![[value; 3]; 4800] } }
    }

    #[test]
    fn longer_paths_are_exposed_no_less() {
        let layers = [flat(0, 2, 0.8), flat(1, 1, 0.1), flat(0, 3, 0.2), flat(1, 2, 0.01), flat(0, 4, 4.8), flat(0, 5, 0.0)];
        let (_, exposures) = draw(&layers, Deciding::Brightest);
        assert_eq!(exposures, [(1, Stops(0)), (2, Stops(2)), (3, Stops(2)), (4, Stops(2))]);
        assert_eq!(Stops(-3).to_string(), "× 1/8");
    }

    #[test]
    fn one_noisy_cell_does_not_decide_over_the_middle() {
        let layers = [flat(0, 3, 0.8), flat(1, 2, 0.1), flat(2, 1, 0.1), flat(3, 0, 0.0)];
        assert_eq!(draw(&layers, Deciding::Middle).1, [(2, Stops(3))]);
        assert_eq!(draw(&layers, Deciding::Brightest).1, [(2, Stops(0))]);
    }

    /// Four pixels of 4800 at 6.4 are 0.005 on the mean, a twentieth of the other cell.
    #[test]
    fn a_caustic_is_exposed_for_itself_and_a_few_sparks_are_not() {
        let mut sparse = flat(0, 3, 0.0);
        sparse.image.pixels[..4].fill([6.4; 3]);
        assert_eq!(draw(&[sparse.clone()], Deciding::Brightest).1, [(2, Stops(-3))]);
        assert_eq!(draw(&[sparse, flat(1, 2, 0.1)], Deciding::Brightest).1, [(2, Stops(3))]);
    }

    #[test]
    fn a_pyramid_is_never_too_wide_and_its_captions_fit() {
        for (width, height, columns) in [(1920, 1080, 8), (8, 8, 3), (128, 128, 66), (100, 3000, 7)] {
            let (w, h) = cell_size(width, height, columns);
            let layer = |s| Layer { technique: Technique { s, t: columns - 1 - s }, image: Image::black(w, h) };
            let picture = draw(&(0..columns).map(layer).collect::<Vec<_>>(), Deciding::Middle).0;
            assert!(picture.width <= WIDEST, "{width}×{height}: {}", picture.width);
        }
        assert!(cell_size(8, 8, 3).0 >= text::width("(10,10)"));
    }
}
