//! Runs the commands that the pages and the README show, each once, as written.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Command;

use crate::{Errors, files, pages, read, repository};

/// Whether there is a test program of this name: a file, or a folder with a `main.rs`.
fn is_test(root: &Path, name: &str) -> bool {
    [format!("tests/{name}.rs"), format!("tests/{name}/main.rs")].iter().any(|path| root.join(path).is_file())
}

/// Runs what can be run, in a folder of its own, and says what was left out and why.
pub fn run() -> Result<(), Errors> {
    let root = repository();
    let folder = root.join("target/book/commands");
    let prepared = fs::remove_dir_all(&folder).or_else(|error| match error.kind() {
        std::io::ErrorKind::NotFound => Ok(()),
        _ => Err(error),
    });
    prepared
        .and_then(|()| copy(&root.join("assets"), &folder.join("assets")))
        .map_err(|error| vec![error.to_string()])?;

    let mut errors = Vec::new();
    let mut done = BTreeSet::new();
    let mut ran = 0;
    for page in pages() {
        for command in commands(&read(&page)) {
            if !done.insert(command.clone()) {
                continue;
            }
            let name = page.strip_prefix(&root).unwrap_or(&page).display();
            match task(&command) {
                Task::LeaveOut(why) => println!("left out, {why}: {command}"),
                Task::Test(name) if is_test(&root, &name) => {
                    println!("left out, a test: {command}");
                }
                Task::Test(_) => errors.push(format!("{name}: {command}: no such test")),
                Task::Run(words) => {
                    ran += 1;
                    if let Err(what) = execute(&root, &folder, &words) {
                        errors.push(format!("{name}: {command}\n{what}"));
                    }
                }
            }
        }
    }
    println!("{ran} commands run");
    if ran < 20 {
        errors.push("hardly a command was found".to_owned());
    }
    if errors.is_empty() { Ok(()) } else { Err(errors) }
}

/// The commands of a page: lines of `text` blocks and indented lines that begin with a program's name.
fn commands(page: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut fence = None;
    for line in page.lines() {
        if let Some(language) = line.trim_start().strip_prefix("```") {
            fence = if fence.is_some() { None } else { Some(language.trim()) };
            continue;
        }
        let line = match fence {
            Some("text" | "sh" | "console") => line,
            None if line.starts_with("    ") => line,
            _ => continue,
        };
        let command = line.split(" #").next().unwrap_or_default().trim();
        if command.starts_with("cargo ") || command == "cargo" {
            found.push(command.to_owned());
        }
    }
    found
}

enum Task {
    Run(Vec<String>),
    Test(String),
    LeaveOut(&'static str),
}

fn task(command: &str) -> Task {
    let words: Vec<String> = command.split_whitespace().map(ToOwned::to_owned).collect();
    // FILE, X,Y, N
    let is_placeholder = |word: &String| {
        let mut parts = word.split(|it: char| !it.is_ascii_alphabetic()).filter(|part| !part.is_empty());
        parts.any(|part| part.chars().all(|it| it.is_ascii_uppercase()))
    };
    if words.iter().any(is_placeholder) {
        return Task::LeaveOut("a pattern");
    }
    if command.contains(['|', '>', '"', '\'', '$', '…']) {
        return Task::LeaveOut("needs a shell");
    }
    if words.iter().any(|word| word == "--show") {
        return Task::LeaveOut("needs a terminal");
    }
    if words.iter().any(|word| word == "--window") {
        return Task::LeaveOut("needs a display");
    }
    if words.iter().any(|word| word == "--manifest-path") {
        return Task::LeaveOut("of another workspace");
    }
    match words.get(1).map(String::as_str) {
        Some("run" | "build") => Task::Run(words),
        Some("test") => match words.iter().position(|word| word == "--test").and_then(|at| words.get(at + 1))
        {
            Some(name) => Task::Test(name.clone()),
            None => Task::LeaveOut("all tests"),
        },
        _ => Task::LeaveOut("neither run nor test"),
    }
}

/// Runs a command of cargo with the project's manifest, in another folder.
fn execute(root: &Path, folder: &Path, words: &[String]) -> Result<(), String> {
    let output = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
        .arg(&words[1])
        .args(["--quiet", "--manifest-path"])
        .arg(root.join("Cargo.toml"))
        .args(&words[2..])
        .current_dir(folder)
        .output()
        .map_err(|error| error.to_string())?;
    if output.status.success() {
        return Ok(());
    }
    let streams = [output.stdout, output.stderr].concat();
    Err(String::from_utf8_lossy(&streams).into_owned())
}

fn copy(from: &Path, to: &Path) -> std::io::Result<()> {
    for file in files(from) {
        let target = to.join(file.strip_prefix(from).unwrap_or(&file));
        fs::create_dir_all(target.parent().unwrap_or(to))?;
        fs::copy(&file, target)?;
    }
    Ok(())
}
