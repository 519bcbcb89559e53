//! Triangles by edge functions: for each pixel, on which side of each edge is its center?

use glam::DVec2;
use rasterbook::exact::edge::Coverage;
use rasterbook::figure::{Knob, Knobs, picture};
use rasterbook::scanline::{EdgeWalk, spans};
use rasterbook::scissor::Scissor;
use rasterbook::{Color, Framebuffer};

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
            screen.set(x, y, if coverage.covers(values) { inside } else { Color::rgb(red, green, blue) });
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
/// How often each pixel is drawn when six triangles round a center make up a hexagon. `pixels`
/// emits those of one triangle.
fn hexagon(
    framebuffer: &mut Framebuffer,
    center: DVec2,
    pixels: impl Fn([DVec2; 3], Scissor, &mut dyn FnMut(i32, i32)),
) {
    // Every vertex lies on the center of a pixel, and so do many pixels on the seams between two
    // triangles.
    let rim =
        [(35.5, 14.5), (27.5, 26.5), (11.5, 26.5), (3.5, 14.5), (11.5, 2.5), (27.5, 2.5)].map(DVec2::from);
    picture::draw_enlarged(framebuffer, (40, 30), |screen| {
        for i in 0..6 {
            pixels([center, rim[i], rim[(i + 1) % 6]], screen.scissor(), &mut |x, y| {
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

/// The hexagon by rows.
pub(super) fn shared_edge(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    hexagon(framebuffer, knobs.point("center") / FACTOR, |triangle, scissor, emit| {
        spans(triangle, EdgeWalk::Clamped, scissor, |span| span.columns().for_each(|x| emit(x, span.y)));
    });
}
// ANCHOR_END: shared_edge

// ANCHOR: top_left
/// The hexagon by edge functions: a center on a shared edge belongs to one triangle, by the
/// top-left rule.
pub(super) fn top_left(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    hexagon(framebuffer, knobs.point("center") / FACTOR, |triangle, scissor, emit| {
        let Some(coverage) = Coverage::new(triangle) else { return };
        coverage.pixels(scissor).for_each(|(x, y, _)| emit(x, y));
    });
}
// ANCHOR_END: top_left
