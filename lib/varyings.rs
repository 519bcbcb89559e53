//! Chapter 9, beyond the book: interpolation by weights, corrected by w, for rasterizers that know where in a triangle they are.
//!
//! Chapter 3 finds weights by areas, chapter 5 corrects a parameter along a row; here the weights themselves are
//! corrected. Takes what the vertices of a triangle carry and weights on the screen; gives varyings, the depth, and how
//! the varyings change from pixel to pixel.
//!
//! ```
//! use glam::dvec2;
//! use rasterbook::varyings::weight_gradients;
//!
//! // The weight of the second vertex grows by a quarter a pixel to the right, that of the third by an eighth upwards.
//! let gradients = weight_gradients::<f64>([dvec2(1.0, 1.0), dvec2(5.0, 1.0), dvec2(1.0, 9.0)]);
//! assert_eq!(gradients, [[0.25, 0.0], [0.0, 0.125]]);
//! ```

use glam::DVec2;

use crate::area::twice_signed_area;
use crate::clip::NdcVertex;
use crate::interpolate::{Interpolation, Projected};
use crate::real::{Real, each, map3};

/// How varyings change from one pixel to the next: to the right, and upwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Derivatives<R, const N: usize> {
    /// ∂V/∂x, per pixel.
    pub dx: [R; N],
    /// ∂V/∂y, per pixel.
    pub dy: [R; N],
}

/// How the weights of the second and the third vertex change per pixel, to the right and upwards.
pub type WeightGradients<R> = [[R; 2]; 2];

/// The gradients of the weights in a triangle on the screen, in pixels.
#[must_use]
#[inline]
pub fn weight_gradients<R: Real>([a, b, c]: [DVec2; 3]) -> WeightGradients<R> {
    let area = twice_signed_area(a, b, c);
    [[c.y - a.y, a.y - b.y], [a.x - c.x, b.x - a.x]].map(|row| row.map(|change| R::of(change / area)))
}

// ANCHOR: triangle_varyings
/// What changes linearly on the screen: what a vertex carries, divided by w; the same at a point
/// between vertices; or how much all of it changes from there to another point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearVaryings<R, const N: usize> {
    /// 1/w; for [`Interpolation::Affine`] w itself.
    pub distance: R,
    /// The depth.
    pub depth: R,
    /// V/w; for [`Interpolation::Affine`] V itself.
    pub values: [R; N],
}

impl<R: Real, const N: usize> LinearVaryings<R, N> {
    /// At a vertex: divides what is to be interpolated by w. All triangles that meet there can
    /// share it.
    #[must_use]
    #[inline(always)]
    pub fn new(vertex: &NdcVertex<N>, interpolation: Interpolation) -> Self {
        let (w, depth) = (R::of(vertex.w), R::of(vertex.position.z));
        let values = each([R::of(0.0); N], |k, _| R::of(vertex.varyings[k]));
        match interpolation {
            Interpolation::Affine => Self { distance: w, depth, values },
            Interpolation::PerspectiveCorrect | Interpolation::Reciprocal => {
                let over_w = R::of(1.0) / w;
                Self {
                    distance: over_w,
                    depth,
                    values: each(
                        values,
                        #[inline(always)]
                        |_, value| value * over_w,
                    ),
                }
            }
        }
    }

    /// Combines each number with the one of the same meaning.
    #[inline(always)]
    fn with(&self, other: &Self, combine: impl Fn(R, R) -> R) -> Self {
        Self {
            distance: combine(self.distance, other.distance),
            depth: combine(self.depth, other.depth),
            values: each(
                self.values,
                #[inline(always)]
                |k, value| combine(value, other.values[k]),
            ),
        }
    }

    /// After so many times a change.
    #[must_use]
    #[inline(always)]
    pub fn moved(&self, change: &Self, times: R) -> Self {
        self.with(
            change,
            #[inline(always)]
            |value, change| value + change * times,
        )
    }

    /// Multiplies by w again: what was interpolated linearly becomes w and values.
    #[must_use]
    #[inline(always)]
    pub fn multiplied(self, interpolation: Interpolation) -> Projected<R, N> {
        match interpolation {
            Interpolation::Affine => Projected { w: self.distance, values: self.values },
            Interpolation::PerspectiveCorrect | Interpolation::Reciprocal => {
                let w = R::of(1.0) / self.distance;
                Projected {
                    w,
                    values: each(
                        self.values,
                        #[inline(always)]
                        |_, value| value * w,
                    ),
                }
            }
        }
    }

    /// How the varyings change at a point, if this is how they change linearly from there to the
    /// next pixel.
    ///
    /// From V = (V/w) / (1/w) by the quotient rule: ∂V = w (∂(V/w) − V ∂(1/w)).
    #[must_use]
    #[inline(always)]
    pub fn derivative(&self, point: &Projected<R, N>, interpolation: Interpolation) -> [R; N] {
        match interpolation {
            Interpolation::Affine => self.values,
            Interpolation::PerspectiveCorrect | Interpolation::Reciprocal => each(
                self.values,
                #[inline(always)]
                |k, value| (value - point.values[k] * self.distance) * point.w,
            ),
        }
    }
}

/// What the vertices of a triangle carry, made ready for weights: its value at the first, and the
/// differences to the other two.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleVaryings<R, const N: usize> {
    first: LinearVaryings<R, N>,
    to_second: LinearVaryings<R, N>,
    to_third: LinearVaryings<R, N>,
    interpolation: Interpolation,
}

impl<R: Real, const N: usize> TriangleVaryings<R, N> {
    /// From the three vertices of a triangle.
    #[must_use]
    #[inline]
    pub fn new(vertices: &[NdcVertex<N>; 3], interpolation: Interpolation) -> Self {
        let [first, second, third] =
            map3(vertices.each_ref(), |vertex| LinearVaryings::new(vertex, interpolation));
        let difference = |vertex: LinearVaryings<R, N>| vertex.with(&first, |a, b| a - b);
        Self { first, to_second: difference(second), to_third: difference(third), interpolation }
    }

    /// What changes linearly, where the second and the third vertex have these weights.
    #[must_use]
    #[inline]
    pub fn linear_at(&self, [second, third]: [R; 2]) -> LinearVaryings<R, N> {
        self.first.moved(&self.to_second, second).moved(&self.to_third, third)
    }

    /// How much it changes where the weights of the second and the third vertex change by so much.
    #[must_use]
    #[inline]
    pub fn change(&self, [second, third]: [R; 2]) -> LinearVaryings<R, N> {
        self.to_second.with(&self.to_third, |b, c| b * second + c * third)
    }

    /// w and the varyings where the second and the third vertex have these weights.
    #[must_use]
    #[inline]
    pub fn at(&self, weights: [R; 2]) -> Projected<R, N> {
        self.linear_at(weights).multiplied(self.interpolation)
    }

    /// How the varyings change from pixel to pixel at a point.
    #[must_use]
    #[inline]
    pub fn derivatives(
        &self,
        point: &Projected<R, N>,
        weight_gradients: WeightGradients<R>,
    ) -> Derivatives<R, N> {
        let along = |weights| self.change(weights).derivative(point, self.interpolation);
        let [x, y] = weight_gradients;
        Derivatives { dx: along(x), dy: along(y) }
    }
}
// ANCHOR_END: triangle_varyings

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interpolate::perspective_weights;
    use glam::dvec3;
    use proptest::prelude::*;
    use std::array::from_fn;

    fn weights() -> impl Strategy<Value = [f64; 3]> {
        (0.0..1.0, 0.0..1.0).prop_map(|(a, b): (f64, f64)| {
            let [b, c] = [b * (1.0 - a), (1.0 - b) * (1.0 - a)];
            [a, b, c]
        })
    }

    fn vertices(w: [f64; 3], values: [f64; 3]) -> [NdcVertex<1>; 3] {
        from_fn(|i| NdcVertex { position: dvec3(0.0, 0.0, w[i]), w: w[i], varyings: [values[i]] })
    }

    #[test]
    fn what_cannot_be_corrected_stays() {
        let weights = [0.2, 0.3, 0.5];
        assert_eq!(perspective_weights(weights, [0.0; 3]), weights, "all ω are zero");
        assert_eq!(perspective_weights(weights, [1.0, 0.0, 2.0]), weights, "one is");
        assert_eq!(perspective_weights([0.5, 0.5, 0.0], [1.0, -1.0, 1.0]), [0.5, 0.5, 0.0], "their sum is");
    }

    #[test]
    fn gradients_of_weights() {
        use glam::dvec2;
        // The second weight grows by a quarter a pixel to the right, the third by an eighth a pixel upwards.
        let gradients: WeightGradients<f64> =
            weight_gradients([dvec2(1.0, 1.0), dvec2(5.0, 1.0), dvec2(1.0, 9.0)]);
        assert_eq!(gradients, [[0.25, 0.0], [0.0, 0.125]]);
    }

    proptest! {
        #[test]
        fn an_orthographic_projection_needs_no_correction(weights in weights(), w in 0.1..10.0) {
            let corrected = perspective_weights(weights, [w; 3]);
            prop_assert!((0..3).all(|i| (corrected[i] - weights[i]).abs() < 1e-14));
        }

        #[test]
        fn both_ways_to_a_value_agree(weights in weights(), w in prop::array::uniform3(0.1..10.0), v in prop::array::uniform3(-5.0..5.0)) {
            let corrected = perspective_weights(weights, w);
            let by_weights: f64 = (0..3).map(|i| corrected[i] * v[i]).sum();
            let varyings = TriangleVaryings::<f64, 1>::new(&vertices(w, v), Interpolation::PerspectiveCorrect);
            let point = varyings.at([weights[1], weights[2]]);
            prop_assert!((point.values[0] - by_weights).abs() < 1e-11);
            let one_over_w: f64 = (0..3).map(|i| weights[i] / w[i]).sum();
            prop_assert!((point.w - 1.0 / one_over_w).abs() < 1e-11);
        }

        #[test]
        fn derivatives_are_the_limit_of_differences(
            weights in weights(), w in prop::array::uniform3(0.5..5.0), v in prop::array::uniform3(-5.0..5.0),
            affine in any::<bool>(),
        ) {
            const STEP: f64 = 1e-6;
            let interpolation = if affine { Interpolation::Affine } else { Interpolation::PerspectiveCorrect };
            let varyings = TriangleVaryings::<f64, 1>::new(&vertices(w, v), interpolation);
            let gradients = [[0.3, -0.1], [-0.2, 0.4]];
            let at = |steps: [f64; 2]| {
                varyings.at(from_fn(|k| weights[k + 1] + gradients[0][k] * steps[0] + gradients[1][k] * steps[1]))
            };
            let derivatives = varyings.derivatives(&at([0.0, 0.0]), gradients);
            let slope = |ahead: [f64; 2], behind: [f64; 2]| (at(ahead).values[0] - at(behind).values[0]) / (2.0 * STEP);
            prop_assert!((derivatives.dx[0] - slope([STEP, 0.0], [-STEP, 0.0])).abs() < 1e-5);
            prop_assert!((derivatives.dy[0] - slope([0.0, STEP], [0.0, -STEP])).abs() < 1e-5);
        }
    }
}
