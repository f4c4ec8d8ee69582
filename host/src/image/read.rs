//! Reading images: EXR, HDR, PNG, JPEG, BMP and TGA into linear pixels.

use std::{
    cell::Cell,
    io::Cursor,
    panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook},
    path::Path,
    sync::Once,
};

use bidir_kernel::Spectrum;
use exr::prelude::{FlatSamples, Layer, MetaData, ReadChannels, ReadLayers, f16};
use image::DynamicImage;

use super::{
    Image,
    texels::{Packed, Texels},
};
use crate::error::{Error, Result};

/// The most pixels that an image may have: 16384 × 8192.
pub const MAX_PIXELS: u64 = 1 << 27;
/// The largest image once decoded, all channels and layers together, in bytes; also the largest file.
pub const MAX_BYTES: u64 = 4 << 30;

/// How much an image may take, however small the file is that it is packed into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Of each layer.
    pub pixels: u64,
    /// Once decoded, all channels and layers together.
    pub bytes: u64,
}

impl Default for Limits {
    /// [`MAX_PIXELS`] and [`MAX_BYTES`].
    fn default() -> Self {
        Self { pixels: MAX_PIXELS, bytes: MAX_BYTES }
    }
}

/// Linear pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Pixels {
    /// At least 1.
    pub width: u32,
    /// At least 1.
    pub height: u32,
    /// Rows from the top, each from the left. Whatever the file holds: negative, NaN and infinite values too.
    pub values: Vec<Spectrum>,
}

/// How the whole numbers of 8- and 16-bit files are meant. Files of floats are always linear.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Encoding {
    /// With the sRGB curve, to be undone.
    Srgb,
    /// As fractions of the largest number.
    Linear,
}

/// Reads an image; alpha is left out, and grey becomes three equal bands. Of an EXR's layers, the one with plain R, G, B.
///
/// # Errors
/// If the file cannot be read, is no image, or has more than [`MAX_PIXELS`].
pub fn read(path: &Path, encoding: Encoding) -> Result<Pixels> {
    Ok(packed(path, encoding)?.unpack())
}

/// Reads an image, and keeps it as densely as the file does.
///
/// # Errors
/// As [`read`].
pub fn packed(path: &Path, encoding: Encoding) -> Result<Packed> {
    let fail = |thing: String| Error::in_file(path, thing, REMEDY);
    let found = std::fs::metadata(path).map_err(|e| fail(format!("cannot be read ({e})")))?;
    if !found.is_file() {
        return Err(fail("is not a file".into()));
    }
    if found.len() > MAX_BYTES {
        return Err(fail(format!("is larger than {} GiB", MAX_BYTES >> 30)));
    }
    let bytes = std::fs::read(path).map_err(|e| fail(format!("cannot be read ({e})")))?;
    decode(&bytes, path, encoding, &Limits::default())
}

/// Reads a picture: what was written to be looked at, whole numbers with the sRGB curve.
///
/// # Errors
/// As [`read`].
pub fn picture(path: &Path) -> Result<Image> {
    let Pixels { width, height, values } = read(path, Encoding::Srgb)?;
    Ok(Image { width, height, pixels: values.into_iter().map(|value| value.0).collect() })
}

/// Decodes an image that is in memory already; messages call it `name`, whose ending counts where the bytes do not say what they are.
///
/// # Errors
/// If it is no image, or passes the limits.
pub fn decode(bytes: &[u8], name: &Path, encoding: Encoding, limits: &Limits) -> Result<Packed> {
    let decoded = quietly(|| if bytes.starts_with(&EXR_MAGIC) { exr(bytes, limits) } else { other(bytes, name, encoding, limits) });
    decoded.map_err(|thing| Error::in_file(name, format!("cannot be decoded ({thing})"), REMEDY))
}

/// Decodes a PNG or another image of whole numbers as [`decode`] does, and how opaque each pixel is: 0 … 1, or nothing where all are.
///
/// # Errors
/// As [`decode`].
pub fn decode_with_alpha(bytes: &[u8], name: &Path, encoding: Encoding, limits: &Limits) -> Result<(Packed, Vec<f32>)> {
    let decoded = quietly(|| {
        let decoded = whole_numbers(bytes, name, limits)?;
        let alpha = match decoded.color().has_alpha() {
            true => decoded.to_rgba16().pixels().map(|p| f32::from(p.0[3]) / 65535.0).collect(),
            false => Vec::new(),
        };
        Ok((pack(decoded, encoding), alpha))
    });
    decoded.map_err(|thing| Error::in_file(name, format!("cannot be decoded ({thing})"), REMEDY))
}

const REMEDY: &str = "name an EXR, HDR, PNG, JPEG, BMP or TGA image";

impl Pixels {
    /// Takes what no light can be for black (NaN, infinite, negative and huge bands), and says in how many pixels.
    pub fn clean(&mut self) -> usize {
        let mut count = 0;
        for value in &mut self.values {
            // The bound keeps sums over an image finite.
            let cleaned = value.map(|v| if (0.0..=1e30).contains(&v) { v } else { 0.0 });
            count += usize::from(cleaned != *value);
            *value = cleaned;
        }
        count
    }
}

const EXR_MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

fn check_size(width: u64, height: u64, limits: &Limits) -> std::result::Result<(), String> {
    match width.checked_mul(height) {
        Some(0) => Err("it has no pixels".into()),
        Some(pixels) if pixels <= limits.pixels => Ok(()),
        _ => Err(format!("{width}×{height} is more than {} pixels", limits.pixels)),
    }
}

fn exr(bytes: &[u8], limits: &Limits) -> std::result::Result<Packed, String> {
    let text = |e: exr::error::Error| e.to_string();
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(text)?;
    let mut total = 0_u64;
    for header in &meta.headers {
        let (width, height) = (header.layer_size.x() as u64, header.layer_size.y() as u64);
        check_size(width, height, limits)?;
        total = total.saturating_add(width * height * header.channels.bytes_per_pixel as u64);
        if header.deep {
            return Err("deep images are not supported".into());
        }
        // What a file says of one block is taken from memory before it is read, and may be more than the whole image.
        let block = header.max_block_pixel_size();
        let bytes = [block.y(), header.channels.bytes_per_pixel].into_iter().fold(block.x() as u64, |all, n| all.saturating_mul(n as u64));
        if bytes > limits.bytes {
            return Err(format!("its tiles or groups of lines take {bytes} bytes each, more than {}", limits.bytes));
        }
    }
    if total > limits.bytes {
        return Err(format!("its layers take more than {} bytes", limits.bytes));
    }
    let image = exr::prelude::read().no_deep_data().largest_resolution_level().all_channels().all_layers().all_attributes();
    let image = image.non_parallel().from_buffered(Cursor::new(bytes)).map_err(text)?;
    let named = |layer: &&Layer<_>| layer.attributes.layer_name.is_none() && channels(layer).is_some();
    let layer = image.layer_data.iter().find(named).or_else(|| image.layer_data.iter().find(|l| channels(l).is_some()));
    let layer = layer.ok_or("it has neither R, G, B nor Y")?;
    let (width, height) = (layer.size.x(), layer.size.y());
    let channels = channels(layer).unwrap_or_default();
    let bands: Vec<&FlatSamples> = channels.iter().map(|c| &layer.channel_data.list[*c].sample_data).collect();
    if bands.iter().any(|b| b.len() != width * height) {
        return Err("its channels differ in size".into());
    }
    let halves: Option<Vec<&[f16]>> = bands.iter().map(|band| if let FlatSamples::F16(v) = band { Some(&v[..]) } else { None }).collect();
    let texels = match halves {
        Some(halves) => Texels::halves(beside(&halves), bands.len()),
        None => {
            let floats: Vec<_> = bands.iter().map(|band| floats(band)).collect();
            Texels::floats(beside(&floats), bands.len())
        }
    };
    Ok(Packed { width: width as u32, height: height as u32, texels })
}

/// Which channels hold red, green and blue, or grey.
fn channels(layer: &Layer<exr::prelude::AnyChannels<FlatSamples>>) -> Option<Vec<usize>> {
    let list = &layer.channel_data.list;
    let find = |name: &str| list.iter().position(|c| c.name.eq_case_insensitive(name));
    match (find("R"), find("G"), find("B"), find("Y")) {
        (Some(r), Some(g), Some(b), _) => Some(vec![r, g, b]),
        (None, None, None, Some(y)) if find("RY").is_none() => Some(vec![y]),
        _ if list.len() == 1 => Some(vec![0]),
        _ => None,
    }
}

/// Bands that stand one after the other, pixel by pixel.
fn beside<T: Copy>(bands: &[impl AsRef<[T]>]) -> Vec<T> {
    let count = bands.first().map_or(0, |band| band.as_ref().len());
    (0..count).flat_map(|at| bands.iter().map(move |band| band.as_ref()[at])).collect()
}

fn floats(samples: &FlatSamples) -> Vec<f32> {
    match samples {
        FlatSamples::F16(v) => v.iter().map(|s: &f16| s.to_f32()).collect(),
        FlatSamples::F32(v) => v.clone(),
        FlatSamples::U32(v) => v.iter().map(|s| *s as f32).collect(),
    }
}

fn other(bytes: &[u8], path: &Path, encoding: Encoding, limits: &Limits) -> std::result::Result<Packed, String> {
    Ok(pack(whole_numbers(bytes, path, limits)?, encoding))
}

/// What the crate `image` reads.
fn whole_numbers(bytes: &[u8], path: &Path, limits: &Limits) -> std::result::Result<DynamicImage, String> {
    let mut reader = image::ImageReader::new(Cursor::new(bytes));
    // TGA has no signature, so there the name decides.
    if let Ok(format) = image::ImageFormat::from_path(path) {
        reader.set_format(format);
    }
    let mut reader = reader.with_guessed_format().map_err(|e| e.to_string())?;
    let mut theirs = image::Limits::default();
    theirs.max_image_width = Some(1 << 20);
    theirs.max_image_height = Some(1 << 20);
    theirs.max_alloc = Some(limits.pixels * 16);
    reader.limits(theirs);
    let decoded = reader.decode().map_err(|e| e.to_string())?;
    check_size(decoded.width().into(), decoded.height().into(), limits)?;
    Ok(decoded)
}

fn pack(decoded: DynamicImage, encoding: Encoding) -> Packed {
    let (width, height) = (decoded.width(), decoded.height());
    let texels = match decoded {
        DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_) => Texels::floats(decoded.into_rgb32f().into_raw(), 3),
        DynamicImage::ImageLuma16(_) | DynamicImage::ImageLumaA16(_) => Texels::shorts(decoded.into_luma16().into_raw(), 1, encoding),
        DynamicImage::ImageRgb16(_) | DynamicImage::ImageRgba16(_) => Texels::shorts(decoded.into_rgb16().into_raw(), 3, encoding),
        DynamicImage::ImageLuma8(_) | DynamicImage::ImageLumaA8(_) => Texels::bytes(decoded.into_luma8().into_raw(), 1, encoding),
        _ => Texels::bytes(decoded.into_rgb8().into_raw(), 3, encoding),
    };
    Packed { width, height, texels }
}

impl Encoding {
    /// The linear value of a fraction; IEC 61966-2-1.
    pub(super) fn decode(self, v: f64) -> f32 {
        let linear = match self {
            Self::Linear => v,
            Self::Srgb if v <= 0.04045 => v / 12.92,
            Self::Srgb => libm::pow((v + 0.055) / 1.055, 2.4),
        };
        linear as f32
    }
}

thread_local! {
    static QUIET: Cell<bool> = const { Cell::new(false) };
}

/// Runs a decoder so that a file which makes it panic is an error like any other, without a word on standard error.
fn quietly<T>(decode: impl FnOnce() -> std::result::Result<T, String>) -> std::result::Result<T, String> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let before = take_hook();
        set_hook(Box::new(move |panic| {
            if !QUIET.with(Cell::get) {
                before(panic);
            }
        }));
    });
    QUIET.with(|quiet| quiet.set(true));
    let result = catch_unwind(AssertUnwindSafe(decode));
    QUIET.with(|quiet| quiet.set(false));
    result.unwrap_or_else(|_| Err("the file is damaged".into()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn png(name: &str, pixels: &[[u8; 3]], width: u32) -> (tempfile::TempDir, std::path::PathBuf) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        let height = pixels.len() as u32 / width;
        image::RgbImage::from_raw(width, height, pixels.concat()).unwrap().save(&path).unwrap();
        (folder, path)
    }

    #[test]
    fn eight_bits_are_srgb_unless_they_are_said_to_be_linear() {
        let (_folder, path) = png("a.png", &[[255, 128, 0]], 1);
        let srgb = read(&path, Encoding::Srgb).unwrap().values[0];
        assert!((srgb[1] - 0.2158605).abs() < 1e-6 && srgb[0] == 1.0 && srgb[2] == 0.0);
        assert_eq!(read(&path, Encoding::Linear).unwrap().values[0][1], 128.0 / 255.0);
    }

    #[test]
    fn rows_come_from_the_top() {
        let (_folder, path) = png("a.bmp", &[[255, 0, 0], [0, 255, 0], [0, 0, 255], [0, 0, 0]], 2);
        let pixels = read(&path, Encoding::Srgb).unwrap();
        assert_eq!(pixels.values[1], Spectrum([0.0, 1.0, 0.0]));
        assert_eq!(pixels.values[2], Spectrum([0.0, 0.0, 1.0]));
    }

    #[test]
    fn floats_keep_their_values() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        let value = |x: usize, _: usize| (x as f32, -1.0_f32, f32::INFINITY);
        exr::prelude::write_rgb_file(&path, 2, 1, value).unwrap();
        assert_eq!(read(&path, Encoding::Srgb).unwrap().values[1], Spectrum([1.0, -1.0, f32::INFINITY]));
    }

    #[test]
    fn what_no_light_can_be_becomes_black_and_is_counted() {
        let values = vec![Spectrum([1.0, f32::NAN, -1.0]), Spectrum([f32::INFINITY, 2.0, 0.0]), Spectrum::ONE];
        let mut pixels = Pixels { width: 3, height: 1, values };
        assert_eq!(pixels.clean(), 2);
        assert_eq!(pixels.values, [Spectrum([1.0, 0.0, 0.0]), Spectrum([0.0, 2.0, 0.0]), Spectrum::ONE]);
    }

    #[test]
    fn what_is_no_image_is_an_error_that_names_the_file() {
        let folder = tempfile::tempdir().unwrap();
        for (name, content) in
            [("a.png", &b"hello"[..]), ("a.exr", &EXR_MAGIC), ("a.tga", b"x"), ("a", b""), ("a.hdr", b"#?RADIANCE\n\n-Y 9 +X")]
        {
            let path = folder.path().join(name);
            std::fs::write(&path, content).unwrap();
            let error = read(&path, Encoding::Srgb).unwrap_err().to_string();
            assert!(error.contains(name) && error.contains("cannot be decoded"), "{error}");
        }
        assert!(read(folder.path(), Encoding::Srgb).unwrap_err().to_string().contains("is not a file"));
        assert!(read(&folder.path().join("none.png"), Encoding::Srgb).is_err());
    }

    #[test]
    fn a_damaged_file_is_an_error_or_an_image_but_never_a_panic() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        exr::prelude::write_rgb_file(&path, 8, 8, |x, y| (x as f32, y as f32, 1.0_f32)).unwrap();
        let whole = std::fs::read(&path).unwrap();
        for at in (4..whole.len()).step_by(3) {
            let mut bytes = whole.clone();
            bytes[at] ^= 0xff;
            std::fs::write(&path, &bytes).unwrap();
            let _either = read(&path, Encoding::Srgb);
            std::fs::write(&path, &whole[..at]).unwrap();
            let _either = read(&path, Encoding::Srgb);
        }
    }
}
