//! Every picture of every chapter, drawn by the real program and compared pixel by pixel with the accepted one.
//!
//! Each variant is a test of its own, which fails if there is no accepted picture: `cargo test --test snapshots affine`.
//! One more sees that there is no picture without a variant.

#[path = "support/chapters.rs"]
mod chapters;
#[path = "support/pictures.rs"]
mod pictures;
#[path = "support/review.rs"]
mod review;

use std::collections::BTreeSet;
use std::path::Path;
use std::process::{Command, ExitCode};

use chapters::CHAPTERS;
use libtest_mimic::{Arguments, Failed, Trial};
use rasterbook::figure::Mistake;

fn main() -> ExitCode {
    // A failed comparison is told once, by its test.
    std::panic::set_hook(Box::new(|_| {}));
    let mut trials: Vec<Trial> = all_pictures().map(Picture::trial).collect();
    trials.push(Trial::test("no_snapshot_without_a_variant", no_orphan));
    let conclusion = libtest_mimic::run(&Arguments::from_args(), trials);
    if let Some(page) = review::write_page(&pictures::failure_folder()) {
        eprintln_page(&page);
    }
    conclusion.exit_code()
}

#[expect(clippy::print_stderr, reason = "the report of a test program")]
fn eprintln_page(page: &Path) {
    eprintln!("All pictures that wait for a review: {}", page.display());
}

/// A picture that some program can draw.
#[derive(Clone)]
struct Picture {
    program: &'static str,
    variant: &'static str,
    frame: Option<u32>,
    /// Whether it is a mistake beside its remedy, and where they differ.
    is_comparison: bool,
    name: String,
}

fn all_pictures() -> impl Iterator<Item = Picture> {
    let rows = CHAPTERS.iter().flat_map(|&(chapter, program)| {
        chapter.variants.iter().map(move |variant| (chapter, program, variant))
    });
    rows.flat_map(|(chapter, program, variant)| {
        let name = format!("{}__{}", chapter.name, variant.name);
        // Of an animation the first, a middle and the last frame.
        let frames = match variant.animation {
            None => vec![None],
            Some(animation) => [0, animation.frames / 2, animation.frames - 1].map(Some).to_vec(),
        };
        let picture = Picture { program, variant: variant.name, frame: None, is_comparison: false, name };
        let comparison = match variant.mistake {
            Mistake::RemediedBy(remedy) => {
                let name = format!("{}--{remedy}", picture.name);
                Some(Picture { is_comparison: true, name, ..picture.clone() })
            }
            Mistake::No | Mistake::WithoutRemedy => None,
        };
        let single = frames.into_iter().map(move |frame| {
            let at = frame.map_or_else(String::new, |frame| format!("@{frame:03}"));
            Picture { frame, name: format!("{}{at}", picture.name), ..picture.clone() }
        });
        single.chain(comparison)
    })
}

impl Picture {
    fn trial(self) -> Trial {
        Trial::test(self.name.clone(), move || {
            let png = self.draw()?;
            pictures::assert_picture(&self.name, png).map_err(Failed::from)
        })
    }

    /// Runs the program as a reader would, and takes the file that it wrote.
    fn draw(&self) -> Result<Vec<u8>, Failed> {
        let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{}.png", self.name));
        let mut command = Command::new(self.program);
        command.arg(self.variant).arg("--out").arg(&file);
        if let Some(frame) = self.frame {
            command.arg("--frame").arg(frame.to_string());
        }
        if self.is_comparison {
            command.arg("--compare");
        }
        let output = command.output()?;
        if !output.status.success() {
            return Err(String::from_utf8_lossy(&output.stderr).into_owned().into());
        }
        let png = std::fs::read(&file)?;
        std::fs::remove_file(&file)?;
        Ok(png)
    }
}

fn no_orphan() -> Result<(), Failed> {
    let wanted: BTreeSet<String> = all_pictures()
        .flat_map(|picture| [format!("{}.snap", picture.name), format!("{}.snap.png", picture.name)])
        .collect();
    let mut orphans = Vec::new();
    for entry in std::fs::read_dir(pictures::snapshot_folder())? {
        let name = entry?.file_name().to_string_lossy().into_owned();
        let is_pending = name.contains(".snap.new");
        if !is_pending && !wanted.contains(&name) {
            orphans.push(name);
        }
    }
    if orphans.is_empty() {
        return Ok(());
    }
    Err(format!("in tests/snapshots, but drawn by no variant (remove or rename): {}", orphans.join(", "))
        .into())
}
