//! Triangles by edge functions: for each pixel, on which side of the three edges is its centre?

use glam::DVec2;
use rasterbook::edge::{Coverage, center};
use rasterbook::program::picture;
use rasterbook::scanline::Walk;
use rasterbook::{Color, Framebuffer, Rect};

use super::scanlines::{halves, triangle};

// ANCHOR: bounding_box
/// All pixels of the box around a triangle. An edge that has a pixel on its wrong side gives it a tint.
pub(super) fn bounding_box(framebuffer: &mut Framebuffer) {
    let mut screen = Framebuffer::new(40, 30);
    let corners = triangle([(5.3, 4.6), (35.2, 9.4), (15.8, 26.7)]);
    let coverage = Coverage::new(corners).expect("a triangle with area");
    let bounds = coverage.bounding_box(screen.rect());
    for (x, y) in bounds.rows().flat_map(|y| bounds.columns().map(move |x| (x, y))) {
        let values = coverage.edge_values(center(x, y));
        let tint = |value: i64| if value < 0 { 90 } else { 25 };
        let [red, green, blue] = values.map(tint);
        let inside = Color::rgb(240, 170, 60);
        screen.set(x, y, if coverage.covers(values) { inside } else { Color::rgb(red, green, blue) });
    }
    picture::paste(framebuffer, &picture::enlarged(&screen, 16), 0, 0);
}
// ANCHOR_END: bounding_box

// ANCHOR: shared_edge
/// How often each pixel is drawn when six triangles make up a hexagon. `pixels` gives those of one triangle.
fn hexagon(framebuffer: &mut Framebuffer, pixels: impl Fn([DVec2; 3], Rect) -> Vec<(i32, i32)>) {
    let center = (19.6, 14.7);
    let rim = [(36.3, 15.2), (27.8, 27.4), (11.4, 26.9), (3.2, 14.1), (10.7, 2.3), (28.9, 1.6)];
    let mut screen = Framebuffer::new(40, 30);
    for i in 0..6 {
        for (x, y) in pixels(triangle([center, rim[i], rim[(i + 1) % 6]]), screen.rect()) {
            let before = screen.get(x, y).unwrap_or_default();
            screen.set(x, y, one_more(before));
        }
    }
    picture::paste(framebuffer, &picture::enlarged(&screen, 16), 0, 0);
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
    hexagon(framebuffer, |triangle, window| {
        let mut pixels = Vec::new();
        for half in halves(triangle).into_iter().flatten() {
            half.walk(
                |_| [(), ()],
                Walk::default(),
                window,
                |span| {
                    pixels.extend(span.columns().map(|x| (x, span.y)));
                },
            );
        }
        pixels
    });
}
// ANCHOR_END: shared_edge

// ANCHOR: top_left
/// The hexagon by edge functions: a centre on a shared edge belongs to one side, by the top-left rule.
pub(super) fn top_left(framebuffer: &mut Framebuffer) {
    hexagon(framebuffer, |triangle, window| {
        let coverage = Coverage::new(triangle).expect("a triangle with area");
        coverage.pixels(window).map(|(x, y, _)| (x, y)).collect()
    });
}
// ANCHOR_END: top_left
