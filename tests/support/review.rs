//! One HTML file that shows all pictures which wait for a review, and what there is to know of each.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{fs, io};

use base64::Engine as _;

/// What a program can draw, as far as a review needs it.
pub(crate) struct Entry {
    pub(crate) name: String,
    /// What to look for in the picture.
    pub(crate) look: String,
    /// The command that reports a pixel of it, up to the coordinates; a comparison has none.
    pub(crate) inspect: Option<String>,
}

/// Writes `review.html` for the failures in a folder; takes it away if there are none.
///
/// The pictures come by chapters, in the order of `entries`; after them those that no program draws.
pub(crate) fn write_page(
    folder: &Path,
    failures: &BTreeSet<String>,
    entries: &[Entry],
) -> io::Result<Option<PathBuf>> {
    let page = folder.join("review.html");
    if failures.is_empty() {
        return match fs::remove_file(&page) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
            _ => Ok(None),
        };
    }
    let mut sorted: Vec<(usize, &String)> = failures
        .iter()
        .map(|name| (entries.iter().position(|entry| entry.name == *name).unwrap_or(entries.len()), name))
        .collect();
    sorted.sort_by_key(|&(index, name)| (chapter(name), index));
    let sections: String =
        sorted.into_iter().map(|(index, name)| section(folder, name, entries.get(index))).collect();
    let html = include_str!("review.html").replace("<!-- pictures -->", &sections);
    fs::write(&page, html)?;
    Ok(Some(page))
}

/// The program that draws a picture.
fn chapter(name: &str) -> &str {
    name.split("__").next().unwrap_or(name)
}

/// The part of the page that has one picture, before and after; without scripts it is shown as it stands.
fn section(folder: &Path, name: &str, entry: Option<&Entry>) -> String {
    let file = |end: &str| fs::read(folder.join(format!("{name}.{end}")));
    let mut html = format!("<section id=\"{name}\" data-chapter=\"{}\"", chapter(name));
    match entry {
        None => html.push_str(" data-orphan"),
        Some(Entry { inspect: Some(command), .. }) => {
            let _ = write!(html, " data-inspect=\"{}\"", escaped(command));
        }
        Some(_) => {}
    }
    let _ = writeln!(html, ">\n<h2>{name}</h2>");
    if let Some(entry) = entry {
        let _ = writeln!(html, "<p>{}</p>", escaped(&entry.look));
    }
    for (kind, title) in [("expected", "accepted"), ("actual", "new")] {
        if let Ok(bytes) = file(&format!("{kind}.png")) {
            let data = base64::engine::general_purpose::STANDARD.encode(bytes);
            let _ = writeln!(
                html,
                "<img class=\"{kind}\" alt=\"{title}\" title=\"{title}\" src=\"data:image/png;base64,{data}\">"
            );
        }
    }
    let reason = file("reason.txt").unwrap_or_default();
    let _ = writeln!(html, "<pre>{}</pre>\n</section>", escaped(&String::from_utf8_lossy(&reason)));
    html
}

/// A text as it is written between tags or in an attribute.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}
