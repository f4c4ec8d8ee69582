//! Many pictures in one, in rows, with labels.

use super::{Image, text};

/// Between cells, and around everything.
const GUTTER: u32 = 8;
/// Between a cell and its caption.
const GAP: u32 = 2;
/// Linear.
const PAPER: [f32; 3] = [1.0; 3];
/// Linear; 0x20 in sRGB.
const INK: [f32; 3] = [0.014; 3];

/// A row of the montage; it is centred.
#[derive(Clone, Debug)]
pub struct Row {
    /// Lines to its left.
    pub label: Vec<String>,
    /// From the left, all pictures of all rows of one size.
    pub cells: Vec<Cell>,
}

/// A picture and what stands under it.
#[derive(Clone, Debug)]
pub struct Cell {
    /// Shown as it is, clamped.
    pub image: Image,
    /// One line.
    pub caption: String,
}

/// How wide each of `columns` cells may be in a montage of at most `width` pixels.
pub fn cell_width(width: u32, columns: u32, longest_label: u32) -> u32 {
    width.saturating_sub(longest_label + 2 * GUTTER) / columns.max(1) - GUTTER.min(width / columns.max(1))
}

/// Lays the rows out, labels in a column of their own.
pub fn compose(rows: &[Row]) -> Image {
    let (width, height) = rows.iter().flat_map(|row| &row.cells).map(|cell| (cell.image.width, cell.image.height)).next().unwrap_or((0, 0));
    let label = rows.iter().flat_map(|row| &row.label).map(|line| text::width(line)).max().unwrap_or(0);
    let columns = rows.iter().map(|row| row.cells.len() as u32).max().unwrap_or(0);
    let (across, down) = (width + GUTTER, height + GAP + text::LINE + GUTTER);
    let left = label + 2 * GUTTER;
    let mut out = Image::black(left + columns * across, GUTTER + rows.len() as u32 * down);
    out.pixels.fill(PAPER);
    for (number, row) in rows.iter().enumerate() {
        let top = GUTTER + number as u32 * down;
        let lines = row.label.len() as u32 * text::LINE;
        for (line, words) in row.label.iter().enumerate() {
            let y = top + (height.saturating_sub(lines)) / 2 + line as u32 * text::LINE;
            text::draw(&mut out, (GUTTER, y), words, INK);
        }
        let start = left + (columns - row.cells.len() as u32) * across / 2;
        for (column, cell) in row.cells.iter().enumerate() {
            let x = start + column as u32 * across;
            paste(&mut out, &cell.image, (x, top));
            let indent = width.saturating_sub(text::width(&cell.caption)) / 2;
            text::draw(&mut out, (x + indent, top + height + GAP), &cell.caption, INK);
        }
    }
    out
}

fn paste(onto: &mut Image, image: &Image, (x, y): (u32, u32)) {
    for (row, pixels) in image.pixels.chunks_exact(image.width as usize).enumerate() {
        let start = (y as usize + row) * onto.width as usize + x as usize;
        for (pixel, value) in onto.pixels[start..start + pixels.len()].iter_mut().zip(pixels) {
            *pixel = value.map(|v| v.clamp(0.0, 1.0));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_centred_and_captioned() {
        let cell = |value: f32| Cell { image: Image { width: 40, height: 30, pixels: vec![[value; 3]; 1200] }, caption: "(1,2)".into() };
        let rows = [
            Row { label: vec!["k = 1".into()], cells: vec![cell(0.5); 2] },
            Row { label: vec!["k = 2".into(), "×4".into()], cells: vec![cell(7.0); 3] },
        ];
        let picture = compose(&rows);
        let row = |y: u32| (0..picture.width).filter(|x| picture.at(*x, y) == [0.5; 3]).collect::<Vec<_>>();
        let cells = row(GUTTER + 1);
        assert_eq!(cells.len(), 80);
        let left = text::width("k = 1") + 2 * GUTTER;
        assert_eq!(cells[0], left + (40 + GUTTER) / 2);
        assert_eq!(picture.width, left + 3 * (40 + GUTTER));
        // Under the first cell stands something dark; brighter than white is white.
        assert!((cells[0]..cells[40]).any(|x| (0..text::LINE).any(|y| picture.at(x, GUTTER + 30 + GAP + y)[0] < 0.2)));
        assert!(picture.pixels.iter().all(|pixel| pixel[0] <= 1.0));
        assert_eq!(cell_width(1000, 3, 84), (1000 - 100) / 3 - GUTTER);
    }
}
