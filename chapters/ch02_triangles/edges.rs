//! Triangles by edge functions: for each pixel, on which side of each edge is its center?

use glam::{DVec2, dvec2};
use rasterbook::exact::edge::Coverage;
use rasterbook::figure::{Fit, Knob, Knobs, Sketch, picture};
use rasterbook::scanline::{EdgeWalk, spans};
use rasterbook::scissor::Scissor;
use rasterbook::{Color, Framebuffer, Pixel, Rect};

/// How many pixels of the picture show one pixel of the small screen.
const FACTOR: f64 = 16.0;

pub(super) const BOUNDING_BOX: &[Knob] = &[
    Knob::point(
        "a",
        [84.8, 73.6],
        "make the triangle long and slanted: most pixels of the box are tested in vain",
    ),
    Knob::point(
        "b",
        [563.2, 150.4],
        "bring it below a: each tint stays beyond the edge opposite to its vertex",
    ),
    Knob::point(
        "c",
        [252.8, 427.2],
        "bring it close to the line from a to b: few pixels have their center inside, then none",
    ),
];

// ANCHOR: bounding_box
/// All pixels of the box around a triangle. An edge that has a pixel on its wrong side gives it a
/// tint.
pub(super) fn bounding_box(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    let triangle = ["a", "b", "c"].map(|name| knobs.point(name) / FACTOR);
    picture::draw_enlarged(framebuffer, (40, 30), |screen| {
        let Some(coverage) = Coverage::new(triangle) else { return };
        let bounds = coverage.bounding_box(screen.rect());
        for (x, y, values) in coverage.all_pixels(screen.scissor().within(bounds)) {
            let tint = |value: i64| if value < 0 { 90 } else { 25 };
            let [red, green, blue] = values.map(tint);
            let inside = Color::rgb(240, 170, 60);
            let outside = Color::rgb(red, green, blue);
            screen.set(x, y, if coverage.covers(values) { inside } else { outside });
        }
    });
}
// ANCHOR_END: bounding_box

pub(super) const HEXAGON: &[Knob] = &[Knob::point(
    "center",
    [312.0, 232.0],
    "wherever in the hexagon it is: by rows seams are drawn twice, by the top-left rule no pixel is",
)];

// ANCHOR: shared_edge
/// Emits those pixels of a scissor that belong to a triangle.
type Rule = fn([DVec2; 3], Scissor, &mut dyn FnMut(i32, i32));

/// How often each pixel is drawn when six triangles round a center make up a hexagon.
fn hexagon(framebuffer: &mut Framebuffer, center: DVec2, rule: Rule) {
    // Every vertex lies on the center of a pixel, and so do many pixels on the seams between two
    // triangles.
    let rim = [(35.5, 14.5), (27.5, 26.5), (11.5, 26.5), (3.5, 14.5), (11.5, 2.5), (27.5, 2.5)]
        .map(DVec2::from);
    picture::draw_enlarged(framebuffer, (40, 30), |screen| {
        for i in 0..6 {
            rule([center, rim[i], rim[(i + 1) % 6]], screen.scissor(), &mut |x, y| {
                let before = screen.get(x, y).unwrap_or_default();
                screen.set(x, y, one_more(before));
            });
        }
    });
}

/// The color of a pixel that has been drawn once more than `color` says.
fn one_more(color: Color) -> Color {
    const ONCE: Color = Color::rgb(60, 90, 130);
    const TWICE: Color = Color::rgb(255, 220, 60);
    match color {
        Color::BLACK => ONCE,
        ONCE => TWICE,
        _ => Color::rgb(240, 50, 40),
    }
}

/// The pixels of a triangle by the rule of the book, row by row.
fn by_rows(triangle: [DVec2; 3], scissor: Scissor, emit: &mut dyn FnMut(i32, i32)) {
    spans(triangle, EdgeWalk::Clamped, scissor, |span| {
        span.columns().for_each(|x| emit(x, span.y));
    });
}

/// The hexagon by rows.
pub(super) fn shared_edge(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    hexagon(framebuffer, knobs.point("center") / FACTOR, by_rows);
}
// ANCHOR_END: shared_edge

// ANCHOR: top_left
/// The pixels whose centers are inside; one on a shared edge belongs to one triangle, by the
/// top-left rule.
fn by_centers(triangle: [DVec2; 3], scissor: Scissor, emit: &mut dyn FnMut(i32, i32)) {
    let Some(coverage) = Coverage::new(triangle) else { return };
    coverage.pixels(scissor).for_each(|(x, y, _)| emit(x, y));
}

/// The hexagon by edge functions.
pub(super) fn top_left(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    hexagon(framebuffer, knobs.point("center") / FACTOR, by_centers);
}
// ANCHOR_END: top_left

/// How many pixels of the picture show one pixel of a grid, and how many pixels a grid has.
const CELL: f64 = 24.0;
const GRID: (u32, u32) = (16, 12);

pub(super) const TWO_RULES: &[Knob] = &[
    Knob::point(
        "a",
        [62.0, 43.0],
        "slowly: on the right a square changes when an edge crosses its dot, on the left when its row's end enters it",
    ),
    Knob::point(
        "b",
        [346.0, 101.0],
        "close to the line from a to c: on the left each row keeps a square, on the right only dots inside count",
    ),
    Knob::point(
        "c",
        [139.0, 262.0],
        "lower it: the top row goes when c falls to the row's dots, and on the left these are half a square lower",
    ),
];

/// One triangle by both rules on a coarse grid, with the point that stands for each pixel: on the left its
/// lower left one, on the right its center. Blue is what both rules take, orange what one of them takes alone.
pub(super) fn two_rules(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    let fit = Fit::new(framebuffer.rect(), [784.0, 288.0]);
    let triangle = ["a", "b", "c"].map(|name| knobs.point(name) / CELL);
    let rules = [(by_rows as Rule, dvec2(0.0, 0.0)), (by_centers, dvec2(0.5, 0.5))];
    let taken = rules.map(|(rule, _)| {
        let mut pixels: Vec<Pixel> = Vec::new();
        rule(triangle, Rect::sized(GRID.0, GRID.1).into(), &mut |x, y| pixels.push((x, y)));
        pixels
    });
    for (left, (rule, sample), others) in [(0, rules[0], &taken[1]), (400, rules[1], &taken[0])] {
        let half = fit.rect(Rect { left, bottom: 0, right: left + 384, top: 288 });
        let cells = picture::draw_enlarged_within(framebuffer, half, GRID, |screen| {
            rule(triangle, screen.scissor(), &mut |x, y| {
                let is_shared = others.contains(&(x, y));
                let [blue, orange] = [Color::rgb(60, 110, 190), Color::rgb(240, 150, 50)];
                screen.set(x, y, if is_shared { blue } else { orange });
            });
        });
        let mut sketch = Sketch::new(framebuffer, cells).within(half);
        for (x, y) in (0..12).flat_map(|y| (0..16).map(move |x| (f64::from(x), f64::from(y)))) {
            sketch.dot(dvec2(x, y) + sample, 2.0 / CELL, Color::gray(190));
        }
        for i in 0..3 {
            sketch.line(triangle[i], triangle[(i + 1) % 3], 2.0 / CELL, Color::WHITE);
        }
        for vertex in triangle {
            sketch.dot(vertex, 5.0 / CELL, Color::WHITE);
        }
    }
}
