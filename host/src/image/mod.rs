//! Images: files and pixels.

pub mod read;
