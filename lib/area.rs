//! Chapter 2: the signed area of a triangle, which side of an edge a point is on, and winding.
//!
//! One number answers three questions of the data flow: is there anything to draw (area 0 or not), which way does
//! the triangle face (the sign), and how much does each vertex weigh at a point (three areas, chapter 3).
//!
//! ```
//! use glam::dvec2;
//! use rasterbook::area::{Winding, twice_signed_area};
//!
//! let area = twice_signed_area(dvec2(0.0, 0.0), dvec2(4.0, 0.0), dvec2(0.0, 3.0));
//! assert_eq!(area, 12.0); // base 4, height 3: half of 12
//! assert_eq!(Winding::of(area), Some(Winding::CounterClockwise));
//! ```

use glam::DVec2;

/// An area smaller than this is that of a line or a point: nothing is drawn. Book, section 2.2.
pub const EPSILON: f64 = 1e-15;

// ANCHOR: twice_signed_area
/// Twice the signed area of the triangle a, b, c (input in any plane with y up; output in that
/// plane's units, squared).
///
/// The cross product of two edges, (b − a) × (c − a), multiplied out. Positive if a, b, c run
/// counter-clockwise:
///
/// ```text
///        c                     b
///       ╱ ╲        +          ╱ ╲        −
///      a ─ b                 a ─ c
/// ```
///
/// The book leaves out the division by two (section 2.2): only zero and the sign matter. The order
/// of the six products is the book's, and so is the rounding.
#[must_use]
#[inline]
pub fn twice_signed_area(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    a.x * b.y + b.x * c.y + c.x * a.y - a.x * c.y - b.x * a.y - c.x * b.y
}
// ANCHOR_END: twice_signed_area

/// Whether a triangle of this (doubled) area has anything to draw: not degenerate, and made of finite numbers.
#[must_use]
#[inline]
pub fn is_drawable(twice_area: f64) -> bool {
    twice_area.is_finite() && twice_area.abs() >= EPSILON
}

/// The direction in which the vertices of a triangle follow one another on the screen (y up). Book, section 9.3.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Winding {
    /// Against the clock: the signed area is positive.
    CounterClockwise,
    /// With the clock: the signed area is negative.
    Clockwise,
}

impl Winding {
    /// The winding that belongs to a signed area; `None` for zero and NaN.
    #[must_use]
    #[inline]
    pub fn of(signed_area: f64) -> Option<Self> {
        if signed_area > 0.0 {
            Some(Self::CounterClockwise)
        } else if signed_area < 0.0 {
            Some(Self::Clockwise)
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec2;

    #[test]
    fn area_of_a_triangle_on_a_grid() {
        // (1, 1) (6, 2) (3, 5): bounding box 5 × 4 = 20, less corners 2.5, 4.5 and 4 → 9.
        let [a, b, c] = [dvec2(1.0, 1.0), dvec2(6.0, 2.0), dvec2(3.0, 5.0)];
        assert_eq!(twice_signed_area(a, b, c), 18.0);
        assert_eq!(twice_signed_area(b, c, a), 18.0);
        assert_eq!(twice_signed_area(a, c, b), -18.0);
    }

    #[test]
    fn what_cannot_be_drawn() {
        let line = [dvec2(0.0, 0.0), dvec2(1.0, 1.0), dvec2(2.0, 2.0)];
        assert!(!is_drawable(twice_signed_area(line[0], line[1], line[2])));
        assert!(!is_drawable(f64::NAN));
        assert!(!is_drawable(f64::INFINITY));
        assert!(is_drawable(-0.5));
    }

    #[test]
    fn winding_is_the_sign() {
        assert_eq!(Winding::of(2.0), Some(Winding::CounterClockwise));
        assert_eq!(Winding::of(-2.0), Some(Winding::Clockwise));
        assert_eq!(Winding::of(0.0), None);
        assert_eq!(Winding::of(f64::NAN), None);
    }
}
