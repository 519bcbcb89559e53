//! Where pictures go: file names, formats, and writing without ever leaving half a file behind.

use std::error::Error;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

use image::ImageFormat;

use super::failure::Failure;
use crate::framebuffer::Framebuffer;
use crate::save::{encode, replace};

/// Image formats that are often asked for and not written here.
const UNSUPPORTED: [&str; 7] = ["jpg", "jpeg", "webp", "tif", "tiff", "svg", "pdf"];

/// Where the pictures of one run go.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Destination {
    /// A single picture, in the format that its extension names.
    File(PathBuf),
    /// Any number of pictures, as PNG files named for their variants.
    Folder(PathBuf),
}

impl Destination {
    /// `--out PATH`: a file if it ends in a known image extension, else a folder.
    pub(super) fn new(path: PathBuf) -> Result<Self, Failure> {
        match extension(&path).as_deref() {
            Some("png" | "bmp" | "tga" | "ppm" | "gif") => Ok(Self::File(path)),
            Some(other) if UNSUPPORTED.contains(&other) => Err(Failure::Usage(format!(
                "cannot write {}: the formats are .png .bmp .tga .ppm, of animations .gif .png",
                path.display()
            ))),
            _ => Ok(Self::Folder(path)),
        }
    }

    /// Where the picture called `name` goes.
    fn path(&self, name: &str, extension: &str) -> PathBuf {
        match self {
            Self::File(path) => path.clone(),
            Self::Folder(folder) => folder.join(format!("{name}.{extension}")),
        }
    }

    /// Writes the picture called `name`, and says where.
    pub(super) fn write(&self, name: &str, picture: &Framebuffer) -> Result<PathBuf, Failure> {
        let path = self.path(name, "png");
        if extension(&path).as_deref() == Some("gif") {
            return Err(Failure::Usage(format!("{} is for an animation: give --animate", path.display())));
        }
        let format = ImageFormat::from_path(&path).unwrap_or(ImageFormat::Png);
        let bytes = encode(picture, format).map_err(|error| cannot_write(&path, &error))?;
        replace_file(&path, &bytes)?;
        Ok(path)
    }

    /// Writes the animation called `name`, as `encode` makes it for the format, and says where.
    pub(super) fn write_animation(
        &self,
        name: &str,
        encode: impl FnOnce(AnimationFormat) -> Result<Vec<u8>, Box<dyn Error>>,
    ) -> Result<PathBuf, Failure> {
        let path = self.path(name, "gif");
        let format = match extension(&path).as_deref() {
            Some("gif") => AnimationFormat::Gif,
            Some("png") => AnimationFormat::Png,
            _ => {
                return Err(Failure::Usage(format!(
                    "{}: an animation is a .gif or a .png file",
                    path.display()
                )));
            }
        };
        let bytes = encode(format).map_err(|error| cannot_write(&path, error.as_ref()))?;
        replace_file(&path, &bytes)?;
        Ok(path)
    }
}

/// What an animation can be written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum AnimationFormat {
    /// At most 256 colors a frame.
    Gif,
    /// Animated PNG: every color as it is.
    Png,
}

/// The extension of a path, in lower case.
fn extension(path: &Path) -> Option<String> {
    path.extension().and_then(|extension| extension.to_str()).map(str::to_ascii_lowercase)
}

fn replace_file(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    replace(path, bytes).map_err(|error| Failure::Runtime(format!("cannot write {error}")))
}

fn cannot_write(path: &Path, error: &dyn Error) -> Failure {
    Failure::Runtime(format!("cannot write {}: {error}", path.display()))
}

/// A line on standard output.
pub(super) fn say(line: &str) -> Result<(), Failure> {
    let mut stdout = std::io::stdout().lock();
    let said = stdout
        .write_all(line.as_bytes())
        .and_then(|()| stdout.write_all(b"\n"))
        .and_then(|()| stdout.flush());
    said.map_err(|error| match error.kind() {
        ErrorKind::BrokenPipe => Failure::ClosedPipe,
        _ => Failure::Runtime(format!("cannot write to standard output: {error}")),
    })
}

/// A line on standard error; a failure is not reported.
pub(super) fn note(line: &str) {
    let _ = writeln!(std::io::stderr(), "{line}");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_and_folders() {
        let of = |path: &str| Destination::new(PathBuf::from(path));
        assert_eq!(of("a/b.png"), Ok(Destination::File("a/b.png".into())));
        assert_eq!(of("b.TGA"), Ok(Destination::File("b.TGA".into())));
        assert_eq!(of("pictures"), Ok(Destination::Folder("pictures".into())));
        assert_eq!(of("v1.2"), Ok(Destination::Folder("v1.2".into())));
        assert!(matches!(of("a.jpg"), Err(Failure::Usage(_))));
    }
}
