//! # Chapter 3: barycentric interpolation and textures
//!
//! **The corners have values: which value has a pixel between them?** The nearer a corner, the more it weighs. Along a
//! straight line the weights change linearly, so that the scanline walk needs one addition a pixel.
//!
//! New here: interpolation (`lib/interpolate.rs`) and textures (`lib/texture.rs`). The walk is that of chapter 2; what
//! is stepped along with x is new. Book: chapter 3.

use std::process::ExitCode;

use glam::dvec2;
use rasterbook::exact::edge::Coverage;
use rasterbook::figure::{Chapter, Fit, Variant, picture};
use rasterbook::interpolate::{ScreenVertex, step_values};
use rasterbook::payload::{StepLimit, Walk};
use rasterbook::texture::{AddressMode, Texture};
use rasterbook::{Color, Framebuffer};

pub(crate) const CHAPTER: Chapter = Chapter {
    name: "ch03_barycentric",
    question: "The corners have values: which value has a pixel between them?",
    variants: &[
        Variant::new("weights", weights, "the weight of each corner by areas: its lines of equal weight run along the opposite edge")
            .source("section 3.2.2, Figures 3-6 and 3-7"),
        Variant::new("rgb", rgb, "red, green and blue corners, and all their mixtures between them").source("section 3.2.5"),
        Variant::new("gray", gray, "one value a corner: black, white, black").source("section 3.2.4"),
        Variant::new("texture", texture, "texture coordinates as values: half of the book's 2×2 texture on a triangle")
            .source("section 3.3, Figures 3-10 and 3-11"),
        Variant::new("spikes", spikes, "orange: values out of the range of the corners, at the tips (past the end of an edge) and at the ends of rows")
            .source("section 11.4")
            .remedied_by("limited"),
        Variant::new("limited-edges", limited_edges, "the same, limited along the edges as in the book: the tips are right, the ends of rows are not")
            .source("section 11.4"),
        Variant::new("limited", limited, "the same, limited along the rows too: no orange pixel is left"),
    ],
};

/// A vertex on the screen with its values.
fn vertex<const N: usize>(x: f64, y: f64, values: [f64; N]) -> ScreenVertex<[f64; N]> {
    ScreenVertex { position: dvec2(x, y), varyings: values }
}

// ANCHOR: gray
/// One value a vertex, drawn as gray.
fn gray(framebuffer: &mut Framebuffer) {
    let fit = Fit::new(framebuffer.rect(), [640.0, 480.0]);
    let triangle = [vertex(100.0, 0.0, [0.0]), vertex(0.0, 100.0, [255.0]), vertex(100.0, 200.0, [0.0])];
    step_values(fit.triangle(triangle), Walk::default(), framebuffer.scissor(), |x, y, [value]| {
        framebuffer.set(x, y, Color::truncated([value; 3]));
    });
}
// ANCHOR_END: gray

// ANCHOR: rgb
/// Three values a vertex, drawn as a color.
fn rgb(framebuffer: &mut Framebuffer) {
    let fit = Fit::new(framebuffer.rect(), [640.0, 480.0]);
    let triangle = [
        vertex(0.0, 0.0, [255.0, 0.0, 0.0]),
        vertex(240.0, 240.0, [0.0, 255.0, 0.0]),
        vertex(0.0, 480.0, [0.0, 0.0, 255.0]),
    ];
    step_values(fit.triangle(triangle), Walk::default(), framebuffer.scissor(), |x, y, values| {
        framebuffer.set(x, y, Color::truncated(values));
    });
}
// ANCHOR_END: rgb

// ANCHOR: texture
/// Two values a vertex, drawn as the texel that they point to.
fn texture(framebuffer: &mut Framebuffer) {
    let fit = Fit::new(framebuffer.rect(), [640.0, 480.0]);
    let texture = Texture::book();
    let triangle =
        [vertex(0.0, 0.0, [0.0, 0.0]), vertex(480.0, 0.0, [1.0, 0.0]), vertex(0.0, 480.0, [0.0, 1.0])];
    step_values(fit.triangle(triangle), Walk::default(), framebuffer.scissor(), |x, y, uv| {
        framebuffer.set(x, y, Color::truncated(texture.nearest(uv, AddressMode::Clamp)));
    });
}
// ANCHOR_END: texture

// ANCHOR: weights
/// The three weights at every pixel as red, green and blue, with a line at every tenth.
fn weights(framebuffer: &mut Framebuffer) {
    let fit = Fit::new(framebuffer.rect(), [640.0, 480.0]);
    let triangle = [dvec2(70.0, 50.0), dvec2(590.0, 130.0), dvec2(250.0, 440.0)];
    // The value of an edge function is twice the area of the small triangle over that edge.
    let coverage = Coverage::new(triangle.map(|vertex| fit.at(vertex))).expect("area");
    for (x, y, areas) in coverage.all_pixels(framebuffer.scissor()) {
        let weights = areas.map(|area| area as f64 / coverage.twice_area as f64);
        let inside = coverage.covers(areas);
        let on_tenth = weights.iter().any(|&weight| (weight * 10.0 - (weight * 10.0).round()).abs() < 0.025);
        // Beyond an edge the weight of the opposite vertex is negative; dim, so that the triangle stands out.
        let brightness = if inside == on_tenth {
            110.0
        } else if inside {
            255.0
        } else {
            40.0
        };
        framebuffer.set(x, y, Color::truncated(weights.map(|weight| weight * brightness)));
    }
}
// ANCHOR_END: weights

// ANCHOR: spikes
/// Values stepped past the ends of the edges.
fn spikes(framebuffer: &mut Framebuffer) {
    confetti(framebuffer, StepLimit::Overrun);
}

/// Values limited along the edges.
fn limited_edges(framebuffer: &mut Framebuffer) {
    confetti(framebuffer, StepLimit::Edges);
}

/// Values limited along edges and rows.
fn limited(framebuffer: &mut Framebuffer) {
    confetti(framebuffer, StepLimit::Everywhere);
}

/// Small triangles on a screen of 80×60 pixels, each at another fraction of a pixel. All vertices have values in 0..=1,
/// drawn as dark to bright blue; a value outside that range is drawn in orange.
fn confetti(framebuffer: &mut Framebuffer, limit: StepLimit) {
    picture::draw_enlarged(framebuffer, (80, 60), |screen| {
        for (column, row) in (0..6).flat_map(|row| (0..7).map(move |column| (column, row))) {
            let (i, j) = (f64::from(column), f64::from(row));
            let (x, y) = (2.2 + 11.13 * i, 2.6 + 9.41 * j + 0.27 * i);
            let triangle = [
                vertex(x, y, [0.0]),
                vertex(x + 8.4, y + 1.7, [0.0]),
                vertex(x + 1.8 + 0.7 * i, y + 7.6, [1.0]),
            ];
            step_values(triangle, Walk { limit, ..Walk::default() }, screen.scissor(), |x, y, [value]| {
                let is_in_range = (-1e-9..=1.0 + 1e-9).contains(&value);
                let blue =
                    Color::truncated([30.0 + 60.0 * value, 60.0 + 120.0 * value, 110.0 + 140.0 * value]);
                screen.set(x, y, if is_in_range { blue } else { Color::rgb(255, 140, 0) });
            });
        }
    });
}
// ANCHOR_END: spikes

fn main() -> ExitCode {
    CHAPTER.main()
}
