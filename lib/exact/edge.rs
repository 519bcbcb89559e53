//! Beyond the book: edge functions. Which pixels a triangle covers is decided with whole numbers, and neighbors that
//! share an edge cover every pixel along it exactly once.
//!
//! Takes triangles on the screen; gives the pixels that they cover, and how much each vertex weighs there. A pixel is a
//! square with its sample in the middle; three *edge functions* say on which side of each edge the sample lies. The
//! [exact rasterizer](super) and the fast one stand on it.
//!
//! Sources: Direct3D 11.3 functional specification, 3.3 (pixel centers), 3.4.1 (snapping), 3.4.2.1 (top-left rule); J.
//! Pineda, A parallel algorithm for polygon rasterization, 1988.
//!
//! ```
//! use glam::dvec2;
//! use rasterbook::Rect;
//! use rasterbook::exact::edge::Coverage;
//!
//! // Two triangles that share a diagonal through pixel centers: each center belongs to one of them.
//! let [a, b, c, d] = [dvec2(0.0, 0.0), dvec2(4.0, 0.0), dvec2(4.0, 4.0), dvec2(0.0, 4.0)];
//! let lower = Coverage::new([a, b, c]).ok_or("no area")?;
//! let upper = Coverage::new([a, c, d]).ok_or("no area")?;
//! let picture = Rect::sized(4, 4);
//! assert_eq!(lower.pixels(picture).count() + upper.pixels(picture).count(), 16);
//! # Ok::<(), &str>(())
//! ```

use std::ops::Range;

use glam::{DVec2, dvec2};

use crate::area::Winding;
use crate::real::{Real, Scalar, each, map3};
use crate::rect::Rect;
use crate::scissor::Scissor;
use crate::varyings::{WeightGradients, weight_gradients};

/// The parts of a pixel into which positions are rounded, along x and along y.
pub const SUBPIXELS: i64 = 256;
/// Vertices as far from the origin as this, in pixels, cannot be drawn.
///
/// Differences of coordinates then have at most 26 bits and edge functions at most 53: exact in 64-bit integers, and in
/// `f64` as well.
pub(crate) const FARTHEST: f64 = 65_536.0;

/// A position on the screen in 1/256 pixel, y up.
pub type Subpixel = [i64; 2];

/// The center of the pixel (x, y).
#[must_use]
#[inline]
pub fn center(x: i32, y: i32) -> Subpixel {
    [x, y].map(|i| i64::from(i) * SUBPIXELS + SUBPIXELS / 2)
}

/// Screen space, in pixels → the nearest position in 1/256 pixel; `None` if it is not finite or too far away.
#[must_use]
#[inline]
pub fn snap(position: DVec2) -> Option<Subpixel> {
    let is_near = position.abs().max_element() <= FARTHEST && !position.is_nan();
    let rounded = |coordinate: f64| (coordinate * SUBPIXELS as f64).round() as i64;
    is_near.then(|| [rounded(position.x), rounded(position.y)])
}

// ANCHOR: edge_function
/// On which side of an edge from a to b a point is, and how far: twice the area of the triangle a,
/// b, p.
///
/// ```text
///              b
///        +    ╱              E(p) = (b.x − a.x)(p.y − a.y) − (b.y − a.y)(p.x − a.x)
///            ╱    −               = step_x · p.x + step_y · p.y + constant
///           a
/// ```
///
/// In units of 1/256 × 1/256 pixel. Positive on the left of the edge. From point to point it
/// changes linearly, so that the next pixel costs one addition. Source: J. Pineda, A parallel
/// algorithm for polygon rasterization, 1988.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EdgeFunction {
    /// How much more it is 1/256 pixel farther to the right.
    pub step_x: i64,
    /// How much more it is 1/256 pixel higher.
    pub step_y: i64,
    constant: i64,
}

impl EdgeFunction {
    // ANCHOR: edge_value
    /// The function of the edge from a to b: exact, if neither is farther than 2²⁴ from the origin
    /// along x or y, as [`snap`] sees to. Beyond 2³⁰ it may overflow.
    #[must_use]
    #[inline]
    pub fn new(a: Subpixel, b: Subpixel) -> Self {
        let (step_x, step_y) = (a[1] - b[1], b[0] - a[0]);
        Self { step_x, step_y, constant: -(step_x * a[0] + step_y * a[1]) }
    }

    /// Its value at a point: exact up to 2³⁶ from the origin along x and y, which is farther than
    /// any picture goes. Beyond it may overflow.
    #[must_use]
    #[inline]
    pub fn at(&self, [x, y]: Subpixel) -> i64 {
        self.step_x * x + self.step_y * y + self.constant
    }
    // ANCHOR_END: edge_value

    /// Whether points on the edge itself belong to the triangle on its left: it is a top edge or a
    /// left edge.
    ///
    /// Counter-clockwise round the triangle, a top edge runs to the left, and a left edge runs
    /// down.
    ///
    /// ```text
    ///             top
    ///        ┌──◄──────┐
    ///   left ▼         ▲ right
    ///        └──────►──┘
    ///           bottom
    /// ```
    #[must_use]
    #[inline]
    pub fn is_top_left(&self) -> bool {
        is_top_left(self.step_x, self.step_y)
    }

    /// Whether a point at which the function has this value is on the triangle's side.
    #[must_use]
    #[inline]
    pub fn covers(&self, value: i64) -> bool {
        value >= self.least()
    }

    /// The least value on the triangle's side: whole numbers are positive from 1 on, and 0 is on
    /// the edge itself.
    #[inline]
    pub(crate) fn least(&self) -> i64 {
        if self.is_top_left() { 0 } else { 1 }
    }

    /// Which of some columns of a row are on the triangle's side, if the function has this value in
    /// the first of them.
    ///
    /// The nth column after the first has value + n · step, and is on that side if n · step ≥ least
    /// − value: from some column on where the function grows, up to some column where it falls.
    #[inline]
    fn columns(&self, columns: Range<i32>, value: i64) -> Range<i32> {
        let (start, end) = (i64::from(columns.start), i64::from(columns.end));
        let (step, missing) = (self.step_x * SUBPIXELS, self.least() - value);
        let covered = match step {
            1.. => start - (-missing).div_euclid(step)..end,
            0 if missing > 0 => end..end,
            0 => start..end,
            _ => start..start + (-missing).div_euclid(-step) + 1,
        };
        let limited = |column: i64| column.max(start).min(end) as i32;
        limited(covered.start)..limited(covered.end)
    }
}

// ANCHOR: top_left
/// The rule by itself, for whole numbers of any size.
#[inline]
pub(crate) fn is_top_left<I: PartialOrd + Default>(step_x: I, step_y: I) -> bool {
    let zero = I::default();
    let (runs_down, is_level, runs_left) = (step_x > zero, step_x == zero, step_y < zero);
    runs_down || (is_level && runs_left)
}
// ANCHOR_END: top_left
// ANCHOR_END: edge_function

/// How the weights of the second and the third of three vertices change from pixel to pixel.
#[inline]
pub(crate) fn gradients_between<R: Real>(vertices: [Subpixel; 3]) -> WeightGradients<R> {
    weight_gradients(map3(vertices, |[x, y]| dvec2(x as f64, y as f64) / SUBPIXELS as f64))
}

// ANCHOR: coverage
/// Which points of the screen a triangle covers, and how much each vertex weighs there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Coverage {
    /// The vertices, rounded to 1/256 pixel.
    pub vertices: [Subpixel; 3],
    /// Each edge belongs to the vertex opposite to it, and has the triangle on its left, whichever
    /// way it winds.
    pub edges: [EdgeFunction; 3],
    /// Twice the area, positive; the sum of the three edge functions anywhere.
    pub twice_area: i64,
    /// In which direction the vertices run.
    pub winding: Winding,
}

impl Coverage {
    /// Screen space, in pixels → coverage; `None` if there is nothing to draw: no area, or a vertex
    /// that is not finite or too far away.
    #[must_use]
    #[inline]
    pub fn new(triangle: [DVec2; 3]) -> Option<Self> {
        Self::of([snap(triangle[0])?, snap(triangle[1])?, snap(triangle[2])?])
    }

    /// The same for vertices that are rounded already, and near enough.
    #[inline]
    pub(crate) fn of([a, b, c]: [Subpixel; 3]) -> Option<Self> {
        let signed_area = EdgeFunction::new(a, b).at(c);
        let edge = |from, to| match signed_area {
            1.. => EdgeFunction::new(from, to),
            _ => EdgeFunction::new(to, from),
        };
        let winding = Winding::of(signed_area as f64)?;
        let edges = [edge(b, c), edge(c, a), edge(a, b)];
        Some(Self { vertices: [a, b, c], edges, twice_area: signed_area.abs(), winding })
    }

    /// The values of the three edge functions at a point, as far as [`EdgeFunction::at`] reaches.
    #[must_use]
    #[inline]
    pub fn edge_values(&self, point: Subpixel) -> [i64; 3] {
        map3(self.edges, |edge| edge.at(point))
    }

    /// Whether a point where the edge functions have these values belongs to the triangle: three
    /// signs that agree.
    #[must_use]
    #[inline]
    pub fn covers(&self, values: [i64; 3]) -> bool {
        let [a, b, c] = &self.edges;
        a.covers(values[0]) && b.covers(values[1]) && c.covers(values[2])
    }

    /// How much the second and the third vertex weigh where the edge functions have these values;
    /// the first has the rest of 1. Outside the triangle, weights are negative.
    #[must_use]
    #[inline]
    pub fn weights<R: Scalar>(&self, [_, second, third]: [i64; 3]) -> [R; 2] {
        // Whole numbers of up to 53 bits are exact in `f64`; `of` rounds once.
        let (second, third) = (R::of(second as f64), R::of(third as f64));
        let one_over_area = R::of(1.0) / R::of(self.twice_area as f64);
        [second * one_over_area, third * one_over_area]
    }

    /// How much more they weigh one pixel farther to the right.
    #[must_use]
    #[inline]
    pub fn weight_step<R: Scalar>(&self) -> [R; 2] {
        self.weights(map3(self.edges, |edge| edge.step_x * SUBPIXELS))
    }

    /// The area with the sign of the winding, doubled, in square pixels.
    #[must_use]
    pub fn signed_area(&self) -> f64 {
        let area = self.twice_area as f64 / (SUBPIXELS * SUBPIXELS) as f64;
        if self.winding == Winding::CounterClockwise { area } else { -area }
    }

    /// How the two weights change from pixel to pixel.
    #[must_use]
    pub fn weight_gradients<R: Scalar>(&self) -> WeightGradients<R> {
        gradients_between(self.vertices)
    }

    /// The pixels of a rectangle whose centers lie in the bounding box of the triangle.
    #[must_use]
    #[inline]
    pub fn bounding_box(&self, rect: Rect) -> Rect {
        let (xs, ys) = (map3(self.vertices, |[x, _]| x), map3(self.vertices, |[_, y]| y));
        // The first center that is not below the lowest, and the one after the last that is not
        // above the highest.
        let first = |values: [i64; 3]| {
            let lowest = values[0].min(values[1]).min(values[2]);
            (lowest - SUBPIXELS / 2 + SUBPIXELS - 1).div_euclid(SUBPIXELS) as i32
        };
        let end = |values: [i64; 3]| {
            let highest = values[0].max(values[1]).max(values[2]);
            (highest - SUBPIXELS / 2).div_euclid(SUBPIXELS) as i32 + 1
        };
        Rect { left: first(xs), bottom: first(ys), right: end(xs), top: end(ys) }.intersection(rect)
    }

    /// The pixels of the scissor whose centers are covered, row by row from the bottom, with the
    /// values of the edge functions there.
    pub fn pixels<W: Into<Scissor>>(
        &self,
        scissor: W,
    ) -> impl Iterator<Item = (i32, i32, [i64; 3])> + use<W> {
        let scissor = scissor.into();
        let area = self.bounding_box(scissor.rect);
        let announced = Announced::new(scissor, self);
        area.rows().flat_map(move |y| {
            // All of it, so that it lives as long as the rows do.
            let announced = &announced;
            announced.coverage.row(area.columns(), y).map(move |(x, values)| (x, y, values))
        })
    }

    /// All pixels of the scissor, covered or not, row by row from the bottom, with the values of
    /// the edge functions at their centers, as far as [`EdgeFunction::at`] reaches.
    pub fn all_pixels<W: Into<Scissor>>(
        &self,
        scissor: W,
    ) -> impl Iterator<Item = (i32, i32, [i64; 3])> + use<W> {
        let scissor = scissor.into();
        let area = scissor.rect;
        let announced = Announced::new(scissor, self);
        area.rows().flat_map(move |y| {
            let coverage = announced.coverage;
            area.columns().map(move |x| (x, y, coverage.edge_values(center(x, y))))
        })
    }

    /// The covered ones of some columns of a row, from left to right, with the values of the edge
    /// functions there.
    #[inline]
    fn row(&self, columns: Range<i32>, y: i32) -> impl Iterator<Item = (i32, [i64; 3])> + use<> {
        let covered = self.covered_columns(columns, y);
        let mut values = self.edge_values(center(covered.start, y));
        let steps = map3(self.edges, |edge| edge.step_x * SUBPIXELS);
        covered.map(move |x| {
            let here = values;
            values = each(here, |i, value| value + steps[i]);
            (x, here)
        })
    }

    // ANCHOR: covered_columns
    /// Which of some columns of a row are covered: they lie side by side.
    #[must_use]
    #[inline]
    pub fn covered_columns(&self, columns: Range<i32>, y: i32) -> Range<i32> {
        // No center is covered so far away, and there edge functions would overflow.
        const FAR: i32 = FARTHEST as i32 + 1;
        let columns = columns.start.clamp(-FAR, FAR)..columns.end.clamp(-FAR, FAR);
        let y = y.clamp(-FAR, FAR);
        let values = self.edge_values(center(columns.start, y));
        let [a, b, c] = map3([0, 1, 2], |i| self.edges[i].columns(columns.clone(), values[i]));
        a.start.max(b.start).max(c.start)..a.end.min(b.end).min(c.end)
    }
    // ANCHOR_END: covered_columns
}
// ANCHOR_END: coverage

/// Reports a triangle to the observer of a scissor, and that it is done as soon as this goes out of scope.
pub(crate) struct Announced {
    scissor: Scissor,
    coverage: Coverage,
}

impl Announced {
    #[inline]
    pub(crate) fn new(scissor: Scissor, coverage: &Coverage) -> Self {
        let announced = Self { scissor, coverage: *coverage };
        announced.scissor.report(|observer| observer.begun(&announced.coverage));
        announced
    }
}

impl Drop for Announced {
    fn drop(&mut self) {
        self.scissor.report(|observer| observer.done());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scanline::tests::grid;

    /// How often each pixel of 10 × 6 is covered by some triangles; a `2` would be overdraw.
    fn drawn(triangles: &[[(f64, f64); 3]]) -> String {
        let mut counts = [[0; 10]; 6];
        for triangle in triangles {
            let coverage = Coverage::new(triangle.map(DVec2::from)).expect("a triangle with area");
            for (x, y, _) in coverage.pixels(Rect::sized(10, 6)) {
                counts[y as usize][x as usize] += 1;
            }
        }
        grid(&counts)
    }

    /// The vertices of a square whose edges run through the centers of pixels.
    const A: (f64, f64) = (1.5, 0.5);
    const B: (f64, f64) = (6.5, 0.5);
    const C: (f64, f64) = (6.5, 5.5);
    const D: (f64, f64) = (1.5, 5.5);

    #[test]
    fn centers_on_left_edges_are_covered_and_those_on_right_and_bottom_edges_are_not() {
        let expected = "\
            ..........\n\
            .1........\n\
            .11.......\n\
            .111......\n\
            .1111.....\n\
            ..........\n";
        assert_eq!(drawn(&[[A, B, D]]), expected);
        assert_eq!(drawn(&[[A, D, B]]), expected, "whichever way it winds");
    }

    #[test]
    fn centers_on_top_edges_are_covered() {
        let expected = "\
            .11111....\n\
            .1111.....\n\
            .111......\n\
            .11.......\n\
            .1........\n\
            ..........\n";
        assert_eq!(drawn(&[[A, C, D]]), expected);
    }

    #[test]
    fn two_triangles_share_a_diagonal_through_centers_without_a_gap_or_overdraw() {
        let expected = "\
            .11111....\n\
            .11111....\n\
            .11111....\n\
            .11111....\n\
            .11111....\n\
            ..........\n";
        assert_eq!(drawn(&[[A, B, C], [A, C, D]]), expected);
        assert_eq!(drawn(&[[B, C, D], [A, B, D]]), expected, "the other diagonal");
    }

    #[test]
    fn positions_are_snapped_if_they_are_near() {
        assert_eq!(snap(dvec2(65_536.0, -0.5)), Some([16_777_216, -128]));
        assert_eq!(snap(dvec2(1.5 / 256.0, -1.5 / 256.0)), Some([2, -2]), "halves away from zero");
        for far in [65_536.1, -65_537.0, f64::NAN, f64::INFINITY] {
            assert_eq!([snap(dvec2(far, 1.0)), snap(dvec2(1.0, far))], [None, None], "{far}");
        }
    }

    #[test]
    fn an_edge_without_length_is_neither_top_nor_left() {
        assert!(!EdgeFunction::new([3, 5], [3, 5]).is_top_left());
    }

    #[test]
    fn areas_and_weights_by_hand() {
        // Legs of 4: doubled, the area is 16. At (1.5, 0.5) the parts opposite to the vertices are 8, 6 and 2 of it.
        let [a, b, c] = [dvec2(0.0, 0.0), dvec2(4.0, 0.0), dvec2(0.0, 4.0)];
        let unit = SUBPIXELS * SUBPIXELS;
        let (left, right) =
            (Coverage::new([a, b, c]).expect("area"), Coverage::new([a, c, b]).expect("area"));
        assert_eq!([left.signed_area(), right.signed_area()], [16.0, -16.0]);
        assert_eq!([left.twice_area, right.twice_area], [16 * unit, 16 * unit]);
        let values = left.edge_values(center(1, 0));
        assert_eq!(values, [8 * unit, 6 * unit, 2 * unit]);
        assert_eq!(left.weights::<f64>(values), [0.375, 0.125]);
        // One pixel to the right is a quarter of the second vertex more; one pixel up, of the third.
        assert_eq!(left.weight_step::<f64>(), [0.25, 0.0]);
        assert_eq!(right.weight_step::<f64>(), [0.0, 0.25]);
        assert_eq!(left.weight_gradients::<f64>(), [[0.25, 0.0], [0.0, 0.25]]);
        assert!(left.covers(values));
        for outside in [[-1, 6, 2], [8, -1, 2], [8, 6, -1]] {
            assert!(!left.covers(outside));
        }
        // The edge from b to c is the right one, the others are the bottom and the left one.
        assert_eq!(
            left.edges.map(|edge| [edge.covers(0), edge.covers(1)]),
            [[false, true], [true, true], [false, true]]
        );
    }

    #[test]
    fn a_bounding_box_has_the_centers_between_the_vertices() {
        let all = Rect { left: -50, bottom: -50, right: 50, top: 50 };
        let bounding_box = |triangle: [(f64, f64); 3]| {
            Coverage::new(triangle.map(DVec2::from)).expect("area").bounding_box(all)
        };
        // Centers from 1.5 to 8.5, and from 2.5 to 3.5.
        let found = bounding_box([(0.6, 1.6), (9.4, 1.7), (5.0, 3.6)]);
        assert_eq!(found, Rect { left: 1, bottom: 2, right: 9, top: 4 });
        // Centers on the border count: those of the columns −3 and 2, and of the rows −2 and 1.
        let found = bounding_box([(-2.5, -1.5), (2.5, -1.5), (0.0, 1.5)]);
        assert_eq!(found, Rect { left: -3, bottom: -2, right: 3, top: 2 });
    }

    #[test]
    fn covered_pixels_are_those_of_all_whose_values_say_so() {
        let rect = Rect { left: -1, bottom: -1, right: 10, top: 6 };
        for triangle in [[A, B, D], [A, C, D], [(-3.0, 0.2), (9.3, 1.9), (4.1, 7.7)]] {
            let coverage = Coverage::new(triangle.map(DVec2::from)).expect("area");
            let all: Vec<_> = coverage.all_pixels(rect).collect();
            let places: Vec<_> = all.iter().map(|&(x, y, _)| (x, y)).collect();
            let expected: Vec<_> = (-1..6).flat_map(|y| (-1..10).map(move |x| (x, y))).collect();
            assert_eq!(places, expected);
            let covered = all.into_iter().filter(|&(_, _, values)| coverage.covers(values));
            assert!(covered.eq(coverage.pixels(rect)));
            for (x, y, values) in coverage.pixels(rect) {
                assert_eq!(values, coverage.edge_values(center(x, y)), "at ({x}, {y})");
            }
        }
    }

    #[test]
    fn exact_as_far_as_is_said() {
        let far = 1_i64 << 24;
        let positions = [[-far, -far], [far, far], [far, -far], [-far + 1, far], [0, 0], [1, -1]];
        let farthest = 1_i64 << 36;
        let points =
            [[farthest, -farthest], [-farthest, -farthest], [-farthest, farthest], [far, 0], [128, 128]];
        for (a, b) in positions.iter().flat_map(|&a| positions.map(|b| (a, b))) {
            let edge = EdgeFunction::new(a, b);
            for point in points {
                let [[ax, ay], [bx, by], [x, y]] = [a, b, point].map(|place| place.map(i128::from));
                assert_eq!(i128::from(edge.at(point)), (bx - ax) * (y - ay) - (by - ay) * (x - ax));
            }
        }
        let _ = EdgeFunction::new([1 << 30, -1 << 30], [-1 << 30, 1 << 30]);
    }

    #[test]
    fn any_row_and_any_columns_can_be_asked_for() {
        let far = 65_536.0;
        let whole = Coverage::new([dvec2(-far, -far), dvec2(far, -far), dvec2(-far, far)]).expect("area");
        let small = Coverage::new([A, B, D].map(DVec2::from)).expect("area");
        let all = i32::MIN..i32::MAX;
        assert_eq!(whole.covered_columns(all.clone(), 0), -65_536..-1);
        assert_eq!(small.covered_columns(all.clone(), 1), 1..5);
        for y in [i32::MIN, -65_537, 65_536, i32::MAX] {
            assert!(whole.covered_columns(all.clone(), y).is_empty());
            assert!(small.covered_columns(all.clone(), y).is_empty());
        }
        for (start, end) in [(i32::MIN, -70_000), (70_000, i32::MAX), (5, 3), (i32::MAX, i32::MIN)] {
            assert!(small.covered_columns(start..end, 1).is_empty());
        }
        assert_eq!(
            small.pixels(Rect { left: i32::MIN, bottom: i32::MIN, right: i32::MAX, top: i32::MAX }).count(),
            10
        );
    }

    #[test]
    fn between_the_centers_nothing_is_covered() {
        assert_eq!(drawn(&[[(0.6, 1.6), (9.4, 1.7), (5.0, 2.4)]]), ("..........\n").repeat(6));
    }
}
