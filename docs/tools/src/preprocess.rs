//! Makes pages that show well on a code host into pages of a book that is whole by itself.
//!
//! - Pictures of `tests/snapshots` are copied into the book, and centered.
//! - Below `<!-- live -->` a picture of a chapter's variant becomes a live figure, if `docs/live/build` has run.
//! - Below `<!-- crop X Y WIDTH HEIGHT -->` a part of a picture is shown, counted from its upper left, and never scaled.
//! - Drawings (`figures/NAME.svg`) are put into the page, where they take the colors of its theme.
//! - A note for those who read the page on a code host, where nothing is put in, is left out.
//! - Other files of the repository that a page links to become pages with line numbers.
//! - Code within text that is longer than a line of a phone says where it may break.
//! - Formulas, blocks named `math` and `` $`…`$ `` within a line, become MathML.
//!
//! The copies go to `docs/src/files`, which git ignores, since mdBook takes all files from below `src`.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Component, Path, PathBuf};

use pulldown_latex::config::{DisplayMode, RenderConfig};
use pulldown_latex::{Parser, Storage, push_mathml};
use serde_json::Value;

use crate::html::escape;
use crate::{Errors, files, read, repository};

/// Reads the book from standard input and writes it to standard output.
pub fn run() -> Result<(), Errors> {
    let input = std::io::read_to_string(std::io::stdin()).map_err(|error| vec![error.to_string()])?;
    let mut input: Value = serde_json::from_str(&input).map_err(|error| vec![error.to_string()])?;
    let mut book = input[1].take();
    let mut work = Work::new(repository().join("docs/src"));
    work.items(&mut book["items"]);
    work.remove_old_copies();
    if work.errors.is_empty() {
        println!("{book}");
        Ok(())
    } else {
        Err(work.errors)
    }
}

/// What begins a note that is not for the book.
const HOST_NOTE: &str = "<!-- on a code host -->";

/// What stands above a picture that is to be live. On a code host it is a comment.
const LIVE: &str = "<!-- live -->";

/// What stands above a picture of which a part is to be shown; four numbers follow.
const CROP: &str = "<!-- crop ";

/// The chapters, compiled for pages.
const MODULE: &str = "target/live/rasterbook.wasm";

struct Work {
    /// `docs/src`.
    source: PathBuf,
    copies: BTreeSet<PathBuf>,
    /// The page at work, relative to `source`.
    page: PathBuf,
    /// Whether the next picture is to be live.
    is_live: bool,
    /// The part of the next picture that is to be shown: the column and the row of its upper left, width and height.
    crop: Option<[u32; 4]>,
    errors: Errors,
}

impl Work {
    fn new(source: PathBuf) -> Self {
        Self {
            source,
            copies: BTreeSet::new(),
            page: PathBuf::new(),
            is_live: false,
            crop: None,
            errors: Vec::new(),
        }
    }

    fn items(&mut self, items: &mut Value) {
        for item in items.as_array_mut().into_iter().flatten() {
            let Some(chapter) = item.get_mut("Chapter") else { continue };
            if let (Some(path), Some(content)) = (chapter["path"].as_str(), chapter["content"].as_str()) {
                self.page = PathBuf::from(path);
                let content = self.content(content);
                chapter["content"] = Value::from(content);
            }
            self.items(&mut chapter["sub_items"]);
        }
    }

    fn error(&mut self, what: &str) {
        self.errors.push(format!("docs/src/{}: {what}", self.page.display()));
    }

    /// A page. Blocks of code stay as they are.
    fn content(&mut self, text: &str) -> String {
        let mut result = String::new();
        let mut lines = text.lines();
        while let Some(line) = lines.next() {
            if line == HOST_NOTE {
                // Up to the blank line below it.
                lines.by_ref().find(|line| line.is_empty());
                continue;
            }
            if line == LIVE {
                self.is_live = true;
                continue;
            }
            if let Some(part) = line.strip_prefix(CROP) {
                self.crop = part_of(part);
                if self.crop.is_none() {
                    self.error(&format!("{line}: not four numbers"));
                }
                continue;
            }
            let trimmed = line.trim_start();
            let fence: String = trimmed.chars().take_while(|it| *it == '`' || *it == '~').collect();
            if fence.len() < 3 {
                result.push_str(&self.line(line));
                result.push('\n');
                continue;
            }
            let indent = &line[..line.len() - trimmed.len()];
            let is_end = |line: &&str| line.trim() == fence;
            if trimmed[fence.len()..].trim() == "math" {
                let formula: Vec<&str> = lines.by_ref().take_while(|line| !is_end(line)).collect();
                let mathml = self.formula(&formula.join("\n"), DisplayMode::Block);
                result.push_str(&format!("{indent}<div class=\"formula\">{mathml}</div>\n"));
            } else {
                result.push_str(&format!("{line}\n"));
                for line in lines.by_ref() {
                    result.push_str(&format!("{line}\n"));
                    if is_end(&line) {
                        break;
                    }
                }
            }
        }
        result
    }

    /// A line outside of code blocks.
    fn line(&mut self, line: &str) -> String {
        let trimmed = line.trim();
        let alone = trimmed.strip_prefix("![").and_then(|it| it.strip_suffix(')'));
        if let Some((alternative, target)) = alone.and_then(|it| it.split_once("]("))
            && !target.contains(['(', ' '])
        {
            let indent = &line[..line.len() - line.trim_start().len()];
            return format!("{indent}{}", self.picture(&alternative.replace('`', ""), target));
        }
        let mut result = String::new();
        let mut rest = line;
        while let Some(start) = rest.find('`') {
            let ticks = rest[start..].len() - rest[start..].trim_start_matches('`').len();
            let (before, code) = rest.split_at(start);
            let Some(length) = code[ticks..].find(&code[..ticks]) else { break };
            let (inside, after) = (&code[ticks..ticks + length], &code[2 * ticks + length..]);
            if let (Some(before), Some(after)) = (before.strip_suffix('$'), after.strip_prefix('$')) {
                result.push_str(&self.links(before));
                result.push_str(&self.formula(inside, DisplayMode::Inline));
                rest = after;
            } else {
                result.push_str(&self.links(before));
                if ticks == 1 && inside.chars().count() > LONG_CODE {
                    result.push_str(&long_code(inside));
                } else {
                    result.push_str(&code[..2 * ticks + length]);
                }
                rest = after;
            }
        }
        result.push_str(&self.links(rest));
        result
    }

    /// Links to files outside of `docs/src` lead to copies.
    fn links(&mut self, text: &str) -> String {
        let mut text = text.to_owned();
        for (begin, end) in [("](", ')'), ("src=\"", '"'), ("href=\"", '"')] {
            let mut result = String::new();
            let mut parts = text.split(begin);
            result.push_str(parts.next().unwrap_or_default());
            for part in parts {
                result.push_str(begin);
                let (target, after) = part.split_at(part.find(end).unwrap_or(0));
                result.push_str(&self.target(target));
                result.push_str(after);
            }
            text = result;
        }
        text
    }

    fn formula(&mut self, latex: &str, display_mode: DisplayMode) -> String {
        let storage = Storage::new();
        for event in Parser::new(latex, &storage) {
            if let Err(error) = event {
                self.error(&format!("formula: {error}"));
            }
        }
        let mut mathml = String::new();
        let config = RenderConfig { display_mode, ..RenderConfig::default() };
        if push_mathml(&mut mathml, Parser::new(latex, &storage), config).is_err() {
            self.error(&format!("formula: {latex}"));
        }
        // The signs for less and greater come out as they are; in HTML they begin and end tags.
        mathml
            .replace('\n', " ")
            .replace("<mo><</mo>", "<mo>&lt;</mo>")
            .replace("<mo>></mo>", "<mo>&gt;</mo>")
    }

    /// A picture that stands alone on its line.
    fn picture(&mut self, alternative: &str, target: &str) -> String {
        let alternative = escape(alternative);
        let path = self.source.join(&self.page).with_file_name(target);
        if target.ends_with(".svg") {
            return format!(
                "<figure class=\"drawing\" role=\"img\" aria-label=\"{alternative}\">{}</figure>",
                drawing(&read(&path))
            );
        }
        let size = fs::read(&path).ok().and_then(|png| {
            let number = |at: usize| Some(u32::from_be_bytes(png.get(at..at + 4)?.try_into().ok()?));
            Some((number(16)?, number(20)?))
        });
        let Some((width, height)) = size else {
            self.error(&format!("no picture {target}"));
            return String::new();
        };
        if let Some([x, y, part_width, part_height]) = self.crop.take() {
            if x + part_width > width || y + part_height > height {
                self.error(&format!("{target} has no such part"));
            }
            let target = self.target(target);
            return format!(
                "<figure class=\"crop\"><a href=\"{target}\"><img src=\"{target}\" alt=\"{alternative}\" \
                 style=\"width: {part_width}px; height: {part_height}px; object-position: -{x}px -{y}px\"></a></figure>"
            );
        }
        let live = if std::mem::take(&mut self.is_live) { self.live(target) } else { None };
        let class = live.unwrap_or_else(|| picture_class(target, width));
        let target = self.target(target);
        format!(
            "<figure{class}><a href=\"{target}\"><img src=\"{target}\" alt=\"{alternative}\" width=\"{width}\" \
             height=\"{height}\"></a></figure>"
        )
    }

    /// What makes a picture a live figure: whose it is, and where the module is. Its name changes with its content, so
    /// that no browser takes an old one for it.
    fn live(&mut self, target: &str) -> Option<String> {
        let Some((chapter, variant, frame)) = variant_of(target) else {
            self.error(&format!("{target} is no variant's own picture: it cannot be live"));
            return None;
        };
        let module = fs::read(repository().join(MODULE)).ok()?;
        let file = format!("live-{:016x}.wasm", fingerprint(&module));
        self.copy(&self.source.join("files").join(&file), &module);
        Some(format!(
            " class=\"live\" data-chapter=\"{chapter}\" data-variant=\"{variant}\" data-frame=\"{frame}\" \
             data-module=\"files/{file}\""
        ))
    }

    /// Where a link leads to in the book.
    fn target(&mut self, target: &str) -> String {
        let (file, fragment) = match target.find('#') {
            Some(at) => target.split_at(at),
            None => (target, ""),
        };
        if file.is_empty() || file.contains(':') {
            return target.to_owned();
        }
        let path = normal(&self.source.join(&self.page).with_file_name(file));
        if path.starts_with(&self.source) {
            return target.to_owned();
        }
        let repository = repository();
        let Ok(inside) = path.strip_prefix(&repository) else {
            self.error(&format!("{target} leads out of the repository"));
            return target.to_owned();
        };
        let Ok(content) = fs::read(&path) else {
            self.error(&format!("no file {target}"));
            return target.to_owned();
        };
        let inside = inside.to_string_lossy().replace('\\', "/");
        let (copy, content) = if inside.ends_with(".png") {
            (inside, content)
        } else {
            let content = listing(&inside, &String::from_utf8_lossy(&content));
            (format!("{inside}.html"), content.into_bytes())
        };
        self.copy(&self.source.join("files").join(&copy), &content);
        let up = "../".repeat(self.page.components().count() - 1);
        format!("{up}files/{copy}{fragment}")
    }

    /// Writes a file unless it is there already, or else `mdbook serve` would build for ever.
    fn copy(&mut self, path: &Path, content: &[u8]) {
        self.copies.insert(path.to_owned());
        if fs::read(path).is_ok_and(|old| old == content) {
            return;
        }
        let folder = path.parent().expect("a folder");
        if let Err(error) = fs::create_dir_all(folder).and_then(|()| fs::write(path, content)) {
            self.error(&format!("{}: {error}", path.display()));
        }
    }

    fn remove_old_copies(&mut self) {
        for file in files(&self.source.join("files")) {
            if !self.copies.contains(&file)
                && let Err(error) = fs::remove_file(&file)
            {
                self.error(&format!("{}: {error}", file.display()));
            }
        }
    }
}

/// The four numbers of `X Y WIDTH HEIGHT -->`.
fn part_of(text: &str) -> Option<[u32; 4]> {
    let numbers: Option<Vec<u32>> =
        text.strip_suffix("-->")?.split_whitespace().map(|number| number.parse().ok()).collect();
    numbers?.try_into().ok()
}

/// The chapter, the variant and the frame that a picture shows; `None` if it is magnified, or beside another one.
fn variant_of(target: &str) -> Option<(&str, &str, u32)> {
    let name = target.rsplit('/').next()?.strip_suffix(".snap.png")?;
    let (chapter, variant) = name.split_once("__")?;
    let (variant, frame) = variant.split_once('@').unwrap_or((variant, "0"));
    let is_alone = !variant.contains("--") && !variant.contains("-zoom");
    is_alone.then_some((chapter, variant, frame.parse().ok()?))
}

/// A number that another content has not, as far as one can tell: FNV-1a.
fn fingerprint(bytes: &[u8]) -> u64 {
    let mix = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x100_0000_01b3);
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, mix)
}

/// The class of a picture: a comparison is a strip of three, another one says how much room it needs to be shown in its
/// own size.
fn picture_class(file: &str, width: u32) -> String {
    if file.rsplit('/').next().is_some_and(|name| name.contains("--")) {
        return " class=\"strip\"".to_owned();
    }
    let room = [320, 480, 640, 800].into_iter().find(|room| width <= *room);
    room.map(|room| format!(" class=\"to-{room}\"")).unwrap_or_default()
}

/// So many characters of code fit into a line of a phone.
const LONG_CODE: usize = 36;

/// Long code within text: it breaks between words, and a long word after `_` and `/`.
fn long_code(code: &str) -> String {
    // Signs that Markdown reads, even within tags: two hyphens would become a dash.
    let literal = |text: &str| {
        let mut result = escape(text);
        for sign in ["*", "_", "[", "]", "|", "\\", "~", "-", ".", "'"] {
            result = result.replace(sign, &format!("&#{};", u32::from(sign.as_bytes()[0])));
        }
        result
    };
    // Within a table a bar has a backslash in front of it.
    let code = code.replace("\\|", "|");
    let words: Vec<String> = code
        .split(' ')
        .map(|word| {
            if word.chars().count() <= LONG_CODE {
                return format!("<span>{}</span>", literal(word));
            }
            word.split_inclusive(['_', '/']).map(literal).collect::<Vec<_>>().join("<wbr>")
        })
        .collect();
    format!("<code class=\"long\">{}</code>", words.join(" "))
}

/// A path without `..`.
fn normal(path: &Path) -> PathBuf {
    let mut result = PathBuf::new();
    for component in path.components() {
        match component {
            Component::ParentDir => {
                result.pop();
            }
            Component::CurDir => {}
            other => result.push(other),
        }
    }
    result
}

/// A drawing as it stands in a page: without what it needs only as a file, and on one line.
fn drawing(svg: &str) -> String {
    let svg = svg.find("<svg").map_or(svg, |start| &svg[start..]);
    let svg = match (svg.find("<style>"), svg.find("</style>")) {
        (Some(start), Some(end)) => format!("{}{}", &svg[..start], &svg[end + "</style>".len()..]),
        _ => svg.to_owned(),
    };
    svg.lines().map(str::trim).filter(|line| !line.is_empty()).collect::<Vec<_>>().join(" ")
}

/// A file of the repository as a page of its own, with numbered lines.
fn listing(name: &str, text: &str) -> String {
    let name = escape(name);
    let mut lines = String::new();
    for (index, line) in text.lines().enumerate() {
        let number = index + 1;
        lines.push_str(&format!("<span id=\"L{number}\">{}</span>\n", escape(line)));
    }
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n<title>{name}</title>\n<style>\n\
         pre {{ line-height: 1.4; counter-reset: line; overflow-x: auto }}\n\
         span::before {{ counter-increment: line; content: counter(line); display: inline-block;\n\
         width: 3em; margin-right: 1.5em; text-align: right; opacity: 0.5 }}\n\
         span:target {{ background: #8884 }}\n</style>\n</head>\n<body>\n<h1>{name}</h1>\n\
         <pre>{lines}</pre>\n</body>\n</html>\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_code_breaks_between_words_and_in_long_names_alone() {
        assert_eq!(
            long_code("run --set a|b"),
            "<code class=\"long\"><span>run</span> <span>&#45;&#45;set</span> <span>a&#124;b</span></code>"
        );
        let name = "the_row_of_a_fractional_middle_vertex_is_drawn_twice";
        let code = long_code(name);
        assert_eq!(code.matches("<wbr>").count(), name.matches('_').count(), "{code}");
        assert!(!code.contains('_') && !code.contains("<span>"), "{code}");
    }

    #[test]
    fn a_part_is_four_numbers() {
        assert_eq!(part_of("360 20 260 320 -->"), Some([360, 20, 260, 320]));
        assert_eq!(part_of("360 20 260 -->"), None);
        assert_eq!(part_of("360 20 260 -5 -->"), None);
        assert_eq!(part_of("360 20 260 320"), None);
    }

    #[test]
    fn pictures_say_how_much_room_they_need() {
        assert_eq!(picture_class("../tests/a__b--c.snap.png", 480), " class=\"strip\"");
        assert_eq!(picture_class("../tests/a__floor-affine.snap.png", 560), " class=\"to-640\"");
        assert_eq!(picture_class("../tests/a__b.snap.png", 801), "");
    }
}
