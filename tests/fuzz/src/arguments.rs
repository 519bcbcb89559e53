//! Bytes as a command line.

use std::ffi::OsString;

use rasterbook::figure::Chapter;

/// A command line, a line an argument. It lists and draws nothing, if it is one.
pub(crate) fn arguments(chapters: &[&Chapter], data: &[u8]) {
    let (chapter, text) = data.split_first().map_or((0, data), |(first, rest)| (usize::from(*first), rest));
    let text = String::from_utf8_lossy(text);
    let words = ["program", "--list"].into_iter().chain(text.lines()).map(OsString::from);
    let _ = chapters[chapter % chapters.len()].main_with(words);
}
