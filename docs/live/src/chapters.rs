//! The chapters' own files, as they are.

#![allow(
    missing_docs,
    dead_code,
    clippy::pedantic,
    reason = "they are programs; their `main`s are not called here"
)]

use rasterbook::figure::Chapter;

macro_rules! chapters {
    ($($path:literal $name:ident),* $(,)?) => {
        $(#[path = $path] mod $name;)*

        /// All chapters, in the order of the book.
        pub(crate) static CHAPTERS: &[Chapter] = &[$($name::CHAPTER),*];
    };
}

chapters!(
    "../../../chapters/ch01_pixels.rs" ch01_pixels,
    "../../../chapters/ch02_dda_lines.rs" ch02_dda_lines,
    "../../../chapters/ch02_triangles/main.rs" ch02_triangles,
    "../../../chapters/ch03_barycentric.rs" ch03_barycentric,
    "../../../chapters/ch04_projection.rs" ch04_projection,
    "../../../chapters/ch05_perspective_correct/main.rs" ch05_perspective_correct,
    "../../../chapters/ch06_z_buffer/main.rs" ch06_z_buffer,
    "../../../chapters/ch07_clipping.rs" ch07_clipping,
    "../../../chapters/ch08_cvv/main.rs" ch08_cvv,
    "../../../chapters/ch09_pipeline.rs" ch09_pipeline,
    "../../../chapters/ch10_matrices_lighting/main.rs" ch10_matrices_lighting,
);
