//! Positions on the screen in 1/256 pixel, in 32 bits, and what is computed of them for every triangle.

use crate::exact::edge::SUBPIXELS;
use crate::rect::Rect;

/// A position on the screen in 1/256 pixel, y up; at most 2²⁴ from the origin.
pub(super) type SnappedPosition = [i32; 2];

/// 1.5 · 2⁵²: a sum with it has no room for fractions, and its last bits are the nearest whole number.
pub(super) const NO_FRACTIONS: f64 = 6_755_399_441_055_744.0;

/// Twice the area of a triangle in 1/256 × 1/256 pixel, positive if it runs counter-clockwise.
#[inline(always)]
pub(super) fn signed_area([a, b, c]: [SnappedPosition; 3]) -> i64 {
    let difference = |to: SnappedPosition, axis: usize| i64::from(to[axis]) - i64::from(a[axis]);
    difference(b, 0) * difference(c, 1) - difference(b, 1) * difference(c, 0)
}

/// The pixels whose centers lie in the bounding box of a triangle, in the picture or not.
///
/// As [`Coverage::bounding_box`](crate::exact::edge::Coverage::bounding_box), but in the 32 bits that positions have here: it is
/// asked for every triangle, and once more in each of its tiles.
#[inline(always)]
pub(super) fn box_of([a, b, c]: [SnappedPosition; 3]) -> Rect {
    const PIXEL: i32 = SUBPIXELS as i32;
    let range = |axis: usize| {
        let (low, high) = (a[axis].min(b[axis]).min(c[axis]), a[axis].max(b[axis]).max(c[axis]));
        // The first center not below `low`, and the one after the last not above `high`; shifts round down.
        ((low + PIXEL / 2 - 1) >> 8, ((high - PIXEL / 2) >> 8) + 1)
    };
    let ((left, right), (bottom, top)) = (range(0), range(1));
    Rect { left, bottom, right, top }
}

/// Whether a rectangle is no larger than a square.
#[inline(always)]
pub(super) fn is_at_most(Rect { left, bottom, right, top }: Rect, side: i32) -> bool {
    right - left <= side && top - bottom <= side
}

/// What two rectangles share, if anything.
#[inline(always)]
pub(super) fn shared(a: Rect, b: Rect) -> Option<Rect> {
    let rect = a.intersection(b);
    (rect.left < rect.right && rect.bottom < rect.top).then_some(rect)
}
