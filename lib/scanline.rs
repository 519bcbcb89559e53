//! Chapter 2: filling a triangle row by row.
//!
//! Takes three corners on the screen, splits the triangle into two halves with a level edge, walks up both sides of
//! each half and emits one span of pixels a row: coverage only. What is drawn in a span is the caller's business, and
//! so is what a corner carries besides its position (its *attributes*), and what is stepped along the two sides (the
//! *payload*): nothing in chapter 2, values in chapter 3, the parameter t in chapter 5.
//!
//! ```
//! use glam::dvec2;
//! use rasterbook::scanline::{Corner, Walk, split};
//! use rasterbook::Rect;
//!
//! let corners = [dvec2(0.0, 0.0), dvec2(0.0, 4.0), dvec2(4.0, 0.0)].map(|position| Corner { position, attributes: () });
//! let mut pixels = 0;
//! for half in split(corners, |(), (), _| ()).into_iter().flatten() {
//!     half.walk(|_| [(), ()], Walk::default(), Rect::sized(8, 8), |span| pixels += span.columns().len());
//! }
//! assert_eq!(pixels, 5 + 4 + 3 + 2);
//! ```

use std::ops::Range;

use glam::{DVec2, dvec2};

use crate::Rect;
use crate::area::{is_drawable, twice_signed_area};
use crate::probe::Window;

/// Whether the two sides of a row may pass the ends of their edges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum EdgeWalk {
    /// x stops at the end of its edge. Book, section 2.2, the lines marked green.
    #[default]
    Clamped,
    /// x goes where the slope leads, a mistake.
    ///
    /// - Cause: on a nearly level edge one step of y moves x by thousands of pixels, past the end of the edge.
    /// - Artefact: rows that shoot far out of the triangle.
    /// - Remedy: [`EdgeWalk::Clamped`]. Book, section 2.2, Figure 2-4.
    Unclamped,
}

/// Whether a payload may pass the value that it has at the end of what it is stepped along.
///
/// A row stands for the height trunc(y), an edge ends at its own height: the last step may go beyond it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StepLimit {
    /// Nothing is limited, a mistake.
    ///
    /// - Cause: the last row of an edge lies up to one pixel beyond the edge's end, and so does the last pixel of a row.
    /// - Artefact: values outside the range of the vertices; in a texture, texels from beyond the triangle ("spikes").
    /// - Remedy: [`StepLimit::Edges`] as in the book (chapter 11), or [`StepLimit::Everywhere`].
    Overrun,
    /// Limited along the two sides after each row, not along the row: the book's remedy. The last pixel of a row may
    /// still pass the end, and a depth that is stepped beside t is not limited.
    #[default]
    Edges,
    /// Limited along the sides and along the row, depth included: nothing leaves the range of the vertices.
    Everywhere,
}

/// The options of the walk.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Walk {
    /// Whether x is kept between the ends of its edge.
    pub edges: EdgeWalk,
    /// Whether the payload is kept between its values at the ends.
    pub limit: StepLimit,
}

/// Something that changes by equal steps from one end of an edge, or of a row, to the other.
pub trait Payload: Copy {
    /// The step for one pixel, from `start` to `end` over `length` pixels: (end − start) / length.
    #[must_use]
    fn slope(start: Self, end: Self, length: f64) -> Self;
    /// This value after `count` steps.
    #[must_use]
    fn stepped(self, slope: Self, count: f64) -> Self;
    /// This value, but not beyond `end` as seen from `start`; `limit` is not [`StepLimit::Overrun`].
    #[must_use]
    fn limited(self, start: Self, end: Self, limit: StepLimit) -> Self;
}

/// Chapter 2: nothing but coverage.
impl Payload for () {
    fn slope((): (), (): (), _: f64) {}
    fn stepped(self, (): (), _: f64) {}
    fn limited(self, (): (), (): (), _: StepLimit) {}
}

/// One number: a coordinate, or the parameter t of chapter 5.
impl Payload for f64 {
    fn slope(start: Self, end: Self, length: f64) -> Self {
        (end - start) / length
    }

    fn stepped(self, slope: Self, count: f64) -> Self {
        self + slope * count
    }

    fn limited(self, start: Self, end: Self, _: StepLimit) -> Self {
        if end > start {
            self.min(end)
        } else if end < start {
            self.max(end)
        } else {
            self
        }
    }
}

/// Chapter 3: several values, each by itself.
impl<P: Payload, const N: usize> Payload for [P; N] {
    fn slope(start: Self, end: Self, length: f64) -> Self {
        std::array::from_fn(|i| P::slope(start[i], end[i], length))
    }

    fn stepped(self, slope: Self, count: f64) -> Self {
        std::array::from_fn(|i| self[i].stepped(slope[i], count))
    }

    fn limited(self, start: Self, end: Self, limit: StepLimit) -> Self {
        std::array::from_fn(|i| self[i].limited(start[i], end[i], limit))
    }
}

/// A corner of a triangle on the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner<A> {
    /// Screen space, in pixels, y up.
    pub position: DVec2,
    /// What else belongs to the corner.
    pub attributes: A,
}

impl<A> Corner<A> {
    /// The same corner with other attributes.
    pub fn with<B>(&self, attributes: B) -> Corner<B> {
        Corner { position: self.position, attributes }
    }
}

/// An edge, from its lower end to its upper end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge<A> {
    /// The lower end.
    pub start: Corner<A>,
    /// The upper end.
    pub end: Corner<A>,
}

/// One of the two halves of a triangle: below or above the level line through its middle vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Half<A> {
    /// The side at which the rows begin.
    pub left: Edge<A>,
    /// The side at which the rows end.
    pub right: Edge<A>,
}

// ANCHOR: split
/// Splits a triangle at the height of its middle vertex P₂; the new point P′ lies on the long edge P₁P₃.
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
/// Lower half first. `between` gives the attributes at the parameter t between two corners. `None` for a triangle
/// without area or with coordinates that are not finite. Source: book, section 2.2, Figure 2-3.
pub fn split<A: Copy>(corners: [Corner<A>; 3], between: impl Fn(A, A, f64) -> A) -> Option<[Half<A>; 2]> {
    let [a, b, c] = corners.map(|corner| corner.position);
    if !is_drawable(twice_signed_area(a, b, c)) {
        return None;
    }

    // Sort the corners by height.
    let [p1, p2, p3] = sorted_by_height(corners);

    // Find P′ on the long edge.
    let t = (p2.position.y - p1.position.y) / (p3.position.y - p1.position.y);
    let x = p1.position.x + (p3.position.x - p1.position.x) * t;
    let p =
        Corner { position: dvec2(x, p2.position.y), attributes: between(p1.attributes, p3.attributes, t) };

    // Left is left.
    let (left, right) = if p2.position.x > p.position.x { (p, p2) } else { (p2, p) };
    Some([
        Half { left: Edge { start: p1, end: left }, right: Edge { start: p1, end: right } },
        Half { left: Edge { start: left, end: p3 }, right: Edge { start: right, end: p3 } },
    ])
}
// ANCHOR_END: split

/// The corners from bottom to top; those of equal height keep their order.
fn sorted_by_height<A: Copy>([mut low, mut middle, mut high]: [Corner<A>; 3]) -> [Corner<A>; 3] {
    let sort = |a: &mut Corner<A>, b: &mut Corner<A>| {
        if a.position.y > b.position.y {
            std::mem::swap(a, b);
        }
    };
    sort(&mut low, &mut middle);
    sort(&mut middle, &mut high);
    sort(&mut low, &mut middle);
    [low, middle, high]
}

impl<A: Copy> Half<A> {
    // ANCHOR: walk
    /// Walks up both sides of the half, a row at a time, and emits the span between them, within `window`.
    ///
    /// Rows run from trunc(y) of the lower end while y is below the upper end. `payload` says what is stepped along an
    /// edge: its values at the edge's start and end. Source: book, sections 2.2 and 3.2.4.
    pub fn walk<P: Payload>(
        &self,
        payload: impl Fn(&Edge<A>) -> [P; 2],
        walk: Walk,
        window: impl Into<Window>,
        mut emit: impl FnMut(Span<P>),
    ) {
        let window = window.into();
        let ends = |edge: &Edge<A>| [edge.start.position, edge.end.position];
        window.tell(|probe| probe.half(ends(&self.left), ends(&self.right), walk));
        self.walk_rows(payload, walk, window.rect, &mut emit);
        window.tell(|probe| probe.done());
    }

    fn walk_rows<P: Payload>(
        &self,
        payload: impl Fn(&Edge<A>) -> [P; 2],
        walk: Walk,
        window: Rect,
        mut emit: impl FnMut(Span<P>),
    ) {
        let mut left = Side::new(&self.left, payload(&self.left));
        let mut right = Side::new(&self.right, payload(&self.right));
        let end = self.left.end.position.y.min(f64::from(window.top));
        let mut y = self.left.start.position.y.trunc();

        // What lies below the window is passed over in one stride.
        let skipped = f64::from(window.bottom) - y;
        if skipped > 0.0 {
            left.step(skipped, walk.limit);
            right.step(skipped, walk.limit);
            y = f64::from(window.bottom);
        }

        while y < end {
            if walk.edges == EdgeWalk::Clamped {
                left.clamp();
                right.clamp();
            }
            emit(Span {
                y: y as i32,
                ends: [left.x, right.x],
                payload: [left.value, right.value],
                walk,
                window,
            });
            left.step(1.0, walk.limit);
            right.step(1.0, walk.limit);
            y += 1.0;
        }
    }
    // ANCHOR_END: walk
}

/// One side of a half while the walk goes up: its x and its payload at the running row.
struct Side<P> {
    x: f64,
    x_slope: f64,
    x_end: f64,
    value: P,
    value_slope: P,
    value_ends: [P; 2],
}

impl<P: Payload> Side<P> {
    fn new<A>(edge: &Edge<A>, value_ends: [P; 2]) -> Self {
        let [start, end] = [edge.start.position, edge.end.position];
        // Both differences are taken backwards, as in the book: on a level edge that decides the sign of an infinite
        // slope, and with it what the clamp does there.
        let height = start.y - end.y;
        Self {
            x: start.x,
            x_slope: f64::slope(end.x, start.x, height),
            x_end: end.x,
            value: value_ends[0],
            value_slope: P::slope(value_ends[1], value_ends[0], height),
            value_ends,
        }
    }

    fn clamp(&mut self) {
        if self.x_slope < 0.0 {
            self.x = self.x.max(self.x_end);
        } else if self.x_slope > 0.0 {
            self.x = self.x.min(self.x_end);
        }
    }

    fn step(&mut self, rows: f64, limit: StepLimit) {
        self.x = self.x.stepped(self.x_slope, rows);
        self.value = self.value.stepped(self.value_slope, rows);
        if limit != StepLimit::Overrun {
            self.value = self.value.limited(self.value_ends[0], self.value_ends[1], limit);
        }
    }
}

/// The pixels of one row that a triangle covers, with the payload at both ends.
#[derive(Clone, Copy, Debug)]
pub struct Span<P> {
    /// The row.
    pub y: i32,
    /// Where the row begins and where it ends: x, in pixels.
    pub ends: [f64; 2],
    /// The payload there.
    pub payload: [P; 2],
    walk: Walk,
    window: Rect,
}

impl<P> Span<P> {
    // ANCHOR: span
    /// The columns from trunc(start) while x ≤ end, within the window.
    #[must_use]
    pub fn columns(&self) -> Range<i32> {
        let [start, end] = self.ends;
        let first = (start as i32).max(self.window.left);
        let last = (end.floor() as i32).min(self.window.right - 1);
        if start <= end && first <= last { first..last + 1 } else { 0..0 }
    }

    /// Steps a payload along the row, from its value at the start to its value at the end, a pixel at a time.
    pub fn step<Q: Payload>(&self, from: Q, to: Q, mut emit: impl FnMut(i32, Q)) {
        let columns = self.columns();
        let [start, end] = self.ends;
        let slope = Q::slope(from, to, end - start);
        let skipped = f64::from(columns.start) - start.trunc();
        let mut value = if skipped > 0.0 { from.stepped(slope, skipped) } else { from };
        for x in columns {
            if self.walk.limit == StepLimit::Everywhere {
                value = value.limited(from, to, StepLimit::Everywhere);
            }
            emit(x, value);
            value = value.stepped(slope, 1.0);
        }
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

    fn walk_all(corners: [DVec2; 3], walk: Walk, window: Rect, mut emit: impl FnMut(Span<()>)) {
        let corners = corners.map(|position| Corner { position, attributes: () });
        for half in split(corners, |(), (), _| ()).into_iter().flatten() {
            half.walk(|_| [(), ()], walk, window, &mut emit);
        }
    }

    fn drawn(corners: [(f64, f64); 3], walk: Walk) -> String {
        let mut counts = [[0; 12]; 7];
        walk_all(corners.map(DVec2::from), walk, Rect::sized(12, 7), |span| {
            for x in span.columns() {
                counts[span.y as usize][x as usize] += 1;
            }
        });
        grid(&counts)
    }

    #[test]
    fn triangle_with_a_level_base() {
        let expected = "\
            ............\n\
            ............\n\
            11..........\n\
            111.........\n\
            1111........\n\
            11111.......\n\
            111111......\n";
        assert_eq!(drawn([(0.0, 0.0), (5.0, 0.0), (0.0, 5.0)], Walk::default()), expected);
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
        assert_eq!(drawn([(8.0, 0.0), (1.0, 3.0), (5.0, 6.0)], Walk::default()), expected);
    }

    #[test]
    fn nearly_level_edges_overshoot_unless_clamped() {
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
        assert_eq!(drawn(corners, Walk::default()), clamped);
        assert_eq!(drawn(corners, Walk { edges: EdgeWalk::Unclamped, ..Walk::default() }), unclamped);
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
            assert!(!drawn(corners, Walk::default()).contains('1'), "{corners:?}");
        }
    }

    #[test]
    fn huge_triangles_end() {
        let far = 1e30;
        let mut rows = 0;
        walk_all(
            [dvec2(-far, -far), dvec2(far, -far), dvec2(0.0, far)],
            Walk::default(),
            Rect::sized(1, 1),
            |span| {
                rows += 1;
                assert_eq!(span.columns(), 0..1);
            },
        );
        assert_eq!(rows, 1);
    }

    fn point() -> impl Strategy<Value = DVec2> {
        (-20.0..60.0, -20.0..60.0).prop_map(DVec2::from)
    }

    proptest! {
        #[test]
        fn spans_stay_inside_the_bounding_box_and_the_window(a in point(), b in point(), c in point()) {
            let (low, high) = (a.min(b).min(c), a.max(b).max(c));
            let window = Rect::sized(40, 30);
            walk_all([a, b, c], Walk::default(), window, |span| {
                assert!(window.rows().contains(&span.y));
                assert!(f64::from(span.y) >= low.y.trunc() && f64::from(span.y) < high.y);
                for x in span.columns() {
                    assert!(window.columns().contains(&x));
                    assert!(f64::from(x) >= low.x.trunc() && f64::from(x) <= high.x);
                }
            });
        }

        #[test]
        fn payload_limited_everywhere_stays_between_its_ends(
            a in point(), b in point(), c in point(), values in prop::array::uniform3(-5.0..5.0),
        ) {
            let corners = [Corner { position: a, attributes: values[0] }, Corner { position: b, attributes: values[1] },
                Corner { position: c, attributes: values[2] }];
            let (low, high) = (values.iter().copied().fold(f64::MAX, f64::min), values.iter().copied().fold(f64::MIN, f64::max));
            let walk = Walk { limit: StepLimit::Everywhere, ..Walk::default() };
            for half in split(corners, |a, b, t| (b - a) * t + a).into_iter().flatten() {
                half.walk(|edge| [edge.start.attributes, edge.end.attributes], walk, Rect::sized(40, 30), |span| {
                    span.step(span.payload[0], span.payload[1], |_, value| {
                        assert!(value >= low - 1e-9 && value <= high + 1e-9, "{value} is not in {low}..{high}");
                    });
                });
            }
        }
    }
}
