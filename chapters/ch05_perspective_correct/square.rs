//! A square that is turned away, interpolated in every way; and the square and the triangle that face us.

use std::f64::consts::PI;

use glam::dvec3;
use rasterbook::exact::edge::Coverage;
use rasterbook::figure::{Fit, Knob, Knobs};
use rasterbook::interpolate::{
    Interpolation, Projected, ScreenVertex, perspective_weights, step_parameter, step_values,
};
use rasterbook::payload::Walk;
use rasterbook::texture::{AddressMode, Texture};
use rasterbook::transform::{perspective, perspective_divide};
use rasterbook::{Color, Framebuffer};

pub(super) const TILTED: &[Knob] = &[
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
pub(super) fn vertex([x, y, z]: [f64; 3], uv: [f64; 2]) -> ScreenVertex<Projected<f64, 2>> {
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
    let left =
        [vertex([0.0, 0.0, distance], [0.0, 0.0]), vertex([0.0, 480.0, distance], [0.0, 1.0])];
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
        let (scissor, walk) = (framebuffer.scissor(), Walk::default());
        step_parameter(triangle, interpolation, walk, scissor, |x, y, point| {
            let texel = texture.nearest(point.values, AddressMode::Clamp);
            framebuffer.set(x, y, Color::truncated(texel));
        });
    }
}

/// The tilted square, right.
pub(super) fn correct(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    textured(framebuffer, knobs, Interpolation::PerspectiveCorrect);
}

/// The tilted square, wrong.
pub(super) fn affine(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    textured(framebuffer, knobs, Interpolation::Affine);
}

/// The tilted square, right in another way.
pub(super) fn reciprocal(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    textured(framebuffer, knobs, Interpolation::Reciprocal);
}
// ANCHOR_END: textured

// ANCHOR: barycentric
/// The tilted square by weights, pixel by pixel; the weights of areas are corrected by w.
pub(super) fn barycentric(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    let fit = Fit::new(framebuffer.rect(), [640.0, 480.0]);
    let (triangles, texture) = tilted_square(knobs);
    for triangle in triangles {
        let triangle = fit.triangle(triangle);
        let Some(coverage) = Coverage::new(triangle.map(|vertex| vertex.position)) else {
            continue;
        };
        for (x, y, areas) in coverage.pixels(framebuffer.scissor()) {
            let on_screen = areas.map(|area| area as f64 / coverage.twice_area as f64);
            let in_space = perspective_weights(on_screen, triangle.map(|vertex| vertex.varyings.w));
            let uv =
                [0, 1].map(|k| (0..3).map(|i| in_space[i] * triangle[i].varyings.values[k]).sum());
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
        let triangle = fit.triangle(triangle).map(|vertex| ScreenVertex {
            position: vertex.position,
            varyings: vertex.varyings.values,
        });
        step_values(triangle, Walk::default(), framebuffer.scissor(), |x, y, uv| {
            framebuffer.set(x, y, Color::truncated(texture.nearest(uv, AddressMode::Clamp)));
        });
    }
}

/// A triangle that faces us.
pub(super) fn facing(framebuffer: &mut Framebuffer) {
    let vertices =
        [([0.0, 0.0], [0.0, 0.0]), ([320.0, 480.0], [0.5, 1.0]), ([640.0, 0.0], [1.0, 0.0])];
    textured_as_before(framebuffer, &[vertices.map(|([x, y], uv)| vertex([x, y, 100.0], uv))]);
}

/// A square that faces us.
pub(super) fn square(framebuffer: &mut Framebuffer) {
    textured_as_before(framebuffer, &square_at(100.0, 0.0));
}
// ANCHOR_END: facing
