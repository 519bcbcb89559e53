//! # Chapter 6: the z-buffer
//!
//! **Which surface is in front?** The painter draws what is far first. That fails as soon as two surfaces pass through
//! one another. The z-buffer decides anew at every pixel.
//!
//! New here: a depth for each pixel, and the depth test (`lib/depth.rs`). The depth is interpolated like any other
//! value, by chapter 5's formula. Book: chapter 6.

use std::f64::consts::PI;
use std::process::ExitCode;

use glam::{DVec2, dvec2, dvec3};
use rasterbook::depth::{DepthEncoding, DepthTest, z_from_w};
use rasterbook::figure::{Chapter, Fit, Knob, Knobs, Variant};
use rasterbook::interpolate::{Interpolation, Projected, ScreenVertex, step_parameter};
use rasterbook::payload::Walk;
use rasterbook::texture::{AddressMode, Texture};
use rasterbook::transform::{perspective, perspective_divide};
use rasterbook::{Color, Framebuffer, Target};

pub(crate) const CHAPTER: Chapter = Chapter {
    name: "ch06_z_buffer",
    question: "Which surface is in front?",
    variants: &[
        Variant::with_knobs("intersecting", intersecting, PIERCING, "the same with a z-buffer: each triangle is seen where it is nearer, and they meet in a line")
            .source("section 6.2, Figure 6-3"),
        Variant::with_knobs("z-buffer", z_buffer, SQUARES, "a tilted square and one that faces us: the tilted one is drawn first, and still in front where it is nearer")
            .source("section 6.2, Figure 6-5"),
        Variant::new("painter", painter, "three squares drawn from far to near, without a depth test: each covers what is behind it")
            .source("section 6.1, Figure 6-2"),
        Variant::with_knobs("painter-red-first", painter_red_first, PIERCING, "two triangles that pierce each other, red drawn first: green covers red also where red is nearer")
            .source("section 6.1, Figure 6-3").remedied_by("intersecting"),
        Variant::with_knobs("painter-green-first", painter_green_first, PIERCING, "the same, green drawn first: no order is right")
            .source("section 6.1, Figure 6-3").remedied_by("intersecting"),
        Variant::with_knobs("depth", depth, STEPS, "a z-buffer, as hardware stores it, in 16 grays: black is near (1), white is far (12); most of them lie close by"),
        Variant::with_knobs("w-buffer", w_buffer, STEPS, "the same scene with w stored, in 16 grays: black is near (1), white is far (12); each stands for the same distance"),
        Variant::with_knobs("uncleared", uncleared, FRAMES, "the second frame of a moving square, depths of the first not cleared: the old square cuts a hole into the new one")
            .source("section 6.2, section 9.4.1").remedied_by("cleared"),
        Variant::with_knobs("cleared", cleared, FRAMES, "the same frame, its depths cleared first: the square is whole").source("section 6.2"),
    ],
};

const SQUARES: &[Knob] = &[
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

const PIERCING: &[Knob] = &[
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

const STEPS: &[Knob] = &[
    Knob::whole("bits", 4, [1, 8], "bits", "one bit more makes twice as many steps, each half as high"),
    Knob::number(
        "near",
        1.0,
        [0.05, 1.0],
        "",
        "the near plane comes closer: in 'depth' nearly all turns white, in 'w-buffer' next to nothing changes",
    ),
    Knob::number(
        "far",
        12.0,
        [12.0, 100.0],
        "",
        "the far plane goes away: in 'depth' little changes, in 'w-buffer' all turns black",
    ),
];

const FRAMES: &[Knob] = &[Knob::number(
    "distance",
    500.0,
    [350.0, 900.0],
    "",
    "that of the green square: up to 450 it covers the depths of the red one, and is whole even if they stay",
)];

/// The depth that the buffer is cleared to: farther away than anything drawn.
const FAR_AWAY: f64 = 1000.0;

type Triangle<const N: usize> = [ScreenVertex<Projected<f64, N>>; 3];

// ANCHOR: vertex
/// Projects a point of the book's scene with its texture coordinates; its depth z is the third value.
fn vertex([x, y, z]: [f64; 3], [u, v]: [f64; 2]) -> ScreenVertex<Projected<f64, 3>> {
    const NEAR: f64 = 80.0;
    let mut clip = perspective(dvec3(x, y, z), NEAR);
    // So that the divide leaves the depth: z · z / w = z.
    clip.z = DepthEncoding::ViewZ.clip_z(z, NEAR, FAR_AWAY);
    let screen = perspective_divide(clip);
    ScreenVertex { position: screen.truncate(), varyings: Projected { w: clip.w, values: [u, v, screen.z] } }
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
fn draw<const N: usize>(
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
fn z_buffer(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    let distance = knobs.number("distance");
    let quad = |[x, z]: [f64; 2], left_z: f64, uv: [[f64; 2]; 4]| {
        let [a, b] = [vertex([0.0, 0.0, left_z], uv[0]), vertex([x, 0.0, z], uv[1])];
        let [c, d] = [vertex([0.0, 480.0, left_z], uv[2]), vertex([x, 480.0, z], uv[3])];
        [[a, b, c], [b, c, d]]
    };
    let tilted =
        quad(tilted_side(knobs.number("tilt")), 100.0, [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]]);
    let facing = quad([480.0, distance], distance, [[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0]]);

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
fn seen_from_middle(x: f64, y: f64, z: f64) -> ScreenVertex<Projected<f64, 1>> {
    let clip = perspective(dvec3(x, y, z), 500.0);
    let position: DVec2 = dvec2(320.0, 240.0) + perspective_divide(clip).truncate();
    ScreenVertex { position, varyings: Projected { w: clip.w, values: [z] } }
}

/// Draws a square that faces us, its lower left vertex given, as two triangles.
fn draw_square(target: &mut Target, [x, y, z]: [f64; 3], side: f64, test: DepthTest, flat: Color) {
    let corner = |i: f64, j: f64| seen_from_middle(x + i * side, y + j * side, z);
    draw(target, [corner(0.0, 0.0), corner(1.0, 0.0), corner(0.0, 1.0)], test, |_| flat);
    draw(target, [corner(1.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)], test, |_| flat);
}

const RED: Color = Color::rgb(225, 70, 60);
const GREEN: Color = Color::rgb(80, 180, 90);
const BLUE: Color = Color::rgb(70, 120, 220);

// ANCHOR: painter
/// Three squares, the farthest first: each covers what is behind it.
fn painter(framebuffer: &mut Framebuffer) {
    let mut target = Target::like(framebuffer);
    for (place, color) in
        [([-60.0, -20.0, 800.0], RED), ([-130.0, -110.0, 600.0], GREEN), ([-20.0, -140.0, 450.0], BLUE)]
    {
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
fn painter_red_first(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    piercing(framebuffer, knobs, true, DepthTest::Always);
}

/// The painter's order, green first.
fn painter_green_first(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    piercing(framebuffer, knobs, false, DepthTest::Always);
}

/// Any order, with a z-buffer.
fn intersecting(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    piercing(framebuffer, knobs, true, DepthTest::LessOrEqual);
}
// ANCHOR_END: intersecting

// ANCHOR: depth
/// A floor with posts, from the distance 1 to 12; each pixel's gray is what `encode` makes of its
/// distance, 0..=1, in as many steps as so many bits have.
fn encoded_depths(framebuffer: &mut Framebuffer, bits: i32, far: f64, encode: impl Fn(f64) -> f64) {
    let mut target = Target::like(framebuffer);
    target.clear(Color::BLACK, FAR_AWAY);
    let floor = |x: f64, z: f64| seen_from_middle(x, -0.5, z);
    let [a, b, c, d] = [floor(-12.0, 1.0), floor(12.0, 1.0), floor(12.0, 12.0), floor(-12.0, 12.0)];
    draw(&mut target, [a, b, c], DepthTest::LessOrEqual, |_| Color::BLACK);
    draw(&mut target, [a, c, d], DepthTest::LessOrEqual, |_| Color::BLACK);
    for (x, z) in [(-0.85, 1.5), (-0.72, 2.2), (-0.3, 3.4), (0.6, 4.5), (2.1, 6.5), (4.6, 9.5)] {
        draw_square(&mut target, [x, -0.5, z], 0.6, DepthTest::LessOrEqual, Color::BLACK);
    }

    let steps = f64::from(1 << bits);
    for y in framebuffer.rect().rows() {
        for x in framebuffer.rect().columns() {
            let distance = target.depth.get(x, y).unwrap_or(FAR_AWAY).min(far);
            let step = (encode(distance) * steps).floor().clamp(0.0, steps - 1.0);
            framebuffer.set(x, y, Color::gray((step * 255.0 / (steps - 1.0)) as u8));
        }
    }
}

/// As hardware stores it: Q (w − n) / w.
fn depth(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    let (near, far) = (knobs.number("near"), knobs.number("far"));
    encoded_depths(framebuffer, knobs.whole("bits"), far, |w| z_from_w(w, near, far));
}

/// w itself, scaled to 0..=1.
fn w_buffer(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    let (near, far) = (knobs.number("near"), knobs.number("far"));
    encoded_depths(framebuffer, knobs.whole("bits"), far, |w| (w - near) / (far - near));
}
// ANCHOR_END: depth

// ANCHOR: uncleared
/// Two frames of a square that moves to the right and away from us, to some distance.
fn two_frames(framebuffer: &mut Framebuffer, distance: f64, clear_depth: bool) {
    let mut target = Target::like(framebuffer);
    target.clear(Color::BLACK, FAR_AWAY);
    for (place, color) in [([-170.0, -110.0, 450.0], RED), ([-90.0, -60.0, distance], GREEN)] {
        target.color.clear(Color::BLACK);
        if clear_depth {
            target.depth.clear(FAR_AWAY);
        }
        draw_square(&mut target, place, 200.0, DepthTest::LessOrEqual, color);
    }
    *framebuffer = target.color;
}

/// The depths of the first frame stay.
fn uncleared(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    two_frames(framebuffer, knobs.number("distance"), false);
}

/// Each frame begins with cleared depths.
fn cleared(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    two_frames(framebuffer, knobs.number("distance"), true);
}
// ANCHOR_END: uncleared

fn main() -> ExitCode {
    CHAPTER.main()
}
