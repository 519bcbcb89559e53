//! What the book needs beside mdBook.
//!
//! - Without arguments: a preprocessor. mdBook hands it the book as JSON and takes it back changed.
//! - `check FOLDER`: whether the built book in that folder is whole.
//! - `commands`: runs the commands that the pages and the README show.
//!
//! Run by `docs/book.toml` and `.ci/docs`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

mod check;
mod commands;
mod html;
mod preprocess;
mod text;

/// What went wrong, one line each.
type Errors = Vec<String>;

/// The checkout.
fn repository() -> PathBuf {
    let tools = Path::new(env!("CARGO_MANIFEST_DIR"));
    tools.ancestors().nth(2).expect("docs/tools lies in the checkout").to_owned()
}

/// All files below a folder, sorted.
fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            found.extend(files(&path));
        } else {
            found.push(path);
        }
    }
    found.sort();
    found
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The pages as they are written, and the README.
fn pages() -> Vec<PathBuf> {
    let mut pages = files(&repository().join("docs/src"));
    pages.retain(|path| path.extension().is_some_and(|it| it == "md"));
    pages.push(repository().join("README.md"));
    pages
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let result = match arguments.as_slice() {
        [] => preprocess::run(),
        ["supports", renderer] => return ExitCode::from(u8::from(*renderer != "html")),
        ["check", folder] => check::run(Path::new(folder)),
        ["commands"] => commands::run(),
        _ => Err(vec![format!("no such task: {arguments:?}")]),
    };
    let errors = result.err().unwrap_or_default();
    for error in &errors {
        eprintln!("error: {error}");
    }
    ExitCode::from(u8::from(!errors.is_empty()))
}
