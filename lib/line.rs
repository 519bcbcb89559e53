//! Chapter 2: lines, by a digital differential analyzer (DDA).
//!
//! Takes two points on the screen and emits the pixels of the segment between them; the caller colors them.
//!
//! ```
//! use glam::dvec2;
//! use rasterbook::{Color, Framebuffer, line};
//!
//! let mut framebuffer = Framebuffer::new(8, 8);
//! let scissor = framebuffer.scissor();
//! line::dda(dvec2(0.0, 1.0), dvec2(3.0, 4.0), line::StepAxis::Longer, scissor, |x, y| {
//!     framebuffer.set(x, y, Color::RED);
//! });
//! assert_eq!(framebuffer.get(2, 3), Some(Color::RED));
//! ```

use std::ops::Range;

use glam::DVec2;

use crate::rect::Pixel;
use crate::scissor::Scissor;

/// Which coordinate a line steps by one pixel at a time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StepAxis {
    /// The axis along which the line is longer: the other coordinate moves by at most one pixel a step.
    #[default]
    Longer,
    /// Always x, a mistake.
    ///
    /// - Cause: on a y-major line y moves by more than one pixel from one column to the next.
    /// - Artefact: the line falls apart into dots; a vertical one vanishes.
    /// - Remedy: [`StepAxis::Longer`]. Book, section 2.1, Figure 2-2.
    X,
}

/// A line on the screen, in pixels: what [`dda`] draws, and announces to observers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// One end.
    pub a: DVec2,
    /// The other end.
    pub b: DVec2,
    /// Which coordinate is stepped.
    pub axis: StepAxis,
}

/// Emits the pixels of the line from `a` to `b` (screen space, pixels) that lie in the scissor.
///
/// The running coordinate goes up by one from the lower end, the other one by the slope; the pixel is where both are
/// rounded down to whole numbers (the book cuts them, which is the same but for negative ones). The right end, of a y-major
/// line the upper end, is not drawn: a chain draws no joint twice while it goes on to the right by x-major lines, or upwards
/// by y-major ones. Elsewhere both lines may draw the joint, or neither: (0, 9) to (3, 0) to (9, 0) has (3, 0) twice.
///
/// ```text
///     y                    k = Δy/Δx = 1/3
///     2 │ . . . . . . b
///     1 │ . . . # # # .    x = 0 1 2 3 4 5, y = 0, ⅓, ⅔, 1, 4/3, 5/3
///     0 │ # # # . . . .
/// ```
///
/// From `b` to `a` the pixels are the same: a line always runs from its left end, or from its lower end if it is y-major.
/// A point that is not finite draws nothing, nor does a line so long that its extent is not. Source: book, section 2.1.
pub fn dda(a: DVec2, b: DVec2, axis: StepAxis, scissor: impl Into<Scissor>, mut emit: impl FnMut(i32, i32)) {
    if !(b - a).is_finite() {
        return;
    }
    let (line, scissor) = (Line { a, b, axis }, scissor.into());
    scissor.report(|observer| observer.begun(&line));
    let Scissor { rect, .. } = scissor;
    let visible = if line.is_x_major() { rect.columns() } else { rect.rows() };
    line.step(visible, |(x, y), _| {
        if rect.contains(x, y) {
            emit(x, y);
        }
    });
    scissor.report(|observer| observer.done());
}

impl Line {
    /// Δy/Δx.
    #[must_use]
    pub fn slope(&self) -> f64 {
        (self.b.y - self.a.y) / (self.b.x - self.a.x)
    }

    /// Whether x is stepped by one pixel at a time, not y: the line is x-major.
    #[must_use]
    pub fn is_x_major(&self) -> bool {
        self.slope().abs() < 1.0 || self.axis == StepAxis::X
    }

    // ANCHOR: dda
    /// Emits the pixels of the line, from left to right or, if it is y-major, from bottom to top;
    /// `visible` are the columns or the rows that can be seen. With each pixel the running
    /// coordinate and the other one, before they are rounded down.
    pub(crate) fn step(&self, visible: Range<i32>, mut emit: impl FnMut(Pixel, [f64; 2])) {
        let Self { a, b, .. } = *self;
        if self.is_x_major() {
            // Step x from the left end.
            let (start, end) = if a.x < b.x { (a, b) } else { (b, a) };
            step_by_one([start.x, start.y], end.x, self.slope(), visible, |x, y| {
                emit((x.floor() as i32, y.floor() as i32), [x, y]);
            });
        } else {
            // Step y from the lower end.
            let (start, end) = if a.y < b.y { (a, b) } else { (b, a) };
            let slope = 1.0 / self.slope();
            step_by_one([start.y, start.x], end.y, slope, visible, |y, x| {
                emit((x.floor() as i32, y.floor() as i32), [y, x]);
            });
        }
    }
}

/// Steps the first coordinate by one while it is below `end`, and the second by `slope`, within
/// `visible`.
fn step_by_one(
    [mut along, mut across]: [f64; 2],
    end: f64,
    slope: f64,
    visible: Range<i32>,
    mut emit: impl FnMut(f64, f64),
) {
    // What lies before the first visible pixel is skipped in one step.
    let skipped = f64::from(visible.start) - along.floor();
    if skipped > 0.0 {
        along = f64::from(visible.start) + (along - along.floor());
        across += slope * skipped;
    }
    while along < end.floor() && along < f64::from(visible.end) {
        emit(along, across);
        along += 1.0;
        across += slope;
    }
}
// ANCHOR_END: dda

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rect::Rect;
    use glam::dvec2;
    use proptest::prelude::*;

    /// The pixels of a line in a scissor of 8 × 6, as a reader would draw them; a `2` would be a pixel drawn twice.
    fn drawn(a: DVec2, b: DVec2, axis: StepAxis) -> String {
        let mut counts = [[0; 8]; 6];
        dda(a, b, axis, Rect::sized(8, 6), |x, y| counts[y as usize][x as usize] += 1);
        crate::scanline::tests::grid(&counts)
    }

    fn pixels(a: DVec2, b: DVec2) -> Vec<(i32, i32)> {
        let mut pixels = Vec::new();
        dda(a, b, StepAxis::Longer, Rect::sized(200, 200), |x, y| pixels.push((x, y)));
        pixels
    }

    #[test]
    fn flat_line() {
        let expected = "\
            ........\n\
            ........\n\
            ........\n\
            ........\n\
            ...111..\n\
            111.....\n";
        assert_eq!(drawn(dvec2(0.0, 0.0), dvec2(6.0, 2.0), StepAxis::Longer), expected);
    }

    #[test]
    fn steep_line() {
        let expected = "\
            ........\n\
            ..1.....\n\
            ..1.....\n\
            .1......\n\
            .1......\n\
            .1......\n";
        assert_eq!(drawn(dvec2(1.0, 0.0), dvec2(3.0, 5.0), StepAxis::Longer), expected);
    }

    #[test]
    fn steep_line_stepped_by_x_has_gaps() {
        let expected = "\
            ........\n\
            ........\n\
            ........\n\
            ..1.....\n\
            ........\n\
            .1......\n";
        assert_eq!(drawn(dvec2(1.0, 0.0), dvec2(3.0, 5.0), StepAxis::X), expected);
    }

    #[test]
    fn no_numbers_no_pixels_no_hang() {
        let far = 1e30;
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(pixels(dvec2(bad, 0.0), dvec2(5.0, 5.0)).is_empty());
            assert!(pixels(dvec2(0.0, 0.0), dvec2(5.0, bad)).is_empty());
        }
        assert!(pixels(dvec2(3.0, 3.0), dvec2(3.0, 3.0)).is_empty(), "a line without length");
        assert_eq!(pixels(dvec2(-far, 7.0), dvec2(far, 7.0)).len(), 200, "a line across the whole scissor");
        assert_eq!(pixels(dvec2(7.0, -far), dvec2(7.0, far)).len(), 200);
        assert!(pixels(dvec2(far, far), dvec2(2.0 * far, far)).is_empty());
        assert!(pixels(dvec2(-f64::MAX, 7.0), dvec2(f64::MAX, 8.0)).is_empty(), "Δx is infinite");
    }

    #[test]
    fn what_lies_left_of_or_below_zero_is_outside() {
        assert!(pixels(dvec2(1.0, -0.5), dvec2(6.0, -0.9)).is_empty(), "below row 0");
        assert!(pixels(dvec2(-0.9, 1.0), dvec2(-0.5, 6.0)).is_empty(), "left of column 0");
        assert_eq!(pixels(dvec2(-1.5, 2.0), dvec2(2.5, 2.0)), [(0, 2), (1, 2)], "no column twice");
    }

    #[test]
    fn what_is_skipped_counts() {
        // x = −1.5 −0.5 0.5 1.5 2.5 3.5 4.5 5.5, and y goes from 0 up by ½: of them x ≥ 2 is seen.
        let (a, b) = (dvec2(-1.5, 0.0), dvec2(6.5, 4.0));
        let seen = Rect { left: 2, bottom: 0, right: 200, top: 200 };
        let mut columns = Vec::new();
        dda(a, b, StepAxis::Longer, seen, |x, y| columns.push((x, y)));
        assert_eq!(columns, [(2, 2), (3, 2), (4, 3), (5, 3)]);
        // The same along y.
        let seen = Rect { left: 0, bottom: 2, right: 200, top: 200 };
        let mut rows = Vec::new();
        dda(dvec2(a.y, a.x), dvec2(b.y, b.x), StepAxis::Longer, seen, |x, y| rows.push((y, x)));
        assert_eq!(rows, columns);

        let mut steps = Vec::new();
        Line { a: dvec2(0.0, 1.0), b: dvec2(9.0, 1.0), axis: StepAxis::Longer }
            .step(3..5, |pixel, _| steps.push(pixel));
        assert_eq!(steps, [(3, 1), (4, 1)], "no step beyond what is visible");
    }

    #[test]
    fn a_diagonal_is_y_major() {
        let is_x_major = |x, y, axis| Line { a: DVec2::ZERO, b: dvec2(x, y), axis }.is_x_major();
        for (x, y, expected) in [(2.0, 2.0, false), (2.0, -2.0, false), (2.1, 2.0, true), (2.0, -2.1, false)]
        {
            assert_eq!(is_x_major(x, y, StepAxis::Longer), expected, "({x}, {y})");
            assert!(is_x_major(x, y, StepAxis::X));
        }
    }

    #[test]
    fn joints() {
        let count = |chain: &[DVec2], joint: Pixel| {
            let lines = chain.windows(2).flat_map(|ends| pixels(ends[0], ends[1]));
            lines.filter(|&pixel| pixel == joint).count()
        };
        let [flat, steep] = [dvec2(8.0, 2.0), dvec2(2.0, 8.0)];
        assert_eq!(count(&[DVec2::ZERO, flat, flat + flat], (8, 2)), 1, "on to the right");
        assert_eq!(count(&[DVec2::ZERO, steep, steep + steep], (2, 8)), 1, "on upwards");
        assert_eq!(
            count(&[dvec2(0.0, 9.0), dvec2(3.0, 0.0), dvec2(9.0, 0.0)], (3, 0)),
            2,
            "from steep to flat"
        );
        assert_eq!(count(&[DVec2::ZERO, flat, dvec2(0.0, 4.0)], (8, 2)), 0, "turned back");
    }

    proptest! {
        #[test]
        fn flat_chains_to_the_right_draw_no_column_twice(
            start in (-20.0..20.0, -20.0..20.0), steps in prop::collection::vec((0.1..30.0, -1.0..1.0), 1..8),
        ) {
            let mut chain = vec![DVec2::from(start)];
            for (along, slope) in steps {
                let last = chain[chain.len() - 1];
                chain.push(last + dvec2(along, along * slope));
            }
            let mut columns: Vec<i32> = Vec::new();
            for ends in chain.windows(2).filter(|ends| Line { a: ends[0], b: ends[1], axis: StepAxis::Longer }.is_x_major()) {
                let line = Line { a: ends[0], b: ends[1], axis: StepAxis::Longer };
                line.step(-100..200, |(x, _), _| columns.push(x));
            }
            prop_assert!(columns.windows(2).all(|pair| pair[0] < pair[1]), "{columns:?}");
        }

        #[test]
        fn both_directions_cover_the_same_pixels(
            ax in -50.0..250.0, ay in -50.0..250.0, bx in -50.0..250.0, by in -50.0..250.0,
        ) {
            let (a, b) = (dvec2(ax, ay), dvec2(bx, by));
            prop_assert_eq!(pixels(a, b), pixels(b, a));
        }

        #[test]
        fn neighbors_touch(ax in 0.0..200.0, ay in 0.0..200.0, bx in 0.0..200.0, by in 0.0..200.0) {
            for pair in pixels(dvec2(ax, ay), dvec2(bx, by)).windows(2) {
                prop_assert!((pair[0].0 - pair[1].0).abs() <= 1 && (pair[0].1 - pair[1].1).abs() <= 1);
            }
        }
    }
}
