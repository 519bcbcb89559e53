//! Beyond the book: the exact rasterizer. Which pixels a triangle covers is decided with whole numbers
//! ([`edge`]).
//!
//! Takes triangles in NDC, as the scanline rasterizer does, and implements the same trait.
//!
//! # Contract
//!
//! **Which pixels.** The viewport maps NDC −1..1 to 0..width and 0..height, y up; the pixel (i, j) is sampled at its
//! center (i + ½, j + ½). After clipping and the viewport, and before culling, x and y of each vertex are rounded to the
//! nearest multiple of 1/256, halves away from zero. All decisions are made on these whole numbers, in 64-bit integers,
//! which cannot overflow. The facing of a triangle is the sign of its area there; one without area is not drawn. A
//! sample inside is covered; one on an edge is covered if the edge is a *top* edge (horizontal, the triangle below it)
//! or a *left* edge (not horizontal, the triangle on its right), as seen on the screen; one on two edges, if both are.
//!
//! **Which values.** Weights are E · (1 / sum of the three E), E the exact values of the edge functions at the center,
//! converted, divided and multiplied with one rounding each. In the first covered pixel of a row 1/w, V/w and the depth
//! are interpolated by these weights; in the nth after it they are that plus n times their change from pixel to pixel,
//! which comes from the change of E in the same way. V/w is V · (1/w), and V = (V/w) · 1/(1/w). The depth is linear on the
//! screen. All arithmetic is that of the number type: four operations, one rounding each.
//!
//! **Which rounding.** To a channel ½ is added, and the fraction of the sum cut off: the nearest of 0..=255, halves upwards.
//! NaN gives 0.
//!
//! Triangles that share an edge, with the same two vertices, leave no hole along it and draw nothing twice. Where a
//! vertex of one lies in the middle of an edge of another (a T-junction), rounding may move it off that edge.
//!
//! Vertices outside twice the width and height of the view, beside the eye (w = 0) and behind it, are clipped away before
//! they are rounded (a *guard band*); a triangle that is still farther than 2¹⁶ pixels from the origin is not drawn.
//!
//! Sources: Direct3D 11.3 functional specification, 3.2.3.6 (colors), 3.3 (pixel centers), 3.4.1 (snapping), 3.4.2.1
//! (top-left rule), 15.11.1 (facing); Vulkan specification, *Basic polygon rasterization* (values by weights); OpenGL
//! 4.6, 14.6.1, asks only that one of two triangles sharing an edge covers a sample, which follows.

pub mod edge;
pub mod samples;

use std::marker::PhantomData;

use arrayvec::ArrayVec;
use glam::dvec4;

use crate::clip::{ClipTest, ClipVertex, NdcVertex, Plane, Polygon, RecordedVertex, clip_triangle, fan};
use crate::fragment::FragmentStages;
use crate::merge::Rounding;
use crate::probe::{Piece, Probe};
use crate::raster::Rasterizer;
use crate::real::{Scalar, map3};
use crate::shader::Shader;
use crate::state::RenderState;
use crate::target::Target;
use crate::varyings::TriangleVaryings;

use edge::{Announced, Coverage, center};

/// The exact rasterizer, computing in `R`: `f64` or `f32`. Coverage is the same in both.
///
/// See the [module](self) for its contract. What [`RenderState::walk`] says does not concern it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Exact<R>(PhantomData<R>);

impl<R: Scalar> Exact<R> {
    /// The rasterizer.
    #[must_use]
    #[inline]
    pub const fn new() -> Self {
        Self(PhantomData)
    }
}

impl<R: Scalar> Rasterizer for Exact<R> {
    type Depth = R;

    fn draw<S: Shader<N>, P: Probe + ?Sized, const N: usize>(
        &self,
        triangles: impl Iterator<Item = [NdcVertex<N>; 3]>,
        state: &RenderState,
        shader: &S,
        target: &mut Target<R>,
        probe: &P,
    ) {
        target.assert_depths();
        for triangle in triangles {
            if triangle.iter().all(is_in_guard_band) {
                draw_triangle::<R, S, P, N>(&triangle, state, shader, target, probe);
            } else {
                for piece in fan(cut_to_guard_band(triangle)) {
                    draw_triangle::<R, S, P, N>(&piece, state, shader, target, probe);
                }
            }
        }
    }
}

// ANCHOR: guard_band
/// How far beyond the border of the view a vertex may be, in NDC.
pub(crate) const GUARD_BAND: f64 = 2.0;

/// A polygon of NDC: a triangle, and what cuts add to it.
type CutTriangle<const N: usize> = ArrayVec<NdcVertex<N>, 9>;

#[inline]
pub(crate) fn is_in_guard_band<const N: usize>(vertex: &NdcVertex<N>) -> bool {
    vertex.w > 0.0 && vertex.position.truncate().abs().max_element() <= GUARD_BAND
}

/// The part of a triangle in the guard band: only for pipelines that do not clip to the view
/// volume.
pub(crate) fn cut_to_guard_band<const N: usize>(triangle: [NdcVertex<N>; 3]) -> CutTriangle<N> {
    const PLANES: [Plane; 4] = [
        Plane::homogeneous(dvec4(1.0, 0.0, 0.0, GUARD_BAND)),
        Plane::homogeneous(dvec4(-1.0, 0.0, 0.0, GUARD_BAND)),
        Plane::homogeneous(dvec4(0.0, 1.0, 0.0, GUARD_BAND)),
        Plane::homogeneous(dvec4(0.0, -1.0, 0.0, GUARD_BAND)),
    ];
    let clip = map3(triangle, |vertex| ClipVertex {
        position: (vertex.position * vertex.w).extend(vertex.w),
        varyings: vertex.varyings,
    });
    let polygon: Polygon<N> = clip_triangle(clip, &PLANES, ClipTest::BeforeDivide);
    polygon.into_iter().map(NdcVertex::from).collect()
}
// ANCHOR_END: guard_band

// ANCHOR: draw_triangle
fn draw_triangle<R: Scalar, S: Shader<N>, P: Probe + ?Sized, const N: usize>(
    triangle: &[NdcVertex<N>; 3],
    state: &RenderState,
    shader: &S,
    target: &mut Target<R>,
    probe: &P,
) {
    // 6. Viewport: NDC → screen, and to 1/256 pixel.
    let scissor = target.color.scissor();
    let viewport = state.viewport_in(scissor.rect);
    let coverage = Coverage::new(map3(*triangle, |vertex| viewport.pixel_areas(vertex.position)));

    // 5. Culling, by the signed area on the screen.
    let signed_area = coverage.as_ref().map_or(0.0, Coverage::signed_area);
    probe.piece(&|| Piece { vertices: RecordedVertex::of_triangle(triangle), signed_area });
    let is_culled = state.cull.culls(signed_area, state.front_face);
    let Some(coverage) = coverage.filter(|_| !is_culled) else {
        probe.culled();
        return;
    };

    // What the vertices carry, made ready for weights, and how it changes from pixel to pixel.
    let varyings = TriangleVaryings::<R, N>::new(triangle, state.interpolation);
    let step = varyings.change(coverage.weight_step());
    let gradients = coverage.weight_gradients();

    // 7. Rasterization: which pixels, and which values. Each fragment goes through stages 8 to 10.
    let area = coverage.bounding_box(scissor.rect);
    let _announced = Announced::new(scissor, &coverage);
    let mut stages = FragmentStages { shader, state, rounding: Rounding::Nearest, target, probe };
    for y in area.rows() {
        let columns = coverage.covered_columns(area.columns(), y);
        let values = coverage.edge_values(center(columns.start, y));
        let start = varyings.linear_at(coverage.weights(values));
        for (count, x) in columns.enumerate() {
            let linear = start.moved(&step, R::of(count as f64));
            let point = linear.multiplied(state.interpolation);
            stages.draw((x, y), point, linear.depth, |it| varyings.derivatives(it, gradients));
        }
    }
}
// ANCHOR_END: draw_triangle

#[cfg(test)]
mod tests {
    use super::*;

    use glam::dvec3;

    fn vertex<const N: usize>([x, y]: [f64; 2], w: f64, varyings: [f64; N]) -> NdcVertex<N> {
        NdcVertex { position: dvec3(x, y, 0.5), w, varyings }
    }

    #[test]
    fn the_guard_band_is_twice_the_view_in_front_of_the_eye() {
        let is_inside = |place, w| is_in_guard_band(&vertex(place, w, []));
        assert!(is_inside([2.0, -2.0], 1.0) && is_inside([-2.0, 2.0], 0.25));
        for outside in [[2.1, 0.0], [-2.1, 0.0], [0.0, 2.1], [0.0, -2.1]] {
            assert!(!is_inside(outside, 1.0), "{outside:?}");
        }
        assert!(!is_inside([0.0, 0.0], 0.0) && !is_inside([0.0, 0.0], -1.0));
    }

    #[test]
    fn what_is_beyond_the_guard_band_is_cut_off() {
        // To each of the four sides: half of the way out to 4 is left, and the value there is half of 8.
        let sides: [fn(f64, f64) -> [f64; 2]; 4] =
            [|x, y| [x, y], |x, y| [-x, -y], |x, y| [y, x], |x, y| [-y, -x]];
        for turned in sides {
            let at = |x, y, value| vertex(turned(x, y), 2.0, [value]);
            let cut = cut_to_guard_band([at(0.0, 0.0, 0.0), at(4.0, 0.0, 8.0), at(0.0, 1.0, 0.0)]);
            let expected = [at(0.0, 0.0, 0.0), at(2.0, 0.0, 4.0), at(2.0, 0.5, 4.0), at(0.0, 1.0, 0.0)];
            assert_eq!(cut.as_slice(), expected);
        }
    }
}
