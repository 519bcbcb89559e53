//! Where pictures go: file names, formats, and writing without ever leaving half a file behind.

use std::error::Error;
use std::io::{ErrorKind, IsTerminal, Write};
use std::path::{Path, PathBuf};

use image::ImageFormat;

use super::failure::Failure;
use super::show::Screen;
use crate::files::{shown, shown_path};
use crate::framebuffer::Framebuffer;
use crate::save::{encode, replace};

/// Where the pictures of one run go.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Destination {
    /// A single picture, in the format that its extension names.
    File(PathBuf),
    /// Any number of pictures, as PNG files named for their variants.
    Folder(PathBuf),
    /// A single picture, as a PNG file on standard output.
    Output,
    /// A single picture, shown on standard output.
    Screen(Screen),
}

impl Destination {
    /// `--out PATH`: `-` is standard output; a folder is what exists as one, ends in `/`, or has no extension; else the
    /// extension must be that of a picture.
    pub(super) fn new(path: PathBuf) -> Result<Self, Failure> {
        let ends_as_folder = path.as_os_str().to_string_lossy().ends_with(std::path::is_separator);
        if path.as_os_str() == "-" {
            return Ok(Self::Output);
        }
        match extension(&path).as_deref() {
            _ if ends_as_folder || path.is_dir() => Ok(Self::Folder(path)),
            None => Ok(Self::Folder(path)),
            Some("png" | "bmp" | "tga" | "ppm" | "gif") => Ok(Self::File(path)),
            Some(other) => Err(Failure::Usage(format!(
                "cannot write {}: '.{other}' is no picture format that is written; these are .png .bmp .tga .ppm, of \
                 animations .gif .png (a folder ends in /)",
                shown_path(&path)
            ))),
        }
    }

    /// Whether only one picture can go there.
    pub(super) const fn is_single(&self) -> bool {
        matches!(self, Self::File(_) | Self::Output | Self::Screen(_))
    }

    /// Where the picture called `name` goes; `None` for standard output.
    fn path(&self, name: &str, extension: &str) -> Option<PathBuf> {
        match self {
            Self::File(path) => Some(path.clone()),
            Self::Folder(folder) => Some(folder.join(format!("{name}.{extension}"))),
            Self::Output | Self::Screen(_) => None,
        }
    }

    /// Writes the picture called `name`, and prints where it is.
    pub(super) fn write(&self, name: &str, picture: &Framebuffer) -> Result<(), Failure> {
        let Some(path) = self.path(name, "png") else {
            return self.put(name, picture);
        };
        if extension(&path).as_deref() == Some("gif") {
            return Err(Failure::Usage(format!("{} is for an animation: give --animate", shown_path(&path))));
        }
        let format = ImageFormat::from_path(&path).unwrap_or(ImageFormat::Png);
        let bytes = encode(picture, format).map_err(|error| cannot_write(&path, &error))?;
        replace_file(&path, &bytes)
    }

    /// Writes the picture called `name` to standard output.
    fn put(&self, name: &str, picture: &Framebuffer) -> Result<(), Failure> {
        let cannot = |error| Failure::Runtime(format!("cannot write to standard output: {error}"));
        let Self::Screen(screen) = self else {
            return put(&encode(picture, ImageFormat::Png).map_err(cannot)?);
        };
        put(&screen.rendered(picture).map_err(cannot)?)?;
        note(&format!("{name}: {}×{}", picture.width(), picture.height()));
        if let Some(line) = screen.note() {
            note(line);
        }
        Ok(())
    }

    /// Writes the animation called `name`, as `encode` makes it for the format, and prints where it is.
    pub(super) fn write_animation(
        &self,
        name: &str,
        encode: impl FnOnce(AnimationFormat) -> Result<Vec<u8>, Box<dyn Error>>,
    ) -> Result<(), Failure> {
        let path = self.path(name, "gif").unwrap_or_else(|| PathBuf::from("-"));
        let format = match extension(&path).as_deref() {
            Some("gif") => AnimationFormat::Gif,
            Some("png") => AnimationFormat::Png,
            _ => {
                return Err(Failure::Usage(format!(
                    "{}: an animation is a .gif or a .png file",
                    shown_path(&path)
                )));
            }
        };
        let bytes = encode(format).map_err(|error| cannot_write(&path, error.as_ref()))?;
        replace_file(&path, &bytes)
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
    path.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase())
}

/// Writes a whole file or nothing, and prints its path.
fn replace_file(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    replace(path, bytes).map_err(|error| Failure::Runtime(format!("cannot write {error}")))?;
    say_path(path)
}

fn cannot_write(path: &Path, error: &dyn Error) -> Failure {
    Failure::Runtime(format!("cannot write {}: {error}", shown_path(path)))
}

/// A line on standard output.
pub(super) fn say(line: &str) -> Result<(), Failure> {
    put(format!("{line}\n").as_bytes())
}

/// The path of a file, a line on standard output: for people as a terminal may show it, for programs as it is.
fn say_path(path: &Path) -> Result<(), Failure> {
    if std::io::stdout().is_terminal() {
        return say(&shown_path(path));
    }
    put(&[path.as_os_str().as_encoded_bytes(), b"\n"].concat())
}

/// Bytes on standard output.
fn put(bytes: &[u8]) -> Result<(), Failure> {
    let mut stdout = std::io::stdout().lock();
    stdout.write_all(bytes).and_then(|()| stdout.flush()).map_err(|error| match error.kind() {
        ErrorKind::BrokenPipe => Failure::ClosedPipe,
        _ => Failure::Runtime(format!("cannot write to standard output: {error}")),
    })
}

/// Lines on standard error; a failure is not reported. All that is said there comes through here, and may quote names and
/// arguments: nothing of them commands the terminal.
pub(super) fn note(lines: &str) {
    let lines: String = lines.split('\n').flat_map(|line| [shown(line), "\n".to_owned()]).collect();
    let _ = std::io::stderr().write_all(lines.as_bytes());
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
        assert_eq!(of("v1.2/"), Ok(Destination::Folder("v1.2/".into())));
        assert_eq!(of("src/.."), Ok(Destination::Folder("src/..".into())));
        assert_eq!(of("-"), Ok(Destination::Output));
        assert!(matches!(of("v1.2"), Err(Failure::Usage(_))));
        assert!(matches!(of("a.jpg"), Err(Failure::Usage(_))));
    }
}
