//! # Chapter 1: pixels
//!
//! **How does a program put a picture on a screen?** By giving every pixel a color, one at a time.
//! Everything in this book ends in one call: `framebuffer.set(x, y, color)`.
//!
//! New here: the framebuffer (`lib/framebuffer.rs`). Book: chapter 1.

use std::process::ExitCode;

use rasterbook::figure::{Chapter, Fit, Knob, Knobs, Variant, picture};
use rasterbook::{Color, Framebuffer, Rect};

pub(crate) const CHAPTER: Chapter = Chapter {
    name: "ch01_pixels",
    question: "How does a program put a picture on a screen?",
    variants: &[
        Variant::new(
            "pawn",
            pawn,
            "a pawn made of 16×22 pixels, in six colors, with the grid that a screen does not show",
        )
        .size(320, 440),
        Variant::with_knobs(
            "pixel",
            pixel,
            PIXEL,
            "one red pixel at (200, 200), counted from the lower left corner; try --zoom 12@200,200",
        )
        .source("section 1.4")
        .in_pixels(),
        Variant::new(
            "digit",
            digit,
            "a digit made of pixels that are lit or not, with the grid that a screen does not show",
        )
        .source("section 1.3, Figure 1-5")
        .size(320, 400),
        Variant::with_knobs(
            "subpixels",
            subpixels,
            SUBPIXELS,
            "the three lamps of each pixel on the left, the color that the eye makes of them on the right",
        )
        .source("section 1.2, Figures 1-1 and 1-3")
        .size(632, 208),
    ],
};

const PIXEL: &[Knob] = &[
    Knob::point(
        "place",
        [200.0, 200.0],
        "the pixel jumps from one whole position to the next: fractions are cut off",
    ),
    Knob::color(
        "color",
        Color::RED,
        "one color, made of three channels: with green as bright as red it is yellow",
    ),
];

// ANCHOR: pixel
/// One pixel: knobs say where it is, and in which color.
fn pixel(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    let (place, color) = (knobs.point("place"), knobs.color("color"));
    let (x, y) = (place.x as i32, place.y as i32);
    framebuffer.set(x, y, color);
}
// ANCHOR_END: pixel

/// A letter for each pixel, the highest row first: the outline, and four shades of wood.
const PAWN: [&str; 22] = [
    "................",
    "......oooo......",
    ".....ollmmo.....",
    "....olwlmmdo....",
    "....ollmmmdo....",
    "....olmmmddo....",
    ".....ommddo.....",
    "....oooooooo....",
    "...ollmmmmddo...",
    "....oooooooo....",
    ".....ollmdo.....",
    ".....ollmdo.....",
    ".....ollmdo.....",
    "....ollmmmdo....",
    "....olmmmddo....",
    "...ollmmmmddo...",
    "..ollmmmmmmddo..",
    "..oooooooooooo..",
    ".ollwmmmmmmmddo.",
    ".ollmmmmmmmmddo.",
    ".oooooooooooooo.",
    "................",
];

// ANCHOR: pawn
/// A pawn on a screen of 16×22 pixels, each shown as a block: of 20×20, if the picture has 320×440.
fn pawn(framebuffer: &mut Framebuffer) {
    picture::draw_enlarged(framebuffer, (16, 22), |screen| {
        for (y, row) in (0..).zip(PAWN.iter().rev()) {
            for (x, letter) in (0..).zip(row.chars()) {
                let color = match letter {
                    'o' => Color::rgb(62, 32, 20),
                    'd' => Color::rgb(140, 78, 40),
                    'm' => Color::rgb(192, 122, 66),
                    'l' => Color::rgb(228, 172, 110),
                    'w' => Color::rgb(255, 240, 210),
                    _ => Color::rgb(44, 62, 88),
                };
                screen.set(x, y, color);
            }
        }
    });
}
// ANCHOR_END: pawn

const DIGIT: [&str; 10] = [
    "........", "..####..", ".#....#.", "......#.", "...###..", "......#.", "......#.", ".#....#.",
    "..####..", "........",
];

// ANCHOR: digit
/// The digit 3 on a screen of 8×10 pixels.
fn digit(framebuffer: &mut Framebuffer) {
    picture::draw_enlarged(framebuffer, (8, 10), |screen| {
        for (y, row) in (0..).zip(DIGIT.iter().rev()) {
            for (x, lamp) in (0..).zip(row.chars()) {
                let color = if lamp == '#' { Color::WHITE } else { Color::BLACK };
                screen.set(x, y, color);
            }
        }
    });
}
// ANCHOR_END: digit

const COLORS: [[Color; 6]; 4] = [
    [
        Color::RED,
        Color::GREEN,
        Color::BLUE,
        Color::rgb(255, 255, 0),
        Color::rgb(0, 255, 255),
        Color::rgb(255, 0, 255),
    ],
    [
        Color::gray(255),
        Color::gray(204),
        Color::gray(153),
        Color::gray(102),
        Color::gray(51),
        Color::gray(0),
    ],
    [
        Color::rgb(255, 128, 0),
        Color::rgb(255, 192, 203),
        Color::rgb(128, 64, 0),
        Color::rgb(128, 0, 128),
        Color::rgb(0, 128, 128),
        Color::rgb(128, 160, 255),
    ],
    [
        Color::rgb(255, 0, 0),
        Color::rgb(255, 0, 51),
        Color::rgb(204, 0, 102),
        Color::rgb(153, 0, 153),
        Color::rgb(102, 0, 204),
        Color::rgb(0, 0, 255),
    ],
];

const SUBPIXELS: &[Knob] = &[Knob::color(
    "color",
    Color::RED,
    "the pixel at the upper left: each of its lamps is as bright as its channel",
)];

// ANCHOR: subpixels
/// A screen of 6×4 pixels: the lamps, and what they add up to. The upper left pixel has the knob's
/// color.
fn subpixels(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    const CELL: i32 = 52;
    let mut screen = COLORS;
    screen[0][0] = knobs.color("color");
    // Made for a picture of 632×208; in a larger one all rectangles are larger.
    let fit = Fit::new(framebuffer.rect(), [632.0, 208.0]);
    framebuffer.clear(Color::gray(30));
    for (row, colors) in (0..).zip(screen.iter().rev()) {
        for (column, &color) in (0..).zip(colors) {
            let (left, bottom) = (column * CELL, row * CELL);

            // Each lamp shines with the brightness that its channel says.
            let [red, green, blue] = color.channels();
            let lamps = [Color::rgb(red, 0, 0), Color::rgb(0, green, 0), Color::rgb(0, 0, blue)];
            for (i, lamp) in (0..).zip(lamps) {
                let left = left + 2 + i * 16;
                let rect =
                    Rect { left, bottom: bottom + 3, right: left + 14, top: bottom + CELL - 3 };
                framebuffer.fill(fit.rect(rect), lamp);
            }

            let left = left + 6 * CELL + 8;
            let rect = Rect { left, bottom, right: left + CELL, top: bottom + CELL };
            framebuffer.fill(fit.rect(rect), color);
        }
    }
}
// ANCHOR_END: subpixels

fn main() -> ExitCode {
    CHAPTER.main()
}
