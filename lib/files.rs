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

use std::error::Error;
use std::fmt;
use std::io::Cursor;
use std::path::{Path, PathBuf};

use image::{DynamicImage, ImageFormat, ImageReader, Limits};

use crate::color::Color;
use crate::framebuffer::Framebuffer;
use crate::texture::Texture;

/// Why a file cannot be used.
#[derive(Debug)]
pub struct FileError {
    path: PathBuf,
    cause: String,
    source: Option<Box<dyn Error + Send + Sync>>,
}

impl FileError {
    pub(crate) fn new(path: &Path, cause: impl fmt::Display) -> Self {
        Self { path: path.to_owned(), cause: cause.to_string(), source: None }
    }

    /// The cause is an error of another layer, which is kept.
    pub(crate) fn from_source(path: &Path, source: impl Error + Send + Sync + 'static) -> Self {
        Self { path: path.to_owned(), cause: source.to_string(), source: Some(Box::new(source)) }
    }
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.path.display(), self.cause)
    }
}

impl Error for FileError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        self.source.as_deref().map(|source| source as &(dyn Error + 'static))
    }
}

/// What is odd about a file that can be used all the same.
pub type Warnings = Vec<String>;

/// The bytes of a file: not of a folder, nor of a device that never ends.
pub(crate) fn read_file(path: &Path) -> Result<Vec<u8>, FileError> {
    let failure = |error| FileError::from_source(path, error);
    let metadata = std::fs::metadata(path).map_err(failure)?;
    if !metadata.is_file() {
        return Err(FileError::new(path, "is no file"));
    }
    std::fs::read(path).map_err(failure)
}

/// Reads a texture from an image file (PNG, BMP, TGA, JPEG); what a file is says its content, not its name.
///
/// # Errors
/// If the file cannot be read or is no such image, or if it is larger than 16384×16384 pixels or 1 GiB in memory.
pub fn load_texture(path: &Path) -> Result<(Texture, Warnings), FileError> {
    let bytes = read_file(path)?;
    let (texture, format) = decode_texture(&bytes, path)?;
    let mut warnings = Warnings::new();
    if let Ok(named) = ImageFormat::from_path(path)
        && named != format
    {
        warnings.push(format!("{}: is a {format:?} file, whatever its name says", path.display()));
    }
    Ok((texture, warnings))
}

/// Decodes an image file; `path` names it in errors, and its extension tells a TGA file, which has no mark inside.
///
/// # Errors
/// As [`load_texture`].
pub fn decode_texture(bytes: &[u8], path: &Path) -> Result<(Texture, ImageFormat), FileError> {
    if bytes.is_empty() {
        return Err(FileError::new(path, "is empty"));
    }
    let guessed = image::guess_format(bytes).or_else(|_| ImageFormat::from_path(path));
    let format = guessed
        .map_err(|_| FileError::new(path, "is no image that can be read here (PNG, BMP, TGA, JPEG)"))?;
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    let mut limits = Limits::default();
    limits.max_image_width = Some(Framebuffer::MAX_SIDE);
    limits.max_image_height = Some(Framebuffer::MAX_SIDE);
    limits.max_alloc = Some(1 << 30);
    reader.limits(limits);
    let image = reader.decode().map_err(|error| FileError::from_source(path, error))?;
    if image.width() == 0 || image.height() == 0 {
        return Err(FileError::new(path, "has no pixels"));
    }
    Ok((texture_of(image), format))
}

/// An image, whose first row is on top, as a texture, whose first row is at the bottom.
fn texture_of(image: DynamicImage) -> Texture {
    let pixels = image.into_rgb8();
    let texels =
        pixels.rows().rev().flatten().map(|pixel| Color::rgb(pixel[0], pixel[1], pixel[2])).collect();
    Texture::new(pixels.width(), pixels.height(), texels)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lowest_row_of_an_image_file_is_the_first_of_a_texture() {
        // Red above green.
        let image = image::RgbImage::from_fn(1, 2, |_, row| {
            image::Rgb(if row == 0 { [255, 0, 0] } else { [0, 255, 0] })
        });
        let mut bytes = Cursor::new(Vec::new());
        image.write_to(&mut bytes, ImageFormat::Png).expect("two pixels");
        let (texture, _) = decode_texture(bytes.get_ref(), "a.png".as_ref()).expect("a picture");
        let at = |v: f64| Color::truncated(texture.nearest([0.5, v], crate::texture::AddressMode::Clamp));
        assert_eq!((at(0.25), at(0.75)), (Color::GREEN, Color::RED), "v points up");
    }
}
