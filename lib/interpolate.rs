//! Chapters 3 and 5: interpolation of the values that the corners of a triangle carry.
//!
//! Takes the spans of the scanline walk and says which values belong to each pixel; what they mean (a color, texture
//! coordinates) is the caller's business. The values of one corner are a plain array, `[R; N]`.
//!
//! ```
//! use glam::dvec2;
//! use rasterbook::interpolate::barycentric_weights;
//!
//! let triangle = [dvec2(0.0, 0.0), dvec2(6.0, 0.0), dvec2(0.0, 3.0)];
//! assert_eq!(barycentric_weights(dvec2(2.0, 1.0), triangle), [1.0 / 3.0; 3]); // the centroid
//! ```

use std::array::from_fn;

use glam::DVec2;

use crate::Rect;
use crate::area::twice_signed_area;
use crate::real::Real;
use crate::scanline::{Corner, Walk, split};

// ANCHOR: barycentric_weights
/// How much each corner of a triangle weighs at the point p: the area of the small triangle opposite to the corner, as
/// a part of the whole. The three weights sum to 1; one is negative beyond the edge opposite to its corner.
///
/// ```text
///            C                 w_A = area(P, B, C) / area(A, B, C)
///           ╱│╲                w_B = area(A, P, C) / area(A, B, C)
///          ╱ │ ╲               w_C = area(A, B, P) / area(A, B, C)
///         ╱  P  ╲
///        ╱ ╱   ╲ ╲             P = w_A A + w_B B + w_C C
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

/// The values at the parameter t between a (t = 0) and b (t = 1), changing evenly: (b − a) · t + a. Book, section 3.1.
#[must_use]
pub fn linear<R: Real, const N: usize>(a: [R; N], b: [R; N], t: R) -> [R; N] {
    from_fn(|i| (b[i] - a[i]) * t + a[i])
}

// ANCHOR: step_values
/// Emits the pixels of a triangle, each with its values, which go up the two sides and along each row by equal steps.
///
/// Screen space → (x, y, values). Along any straight line on the screen values change evenly (barycentric
/// interpolation), so that one addition a pixel is enough. Source: book, sections 3.2.4 and 3.2.5.
pub fn step_values<const N: usize>(
    corners: [Corner<[f64; N]>; 3],
    walk: Walk,
    window: Rect,
    mut emit: impl FnMut(i32, i32, [f64; N]),
) {
    for half in split(corners, linear).into_iter().flatten() {
        half.walk(
            |edge| [edge.start.attributes, edge.end.attributes],
            walk,
            window,
            |span| {
                let [start, end] = span.payload;
                span.step(start, end, |x, values| emit(x, span.y, values));
            },
        );
    }
}
// ANCHOR_END: step_values

/// What a corner carries once it has been projected (chapter 5): its distance ω and its values.
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
    /// Evenly on the screen, a mistake as soon as the corners are not equally far away.
    ///
    /// - Cause: equal steps on the screen are not equal steps in space; what is far away is squeezed.
    /// - Artefact: a texture bends at the diagonal of a quad and swims when the view moves.
    /// - Remedy: [`Interpolation::PerspectiveCorrect`]. Book, section 5.3, Figure 5-3.
    Affine,
    /// Evenly in space: the book's formula ⑧. Book, section 5.4.
    #[default]
    PerspectiveCorrect,
    /// Evenly in space by the usual two steps: 1/ω and V/ω change evenly on the screen. Book, section 5.5.4.
    Reciprocal,
}

impl Interpolation {
    /// What lies between two projected points at the parameter t′, measured on the screen from a (0) to b (1).
    #[must_use]
    pub fn between<R: Real, const N: usize>(
        self,
        a: Projected<R, N>,
        b: Projected<R, N>,
        t: R,
    ) -> Projected<R, N> {
        match self {
            Self::Affine => Projected { w: (b.w - a.w) * t + a.w, values: linear(a.values, b.values, t) },
            Self::PerspectiveCorrect => perspective_correct(a, b, t),
            Self::Reciprocal => reciprocal(a, b, t),
        }
    }
}
// ANCHOR_END: interpolation

// ANCHOR: perspective_correct
/// Formulas ⑨ and ⑧ of the book (section 5.4):
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
    Projected { w: (a.w * b.w) / denominator, values: from_fn(|i| value(a.values[i], b.values[i])) }
}
// ANCHOR_END: perspective_correct

// ANCHOR: reciprocal
/// The same in the form that most texts give (book, section 5.5.4): interpolate 1/ω and V/ω evenly, then divide.
fn reciprocal<R: Real, const N: usize>(a: Projected<R, N>, b: Projected<R, N>, t: R) -> Projected<R, N> {
    let one = R::of(1.0);
    let one_over_w = one / a.w + (one / b.w - one / a.w) * t;
    let value = |va: R, vb: R| (va / a.w + (vb / b.w - va / a.w) * t) / one_over_w;
    Projected { w: one / one_over_w, values: from_fn(|i| value(a.values[i], b.values[i])) }
}
// ANCHOR_END: reciprocal

// ANCHOR: step_parameter
/// Emits the pixels of a projected triangle, each with its ω and its values.
///
/// Screen space → (x, y, ω and values). What goes up the sides and along each row by equal steps is the parameter t′;
/// `interpolation` makes values of it, once for each end of a row and once for each pixel. Source: book, section 5.4,
/// Figure 5-7.
pub fn step_parameter<const N: usize>(
    corners: [Corner<Projected<f64, N>>; 3],
    interpolation: Interpolation,
    walk: Walk,
    window: Rect,
    mut emit: impl FnMut(i32, i32, Projected<f64, N>),
) {
    let between = |a, b, t| interpolation.between(a, b, t);
    for half in split(corners, between).into_iter().flatten() {
        half.walk(
            |_| [0.0, 1.0],
            walk,
            window,
            |span| {
                let [t_left, t_right] = span.payload;
                let start = between(half.left.start.attributes, half.left.end.attributes, t_left);
                let end = between(half.right.start.attributes, half.right.end.attributes, t_right);
                span.step(0.0, 1.0, |x, t| emit(x, span.y, between(start, end, t)));
            },
        );
    }
}
// ANCHOR_END: step_parameter
