//! The chapters' own tables, and the programs built from them.

#![allow(dead_code, reason = "the chapters' `main`s are not called")]

use rasterbook::figure::{Chapter, Variant};

/// Lists the chapters: includes each file as a module, and pairs its table with its program.
macro_rules! chapters {
    ($($path:literal $name:ident),* $(,)?) => {
        $(#[path = $path] mod $name;)*

        /// All chapters in the order of the book, each with the path of its program.
        pub(crate) const CHAPTERS: &[(&Chapter, &str)] =
            &[$((&$name::CHAPTER, env!(concat!("CARGO_BIN_EXE_", stringify!($name))))),*];
    };
}
chapters!(
    "../../chapters/ch01_pixels.rs" ch01_pixels,
    "../../chapters/ch02_dda_lines.rs" ch02_dda_lines,
    "../../chapters/ch02_triangles/main.rs" ch02_triangles,
    "../../chapters/ch03_barycentric.rs" ch03_barycentric,
    "../../chapters/ch04_projection.rs" ch04_projection,
    "../../chapters/ch05_perspective_correct/main.rs" ch05_perspective_correct,
    "../../chapters/ch06_z_buffer/main.rs" ch06_z_buffer,
    "../../chapters/ch07_clipping.rs" ch07_clipping,
    "../../chapters/ch08_cvv/main.rs" ch08_cvv,
    "../../chapters/ch09_pipeline.rs" ch09_pipeline,
    "../../chapters/ch10_matrices_lighting/main.rs" ch10_matrices_lighting,
);

/// All rows of all chapters' tables, each with the name of its program.
pub(crate) fn variants() -> impl Iterator<Item = (&'static str, &'static Variant)> {
    CHAPTERS.iter().flat_map(|(chapter, _)| chapter.variants.iter().map(|variant| (chapter.name, variant)))
}

/// A size so many times smaller than its own, for tests that would say the same of any size. A picture that is about single
/// pixels keeps its own: less would be a part of it.
pub(crate) fn smaller(variant: &Variant, times: u32) -> (u32, u32) {
    let (width, height) = variant.size;
    if variant.in_pixels { (width, height) } else { (width / times, height / times) }
}

/// A row of a chapter's table.
pub(crate) fn variant(chapter: &str, name: &str) -> &'static Variant {
    let (chapter, _) =
        CHAPTERS.iter().find(|(c, _)| c.name == chapter).unwrap_or_else(|| panic!("no {chapter}"));
    chapter.find(name).unwrap_or_else(|| panic!("{} has no {name}", chapter.name))
}
