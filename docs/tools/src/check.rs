//! Whether the built book is whole: every link leads somewhere, every picture is ours, nothing comes from elsewhere,
//! and every program and module of the repository is named.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Component, Path, PathBuf};

use crate::html::{Tag, tags};
use crate::{Errors, files, pages, read, repository, text};

/// Checks the book in a folder.
pub fn run(book: &Path) -> Result<(), Errors> {
    let mut errors = links(book);
    errors.extend(mentions());
    errors.extend(unused_figures());
    errors.extend(accidental_lists());
    errors.extend(text::run());
    if errors.is_empty() { Ok(()) } else { Err(errors) }
}

fn links(book: &Path) -> Errors {
    let mut errors = Vec::new();
    let mut tags_of: BTreeMap<PathBuf, Vec<Tag>> = BTreeMap::new();
    for path in files(book).into_iter().filter(|path| path.extension().is_some_and(|it| it == "html")) {
        let name = path.strip_prefix(book).expect("a file of the book").to_owned();
        tags_of.insert(name, tags(&read(&path)));
    }
    let mut ids: BTreeMap<&Path, BTreeSet<&str>> = BTreeMap::new();
    for (page, tags) in &tags_of {
        let of_page = ids.entry(page).or_default();
        for id in tags.iter().filter_map(|tag| tag.get("id")) {
            // The page that is made for printing has all the others in it.
            if !of_page.insert(id) && page != Path::new("print.html") {
                errors.push(format!("{}: the id {id} is there twice", page.display()));
            }
        }
    }
    let mut count = 0;
    for (page, tags) in &tags_of {
        for tag in tags {
            for target in ["href", "src", "srcset", "poster"].iter().filter_map(|name| tag.get(name)) {
                count += 1;
                if let Err(what) = link(book, page, tag, target, &ids) {
                    errors.push(format!("{}: {target}: {what}", page.display()));
                }
            }
        }
    }
    println!("{} pages, {count} links", tags_of.len());
    if tags_of.len() < 10 || count < 100 {
        errors.push(format!("{}: hardly a book", book.display()));
    }
    errors
}

/// Follows one link.
fn link(
    book: &Path,
    page: &Path,
    tag: &Tag,
    target: &str,
    ids: &BTreeMap<&Path, BTreeSet<&str>>,
) -> Result<(), &'static str> {
    if let Some((scheme, _)) = target.split_once("://") {
        return match (scheme, tag.name.as_str()) {
            ("https", "a") => Ok(()),
            ("https", _) => Err("comes from the network"),
            _ => Err("not https"),
        };
    }
    // mdBook's own: the base of the page for links that lead nowhere.
    if tag.name == "base" || target.starts_with("data:") {
        return Ok(());
    }
    let (file, fragment) = target.split_once('#').unwrap_or((target, ""));
    let file = decode(file.split('?').next().unwrap_or_default());
    let path = if file.is_empty() {
        page.to_owned()
    } else {
        inside(&page.with_file_name(file)).ok_or("leads out of the book")?
    };
    if !book.join(&path).is_file() {
        return Err("no such file");
    }
    if tag.name == "img" && !is_ours(&path) {
        return Err("neither a snapshot nor a drawing");
    }
    if !fragment.is_empty() {
        let known = ids.get(path.as_path()).ok_or("a place in something that is no page")?;
        if !known.contains(decode(fragment).as_str()) {
            return Err("no such place");
        }
    }
    Ok(())
}

fn is_ours(picture: &Path) -> bool {
    let name = picture.to_string_lossy().replace('\\', "/");
    (name.starts_with("files/tests/snapshots/") && name.ends_with(".snap.png"))
        || (name.starts_with("figures/") && name.ends_with(".svg"))
}

/// A path without `..`, unless it leads out.
fn inside(path: &Path) -> Option<PathBuf> {
    let mut result = PathBuf::new();
    for component in path.components() {
        match component {
            Component::ParentDir => result.pop().then_some(())?,
            Component::Normal(name) => result.push(name),
            Component::CurDir => {}
            _ => return None,
        }
    }
    Some(result)
}

/// Without `%20` and the like.
fn decode(text: &str) -> String {
    let mut bytes = Vec::new();
    let mut rest = text.as_bytes();
    while let [first, after @ ..] = rest {
        let hex = (*first == b'%')
            .then(|| after.get(..2).and_then(|it| std::str::from_utf8(it).ok()))
            .flatten()
            .and_then(|it| u8::from_str_radix(it, 16).ok());
        bytes.push(hex.unwrap_or(*first));
        rest = if hex.is_some() { &after[2..] } else { after };
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

/// Every program and every public module of the library is named on a page.
fn mentions() -> Errors {
    let root = repository();
    let text: String =
        pages().iter().filter(|page| !page.ends_with("README.md")).map(|page| read(page)).collect();
    let mut errors = Vec::new();
    for line in read(&root.join("lib/lib.rs")).lines() {
        let Some(module) = line.strip_prefix("pub mod ").and_then(|it| it.strip_suffix(';')) else {
            continue;
        };
        if ![format!("lib/{module}.rs"), format!("lib/{module}/")].iter().any(|name| text.contains(name)) {
            errors.push(format!("no page names lib/{module}.rs"));
        }
    }
    for program in read(&root.join("Cargo.toml")).split("[[bin]]").skip(1) {
        let path = program.lines().find_map(|line| line.strip_prefix("path = \"")).unwrap_or_default();
        let path = path.trim_end_matches('"');
        let name = path.trim_start_matches("chapters/").trim_end_matches(".rs").trim_end_matches("/main");
        if path.is_empty() || !text.contains(&format!("cargo run --bin {name}")) {
            errors.push(format!("no page runs {name}"));
        }
    }
    errors
}

/// Every drawing is shown.
fn unused_figures() -> Errors {
    let root = repository();
    let text: String = pages().iter().map(|page| read(page)).collect();
    let name = |path: &PathBuf| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    files(&root.join("docs/src/figures"))
        .iter()
        .map(name)
        .filter(|name| !text.contains(&format!("figures/{name}")))
        .map(|name| format!("no page shows docs/src/figures/{name}"))
        .collect()
}

/// A line of a paragraph that begins with a number and a point, or with a dash, would begin a list.
fn accidental_lists() -> Errors {
    let mut errors = Vec::new();
    for page in pages() {
        let text = read(&page);
        let mut in_code = false;
        let mut in_text = false;
        for (index, line) in text.lines().enumerate() {
            in_code ^= line.trim_start().starts_with("```");
            if in_text && !in_code && ["1. ", "- ", "+ ", "* "].iter().any(|sign| line.starts_with(sign)) {
                errors.push(format!("{}:{}: begins a list within a paragraph", page.display(), index + 1));
            }
            // Text of a list is indented.
            in_text = line.starts_with(|it: char| it.is_alphanumeric() || "*`([".contains(it))
                && !line.starts_with("* ")
                && line.split_once(". ").is_none_or(|(number, _)| number.parse::<u32>().is_err());
        }
    }
    errors
}
