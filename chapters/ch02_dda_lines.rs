//! # Chapter 2, first part: lines
//!
//! **Which pixels belong to a line between two points?** A line has no width and pixels have no gaps: one coordinate
//! is stepped pixel by pixel, and the other one follows. Which of the two is stepped, that is the question.
//!
//! New here: the digital differential analyzer, DDA (`lib/line.rs`). Book: section 2.1.

use std::f64::consts::PI;
use std::process::ExitCode;

use glam::{DVec2, DVec3, dvec2};
use rasterbook::figure::{Chapter, Fit, Knob, Knobs, Subject, Variant};
use rasterbook::line::{StepAxis, dda};
use rasterbook::{Color, Framebuffer};

pub(crate) const CHAPTER: Chapter = Chapter {
    name: "ch02_dda_lines",
    question: "Which pixels belong to a line between two points?",
    variants: &[
        Variant::with_knobs(
            "star",
            star,
            RAYS,
            "rays in every direction, a color for each octant; none has a gap",
        )
        .source("section 2.1")
        .size(480, 480),
        Variant::with_knobs(
            "line",
            line,
            LINE,
            "a vertical line: 300 pixels, one in each row, its upper end not drawn",
        )
        .source("section 2.1")
        .in_pixels(),
        Variant::with_knobs(
            "broken",
            broken,
            RAYS,
            "the same rays, always stepping x: y-major ones fall apart into dots, vertical ones vanish",
        )
        .source("section 2.1, Figure 2-2")
        .size(480, 480)
        .remedied_by("star"),
        Variant::of_model_in_plane(
            "wireframe",
            wireframe,
            ["pawn.obj", "wood.png"],
            "a model as lines alone: every edge of every triangle, front and back",
        )
        .size(480, 480),
    ],
};

const LINE: &[Knob] = &[
    Knob::point(
        "a",
        [100.0, 0.0],
        "bring it above b: the end that is left out is still the upper one",
    ),
    Knob::point(
        "b",
        [100.0, 300.0],
        "go round a: y-major lines have a pixel in each row, x-major ones in each column",
    ),
];

// ANCHOR: line
/// One line: its ends are knobs.
fn line(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    draw_line(framebuffer, knobs.point("a"), knobs.point("b"), StepAxis::Longer, Color::RED);
}

/// Colors the pixels that the DDA emits.
fn draw_line(framebuffer: &mut Framebuffer, a: DVec2, b: DVec2, axis: StepAxis, color: Color) {
    dda(a, b, axis, framebuffer.scissor(), |x, y| framebuffer.set(x, y, color));
}
// ANCHOR_END: line

const RAYS: &[Knob] = &[Knob::number(
    "turn",
    0.0,
    [0.0, 90.0],
    "°",
    "if only x is stepped, a ray breaks as soon as it is steeper than 45°, whatever its color",
)];

/// Rays that step along their longer axis.
fn star(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    rays(framebuffer, StepAxis::Longer, knobs.number("turn"));
}

/// Rays that step x whatever their slope.
fn broken(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    rays(framebuffer, StepAxis::X, knobs.number("turn"));
}

/// A color for each octant (eighth of the circle), counter-clockwise from the right.
const OCTANTS: [Color; 8] = [
    Color::rgb(255, 96, 96),
    Color::rgb(255, 176, 64),
    Color::rgb(240, 240, 80),
    Color::rgb(120, 230, 90),
    Color::rgb(80, 220, 200),
    Color::rgb(90, 170, 255),
    Color::rgb(150, 130, 255),
    Color::rgb(240, 120, 230),
];

// ANCHOR: rays
/// Rays from the middle to points all round a square, six in each octant; all are rotated by an
/// angle in degrees. `fit` scales them to the size of the picture.
fn rays(framebuffer: &mut Framebuffer, axis: StepAxis, turn: f64) {
    let fit = Fit::new(framebuffer.rect(), [480.0, 480.0]);
    let (sin, cos) = libm::sincos(turn * PI / 180.0);
    let center = dvec2(240.0, 240.0);
    for (octant, color) in OCTANTS.into_iter().enumerate() {
        for i in 0..6 {
            // Up the right side of the square, or along its top to the left; then rotated by
            // quarter turns.
            let along = 38.0 * f64::from(i);
            let ray =
                if octant % 2 == 0 { dvec2(228.0, along) } else { dvec2(228.0 - along, 228.0) };
            let ray = (0..octant / 2).fold(ray, |ray, _| ray.perp());
            let ray = cos * ray + sin * ray.perp();
            draw_line(framebuffer, fit.at(center), fit.at(center + ray), axis, color);
        }
    }
}
// ANCHOR_END: rays

// ANCHOR: wireframe
/// The edges of a model's triangles, seen along z: of each vertex x and y are enough.
fn wireframe(framebuffer: &mut Framebuffer, subject: &Subject) {
    let fit = Fit::new(framebuffer.rect(), [480.0, 480.0]);
    let on_screen = |point: DVec3| fit.at(dvec2(240.0, 240.0) + point.truncate() * 135.0);
    for part in subject.model.parts.iter() {
        let vertices = part.mesh.vertices();
        for triangle in part.mesh.triangles() {
            let [a, b, c] = triangle.map(|index| on_screen(vertices[index].position));
            for (start, end) in [(a, b), (b, c), (c, a)] {
                draw_line(framebuffer, start, end, StepAxis::Longer, Color::rgb(120, 200, 255));
            }
        }
    }
}
// ANCHOR_END: wireframe

fn main() -> ExitCode {
    CHAPTER.main()
}
