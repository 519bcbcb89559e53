//! What the colors of an overdraw picture mean, in the picture.

use super::overdraw::HEAT;
use crate::color::Color;
use crate::figure::glyphs::{INK, LABEL_HEIGHT, PAPER, label, label_width};
use crate::figure::picture::paste;
use crate::framebuffer::Framebuffer;
use crate::rect::Rect;

const OUTLINE: Color = Color::gray(120);
const SWATCH: i32 = 12;
const GAP: i32 = 6;

/// What the colors mean, in a line, for those who have no picture with a legend.
#[must_use]
pub fn heat_legend() -> String {
    let last = HEAT.len() - 1;
    let more = |count: usize| if count == last { "+" } else { "" };
    let colors: Vec<String> =
        HEAT.iter().enumerate().map(|(count, (_, name))| format!("{name} {count}{}", more(count))).collect();
    format!("how often each pixel was written: {}", colors.join(", "))
}

/// The picture with a strip below it: a swatch of each color and how many writes it stands for; the picture alone, if with
/// the strip it would be too high for a framebuffer.
#[must_use]
pub fn with_legend(picture: Framebuffer) -> Framebuffer {
    let last = HEAT.len() - 1;
    let text = |count: usize| if count == last { format!("{count}+") } else { count.to_string() };
    let (cell, row) = (SWATCH + GAP + label_width(&text(last)) + GAP, LABEL_HEIGHT + GAP);
    // Of what does not fit beside the others, a row of its own.
    let width = (picture.width() as i32).max(GAP + cell);
    let in_a_row = (width - GAP) / cell;
    let strip = GAP + (HEAT.len() as i32 + in_a_row - 1) / in_a_row * row;
    let height = picture.height() as i32 + strip;
    if height > Framebuffer::MAX_SIDE as i32 {
        return picture;
    }
    let mut result = Framebuffer::new(width as u32, height as u32);
    result.clear(PAPER);
    paste(&mut result, &picture, 0, strip);
    for (count, (color, _)) in HEAT.iter().enumerate() {
        let (column, down) = (count as i32 % in_a_row, count as i32 / in_a_row);
        let (left, bottom) = (GAP + column * cell, strip - (down + 1) * row);
        let swatch = Rect { left, bottom, right: left + SWATCH, top: bottom + LABEL_HEIGHT };
        result.fill(swatch, OUTLINE);
        let Rect { left, bottom, right, top } = swatch;
        result.fill(Rect { left: left + 1, bottom: bottom + 1, right: right - 1, top: top - 1 }, *color);
        label(&mut result, &text(count), (right + GAP, bottom), INK);
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_names_every_color_and_its_count() {
        let line = heat_legend();
        for (count, (_, name)) in HEAT.iter().enumerate() {
            assert!(line.contains(&format!("{name} {count}")), "{line}");
        }
        assert!(line.ends_with(&format!("{}+", HEAT.len() - 1)), "the last one stands for more, too: {line}");
    }

    #[test]
    fn colors_stand_side_by_side_in_their_order() {
        let result = with_legend(Framebuffer::new(640, 480));
        let cell = SWATCH + GAP + label_width("6+") + GAP;
        for (left, (color, _)) in (GAP..).step_by(cell as usize).zip(HEAT) {
            let (right, top) = (left + SWATCH - 1, GAP + LABEL_HEIGHT - 1);
            for (x, y) in (GAP..=top).flat_map(|y| (left..=right).map(move |x| (x, y))) {
                let is_outline = x == left || x == right || y == GAP || y == top;
                let expected = if is_outline { OUTLINE } else { color };
                assert_eq!(result.get(x, y), Some(expected), "({x}, {y})");
            }
            assert_eq!(result.get(right + 1, top), Some(PAPER));
        }
    }

    #[test]
    fn beside_each_color_stands_its_count() {
        let result = with_legend(Framebuffer::new(640, 480));
        let cell = SWATCH + GAP + label_width("6+") + GAP;
        for (i, text) in ["0", "1", "2", "3", "4", "5", "6+"].into_iter().enumerate() {
            let mut expected = Framebuffer::new(cell as u32, LABEL_HEIGHT as u32);
            expected.clear(PAPER);
            label(&mut expected, text, (GAP, 0), INK);
            let left = GAP + i as i32 * cell + SWATCH;
            for (x, y) in expected.rect().pixels().filter(|(x, _)| *x < cell - SWATCH) {
                assert_eq!(result.get(left + x, GAP + y), expected.get(x, y), "{text} ({x}, {y})");
            }
        }
    }

    #[test]
    fn every_color_is_below_a_picture_of_any_width() {
        for (size, expected) in [
            ((640, 480), (640, 480 + 22)),
            ((160, 120), (160, 120 + 38)),
            ((100, 10), (100, 10 + 70)),
            ((1, 1), (44, 1 + 118)),
            // Two cells of 38 and a gap, and one pixel less.
            ((82, 1), (82, 1 + 70)),
            ((81, 1), (81, 1 + 118)),
            ((20, Framebuffer::MAX_SIDE - 118), (44, Framebuffer::MAX_SIDE)),
            ((20, Framebuffer::MAX_SIDE), (20, Framebuffer::MAX_SIDE)),
        ] {
            let mut picture = Framebuffer::new(size.0, size.1);
            picture.clear(Color::GREEN);
            let result = with_legend(picture);
            assert_eq!((result.width(), result.height()), expected);
            let below = (expected.1 - size.1) as i32;
            assert_eq!(result.get(0, below), Some(Color::GREEN));
            assert_eq!(result.get(0, expected.1 as i32 - 1), Some(Color::GREEN), "the picture stays whole");
            let has =
                |color| (0..below).any(|y| (0..expected.0 as i32).any(|x| result.get(x, y) == Some(color)));
            assert!(below == 0 || HEAT.iter().all(|(color, _)| has(*color)), "{size:?}");
        }
    }
}
