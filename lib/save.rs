//! Pictures into image files: the last step, after the framebuffer.
//!
//! ```no_run
//! use rasterbook::{Color, Framebuffer};
//!
//! let mut framebuffer = Framebuffer::new(64, 48);
//! framebuffer.set(10, 20, Color::RED);
//! framebuffer.save("dot.png")?;
//! # Ok::<(), rasterbook::files::FileError>(())
//! ```

use std::fs::{self, OpenOptions};
use std::hash::{BuildHasher, RandomState};
use std::io::{Cursor, ErrorKind, Write};
use std::path::Path;

use image::{ImageError, ImageFormat, RgbImage};

use crate::files::{FileError, not_a_file};
use crate::framebuffer::Framebuffer;

/// The formats that pictures can be written in.
const WRITABLE: [ImageFormat; 4] = [ImageFormat::Png, ImageFormat::Bmp, ImageFormat::Tga, ImageFormat::Pnm];

impl Framebuffer {
    /// Writes the picture into a file, whole or not at all; its extension names the format: `.png`, `.bmp`, `.tga` or
    /// `.ppm`.
    ///
    /// # Errors
    /// If the extension names no such format, or the file cannot be written.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), FileError> {
        let path = path.as_ref();
        let format = ImageFormat::from_path(path).ok().filter(|format| WRITABLE.contains(format));
        let format = format
            .ok_or_else(|| FileError::new(path, "names no format that is written: .png .bmp .tga .ppm"))?;
        let bytes = encode(self, format).map_err(|error| FileError::from_source(path, error))?;
        replace(path, &bytes)
    }
}

/// A picture as the bytes of an image file.
pub(crate) fn encode(picture: &Framebuffer, format: ImageFormat) -> Result<Vec<u8>, ImageError> {
    let mut bytes = Vec::new();
    if format == ImageFormat::Pnm {
        picture.write_ppm(&mut bytes)?;
        return Ok(bytes);
    }
    let image = RgbImage::from_raw(picture.width(), picture.height(), picture.rgb_from_top());
    image.unwrap_or_default().write_to(&mut Cursor::new(&mut bytes), format)?;
    Ok(bytes)
}

/// Writes a whole file or nothing: under another name first, which then takes the place of the old file.
///
/// Nobody foresees that name, and a file or a link that has it is left alone, as with the crate `tempfile`; that one and
/// the six that it brings would take a tenth of the first build. Neither catches a signal that ends the program; all bytes
/// are there before the file is made, so only one within these milliseconds leaves it behind.
pub(crate) fn replace(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    fs::create_dir_all(folder).map_err(|error| match error.kind() {
        ErrorKind::AlreadyExists => FileError::new(folder, "is no folder"),
        _ => FileError::from_source(folder, error),
    })?;
    // What is in the place of a pipe or a device would be a file, and who reads from it would wait for ever.
    if let Some(what) = fs::metadata(path).ok().as_ref().and_then(not_a_file) {
        return Err(FileError::new(path, what));
    }
    // The state of a hash table is random.
    let part = folder.join(format!(".rasterbook.{:016x}.part", RandomState::new().hash_one(path)));
    let failure = |error| FileError::from_source(path, error);
    let mut file = OpenOptions::new().write(true).create_new(true).open(&part).map_err(failure)?;
    let written = file.write_all(bytes);
    drop(file);
    written.and_then(|()| fs::rename(&part, path)).map_err(|error| {
        let _ = fs::remove_file(&part);
        failure(error)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::scratch::Folder;

    #[test]
    fn every_format_holds_the_picture() {
        let mut picture = Framebuffer::new(3, 2);
        picture.set(2, 1, crate::Color::rgb(10, 20, 30));
        for format in WRITABLE {
            let bytes = encode(&picture, format).expect("a small picture");
            let read = image::load_from_memory_with_format(&bytes, format).expect("just written").to_rgb8();
            assert_eq!(read.dimensions(), (3, 2));
            assert_eq!(read.get_pixel(2, 0).0, [10, 20, 30], "{format:?}");
        }
    }

    #[test]
    fn a_picture_replaces_the_file_before_and_nothing_else_is_left() {
        let top = Folder::new("save", &[]);
        let (folder, mut picture) = (top.0.join("new"), Framebuffer::new(3, 2));
        let path = folder.join("picture.png");
        for color in [crate::Color::RED, crate::Color::GREEN] {
            picture.clear(color);
            picture.save(&path).expect("a place for temporary files");
            let read = image::open(&path).expect("just written").to_rgb8();
            assert_eq!((read.dimensions(), read.get_pixel(0, 0).0), ((3, 2), color.channels()));
        }
        assert_eq!(fs::read_dir(&folder).expect("made").count(), 1);
    }

    #[test]
    fn what_is_in_the_way_is_named() {
        let top = Folder::new("way", &[("file", b"precious")]);
        let refused = |place: &str| {
            let path = top.0.join(place);
            Framebuffer::new(1, 1).save(path).expect_err("something is in the way").to_string()
        };
        assert!(refused("file/a.png").ends_with("file: is no folder"));
        fs::create_dir(top.0.join("b.png")).expect("a place for temporary files");
        assert!(refused("b.png").ends_with("b.png: is a folder"));
        assert_eq!(fs::read(top.0.join("file")).expect("still there"), b"precious");
        assert_eq!(fs::read_dir(&top.0).expect("made").count(), 2, "nothing else is left");
    }

    #[test]
    fn unknown_formats_are_refused() {
        let error = Framebuffer::new(1, 1).save("picture.doc").expect_err("no picture format");
        assert_eq!(error.to_string(), "picture.doc: names no format that is written: .png .bmp .tga .ppm");
    }
}
