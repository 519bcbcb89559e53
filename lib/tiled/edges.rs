//! Edge functions for eight pixels at a time: in as few bits as do, and always exact.

use std::array::from_fn;

use wide::i32x8;

use super::front::{Place, signed_area};
use crate::Rect;
use crate::edge::{EdgeFunction, SUBPIXELS, center};
use crate::lanes::{LANES, LaneMask, Lanes, is_less_or_equal};
use crate::real::Mask;
use crate::varyings::WeightGradients;

/// The three edges of a triangle, each on the left of its inside, opposite to its vertex.
pub(super) struct Setup {
    pub(super) edges: [EdgeFunction; 3],
    /// What is taken off a value so that "not negative" means covered: 1 on edges that are neither top nor left.
    pub(super) shy: [i64; 3],
    pub(super) one_over_area: f32,
    pub(super) area: Rect,
}

impl Setup {
    pub(super) fn new([a, b, c]: [Place; 3], area: Rect) -> Self {
        let signed_area = signed_area([a, b, c]);
        let edge = |from: Place, to: Place| {
            let (from, to) = if signed_area > 0 { (from, to) } else { (to, from) };
            EdgeFunction::new(from.map(i64::from), to.map(i64::from))
        };
        let edges = [edge(b, c), edge(c, a), edge(a, b)];
        let shy = edges.map(|edge| i64::from(!edge.is_top_left()));
        Self { edges, shy, one_over_area: 1.0 / (signed_area.abs() as f32), area }
    }

    /// The least and the greatest value of an edge function at the centers of a rectangle, less what keeps a tie out.
    fn range(&self, i: usize, area: Rect) -> [i64; 2] {
        let corners = [
            (area.left, area.bottom),
            (area.right - 1, area.bottom),
            (area.left, area.top - 1),
            (area.right - 1, area.top - 1),
        ];
        let values = corners.map(|(x, y)| self.edges[i].at(center(x, y)) - self.shy[i]);
        [values.into_iter().fold(i64::MAX, i64::min), values.into_iter().fold(i64::MIN, i64::max)]
    }

    /// Whether all centers of a rectangle are covered.
    pub(super) fn covers(&self, area: Rect) -> bool {
        (0..3).all(|i| self.range(i, area)[0] >= 0)
    }

    /// Whether a rectangle lies wholly on the wrong side of an edge.
    pub(super) fn misses(&self, area: Rect) -> bool {
        (0..3).any(|i| self.range(i, area)[1] < 0)
    }

    /// Whether values near a rectangle have at most 40 bits.
    pub(super) fn is_split_exact(&self, area: Rect) -> bool {
        let near = Rect { right: area.right + LANES as i32, ..area };
        (0..3).all(|i| self.range(i, near).into_iter().all(|value| value.abs() < 1 << 39))
    }

    /// How the weights of the second and third vertex change per pixel.
    pub(super) fn gradients(&self, places: [Place; 3]) -> WeightGradients<Lanes> {
        let corners = places.map(|[x, y]| glam::dvec2(f64::from(x), f64::from(y)) / SUBPIXELS as f64);
        crate::varyings::weight_gradients(corners)
    }
}

/// Whether all values of a triangle's edge functions near it fit into 32 bits.
pub(super) fn is_narrow([a, b, c]: [Place; 3]) -> bool {
    let size = |axis: usize| {
        let (low, high) = (a[axis].min(b[axis]).min(c[axis]), a[axis].max(b[axis]).max(c[axis]));
        // Groups of eight begin up to seven pixels to the left, and end as many to the right.
        i64::from(high) - i64::from(low) + 16 * SUBPIXELS
    };
    size(0) * size(1) < 1 << 29
}

/// An edge function at eight neighboring centers from a point on, if its values fit into 32 bits.
pub(super) fn narrow_lanes(edge: &EdgeFunction, start: [i64; 2]) -> i32x8 {
    let step = (edge.step_x * SUBPIXELS) as i32;
    i32x8::splat(edge.at(start) as i32) + i32x8::splat(step) * i32x8::new([0, 1, 2, 3, 4, 5, 6, 7])
}

/// The edge functions along a row, eight centers at a time.
pub(super) trait Edges {
    /// The values at eight neighboring centers.
    type Group;

    /// The first group of a row.
    fn row(&self, y: i32) -> Self::Group;
    /// The next eight.
    fn step(&self, group: &mut Self::Group);
    /// Which of the eight are covered.
    fn covered(&self, group: &Self::Group) -> LaneMask;
    /// The values that belong to the second and the third vertex, each rounded once.
    fn values(group: &Self::Group) -> [Lanes; 2];
}

/// In 32-bit integers, for triangles that are not too large.
pub(super) struct Narrow<'a> {
    setup: &'a Setup,
    left: i32,
    steps: [i32x8; 3],
    shy: [i32x8; 3],
}

impl<'a> Narrow<'a> {
    pub(super) fn new(setup: &'a Setup, left: i32) -> Self {
        let step = |edge: EdgeFunction| i32x8::splat((edge.step_x * SUBPIXELS) as i32 * LANES as i32);
        let shy = setup.shy.map(|shy| i32x8::splat(shy as i32));
        Self { setup, left, steps: setup.edges.map(step), shy }
    }
}

impl Edges for Narrow<'_> {
    type Group = [i32x8; 3];

    #[inline(always)]
    fn row(&self, y: i32) -> [i32x8; 3] {
        from_fn(|i| narrow_lanes(&self.setup.edges[i], center(self.left, y)))
    }

    #[inline(always)]
    fn step(&self, group: &mut [i32x8; 3]) {
        *group = from_fn(|i| group[i] + self.steps[i]);
    }

    #[inline(always)]
    fn covered(&self, group: &[i32x8; 3]) -> LaneMask {
        let outside = (group[0] - self.shy[0]) | (group[1] - self.shy[1]) | (group[2] - self.shy[2]);
        LaneMask::of_signs(outside).not()
    }

    #[inline(always)]
    fn values(group: &[i32x8; 3]) -> [Lanes; 2] {
        [group[1].round_float(), group[2].round_float()]
    }
}

// ANCHOR: split
/// A whole number of up to 40 bits as the sum of two `f32` that are exact: a multiple of 2¹⁶, and the rest.
///
/// ```text
///    E = high · 2¹⁶ + low        high: up to 24 bits        low: 16 bits, and 20 after a tile's steps
/// ```
///
/// Both are stepped by additions that are exact; their sum is E, rounded once. Its sign is that of E.
#[derive(Clone, Copy)]
pub(super) struct Parts {
    high: Lanes,
    low: Lanes,
}

impl Parts {
    /// The numbers start, start + step, start + 2 · step, …
    fn stepping(start: i64, step: i64) -> Self {
        let number = Lanes::new([0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]);
        let (start, step) = (Self::same(start), Self::same(step));
        Self { high: start.high + step.high * number, low: start.low + step.low * number }
    }

    fn same(number: i64) -> Self {
        let (high, low) = (number >> 16, number & 0xFFFF);
        Self { high: Lanes::splat(high as f32 * 65_536.0), low: Lanes::splat(low as f32) }
    }
}
// ANCHOR_END: split

/// In [`Parts`]. With `INSIDE` all centers are known to be covered, and nothing is asked.
pub(super) struct Split<'a, const INSIDE: bool> {
    setup: &'a Setup,
    left: i32,
    steps: [Parts; 3],
    shy: [Lanes; 3],
}

impl<'a, const INSIDE: bool> Split<'a, INSIDE> {
    pub(super) fn new(setup: &'a Setup, left: i32) -> Self {
        let steps = setup.edges.map(|edge| Parts::same(edge.step_x * SUBPIXELS * LANES as i64));
        Self { setup, left, steps, shy: setup.shy.map(|shy| Lanes::splat(shy as f32)) }
    }
}

impl<const INSIDE: bool> Edges for Split<'_, INSIDE> {
    type Group = [Parts; 3];

    #[inline(always)]
    fn row(&self, y: i32) -> [Parts; 3] {
        self.setup.edges.map(|edge| Parts::stepping(edge.at(center(self.left, y)), edge.step_x * SUBPIXELS))
    }

    #[inline(always)]
    fn step(&self, group: &mut [Parts; 3]) {
        for (parts, step) in group.iter_mut().zip(&self.steps).skip(usize::from(INSIDE)) {
            *parts = Parts { high: parts.high + step.high, low: parts.low + step.low };
        }
    }

    #[inline(always)]
    fn covered(&self, group: &[Parts; 3]) -> LaneMask {
        if INSIDE {
            return LaneMask::all(true);
        }
        let is_inside =
            |i: usize| is_less_or_equal(Lanes::ZERO, group[i].high + (group[i].low - self.shy[i]));
        is_inside(0).and(is_inside(1)).and(is_inside(2))
    }

    #[inline(always)]
    fn values(group: &[Parts; 3]) -> [Lanes; 2] {
        [group[1].high + group[1].low, group[2].high + group[2].low]
    }
}

/// In 64-bit integers: for triangles of thousands of pixels on a side, seen from near their corners.
pub(super) struct Huge<'a> {
    pub(super) setup: &'a Setup,
    pub(super) left: i32,
}

impl Edges for Huge<'_> {
    type Group = [[i64; LANES]; 3];

    fn row(&self, y: i32) -> Self::Group {
        self.setup.edges.map(|edge| from_fn(|lane| edge.at(center(self.left + lane as i32, y))))
    }

    fn step(&self, group: &mut Self::Group) {
        for (values, edge) in group.iter_mut().zip(&self.setup.edges) {
            values.iter_mut().for_each(|value| *value += edge.step_x * SUBPIXELS * LANES as i64);
        }
    }

    fn covered(&self, group: &Self::Group) -> LaneMask {
        let is_covered = |lane: usize| (0..3).all(|i| group[i][lane] >= self.setup.shy[i]);
        LaneMask::of_bits((0..LANES).fold(0, |bits, lane| bits | i32::from(is_covered(lane)) << lane))
    }

    fn values(group: &Self::Group) -> [Lanes; 2] {
        [1, 2].map(|i| Lanes::new(group[i].map(|value| value as f32)))
    }
}
