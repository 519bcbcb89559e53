//! Compares pictures by their decoded pixels, exactly. The one file that uses `insta::internals`.

use std::fmt::Write as _;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

use image::RgbImage;
use insta::internals::SnapshotContents;
use insta::{Comparator, Settings, Snapshot};
use rasterbook::figure::picture;
use rasterbook::{Color, Framebuffer};

/// How many differing pixels a report names.
const NAMED: usize = 5;

/// Where the pictures of failed comparisons go: `target/tmp/snapshots`.
pub(crate) fn failure_folder() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("snapshots")
}

/// Where the accepted pictures are.
pub(crate) fn snapshot_folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/snapshots")
}

/// Compares a PNG file with the accepted picture of that name.
///
/// The error says what differs. Then expected | difference | actual is at [`failure_folder`], where a picture that
/// is accepted again takes it away.
pub(crate) fn assert_picture(name: &str, png: Vec<u8>) -> Result<(), String> {
    forget(name);
    let comparator = Pixels { name: name.to_owned(), report: Arc::default() };
    let report = Arc::clone(&comparator.report);

    let mut settings = Settings::clone_current();
    settings.set_prepend_module_to_snapshot(false);
    settings.set_snapshot_path(snapshot_folder());
    settings.set_omit_expression(true);
    settings.set_comparator(Box::new(comparator));
    let file = format!("{name}.png");
    let actual = png.clone();
    let asserted =
        catch_unwind(AssertUnwindSafe(|| settings.bind(|| insta::assert_binary_snapshot!(&file, png))));
    if asserted.is_ok() {
        // With INSTA_UPDATE=always a picture that differs is accepted.
        forget(name);
        return Ok(());
    }
    let report = report.lock().expect("no other thread").take();
    Err(report.unwrap_or_else(|| {
        save(name, "actual", &actual);
        format!("{name}: there is no accepted picture yet.\n{HINT}")
    }))
}

/// Takes the pictures of an earlier failure away.
fn forget(name: &str) {
    for kind in ["expected", "actual", "report"] {
        let _ = std::fs::remove_file(failure_folder().join(format!("{name}.{kind}.png")));
    }
}

const HINT: &str = "Look at the pictures in target/tmp/snapshots (review.html shows all of them).\n\
    If the new picture is right: INSTA_UPDATE=always cargo test --test snapshots, then look at git diff.";

/// Equal if and only if all pixels are equal: PNG bytes change with the encoder, pixels must not.
struct Pixels {
    name: String,
    report: Arc<Mutex<Option<String>>>,
}

impl Comparator for Pixels {
    fn matches(&self, reference: &Snapshot, test: &Snapshot) -> bool {
        let (expected, actual) = (decode(reference), decode(test));
        let report = match (&expected, &actual) {
            (Ok(expected), Ok(actual)) if expected == actual => return true,
            (Ok(expected), Ok(actual)) => difference(&self.name, expected, actual),
            (Err(reason), _) => format!("the accepted picture cannot be read: {reason}"),
            (_, Err(reason)) => format!("the new picture cannot be read: {reason}"),
        };
        for (kind, snapshot) in [("expected", reference), ("actual", test)] {
            if let SnapshotContents::Binary(Some(bytes)) = snapshot.contents() {
                save(&self.name, kind, bytes);
            }
        }
        *self.report.lock().expect("no other thread") = Some(format!("{}: {report}\n{HINT}", self.name));
        false
    }

    fn dyn_clone(&self) -> Box<dyn Comparator> {
        Box::new(Self { name: self.name.clone(), report: Arc::clone(&self.report) })
    }
}

/// The pixels of a snapshot.
fn decode(snapshot: &Snapshot) -> Result<RgbImage, String> {
    let bytes = match snapshot.contents() {
        SnapshotContents::Binary(Some(bytes)) => bytes,
        SnapshotContents::Binary(None) => return Err("its .snap.png file is missing".to_owned()),
        SnapshotContents::Text(_) => return Err("it is a text snapshot".to_owned()),
    };
    if bytes.starts_with(b"version https://git-lfs") {
        return Err("it is a pointer of Git LFS, not a picture: run git lfs pull".to_owned());
    }
    let image = image::load_from_memory_with_format(bytes, image::ImageFormat::Png);
    image.map(|image| image.to_rgb8()).map_err(|error| error.to_string())
}

/// Says how two pictures differ, in framebuffer coordinates (y up), and draws expected | difference | actual.
fn difference(name: &str, expected: &RgbImage, actual: &RgbImage) -> String {
    if expected.dimensions() != actual.dimensions() {
        return format!("the size was {:?} and is {:?}", expected.dimensions(), actual.dimensions());
    }
    let (width, height) = expected.dimensions();
    let differing: Vec<(u32, u32)> = (0..height)
        .rev()
        .flat_map(|row| (0..width).map(move |column| (column, row)))
        .filter(|&(column, row)| expected.get_pixel(column, row) != actual.get_pixel(column, row))
        .collect();

    let mut report =
        format!("{} of {} pixels differ, first (y up from the bottom):", differing.len(), width * height);
    for &(column, row) in differing.iter().take(NAMED) {
        let [was, is] = [expected, actual].map(|image| image.get_pixel(column, row).0);
        let _ = write!(report, "\n  ({column}, {}) was {was:?}, is {is:?}", height - 1 - row);
    }

    if let Some(panels) = panels(expected, actual) {
        save(name, "report", &panels);
    }
    report
}

/// Expected | difference | actual, as a PNG file.
fn panels(expected: &RgbImage, actual: &RgbImage) -> Option<Vec<u8>> {
    let [before, now] = [expected, actual].map(framebuffer_of);
    let (marked, _) = picture::difference(&before, &now)?;
    let panels = picture::side_by_side(&[before, marked, now])?;
    let channels = panels.rows_from_top().flatten().flat_map(|color| color.channels()).collect();
    let mut bytes = std::io::Cursor::new(Vec::new());
    let image = RgbImage::from_raw(panels.width(), panels.height(), channels)?;
    image.write_to(&mut bytes, image::ImageFormat::Png).ok()?;
    Some(bytes.into_inner())
}

fn framebuffer_of(image: &RgbImage) -> Framebuffer {
    let mut framebuffer = Framebuffer::new(image.width(), image.height());
    for (x, row, pixel) in image.enumerate_pixels() {
        let [red, green, blue] = pixel.0;
        framebuffer.set(x as i32, (image.height() - 1 - row) as i32, Color::rgb(red, green, blue));
    }
    framebuffer
}

/// Puts a picture into the folder of failures.
fn save(name: &str, kind: &str, bytes: &[u8]) {
    let folder = failure_folder();
    let saved = std::fs::create_dir_all(&folder)
        .and_then(|()| std::fs::write(folder.join(format!("{name}.{kind}.png")), bytes));
    if let Err(error) = saved {
        panic!("cannot write to {}: {error}", folder.display());
    }
}
