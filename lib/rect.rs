//! Chapter 1: rectangles of pixels.
//!
//! Beside the data flow: what a stage may draw into is a rectangle, and so is a picture.
//!
//! ```
//! use rasterbook::Rect;
//!
//! let picture = Rect::sized(640, 480);
//! assert!(picture.contains(639, 479));
//! assert!(!picture.contains(640, 0)); // one column too far
//! ```

use std::ops::Range;

/// A pixel: its column, counted from the left, and its row, counted from the bottom.
///
/// Functions of a single pixel, such as [`Framebuffer::set`](crate::Framebuffer::set), and callbacks that emit pixels take
/// x and y by themselves, as the book does; where a pixel is kept or passed on, it is this pair.
pub type Pixel = (i32, i32);

/// A rectangle of pixels, half-open: `left ≤ x < right`, `bottom ≤ y < top`.
///
/// A picture is one; so is the part of it that a stage may draw into, its [scissor](crate::scissor).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rect {
    /// The first column.
    pub left: i32,
    /// The lowest row.
    pub bottom: i32,
    /// The column after the last.
    pub right: i32,
    /// The row above the highest.
    pub top: i32,
}

impl Rect {
    /// The rectangle of `width` × `height` pixels with its lower left pixel at (0, 0); a side has at most 2³¹ − 1.
    #[must_use]
    pub const fn sized(width: u32, height: u32) -> Self {
        const MOST: u32 = i32::MAX as u32;
        let [right, top] =
            [if width < MOST { width } else { MOST }, if height < MOST { height } else { MOST }];
        Self { left: 0, bottom: 0, right: right as i32, top: top as i32 }
    }

    /// Whether the pixel (x, y) belongs to the rectangle.
    #[must_use]
    #[inline]
    pub const fn contains(self, x: i32, y: i32) -> bool {
        self.left <= x && x < self.right && self.bottom <= y && y < self.top
    }

    /// Where the pixel (x, y) stands in a plane that holds the rectangle's rows one after the other, the lowest first;
    /// `None` outside, and beyond what `usize` holds: with 32 bits no plane has so many pixels.
    #[must_use]
    #[inline]
    pub const fn index(self, x: i32, y: i32) -> Option<usize> {
        // As `u32`, a negative difference is greater than any width: one comparison for each axis.
        let (column, row) = (x.wrapping_sub(self.left) as u32, y.wrapping_sub(self.bottom) as u32);
        let (width, height) = (length(self.left, self.right), length(self.bottom, self.top));
        let index = row as u64 * width as u64 + column as u64;
        if column < width && row < height && index <= usize::MAX as u64 { Some(index as usize) } else { None }
    }

    /// The pixels that belong to both rectangles; where there are none, a rectangle without pixels.
    #[must_use]
    #[inline]
    pub fn intersection(self, other: Self) -> Self {
        Self {
            left: self.left.max(other.left),
            bottom: self.bottom.max(other.bottom),
            right: self.right.min(other.right),
            top: self.top.min(other.top),
        }
    }

    /// The columns, from left to right.
    #[must_use]
    pub const fn columns(self) -> Range<i32> {
        self.left..self.right
    }

    /// The rows, from bottom to top.
    #[must_use]
    pub const fn rows(self) -> Range<i32> {
        self.bottom..self.top
    }

    /// All pixels, row by row from the bottom, each from left to right: as [`Rect::index`] counts them.
    pub fn pixels(self) -> impl Iterator<Item = Pixel> {
        self.rows().flat_map(move |y| self.columns().map(move |x| (x, y)))
    }
}

/// How many numbers there are from `from` up to, and without, `to`.
#[inline]
const fn length(from: i32, to: i32) -> u32 {
    if from < to { to.wrapping_sub(from) as u32 } else { 0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn sides_end_where_columns_and_rows_do() {
        let most = Rect { left: 0, bottom: 0, right: i32::MAX, top: i32::MAX };
        assert_eq!(Rect::sized(u32::MAX, 1 << 31), most);
        assert_eq!(Rect::sized(i32::MAX as u32, i32::MAX as u32), most);
        assert_eq!(Rect::sized(0, 3), Rect { left: 0, bottom: 0, right: 0, top: 3 });
    }

    proptest! {
        #[test]
        fn what_a_rectangle_contains_has_an_index(
            sides in prop::array::uniform4(prop_oneof![-9..9, any::<i32>(), Just(i32::MIN), Just(i32::MAX)]),
            x in prop_oneof![-9..9, any::<i32>(), Just(i32::MIN), Just(i32::MAX)],
            y in prop_oneof![-9..9, any::<i32>(), Just(i32::MIN), Just(i32::MAX)],
        ) {
            let [left, bottom, right, top] = sides;
            let rect = Rect { left, bottom, right, top };
            let [left, bottom, right, x, y] = [left, bottom, right, x, y].map(i128::from);
            let index = (y - bottom) * (right - left) + (x - left);
            let expected = rect.contains(x as i32, y as i32).then_some(index);
            let expected = expected.and_then(|index| usize::try_from(index).ok());
            prop_assert_eq!(rect.index(x as i32, y as i32), expected);
        }

        #[test]
        fn an_intersection_contains_what_both_contain(
            a in prop::array::uniform4(-9..9), b in prop::array::uniform4(-9..9), x in -10..10, y in -10..10,
        ) {
            let [a, b] = [a, b].map(|[left, bottom, right, top]| Rect { left, bottom, right, top });
            prop_assert_eq!(a.intersection(b).contains(x, y), a.contains(x, y) && b.contains(x, y));
        }

        #[test]
        fn pixels_come_in_the_order_of_their_indices(sides in prop::array::uniform4(-9..9)) {
            let [left, bottom, right, top] = sides;
            let rect = Rect { left, bottom, right, top };
            let indices: Vec<_> = rect.pixels().map(|(x, y)| rect.index(x, y)).collect();
            let expected: Vec<_> = (0..rect.columns().len() * rect.rows().len()).map(Some).collect();
            prop_assert_eq!(indices, expected);
        }
    }
}
