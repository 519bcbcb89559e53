//! What is hidden in all of a tile need not be drawn there.

use super::edges::{Setup, corners, is_narrow};
use super::front::{Triangle, bounding_box};
use super::tile::{Frame, is_plain};
use crate::Rect;
use crate::shader::Shader;

/// No depth is behind this one.
pub(super) const NOTHING_IS_HIDDEN: f64 = f64::INFINITY;

// ANCHOR: occlusion
/// The depth behind which nothing can be seen in a tile: that of the nearest large triangle that covers all of it, where
/// it is farthest away.
///
/// ```text
///   depth
///     ▲  ──────────────── A       nowhere nearer than `behind`: hidden, whether it comes first or last
///     │ ─ ─ ─ ─ ─ ─ ─ ─ ╱ ─ behind
///     │            ╱
///     │      ╱                    B covers the tile
///     │ ╱
///     └─┼───────────────┼───► x
///           the tile
/// ```
///
/// Only with the default options, under which the nearest fragment stays.
pub(super) fn hidden_behind<'a, S: Shader<N>, const N: usize>(
    frame: &Frame<'_, S, N>,
    triangles: impl Iterator<Item = Triangle<'a>>,
    tile: Rect,
) -> f64 {
    if !is_plain(frame.state) {
        return NOTHING_IS_HIDDEN;
    }
    let covering = triangles.filter_map(|triangle| {
        let is_large = !is_narrow(triangle.places) && bounding_box(triangle.places, tile) == Some(tile);
        let setup = is_large.then(|| Setup::new(triangle.places)).flatten();
        let setup = setup.filter(|setup| setup.covers(tile))?;
        Some(depth_range(&setup, triangle, tile)[1])
    });
    covering.fold(NOTHING_IS_HIDDEN, f64::min)
}

/// The least and the greatest depth that a triangle can have in a rectangle, with room for rounding.
pub(super) fn depth_range(setup: &Setup, triangle: Triangle<'_>, rect: Rect) -> [f64; 2] {
    let [first, second, third] = triangle.records.map(|record| f64::from(record[0].as_array_ref()[1]));
    let (to_second, to_third) = (second - first, third - first);
    let depths = corners(rect).map(|corner| {
        let [second, third] = [1, 2].map(|i| setup.edges[i].at(corner) as f64);
        first + (to_second * second + to_third * third) * f64::from(setup.one_over_area)
    });
    // A pixel's depth takes some seven roundings of 2⁻²⁴ each.
    let room = (first.abs() + to_second.abs() + to_third.abs()) * f64::from(f32::EPSILON) * 8.0;
    [depths.into_iter().fold(f64::MAX, f64::min) - room, depths.into_iter().fold(f64::MIN, f64::max) + room]
}
// ANCHOR_END: occlusion
