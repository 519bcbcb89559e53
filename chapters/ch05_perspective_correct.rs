//! # Chapter 5: perspective-correct interpolation
//!
//! **Why does a texture bend when a surface is tilted?** Because equal steps on the screen are not equal steps in
//! space. The scanline walk stays as it is; what goes up its sides is now t′, a part of the way on the screen, and one
//! option says what a value at t′ is.
//!
//! New here: ω and the formula for V_p (`lib/interpolate.rs`). Book: chapter 5.

use std::process::ExitCode;

use glam::{dvec2, dvec3};
use rasterbook::exact::edge::Coverage;
use rasterbook::figure::{Chapter, Fit, Variant};
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
        Variant::new("floor", floor, "a checkered floor to the horizon: every line is straight, and the squares shrink towards the horizon"),
        Variant::new("correct", correct, "the tilted square, interpolated in space: the line between the colors is straight")
            .source("section 5.4, Figure 5-8"),
        Variant::new("affine", affine, "the same square, interpolated on the screen: the line between the colors breaks at the diagonal")
            .source("section 5.3, Figure 5-3")
            .remedied_by("correct"),
        Variant::new("facing", facing, "a projected triangle that faces us: chapter 3 is still enough").source("section 5.1, Figure 5-1"),
        Variant::new("square", square, "two triangles make a square that faces us: no seam, no bend").source("section 5.2, Figure 5-2"),
        Variant::new("reciprocal", reciprocal, "the tilted square again, by way of 1/ω and V/ω: compare it with 'correct', not one pixel differs")
            .source("section 5.5.4"),
        Variant::new("barycentric", barycentric, "the tilted square by weights: those of areas on the screen, each divided by its corner's ω")
            .source("first note"),
        Variant::new("floor-affine", floor_affine, "the same two triangles, interpolated on the screen: the floor folds along the diagonal")
            .remedied_by("floor"),
    ],
};

/// The distance of the projection plane in the book's scenes of this chapter.
const NEAR: f64 = 80.0;
/// How far to the right the tilted square reaches: 480 · cos 30°.
const TILTED_X: f64 = 415.692193816530;
/// How far away it is there: 100 + 480 · sin 30°.
const TILTED_Z: f64 = 340.0;

// ANCHOR: vertex
/// Projects a point with its texture coordinates. Screen coordinates are what the divide gives, and ω is kept.
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
/// A square of two triangles, its left side at z = 100 and its right side at (`x`, `z`).
fn square_to(x: f64, z: f64) -> [Triangle; 2] {
    let left = [vertex([0.0, 0.0, 100.0], [0.0, 0.0]), vertex([0.0, 480.0, 100.0], [0.0, 1.0])];
    let right = [vertex([x, 0.0, z], [1.0, 0.0]), vertex([x, 480.0, z], [1.0, 1.0])];
    [[left[0], right[0], left[1]], [right[0], left[1], right[1]]]
}
// ANCHOR_END: square_geometry

// ANCHOR: textured
/// Draws triangles with the book's texture; `interpolation` is the option of this chapter.
fn textured(framebuffer: &mut Framebuffer, triangles: &[Triangle], interpolation: Interpolation) {
    let fit = Fit::new(framebuffer.rect(), [640.0, 480.0]);
    let texture = Texture::book();
    for &triangle in triangles {
        let triangle = fit.triangle(triangle);
        step_parameter(triangle, interpolation, Walk::default(), framebuffer.scissor(), |x, y, point| {
            framebuffer.set(x, y, Color::truncated(texture.nearest(point.values, AddressMode::Clamp)));
        });
    }
}

/// The tilted square, right.
fn correct(framebuffer: &mut Framebuffer) {
    textured(framebuffer, &square_to(TILTED_X, TILTED_Z), Interpolation::PerspectiveCorrect);
}

/// The tilted square, wrong.
fn affine(framebuffer: &mut Framebuffer) {
    textured(framebuffer, &square_to(TILTED_X, TILTED_Z), Interpolation::Affine);
}

/// The tilted square, right in another way.
fn reciprocal(framebuffer: &mut Framebuffer) {
    textured(framebuffer, &square_to(TILTED_X, TILTED_Z), Interpolation::Reciprocal);
}
// ANCHOR_END: textured

// ANCHOR: barycentric
/// The tilted square by weights, pixel by pixel; the weights of areas are corrected by ω.
fn barycentric(framebuffer: &mut Framebuffer) {
    let fit = Fit::new(framebuffer.rect(), [640.0, 480.0]);
    let texture = Texture::book();
    for triangle in square_to(TILTED_X, TILTED_Z) {
        let triangle = fit.triangle(triangle);
        let coverage = Coverage::new(triangle.map(|corner| corner.position)).expect("area");
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
/// Draws triangles as chapter 3 does: values by equal steps on the screen, ω unused.
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
    textured_as_before(framebuffer, &square_to(480.0, 100.0));
}
// ANCHOR_END: facing

// ANCHOR: floor
/// A checkered floor of two triangles, from below our feet to far away.
fn checkered_floor(framebuffer: &mut Framebuffer, interpolation: Interpolation) {
    let fit = Fit::new(framebuffer.rect(), [640.0, 480.0]);
    framebuffer.clear(Color::rgb(70, 90, 70));
    let horizon = fit.at(dvec2(0.0, 240.0)).y as i32;
    framebuffer.fill(Rect { bottom: horizon, ..framebuffer.rect() }, Color::rgb(120, 170, 220));

    // The camera is 100 above the floor and looks at the middle of a picture of 640×480.
    let corner = |x: f64, z: f64| {
        let seen = vertex([x, -100.0, z], [x / 240.0, z / 240.0]);
        ScreenVertex { position: dvec2(320.0, 240.0) + seen.position * 4.0, ..seen }
    };
    let near = [corner(-720.0, 120.0), corner(720.0, 120.0)];
    let far = [corner(-720.0, 2520.0), corner(720.0, 2520.0)];

    let texture = Texture::checkerboard(Color::rgb(50, 60, 80), Color::rgb(235, 235, 225));
    for triangle in [[near[0], near[1], far[0]], [near[1], far[1], far[0]]] {
        let triangle = fit.triangle(triangle);
        step_parameter(triangle, interpolation, Walk::default(), framebuffer.scissor(), |x, y, point| {
            framebuffer.set(x, y, Color::truncated(texture.nearest(point.values, AddressMode::Repeat)));
        });
    }
}

/// The floor, right.
fn floor(framebuffer: &mut Framebuffer) {
    checkered_floor(framebuffer, Interpolation::PerspectiveCorrect);
}

/// The floor, wrong.
fn floor_affine(framebuffer: &mut Framebuffer) {
    checkered_floor(framebuffer, Interpolation::Affine);
}
// ANCHOR_END: floor

fn main() -> ExitCode {
    CHAPTER.main()
}
