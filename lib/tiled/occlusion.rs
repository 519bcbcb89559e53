//! What is hidden in all of a tile need not be drawn there.

use super::edges::SMALL_SIDE;
use super::frame::Frame;
use super::snapped::{box_of, is_at_most, shared};
use super::vertices::Triangle;
use crate::exact::edge::{Coverage, Subpixel, center};
use crate::rect::Rect;
use crate::shader::Shader;

/// No depth is behind this one.
pub(super) const NO_OCCLUDER: f64 = f64::INFINITY;
/// Of triangles with larger depths nothing is said.
const FARTHEST: f64 = 1e27;

// ANCHOR: occlusion
/// The depth behind which nothing can be seen in a tile: that of the nearest large triangle that covers all of it, where
/// it is farthest away.
///
/// ```text
///   depth
///     ▲  ──────────────── A       nowhere nearer than that: hidden, whether first or last
///     │ ─ ─ ─ ─ ─ ─ ─ ─ ╱ ─ the occluder depth
///     │            ╱
///     │      ╱                    B covers the tile
///     │ ╱
///     └─┼───────────────┼───► x
///           the tile
/// ```
///
/// Only with the default options, under which the nearest fragment stays.
pub(super) fn occluder_depth<S: Shader<N>, const N: usize>(
    frame: &Frame<'_, S, N>,
    number: usize,
    tile: Rect,
) -> f64 {
    let mut nearest = NO_OCCLUDER;
    if !frame.is_plain {
        return nearest;
    }
    frame.front.each_triangle_in(frame.source, number, |triangle| {
        let whole = box_of(triangle.positions);
        // What goes through the queue is not noted if the shader throws it away.
        let is_large = !is_at_most(whole, SMALL_SIDE as i32);
        if is_large
            && shared(whole, tile) == Some(tile)
            && let Some(coverage) = coverage_of(triangle)
            && corners(tile).into_iter().all(|corner| coverage.covers(coverage.edge_values(corner)))
        {
            nearest = nearest.min(depth_range(&coverage, triangle, tile)[1]);
        }
    });
    nearest
}

/// The outermost centers of a rectangle: what changes linearly has its extremes there.
fn corners(Rect { left, bottom, right, top }: Rect) -> [Subpixel; 4] {
    [(left, bottom), (right - 1, bottom), (left, top - 1), (right - 1, top - 1)].map(|(x, y)| center(x, y))
}

/// A triangle that has been snapped; `None` without area.
pub(super) fn coverage_of(triangle: Triangle<'_>) -> Option<Coverage> {
    Coverage::of(triangle.vertices())
}

/// The least and the greatest depth that a triangle can have in a rectangle, with room for rounding.
pub(super) fn depth_range(coverage: &Coverage, triangle: Triangle<'_>, rect: Rect) -> [f64; 2] {
    let [first, second, third] = triangle.packed.map(|packed| f64::from(packed[0].0[1]));
    let (to_second, to_third) = (second - first, third - first);
    let depths = corners(rect).map(|corner| {
        let [second, third] = coverage.weights::<f64>(coverage.edge_values(corner));
        first + to_second * second + to_third * third
    });
    let most = first.abs() + to_second.abs() + to_third.abs();
    // From pixel to pixel depths of a thin triangle change by up to 2³³ times as much: beyond single precision, perhaps.
    if most.is_nan() || most > FARTHEST {
        return [f64::NEG_INFINITY, f64::INFINITY];
    }
    // A pixel's depth takes some twenty roundings of 2⁻²⁴ each, on the way to the first of its row and from there.
    let room = most * f64::from(f32::EPSILON) * 16.0;
    [depths.into_iter().fold(f64::MAX, f64::min) - room, depths.into_iter().fold(f64::MIN, f64::max) + room]
}
// ANCHOR_END: occlusion

#[cfg(test)]
mod tests {
    use std::sync::atomic::AtomicBool;

    use super::*;
    use crate::clip::{ClipVertex, NdcVertex};
    use crate::interpolate::Interpolation;
    use crate::shader::from_fn;
    use crate::state::RenderState;
    use crate::tiled::Instructions;
    use crate::tiled::frame::is_plain;
    use crate::tiled::front::{Front, Source};
    use crate::tiled::vertices::{Projection, Vertices};
    use glam::{DVec4, dvec3};

    /// The lower left half of a rectangle so many times as large as the tile.
    fn half(size: f64, depth: f64) -> [NdcVertex<0>; 3] {
        let far = size - 1.0;
        [(-1.0, -1.0), (far, -1.0), (-1.0, far)].map(|(x, y)| NdcVertex {
            position: dvec3(x, y, depth),
            w: 1.0,
            varyings: [],
        })
    }

    /// The occluder depth in a tile, the lower left quarter of a picture.
    fn occluder(state: &RenderState, tile: Rect, triangles: &[[NdcVertex<0>; 3]]) -> f64 {
        let shader =
            from_fn(|&position: &DVec4| ClipVertex { position, varyings: [] }, |_: [f64; 0]| [0.0; 3]);
        let source = Source::Pieces(triangles);
        let mut front = Front::default();
        let picture = Rect { right: 2 * tile.right, top: 2 * tile.top, ..tile };
        front.prepare(Instructions::baseline(), &source, &shader, state, picture);
        let (columns, discards) = (picture.right, AtomicBool::new(false));
        let (front, source, is_plain) = (&front, &source, is_plain(state));
        let frame = Frame { shader: &shader, state, front, source, is_plain, columns, discards };
        occluder_depth(&frame, 0, tile)
    }

    #[test]
    fn what_covers_a_tile_hides_what_is_behind_it() {
        let (state, tile) = (RenderState::default(), Rect::sized(64, 16));
        // They cover the last pixel, and would not cover another one.
        let [near, far] = [0.25, 0.5].map(|depth| half(1.965, depth));
        for triangles in [[near, far], [far, near]] {
            let depth = occluder(&state, tile, &triangles);
            assert!(depth > 0.25 && depth < 0.2501, "{depth}: the nearer one, and room for rounding");
        }
        let nearly = half(1.9, 0.25);
        assert_eq!(occluder(&state, tile, &[nearly]), NO_OCCLUDER, "the last pixel is not covered");
        assert_eq!(occluder(&state, tile, &[]), NO_OCCLUDER);
        // Nine pixels wide and high, and eight.
        let small = Rect::sized(4, 4);
        assert!(occluder(&state, small, &[half(9.0 / 4.0, 0.25)]) < 0.2501);
        assert_eq!(occluder(&state, small, &[half(8.0 / 4.0, 0.25)]), NO_OCCLUDER);
        let affine = RenderState { interpolation: Interpolation::Affine, ..state };
        assert_eq!(occluder(&affine, tile, &[near]), NO_OCCLUDER, "not with other options");
    }

    /// The range of depths in a rectangle of a triangle with these depths at (0, 0), (128, 0) and (0, 128).
    fn range(depths: [f64; 3], rect: Rect) -> [f64; 2] {
        let ndc = [(-1.0, -1.0), (3.0, -1.0), (-1.0, 3.0)];
        let ndc = [0, 1, 2].map(|i| NdcVertex {
            position: dvec3(ndc[i].0, ndc[i].1, depths[i]),
            w: 1.0,
            varyings: [],
        });
        let (mut vertices, state) = (Vertices::default(), RenderState::default());
        vertices.push(&ndc, &Projection::new(&state, Rect::sized(64, 64))).expect("near enough");
        let triangle = vertices.triangle::<0>([0, 1, 2]);
        depth_range(&coverage_of(triangle).expect("an area"), triangle, rect)
    }

    #[test]
    fn depths_are_between_those_of_the_outermost_centers() {
        let rect = Rect { left: 3, bottom: 7, right: 20, top: 30 };
        let depth = |x: f64, y: f64| 0.5 + (0.25 * y - 0.125 * x) / 128.0;
        let [least, greatest] = range([0.5, 0.375, 0.75], rect);
        // The greatest of all numbers in the sum, and of each sixteen roundings of single precision.
        let room = (0.5 + 0.125 + 0.25) * 16.0 * f64::from(f32::EPSILON);
        assert!((least - (depth(19.5, 7.5) - room)).abs() < 1e-15, "{least}");
        assert!((greatest - (depth(3.5, 29.5) + room)).abs() < 1e-15, "{greatest}");
    }

    #[test]
    fn of_depths_without_measure_nothing_is_said() {
        let one = Rect::sized(1, 1);
        let nothing = [f64::NEG_INFINITY, f64::INFINITY];
        for odd in [2.0 * FARTHEST, -2.0 * FARTHEST, f64::NAN, f64::INFINITY] {
            assert_eq!(range([odd, 0.0, 0.0], one), nothing, "{odd}");
            assert_eq!(range([0.0, odd, 0.0], one), nothing, "{odd}");
            assert_eq!(range([0.0, 0.0, odd], one), nothing, "{odd}");
        }
        assert_ne!(range([0.0, 0.0, FARTHEST / 2.0], one), nothing);
    }
}
