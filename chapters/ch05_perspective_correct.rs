//! # Chapter 5: perspective-correct interpolation
//!
//! **Why does a texture bend when a surface is tilted?** Because equal steps on the screen are not equal steps in
//! space. The scanline walk stays as it is; what is stepped along its edges is now t′, the parameter
//! on the screen, and one option says what a value at t′ is.
//!
//! New here: w (the book's ω) and the formula for V_p (`lib/interpolate.rs`). Book: chapter 5.

use std::f64::consts::PI;
use std::process::ExitCode;

use glam::{dvec2, dvec3};
use rasterbook::exact::edge::Coverage;
use rasterbook::figure::{Chapter, Fit, Knob, Knobs, Variant};
use rasterbook::interpolate::{
    Interpolation, Projected, ScreenVertex, perspective_weights, step_parameter, step_values,
};
use rasterbook::payload::Walk;
use rasterbook::texture::{AddressMode, Texture};
use rasterbook::transform::{perspective, perspective_divide};
use rasterbook::{Color, Framebuffer, Rect};

pub(crate) const CHAPTER: Chapter = Chapter {
    name: "ch05_perspective_correct",
    question: "Why does a texture bend when a surface is tilted?",
    variants: &[
        Variant::with_knobs("floor", floor, FLOOR, "a checkered floor to the horizon: every line is straight, and the squares get smaller towards the horizon"),
        Variant::with_knobs("correct", correct, TILTED, "the tilted square, interpolated in space: the line between the colors is straight")
            .source("section 5.4, Figure 5-8"),
        Variant::with_knobs("affine", affine, TILTED, "the same square, interpolated on the screen: the line between the colors breaks at the diagonal")
            .source("section 5.3, Figure 5-3")
            .remedied_by("correct"),
        Variant::new("facing", facing, "a projected triangle that faces us: chapter 3 is still enough").source("section 5.1, Figure 5-1"),
        Variant::new("square", square, "two triangles make a square that faces us: no seam, no bend").source("section 5.2, Figure 5-2"),
        Variant::with_knobs("reciprocal", reciprocal, TILTED, "the tilted square again, by way of 1/w and V/w: compare it with 'correct', not one pixel differs")
            .source("section 5.5.4"),
        Variant::with_knobs("barycentric", barycentric, TILTED, "the tilted square by weights: those of areas on the screen, each divided by its vertex's w")
            .source("first note"),
        Variant::with_knobs("floor-affine", floor_affine, FLOOR, "the same two triangles, interpolated on the screen: the floor folds along the diagonal")
            .remedied_by("floor"),
    ],
};

const TILTED: &[Knob] = &[
    Knob::number(
        "tilt",
        30.0,
        [0.0, 85.0],
        "°",
        "at 0 nothing is wrong; without the correction, the more it turns away, the larger is the wrong part",
    ),
    Knob::number(
        "distance",
        100.0,
        [60.0, 400.0],
        "",
        "without the correction, less is wrong from farther away: the edges differ less in their distance",
    ),
    Knob::whole(
        "texels",
        2,
        [2, 16],
        "",
        "without the correction the horizontal lines break, and the vertical ones do not crowd together",
    ),
];

/// The distance of the image plane in the book's scenes of this chapter.
const NEAR: f64 = 80.0;

// ANCHOR: vertex
/// Projects a point with its texture coordinates. Screen coordinates are what the divide gives, and
/// w is kept.
fn vertex([x, y, z]: [f64; 3], uv: [f64; 2]) -> ScreenVertex<Projected<f64, 2>> {
    let clip = perspective(dvec3(x, y, z), NEAR);
    ScreenVertex {
        position: perspective_divide(clip).truncate(),
        varyings: Projected { w: clip.w, values: uv },
    }
}
// ANCHOR_END: vertex

type Triangle = [ScreenVertex<Projected<f64, 2>>; 3];

// ANCHOR: square_geometry
/// A square of two triangles, its left edge at a distance, its right edge turned away from us by an
/// angle in degrees.
fn square_at(distance: f64, tilt: f64) -> [Triangle; 2] {
    let (sin, cos) = libm::sincos(tilt * PI / 180.0);
    let (x, z) = (480.0 * cos, distance + 480.0 * sin);
    let left = [vertex([0.0, 0.0, distance], [0.0, 0.0]), vertex([0.0, 480.0, distance], [0.0, 1.0])];
    let right = [vertex([x, 0.0, z], [1.0, 0.0]), vertex([x, 480.0, z], [1.0, 1.0])];
    [[left[0], right[0], left[1]], [right[0], left[1], right[1]]]
}

/// The tilted square and its texture, as the knobs say.
fn tilted_square(knobs: &Knobs) -> ([Triangle; 2], Texture) {
    let square = square_at(knobs.number("distance"), knobs.number("tilt"));
    (square, book_texels(knobs.whole("texels")))
}
// ANCHOR_END: square_geometry

/// The colors of the book's texture, so many texels in each direction.
fn book_texels(count: i32) -> Texture {
    let book = Texture::book();
    let color = |column: i32, row: i32| {
        let center = [column, row].map(|index| (f64::from(index) + 0.5) / 2.0);
        Color::truncated(book.nearest(center, AddressMode::Repeat))
    };
    let texels = (0..count).flat_map(|row| (0..count).map(move |column| color(column, row)));
    Texture::new(count as u32, count as u32, texels.collect())
}

// ANCHOR: textured
/// Draws the tilted square; `interpolation` is the option of this chapter.
fn textured(framebuffer: &mut Framebuffer, knobs: &Knobs, interpolation: Interpolation) {
    let fit = Fit::new(framebuffer.rect(), [640.0, 480.0]);
    let (triangles, texture) = tilted_square(knobs);
    for triangle in triangles {
        let triangle = fit.triangle(triangle);
        step_parameter(triangle, interpolation, Walk::default(), framebuffer.scissor(), |x, y, point| {
            framebuffer.set(x, y, Color::truncated(texture.nearest(point.values, AddressMode::Clamp)));
        });
    }
}

/// The tilted square, right.
fn correct(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    textured(framebuffer, knobs, Interpolation::PerspectiveCorrect);
}

/// The tilted square, wrong.
fn affine(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    textured(framebuffer, knobs, Interpolation::Affine);
}

/// The tilted square, right in another way.
fn reciprocal(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    textured(framebuffer, knobs, Interpolation::Reciprocal);
}
// ANCHOR_END: textured

// ANCHOR: barycentric
/// The tilted square by weights, pixel by pixel; the weights of areas are corrected by w.
fn barycentric(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    let fit = Fit::new(framebuffer.rect(), [640.0, 480.0]);
    let (triangles, texture) = tilted_square(knobs);
    for triangle in triangles {
        let triangle = fit.triangle(triangle);
        let Some(coverage) = Coverage::new(triangle.map(|corner| corner.position)) else { continue };
        for (x, y, areas) in coverage.pixels(framebuffer.scissor()) {
            let on_screen = areas.map(|area| area as f64 / coverage.twice_area as f64);
            let in_space = perspective_weights(on_screen, triangle.map(|vertex| vertex.varyings.w));
            let uv = [0, 1].map(|k| (0..3).map(|i| in_space[i] * triangle[i].varyings.values[k]).sum());
            framebuffer.set(x, y, Color::truncated(texture.nearest::<f64>(uv, AddressMode::Clamp)));
        }
    }
}
// ANCHOR_END: barycentric

// ANCHOR: facing
/// Draws triangles as chapter 3 does: values by equal steps on the screen, w unused.
fn textured_as_before(framebuffer: &mut Framebuffer, triangles: &[Triangle]) {
    let fit = Fit::new(framebuffer.rect(), [640.0, 480.0]);
    let texture = Texture::book();
    for &triangle in triangles {
        let triangle = fit
            .triangle(triangle)
            .map(|vertex| ScreenVertex { position: vertex.position, varyings: vertex.varyings.values });
        step_values(triangle, Walk::default(), framebuffer.scissor(), |x, y, uv| {
            framebuffer.set(x, y, Color::truncated(texture.nearest(uv, AddressMode::Clamp)));
        });
    }
}

/// A triangle that faces us.
fn facing(framebuffer: &mut Framebuffer) {
    let corners = [([0.0, 0.0], [0.0, 0.0]), ([320.0, 480.0], [0.5, 1.0]), ([640.0, 0.0], [1.0, 0.0])];
    textured_as_before(framebuffer, &[corners.map(|([x, y], uv)| vertex([x, y, 100.0], uv))]);
}

/// A square that faces us.
fn square(framebuffer: &mut Framebuffer) {
    textured_as_before(framebuffer, &square_at(100.0, 0.0));
}
// ANCHOR_END: facing

const FLOOR: &[Knob] = &[
    Knob::whole(
        "pieces",
        1,
        [1, 24],
        "",
        "without the correction each piece folds, small ones less; with it borders move by a pixel, no more",
    ),
    Knob::number(
        "height",
        100.0,
        [50.0, 300.0],
        "",
        "the eye goes up: the floor opens, the horizon stays, and a fold stays on its diagonal",
    ),
];

// ANCHOR: floor
/// A checkered floor from below our feet to far away. In each direction it is cut into so many
/// pieces, each of two triangles.
fn checkered_floor(framebuffer: &mut Framebuffer, knobs: &Knobs, interpolation: Interpolation) {
    let fit = Fit::new(framebuffer.rect(), [640.0, 480.0]);
    framebuffer.clear(Color::rgb(70, 90, 70));
    let horizon = fit.at(dvec2(0.0, 240.0)).y as i32;
    framebuffer.fill(Rect { bottom: horizon, ..framebuffer.rect() }, Color::rgb(120, 170, 220));

    // The camera is above the floor and looks at the middle of a picture of 640×480.
    let (pieces, height) = (knobs.whole("pieces"), knobs.number("height"));
    let corner = |column: i32, row: i32| {
        let [right, away] = [column, row].map(|index| f64::from(index) / f64::from(pieces));
        let (x, z) = (-720.0 + 1440.0 * right, 120.0 + 2400.0 * away);
        let seen = vertex([x, -height, z], [x / 240.0, z / 240.0]);
        ScreenVertex { position: dvec2(320.0, 240.0) + seen.position * 4.0, ..seen }
    };

    let texture = Texture::checkerboard(Color::rgb(50, 60, 80), Color::rgb(235, 235, 225));
    for (row, column) in (0..pieces).flat_map(|row| (0..pieces).map(move |column| (row, column))) {
        let near = [corner(column, row), corner(column + 1, row)];
        let far = [corner(column, row + 1), corner(column + 1, row + 1)];
        for triangle in [[near[0], near[1], far[0]], [near[1], far[1], far[0]]] {
            let triangle = fit.triangle(triangle);
            step_parameter(triangle, interpolation, Walk::default(), framebuffer.scissor(), |x, y, point| {
                framebuffer.set(x, y, Color::truncated(texture.nearest(point.values, AddressMode::Repeat)));
            });
        }
    }
}

/// The floor, right.
fn floor(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    checkered_floor(framebuffer, knobs, Interpolation::PerspectiveCorrect);
}

/// The floor, wrong.
fn floor_affine(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    checkered_floor(framebuffer, knobs, Interpolation::Affine);
}
// ANCHOR_END: floor

fn main() -> ExitCode {
    CHAPTER.main()
}
