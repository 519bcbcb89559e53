//! # Chapter 3: barycentric interpolation and textures
//!
//! **The vertices have values: what value does a pixel between them get?** The nearer a vertex, the more it weighs. Along a
//! straight line the weights change linearly, so that the scanline walk needs one addition a pixel.
//!
//! New here: interpolation (`lib/interpolate.rs`) and textures (`lib/texture.rs`). The walk is that of chapter 2; what
//! is stepped along with x is new. Book: chapter 3.

use std::process::ExitCode;

use glam::{DVec2, dvec2};
use rasterbook::exact::edge::Coverage;
use rasterbook::figure::{Chapter, Fit, Knob, Knobs, Variant, picture};
use rasterbook::interpolate::{ScreenVertex, barycentric_weights, step_values};
use rasterbook::line::{StepAxis, dda};
use rasterbook::payload::{StepClamp, Walk};
use rasterbook::scanline::{EdgeWalk, spans};
use rasterbook::texture::{AddressMode, Texture};
use rasterbook::{Color, Framebuffer};

pub(crate) const CHAPTER: Chapter = Chapter {
    name: "ch03_barycentric",
    question: "The vertices have values: what value does a pixel between them get?",
    variants: &[
        Variant::with_knobs("weights", weights, WEIGHTS, "the weight of each vertex by areas: its lines of equal weight run along the opposite edge")
            .source("section 3.2.2, Figures 3-6 and 3-7"),
        Variant::with_knobs("areas", areas, AREAS, "the weights of one point as areas: each small triangle has the color of the vertex opposite to it, and is the brighter the larger it is")
            .source("section 3.2.2, Figure 3-6"),
        Variant::with_knobs("rgb", rgb, RGB, "red, green and blue vertices, and all their mixtures between them").source("section 3.2.5"),
        Variant::with_knobs("gray", gray, GRAY, "one value a vertex: black, white, black").source("section 3.2.4"),
        Variant::with_knobs("texture", texture, TEXTURE, "texture coordinates as values: half of the book's 2×2 texture on a triangle")
            .source("section 3.3, Figures 3-10 and 3-11"),
        Variant::new("spikes", spikes, "orange: values out of the range of the vertices, at the tips (past the end of an edge) and at the ends of rows")
            .source("section 11.4")
            .remedied_by("clamped"),
        Variant::new("clamped-edges", clamped_edges, "the same, clamped along the edges as in the book: the tips are right, the ends of rows are not")
            .source("section 11.4"),
        Variant::new("clamped", clamped, "the same, clamped along the rows too: no orange pixel is left"),
    ],
};

/// A vertex on the screen with its values.
fn vertex<const N: usize>(position: DVec2, values: [f64; N]) -> ScreenVertex<[f64; N]> {
    ScreenVertex { position, varyings: values }
}

const GRAY: &[Knob] = &[
    Knob::point(
        "a",
        [100.0, 0.0],
        "the gray stays the same along every parallel to the edge from a to c",
    ),
    Knob::point("b", [0.0, 100.0], "the farther it is from a and c, the slower the gray changes"),
    Knob::point(
        "c",
        [100.0, 200.0],
        "bring it to the height of a: now the gray changes from row to row",
    ),
];

// ANCHOR: gray
/// One value a vertex, drawn as gray.
fn gray(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    let fit = Fit::new(framebuffer.rect(), [640.0, 480.0]);
    let triangle = [
        vertex(knobs.point("a"), [0.0]),
        vertex(knobs.point("b"), [255.0]),
        vertex(knobs.point("c"), [0.0]),
    ];
    step_values(fit.triangle(triangle), Walk::default(), framebuffer.scissor(), |x, y, [value]| {
        framebuffer.set(x, y, Color::truncated([value; 3]));
    });
}
// ANCHOR_END: gray

const RGB: &[Knob] = &[
    Knob::point(
        "a",
        [0.0, 0.0],
        "red goes with it, and along the edge from b to c no color changes",
    ),
    Knob::point(
        "b",
        [240.0, 240.0],
        "green goes with it, and along the edge from a to c no color changes",
    ),
    Knob::point(
        "c",
        [0.0, 480.0],
        "blue goes with it, and along the edge from a to b no color changes",
    ),
];

// ANCHOR: rgb
/// Three values a vertex, drawn as a color.
fn rgb(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    let fit = Fit::new(framebuffer.rect(), [640.0, 480.0]);
    let triangle = [
        vertex(knobs.point("a"), [255.0, 0.0, 0.0]),
        vertex(knobs.point("b"), [0.0, 255.0, 0.0]),
        vertex(knobs.point("c"), [0.0, 0.0, 255.0]),
    ];
    step_values(fit.triangle(triangle), Walk::default(), framebuffer.scissor(), |x, y, values| {
        framebuffer.set(x, y, Color::truncated(values));
    });
}
// ANCHOR_END: rgb

const TEXTURE: &[Knob] = &[
    Knob::point(
        "a",
        [0.0, 0.0],
        "the texture goes with the vertices: each texel becomes a slanted parallelogram",
    ),
    Knob::point("b", [480.0, 0.0], "closer to a: the texels get narrow and keep their height"),
    Knob::point(
        "c",
        [0.0, 480.0],
        "bring it to the right of b: the texture leans, and its lines stay straight",
    ),
];

// ANCHOR: texture
/// Two values a vertex, drawn as the texel that they point to.
fn texture(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    let fit = Fit::new(framebuffer.rect(), [640.0, 480.0]);
    let texture = Texture::book();
    let triangle = [
        vertex(knobs.point("a"), [0.0, 0.0]),
        vertex(knobs.point("b"), [1.0, 0.0]),
        vertex(knobs.point("c"), [0.0, 1.0]),
    ];
    step_values(fit.triangle(triangle), Walk::default(), framebuffer.scissor(), |x, y, uv| {
        framebuffer.set(x, y, Color::truncated(texture.nearest(uv, AddressMode::Clamp)));
    });
}
// ANCHOR_END: texture

const WEIGHTS: &[Knob] = &[
    Knob::point(
        "a",
        [70.0, 50.0],
        "the lines of one weight of a stay parallel to the edge from b to c",
    ),
    Knob::point(
        "b",
        [590.0, 130.0],
        "bring it beyond the edge from a to c: the triangle flips over, the lines stay straight",
    ),
    Knob::point(
        "c",
        [250.0, 440.0],
        "bring it close to the edge from a to b: its lines crowd together, since its weight changes fast",
    ),
];

// ANCHOR: weights
/// The three weights at every pixel as red, green and blue, with a line at every tenth.
fn weights(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    let fit = Fit::new(framebuffer.rect(), [640.0, 480.0]);
    let triangle = ["a", "b", "c"].map(|name| fit.at(knobs.point(name)));
    // The value of an edge function is twice the area of the small triangle over that edge.
    let Some(coverage) = Coverage::new(triangle) else { return };
    for (x, y, areas) in coverage.all_pixels(framebuffer.scissor()) {
        let weights = areas.map(|area| area as f64 / coverage.twice_area as f64);
        let inside = coverage.covers(areas);
        let on_tenth =
            weights.iter().any(|&weight| (weight * 10.0 - (weight * 10.0).round()).abs() < 0.025);
        // Beyond an edge the weight of the opposite vertex is negative; dim, so that the triangle
        // stands out.
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

const AREAS: &[Knob] = &[
    Knob::point(
        "p",
        [330.0, 180.0],
        "go to a: all is red; go beyond an edge: its triangle lies outside, its weight is negative",
    ),
    Knob::point(
        "a",
        [70.0, 50.0],
        "the red triangle keeps its shape, and yet the weight of a changes: the whole does",
    ),
    Knob::point(
        "b",
        [590.0, 130.0],
        "the green triangle keeps its shape, and yet the weight of b changes: the whole does",
    ),
    Knob::point(
        "c",
        [250.0, 440.0],
        "the blue triangle keeps its shape, and yet the weight of c changes: the whole does",
    ),
];

// ANCHOR: areas
/// The weights of a point P: the small triangle opposite to A in red, to B in green, to C in blue,
/// each the brighter the more its vertex weighs, and P in the mixture of the three. Negative
/// weights are striped.
fn areas(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    let fit = Fit::new(framebuffer.rect(), [640.0, 480.0]);
    let [a, b, c, p] = ["a", "b", "c", "p"].map(|name| fit.at(knobs.point(name)));
    let weights = barycentric_weights(p, [a, b, c]);
    if !weights.iter().all(|weight| weight.is_finite()) {
        return; // A triangle without area has no weights.
    }
    let small = [[p, b, c], [a, p, c], [a, b, p]];
    let color = |i: usize, brightness: f64| {
        let mut channels = [0.0; 3];
        channels[i] = brightness;
        Color::truncated(channels)
    };

    // The largest first: a triangle of negative weight lies on others, and they show between its
    // stripes.
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| weights[j].total_cmp(&weights[i]));
    for i in order {
        let paint = color(i, 80.0 + 175.0 * weights[i].abs());
        spans(small[i], EdgeWalk::Clamped, framebuffer.scissor(), |span| {
            for x in span.columns() {
                let stripe = f64::from(x + span.y) / (6.0 * fit.scale);
                if weights[i] >= 0.0 || stripe as i32 % 2 == 0 {
                    framebuffer.set(x, span.y, paint);
                }
            }
        });
    }

    for (i, (start, end)) in [(b, c), (c, a), (a, b)].into_iter().enumerate() {
        let (scissor, vertex) = (framebuffer.scissor(), [a, b, c][i]);
        dda(start, end, StepAxis::Longer, scissor, |x, y| framebuffer.set(x, y, Color::WHITE));
        framebuffer.fill(fit.mark(vertex, 6.0), color(i, 255.0));
    }
    framebuffer.fill(fit.mark(p, 9.0), Color::WHITE);
    framebuffer.fill(fit.mark(p, 7.0), Color::truncated(weights.map(|weight| weight * 255.0)));
}
// ANCHOR_END: areas

// ANCHOR: spikes
/// Values stepped past the ends of the edges.
fn spikes(framebuffer: &mut Framebuffer) {
    confetti(framebuffer, StepClamp::Overrun);
}

/// Values clamped along the edges.
fn clamped_edges(framebuffer: &mut Framebuffer) {
    confetti(framebuffer, StepClamp::Edges);
}

/// Values clamped along edges and rows.
fn clamped(framebuffer: &mut Framebuffer) {
    confetti(framebuffer, StepClamp::Everywhere);
}

/// Small triangles on a screen of 80×60 pixels, each at another fraction of a pixel. All vertices
/// have values in 0..=1, drawn as dark to bright blue; a value outside that range is drawn in
/// orange.
fn confetti(framebuffer: &mut Framebuffer, clamp: StepClamp) {
    picture::draw_enlarged(framebuffer, (80, 60), |screen| {
        for (column, row) in (0..6).flat_map(|row| (0..7).map(move |column| (column, row))) {
            let (i, j) = (f64::from(column), f64::from(row));
            let (x, y) = (2.2 + 11.13 * i, 2.6 + 9.41 * j + 0.27 * i);
            let triangle = [
                vertex(dvec2(x, y), [0.0]),
                vertex(dvec2(x + 8.4, y + 1.7), [0.0]),
                vertex(dvec2(x + 1.8 + 0.7 * i, y + 7.6), [1.0]),
            ];
            let walk = Walk { clamp, ..Walk::default() };
            step_values(triangle, walk, screen.scissor(), |x, y, [value]| {
                let is_in_range = (-1e-9..=1.0 + 1e-9).contains(&value);
                let blue = [30.0 + 60.0 * value, 60.0 + 120.0 * value, 110.0 + 140.0 * value];
                let orange = Color::rgb(255, 140, 0);
                screen.set(x, y, if is_in_range { Color::truncated(blue) } else { orange });
            });
        }
    });
}
// ANCHOR_END: spikes

fn main() -> ExitCode {
    CHAPTER.main()
}
