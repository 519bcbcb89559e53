//! Chapter 2: filling a triangle row by row.
//!
//! Takes three points on the screen, splits the triangle into two halves with a horizontal edge, walks up two edges of
//! each half and emits one span of pixels a row: coverage only. What is drawn in a span is the caller's business.
//!
//! ```
//! use glam::dvec2;
//! use rasterbook::scanline::{EdgeWalk, spans};
//! use rasterbook::Rect;
//!
//! let triangle = [dvec2(0.0, 0.0), dvec2(0.0, 4.0), dvec2(4.0, 0.0)];
//! let mut pixels = 0;
//! spans(triangle, EdgeWalk::Clamped, Rect::sized(8, 8), |span| pixels += span.columns().len());
//! assert_eq!(pixels, 5 + 4 + 3 + 2);
//! ```

use std::ops::Range;

use glam::{DVec2, dvec2};

use crate::area::{is_drawable, twice_signed_area};
use crate::rect::Rect;
use crate::scissor::Scissor;

/// Whether the two ends of a row may pass the ends of their edges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum EdgeWalk {
    /// x stops at the end of its edge. Book, section 2.2, the lines marked green.
    #[default]
    Clamped,
    /// x goes where the slope leads, a mistake.
    ///
    /// - Cause: on a nearly horizontal edge one step of y moves x by thousands of pixels, past the end of the edge.
    /// - Artefact: rows that shoot far out of the triangle.
    /// - Remedy: [`EdgeWalk::Clamped`]. Book, section 2.2, Figure 2-4.
    Unclamped,
}

// ANCHOR: spans
/// Emits the spans of a triangle, those of the lower half first. Screen space, in pixels, y up.
///
/// Nothing for a triangle without area or with coordinates that are not finite. Source: book,
/// section 2.2.
pub fn spans(
    triangle: [DVec2; 3],
    edge_walk: EdgeWalk,
    scissor: impl Into<Scissor>,
    mut emit: impl FnMut(Span),
) {
    let scissor = scissor.into();
    if let Some(Split { lower, upper, .. }) = split(triangle) {
        lower.spans(edge_walk, scissor.clone(), &mut emit);
        upper.spans(edge_walk, scissor, &mut emit);
    }
}
// ANCHOR_END: spans

/// An edge, from its lower end to its upper end. What is at an end is its position, unless said otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge<T = DVec2> {
    /// The lower end.
    pub start: T,
    /// The upper end.
    pub end: T,
}

/// One of the two halves of a triangle: below or above the horizontal line through its middle vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Half<T = DVec2> {
    /// The edge at which the rows begin.
    pub left: Edge<T>,
    /// The edge at which the rows end.
    pub right: Edge<T>,
}

/// A triangle that has been split at the height of its middle vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Split {
    /// The half below the middle vertex.
    pub lower: Half,
    /// The half above it.
    pub upper: Half,
    /// The vertices from bottom to top, P₁, P₂ and P₃: their numbers in the triangle.
    pub order: [usize; 3],
    /// Where on the long edge the new point P′ lies: 0 at P₁, 1 at P₃.
    pub t: f64,
    /// Whether P₂ is to the right of P′.
    pub is_middle_right: bool,
}

// ANCHOR: split
/// Splits a triangle at the height of its middle vertex P₂; the new point P′ lies on the long edge
/// P₁P₃.
///
/// ```text
///             P₃
///            ╱  ╲
///           ╱     ╲             upper half: left P₂P₃, right P′P₃
///         P₂ ─ ─ ─ ─P′
///           ╲        ╲          lower half: left P₁P₂, right P₁P′
///              ╲      ╲
///                 ╲    ╲        t = (y₂ − y₁) / (y₃ − y₁)
///                    ╲  ╲       P′ = P₁ + t (P₃ − P₁)
///                       P₁
/// ```
///
/// `None` for a triangle without area or with coordinates that are not finite. Source: book,
/// section 2.2, Figure 2-3.
#[must_use]
pub fn split(triangle: [DVec2; 3]) -> Option<Split> {
    let [a, b, c] = triangle;
    if !is_drawable(twice_signed_area(a, b, c)) {
        return None;
    }

    // Sort the vertices by height.
    let order = by_height(triangle);
    let [p1, p2, p3] = order.map(|i| triangle[i]);

    // Find P′ on the long edge.
    let t = (p2.y - p1.y) / (p3.y - p1.y);
    let p = dvec2(p1.x + (p3.x - p1.x) * t, p2.y);

    // Left is left.
    let is_middle_right = p2.x > p.x;
    let (left, right) = if is_middle_right { (p, p2) } else { (p2, p) };
    let [lower, upper] = halves(p1, left, right, p3);
    Some(Split { lower, upper, order, t, is_middle_right })
}
// ANCHOR_END: split

/// The lower half ends where the upper one starts.
#[inline]
pub(crate) fn halves<T: Copy>(low: T, left: T, right: T, high: T) -> [Half<T>; 2] {
    [
        Half { left: Edge { start: low, end: left }, right: Edge { start: low, end: right } },
        Half { left: Edge { start: left, end: high }, right: Edge { start: right, end: high } },
    ]
}

/// The numbers of the vertices from bottom to top; those of equal height keep their order.
#[inline]
fn by_height(triangle: [DVec2; 3]) -> [usize; 3] {
    let mut order = [0, 1, 2];
    for (i, j) in [(0, 1), (1, 2), (0, 1)] {
        if triangle[order[i]].y > triangle[order[j]].y {
            order.swap(i, j);
        }
    }
    order
}

/// Half of a triangle that is about to be filled: what [`Half::spans`] announces to observers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfFill {
    /// The half.
    pub half: Half,
    /// Whether x is kept between the ends of its edge.
    pub edges: EdgeWalk,
}

impl Half {
    /// Emits the spans of the half, from bottom to top.
    pub fn spans(&self, edges: EdgeWalk, scissor: impl Into<Scissor>, emit: impl FnMut(Span)) {
        let scissor = scissor.into();
        scissor.report(|observer| observer.begun(&HalfFill { half: *self, edges }));
        self.walk(edges, scissor.rect, emit);
        scissor.report(|observer| observer.done());
    }

    // ANCHOR: walk
    /// Walks up the left and the right edge of the half, a row at a time, and emits the span
    /// between them.
    ///
    /// Rows run from trunc(y) of the lower end while y is below the upper end. Source: book,
    /// section 2.2.
    #[inline]
    pub(crate) fn walk(&self, edges: EdgeWalk, scissor: Rect, mut emit: impl FnMut(Span)) {
        let (mut left, mut right) = (Side::new(&self.left), Side::new(&self.right));
        let top = self.left.end.y.min(f64::from(scissor.top));
        let mut y = self.left.start.y.trunc();

        // What lies below the scissor is skipped in one step.
        let skipped = f64::from(scissor.bottom) - y;
        if skipped > 0.0 {
            left.step(skipped);
            right.step(skipped);
            y = f64::from(scissor.bottom);
        }

        while y < top {
            if edges == EdgeWalk::Clamped {
                left.clamp();
                right.clamp();
            }
            emit(Span { y: y as i32, start: left.x, end: right.x, scissor });
            left.step(1.0);
            right.step(1.0);
            y += 1.0;
        }
    }
    // ANCHOR_END: walk
}

// ANCHOR: side
/// The left or the right edge of a half while the walk goes up: its x at the current row.
struct Side {
    x: f64,
    slope: f64,
    x_end: f64,
}

impl Side {
    fn new(edge: &Edge) -> Self {
        let slope = (edge.start.x - edge.end.x) / edge.rise();
        Self { x: edge.start.x, slope, x_end: edge.end.x }
    }

    /// x does not pass the end of its edge.
    fn clamp(&mut self) {
        if self.slope < 0.0 {
            self.x = self.x.max(self.x_end);
        } else if self.slope > 0.0 {
            self.x = self.x.min(self.x_end);
        }
    }

    fn step(&mut self, rows: f64) {
        self.x += self.slope * rows;
    }
}
// ANCHOR_END: side

impl Edge {
    /// How much lower the start is than the end, negative or 0.
    ///
    /// Slopes are quotients of two differences that are both taken backwards, as in the book: on a horizontal edge that
    /// decides the sign of an infinite slope, and with it what the clamp does there.
    #[inline]
    pub(crate) fn rise(&self) -> f64 {
        self.start.y - self.end.y
    }
}

/// The pixels of one row that a triangle covers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// The row.
    pub y: i32,
    /// Where it begins: x, in pixels.
    pub start: f64,
    /// Where it ends.
    pub end: f64,
    scissor: Rect,
}

impl Span {
    // ANCHOR: span
    /// The columns from trunc(start) while x ≤ end, within the scissor.
    #[must_use]
    pub fn columns(&self) -> Range<i32> {
        let first = (self.start as i32).max(self.scissor.left);
        let end = ((self.end.floor() + 1.0) as i32).min(self.scissor.right);
        if self.start <= self.end && first < end { first..end } else { 0..0 }
    }
    // ANCHOR_END: span
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Counts as an ASCII picture, the highest row on top, as on the screen: `.` for none.
    pub(crate) fn grid<const W: usize>(counts: &[[i32; W]]) -> String {
        let digit = |&count: &i32| if count == 0 { ".".to_owned() } else { count.to_string() };
        counts.iter().rev().map(|row| row.iter().map(digit).collect::<String>() + "\n").collect()
    }

    fn drawn(corners: [(f64, f64); 3], edges: EdgeWalk) -> String {
        let mut counts = [[0; 12]; 7];
        spans(corners.map(DVec2::from), edges, Rect::sized(12, 7), |span| {
            for x in span.columns() {
                counts[span.y as usize][x as usize] += 1;
            }
        });
        grid(&counts)
    }

    #[test]
    fn triangle_with_a_horizontal_base() {
        let expected = "\
            ............\n\
            ............\n\
            11..........\n\
            111.........\n\
            1111........\n\
            11111.......\n\
            111111......\n";
        assert_eq!(drawn([(0.0, 0.0), (5.0, 0.0), (0.0, 5.0)], EdgeWalk::Clamped), expected);
    }

    #[test]
    fn triangle_in_two_halves() {
        // The rows below the middle vertex (1, 3) belong to the lower half, row 3 and those above to the upper one.
        let expected = "\
            ............\n\
            ...111......\n\
            ..11111.....\n\
            .111111.....\n\
            ...11111....\n\
            .....111....\n\
            ........1...\n";
        assert_eq!(drawn([(8.0, 0.0), (1.0, 3.0), (5.0, 6.0)], EdgeWalk::Clamped), expected);
    }

    #[test]
    fn a_fractional_base_has_its_row_in_both_halves() {
        // The lower half has no height, and its slopes are not finite. To the right of the base x falls by 4/3 a row.
        let expected = "\
            ............\n\
            ............\n\
            ............\n\
            .1..........\n\
            .11.........\n\
            .111........\n\
            .22222......\n";
        assert_eq!(drawn([(1.0, 0.5), (5.0, 0.5), (1.0, 3.5)], EdgeWalk::Clamped), expected);
    }

    #[test]
    fn vertices_of_equal_height_keep_their_order() {
        let order = |triangle: [(f64, f64); 3]| split(triangle.map(DVec2::from)).expect("an area").order;
        assert_eq!(order([(0.0, 0.0), (0.0, 4.0), (4.0, 4.0)]), [0, 1, 2]);
        assert_eq!(order([(0.0, 0.0), (4.0, 0.0), (0.0, 4.0)]), [0, 1, 2]);
        assert_eq!(order([(0.0, 4.0), (4.0, 0.0), (0.0, 1.0)]), [1, 2, 0]);
    }

    #[test]
    fn nearly_horizontal_edges_overshoot_unless_clamped() {
        // Rows 1 and 2, and only 2/1000 of a pixel between them: one step of y moves x by more than 1000.
        // The row of a fractional middle vertex belongs to both halves, hence the 2s.
        let corners = [(5.0, 1.999), (3.0, 2.001), (7.5, 2.0011)];
        let clamped = "\
            ............\n\
            ............\n\
            ............\n\
            ............\n\
            ...22222....\n\
            .....1......\n\
            ............\n";
        let unclamped = "\
            ............\n\
            ............\n\
            ............\n\
            ............\n\
            111222221111\n\
            .....1......\n\
            ............\n";
        assert_eq!(drawn(corners, EdgeWalk::Clamped), clamped);
        assert_eq!(drawn(corners, EdgeWalk::Unclamped), unclamped);
    }

    #[test]
    fn no_area_no_numbers_no_pixels() {
        let inf = f64::INFINITY;
        for corners in [
            [(1.0, 1.0), (2.0, 2.0), (3.0, 3.0)],
            [(1.0, 1.0), (1.0, 1.0), (1.0, 1.0)],
            [(f64::NAN, 1.0), (5.0, 1.0), (1.0, 5.0)],
            [(inf, 1.0), (5.0, 1.0), (1.0, 5.0)],
            [(1.0, -inf), (5.0, 1.0), (1.0, 5.0)],
            [(f64::MAX, f64::MAX), (-f64::MAX, 1.0), (1.0, -f64::MAX)],
        ] {
            assert!(!drawn(corners, EdgeWalk::Clamped).contains('1'), "{corners:?}");
        }
    }

    #[test]
    fn huge_triangles_end() {
        let far = 1e30;
        let mut rows = 0;
        spans(
            [dvec2(-far, -far), dvec2(far, -far), dvec2(0.0, far)],
            EdgeWalk::Clamped,
            Rect::sized(1, 1),
            |span| {
                rows += 1;
                assert_eq!(span.columns(), 0..1);
            },
        );
        assert_eq!(rows, 1);
    }

    #[test]
    fn columns_at_the_ends_of_all_numbers() {
        let columns = |start, end, [left, right]: [i32; 2]| {
            let scissor = Rect { left, bottom: 0, right, top: 1 };
            Span { y: 0, start, end, scissor }.columns()
        };
        let (least, most) = (i32::MIN, i32::MAX);
        assert_eq!(columns(-1e300, 1e300, [least, most]), least..most);
        assert_eq!(columns(-1e300, -1e10, [0, 10]), 0..0);
        assert_eq!(columns(0.0, 1e300, [least, least]), 0..0, "a scissor without columns");
        assert_eq!(columns(2.0, 1e300, [0, most]), 2..most);
        assert_eq!(columns(f64::NAN, 3.0, [0, 10]), 0..0);
        assert_eq!(columns(2.0, 5.0, [0, 2]), 0..0, "it begins where the scissor ends");
    }

    fn point() -> impl Strategy<Value = DVec2> {
        (-20.0..60.0, -20.0..60.0).prop_map(DVec2::from)
    }

    proptest! {
        #[test]
        fn spans_stay_inside_the_bounding_box_and_the_scissor(a in point(), b in point(), c in point()) {
            let (low, high) = (a.min(b).min(c), a.max(b).max(c));
            let scissor = Rect::sized(40, 30);
            spans([a, b, c], EdgeWalk::Clamped, scissor, |span| {
                assert!(scissor.rows().contains(&span.y));
                assert!(f64::from(span.y) >= low.y.trunc() && f64::from(span.y) < high.y);
                for x in span.columns() {
                    assert!(scissor.columns().contains(&x));
                    assert!(f64::from(x) >= low.x.trunc() && f64::from(x) <= high.x);
                }
            });
        }
    }
}
