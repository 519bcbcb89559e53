//! # Chapter 2, second part: triangles
//!
//! **Which pixels belong to a triangle?** Everything that follows is made of triangles. One is filled row by row:
//! split it at its middle vertex, walk up two edges of each half, and fill what lies between them.
//!
//! New here: signed area (`lib/area.rs`) and the scanline walk (`lib/scanline.rs`), which emits spans and knows no
//! color. Beyond the book: edge functions (`lib/exact/edge.rs`), which test each pixel for coverage, and several
//! samples in a pixel (`lib/exact/samples.rs`). The figures: `scanlines.rs`, `edges.rs`, `samples.rs`. Book: section 2.2.

mod edges;
mod samples;
mod scanlines;

use std::process::ExitCode;

use rasterbook::figure::{Chapter, Variant};

pub(crate) const CHAPTER: Chapter = Chapter {
    name: "ch02_triangles",
    question: "Which pixels belong to a triangle?",
    variants: &[
        Variant::with_knobs(
            "split",
            scanlines::split_in_two,
            scanlines::SPLIT,
            "the two halves, and the new point P′ on the long edge at the height of the middle vertex",
        )
        .source("section 2.2, Figure 2-3"),
        Variant::with_knobs("flat", scanlines::flat, scanlines::FLAT, "one triangle in one color").source("section 2.2"),
        Variant::with_knobs(
            "overshoot",
            scanlines::overshoot,
            scanlines::TREE,
            "rows that shoot out of the tree wherever an edge is nearly horizontal",
        )
        .source("section 2.2, Figure 2-4")
        .size(320, 320)
        .remedied_by("clamped"),
        Variant::with_knobs(
            "clamped",
            scanlines::clamped,
            scanlines::TREE,
            "the same tree with x kept between the ends of its edge: nothing outside",
        )
        .source("section 2.2")
        .size(320, 320),
        Variant::with_knobs(
            "shared-edge",
            edges::shared_edge,
            edges::HEXAGON,
            "six triangles added up: yellow and red pixels are drawn twice or more, along every seam",
        )
        .remedied_by("top-left"),
        Variant::with_knobs("top-left", edges::top_left, edges::HEXAGON, "the same six triangles by edge functions and the top-left rule: each pixel is drawn once, and there is no hole"),
        Variant::with_knobs("two-rules", edges::two_rules, edges::TWO_RULES, "one triangle by the book's rule (left) and by the top-left rule (right), each with the points that it asks; orange is taken by one rule alone")
            .size(784, 288),
        Variant::with_knobs("bounding-box", edges::bounding_box, edges::BOUNDING_BOX, "the box around a triangle: outside, the tint says which edge has the pixel on its wrong side; where none has is the triangle")
            .source("second, third and fourth note"),
        Variant::with_knobs("one-sample", samples::one_sample, samples::SCENE, "one sample in the middle of each pixel: jaggies along the edges, a broken line where triangles pierce each other, and moiré where stripes are narrower than pixels")
        .size(560, 420),
        Variant::with_knobs("supersampled", samples::supersampled, samples::SCENE, "2×2 samples a pixel, each with its own color and depth, averaged: three shades along every edge; the stripes become an uneven gray")
        .size(560, 420)
            .source("fourth note"),
        Variant::with_knobs("supersampled-16", samples::supersampled_16, samples::SCENE, "4×4 samples a pixel: smoother still; a faint moiré is left of the stripes")
        .size(560, 420),
        Variant::with_knobs("multisampled", samples::multisampled, samples::SCENE, "four samples a pixel for coverage and depth, one color for all of them: smooth edges, but the moiré of the stripes is back")
        .size(560, 420),
        Variant::of_model_in_plane("facets", scanlines::facets, ["pawn.obj", "wood.png"], "a model of flat triangles, each as bright as it faces us; back faces are left out")
            .size(480, 480),
    ],
};

fn main() -> ExitCode {
    CHAPTER.main()
}
