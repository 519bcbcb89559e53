//! Whether the pages as they are written keep to their own rules: words that must not come back, histories of the pixel
//! that is announced, and listings that are not too wide. How long each page is, is printed.

use std::path::Path;

use crate::{Errors, pages, read, repository};

/// Checks all pages and the README.
pub fn run() -> Errors {
    let root = repository();
    let mut errors = Vec::new();
    for page in pages() {
        let name = page.strip_prefix(&root).unwrap_or(&page).display().to_string();
        let text = read(&page);
        errors.extend(words(&text).into_iter().map(|what| format!("{name}:{what}")));
        errors.extend(histories(&text, &page).into_iter().map(|what| format!("{name}:{what}")));
        errors.extend(wide_lines(&text, &page).into_iter().map(|what| format!("{name}:{what}")));
        errors.extend(words_of_listings(&text, &page).into_iter().map(|what| format!("{name}:{what}")));
        let length = Length::of(&text, &page);
        println!("{name}: {length}");
    }
    errors
}

/// Words that the field does not use, and what to write instead. They have all been there once.
const WORDS: [(&str, &str); 34] = [
    ("evenly", "linearly, or equally"),
    ("reckon", "compute"),
    ("reckoned", "computed"),
    ("mend", "fix, remedy"),
    ("mended", "fixed"),
    ("part of the way", "parameter, or fraction"),
    ("way on the screen", "parameter on the screen"),
    ("range of the corners", "range of the vertices"),
    ("middle corner", "middle vertex"),
    ("each corner", "each vertex"),
    ("corners of a triangle", "vertices of a triangle"),
    ("corners of the triangle", "vertices of the triangle"),
    ("level edge", "horizontal edge"),
    ("level edges", "horizontal edges"),
    ("level line", "horizontal line"),
    ("level lines", "horizontal lines"),
    ("near distance", "distance of the image plane"),
    ("projection plane", "image plane"),
    ("is limited", "is clamped"),
    ("are limited", "are clamped"),
    ("stored numbers", "encoded values"),
    ("before the eye", "in front of the eye"),
    ("before the near plane", "in front of the near plane"),
    ("flat line", "x-major line"),
    ("steep line", "y-major line"),
    ("stairs", "jaggies"),
    ("upright", "vertical, or perpendicular"),
    ("aslant", "slanted"),
    ("goes ahead", "is stepped"),
    ("is asked", "is tested, or sampled"),
    ("are asked", "are tested, or sampled"),
    ("turned round", "reversed"),
    ("hence the name", "say where the name comes from, or nothing"),
    ("whoever", "name who"),
];

/// Which of them are in a text, with the lines; code may use what words it likes.
fn words(text: &str) -> Errors {
    let prose = prose(text);
    // A line break between two words is a space.
    let flat = prose.to_lowercase().replace('\n', " ");
    let is_part = |it: char| it.is_alphanumeric() || it == '_';
    let mut errors = Vec::new();
    for (word, instead) in WORDS {
        for (at, _) in flat.match_indices(word) {
            let (before, after) = (&flat[..at], &flat[at + word.len()..]);
            if before.ends_with(is_part) || after.starts_with(is_part) {
                continue;
            }
            let line = before.chars().zip(prose.chars()).filter(|(_, it)| *it == '\n').count() + 1;
            errors.push(format!("{line}: \"{word}\": write {instead}"));
        }
    }
    errors
}

/// Which of them are in the comments of the code that a page includes; the line is that of the page.
fn words_of_listings(text: &str, page: &Path) -> Errors {
    let mut errors = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let Some((file, lines)) = listing(line, page) else { continue };
        for what in words(&comments(&lines)) {
            let (_, what) = what.split_once(": ").unwrap_or_default();
            errors.push(format!("{}: a comment of {file}: {what}", index + 1));
        }
    }
    errors
}

/// What stands in the comments of code, a line for each.
fn comments(lines: &[String]) -> String {
    let comment = |line: &String| {
        line.split_once("//").map(|(_, text)| text.trim_start_matches(['/', '!']).trim().to_owned())
    };
    lines.iter().filter_map(comment).collect::<Vec<_>>().join("\n")
}

/// A text without its code; the lines stay.
fn prose(text: &str) -> String {
    let mut result = String::new();
    let mut in_block = false;
    for line in text.lines() {
        let is_fence = line.trim_start().starts_with("```");
        in_block ^= is_fence;
        if !in_block && !is_fence {
            // Every second part lies between backticks.
            result.extend(line.split('`').step_by(2));
        }
        result.push('\n');
    }
    result
}

/// The history that follows an `--inspect X,Y` must be of that pixel.
fn histories(text: &str, page: &Path) -> Errors {
    let mut errors = Vec::new();
    let mut announced = None;
    for (index, line) in text.lines().enumerate() {
        if let Some((_, after)) = line.split_once("--inspect ")
            && after.starts_with(|it: char| it.is_ascii_digit())
        {
            let end = after.find(|it: char| !it.is_ascii_digit() && it != ',').unwrap_or(after.len());
            announced = Some(after[..end].trim_end_matches(','));
        }
        let shown = match line.split_once("{{#include ../../tests/histories/") {
            Some((_, file)) => {
                let file = file.split(':').next().unwrap_or_default();
                let history = read(&page.with_file_name("../../tests/histories").join(file));
                history.lines().find_map(pixel)
            }
            None => pixel(line),
        };
        if let Some(pixel) = shown
            && let Some(announced) = announced.take()
            && announced != pixel
        {
            errors.push(format!("{}: a history of ({pixel}) below --inspect {announced}", index + 1));
        }
    }
    errors
}

/// `X,Y` of the second line of a history.
fn pixel(line: &str) -> Option<String> {
    let (pixel, _) = line.strip_prefix("pixel (")?.split_once("), y up")?;
    Some(pixel.replace(' ', ""))
}

/// So many characters of a listing fit beside a table of contents.
const WIDEST: usize = 100;

/// Code that is folded on its pages, and as wide as the library allows.
const MAY_BE_WIDER: &str = "../../lib/tiled/";

/// Lines of listings that are too wide, on the page itself or in what it includes.
fn wide_lines(text: &str, page: &Path) -> Errors {
    let mut errors = Vec::new();
    let mut is_rust = false;
    for (index, line) in text.lines().enumerate() {
        if let Some(language) = line.trim_start().strip_prefix("```") {
            is_rust = !is_rust && language.starts_with("rust");
        }
        let (from, lines) = match listing(line, page) {
            Some((file, _)) if file.starts_with(MAY_BE_WIDER) => continue,
            Some((file, lines)) => (file, lines),
            None if is_rust => (String::new(), vec![line.to_owned()]),
            None => continue,
        };
        for line in lines {
            let width = line.chars().count();
            if width > WIDEST {
                errors.push(format!("{}: {from}: {width} characters, not {WIDEST}: {line}", index + 1));
            }
        }
    }
    errors
}

/// The file that a line of a page includes code from, and that code.
fn listing(line: &str, page: &Path) -> Option<(String, Vec<String>)> {
    let (_, include) = line.split_once("{{#include ")?;
    let (file, anchor) = include.trim_end_matches("}}").split_once(".rs:")?;
    let file = format!("{file}.rs");
    let source = read(&page.with_file_name(&file));
    Some((file, anchored(&source, anchor).map(ToOwned::to_owned).collect()))
}

/// How long a page is: a sitting has two to three thousand words and some 120 lines of listings.
#[derive(Default)]
struct Length {
    words: usize,
    /// Lines of listings that are shown.
    lines: usize,
    /// Lines of listings that are folded.
    folded: usize,
    /// The characters of the longest of these lines.
    longest: usize,
}

impl Length {
    fn of(text: &str, page: &Path) -> Self {
        let words = prose(text).split_whitespace().filter(|it| it.contains(char::is_alphanumeric)).count();
        let mut length = Self { words, ..Self::default() };
        let mut depth = 0;
        for line in text.lines() {
            depth += line.matches("<details").count();
            depth -= line.matches("</details>").count().min(depth);
            for line in listing(line, page).into_iter().flat_map(|(_, lines)| lines) {
                *if depth > 0 { &mut length.folded } else { &mut length.lines } += 1;
                length.longest = length.longest.max(line.chars().count());
            }
        }
        length
    }
}

impl std::fmt::Display for Length {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { words, lines, folded, longest } = self;
        write!(f, "{words} words")?;
        if lines + folded > 0 {
            write!(
                f,
                ", {lines} lines of listings and {folded} folded, the longest of {longest} characters"
            )?;
        }
        Ok(())
    }
}

/// The lines of an anchor.
fn anchored<'a>(source: &'a str, anchor: &str) -> impl Iterator<Item = &'a str> {
    let (begin, end) = (format!("// ANCHOR: {anchor}"), format!("// ANCHOR_END: {anchor}"));
    source
        .lines()
        .skip_while(move |line| line.trim() != begin)
        .skip(1)
        .take_while(move |line| line.trim() != end)
        .filter(|line| !line.trim().starts_with("// ANCHOR"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_found_across_lines_but_not_in_code() {
        let text = "It goes\nahead.\n`aslant` is code\n```text\nstairs\n```\nunevenly Upright.";
        let found = words(text);
        assert_eq!(found.len(), 2, "{found:?}");
        assert!(found.iter().any(|it| it.starts_with("1: \"goes ahead\"")), "{found:?}");
        assert!(found.iter().any(|it| it.starts_with("7: \"upright\"")), "{found:?}");
    }

    #[test]
    fn words_are_found_in_comments_of_code() {
        let code =
            ["/// It goes", "/// ahead, and `aslant`.", "let stairs = 1; // upright", "let evenly = 2;"];
        let found = words(&comments(&code.map(ToOwned::to_owned)));
        assert_eq!(found.len(), 2, "{found:?}");
        assert!(found[0].contains("upright") && found[1].contains("goes ahead"), "{found:?}");
    }

    #[test]
    fn a_history_is_of_the_pixel_that_is_announced() {
        let page = Path::new("page.md");
        let told =
            "`floor --inspect 3,4`\n```text\nch01 floor\npixel (3, 4), y up; row 5 of the image file\n```\n";
        assert_eq!(histories(told, page), Errors::new());
        assert_eq!(histories(&told.replace("3,4", "3,5"), page).len(), 1);
    }

    #[test]
    fn listings_are_not_too_wide() {
        let page = Path::new("page.md");
        let code =
            |width: usize| format!("```rust,ignore\n{}\n```\n{}\n", "x".repeat(width), "y".repeat(300));
        assert_eq!(wide_lines(&code(100), page), Errors::new());
        assert_eq!(wide_lines(&code(101), page).len(), 1);
    }

    #[test]
    fn listings_are_counted_apart_where_they_are_folded() {
        let source = "// ANCHOR: a\nfn a() {}\n// ANCHOR: b\nfn b() {}\n// ANCHOR_END: b\n// ANCHOR_END: a\n";
        assert_eq!(anchored(source, "a").count(), 2);
        assert_eq!(anchored(source, "b").count(), 1);
    }
}
