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

mod decode;
#[cfg(feature = "jpeg")]
mod jpeg;
mod orientation;

use std::error::Error;
use std::fmt;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use image::ImageFormat;

use self::decode::decode_within;
use crate::texture::Texture;

/// The largest file that is read: 256 MiB.
pub const MAX_FILE_BYTES: u64 = 1 << 28;

/// The most pixels that an image may have, and all textures of a model together: 8192×8192.
pub const MAX_TEXELS: u64 = 1 << 26;

/// Why a file cannot be used.
#[derive(Clone, Debug)]
pub struct FileError {
    path: PathBuf,
    cause: String,
    source: Option<Arc<dyn Error + Send + Sync>>,
}

impl FileError {
    pub(crate) fn new(path: &Path, cause: impl fmt::Display) -> Self {
        Self { path: path.to_owned(), cause: cause.to_string(), source: None }
    }

    /// The cause is an error of another layer, which is kept.
    pub(crate) fn from_source(path: &Path, source: impl Error + Send + Sync + 'static) -> Self {
        Self { path: path.to_owned(), cause: source.to_string(), source: Some(Arc::new(source)) }
    }
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&shown(&format!("{}: {}", self.path.display(), self.cause)))
    }
}

impl Error for FileError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        self.source.as_deref().map(|source| source as &(dyn Error + 'static))
    }
}

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
    read_file_within(path, MAX_FILE_BYTES)
}

/// As [`read_file`], with no more than `limit` bytes.
pub(crate) fn read_file_within(path: &Path, limit: u64) -> Result<Vec<u8>, FileError> {
    let failure = |error| FileError::from_source(path, error);
    let metadata = std::fs::metadata(path).map_err(failure)?;
    if !metadata.is_file() {
        let what = if metadata.is_dir() { "is a folder" } else { "is no regular file: a pipe or a device" };
        return Err(FileError::new(path, what));
    }
    let too_large = |size| {
        let most = format!("files of up to {MAX_FILE_BYTES} ({} MiB) are read", MAX_FILE_BYTES >> 20);
        let left = if limit < MAX_FILE_BYTES { format!(", and {limit} are left") } else { String::new() };
        FileError::new(path, format!("has {size} bytes; {most}{left}"))
    };
    if metadata.len() > limit {
        return Err(too_large(metadata.len().to_string()));
    }
    let mut bytes = Vec::with_capacity(metadata.len() as usize);
    // It may grow while it is read.
    File::open(path).and_then(|file| file.take(limit + 1).read_to_end(&mut bytes)).map_err(failure)?;
    if bytes.len() as u64 > limit {
        return Err(too_large(format!("more than {limit}")));
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
