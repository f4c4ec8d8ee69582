//! Where on the image contributions fall, and how bright it is there.

use bidir_kernel::Vec2;

use crate::{image::Image, scene::description::Crop};

/// The most cells there are.
const CELLS: f64 = (1 << 18) as f64;

/// About how many blocks there are.
const BLOCKS: f64 = 256.0;

/// The image in cells, which are pixels unless there are too many, and in blocks of cells.
#[derive(Clone, Copy, Debug)]
pub struct Grid {
    crop: Crop,
    /// Pixels along a cell's edge.
    cell: u32,
    /// Cells along a block's edge.
    block: u32,
}

impl Grid {
    /// Of an image of this window.
    pub fn new(crop: Crop) -> Self {
        let pixels = f64::from(crop.width) * f64::from(crop.height);
        let edge = |parts: f64| (pixels / parts).sqrt().ceil().max(1.0) as u32;
        let cell = edge(CELLS);
        Self { crop, cell, block: edge(BLOCKS).div_ceil(cell) }
    }

    /// The cell of a raster position, if it is within the window.
    pub fn at(&self, raster: Vec2) -> Option<u32> {
        let (x, y) = (f64::from(raster.x) - f64::from(self.crop.x), f64::from(raster.y) - f64::from(self.crop.y));
        let inside = x >= 0.0 && y >= 0.0 && x < f64::from(self.crop.width) && y < f64::from(self.crop.height);
        inside.then(|| y as u32 / self.cell * self.columns() + x as u32 / self.cell)
    }

    /// Pixels of the image.
    pub(super) fn pixels(&self) -> f64 {
        f64::from(self.crop.width) * f64::from(self.crop.height)
    }

    /// Cells in a row.
    fn columns(&self) -> u32 {
        self.crop.width.div_ceil(self.cell)
    }

    /// All cells.
    pub(super) fn cells(&self) -> usize {
        self.columns() as usize * self.crop.height.div_ceil(self.cell) as usize
    }

    /// Rows and columns of blocks.
    pub(super) fn blocks(&self) -> [usize; 2] {
        [self.crop.height, self.crop.width].map(|length| length.div_ceil(self.cell).div_ceil(self.block) as usize)
    }

    /// The block that a cell is in.
    pub(super) fn block(&self, cell: usize) -> usize {
        let (row, column) = (cell / self.columns() as usize, cell % self.columns() as usize);
        row / self.block as usize * self.blocks()[1] + column / self.block as usize
    }

    /// Pixels of a block.
    pub(super) fn size(&self, block: usize) -> f64 {
        let (edge, columns) = (self.cell * self.block, self.blocks()[1]);
        let length = |index: usize, whole: u32| f64::from(edge.min(whole - index as u32 * edge));
        length(block / columns, self.crop.height) * length(block % columns, self.crop.width)
    }

    /// How bright a noisy picture of the window is in each cell: as bright as the pixels around it, or as its block, whichever is brighter.
    /// Small bright things are seen so, and noise is not taken for darkness.
    pub(super) fn brightness(&self, image: &Image) -> Vec<f32> {
        let (width, height) = (image.width as usize, image.height as usize);
        let mean = |at: usize| image.pixels[at].iter().sum::<f32>() / 3.0;
        let (mut cells, mut blocks) = (vec![[0.0_f32; 2]; self.cells()], vec![[0.0_f32; 2]; self.blocks().iter().product()]);
        for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
            let near = |at: usize, end: usize| at.saturating_sub(1)..(at + 2).min(end);
            let around = near(y, height).flat_map(|y| near(x, width).map(move |x| y * width + x));
            let (sum, number) = around.fold((0.0, 0.0), |(sum, number), at| (sum + mean(at), number + 1.0));
            let cell = y / self.cell as usize * self.columns() as usize + x / self.cell as usize;
            let add = |to: &mut [f32; 2], value: f32| *to = [to[0] + value, to[1] + 1.0];
            add(&mut cells[cell], sum / number);
            add(&mut blocks[self.block(cell)], mean(y * width + x));
        }
        let bright = |[sum, number]: [f32; 2]| sum / number.max(1.0);
        cells.into_iter().enumerate().map(|(at, cell)| bright(cell).max(bright(blocks[self.block(at)])).max(0.0)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_and_blocks_cover_the_window() {
        for (width, height) in [(1, 1), (64, 48), (2000, 1500), (3, 4000)] {
            let grid = Grid::new(Crop { x: 7, y: 9, width, height });
            let [rows, columns] = grid.blocks();
            assert_eq!((0..rows * columns).map(|block| grid.size(block)).sum::<f64>(), grid.pixels());
            let corner = grid.at(Vec2::new(6.5 + width as f32, 8.5 + height as f32)).unwrap() as usize;
            assert_eq!((corner + 1, grid.block(corner) + 1), (grid.cells(), rows * columns));
            assert_eq!((grid.at(Vec2::new(7.0, 9.0)), grid.at(Vec2::new(6.0, 9.0))), (Some(0), None));
        }
    }

    #[test]
    fn a_small_bright_thing_is_bright_and_what_is_dark_beside_it_is_as_its_block() {
        let grid = Grid::new(Crop { x: 0, y: 0, width: 64, height: 64 });
        let mut image = Image::black(64, 64);
        image.pixels[64 * 9 + 9] = [16.0 * 9.0; 3];
        let bright = grid.brightness(&image);
        let at = |x: f32, y: f32| bright[grid.at(Vec2::new(x, y)).unwrap() as usize];
        assert_eq!([at(9.5, 9.5), at(8.5, 10.5), at(11.5, 11.5), at(12.5, 12.5)], [16.0, 16.0, 9.0, 0.0]);
    }
}
