//! Every picture of every chapter, drawn by the real program and compared pixel by pixel with the accepted one.
//!
//! Each variant is a test of its own, which fails if there is no accepted picture: `cargo test --test snapshots affine`.
//! One more sees that there is no picture without a variant.

#[path = "support/pictures.rs"]
mod pictures;
#[path = "support/review.rs"]
mod review;
#[path = "support/trials.rs"]
mod trials;

use std::collections::BTreeSet;
use std::error::Error;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use pictures::Outcome;
use rasterbook::program::PROGRAMS;
use serde_json::Value;
use trials::{Options, Trial};

fn main() -> Result<ExitCode, Box<dyn Error>> {
    // A failed comparison is reported once, by its test.
    std::panic::set_hook(Box::new(|_| {}));
    let options = Options::from_args(std::env::args_os().skip(1));
    let accepted = Arc::new(Accepted::default());
    let drawn =
        all_pictures().map_err(|reason| format!("the programs do not say what they can draw: {reason}"))?;
    let trial = |picture: &Picture| picture.clone().trial(Arc::clone(&accepted));
    let mut trials: Vec<Trial> = drawn.iter().map(trial).collect();
    let wanted = names_of_files(&drawn);
    trials.push(Trial::new("no_snapshot_without_a_variant", move || no_orphan(&wanted)));
    let conclusion = trials::run(&options, &trials)?;
    if options.is_list {
        return Ok(conclusion);
    }
    match review_page(&drawn) {
        Ok(page) => eprint_summary(&(accepted.summary() + &page)),
        Err(error) => eprint_summary(&format!("The page for the review cannot be written: {error}\n")),
    }
    Ok(conclusion)
}

#[expect(clippy::print_stderr, reason = "the report of a test program")]
fn eprint_summary(summary: &str) {
    eprint!("{summary}");
}

/// How many pictures this run has accepted.
#[derive(Default)]
struct Accepted {
    replaced: AtomicUsize,
    added: AtomicUsize,
}

impl Accepted {
    fn count(&self, outcome: Outcome) {
        match outcome {
            Outcome::Equal | Outcome::Waiting => {}
            Outcome::Replaced => _ = self.replaced.fetch_add(1, Ordering::Relaxed),
            Outcome::Added => _ = self.added.fetch_add(1, Ordering::Relaxed),
        }
    }

    /// How many were accepted and where to look; empty if none were.
    fn summary(&self) -> String {
        let [replaced, added] = [&self.replaced, &self.added].map(|count| count.load(Ordering::Relaxed));
        if replaced + added == 0 {
            return String::new();
        }
        let folder = pictures::snapshot_folder();
        format!(
            "Accepted: {} replaced, {added} added, in {folder}\n\
             Look at each of them before you commit. Their names: git status --short {folder}\n",
            numbered(replaced, "picture"),
            folder = folder.display()
        )
    }
}

/// A number of things, such as `1 picture` or `2 pictures`.
fn numbered(count: usize, thing: &str) -> String {
    format!("{count} {thing}{}", if count == 1 { "" } else { "s" })
}

/// How one accepts all pictures, in the shell of this system.
const ACCEPT_ALL: &str = if cfg!(windows) {
    "$env:INSTA_UPDATE=\"always\"; cargo test --test snapshots; Remove-Item Env:INSTA_UPDATE"
} else {
    "INSTA_UPDATE=always cargo test --test snapshots"
};

/// Writes the page of all pictures that wait for a review, and says how to go on; empty if none waits.
fn review_page(drawn: &[Picture]) -> std::io::Result<String> {
    pictures::forget_others(&drawn.iter().map(|picture| picture.name.as_str()).collect());
    let failures = pictures::failures();
    let entries: Vec<review::Entry> = drawn.iter().map(Picture::entry).collect();
    let folder = pictures::failure_folder();
    let Some(page) = review::write_page(&folder, &failures, &entries)? else {
        return Ok(String::new());
    };
    let mut summary = format!("{} to review: {}\n", numbered(failures.len(), "picture"), page.display());
    let _ = writeln!(
        summary,
        "Of each that changed, NAME.report.png in that folder is expected | difference | actual."
    );
    let _ = writeln!(
        summary,
        "If all new pictures are right, accept them, then look at what git status --short says:"
    );
    let _ = writeln!(summary, "    {ACCEPT_ALL}");
    Ok(summary)
}

/// A picture that some program can draw.
#[derive(Clone)]
struct Picture {
    /// The name of the program.
    program: &'static str,
    variant: String,
    /// What to look for.
    look: String,
    frame: Option<u64>,
    /// Whether it is a mistake beside its remedy, and where they differ.
    is_comparison: bool,
    name: String,
}

/// Where a program is: beside the first one.
fn path_of(program: &str) -> PathBuf {
    let first = Path::new(env!("CARGO_BIN_EXE_ch01_pixels"));
    first.with_file_name(format!("{program}{}", std::env::consts::EXE_SUFFIX))
}

/// What the programs say that they can draw.
fn all_pictures() -> Result<Vec<Picture>, Box<dyn Error>> {
    let mut pictures = vec![];
    for program in &PROGRAMS {
        let output = Command::new(path_of(program.name)).args(["--list", "--format", "json"]).output()?;
        let list: Value = serde_json::from_slice(&output.stdout)?;
        let variants = list["variants"].as_array().ok_or("a list without variants")?;
        pictures.extend(variants.iter().flat_map(|variant| pictures_of(program.name, variant)));
    }
    Ok(pictures)
}

/// The pictures of a variant, from its line in the list.
fn pictures_of(program: &'static str, variant: &Value) -> Vec<Picture> {
    let [name, look] = ["name", "look"].map(|key| variant[key].as_str().unwrap_or_default().to_owned());
    let picture = Picture {
        program,
        name: format!("{program}__{name}"),
        variant: name,
        look,
        frame: None,
        is_comparison: false,
    };
    // Of an animation the first, a middle and the last frame.
    let mut pictures = match variant["animation"]["frames"].as_u64() {
        None => vec![picture.clone()],
        Some(frames) => [0, frames / 2, frames - 1]
            .map(|frame| Picture {
                frame: Some(frame),
                name: format!("{}@{frame:03}", picture.name),
                ..picture.clone()
            })
            .to_vec(),
    };
    if let Some(remedy) = variant["remedy"].as_str() {
        let name = format!("{}--{remedy}", picture.name);
        pictures.push(Picture { is_comparison: true, name, ..picture });
    }
    pictures
}

impl Picture {
    fn trial(self, accepted: Arc<Accepted>) -> Trial {
        Trial::new(self.name.clone(), move || {
            let png = match self.draw() {
                Ok(png) => png,
                Err(reason) => {
                    pictures::report_undrawn(&self.name, &format!("no new picture was drawn: {reason}"))?;
                    return Err(reason);
                }
            };
            accepted.count(pictures::assert_picture(&self.name, &png)?);
            Ok(())
        })
    }

    /// What follows the program's name on the command line, but for where to draw.
    fn arguments(&self) -> Vec<String> {
        let mut arguments = vec![self.variant.clone()];
        if let Some(frame) = self.frame {
            arguments.extend(["--frame".to_owned(), frame.to_string()]);
        }
        if self.is_comparison {
            arguments.push("--compare".to_owned());
        }
        arguments
    }

    /// Runs the program as a reader would, and takes the file that it wrote.
    fn draw(&self) -> Result<Vec<u8>, String> {
        let file = pictures::drawing_folder().join(format!("{}.png", self.name));
        let mut command = Command::new(path_of(self.program));
        command.args(self.arguments()).arg("--out").arg(&file);
        let output = command.output().map_err(|error| format!("{}: {error}", self.program))?;
        if !output.status.success() {
            return Err(String::from_utf8_lossy(&output.stderr).trim_end().to_owned());
        }
        let png = std::fs::read(&file).and_then(|png| std::fs::remove_file(&file).map(|()| png));
        png.map_err(|error| format!("{}: {error}", file.display()))
    }

    fn entry(&self) -> review::Entry {
        let command = format!("cargo run --bin {} -- {} --inspect", self.program, self.arguments().join(" "));
        review::Entry {
            name: self.name.clone(),
            look: self.look.clone(),
            // The pixels of a comparison belong to three pictures.
            inspect: (!self.is_comparison).then_some(command),
        }
    }
}

/// The files that belong to these pictures.
fn names_of_files(pictures: &[Picture]) -> BTreeSet<String> {
    let names = |picture: &Picture| [".snap", ".snap.png"].map(|end| format!("{}{end}", picture.name));
    pictures.iter().flat_map(names).collect()
}

fn no_orphan(wanted: &BTreeSet<String>) -> Result<(), String> {
    let folder = pictures::snapshot_folder();
    let failure = |error| format!("{}: {error}", folder.display());
    let mut orphans = Vec::new();
    for entry in std::fs::read_dir(&folder).map_err(failure)? {
        let name = entry.map_err(failure)?.file_name().to_string_lossy().into_owned();
        let is_pending = name.contains(".snap.new");
        if !is_pending && !wanted.contains(&name) {
            if let Some(picture) = name.strip_suffix(".snap.png") {
                pictures::report_undrawn(picture, "no variant draws it: remove or rename it")?;
            }
            orphans.push(name);
        }
    }
    if orphans.is_empty() {
        return Ok(());
    }
    Err(format!("in tests/snapshots, but drawn by no variant (remove or rename): {}", orphans.join(", ")))
}
