//! Edge functions for eight pixels at a time: in as few bits as do, and always exact.

use std::array::from_fn;
use std::ops::Add;

use wide::i32x8;

use super::front::Place;
use super::{TILE_HEIGHT, TILE_WIDTH};
use crate::Rect;
use crate::edge::{Coverage, EdgeFunction, SUBPIXELS, center, is_top_left};
use crate::lanes::{LANES, LaneMask, Lanes, is_less_or_equal};
use crate::real::Mask;

/// The three edges of a triangle, each on the left of its inside, opposite to its vertex.
pub(super) struct Setup {
    pub(super) edges: [EdgeFunction; 3],
    /// What is taken off a value so that "not negative" means covered: 1 on edges that are neither top nor left.
    pub(super) shy: [i64; 3],
    pub(super) one_over_area: f32,
}

impl Setup {
    /// `None` without area.
    pub(super) fn new(places: [Place; 3]) -> Option<Self> {
        let Coverage { edges, twice_area, .. } = Coverage::of(places.map(|place| place.map(i64::from)))?;
        let shy = edges.map(|edge| edge.least());
        Some(Self { edges, shy, one_over_area: 1.0 / (twice_area as f32) })
    }

    /// The least and the greatest value of an edge function at the centers of a rectangle, less what keeps a tie out.
    fn range(&self, i: usize, area: Rect) -> [i64; 2] {
        let values = corners(area).map(|corner| self.edges[i].at(corner) - self.shy[i]);
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
}

/// The outermost centers of a rectangle: what changes evenly has its extremes there.
pub(super) fn corners(Rect { left, bottom, right, top }: Rect) -> [[i64; 2]; 4] {
    [(left, bottom), (right - 1, bottom), (left, top - 1), (right - 1, top - 1)].map(|(x, y)| center(x, y))
}

/// Whether all values of a triangle's edge functions near it fit into 32 bits.
///
/// A value is the difference of two products of a length along x and one along y. Each is less than 2³⁰, so the value is
/// less than 2³¹.
pub(super) fn is_narrow([a, b, c]: [Place; 3]) -> bool {
    let size = |axis: usize| {
        let (low, high) = (a[axis].min(b[axis]).min(c[axis]), a[axis].max(b[axis]).max(c[axis]));
        // Groups of eight begin up to seven pixels to the left, end as many to the right, and are stepped over by eight.
        i64::from(high) - i64::from(low) + 16 * SUBPIXELS
    };
    size(0) * size(1) < 1 << 30
}

// ANCHOR: narrow
/// The three edges of a triangle of up to some 110 × 110 pixels, in 32-bit integers.
pub(super) struct Narrow {
    /// The values at the first center.
    start: [i32; 3],
    /// How they change from pixel to pixel, to the right and upwards.
    right: [i32; 3],
    up: [i32; 3],
    /// As in [`Setup`].
    shy: [i32; 3],
    pub(super) one_over_area: f32,
}

impl Narrow {
    /// The edges, seen from the center of a pixel. Inlined, so that the places stay in registers.
    #[inline(always)]
    pub(super) fn new(places: [Place; 3], [x, y]: [i32; 2]) -> Self {
        const PIXEL: i32 = SUBPIXELS as i32;
        let [a, b, c] =
            places.map(|place| [place[0] - (x * PIXEL + PIXEL / 2), place[1] - (y * PIXEL + PIXEL / 2)]);
        let cross = |a: Place, b: Place| a[0] * b[1] - a[1] * b[0];
        // Seen from the origin, E is the cross product of the ends; the three of them make up the area.
        let start = [cross(b, c), cross(c, a), cross(a, b)];
        let area = start[0] + start[1] + start[2];
        let sign = area.signum();
        let edges = [[b, c], [c, a], [a, b]];
        let right = edges.map(|[from, to]| (from[1] - to[1]) * sign);
        let up = edges.map(|[from, to]| (to[0] - from[0]) * sign);
        Self {
            start: start.map(|value| value * sign),
            right: right.map(|step| step * PIXEL),
            up: up.map(|step| step * PIXEL),
            shy: from_fn(|i| i32::from(!is_top_left(right[i], up[i]))),
            one_over_area: 1.0 / (area.abs() as f32),
        }
    }

    /// How the functions change from the first to each of eight neighbors.
    #[inline]
    fn lanes(&self) -> [i32x8; 3] {
        let number = i32x8::new([0, 1, 2, 3, 4, 5, 6, 7]);
        self.right.map(|step| i32x8::splat(step) * number)
    }

    /// Calls `row` with the functions at the first eight centers of each row, less what keeps ties out.
    #[inline]
    fn rows(&self, count: usize, mut row: impl FnMut(usize, [i32x8; 3])) {
        let lanes = self.lanes();
        let mut values = from_fn(|i| i32x8::splat(self.start[i] - self.shy[i]) + lanes[i]);
        let up = self.up.map(i32x8::splat);
        for number in 0..count {
            row(number, values);
            values = from_fn(|i| values[i] + up[i]);
        }
    }

    /// Which pixels of an area of at most 8 × 8 are covered: a bit each, eight for a row. And how much the second and the
    /// third vertex weigh, in each row that the area has.
    #[inline]
    pub(super) fn covered(&self, area: Rect, weights: &mut [[Lanes; 2]; 8]) -> u64 {
        let columns = (1_u64 << area.columns().len()) - 1;
        let (shy, one_over_area) = (self.shy.map(i32x8::splat), Lanes::splat(self.one_over_area));
        let mut covered = 0;
        self.rows(area.rows().len(), |row, values| {
            covered |= (u64::from(covered_bits(values)) & columns) << (8 * row);
            // What keeps ties out does not belong to the value. (The remainder is for the compiler.)
            weights[row % 8][0] = (values[1] + shy[1]).round_float() * one_over_area;
            weights[row % 8][1] = (values[2] + shy[2]).round_float() * one_over_area;
        });
        covered
    }

    /// Which groups of eight are touched in an area of so many groups and rows: written to a list, from below. From a pixel
    /// to the one above it there are `stride`.
    pub(super) fn touched<'a>(
        &self,
        [groups, rows]: [usize; 2],
        stride: usize,
        list: &'a mut [Touch; GROUPS],
    ) -> &'a [Touch] {
        let right = self.right.map(|step| i32x8::splat(step * LANES as i32));
        let mut count = 0;
        self.rows(rows, |row, mut signs| {
            let [mut second, mut third] = self.values(0, row as i32);
            for group in 0..groups {
                let covered = i32::from(covered_bits(signs));
                // Always written, but counted only if there is something: no branch to be foreseen.
                list[count % GROUPS] =
                    Touch { place: row * stride + group * LANES, covered, values: [second, third] };
                count += usize::from(covered != 0);
                signs = from_fn(|i| signs[i] + right[i]);
                second += self.right[1] * LANES as i32;
                third += self.right[2] * LANES as i32;
            }
        });
        &list[..count]
    }

    /// The values that belong to the second and the third vertex, so many pixels to the right and above the first center.
    #[inline(always)]
    fn values(&self, column: i32, row: i32) -> [i32; 2] {
        [1, 2].map(|i| self.start[i] + self.right[i] * column + self.up[i] * row)
    }

    /// The values in a touched group, each rounded once.
    #[inline(always)]
    pub(super) fn group(&self, touch: &Touch) -> [Lanes; 2] {
        let [_, second, third] = self.lanes();
        let [to_second, to_third] = touch.values;
        [(i32x8::splat(to_second) + second).round_float(), (i32x8::splat(to_third) + third).round_float()]
    }
}

/// A bit for each of eight pixels: none of the three values says, by its sign, that it is outside.
#[inline(always)]
fn covered_bits(values: [i32x8; 3]) -> u8 {
    !(values[0] | values[1] | values[2]).move_mask() as u8
}
// ANCHOR_END: narrow

/// A group of eight pixels of which a triangle covers some.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Touch {
    /// Where it is: how many pixels after the first.
    pub(super) place: usize,
    /// A bit for each pixel.
    pub(super) covered: i32,
    /// The values that belong to the second and the third vertex at the first of the eight.
    values: [i32; 2],
}

/// How many groups a tile has.
pub(super) const GROUPS: usize = (TILE_HEIGHT * TILE_WIDTH) as usize / LANES;

/// The edge functions of larger triangles in an area, eight centers at a time: from the lowest row up, and in a row from
/// left to right.
pub(super) trait Edges {
    /// The values at eight neighboring centers.
    type Group: Copy;

    /// The first eight of the lowest row.
    fn first(&self) -> Self::Group;
    /// The same columns, a row higher.
    fn step_up(&self, group: &mut Self::Group);
    /// The next eight.
    fn step_right(&self, group: &mut Self::Group);
    /// Which of the eight are covered.
    fn covered(&self, group: &Self::Group) -> LaneMask;
    /// The values that belong to the second and the third vertex, each rounded once.
    fn values(group: &Self::Group) -> [Lanes; 2];
}

// ANCHOR: split
/// A whole number of up to 40 bits as the sum of two `f32` that are exact: a multiple of 2¹⁶, and the rest.
///
/// ```text
///    E = high · 2¹⁶ + low        high: up to 24 bits        low: 16 bits, and 22 after a tile's steps
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

impl Add for Parts {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { high: self.high + other.high, low: self.low + other.low }
    }
}

/// In [`Parts`]. With `INSIDE` all centers are known to be covered, and nothing is asked.
pub(super) struct Split<const INSIDE: bool> {
    first: [Parts; 3],
    right: [Parts; 3],
    up: [Parts; 3],
    shy: [Lanes; 3],
}

impl<const INSIDE: bool> Split<INSIDE> {
    /// The edges of a triangle in an area.
    pub(super) fn new(setup: &Setup, area: Rect) -> Self {
        let start = center(area.left, area.bottom);
        Self {
            first: setup.edges.map(|edge| Parts::stepping(edge.at(start), edge.step_x * SUBPIXELS)),
            right: setup.edges.map(|edge| Parts::same(edge.step_x * SUBPIXELS * LANES as i64)),
            up: setup.edges.map(|edge| Parts::same(edge.step_y * SUBPIXELS)),
            shy: setup.shy.map(|shy| Lanes::splat(shy as f32)),
        }
    }
}

impl<const INSIDE: bool> Edges for Split<INSIDE> {
    type Group = [Parts; 3];

    #[inline(always)]
    fn first(&self) -> [Parts; 3] {
        self.first
    }

    #[inline(always)]
    fn step_up(&self, group: &mut [Parts; 3]) {
        *group = from_fn(|i| group[i] + self.up[i]);
    }

    #[inline(always)]
    fn step_right(&self, group: &mut [Parts; 3]) {
        *group = from_fn(|i| group[i] + self.right[i]);
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
    pub(super) area: Rect,
}

impl Huge<'_> {
    /// Adds a step to each edge function.
    fn step(&self, group: &mut <Self as Edges>::Group, step: impl Fn(&EdgeFunction) -> i64) {
        for (values, edge) in group.iter_mut().zip(&self.setup.edges) {
            values.iter_mut().for_each(|value| *value += step(edge) * SUBPIXELS);
        }
    }
}

impl Edges for Huge<'_> {
    type Group = [[i64; LANES]; 3];

    fn first(&self) -> Self::Group {
        let Rect { left, bottom, .. } = self.area;
        self.setup.edges.map(|edge| from_fn(|lane| edge.at(center(left + lane as i32, bottom))))
    }

    fn step_up(&self, group: &mut Self::Group) {
        self.step(group, |edge| edge.step_y);
    }

    fn step_right(&self, group: &mut Self::Group) {
        self.step(group, |edge| edge.step_x * LANES as i64);
    }

    fn covered(&self, group: &Self::Group) -> LaneMask {
        let is_covered = |lane: usize| (0..3).all(|i| group[i][lane] >= self.setup.shy[i]);
        LaneMask::of_bits((0..LANES).fold(0, |bits, lane| bits | i32::from(is_covered(lane)) << lane))
    }

    fn values(group: &Self::Group) -> [Lanes; 2] {
        [1, 2].map(|i| Lanes::new(group[i].map(|value| value as f32)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tiled::front::bounding_box;
    use crate::tiled::tile::{size_in_groups, whole_groups};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_largest_narrow_triangles_are_exact(
            width in 8.0..850.0_f64,
            corners in prop::array::uniform3((0.0..1.0, 0.0..1.0)),
            is_as_large_as_may_be in any::<bool>(),
            // Half pixels: edges run through centers.
            grid in prop_oneof![Just(1), Just(128)],
            origin in [-9000..20_000, -9000..20_000],
            which in any::<[prop::sample::Index; 2]>(),
        ) {
            // The longest box of this width, or nearly: places may move by half a pixel.
            let [width, height] = [width, 16_384.0 / (width + 16.5) - 16.5].map(|side| side * SUBPIXELS as f64);
            let [mut a, mut b, mut c] = corners;
            if is_as_large_as_may_be {
                (a.0, b.0, b.1, c.1) = (0.0, 1.0, 0.0, 1.0);
            }
            let places = [a, b, c].map(|(x, y)| [(x * width) as i32 + origin[0], (y * height) as i32 + origin[1]])
                .map(|place| place.map(|c| c / grid * grid));
            prop_assert!(is_narrow(places));
            let Some(coverage) = Coverage::of(places.map(|place| place.map(i64::from))) else { return Ok(()) };

            // What of it lies in one of its tiles, in whole groups.
            let corner = |axis: usize, length: f64, side: i32| {
                let ends = [origin[axis], origin[axis] + length as i32].map(|place: i32| (place >> 8).max(0) / side);
                (ends[0] + which[axis].index((ends[1] - ends[0]) as usize + 1) as i32) * side
            };
            let (left, bottom) = (corner(0, width, TILE_WIDTH), corner(1, height, TILE_HEIGHT));
            let tile = Rect { left, bottom, right: left + TILE_WIDTH, top: bottom + TILE_HEIGHT };
            let Some(area) = bounding_box(places, tile) else { return Ok(()) };
            let area = whole_groups(area);
            let size = size_in_groups(area);

            let mut list = [Touch::default(); GROUPS];
            let narrow = Narrow::new(places, [area.left, area.bottom]);
            let stride = size[0] * LANES;
            let touched = narrow.touched(size, stride, &mut list);
            for place in (0..stride * size[1]).step_by(LANES) {
                let (x, y) = (area.left + (place % stride) as i32, area.bottom + (place / stride) as i32);
                let values: [_; LANES] = from_fn(|lane| coverage.edge_values(center(x + lane as i32, y)));
                let covered = values.iter().rev().fold(0, |bits, &here| bits << 1 | i32::from(coverage.covers(here)));
                let touch = touched.iter().find(|touch| touch.place == place);
                prop_assert_eq!(touch.map_or(0, |touch| touch.covered), covered);
                if let Some(touch) = touch {
                    let expected = [1, 2].map(|i| values.map(|values| values[i] as f32));
                    prop_assert_eq!(narrow.group(touch).map(Lanes::to_array), expected);
                }
            }
        }
    }
}
