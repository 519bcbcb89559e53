//! Triangles by edge functions: for each pixel, on which side of the three edges is its center?

use glam::DVec2;
use rasterbook::exact::edge::Coverage;
use rasterbook::figure::picture;
use rasterbook::scanline::{EdgeWalk, spans};
use rasterbook::scissor::Scissor;
use rasterbook::{Color, Framebuffer};

use super::scanlines::triangle;

// ANCHOR: bounding_box
/// All pixels of the box around a triangle. An edge that has a pixel on its wrong side gives it a tint.
pub(super) fn bounding_box(framebuffer: &mut Framebuffer) {
    let triangle = triangle([(5.3, 4.6), (35.2, 9.4), (15.8, 26.7)]);
    let coverage = Coverage::new(triangle).expect("a triangle with area");
    picture::draw_enlarged(framebuffer, (40, 30), |screen| {
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

// ANCHOR: shared_edge
/// How often each pixel is drawn when six triangles make up a hexagon. `pixels` emits those of one triangle.
fn hexagon(framebuffer: &mut Framebuffer, pixels: impl Fn([DVec2; 3], Scissor, &mut dyn FnMut(i32, i32))) {
    // Every vertex lies on the center of a pixel, and so do many pixels on the seams between two triangles.
    let center = (19.5, 14.5);
    let rim = [(35.5, 14.5), (27.5, 26.5), (11.5, 26.5), (3.5, 14.5), (11.5, 2.5), (27.5, 2.5)];
    picture::draw_enlarged(framebuffer, (40, 30), |screen| {
        for i in 0..6 {
            pixels(triangle([center, rim[i], rim[(i + 1) % 6]]), screen.scissor(), &mut |x, y| {
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
pub(super) fn shared_edge(framebuffer: &mut Framebuffer) {
    hexagon(framebuffer, |triangle, scissor, emit| {
        spans(triangle, EdgeWalk::Clamped, scissor, |span| span.columns().for_each(|x| emit(x, span.y)));
    });
}
// ANCHOR_END: shared_edge

// ANCHOR: top_left
/// The hexagon by edge functions: a center on a shared edge belongs to one side, by the top-left rule.
pub(super) fn top_left(framebuffer: &mut Framebuffer) {
    hexagon(framebuffer, |triangle, scissor, emit| {
        let coverage = Coverage::new(triangle).expect("a triangle with area");
        coverage.pixels(scissor).for_each(|(x, y, _)| emit(x, y));
    });
}
// ANCHOR_END: top_left
