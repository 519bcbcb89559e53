//! Which surface is in front: by the order of drawing, and by a depth for each pixel.

use std::f64::consts::PI;

use glam::{DVec2, dvec2, dvec3};
use rasterbook::depth::{DepthEncoding, DepthTest};
use rasterbook::figure::{Fit, Knob, Knobs};
use rasterbook::interpolate::{Interpolation, Projected, ScreenVertex, step_parameter};
use rasterbook::payload::Walk;
use rasterbook::texture::{AddressMode, Texture};
use rasterbook::transform::{perspective, perspective_divide};
use rasterbook::{Color, Framebuffer, Target};

pub(super) const SQUARES: &[Knob] = &[
    Knob::number(
        "tilt",
        30.0,
        [0.0, 80.0],
        "°",
        "the steeper the left square, the sooner it goes behind the other",
    ),
    Knob::number(
        "distance",
        150.0,
        [90.0, 340.0],
        "",
        "the square that faces us goes away: the line in which they meet moves to the right",
    ),
];

pub(super) const PIERCING: &[Knob] = &[
    Knob::number(
        "tips",
        420.0,
        [330.0, 770.0],
        "",
        "the tips go away: at 700 both triangles lie in one plane, beyond it they change sides",
    ),
    Knob::number(
        "red",
        0.0,
        [-220.0, 220.0],
        "",
        "the red triangle goes away: the line in which they meet moves, until green hides red in any order",
    ),
];

/// The depth that the buffer is cleared to: farther away than anything drawn.
pub(super) const FAR_AWAY: f64 = 1000.0;

pub(super) type Triangle<const N: usize> = [ScreenVertex<Projected<f64, N>>; 3];

// ANCHOR: vertex
/// Projects a point of the book's scene with its texture coordinates; its depth z is the third
/// value.
fn vertex([x, y, z]: [f64; 3], [u, v]: [f64; 2]) -> ScreenVertex<Projected<f64, 3>> {
    const NEAR: f64 = 80.0;
    let mut clip = perspective(dvec3(x, y, z), NEAR);
    // So that the divide leaves the depth: z · z / w = z.
    clip.z = DepthEncoding::ViewZ.clip_z(z, NEAR, FAR_AWAY);
    let screen = perspective_divide(clip);
    ScreenVertex {
        position: screen.truncate(),
        varyings: Projected { w: clip.w, values: [u, v, screen.z] },
    }
}
// ANCHOR_END: vertex

/// x and z of the right edge of a square of side 480, whose left edge is at x = 0 and z = 100.
fn tilted_side(degrees: f64) -> [f64; 2] {
    let (sin, cos) = libm::sincos(degrees * PI / 180.0);
    [480.0 * cos, 100.0 + 480.0 * sin]
}

// ANCHOR: z_buffer
/// Draws a triangle where it passes the test; its last value is its depth, `color_of` makes a color
/// of all of them.
pub(super) fn draw<const N: usize>(
    target: &mut Target,
    triangle: Triangle<N>,
    test: DepthTest,
    color_of: impl Fn([f64; N]) -> Color,
) {
    let Target { color, depth } = target;
    // The scenes are made for a picture of 640×480.
    let triangle = Fit::new(color.rect(), [640.0, 480.0]).triangle(triangle);
    let (interpolation, walk) = (Interpolation::PerspectiveCorrect, Walk::default());
    step_parameter(triangle, interpolation, walk, color.scissor(), |x, y, point| {
        if depth.test_and_set(x, y, point.values[N - 1], test) {
            color.set(x, y, color_of(point.values));
        }
    });
}

/// The tilted square of chapter 5, then a square that faces us.
pub(super) fn z_buffer(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    let distance = knobs.number("distance");
    let quad = |[x, z]: [f64; 2], left_z: f64, uv: [[f64; 2]; 4]| {
        let [a, b] = [vertex([0.0, 0.0, left_z], uv[0]), vertex([x, 0.0, z], uv[1])];
        let [c, d] = [vertex([0.0, 480.0, left_z], uv[2]), vertex([x, 480.0, z], uv[3])];
        [[a, b, c], [b, c, d]]
    };
    let tilted = quad(
        tilted_side(knobs.number("tilt")),
        100.0,
        [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]],
    );
    let facing =
        quad([480.0, distance], distance, [[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0]]);

    let mut target = Target::like(framebuffer);
    target.clear(Color::BLACK, FAR_AWAY);
    let texture = Texture::book();
    for triangle in tilted.into_iter().chain(facing) {
        draw(&mut target, triangle, DepthTest::LessOrEqual, |[u, v, _]| {
            Color::truncated(texture.nearest([u, v], AddressMode::Clamp))
        });
    }
    *framebuffer = target.color;
}
// ANCHOR_END: z_buffer

/// Projects a point of space (z into the screen) onto a picture of 640×480 whose middle the camera looks at.
pub(super) fn seen_from_middle(x: f64, y: f64, z: f64) -> ScreenVertex<Projected<f64, 1>> {
    let clip = perspective(dvec3(x, y, z), 500.0);
    let position: DVec2 = dvec2(320.0, 240.0) + perspective_divide(clip).truncate();
    ScreenVertex { position, varyings: Projected { w: clip.w, values: [z] } }
}

/// Draws a square that faces us, its lower left vertex given, as two triangles.
pub(super) fn draw_square(
    target: &mut Target,
    [x, y, z]: [f64; 3],
    side: f64,
    test: DepthTest,
    flat: Color,
) {
    let at = |i: f64, j: f64| seen_from_middle(x + i * side, y + j * side, z);
    draw(target, [at(0.0, 0.0), at(1.0, 0.0), at(0.0, 1.0)], test, |_| flat);
    draw(target, [at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)], test, |_| flat);
}

pub(super) const RED: Color = Color::rgb(225, 70, 60);
pub(super) const GREEN: Color = Color::rgb(80, 180, 90);
const BLUE: Color = Color::rgb(70, 120, 220);

// ANCHOR: painter
/// Three squares, the farthest first: each covers what is behind it.
pub(super) fn painter(framebuffer: &mut Framebuffer) {
    let mut target = Target::like(framebuffer);
    for (place, color) in [
        ([-60.0, -20.0, 800.0], RED),
        ([-130.0, -110.0, 600.0], GREEN),
        ([-20.0, -140.0, 450.0], BLUE),
    ] {
        draw_square(&mut target, place, 210.0, DepthTest::Always, color);
    }
    *framebuffer = target.color;
}
// ANCHOR_END: painter

// ANCHOR: intersecting
/// Two triangles that pierce each other: the red one is near at its tip on the right, the green one
/// on the left.
fn piercing(framebuffer: &mut Framebuffer, knobs: &Knobs, red_first: bool, test: DepthTest) {
    let (tips, red) = (knobs.number("tips"), knobs.number("red"));
    let red = [
        seen_from_middle(-330.0, -150.0, 700.0 + red),
        seen_from_middle(-330.0, 210.0, 700.0 + red),
        seen_from_middle(190.0, 20.0, tips + red),
    ];
    let green = [
        seen_from_middle(330.0, -210.0, 700.0),
        seen_from_middle(330.0, 150.0, 700.0),
        seen_from_middle(-190.0, -20.0, tips),
    ];
    let mut order = [(red, RED), (green, GREEN)];
    if !red_first {
        order.reverse();
    }

    let mut target = Target::like(framebuffer);
    target.clear(Color::BLACK, FAR_AWAY);
    for (triangle, color) in order {
        draw(&mut target, triangle, test, |_| color);
    }
    *framebuffer = target.color;
}

/// The painter's order, red first.
pub(super) fn painter_red_first(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    piercing(framebuffer, knobs, true, DepthTest::Always);
}

/// The painter's order, green first.
pub(super) fn painter_green_first(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    piercing(framebuffer, knobs, false, DepthTest::Always);
}

/// Any order, with a z-buffer.
pub(super) fn intersecting(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    piercing(framebuffer, knobs, true, DepthTest::LessOrEqual);
}
// ANCHOR_END: intersecting
