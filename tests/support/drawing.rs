//! A small picture of a model, drawn by the program of chapter 10 in a folder of its own.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// An empty folder for one drawing of one test file.
pub(crate) fn folder(test: &str, name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test).join(name.replace(' ', "_"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a folder in target");
    folder
}

/// Draws `picture.png` in that folder.
pub(crate) fn draw(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_ch10_matrices_lighting"))
        .args(["lit", "--size", "64x48", "--out", "picture.png"])
        .args(arguments)
        .current_dir(folder)
        .output()
        .expect("the program starts")
}

pub(crate) fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}
