//! A floor to the horizon, interpolated in both ways.

use glam::dvec2;
use rasterbook::figure::{Fit, Knob, Knobs};
use rasterbook::interpolate::{Interpolation, ScreenVertex, step_parameter};
use rasterbook::payload::Walk;
use rasterbook::texture::{AddressMode, Texture};
use rasterbook::{Color, Framebuffer, Rect};

use super::square::vertex;

pub(super) const FLOOR: &[Knob] = &[
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
    let at = |column: i32, row: i32| {
        let [right, away] = [column, row].map(|index| f64::from(index) / f64::from(pieces));
        let (x, z) = (-720.0 + 1440.0 * right, 120.0 + 2400.0 * away);
        let seen = vertex([x, -height, z], [x / 240.0, z / 240.0]);
        ScreenVertex { position: dvec2(320.0, 240.0) + seen.position * 4.0, ..seen }
    };

    let texture = Texture::checkerboard(Color::rgb(50, 60, 80), Color::rgb(235, 235, 225));
    for (row, column) in (0..pieces).flat_map(|row| (0..pieces).map(move |column| (row, column))) {
        let near = [at(column, row), at(column + 1, row)];
        let far = [at(column, row + 1), at(column + 1, row + 1)];
        for triangle in [[near[0], near[1], far[0]], [near[1], far[1], far[0]]] {
            let triangle = fit.triangle(triangle);
            let (scissor, walk) = (framebuffer.scissor(), Walk::default());
            step_parameter(triangle, interpolation, walk, scissor, |x, y, point| {
                let texel = texture.nearest(point.values, AddressMode::Repeat);
                framebuffer.set(x, y, Color::truncated(texel));
            });
        }
    }
}

/// The floor, right.
pub(super) fn floor(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    checkered_floor(framebuffer, knobs, Interpolation::PerspectiveCorrect);
}

/// The floor, wrong.
pub(super) fn floor_affine(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    checkered_floor(framebuffer, knobs, Interpolation::Affine);
}
// ANCHOR_END: floor
