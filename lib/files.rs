//! Chapter 11: files that are read, and what is wrong with them. Textures from image files.
//!
//! What is wrong with a file is said with the file's name; nothing is drawn then.
//!
//! ```
//! use rasterbook::files::decode_texture;
//!
//! let error = decode_texture(b"", "folder/bricks.png".as_ref()).expect_err("no bytes");
//! assert_eq!(error.to_string(), "folder/bricks.png: is empty");
//! ```

use std::fmt;
use std::fs::File;
use std::io::{Cursor, Read};
use std::path::{Path, PathBuf};

use image::metadata::Orientation;
use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits, Rgb, Rgba};

use crate::texture::Texture;
use crate::{Color, Framebuffer};

/// The largest file that is read: 256 MiB.
pub const MAX_FILE_BYTES: u64 = 1 << 28;

/// The most pixels that an image may have, and all textures of a model together: 8192×8192.
pub const MAX_TEXELS: u64 = 1 << 26;

/// The most pixels that a byte of an image file can stand for: a PNG file of one bit a pixel, packed as far as its
/// compression can. A header that claims more is wrong.
const MAX_PIXELS_A_BYTE: u64 = 8 * 1032;

/// Why a file cannot be used.
#[derive(Clone, Debug)]
pub struct FileError {
    path: PathBuf,
    cause: String,
}

impl FileError {
    pub(crate) fn new(path: &Path, cause: impl fmt::Display) -> Self {
        Self { path: path.to_owned(), cause: cause.to_string() }
    }
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&shown(&format!("{}: {}", self.path.display(), self.cause)))
    }
}

impl std::error::Error for FileError {}

/// What is odd about a file that can be used all the same.
pub type Warnings = Vec<String>;

/// Text from a file as a terminal may show it: what could move the cursor, change colors or turn the direction of
/// writing is escaped.
pub(crate) fn shown(text: &str) -> String {
    let turns = |c| matches!(c, '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        if c.is_control() || turns(c) {
            safe.extend(c.escape_default());
        } else {
            safe.push(c);
        }
    }
    safe
}

/// The bytes of a file: the one door for all that is read. A folder, a pipe and a device are refused, and so is a file
/// larger than [`MAX_FILE_BYTES`], before it is read.
pub(crate) fn read_file(path: &Path) -> Result<Vec<u8>, FileError> {
    let failure = |error| FileError::new(path, error);
    let metadata = std::fs::metadata(path).map_err(failure)?;
    if !metadata.is_file() {
        let what = if metadata.is_dir() { "is a folder" } else { "is no regular file: a pipe or a device" };
        return Err(FileError::new(path, what));
    }
    let too_large = |size| {
        let limit = MAX_FILE_BYTES >> 20;
        FileError::new(
            path,
            format!("has {size} bytes; files of up to {MAX_FILE_BYTES} ({limit} MiB) are read"),
        )
    };
    if metadata.len() > MAX_FILE_BYTES {
        return Err(too_large(metadata.len().to_string()));
    }
    let mut bytes = Vec::with_capacity(metadata.len() as usize);
    // It may grow while it is read.
    File::open(path)
        .and_then(|file| file.take(MAX_FILE_BYTES + 1).read_to_end(&mut bytes))
        .map_err(failure)?;
    if bytes.len() as u64 > MAX_FILE_BYTES {
        return Err(too_large(format!("more than {MAX_FILE_BYTES}")));
    }
    Ok(bytes)
}

/// Reads a texture from an image file (PNG, BMP, TGA, JPEG); what a file is says its content, not its name.
///
/// # Errors
/// If the file cannot be read or is no such image, or if it is larger than [`MAX_FILE_BYTES`] or [`MAX_TEXELS`].
pub fn load_texture(path: &Path) -> Result<(Texture, Warnings), FileError> {
    load_texture_within(path, MAX_TEXELS)
}

/// As [`load_texture`], with no more than `max_texels` pixels.
pub(crate) fn load_texture_within(path: &Path, max_texels: u64) -> Result<(Texture, Warnings), FileError> {
    let bytes = read_file(path)?;
    let (texture, format) = decode_within(&bytes, path, max_texels)?;
    let mut warnings = Warnings::new();
    if let Ok(named) = ImageFormat::from_path(path)
        && named != format
    {
        warnings.push(shown(&format!("{}: is a {format:?} file, whatever its name says", path.display())));
    }
    Ok((texture, warnings))
}

/// Decodes an image file; `path` names it in errors, and its extension tells a TGA file, which has no mark inside.
///
/// # Errors
/// As [`load_texture`].
pub fn decode_texture(bytes: &[u8], path: &Path) -> Result<(Texture, ImageFormat), FileError> {
    decode_within(bytes, path, MAX_TEXELS)
}

fn decode_within(bytes: &[u8], path: &Path, max_texels: u64) -> Result<(Texture, ImageFormat), FileError> {
    if bytes.is_empty() {
        return Err(FileError::new(path, "is empty"));
    }
    let guessed = image::guess_format(bytes).or_else(|_| ImageFormat::from_path(path));
    let format = guessed
        .ok()
        .filter(|format| READABLE.contains(format))
        .ok_or_else(|| FileError::new(path, "is no image that can be read here (PNG, BMP, TGA, JPEG)"))?;
    let failure = |error| FileError::new(path, error);
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    reader.limits(limits());
    let mut decoder = reader.into_decoder().map_err(failure)?;
    check_size(decoder.dimensions(), bytes.len() as u64, max_texels)
        .map_err(|cause| FileError::new(path, cause))?;
    let orientation = decoder.orientation().unwrap_or(Orientation::NoTransforms);
    let mut image = DynamicImage::from_decoder(decoder).map_err(failure)?;
    image.apply_orientation(orientation);
    if format == ImageFormat::Tga {
        image = as_tga_says(image, bytes.get(17).copied().unwrap_or(0));
    }
    Ok((texture_of(&image), format))
}

const READABLE: [ImageFormat; 5] =
    [ImageFormat::Png, ImageFormat::Bmp, ImageFormat::Tga, ImageFormat::Jpeg, ImageFormat::Pnm];

fn limits() -> Limits {
    let mut limits = Limits::default();
    limits.max_image_width = Some(Framebuffer::MAX_SIDE);
    limits.max_image_height = Some(Framebuffer::MAX_SIDE);
    // Four channels of 16 bits.
    limits.max_alloc = Some(8 * MAX_TEXELS);
    limits
}

/// Judges the size that a header claims, before there is memory for it.
fn check_size((width, height): (u32, u32), bytes: u64, max_texels: u64) -> Result<(), String> {
    let pixels = u64::from(width) * u64::from(height);
    if pixels == 0 {
        return Err("has no pixels".to_owned());
    }
    let side = Framebuffer::MAX_SIDE;
    if width > side || height > side {
        return Err(format!(
            "exceeds limits: {width}×{height} pixels, but no side may have more than {side}"
        ));
    }
    if pixels > max_texels {
        let limit = if max_texels == MAX_TEXELS {
            format!("{MAX_TEXELS} are allowed")
        } else {
            format!("all textures of a model may have {MAX_TEXELS}, of which {max_texels} are left")
        };
        return Err(format!("exceeds limits: {width}×{height} are {pixels} pixels; {limit}"));
    }
    if pixels > bytes.saturating_mul(MAX_PIXELS_A_BYTE) {
        return Err(format!("claims {width}×{height} pixels, which cannot be in {bytes} bytes"));
    }
    Ok(())
}

/// What the descriptor of a TGA file says and the decoder (`image` 0.25.6) does not do: bit 4, the first pixel of a row is
/// the right one; bits 0 to 3, how many bits of a pixel are its alpha.
fn as_tga_says(image: DynamicImage, descriptor: u8) -> DynamicImage {
    let image = if descriptor & 0x10 == 0 { image } else { image.fliph() };
    if descriptor & 0x0f == 0 { image.into_rgb8().into() } else { image }
}

/// An image, whose first row is on top, as a texture, whose first row is at the bottom. What is transparent shows white
/// beneath it: the color of the material then tints it, so that the surface has that color there.
fn texture_of(image: &DynamicImage) -> Texture {
    let (width, height) = (image.width(), image.height());
    let texels = if image.color().has_alpha() {
        let pixels = image.to_rgba8();
        pixels
            .rows()
            .rev()
            .flatten()
            .map(|&Rgba([r, g, b, a])| Color::rgb(over_white(r, a), over_white(g, a), over_white(b, a)))
            .collect()
    } else {
        let pixels = image.to_rgb8();
        pixels.rows().rev().flatten().map(|&Rgb([r, g, b])| Color::rgb(r, g, b)).collect()
    };
    Texture::new(width, height, texels)
}

/// A channel over white, by its alpha, rounded to nearest.
fn over_white(channel: u8, alpha: u8) -> u8 {
    let [channel, alpha] = [channel, alpha].map(u32::from);
    ((channel * alpha + 255 * (255 - alpha) + 127) / 255) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lowest_row_of_an_image_file_is_the_first_of_a_texture() {
        // Red above green.
        let image =
            image::RgbImage::from_fn(1, 2, |_, row| Rgb(if row == 0 { [255, 0, 0] } else { [0, 255, 0] }));
        let mut bytes = Cursor::new(Vec::new());
        image.write_to(&mut bytes, ImageFormat::Png).expect("two pixels");
        let (texture, _) = decode_texture(bytes.get_ref(), "a.png".as_ref()).expect("a picture");
        let at = |v: f64| Color::truncated(texture.nearest([0.5, v], crate::texture::AddressMode::Clamp));
        assert_eq!((at(0.25), at(0.75)), (Color::GREEN, Color::RED), "v points up");
    }
}
