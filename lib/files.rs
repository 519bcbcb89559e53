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
mod guard;
#[cfg(feature = "jpeg")]
mod jpeg;
mod orientation;

use std::error::Error;
use std::fmt;
use std::fs::{File, Metadata};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use image::ImageFormat;

use self::decode::decode_within;
pub use self::guard::silence_decoders;
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
        write!(f, "{}: {}", shown_path(&self.path), shown(&self.cause))
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

/// A path as a terminal may show it. Bytes that are no text are escaped, so that the name can be recognized. Of what is too
/// long to be a path the beginning is shown: a model can name a texture by any number of bytes.
pub(crate) fn shown_path(path: &Path) -> String {
    const MOST: usize = 4096;
    let bytes = path.as_os_str().as_encoded_bytes();
    let mut safe = String::new();
    for chunk in bytes[..bytes.len().min(MOST)].utf8_chunks() {
        safe += &shown(chunk.valid());
        safe.extend(chunk.invalid().iter().map(|byte| format!("\\x{byte:02x}")));
    }
    if bytes.len() > MOST {
        safe.push('…');
    }
    safe
}

/// What something is that is no regular file, and so is neither read nor replaced.
pub(crate) fn not_a_file(metadata: &Metadata) -> Option<&'static str> {
    let what = if metadata.is_dir() { "is a folder" } else { "is no regular file: a pipe or a device" };
    (!metadata.is_file()).then_some(what)
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
    if let Some(what) = not_a_file(&metadata) {
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
    if metadata.len() == 0 {
        // Some files of a system have no size: what is in them is made while it is read, and may have no end.
        return Ok(Vec::new());
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
/// If the file cannot be read or is no such image, or if it is larger than [`MAX_FILE_BYTES`] or [`MAX_TEXELS`]; also if a
/// decoder panics at it, unless panics end the program.
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
        warnings.push(format!("{}: is a {format:?} file, whatever its name says", shown_path(path)));
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

/// Files that tests of this room and of the rooms below write.
#[cfg(test)]
pub(crate) mod scratch {
    use std::fs;
    use std::hash::{BuildHasher, RandomState};
    use std::path::PathBuf;

    /// A folder of files for one test, which removes it, also when it fails.
    pub(crate) struct Folder(pub(crate) PathBuf);

    impl Folder {
        pub(crate) fn new(name: &str, files: &[(&str, &[u8])]) -> Self {
            // WASI has no temporary folder and no process ID. The state of a hash table is random.
            let top = if cfg!(target_family = "wasm") { "/tmp".into() } else { std::env::temp_dir() };
            let folder = top.join(format!("rasterbook.{:016x}.{name}", RandomState::new().hash_one(name)));
            for (name, content) in files {
                let path = folder.join(name);
                fs::create_dir_all(path.parent().unwrap_or(&folder)).expect("a place for temporary files");
                fs::write(path, content).expect("a place for temporary files");
            }
            Self(folder)
        }
    }

    impl Drop for Folder {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::scratch::Folder;
    use super::*;

    #[test]
    fn a_file_is_read_up_to_a_limit() {
        let folder = Folder::new("limit", &[("a.txt", b"12345")]);
        let path = folder.0.join("a.txt");
        assert_eq!(read_file(&path).expect("a small file"), b"12345");
        assert_eq!(read_file_within(&path, 5).expect("as large as it may be"), b"12345");
        let refused = |limit| read_file_within(&path, limit).expect_err("too large").to_string();
        let most = "files of up to 268435456 (256 MiB) are read";
        assert!(refused(4).ends_with(&format!("has 5 bytes; {most}, and 4 are left")), "{}", refused(4));
        // A file with a hole, which takes no place on the disk.
        let file = File::options().write(true).open(&path).expect("just written");
        file.set_len(MAX_FILE_BYTES + 1).expect("a hole");
        let told = refused(MAX_FILE_BYTES);
        assert!(told.ends_with(&format!("has 268435457 bytes; {most}")), "{told}");
        file.set_len(0).expect("empty");
        assert_eq!(read_file(&path).expect("an empty file"), b"");
    }

    #[test]
    fn what_is_no_file_is_named() {
        let folder = Folder::new("folder", &[("a.txt", b"12345")]);
        let refused = read_file(&folder.0).expect_err("a folder");
        assert!(refused.to_string().ends_with(": is a folder"), "{refused}");
        assert!(refused.source().is_none(), "found out here");
        let missing = read_file("nowhere/a.obj".as_ref()).expect_err("not there");
        assert!(missing.to_string().starts_with("nowhere/a.obj: "), "{missing}");
        let cause = missing.source().and_then(|cause| cause.downcast_ref::<std::io::Error>());
        assert_eq!(cause.map(std::io::Error::kind), Some(std::io::ErrorKind::NotFound));
    }

    #[test]
    fn nothing_commands_the_terminal() {
        assert_eq!(shown("café\u{1b}[31m\n"), "café\\u{1b}[31m\\n");
        assert_eq!(shown("a\u{202e}b\u{2066}c\u{200f}"), "a\\u{202e}b\\u{2066}c\\u{200f}");
    }

    #[test]
    #[cfg(unix)]
    fn a_path_that_is_no_text_can_be_recognized() {
        use std::os::unix::ffi::OsStrExt;
        let path = Path::new(std::ffi::OsStr::from_bytes(b"a/caf\xe9\n.obj"));
        assert_eq!(shown_path(path), "a/caf\\xe9\\n.obj");
    }

    #[test]
    fn of_what_is_too_long_for_a_path_the_beginning_is_shown() {
        let shown = |length: usize| shown_path("x".repeat(length).as_ref());
        assert_eq!([4096, 4097].map(shown), ["x".repeat(4096), "x".repeat(4096) + "…"]);
    }

    #[test]
    fn the_content_says_what_an_image_is() {
        let mut png = std::io::Cursor::new(Vec::new());
        image::RgbImage::new(2, 1).write_to(&mut png, ImageFormat::Png).expect("two pixels");
        for (name, wrong) in [("a.png", false), ("a.bmp", true), ("a.thing", false)] {
            let folder = Folder::new("content", &[(name, png.get_ref())]);
            let path = folder.0.join(name);
            let (texture, warnings) = load_texture(&path).expect("an image");
            assert_eq!((texture.width(), texture.height()), (2, 1));
            let told = wrong.then(|| format!("{}: is a Png file, whatever its name says", path.display()));
            assert_eq!(warnings, Vec::from_iter(told));
        }
        let (texture, format) = decode_texture(png.get_ref(), "a.bmp".as_ref()).expect("an image");
        assert_eq!((texture.width(), format), (2, ImageFormat::Png));
    }
}
