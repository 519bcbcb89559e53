//! # Chapter 6: the z-buffer
//!
//! **Which surface is in front?** The painter draws what is far first. That fails as soon as two surfaces pass through
//! one another. The z-buffer decides anew at every pixel.
//!
//! New here: a depth for each pixel, and the depth test (`lib/depth.rs`). The depth is interpolated like any other
//! value, by chapter 5's formula. The figures: `surfaces.rs`, `precision.rs`, `reversed.rs`, `frames.rs`. Book: chapter 6.

mod frames;
mod precision;
mod reversed;
mod surfaces;

use std::process::ExitCode;

use rasterbook::figure::{Chapter, Variant};

pub(crate) const CHAPTER: Chapter = Chapter {
    name: "ch06_z_buffer",
    question: "Which surface is in front?",
    variants: &[
        Variant::with_knobs("intersecting", surfaces::intersecting, surfaces::PIERCING, "the same with a z-buffer: each triangle is seen where it is nearer, and they meet in a line")
            .source("section 6.2, Figure 6-3"),
        Variant::with_knobs("z-buffer", surfaces::z_buffer, surfaces::SQUARES, "a tilted square and one that faces us: the tilted one is drawn first, and still in front where it is nearer")
            .source("section 6.2, Figure 6-5"),
        Variant::new("painter", surfaces::painter, "three squares drawn from far to near, without a depth test: each covers what is behind it")
            .source("section 6.1, Figure 6-2"),
        Variant::with_knobs("painter-red-first", surfaces::painter_red_first, surfaces::PIERCING, "two triangles that pierce each other, red drawn first: green covers red also where red is nearer")
            .source("section 6.1, Figure 6-3").remedied_by("intersecting"),
        Variant::with_knobs("painter-green-first", surfaces::painter_green_first, surfaces::PIERCING, "the same, green drawn first: no order is right")
            .source("section 6.1, Figure 6-3").remedied_by("intersecting"),
        Variant::with_knobs("depth", precision::depth, precision::STEPS, "a z-buffer, as hardware stores it, in 16 grays: black is near (1), white is far (12); most of them lie close by"),
        Variant::with_knobs("w-buffer", precision::w_buffer, precision::STEPS, "the same scene with w stored, in 16 grays: black is near (1), white is far (12); each stands for the same distance"),
        Variant::with_knobs("steps", precision::steps, precision::ALONG_AXIS, "the distances that 4 bits tell apart, the eye on the left: above by a z-buffer, below by a w-buffer; in the orange step red and green have one depth")
            .size(640, 320),
        Variant::with_knobs("z-fighting", reversed::z_fighting, reversed::CLOSE, "red plates 0.005 in front of green boards, at the distances that stand below: from 100 on ordinary depths are too coarse, and green shows through").remedied_by("reversed"),
        Variant::with_knobs("reversed", reversed::reversed, reversed::CLOSE, "the same with 1 at the near plane and 0 at the far plane: every red plate is whole"),
        Variant::with_knobs("uncleared", frames::uncleared, frames::FRAMES, "the second frame of a moving square, depths of the first not cleared: the old square cuts a hole into the new one")
            .source("section 6.2, section 9.4.1").remedied_by("cleared"),
        Variant::with_knobs("cleared", frames::cleared, frames::FRAMES, "the same frame, its depths cleared first: the square is whole").source("section 6.2"),
    ],
};

fn main() -> ExitCode {
    CHAPTER.main()
}
