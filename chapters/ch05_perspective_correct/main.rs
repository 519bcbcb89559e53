//! # Chapter 5: perspective-correct interpolation
//!
//! **Why does a texture bend when a surface is tilted?** Because equal steps on the screen are not equal steps in
//! space. The scanline walk stays as it is; what is stepped along its edges is now t′, the parameter
//! on the screen, and one option says what a value at t′ is.
//!
//! New here: w (the book's ω) and the formula for V_p (`lib/interpolate.rs`). The figures: `from_above.rs`, `square.rs`,
//! `floor.rs`. Book: chapter 5.

mod floor;
mod from_above;
mod square;

use std::process::ExitCode;

use rasterbook::figure::{Chapter, Variant};

pub(crate) const CHAPTER: Chapter = Chapter {
    name: "ch05_perspective_correct",
    question: "Why does a texture bend when a surface is tilted?",
    variants: &[
        Variant::with_knobs("floor", floor::floor, floor::FLOOR, "a checkered floor to the horizon: every line is straight, and the squares get smaller towards the horizon"),
        Variant::with_knobs("correct", square::correct, square::TILTED, "the tilted square, interpolated in space: the line between the colors is straight")
            .source("section 5.4, Figure 5-8"),
        Variant::with_knobs("affine", square::affine, square::TILTED, "the same square, interpolated on the screen: the line between the colors breaks at the diagonal")
            .source("section 5.3, Figure 5-3")
            .remedied_by("correct"),
        Variant::new("facing", square::facing, "a projected triangle that faces us: chapter 3 is still enough").source("section 5.1, Figure 5-1"),
        Variant::new("square", square::square, "two triangles make a square that faces us: no seam, no bend").source("section 5.2, Figure 5-2"),
        Variant::with_knobs("reciprocal", square::reciprocal, square::TILTED, "the tilted square again, by way of 1/w and V/w: compare it with 'correct', not one pixel differs")
            .source("section 5.5.4"),
        Variant::with_knobs("barycentric", square::barycentric, square::TILTED, "the tilted square by weights: those of areas on the screen, each divided by its vertex's w")
            .source("first note"),
        Variant::with_knobs("from-above", from_above::from_above, from_above::FROM_ABOVE, "the eye, the image plane and a line from above: equal steps on the line are not equal on the plane; below the plane what is seen, and what affine interpolation makes of it")
            .source("section 5.4"),
        Variant::with_knobs("floor-affine", floor::floor_affine, floor::FLOOR, "the same two triangles, interpolated on the screen: the floor folds along the diagonal")
            .remedied_by("floor"),
    ],
};

fn main() -> ExitCode {
    CHAPTER.main()
}
