//! Digits of 3 × 5 dots, for what is written into pictures.

use crate::color::Color;
use crate::framebuffer::Framebuffer;
use crate::rect::{Pixel, Rect};

/// The digits from 0 on, their first row on top.
pub(super) const DIGITS: [[&str; 5]; 10] = [
    ["###", "#.#", "#.#", "#.#", "###"],
    [".#.", "##.", ".#.", ".#.", "###"],
    ["###", "..#", "###", "#..", "###"],
    ["###", "..#", ".##", "..#", "###"],
    ["#.#", "#.#", "###", "..#", "..#"],
    ["###", "#..", "###", "..#", "###"],
    ["###", "#..", "###", "#.#", "###"],
    ["###", "..#", ".#.", ".#.", ".#."],
    ["###", "#.#", "###", "#.#", "###"],
    ["###", "#.#", "###", "..#", "###"],
];
const PLUS: [&str; 5] = ["...", ".#.", "###", ".#.", "..."];

/// What is written beside pictures has this color, and stands on that one.
pub(crate) const INK: Color = Color::gray(215);
/// The color of what surrounds a picture.
pub(crate) const PAPER: Color = Color::gray(45);
/// So many pixels is a dot of a [`label`] wide.
pub(super) const DOT: i32 = 2;
/// How high a label is.
pub(crate) const LABEL_HEIGHT: i32 = 5 * DOT;

/// Draws a letter or a digit with its lower left dot at (left, bottom), each dot as a pixel.
pub(super) fn glyph(picture: &mut Framebuffer, rows: &[&str], place: Pixel, color: Color) {
    squares(rows, place, 1).for_each(|square| picture.fill(square, color));
}

/// Writes a number, `+` included, with its lower left pixel at (left, bottom).
pub(crate) fn label(picture: &mut Framebuffer, text: &str, place: Pixel, color: Color) {
    digits(text, place, DOT).for_each(|square| picture.fill(square, color));
}

/// The dots of such a number, each a square of `dot` pixels.
pub(super) fn digits(text: &str, (left, bottom): Pixel, dot: i32) -> impl Iterator<Item = Rect> {
    (0..).zip(text.chars()).flat_map(move |(place, c)| {
        let rows = c.to_digit(10).map_or(&PLUS, |digit| &DIGITS[digit as usize]);
        squares(rows, (dots_after(left, 4 * place, dot), bottom), dot)
    })
}

/// The dots of a letter or a digit.
fn squares(rows: &[&str], (left, bottom): Pixel, dot: i32) -> impl Iterator<Item = Rect> {
    (0..).zip(rows.iter().rev()).flat_map(move |(y, row)| {
        let marks = (0..).zip(row.chars()).filter(|(_, mark)| *mark == '#');
        marks.map(move |(x, _)| {
            let (left, bottom) = (dots_after(left, x, dot), dots_after(bottom, y, dot));
            Rect { left, bottom, right: dots_after(left, 1, dot), top: dots_after(bottom, 1, dot) }
        })
    })
}

/// The pixel that is `count` dots after another one; none is after the last that has a number.
const fn dots_after(from: i32, count: i32, dot: i32) -> i32 {
    from.saturating_add(count.saturating_mul(dot))
}

/// How wide a label is.
pub(crate) fn label_width(text: &str) -> i32 {
    (4 * text.chars().count() as i32 - 1).max(0) * DOT
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_label_fills_its_place() {
        let mut picture = Framebuffer::new(22, 12);
        label(&mut picture, "7+", (1, 1), Color::WHITE);
        let rows: Vec<String> = (0..12)
            .rev()
            .map(|y| {
                let mark = |x| if picture.get(x, y) == Some(Color::WHITE) { '#' } else { '.' };
                (0..22).map(mark).collect()
            })
            .collect();
        assert_eq!(rows[1], ".######...............");
        assert_eq!(rows[3], ".....##....##.........");
        assert_eq!(rows[5], "...##....######.......");
        assert_eq!(rows[10], "...##.................");
        assert_eq!((label_width("7+"), LABEL_HEIGHT), (14, 10));
    }
}
