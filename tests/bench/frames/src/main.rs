//! How long a frame of each variant takes, by each rasterizer where there is a choice, the longest first.
//!
//! ```text
//! cargo run --release --manifest-path tests/bench/frames/Cargo.toml [-- WORD…]
//! ```
//!
//! With words, only variants whose names contain one of them.

use std::io::Write;
use std::process::ExitCode;
use std::time::Instant;

use rasterbook::figure::{Given, RasterizerChoice, Scene, Variant};
use rasterbook_bench::timing;

#[path = "../../../../docs/live/src/chapters.rs"]
mod chapters;

/// How often a picture is drawn.
const ROUNDS: usize = 9;
/// A window's size; a variant that is about single pixels has its own.
const SIZE: (u32, u32) = (640, 480);

/// Milliseconds that pictures took.
struct Frames {
    name: String,
    first: f64,
    median: f64,
    longest: f64,
}

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let mut all: Vec<Frames> = chapters::CHAPTERS
        .iter()
        .flat_map(|chapter| chapter.variants)
        .filter(|variant| words.is_empty() || words.iter().any(|word| variant.name.contains(word.as_str())))
        .flat_map(|variant| rasterizers(variant).into_iter().map(|rasterizer| measured(variant, rasterizer)))
        .collect();
    all.sort_by(|a, b| b.median.total_cmp(&a.median));
    let table = all.iter().map(|Frames { name, first, median, longest }| {
        format!("{name:<40}{first:>9.1}{median:>9.1}{longest:>9.1}\n")
    });
    let head = format!("{:<40}{:>9}{:>9}{:>9}\n", "ms", "first", "median", "longest");
    let text: String = std::iter::once(head).chain(table).collect();
    // Nobody may read on.
    match std::io::stdout().write_all(text.as_bytes()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(_) => ExitCode::FAILURE,
    }
}

/// Those that can draw a variant; none in particular where it has no choice.
fn rasterizers(variant: &Variant) -> Vec<Option<RasterizerChoice>> {
    match variant.rasterizer {
        Some(_) => RasterizerChoice::ALL.iter().copied().map(Some).collect(),
        None => vec![None],
    }
}

fn measured(variant: &Variant, rasterizer: Option<RasterizerChoice>) -> Frames {
    let scene = Scene::new(variant, &Given::default()).expect("the chapters' own assets");
    let size = if variant.in_pixels { scene.size } else { SIZE };
    let scene = Scene { size, rasterizer: rasterizer.unwrap_or(scene.rasterizer), ..scene };
    let frames = variant.animation.map_or(1, |animation| animation.frames);
    let mut times: Vec<f64> = (0..ROUNDS)
        .map(|round| {
            let scene = Scene { frame: round as u32 % frames, ..scene.clone() };
            let start = Instant::now();
            std::hint::black_box(scene.draw());
            start.elapsed().as_secs_f64() * 1e3
        })
        .collect();
    let by = rasterizer.map(|rasterizer| format!(" {}", rasterizer.name())).unwrap_or_default();
    let first = times.remove(0);
    let longest = times.iter().copied().fold(0.0, f64::max);
    Frames { name: format!("{}{by}", variant.name), first, median: timing::median(times), longest }
}
