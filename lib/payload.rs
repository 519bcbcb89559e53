//! Chapter 3: values that change by equal steps, up two edges of a triangle and along its rows.
//!
//! Chapter 2 walks up a half and finds the span of each row. Here a *payload* goes along: values in chapter 3, the
//! parameter t in chapter 5, t and a depth in chapter 7. Takes a payload at the ends of what is walked; gives it at each
//! row and at each pixel.
//!
//! ```
//! use glam::dvec2;
//! use rasterbook::Rect;
//! use rasterbook::payload::StepClamp;
//! use rasterbook::scanline::{EdgeWalk, spans};
//!
//! // Along a row of five pixels from 0 to 1.
//! let triangle = [dvec2(0.0, 0.0), dvec2(4.0, 0.0), dvec2(0.0, 1.0)];
//! let mut values = Vec::new();
//! spans(triangle, EdgeWalk::Clamped, Rect::sized(8, 8), |span| {
//!     span.step(0.0, 1.0, StepClamp::Edges, |_, value| values.push(value));
//! });
//! assert_eq!(values, [0.0, 0.25, 0.5, 0.75, 1.0]);
//! ```

use crate::real::{each, map3};
use crate::rect::Rect;
use crate::scanline::{Edge, EdgeWalk, Half, Span, Split, halves};

/// Whether a payload may pass the value that it has at the end of what it is stepped along.
///
/// A row stands for the height trunc(y), an edge ends at its own height: the last step may go beyond it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StepClamp {
    /// Nothing is clamped, a mistake.
    ///
    /// - Cause: the last row of an edge lies up to one pixel beyond the edge's end, and so does the last pixel of a row.
    /// - Artefact: values outside the range of the vertices; in a texture, texels from beyond the triangle ("spikes").
    /// - Remedy: [`StepClamp::Edges`] as in the book (chapter 11), or [`StepClamp::Everywhere`].
    Overrun,
    /// Clamped along the two edges after each row, not along the row: the book's remedy. The last pixel of a row may
    /// still pass the end, and a depth that is stepped beside t is not clamped.
    #[default]
    Edges,
    /// Clamped along the edges and along the row, depth included: nothing leaves the range of the vertices.
    Everywhere,
}

/// The options of the walk.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Walk {
    /// Whether x is kept between the ends of its edge.
    pub edges: EdgeWalk,
    /// Whether a payload is kept between its values at the ends.
    pub clamp: StepClamp,
}

/// Something that changes by equal steps from one end of an edge, or of a row, to the other.
pub trait Payload: Copy {
    /// The step for one pixel, from `start` to `end` over `length` pixels: (end − start) / length.
    #[must_use]
    fn slope(start: Self, end: Self, length: f64) -> Self;
    /// This value after `count` steps.
    #[must_use]
    fn stepped(self, slope: Self, count: f64) -> Self;
    /// This value, but not beyond `end` as seen from `start`; `clamp` is not [`StepClamp::Overrun`].
    #[must_use]
    fn clamped(self, start: Self, end: Self, clamp: StepClamp) -> Self;
}

/// One number: a value, or the parameter t of chapter 5.
impl Payload for f64 {
    #[inline]
    fn slope(start: Self, end: Self, length: f64) -> Self {
        (end - start) / length
    }

    #[inline]
    fn stepped(self, slope: Self, count: f64) -> Self {
        self + slope * count
    }

    #[inline]
    fn clamped(self, start: Self, end: Self, _: StepClamp) -> Self {
        if end > start {
            self.min(end)
        } else if end < start {
            self.max(end)
        } else {
            self
        }
    }
}

/// Several values, each by itself.
impl<P: Payload, const N: usize> Payload for [P; N] {
    #[inline]
    fn slope(start: Self, end: Self, length: f64) -> Self {
        each(start, |i, start| P::slope(start, end[i], length))
    }

    #[inline]
    fn stepped(self, slope: Self, count: f64) -> Self {
        each(self, |i, value| value.stepped(slope[i], count))
    }

    #[inline]
    fn clamped(self, start: Self, end: Self, clamp: StepClamp) -> Self {
        each(self, |i, value| value.clamped(start[i], end[i], clamp))
    }
}

impl Split {
    /// What is at the ends of the halves' edges, the lower half first: what the three vertices carry, and at the new point
    /// P′ what `between` makes of two vertices and the parameter t.
    #[must_use]
    #[inline]
    pub fn attach<T: Copy>(&self, carried: [T; 3], between: impl Fn(T, T, f64) -> T) -> [Half<T>; 2] {
        let [p1, p2, p3] = map3(self.order, |i| carried[i]);
        let p = between(p1, p3, self.t);
        let (left, right) = if self.is_middle_right { (p, p2) } else { (p2, p) };
        halves(p1, left, right, p3)
    }
}

// ANCHOR: step
impl Half {
    /// Walks up both edges of the half with a payload, and emits each span with the payload at its
    /// start and at its end.
    ///
    /// `carried` is the payload at the ends of the half's edges. Source: book, section 3.2.4.
    #[inline]
    pub fn step<P: Payload>(
        &self,
        carried: &Half<P>,
        walk: Walk,
        scissor: Rect,
        mut emit: impl FnMut(Span, [P; 2]),
    ) {
        let mut left = Stepped::new(&self.left, &carried.left);
        let mut right = Stepped::new(&self.right, &carried.right);
        self.walk(walk.edges, scissor, |span| {
            left.step_to(span.y, walk.clamp);
            right.step_to(span.y, walk.clamp);
            emit(span, [left.value, right.value]);
        });
    }
}
// ANCHOR_END: step

// ANCHOR: stepped
/// A payload on its way up one edge of a half.
struct Stepped<P> {
    /// The row that it has reached.
    y: f64,
    value: P,
    slope: P,
    ends: Edge<P>,
}

impl<P: Payload> Stepped<P> {
    #[inline]
    fn new(edge: &Edge, ends: &Edge<P>) -> Self {
        let slope = P::slope(ends.end, ends.start, edge.rise());
        Self { y: edge.start.y.trunc(), value: ends.start, slope, ends: *ends }
    }

    /// Goes up to a row, and does not pass the end of the edge, unless nothing is clamped.
    #[inline]
    fn step_to(&mut self, y: i32, clamp: StepClamp) {
        let rows = f64::from(y) - self.y;
        if rows > 0.0 {
            self.y = f64::from(y);
            self.value = self.value.stepped(self.slope, rows);
            if clamp != StepClamp::Overrun {
                self.value = self.value.clamped(self.ends.start, self.ends.end, clamp);
            }
        }
    }
}
// ANCHOR_END: stepped

impl Span {
    // ANCHOR: span_step
    /// Steps a payload along the row, from its value at the start to its value at the end, a pixel
    /// at a time.
    #[inline]
    pub fn step<P: Payload>(&self, from: P, to: P, clamp: StepClamp, mut emit: impl FnMut(i32, P)) {
        let columns = self.columns();
        let slope = P::slope(from, to, self.end - self.start);
        let skipped = f64::from(columns.start) - self.start.trunc();
        let mut value = if skipped > 0.0 { from.stepped(slope, skipped) } else { from };
        for x in columns {
            if clamp == StepClamp::Everywhere {
                value = value.clamped(from, to, clamp);
            }
            emit(x, value);
            value = value.stepped(slope, 1.0);
        }
    }
    // ANCHOR_END: span_step
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scanline::{spans, split};
    use glam::{DVec2, dvec2};
    use proptest::prelude::*;

    fn point() -> impl Strategy<Value = DVec2> {
        (-20.0..60.0, -20.0..60.0).prop_map(DVec2::from)
    }

    #[test]
    fn a_row_of_one_pixel_has_the_value_at_its_start() {
        // The lowest row of a triangle that stands on a vertex: from 3 to 5 over no distance.
        let triangle = [dvec2(2.0, 0.0), dvec2(0.0, 2.0), dvec2(4.0, 2.0)];
        let mut values = Vec::new();
        spans(triangle, EdgeWalk::Clamped, Rect::sized(8, 1), |span| {
            span.step(3.0, 5.0, StepClamp::Edges, |x, value| values.push((x, value)));
        });
        assert_eq!(values, [(2, 3.0)]);
    }

    #[test]
    fn an_edge_without_height_has_the_value_at_its_start() {
        // Row 2 belongs to the lower half, too, though that begins and ends at 2.5.
        let split = split([dvec2(0.0, 2.5), dvec2(4.0, 2.5), dvec2(2.0, 6.0)]).expect("an area");
        let [lower, _] = split.attach([1.0, 2.0, 3.0], |a, b, t| (b - a) * t + a);
        let mut values = Vec::new();
        split
            .lower
            .step(&lower, Walk::default(), Rect::sized(8, 8), |span, ends| values.push((span.y, ends)));
        assert_eq!(values, [(2, [1.0, 1.0])]);
    }

    proptest! {
        #[test]
        fn a_payload_clamped_everywhere_stays_between_its_ends(
            triangle in prop::array::uniform3(point()), values in prop::array::uniform3(-5.0..5.0),
        ) {
            let (low, high) = (values.iter().copied().fold(f64::MAX, f64::min), values.iter().copied().fold(f64::MIN, f64::max));
            let walk = Walk { clamp: StepClamp::Everywhere, ..Walk::default() };
            let Some(split) = split(triangle) else { return Ok(()) };
            let carried = split.attach(values, |a, b, t| (b - a) * t + a);
            for (half, carried) in [split.lower, split.upper].iter().zip(&carried) {
                half.step(carried, walk, Rect::sized(40, 30), |span, [start, end]| {
                    span.step(start, end, walk.clamp, |_, value| {
                        assert!(value >= low - 1e-9 && value <= high + 1e-9, "{value} is not in {low}..{high}");
                    });
                });
            }
        }
    }
}
