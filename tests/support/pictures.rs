//! Compares pictures by their decoded pixels, exactly. The one file that uses `insta::internals`.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs;
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

/// Names a folder that takes the place of all others here: the test of the review itself sets it, and nothing else.
const ELSEWHERE: &str = "RASTERBOOK_SNAPSHOTS";

/// Where the pictures of failed comparisons go: `tmp/snapshots` in the folder into which cargo builds.
pub(crate) fn failure_folder() -> PathBuf {
    elsewhere("failures").unwrap_or_else(|| Path::new(env!("CARGO_TARGET_TMPDIR")).join("snapshots"))
}

/// Where the accepted pictures are.
pub(crate) fn snapshot_folder() -> PathBuf {
    elsewhere("accepted").unwrap_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/snapshots"))
}

/// Where the programs draw into.
pub(crate) fn drawing_folder() -> PathBuf {
    elsewhere("drawn").unwrap_or_else(|| Path::new(env!("CARGO_TARGET_TMPDIR")).to_owned())
}

fn elsewhere(part: &str) -> Option<PathBuf> {
    std::env::var_os(ELSEWHERE).map(|folder| Path::new(&folder).join(part))
}

/// What became of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// It equals the accepted one.
    Equal,
    /// It was accepted in place of another one, as `INSTA_UPDATE=always` asks.
    Replaced,
    /// It was accepted where there was none to compare with.
    Added,
    /// It waits for a review without failing its test, as `INSTA_FORCE_PASS` asks, which `cargo insta test` sets.
    Waiting,
}

/// Compares a PNG file with the accepted picture of that name.
///
/// The error says what differs. Then all that a review needs is at [`failure_folder`], where a picture that is
/// accepted again takes it away.
pub(crate) fn assert_picture(name: &str, png: &[u8]) -> Result<Outcome, String> {
    forget(name);
    let was_there = [".snap", ".snap.png"].iter().all(|end| accepted(name, end).exists());
    let comparator = Pixels { finding: Arc::default() };
    let finding = Arc::clone(&comparator.finding);

    let mut settings = Settings::clone_current();
    settings.set_prepend_module_to_snapshot(false);
    settings.set_snapshot_path(snapshot_folder());
    settings.set_omit_expression(true);
    settings.set_comparator(Box::new(comparator));
    let (file, bytes) = (format!("{name}.png"), png.to_vec());
    let asserted =
        catch_unwind(AssertUnwindSafe(|| settings.bind(|| insta::assert_binary_snapshot!(&file, bytes))));

    let finding = match finding.lock().expect("no other thread").take() {
        None if was_there && asserted.is_ok() => return Ok(Outcome::Equal),
        None => Finding::of("there is no accepted picture yet".to_owned()),
        Some(finding) => finding,
    };
    if asserted.is_ok() && fs::read(accepted(name, ".snap.png")).is_ok_and(|bytes| bytes == png) {
        return Ok(if was_there { Outcome::Replaced } else { Outcome::Added });
    }
    let reason = format!("{name}: {}", finding.reason);
    finding.save(name, Some(png))?;
    if asserted.is_ok() { Ok(Outcome::Waiting) } else { Err(reason) }
}

/// Puts an accepted picture among the failures to which there is no new picture, and says why.
pub(crate) fn report_undrawn(name: &str, reason: &str) -> Result<(), String> {
    forget(name);
    let png = fs::read(accepted(name, ".snap.png")).ok().filter(|bytes| decode_png(bytes).is_ok());
    Finding { expected: png, ..Finding::of(reason.to_owned()) }.save(name, None)
}

/// Takes away the failures of pictures that neither are drawn nor were accepted: their variants are gone.
pub(crate) fn forget_others(drawn: &BTreeSet<&str>) {
    for name in failures() {
        if !drawn.contains(name.as_str()) && !accepted(&name, ".snap.png").exists() {
            forget(&name);
        }
    }
}

/// The names of all pictures that wait for a review.
pub(crate) fn failures() -> BTreeSet<String> {
    let entries = fs::read_dir(failure_folder()).into_iter().flatten();
    let names = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    names.filter_map(|name| name.strip_suffix(REASON).map(str::to_owned)).collect()
}

/// A file of an accepted picture.
fn accepted(name: &str, end: &str) -> PathBuf {
    snapshot_folder().join(format!("{name}{end}"))
}

// What is kept of a failure: the accepted picture, the new one, both beside their difference, and what was found.
const EXPECTED: &str = ".expected.png";
const ACTUAL: &str = ".actual.png";
const PANELS: &str = ".report.png";
const REASON: &str = ".reason.txt";

/// Takes an earlier failure away.
fn forget(name: &str) {
    for end in [EXPECTED, ACTUAL, PANELS, REASON] {
        let _ = fs::remove_file(failure_folder().join(format!("{name}{end}")));
    }
}

/// Why a picture was not accepted.
struct Finding {
    reason: String,
    /// The accepted picture, if it can be read, as a PNG file.
    expected: Option<Vec<u8>>,
    /// Expected | difference | actual, as a PNG file; pictures of different sizes have none.
    panels: Option<Vec<u8>>,
}

impl Finding {
    fn of(reason: String) -> Self {
        Self { reason, expected: None, panels: None }
    }

    /// Writes it to [`failure_folder`].
    fn save(&self, name: &str, actual: Option<&[u8]>) -> Result<(), String> {
        let files = [
            (EXPECTED, self.expected.as_deref()),
            (ACTUAL, actual),
            (PANELS, self.panels.as_deref()),
            (REASON, Some(self.reason.as_bytes())),
        ];
        let folder = failure_folder();
        fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        for (end, bytes) in files {
            let file = folder.join(format!("{name}{end}"));
            let written = bytes.map_or(Ok(()), |bytes| fs::write(&file, bytes));
            written.map_err(|error| format!("{}: {error}", file.display()))?;
        }
        Ok(())
    }
}

/// Equal if and only if all pixels are equal: PNG bytes change with the encoder, pixels must not.
struct Pixels {
    finding: Arc<Mutex<Option<Finding>>>,
}

impl Comparator for Pixels {
    fn matches(&self, reference: &Snapshot, test: &Snapshot) -> bool {
        // The same file has the same pixels.
        if bytes(reference).is_ok_and(|before| bytes(test) == Ok(before)) {
            return true;
        }
        let finding = match (decode(reference), decode(test)) {
            (Ok(expected), Ok(actual)) if expected == actual => return true,
            (Ok(expected), Ok(actual)) => Finding {
                reason: difference(&expected, &actual),
                expected: bytes(reference).ok().map(<[u8]>::to_vec),
                panels: panels(&expected, &actual),
            },
            (Err(reason), _) => Finding::of(format!("the accepted picture cannot be read: {reason}")),
            (_, Err(reason)) => Finding::of(format!("the new picture cannot be read: {reason}")),
        };
        *self.finding.lock().expect("no other thread") = Some(finding);
        false
    }

    fn dyn_clone(&self) -> Box<dyn Comparator> {
        Box::new(Self { finding: Arc::clone(&self.finding) })
    }
}

/// The pixels of a snapshot.
fn decode(snapshot: &Snapshot) -> Result<RgbImage, String> {
    bytes(snapshot).and_then(decode_png)
}

/// The PNG file of a snapshot.
fn bytes(snapshot: &Snapshot) -> Result<&[u8], String> {
    match snapshot.contents() {
        SnapshotContents::Binary(Some(bytes)) => Ok(bytes),
        SnapshotContents::Binary(None) => Err("its .snap.png file is missing".to_owned()),
        SnapshotContents::Text(_) => Err("it is a text snapshot".to_owned()),
    }
}

/// The pixels of a PNG file.
fn decode_png(bytes: &[u8]) -> Result<RgbImage, String> {
    if bytes.starts_with(b"version https://git-lfs") {
        return Err("it is a pointer of Git LFS, not a picture: run git lfs pull".to_owned());
    }
    let image = image::load_from_memory_with_format(bytes, image::ImageFormat::Png);
    image.map(image::DynamicImage::into_rgb8).map_err(|error| error.to_string())
}

/// Says how two pictures differ, in framebuffer coordinates (y up).
fn difference(expected: &RgbImage, actual: &RgbImage) -> String {
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
