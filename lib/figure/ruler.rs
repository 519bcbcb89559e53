//! A frame around an enlarged picture that numbers its columns and rows, so that a pixel that is seen can be named.

use super::glyphs::{INK, LABEL_HEIGHT, PAPER, label, label_width};
use crate::framebuffer::Framebuffer;
use crate::rect::{Pixel, Rect};

/// A tick with a number is so long, one without is half as long.
const TICK: i32 = 8;
const TICK_WIDTH: i32 = 2;
const GAP: i32 = 4;
/// Numbers are at least so far apart: the longest has five digits.
const APART: i32 = 40;

/// The frame for a part of a picture, each pixel as a block of factor × factor, and where in it the part goes.
pub(super) fn ruler(part: Rect, factor: u32) -> (Framebuffer, Pixel) {
    let factor = factor as i32;
    let (step, small_step) = steps(factor);
    let numbers = part.rows().filter(|y| y % step == 0);
    let widest = numbers.map(|y| label_width(&y.to_string())).max().unwrap_or(0);
    let (left, bottom) = (GAP + widest + GAP + TICK, GAP + LABEL_HEIGHT + GAP + TICK);
    let (width, height) = (part.columns().len() as i32 * factor, part.rows().len() as i32 * factor);
    let (right, top) = (left + width + GAP, bottom + height + GAP);
    let mut frame = Framebuffer::new(right as u32, top as u32);
    frame.clear(PAPER);

    // Where the middle of a column or a row is, and how long its tick is.
    let middle = |from: i32, number: i32| from + number * factor + factor / 2;
    let tick = |number: i32| if number % step == 0 { TICK } else { TICK / 2 };
    for x in part.columns().filter(|x| x % small_step == 0) {
        let at = middle(left, x - part.left);
        let first = at - TICK_WIDTH / 2;
        frame.fill(
            Rect { left: first, bottom: bottom - tick(x), right: first + TICK_WIDTH, top: bottom },
            INK,
        );
        if x % step == 0 {
            let (text, from) = (x.to_string(), at - label_width(&x.to_string()) / 2);
            label(&mut frame, &text, (from.min(right - label_width(&text)), GAP), INK);
        }
    }
    for y in part.rows().filter(|y| y % small_step == 0) {
        let at = middle(bottom, y - part.bottom);
        let first = at - TICK_WIDTH / 2;
        frame.fill(Rect { left: left - tick(y), bottom: first, right: left, top: first + TICK_WIDTH }, INK);
        if y % step == 0 {
            let (text, from) = (y.to_string(), at - LABEL_HEIGHT / 2);
            let place = (left - TICK - GAP - label_width(&text), from);
            label(&mut frame, &text, place, INK);
        }
    }
    (frame, (left, bottom))
}

/// How many columns or rows apart the numbers are, and how many the ticks.
fn steps(factor: i32) -> (i32, i32) {
    let step = [1, 2, 5, 10].into_iter().find(|step| step * factor >= APART).unwrap_or(20);
    (step, if factor >= 8 { 1 } else { 5 })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The columns or rows along a line of the frame that show ink.
    fn inked(frame: &Framebuffer, pixels: impl Iterator<Item = Pixel>) -> Vec<usize> {
        pixels.enumerate().filter(|(_, (x, y))| frame.get(*x, *y) == Some(INK)).map(|(i, _)| i).collect()
    }

    #[test]
    fn numbers_are_as_close_as_they_can_be_read() {
        for factor in 2..=64 {
            let (step, small_step) = steps(factor);
            assert!(step * factor > label_width("16383"), "numbers overlap at {factor}");
            assert!(step == 1 || step * factor <= 2 * APART + 20, "too few numbers at {factor}");
            assert!(step % small_step == 0 && small_step * factor > 2 * TICK_WIDTH);
        }
        assert_eq!([2, 4, 8, 12, 64].map(steps), [(20, 5), (10, 5), (5, 1), (5, 1), (1, 1)]);
    }

    #[test]
    fn ticks_point_at_the_middle_of_their_pixels() {
        let part = Rect { left: 18, bottom: 7, right: 24, top: 12 };
        let (frame, (left, bottom)) = ruler(part, 10);
        assert_eq!((frame.width() as i32, frame.height() as i32), (left + 60 + GAP, bottom + 50 + GAP));
        assert_eq!((left, bottom), (GAP + label_width("10") + GAP + TICK, GAP + LABEL_HEIGHT + GAP + TICK));
        // Every column has a tick, that of column 20 is long.
        let right = frame.width() as i32;
        let short = inked(&frame, (left..right).map(|x| (x, bottom - 1)));
        assert_eq!(short, [4, 5, 14, 15, 24, 25, 34, 35, 44, 45, 54, 55]);
        assert_eq!(inked(&frame, (left..right).map(|x| (x, bottom - TICK))), [24, 25]);
        // The long one of the rows is that of row 10.
        assert_eq!(inked(&frame, (bottom..bottom + 50).map(|y| (left - TICK, y))), [34, 35]);
    }

    #[test]
    fn numbers_have_their_middle_at_their_tick() {
        let (frame, (left, bottom)) = ruler(Rect { left: 18, bottom: 7, right: 24, top: 12 }, 10);
        // Of a 2, a 1 and a 0, the lowest row has three dots, and there is one between two digits.
        let digits = |from: i32| [from..from + 6, from + 8..from + 14].into_iter().flatten();
        let width = label_width("20");
        let below = inked(&frame, (0..frame.width() as i32).map(|x| (x, GAP)));
        let middle = left + 25;
        assert_eq!(below, digits(middle - width / 2).map(|x| x as usize).collect::<Vec<_>>());
        let middle = bottom + 35;
        let beside = inked(&frame, (0..left - TICK).map(|x| (x, middle - LABEL_HEIGHT / 2)));
        assert_eq!(beside, digits(GAP).map(|x| x as usize).collect::<Vec<_>>());
    }

    #[test]
    fn there_is_room_for_the_longest_number_that_is_shown() {
        let (_, (left, _)) = ruler(Rect { left: 0, bottom: 98, right: 2, top: 102 }, 10);
        assert_eq!(left, GAP + label_width("100") + GAP + TICK, "of rows 98 to 101 only 100 has a number");
    }

    #[test]
    fn small_pictures_have_room_for_their_numbers() {
        let (frame, (left, _)) = ruler(Rect { left: 9_999, bottom: 0, right: 10_001, top: 1 }, 2);
        let top_of_label = GAP + LABEL_HEIGHT - 1;
        let ink = inked(&frame, (0..frame.width() as i32).map(|x| (x, top_of_label)));
        let right = frame.width() as usize;
        assert_eq!(ink.last().map(|last| right - last), Some(1), "{left}: {ink:?}");
        // The number of the only row, above that of the column, touches the upper border, and is not cut.
        let (below, top) = (GAP + LABEL_HEIGHT, frame.height() as i32);
        let rows = (0..6).flat_map(|x| inked(&frame, (below..top).map(|y| (GAP + x, y))));
        let rows: Vec<i32> = rows.map(|row| top - below - row as i32).collect();
        assert_eq!((rows.iter().max(), rows.iter().min()), (Some(&LABEL_HEIGHT), Some(&1)));
    }
}
