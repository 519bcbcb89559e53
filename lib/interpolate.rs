//! Chapters 3 and 5: interpolation of the values that the vertices of a triangle carry.
//!
//! Takes the spans of the scanline walk and says which values belong to each pixel; what they mean (a color, texture
//! coordinates) is the caller's business. The values of one vertex are a plain array, `[R; N]`.
//!
//! ```
//! use glam::dvec2;
//! use rasterbook::interpolate::barycentric_weights;
//!
//! let triangle = [dvec2(0.0, 0.0), dvec2(6.0, 0.0), dvec2(0.0, 3.0)];
//! assert_eq!(barycentric_weights(dvec2(2.0, 1.0), triangle), [1.0 / 3.0; 3]); // the centroid
//! ```

use glam::DVec2;

use crate::area::twice_signed_area;
use crate::payload::{Payload, StepClamp, Walk};
use crate::real::{Mask, Real, each, map3};
use crate::rect::Rect;
use crate::scanline::{Edge, Half, Split, split};
use crate::scissor::Scissor;

// ANCHOR: barycentric_weights
/// How much each vertex of a triangle weighs at the point p: the area of the small triangle
/// opposite to the vertex, divided by the whole. The three weights sum to 1; one is negative beyond
/// the edge opposite to its vertex.
///
/// ```text
///            C                 α = area(P, B, C) / area(A, B, C)
///           ╱│╲                β = area(A, P, C) / area(A, B, C)
///          ╱ │ ╲               γ = area(A, B, P) / area(A, B, C)
///         ╱  P  ╲
///        ╱ ╱   ╲ ╲             P = α A + β B + γ C
///       A ───────── B
/// ```
///
/// Any plane; not finite for a triangle without area. Source: book, section 3.2.2.
#[must_use]
pub fn barycentric_weights(p: DVec2, [a, b, c]: [DVec2; 3]) -> [f64; 3] {
    let whole = twice_signed_area(a, b, c);
    [
        twice_signed_area(p, b, c) / whole,
        twice_signed_area(a, p, c) / whole,
        twice_signed_area(a, b, p) / whole,
    ]
}
// ANCHOR_END: barycentric_weights

/// The values at the parameter t between a (t = 0) and b (t = 1), changing linearly: (b − a) · t + a. Book, section 3.1.
#[must_use]
#[inline(always)]
pub fn linear<R: Real, const N: usize>(a: [R; N], b: [R; N], t: R) -> [R; N] {
    each(
        a,
        #[inline(always)]
        |i, a| (b[i] - a) * t + a,
    )
}

/// A vertex of a triangle on the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScreenVertex<V> {
    /// Screen space, in pixels, y up.
    pub position: DVec2,
    /// What the vertex carries: its varyings, in chapter 5 with w, in chapter 7 with a depth as well.
    pub varyings: V,
}

/// A triangle on the screen that is about to be filled row by row: what is announced to observers.
#[derive(Clone, Debug, PartialEq)]
pub struct ScreenTriangle {
    /// The vertices, in pixels.
    pub positions: [DVec2; 3],
    /// Their w, if they have been projected.
    pub w: Option<[f64; 3]>,
    /// Their varyings.
    pub varyings: [Vec<f64>; 3],
    /// Their depths, if a depth is stepped beside t.
    pub depth: Option<[f64; 3]>,
    /// How varyings are interpolated.
    pub interpolation: Interpolation,
    /// How the rows are walked.
    pub walk: Walk,
}

/// Emits the pixels of a triangle, each with its values, which are stepped up two edges and along each row.
///
/// Screen space → (x, y, values). Along any straight line on the screen values change linearly (barycentric
/// interpolation), so that one addition a pixel is enough. Source: book, sections 3.2.4 and 3.2.5.
pub fn step_values<const N: usize>(
    triangle: [ScreenVertex<[f64; N]>; 3],
    walk: Walk,
    scissor: impl Into<Scissor>,
    emit: impl FnMut(i32, i32, [f64; N]),
) {
    let (positions, values) = positions_and_varyings(triangle);
    let scissor = scissor.into();
    scissor.report(|observer| {
        let varyings = values.map(|values| values.to_vec());
        let interpolation = Interpolation::Affine;
        observer.begun(&ScreenTriangle { positions, w: None, varyings, depth: None, interpolation, walk });
    });
    step_values_in(positions, values, walk, scissor.rect, emit);
    scissor.report(|observer| observer.done());
}

fn positions_and_varyings<V: Copy>(triangle: [ScreenVertex<V>; 3]) -> ([DVec2; 3], [V; 3]) {
    (map3(triangle, |vertex| vertex.position), map3(triangle, |vertex| vertex.varyings))
}

// ANCHOR: step_values
/// Steps the values that the three vertices carry up the edges of the triangle, and along each row.
fn step_values_in<const N: usize>(
    triangle: [DVec2; 3],
    values: [[f64; N]; 3],
    walk: Walk,
    scissor: Rect,
    mut emit: impl FnMut(i32, i32, [f64; N]),
) {
    let Some(split) = split(triangle) else { return };
    // The values at the ends of the halves' edges; those of the new point P′ lie between those of
    // P₁ and P₃.
    let [lower, upper] = split.attach(values, linear);
    for (half, values) in [(split.lower, lower), (split.upper, upper)] {
        half.step(&values, walk, scissor, |span, [start, end]| {
            span.step(start, end, walk.clamp, |x, values| emit(x, span.y, values));
        });
    }
}
// ANCHOR_END: step_values

/// What a vertex carries once it has been projected (chapter 5): its distance w and its values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projected<R, const N: usize> {
    /// The fourth component before the perspective divide: the distance along the camera's z axis.
    pub w: R,
    /// The values, as they are in space.
    pub values: [R; N],
}

// ANCHOR: interpolation
/// How values are interpolated on the screen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Interpolation {
    /// Linearly on the screen, a mistake as soon as the vertices are not equally far away.
    ///
    /// - Cause: equal steps on the screen are not equal steps in space.
    /// - Artefact: a texture bends at the diagonal of a quad and swims when the view moves.
    /// - Remedy: [`Interpolation::PerspectiveCorrect`]. Book, section 5.3, Figure 5-3.
    Affine,
    /// Linearly in space: the book's formula ⑧. Book, section 5.4.
    #[default]
    PerspectiveCorrect,
    /// Linearly in space by the usual two steps: 1/w and V/w change linearly on the screen. Book,
    /// section 5.5.4.
    Reciprocal,
}

impl Interpolation {
    /// What lies between two projected points at the parameter t′, measured on the screen from a
    /// (0) to b (1).
    #[must_use]
    pub fn between<R: Real, const N: usize>(
        self,
        a: Projected<R, N>,
        b: Projected<R, N>,
        t: R,
    ) -> Projected<R, N> {
        match self {
            Self::Affine => {
                let w = (b.w - a.w) * t + a.w;
                Projected { w, values: linear(a.values, b.values, t) }
            }
            Self::PerspectiveCorrect => perspective_correct(a, b, t),
            Self::Reciprocal => reciprocal([a, b], t),
        }
    }
}
// ANCHOR_END: interpolation

// ANCHOR: perspective_weights
/// The weights of three points in space, from their weights on the screen.
///
/// ```text
///             α′/wa                                  1     α′   β′   γ′
///     α = ───────────────────────     and with it   ── =  ── + ── + ──
///         α′/wa + β′/wb + γ′/wc                      w     wa   wb   wc
/// ```
///
/// Where all w are equal, as under an orthographic projection, nothing changes. Where that cannot
/// be computed, because a w or the denominator is zero, the weights stay as they are. Source: first
/// note, formulas 4 to 7.
#[must_use]
pub fn perspective_weights<R: Real>(weights: [R; 3], w: [R; 3]) -> [R; 3] {
    let zero = R::of(0.0);
    let is_nonzero = |x: R| x.is_less(zero).not().and(zero.is_less(x).not()).not();
    let parts = each(weights, |i, weight| weight / w[i]);
    let sum = parts[0] + parts[1] + parts[2];
    let is_possible = w.into_iter().fold(is_nonzero(sum), |mask, w| mask.and(is_nonzero(w)));
    each(weights, |i, weight| R::select(is_possible, parts[i] / sum, weight))
}
// ANCHOR_END: perspective_weights

// ANCHOR: perspective_correct
/// Formulas ⑨ and ⑧ of the book (section 5.4), which writes ω for w:
///
/// ```text
///                 ωa ωb                        ωb Va + (ωa Vb − ωb Va) t′
///     ωp = ───────────────────          Vp = ────────────────────────────
///          ωb + (ωa − ωb) t′                     ωb + (ωa − ωb) t′
/// ```
fn perspective_correct<R: Real, const N: usize>(
    a: Projected<R, N>,
    b: Projected<R, N>,
    t: R,
) -> Projected<R, N> {
    let denominator = b.w + (a.w - b.w) * t;
    let value = |va: R, vb: R| (b.w * va + (a.w * vb - b.w * va) * t) / denominator;
    Projected { w: (a.w * b.w) / denominator, values: each(a.values, |i, a| value(a, b.values[i])) }
}
// ANCHOR_END: perspective_correct

// ANCHOR: reciprocal
/// The same in the form that most texts give (book, section 5.5.4): interpolate 1/w and V/w
/// linearly, then divide.
fn reciprocal<R: Real, const N: usize>([a, b]: [Projected<R, N>; 2], t: R) -> Projected<R, N> {
    let one = R::of(1.0);
    let one_over_w = one / a.w + (one / b.w - one / a.w) * t;
    let value = |va: R, vb: R| (va / a.w + (vb / b.w - va / a.w) * t) / one_over_w;
    Projected { w: one / one_over_w, values: each(a.values, |i, a| value(a, b.values[i])) }
}
// ANCHOR_END: reciprocal

/// Emits the pixels of a projected triangle, each with its w and its values.
///
/// Screen space → (x, y, w and values). What is stepped up the edges and along each row is the parameter t′;
/// `interpolation` makes values of it, once for each end of a row and once for each pixel. Source: book, section 5.4,
/// Figure 5-7.
pub fn step_parameter<const N: usize>(
    triangle: [ScreenVertex<Projected<f64, N>>; 3],
    interpolation: Interpolation,
    walk: Walk,
    scissor: impl Into<Scissor>,
    mut emit: impl FnMut(i32, i32, Projected<f64, N>),
) {
    let (positions, points) = positions_and_varyings(triangle);
    let scissor = scissor.into();
    begin_projected(&scissor, positions, &points, None, interpolation, walk);
    step_parameter_in(positions, points, [0.0; 3], interpolation, walk, scissor.rect, |x, y, point, _| {
        emit(x, y, point);
    });
    scissor.report(|observer| observer.done());
}

/// The same with a depth that changes linearly on the screen, beside t′ (chapter 7).
///
/// Screen space → (x, y, w and values, depth). Source: book, section 7.2.
pub fn step_parameter_and_depth<const N: usize>(
    triangle: [ScreenVertex<(Projected<f64, N>, f64)>; 3],
    interpolation: Interpolation,
    walk: Walk,
    scissor: impl Into<Scissor>,
    emit: impl FnMut(i32, i32, Projected<f64, N>, f64),
) {
    let (positions, varyings) = positions_and_varyings(triangle);
    let (points, depths) = (map3(varyings, |(point, _)| point), map3(varyings, |(_, depth)| depth));
    let scissor = scissor.into();
    begin_projected(&scissor, positions, &points, Some(depths), interpolation, walk);
    step_parameter_in(positions, points, depths, interpolation, walk, scissor.rect, emit);
    scissor.report(|observer| observer.done());
}

#[inline]
fn begin_projected<const N: usize>(
    scissor: &Scissor,
    positions: [DVec2; 3],
    points: &[Projected<f64, N>; 3],
    depth: Option<[f64; 3]>,
    interpolation: Interpolation,
    walk: Walk,
) {
    scissor.report(|observer| {
        let varyings = points.map(|point| point.values.to_vec());
        let w = Some(points.map(|point| point.w));
        observer.begun(&ScreenTriangle { positions, w, varyings, depth, interpolation, walk });
    });
}

// ANCHOR: step_parameter
/// Steps t′, and the depth, up the edges of the triangle and along each row.
#[inline]
fn step_parameter_in<const N: usize>(
    triangle: [DVec2; 3],
    points: [Projected<f64, N>; 3],
    depths: [f64; 3],
    interpolation: Interpolation,
    walk: Walk,
    scissor: Rect,
    mut emit: impl FnMut(i32, i32, Projected<f64, N>, f64),
) {
    let Some(split) = split(triangle) else { return };
    let between = |a, b, t| interpolation.between(a, b, t);
    let [lower_points, upper_points] = split.attach(points, between);
    let [lower_depths, upper_depths] = attach_depths(&split, depths);
    for (half, points, depths) in
        [(split.lower, lower_points, lower_depths), (split.upper, upper_points, upper_depths)]
    {
        // Up the edges: t′ goes from 0 at an edge's start to 1 at its end.
        half.step(&EdgeParameter::on(&depths), walk, scissor, |span, [left, right]| {
            // What is at the two ends of the row.
            let [start, end] = ends_of_row(&points, [left.t, right.t], interpolation);
            // Along the row: t′ goes from 0 to 1 again.
            let [from, to] = EdgeParameter::along_row([left, right]);
            span.step(from, to, walk.clamp, |x, here| {
                emit(x, span.y, between(start, end, here.t), here.depth);
            });
        });
    }
}
// ANCHOR_END: step_parameter

// ANCHOR: ends_of_row
/// The depths at the ends of the halves' edges.
#[inline]
pub(crate) fn attach_depths(split: &Split, depths: [f64; 3]) -> [Half<f64>; 2] {
    split.attach(depths, |a, b, t| a + (b - a) * t)
}

/// What is at the two ends of a row, where the parameters on its edges are these.
#[inline]
pub(crate) fn ends_of_row<const N: usize>(
    Half { left, right }: &Half<Projected<f64, N>>,
    [t_left, t_right]: [f64; 2],
    interpolation: Interpolation,
) -> [Projected<f64, N>; 2] {
    [
        interpolation.between(left.start, left.end, t_left),
        interpolation.between(right.start, right.end, t_right),
    ]
}
// ANCHOR_END: ends_of_row

/// What is stepped along edges and rows: t′, and a depth, which changes linearly on the screen.
///
/// At an edge's end the book's remedy clamps t′ alone.
#[derive(Clone, Copy)]
pub(crate) struct EdgeParameter {
    pub(crate) t: f64,
    pub(crate) depth: f64,
}

impl EdgeParameter {
    /// At the ends of the edges of a half on which the depths are these.
    #[inline]
    pub(crate) fn on(depths: &Half<f64>) -> Half<Self> {
        let edge = |depths: Edge<f64>| Edge {
            start: Self { t: 0.0, depth: depths.start },
            end: Self { t: 1.0, depth: depths.end },
        };
        Half { left: edge(depths.left), right: edge(depths.right) }
    }

    /// At the ends of a row, from what was reached on the two edges.
    #[inline]
    pub(crate) const fn along_row([left, right]: [Self; 2]) -> [Self; 2] {
        [Self { t: 0.0, ..left }, Self { t: 1.0, ..right }]
    }
}

impl Payload for EdgeParameter {
    #[inline]
    fn slope(start: Self, end: Self, length: f64) -> Self {
        Self { t: f64::slope(start.t, end.t, length), depth: f64::slope(start.depth, end.depth, length) }
    }

    #[inline]
    fn stepped(self, slope: Self, count: f64) -> Self {
        Self { t: self.t.stepped(slope.t, count), depth: self.depth.stepped(slope.depth, count) }
    }

    #[inline]
    fn clamped(self, start: Self, end: Self, clamp: StepClamp) -> Self {
        let depth = match clamp {
            StepClamp::Everywhere => self.depth.clamped(start.depth, end.depth, clamp),
            StepClamp::Edges | StepClamp::Overrun => self.depth,
        };
        Self { t: self.t.clamped(start.t, end.t, clamp), depth }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    use std::any::Any;
    use std::array::from_fn;
    use std::sync::{Arc, Mutex};

    use crate::observer::Observer;
    use crate::transform::{perspective, perspective_divide};
    use glam::{DVec3, dvec2, dvec3};
    use proptest::prelude::*;

    const SCISSOR: Rect = Rect::sized(60, 60);

    fn vertices<const N: usize>(positions: [DVec2; 3], values: [[f64; N]; 3]) -> [ScreenVertex<[f64; N]>; 3] {
        from_fn(|i| ScreenVertex { position: positions[i], varyings: values[i] })
    }

    /// The point of the screen that the walk stands for at each pixel: positions, interpolated like any value.
    fn walk_points(positions: [DVec2; 3]) -> Vec<((i32, i32), DVec2)> {
        let mut points = Vec::new();
        step_values(
            vertices(positions, positions.map(|p| p.to_array())),
            Walk::default(),
            SCISSOR,
            |x, y, p| {
                points.push(((x, y), DVec2::from(p)));
            },
        );
        points
    }

    fn point() -> impl Strategy<Value = DVec2> {
        (-10.0..70.0, -10.0..70.0).prop_map(DVec2::from)
    }

    fn whole_point() -> impl Strategy<Value = DVec2> {
        (0..60, 0..60).prop_map(|(x, y)| dvec2(f64::from(x), f64::from(y)))
    }

    /// A triangle with some area, so that rounding stays small.
    fn triangle(point: impl Strategy<Value = DVec2>) -> impl Strategy<Value = [DVec2; 3]> {
        prop::array::uniform3(point)
            .prop_filter("a sliver", |&[a, b, c]| twice_signed_area(a, b, c).abs() > 20.0)
    }

    fn is_near(a: f64, b: f64, scale: f64) -> bool {
        (a - b).abs() <= 1e-7 * scale
    }

    proptest! {
        #[test]
        fn weights_sum_to_one_and_give_the_point_back(p in point(), t in triangle(point())) {
            let w = barycentric_weights(p, t);
            prop_assert!(is_near(w.iter().sum(), 1.0, 100.0));
            prop_assert!((t[0] * w[0] + t[1] * w[1] + t[2] * w[2] - p).length() < 1e-6);
            for i in 0..3 {
                let at_corner = barycentric_weights(t[i], t);
                prop_assert!((0..3).all(|j| is_near(at_corner[j], f64::from(i == j), 100.0)));
            }
        }

        #[test]
        fn steps_equal_area_weights_at_the_point_that_the_walk_stands_for(
            t in triangle(point()), values in prop::array::uniform3(0.0..255.0),
        ) {
            let points = walk_points(t);
            let mut i = 0;
            step_values(vertices(t, values.map(|v| [v])), Walk::default(), SCISSOR, |x, y, [value]| {
                let (pixel, point) = points[i];
                assert_eq!(pixel, (x, y));
                let weights = barycentric_weights(point, t);
                let expected: f64 = (0..3).map(|i| weights[i] * values[i]).sum();
                assert!(is_near(value, expected, 255.0 * 100.0), "{value} is not {expected}");
                i += 1;
            });
            assert_eq!(i, points.len());
        }

        #[test]
        fn the_point_is_at_most_one_pixel_away(t in triangle(point())) {
            for ((x, y), point) in walk_points(t) {
                let off = point - dvec2(f64::from(x), f64::from(y));
                prop_assert!(off.x.abs() < 1.0 + 1e-6 && off.y.abs() < 1.0 + 1e-6, "{off} at ({x}, {y})");
            }
        }

        #[test]
        fn rows_of_whole_pixel_vertices_are_met_exactly(t in triangle(whole_point())) {
            // Across, a slanted side still lies between two pixels on most rows.
            for ((x, y), point) in walk_points(t) {
                prop_assert!((point.y - f64::from(y)).abs() < 1e-9, "{point} at ({x}, {y})");
            }
        }

        #[test]
        fn a_right_angle_of_whole_pixels_is_met_exactly(
            a in whole_point(), width in 5..50, height in 5..50,
        ) {
            let (width, height) = (f64::from(width), f64::from(height));
            for ((x, y), point) in walk_points([a, a + dvec2(width, 0.0), a + dvec2(0.0, height)]) {
                prop_assert!((point - dvec2(f64::from(x), f64::from(y))).length() < 1e-9, "{point} at ({x}, {y})");
            }
        }

        #[test]
        fn clamped_everywhere_no_depth_leaves_the_range_of_the_vertices(
            t in prop::array::uniform3(point()), z in prop::array::uniform3(-1.0..1.0), w in prop::array::uniform3(0.5..9.0),
        ) {
            let triangle = from_fn(|i| ScreenVertex { position: t[i], varyings: (Projected { w: w[i], values: [] }, z[i]) });
            let walk = Walk { clamp: StepClamp::Everywhere, ..Walk::default() };
            let (low, high) = (z.iter().copied().fold(1.0, f64::min), z.iter().copied().fold(-1.0, f64::max));
            step_parameter_and_depth(triangle, Interpolation::PerspectiveCorrect, walk, SCISSOR, |x, y, _, depth| {
                assert!(depth >= low - 1e-9 && depth <= high + 1e-9, "{depth} at ({x}, {y}) is not in {low}..{high}");
            });
        }

        #[test]
        fn both_forms_of_the_formula_agree(
            w in prop::array::uniform2(0.1..100.0), v in prop::array::uniform2(-5.0..5.0), t in 0.0..1.0,
        ) {
            let [a, b] = from_fn(|i| Projected { w: w[i], values: [v[i]] });
            let [book, usual] = [Interpolation::PerspectiveCorrect, Interpolation::Reciprocal].map(|i| i.between(a, b, t));
            prop_assert!(is_near(book.w, usual.w, 100.0) && is_near(book.values[0], usual.values[0], 5.0));
            prop_assert!((1.0 / book.w - ((1.0 - t) / a.w + t / b.w)).abs() < 1e-9, "1/ω changes linearly");
        }

        #[test]
        fn single_precision_follows_double(w in prop::array::uniform2(0.5..20.0), v in prop::array::uniform2(0.0..1.0), t in 0.0..1.0) {
            let of = |i: usize| Projected { w: w[i], values: [v[i]] };
            let of32 = |i: usize| Projected { w: w[i] as f32, values: [v[i] as f32] };
            let double: f64 = Interpolation::PerspectiveCorrect.between(of(0), of(1), t).values[0];
            let single: f32 = Interpolation::PerspectiveCorrect.between(of32(0), of32(1), t as f32).values[0];
            prop_assert!((double - f64::from(single)).abs() < 1e-5);
        }

        #[test]
        fn perspective_correct_is_where_the_ray_meets_the_plane(
            screen in triangle(point()), z in prop::array::uniform3(50.0..500.0), uv in prop::array::uniform3(prop::array::uniform2(0.0..1.0)),
        ) {
            // Points in space that are seen at the screen positions.
            const NEAR: f64 = 40.0;
            let space: [DVec3; 3] = from_fn(|i| dvec3(screen[i].x * z[i] / NEAR, screen[i].y * z[i] / NEAR, z[i]));
            let seen = space.map(|p| perspective_divide(perspective(p, NEAR)).truncate());
            let mut points = walk_points(seen).into_iter();
            let normal = (space[1] - space[0]).cross(space[2] - space[0]);
            prop_assume!(normal.length() > 1.0);

            let projected = from_fn(|i| ScreenVertex { position: seen[i], varyings: Projected { w: z[i], values: uv[i] } });
            step_parameter(projected, Interpolation::PerspectiveCorrect, Walk::default(), SCISSOR, |x, y, found| {
                let (pixel, point) = points.next().expect("a point for each pixel");
                assert_eq!(pixel, (x, y));
                // The ray from the eye through the point, and where it meets the plane of the triangle.
                let ray = dvec3(point.x / NEAR, point.y / NEAR, 1.0);
                let hit = ray * (normal.dot(space[0]) / normal.dot(ray));
                // The weights there, by areas in space.
                let area = |b: DVec3, c: DVec3| (b - hit).cross(c - hit).dot(normal) / normal.length_squared();
                let w = [area(space[1], space[2]), area(space[2], space[0]), area(space[0], space[1])];
                if hit.z > 40.0 && hit.z < 600.0 {
                    for (k, &value) in found.values.iter().enumerate() {
                        let expected: f64 = (0..3).map(|i| w[i] * uv[i][k]).sum();
                        assert!((value - expected).abs() < 1e-5, "{value} is not {expected} at ({x}, {y})");
                    }
                    assert!(is_near(found.w, hit.z, 1e4));
                }
            });
            prop_assert_eq!(points.next(), None, "a pixel for each point");
        }
    }

    #[test]
    fn interpolation_at_the_ends_and_between() {
        let a = Projected { w: 1.0, values: [0.0] };
        let b = Projected { w: 3.0, values: [8.0] };
        for interpolation in
            [Interpolation::Affine, Interpolation::PerspectiveCorrect, Interpolation::Reciprocal]
        {
            assert_eq!(interpolation.between(a, b, 0.0).values, [0.0]);
            assert!(is_near(interpolation.between(a, b, 1.0).values[0], 8.0, 1.0));
        }
        // The middle on the screen is at a quarter in space: the far end is squeezed.
        assert_eq!(Interpolation::Affine.between(a, b, 0.5), Projected { w: 2.0, values: [4.0] });
        assert_eq!(Interpolation::PerspectiveCorrect.between(a, b, 0.5), Projected { w: 1.5, values: [2.0] });
    }

    /// Triangles that were announced; `None` where one was done.
    #[derive(Debug, Default)]
    struct Told(Mutex<Vec<Option<ScreenTriangle>>>);

    impl Told {
        fn push(&self, what: Option<ScreenTriangle>) {
            self.0.lock().expect("not poisoned").push(what);
        }
    }

    impl Observer for Told {
        fn begun(&self, what: &dyn Any) {
            self.push(what.downcast_ref().cloned());
        }

        fn done(&self) {
            self.push(None);
        }
    }

    /// A right angle whose pixels are met exactly: x + y ≤ 8, but for the row of the upper vertex.
    const RIGHT_ANGLE: [DVec2; 3] = [dvec2(0.0, 0.0), dvec2(8.0, 0.0), dvec2(0.0, 8.0)];

    #[test]
    fn observers_are_told_what_each_walk_begins_with() {
        let told = Arc::new(Told::default());
        let scissor = Scissor { rect: SCISSOR, observer: Some(told.clone()) };
        let walk = Walk { clamp: StepClamp::Everywhere, ..Walk::default() };
        let values = [[1.0], [2.0], [3.0]];
        let w = [4.0, 5.0, 6.0];
        let depths = [7.0, 8.0, 9.0];
        let points: [_; 3] = from_fn(|i| Projected { w: w[i], values: values[i] });
        let vertex = |i: usize| RIGHT_ANGLE[i];
        let projected = from_fn(|i| ScreenVertex { position: vertex(i), varyings: points[i] });
        let with_depth = from_fn(|i| ScreenVertex { position: vertex(i), varyings: (points[i], depths[i]) });

        step_values(vertices(RIGHT_ANGLE, values), walk, scissor.clone(), |_, _, _| ());
        step_parameter(projected, Interpolation::Reciprocal, walk, scissor.clone(), |_, _, _| ());
        step_parameter_and_depth(with_depth, Interpolation::Reciprocal, walk, scissor, |_, _, _, _| ());

        let stepped = ScreenTriangle {
            positions: RIGHT_ANGLE,
            w: None,
            varyings: values.map(Vec::from),
            depth: None,
            interpolation: Interpolation::Affine,
            walk,
        };
        let plain =
            ScreenTriangle { w: Some(w), interpolation: Interpolation::Reciprocal, ..stepped.clone() };
        let deep = ScreenTriangle { depth: Some(depths), ..plain.clone() };
        let told = told.0.lock().expect("not poisoned");
        assert_eq!(*told, [Some(stepped), None, Some(plain), None, Some(deep), None]);
    }

    #[test]
    fn depths_are_linear_on_the_screen() {
        // x + 2 y at the vertices, and so everywhere, though the vertices are at different distances.
        let (depths, w) = ([0.0, 8.0, 16.0], [1.0, 2.0, 4.0]);
        let triangle = from_fn(|i| ScreenVertex {
            position: RIGHT_ANGLE[i],
            varyings: (Projected { w: w[i], values: [] }, depths[i]),
        });
        let (correct, walk) = (Interpolation::PerspectiveCorrect, Walk::default());
        let mut pixels = 0;
        step_parameter_and_depth(triangle, correct, walk, SCISSOR, |x, y, _, depth| {
            assert!(is_near(depth, f64::from(x + 2 * y), 1.0), "{depth} at ({x}, {y})");
            pixels += 1;
        });
        assert_eq!(pixels, 9 + 8 + 7 + 6 + 5 + 4 + 3 + 2);
    }

    #[test]
    fn odd_numbers_neither_panic_nor_hang() {
        let odd = [0.0, -1.0, 1e30, -1e30, f64::NAN, f64::INFINITY, f64::MAX];
        for (&x, &w) in odd.iter().flat_map(|x| odd.iter().map(move |w| (x, w))) {
            let triangle = [dvec2(x, 3.0), dvec2(50.0, x), dvec2(10.0, 40.0)];
            for clamp in [StepClamp::Overrun, StepClamp::Edges, StepClamp::Everywhere] {
                let walk = Walk { clamp, ..Walk::default() };
                let mut count = 0;
                step_values(vertices(triangle, [[w]; 3]), walk, SCISSOR, |_, _, _| count += 1);
                for interpolation in
                    [Interpolation::Affine, Interpolation::PerspectiveCorrect, Interpolation::Reciprocal]
                {
                    let projected = triangle
                        .map(|position| ScreenVertex { position, varyings: Projected { w, values: [x] } });
                    step_parameter(projected, interpolation, walk, Rect::sized(1, 1), |_, _, _| count += 1);
                }
                assert!(count <= 3 * 60 * 60, "a triangle covers no pixel more than twice");
            }
        }
    }
}
