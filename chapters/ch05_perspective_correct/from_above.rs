//! Why t is not t′: the eye, the image plane and a line from above, and what is seen of the line.

use glam::{DVec2, dvec2, dvec3};
use rasterbook::figure::{Fit, Knob, Knobs, Sketch};
use rasterbook::interpolate::{Interpolation, Projected, ScreenVertex, step_parameter};
use rasterbook::payload::Walk;
use rasterbook::transform::{perspective, perspective_divide};
use rasterbook::{Color, Framebuffer};

pub(super) const FROM_ABOVE: &[Knob] = &[
    Knob::point(
        "a",
        [84.0, 200.0],
        "bring it to the height of b: now equal steps on the line are equal on the plane, and both strips agree",
    ),
    Knob::point(
        "b",
        [600.0, 452.0],
        "the higher it is above a, the more the rays crowd together at its end; the lower strip stays as it is",
    ),
    Knob::whole(
        "steps",
        6,
        [2, 16],
        "",
        "more steps: in the upper strip they get narrower from left to right, in the lower one all are equal",
    ),
    Knob::number(
        "near",
        150.0,
        [80.0, 170.0],
        "",
        "the plane goes away from the eye: the strips grow, and their borders keep their proportions",
    ),
];

/// The place of the eye in the picture.
const EYE: DVec2 = DVec2::new(320.0, 24.0);
/// How high a strip is.
const STRIP: f64 = 26.0;

/// A line from a to b in equal steps of t, x to the right and z upwards, and the rays from its points to the
/// eye. Below the plane the strip that is seen, then the same by affine interpolation.
pub(super) fn from_above(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    let fit = Fit::new(framebuffer.rect(), [640.0, 480.0]);
    let (near, steps) = (knobs.number("near"), knobs.whole("steps"));
    // Both ends stay behind the plane.
    let [a, b] = ["a", "b"].map(|name| {
        let place = knobs.point(name) - EYE;
        dvec2(place.x, place.y.max(near + 4.0))
    });
    let at = |step: i32| a + (b - a) * (f64::from(step) / f64::from(steps));
    let projected =
        |point: DVec2| perspective_divide(perspective(dvec3(point.x, 0.0, point.y), near)).x;

    let mut sketch = Sketch::new(framebuffer, fit);
    sketch.line(EYE + dvec2(-290.0, near), EYE + dvec2(290.0, near), 3.0, Color::gray(150));
    for step in 0..=steps {
        sketch.line(EYE, EYE + at(step), 2.0, Color::gray(110));
    }
    for step in 0..steps {
        sketch.line(EYE + at(step), EYE + at(step + 1), 9.0, band(step, steps));
    }
    for end in [a, b] {
        sketch.dot(EYE + end, 8.0, Color::WHITE);
    }
    sketch.dot(EYE, 8.0, Color::WHITE);

    let [from, to] = [a, b].map(projected);
    let behind = [from.min(to), from.max(to)].map(|x| EYE + dvec2(x, near - 2.0));
    sketch.bar(behind[0] - dvec2(0.0, 2.0 * STRIP + 4.0), behind[1], Color::BLACK);
    let ways = [Interpolation::PerspectiveCorrect, Interpolation::Affine];
    for (top, interpolation) in [near - 2.0, near - 4.0 - STRIP].into_iter().zip(ways) {
        // The t of an end is its value; in between it is interpolated.
        let vertex = |point: DVec2, t: f64, y: f64| ScreenVertex {
            position: fit.at(EYE + dvec2(projected(point), y)),
            varyings: Projected { w: point.y, values: [t] },
        };
        let [a_low, a_high] = [top - STRIP, top].map(|y| vertex(a, 0.0, y));
        let [b_low, b_high] = [top - STRIP, top].map(|y| vertex(b, 1.0, y));
        for triangle in [[a_low, b_low, a_high], [b_low, b_high, a_high]] {
            let scissor = sketch.framebuffer.scissor();
            step_parameter(triangle, interpolation, Walk::default(), scissor, |x, y, point| {
                let step = (point.values[0] * f64::from(steps)).floor() as i32;
                sketch.framebuffer.set(x, y, band(step, steps));
            });
        }
    }
    for step in 0..=steps {
        sketch.dot(EYE + dvec2(projected(at(step)), near), 4.0, Color::rgb(255, 220, 0));
    }
}

/// The color of a step: from orange through purple to blue, every second one darker.
fn band(step: i32, steps: i32) -> Color {
    let step = step.clamp(0, steps - 1);
    let t = f64::from(step) / f64::from(steps);
    let brightness = if step % 2 == 0 { 1.0 } else { 0.6 };
    let color = [255.0 - 175.0 * t, 150.0 - 260.0 * t * (1.0 - t), 60.0 + 195.0 * t];
    Color::truncated(color.map(|channel| channel * brightness))
}
