//! Surfaces that lie close together, near and far: ordinary depths cannot tell them apart, reversed ones can.

use glam::{DVec3, dvec2, dvec3};
use rasterbook::depth::{DepthBuffer, DepthFormat, DepthTest, reversed_z_from_w, z_from_w};
use rasterbook::figure::{Fit, Knob, Knobs, Sketch};
use rasterbook::interpolate::{Interpolation, Projected, ScreenVertex, step_parameter};
use rasterbook::payload::Walk;
use rasterbook::transform::{perspective, perspective_divide};
use rasterbook::{Color, Framebuffer, Pixel, Target};

use super::surfaces::{GREEN, RED, Triangle};

pub(super) const CLOSE: &[Knob] = &[
    Knob::number(
        "near",
        0.1,
        [0.01, 1.5],
        "",
        "the near plane goes away from the eye: in 'z-fighting' one red plate after the other becomes whole; in 'reversed' all are from the start",
    ),
    Knob::number(
        "gap",
        0.005,
        [0.00001, 0.02],
        "",
        "the plates leave their boards: in 'z-fighting' the far ones come into sight last, in 'reversed' all do at 0.00002",
    ),
    Knob::choice(
        "format",
        &["float32", "unorm24"],
        "24-bit integers have one step everywhere: reversing gains nothing, and 'reversed' is as bad",
    ),
];

/// The distance of the far plane.
const FAR: f64 = 1000.0;

/// How far away the boards are. They grow with the distance, so that all of them look equally large.
const DISTANCES: [u32; 8] = [2, 5, 10, 20, 50, 100, 200, 500];

// ANCHOR: fighting
/// Draws tilted green boards, then in front of each a red plate: `gap` nearer to the eye, at every
/// point as it is seen. `depth_of` makes a depth of a distance, and the buffer rounds it.
fn boards(
    framebuffer: &mut Framebuffer,
    knobs: &Knobs,
    depth_of: fn(f64, f64, f64) -> f64,
    test: DepthTest,
) {
    let [near, gap] = ["near", "gap"].map(|name| knobs.number(name));
    let format = match knobs.choice("format") {
        "unorm24" => DepthFormat::Unorm24,
        _ => DepthFormat::Float32,
    };
    let mut target = Target::like(framebuffer);
    target.clear(Color::BLACK, format.stored(depth_of(FAR, near, FAR)));
    for (middle, distance) in places() {
        for (nearer, reach, color) in [(0.0, 1.0, GREEN), (gap, 0.65, RED)] {
            for triangle in board(middle, distance - nearer) {
                draw(&mut target, triangle, |depths, (x, y), w, [u, v]| {
                    let depth = format.stored(depth_of(w, near, FAR));
                    let is_on_it = u.abs().max(v.abs()) <= reach;
                    (is_on_it && depths.test_and_set(x, y, depth, test)).then_some(color)
                });
            }
        }
    }
    *framebuffer = target.color;
    label(framebuffer);
}

/// 0 at the near plane, 1 at the far plane; what is smaller is in front.
pub(super) fn z_fighting(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    boards(framebuffer, knobs, z_from_w, DepthTest::Less);
}

/// 1 at the near plane, 0 at the far plane; what is larger is in front.
pub(super) fn reversed(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    boards(framebuffer, knobs, reversed_z_from_w, DepthTest::Greater);
}
// ANCHOR_END: fighting

/// Where the middle of each board is seen, as a point at the distance 1, and how far away it is.
fn places() -> impl Iterator<Item = (DVec3, f64)> {
    DISTANCES.into_iter().enumerate().map(|(index, distance)| {
        let (column, row) = (index % 4, index / 4);
        (dvec3(column as f64 * 0.3 - 0.45, 0.26 - row as f64 * 0.44, 1.0), distance.into())
    })
}

/// A tilted square whose middle is seen there, as two triangles; u and v go from −1 to 1. At any distance it covers the
/// same pixels, and at each of them it is so much nearer or farther.
fn board(middle: DVec3, distance: f64) -> [Triangle<2>; 2] {
    // Both directions have the length 1, and they are perpendicular.
    let (right, up) = (dvec3(0.96, 0.0, 0.28), dvec3(-0.168, 0.8, 0.576));
    let vertex = |u: f64, v: f64| {
        let clip = perspective((middle + (right * u + up * v) * 0.135) * distance, 500.0);
        let position = dvec2(320.0, 240.0) + perspective_divide(clip).truncate();
        ScreenVertex { position, varyings: Projected { w: clip.w, values: [u, v] } }
    };
    let [a, b, c, d] = [vertex(-1.0, -1.0), vertex(1.0, -1.0), vertex(1.0, 1.0), vertex(-1.0, 1.0)];
    [[a, b, c], [a, c, d]]
}

/// Draws a triangle: `shade` tests the depth of a pixel, and gives a color if it passes.
fn draw<const N: usize>(
    target: &mut Target,
    triangle: Triangle<N>,
    shade: impl Fn(&mut DepthBuffer, Pixel, f64, [f64; N]) -> Option<Color>,
) {
    let Target { color, depth } = target;
    let triangle = Fit::new(color.rect(), [640.0, 480.0]).triangle(triangle);
    let (interpolation, walk) = (Interpolation::PerspectiveCorrect, Walk::default());
    step_parameter(triangle, interpolation, walk, color.scissor(), |x, y, point| {
        if let Some(shaded) = shade(depth, (x, y), point.w, point.values) {
            color.set(x, y, shaded);
        }
    });
}

/// Writes the distances below the boards.
fn label(framebuffer: &mut Framebuffer) {
    let fit = Fit::new(framebuffer.rect(), [640.0, 480.0]);
    let mut sketch = Sketch::new(framebuffer, fit);
    for ((middle, _), distance) in places().zip(DISTANCES) {
        let below = dvec2(320.0 + 500.0 * middle.x, 240.0 + 500.0 * middle.y - 88.0);
        sketch.number(distance, below, Color::gray(200));
    }
}
