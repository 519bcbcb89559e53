//! # Chapter 8: the canonical view volume
//!
//! **What of the world gets into the picture?** Whatever the size of the screen, what is seen lies between −1 and 1 in
//! all three directions, once it has been projected and divided. Six planes cut away the rest.
//!
//! New here: the frustum and the viewport (`lib/transform.rs`), and clipping with six planes (`lib/clip.rs`).
//! The figures: `clipped.rs`, `volume.rs`, `outside.rs`. Book: chapter 8.

mod clipped;
mod outside;
mod volume;

use std::process::ExitCode;

use rasterbook::figure::{Chapter, Variant};

pub(crate) const CHAPTER: Chapter = Chapter {
    name: "ch08_cvv",
    question: "What of the world gets into the picture?",
    variants: &[
        Variant::with_knobs("clipped", clipped::clipped, clipped::BORDERS, "a triangle that is larger than the view, one vertex nearer than the near plane: cut off at the borders of the picture")
            .source("section 8.3, Figure 8-9"),
        Variant::with_knobs("ndc", clipped::ndc, clipped::BORDERS, "a triangle that fits: the frustum's borders become the borders of the picture").source("section 8.2, Figure 8-6"),
        Variant::with_knobs("planes", volume::planes, volume::PLANES, "the polygon before clipping and after each plane: left, right, bottom, top, near, far; the square is the view")
            .source("section 8.3, Table 8-1").size(800, 400),
        Variant::with_knobs("frustum", volume::frustum, volume::DEPTHS, "left: 35 points in the view volume from above, the eye at the bottom; right: the same in NDC. Equal steps in depth crowd together far away")
            .source("section 8.1, Figure 8-4").size(760, 400),
        Variant::with_knobs("outside", outside::outside, outside::OUTSIDE, "left: the picture; right: the same world and the view frustum from outside. What clipping leaves is bright, what it cuts away is dim")
            .source("section 8.1").size(808, 300),
        Variant::with_knobs("divide-first", clipped::divide_first, clipped::BEGIN, "a floor that passes under the eye, tested after the divide: behind us the comparison is reversed, and the floor is cut off far in front of our feet")
            .source("section 8.3").remedied_by("clip-first"),
        Variant::with_knobs("clip-first", clipped::clip_first, clipped::BEGIN, "the same floor, clipped before the divide: it comes up to the near plane, at the lower border").source("section 8.3"),
        Variant::with_knobs("zero-to-one", clipped::zero_to_one, clipped::BORDERS, "Direct3D's range, 0 ≤ z ≤ w: another projection, another near plane, the same picture as 'clipped'"),
    ],
};

fn main() -> ExitCode {
    CHAPTER.main()
}
