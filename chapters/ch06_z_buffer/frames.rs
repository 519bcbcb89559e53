//! Two frames of something that moves: depths are cleared before each, or are not.

use rasterbook::depth::DepthTest;
use rasterbook::figure::{Knob, Knobs};
use rasterbook::{Color, Framebuffer, Target};

use super::surfaces::{FAR_AWAY, GREEN, RED, draw_square};

pub(super) const FRAMES: &[Knob] = &[Knob::number(
    "distance",
    500.0,
    [350.0, 900.0],
    "",
    "that of the green square: up to 450 it covers the depths of the red one, and is whole even if they stay",
)];

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
pub(super) fn uncleared(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    two_frames(framebuffer, knobs.number("distance"), false);
}

/// Each frame begins with cleared depths.
pub(super) fn cleared(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    two_frames(framebuffer, knobs.number("distance"), true);
}
// ANCHOR_END: uncleared
