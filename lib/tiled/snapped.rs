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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::edge::Coverage;

    #[test]
    fn boxes_are_those_of_the_exact_rasterizer() {
        // From just before one center to just after the next, on both sides of the origin.
        for low in -400..400 {
            for size in [1, 127, 255, 256, 257, 5000] {
                let positions = [[low, -low], [low + size, 7], [0, size - low]];
                let Some(coverage) = Coverage::of(positions.map(|position| position.map(i64::from))) else {
                    continue;
                };
                let everything = Rect { left: -100, bottom: -100, right: 100, top: 100 };
                assert_eq!(box_of(positions), coverage.bounding_box(everything), "{positions:?}");
            }
        }
    }

    #[test]
    fn areas_have_a_sign_and_do_not_overflow() {
        let [a, b, c] = [[256, 128], [768, 640], [300, 1000]];
        let area = |positions| Coverage::of(positions).map(|coverage| coverage.twice_area);
        assert_eq!(Some(signed_area([a, b, c])), area([a, b, c].map(|position| position.map(i64::from))));
        assert_eq!(signed_area([a, c, b]), -signed_area([a, b, c]), "clockwise");
        assert_eq!(signed_area([a, b, b]), 0);
        let far = 1 << 24;
        assert_eq!(signed_area([[-far, -far], [far, -far], [far, far]]), 1 << 50);
    }

    #[test]
    fn a_rectangle_is_measured_along_both_sides() {
        let at = |width, height| Rect { left: -3, bottom: 5, right: width - 3, top: height + 5 };
        assert!(is_at_most(at(8, 8), 8));
        assert!(!is_at_most(at(9, 8), 8) && !is_at_most(at(8, 9), 8));
    }

    #[test]
    fn neighbors_share_nothing() {
        let rect = |left, bottom, right, top| Rect { left, bottom, right, top };
        let whole = rect(0, 0, 10, 10);
        assert_eq!(shared(whole, rect(5, 9, 20, 20)), Some(rect(5, 9, 10, 10)));
        assert_eq!(shared(whole, rect(10, 0, 20, 10)), None, "beside it");
        assert_eq!(shared(whole, rect(0, 10, 10, 20)), None, "above it");
    }
}
