//! Images in memory, and the files they come from and go to.

pub mod montage;
pub mod read;
pub mod resize;
pub mod texels;
pub mod text;
pub mod trim;
pub mod write;

/// A picture: linear R, G, B with the sRGB primaries, rows from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// In pixels.
    pub width: u32,
    /// In pixels.
    pub height: u32,
    /// `width · height` of them, row by row.
    pub pixels: Vec<[f32; 3]>,
}

impl Image {
    /// A black picture.
    pub fn black(width: u32, height: u32) -> Self {
        Self { width, height, pixels: vec![[0.0; 3]; width as usize * height as usize] }
    }

    /// The pixel at column `x`, row `y`.
    pub fn at(&self, x: u32, y: u32) -> [f32; 3] {
        self.pixels[y as usize * self.width as usize + x as usize]
    }
}
