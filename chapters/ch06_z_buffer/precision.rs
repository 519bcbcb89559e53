//! How fine a depth is, near and far: the steps of a z-buffer and of a w-buffer.

use glam::dvec2;
use rasterbook::depth::{DepthTest, w_from_z, z_from_w};
use rasterbook::figure::{Fit, Knob, Knobs, Sketch};
use rasterbook::{Color, Framebuffer, Target};

use super::surfaces::{FAR_AWAY, GREEN, RED, draw, draw_square, seen_from_middle};

pub(super) const STEPS: &[Knob] = &[
    Knob::whole(
        "bits",
        4,
        [1, 8],
        "bits",
        "one bit more makes twice as many steps, each half as high",
    ),
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

    let last = f64::from((1 << bits) - 1);
    for y in framebuffer.rect().rows() {
        for x in framebuffer.rect().columns() {
            let distance = target.depth.get(x, y).unwrap_or(FAR_AWAY).min(far);
            let step = f64::from(step_of(encode(distance), bits));
            framebuffer.set(x, y, Color::gray((step * 255.0 / last) as u8));
        }
    }
}

/// Which of the steps that so many bits have holds a depth of 0..=1.
fn step_of(depth: f64, bits: i32) -> i32 {
    let steps = f64::from(1 << bits);
    (depth * steps).floor().clamp(0.0, steps - 1.0) as i32
}

/// As hardware stores it: Q (w − n) / w.
pub(super) fn depth(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    let (near, far) = (knobs.number("near"), knobs.number("far"));
    encoded_depths(framebuffer, knobs.whole("bits"), far, |w| z_from_w(w, near, far));
}

/// w itself, scaled to 0..=1.
pub(super) fn w_buffer(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    let (near, far) = (knobs.number("near"), knobs.number("far"));
    encoded_depths(framebuffer, knobs.whole("bits"), far, |w| linear_from_w(w, near, far));
}

/// A depth of 0 at the near plane and 1 at the far plane, linear in ω.
fn linear_from_w(w: f64, near: f64, far: f64) -> f64 {
    (w - near) / (far - near)
}
// ANCHOR_END: depth

pub(super) const ALONG_AXIS: &[Knob] = &[
    Knob::number(
        "near",
        1.0,
        [0.1, 6.0],
        "",
        "the near plane goes away from the eye: above the steps spread, and the pair is told apart; below little changes",
    ),
    Knob::number(
        "far",
        20.0,
        [8.0, 24.0],
        "",
        "the far plane comes closer: below all steps shrink, above next to none but the last",
    ),
    Knob::whole(
        "bits",
        4,
        [1, 7],
        "bits",
        "each bit cuts every step in two; above, half of them lie before 2, however many there are",
    ),
    Knob::number(
        "distance",
        12.0,
        [1.0, 22.0],
        "",
        "the pair comes closer: above one step after the other holds both, below none ever does",
    ),
];

/// The steps of a z-buffer (above) and of a w-buffer (below) along the view axis, the eye on the left. Two
/// surfaces are red and green; a step that holds both is orange: the test cannot tell which is in front.
pub(super) fn steps(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    let fit = Fit::new(framebuffer.rect(), [640.0, 320.0]);
    let [near, far, distance] = ["near", "far", "distance"].map(|name| knobs.number(name));
    let bits = knobs.whole("bits");
    let x_of = |distance: f64| 30.0 + 24.0 * distance;

    let mut sketch = Sketch::new(framebuffer, fit);
    sketch.line(dvec2(x_of(0.0), 40.0), dvec2(x_of(24.5), 40.0), 2.0, Color::gray(150));
    for mark in (0..25).step_by(4) {
        let x = x_of(f64::from(mark));
        sketch.line(dvec2(x, 35.0), dvec2(x, 45.0), 2.0, Color::gray(150));
        sketch.number(mark, dvec2(x, 20.0), Color::gray(200));
    }

    type OneWay = fn(f64, f64, f64) -> f64;
    let rows: [(f64, OneWay, OneWay); 2] = [
        (190.0, z_from_w, w_from_z),
        (65.0, linear_from_w, |depth, near, far| near + depth * (far - near)),
    ];
    for (bottom, depth_of, distance_of) in rows {
        let top = bottom + 105.0;
        let border =
            |step: i32| x_of(distance_of(f64::from(step) / f64::from(1 << bits), near, far));
        let [red, green] =
            [distance, distance + 1.5].map(|w| step_of(depth_of(w, near, far), bits));
        let is_seen = near <= distance && distance + 1.5 <= far;
        for step in 0..1 << bits {
            let color = match step {
                _ if is_seen && step == red && step == green => Color::rgb(240, 150, 50),
                _ if step % 2 == 0 => Color::rgb(40, 70, 115),
                _ => Color::rgb(28, 48, 80),
            };
            sketch.bar(dvec2(border(step), bottom), dvec2(border(step + 1), top), color);
        }
        for step in 0..=1 << bits {
            let x = border(step);
            sketch.bar(dvec2(x - 1.0, bottom), dvec2(x + 1.0, top), Color::rgb(140, 190, 245));
        }
        for (w, color) in [(distance, RED), (distance + 1.5, GREEN)] {
            sketch.line(dvec2(x_of(w), bottom + 15.0), dvec2(x_of(w), top - 15.0), 5.0, color);
        }
        sketch.dot(dvec2(x_of(0.0), (bottom + top) / 2.0), 7.0, Color::WHITE);
    }
}
