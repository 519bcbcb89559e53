//! Which pixels of a tile a triangle covers, and how much its vertices weigh there: always exact.

use std::array::from_fn;
use std::ops::Range;

use bytemuck::cast;
use wide::{CmpEq, CmpGt, CmpLt, f64x4, i16x8, i32x8};

use super::bands::TILE_HEIGHT;
use super::lanes::{LANES, Lanes};
use super::snapped::{NO_FRACTIONS, SnappedPosition};
use crate::exact::edge::{SUBPIXELS, is_top_left};
use crate::rect::{Pixel, Rect};

const PIXEL: i32 = SUBPIXELS as i32;

/// The cross product of two positions, seen from the origin: the edge function there of the edge between them.
#[inline(always)]
fn cross<T: Copy + std::ops::Mul<Output = T> + std::ops::Sub<Output = T>>(a: [T; 2], b: [T; 2]) -> T {
    a[0] * b[1] - a[1] * b[0]
}

// ANCHOR: spans
/// The three edges of a triangle, each opposite to its vertex, as lines that bound its rows. (The fourth lane is empty.)
///
/// ```text
///    ○ ○╲● ● ● ●╱○        With E the edge function, less what keeps a tie out, and d its change from a pixel to the
///    ○ ○ ╲● ● ●╱○ ○       next, E + d · x ≥ 0 holds
///    ○ ○ ○╲● ●╱○ ○ ○          from x = ⌈−E/d⌉ = ⌊(|d| − ½ − E) / |d|⌋ on         where it grows,
///    ○ ○ ○ ╲●╱○ ○ ○ ○         for x < ⌊E/|d|⌋ + 1 = ⌊(|d| + ½ + E) / |d|⌋        where it falls.
/// ```
///
/// All numbers are whole, or halves, and have at most 53 bits: exact in `f64`. E and d are whole, so that a quotient with
/// the half in it is never nearer to a whole number than 1/2d. So it may be a product with 1/d, which is rounded: for all
/// columns that a picture has the error is smaller.
pub(super) struct TriangleSetup {
    /// The edge functions at the center of the pixel (0, 0), and how they change to the right and upwards.
    origin: f64x4,
    right: f64x4,
    up: f64x4,
    /// The numerator of the quotient in row 0, and how it changes upwards.
    above: f64x4,
    above_up: f64x4,
    one_over_step: f64x4,
    /// Added to the quotient: 0, or what makes it no bound at all, for the first column and for the one after the last.
    no_first: f64x4,
    no_end: f64x4,
    pub(super) one_over_area: f32,
}

impl TriangleSetup {
    pub(super) fn new(positions: [SnappedPosition; 3]) -> Self {
        // Without change to the right a row is covered, or it is not: a bound far to the right of all, or to the left.
        const FAR: f64 = 1e6;
        let (zero, half, one, infinity) = (f64x4::ZERO, f64x4::HALF, f64x4::ONE, f64x4::splat(f64::INFINITY));
        // From the vertices b, c, a to c, a, b.
        let [a, b, c] = positions.map(|position| position.map(|along| f64::from(along - PIXEL / 2)));
        let [from, to] = [[b, c, a], [c, a, b]]
            .map(|[i, j, k]| [0, 1].map(|axis| f64x4::new([i[axis], j[axis], k[axis], 0.0])));
        let origin = cross(from, to);
        let [i, j, k, _] = origin.to_array();
        let area = i + j + k;
        // Seen so that the triangle is on the left of each.
        let (sign, pixel) = (f64x4::splat(area.signum()), f64x4::splat(f64::from(PIXEL) * area.signum()));
        let (origin, right, up) = (origin * sign, (from[1] - to[1]) * pixel, (to[0] - from[0]) * pixel);
        // A whole number has one zero only, which is positive.
        let (origin, right) = (origin + zero, right + zero);

        let (grows, is_level, step) = (right.cmp_gt(zero), right.cmp_eq(zero), right.abs());
        let is_top_left = grows | (is_level & up.cmp_lt(zero));
        let value = origin + is_top_left.blend(half, -half);
        Self {
            above: step + grows.blend(-value, value),
            above_up: grows.blend(-up, up),
            one_over_step: is_level.blend(f64x4::splat(FAR), one / step),
            no_first: grows.blend(zero, -infinity),
            no_end: grows.blend(infinity, zero),
            origin,
            right,
            up,
            one_over_area: 1.0 / (area.abs() as f32),
        }
    }

    /// How much more the second and the third vertex weigh one pixel farther to the right.
    #[inline]
    pub(super) fn weight_step(&self) -> [f32; 2] {
        [1, 2].map(|i| self.right.as_array_ref()[i] as f32 * self.one_over_area)
    }
}

const ROWS: usize = TILE_HEIGHT as usize;
/// So many rows are computed at a time.
const AT_A_TIME: usize = 4;

/// The covered pixels of some rows: in each row they lie side by side.
pub(super) struct Spans {
    /// The first covered column, of the whole picture.
    first: [i32; ROWS],
    /// The one after the last.
    end: [i32; ROWS],
    /// How much the second and the third vertex weigh in the first covered column.
    weights: [[f32; ROWS]; 2],
}

impl Spans {
    pub(super) const NONE: Self = Self { first: [0; ROWS], end: [0; ROWS], weights: [[0.0; ROWS]; 2] };

    /// Finds them in some rows, of which there are no more than a tile has, in a picture of so many columns.
    pub(super) fn find(&mut self, setup: &TriangleSetup, rows: Range<i32>, columns: i32) {
        let number = f64x4::new([0.0, 1.0, 2.0, 3.0]) + f64x4::splat(f64::from(rows.start));
        let of_edge = |numbers: &f64x4, i: usize| f64x4::splat(numbers.as_array_ref()[i]);
        let [mut above, mut values] = [(&setup.above, &setup.above_up), (&setup.origin, &setup.up)]
            .map(|(origin, up)| [0, 1, 2].map(|i| of_edge(origin, i) + of_edge(up, i) * number));
        let [next_above, next_value] =
            [setup.above_up, setup.up].map(|up| up * f64x4::splat(AT_A_TIME as f64));
        let leftmost = f64x4::HALF;
        let rightmost = f64x4::splat(f64::from(columns) + 0.5);
        for row in (0..rows.len()).step_by(AT_A_TIME) {
            let (mut first, mut end) = (leftmost, rightmost);
            for (i, above) in above.iter_mut().enumerate() {
                let column = *above * of_edge(&setup.one_over_step, i);
                first = first.fast_max(column + of_edge(&setup.no_first, i));
                end = end.fast_min(column + of_edge(&setup.no_end, i));
                *above += of_edge(&next_above, i);
            }
            let first = whole_below(first.fast_min(rightmost), &mut self.first[row..]);
            whole_below(end.fast_max(leftmost), &mut self.end[row..]);
            for i in [1, 2] {
                let value = (values[i] + of_edge(&setup.right, i) * first).to_array();
                for (weight, value) in self.weights[i - 1][row..].iter_mut().zip(value) {
                    *weight = value as f32 * setup.one_over_area;
                }
                values[i] += of_edge(&next_value, i);
            }
        }
    }

    /// The first covered column of a row; which of some columns are covered; and the weights in the first.
    #[inline(always)]
    pub(super) fn row(&self, row: usize, columns: &Range<i32>) -> (i32, Range<i32>, [f32; 2]) {
        let first = self.first[row];
        let covered = first.max(columns.start)..self.end[row].min(columns.end);
        (first, covered, [self.weights[0][row], self.weights[1][row]])
    }
}

/// Rounds numbers down that are between 0 and 2³¹ and not whole.
#[inline(always)]
fn whole_below(numbers: f64x4, list: &mut [i32]) -> f64x4 {
    // To the nearest of what is half less. The last bits of the sum are the whole number.
    let sum = (numbers - f64x4::HALF) + f64x4::splat(NO_FRACTIONS);
    for (whole, sum) in list.iter_mut().zip(sum.to_array()) {
        *whole = sum.to_bits() as i32;
    }
    sum - f64x4::splat(NO_FRACTIONS)
}
// ANCHOR_END: spans

// ANCHOR: small
/// How wide and high a small triangle is at most: then its coverage fits into 64 bits.
pub(super) const SMALL_SIDE: usize = 8;

/// The three edges of a small triangle.
///
/// Edge functions and their steps are whole, and less than 2²⁴ in 8 × 8 pixels of which the first lies in the triangle's
/// box, though rows of the box may be missing below: 2302 · (2047 + 3839) at most. So they are exact in `f32`.
pub(super) struct SmallTriangleSetup {
    /// The edge functions at the first center.
    start: [f32; 3],
    /// How they change from pixel to pixel, to the right and upwards.
    right: [f32; 3],
    up: [f32; 3],
    /// What keeps a tie out: 1 on edges that are neither top nor left.
    fill_rule_bias: [f32; 3],
    one_over_area: f32,
}

/// Steps from the first of eight pixels, as factors.
pub(super) const STEPS: [f32; LANES] = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];

impl SmallTriangleSetup {
    /// The edges, seen from the center of a pixel. Inlined, so that the positions stay in registers.
    #[inline(always)]
    pub(super) fn new(positions: [SnappedPosition; 3], (x, y): Pixel) -> Self {
        let [a, b, c] = positions
            .map(|position| [position[0] - (x * PIXEL + PIXEL / 2), position[1] - (y * PIXEL + PIXEL / 2)]);
        // The three of them make up the area.
        let start = [cross(b, c), cross(c, a), cross(a, b)];
        let area = start[0] + start[1] + start[2];
        let sign = area.signum();
        let edges = [[b, c], [c, a], [a, b]];
        let right = edges.map(|[from, to]| (from[1] - to[1]) * sign);
        let up = edges.map(|[from, to]| (to[0] - from[0]) * sign);
        Self {
            start: start.map(|value| (value * sign) as f32),
            right: right.map(|step| (step * PIXEL) as f32),
            up: up.map(|step| (step * PIXEL) as f32),
            fill_rule_bias: from_fn(|i| f32::from(u8::from(!is_top_left(right[i], up[i])))),
            one_over_area: 1.0 / (area.abs() as f32),
        }
    }

    /// How much more the second and the third vertex weigh one pixel farther to the right.
    #[inline(always)]
    pub(super) fn weight_step(&self) -> [f32; 2] {
        [1, 2].map(|i| self.right[i] * self.one_over_area)
    }

    /// Which pixels of an area are covered: a bit each, eight for a row.
    #[inline(always)]
    pub(super) fn covered(&self, area: Rect) -> u64 {
        let columns = (1_u64 << area.columns().len()) - 1;
        // A zero is positive here: the first summand is never −0, and then no sum is.
        let mut values: [Lanes; 3] = from_fn(|i| {
            Lanes::splat(self.start[i] - self.fill_rule_bias[i])
                + Lanes::splat(self.right[i]) * Lanes::new(STEPS)
        });
        let mut covered = 0;
        for y in 0..area.rows().len() {
            // None of the three values says, by its sign, that the pixel is outside.
            let outside = (values[0] | values[1] | values[2]).move_mask() as u8;
            covered |= (u64::from(!outside) & columns) << (SMALL_SIDE * y);
            values = from_fn(|i| values[i] + Lanes::splat(self.up[i]));
        }
        covered
    }

    /// The first covered column of each row, and how much the second and the third vertex weigh there. In rows without any
    /// what is answered means nothing.
    #[inline(always)]
    pub(super) fn starts(&self, covered: u64) -> ([i32; SMALL_SIDE], [[f32; SMALL_SIDE]; 2]) {
        let rows = i16x8::from_u8x16_low(cast([covered.to_le(), 0]));
        // The exponent of a power of two is the number of its bit.
        let lowest: Lanes = i32x8::from_i16x8(rows & -rows).round_float();
        let columns: i32x8 = (cast::<Lanes, i32x8>(lowest) >> 23) - i32x8::splat(127);
        let weights = [1, 2].map(|i| {
            let [start, right, up] = [self.start, self.right, self.up].map(|edges| Lanes::splat(edges[i]));
            let value = start + right * columns.round_float() + up * Lanes::new(STEPS);
            (value * Lanes::splat(self.one_over_area)).to_array()
        });
        (columns.to_array(), weights)
    }
}
// ANCHOR_END: small

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::edge::{Coverage, center};
    use crate::tiled::snapped::{box_of, is_at_most, shared};
    use proptest::prelude::*;

    const COLUMNS: i32 = 20_000;

    /// Corners in a square of some size, here or there, on a coarse grid or a fine one; some as thin as can be.
    fn triangle() -> impl Strategy<Value = [SnappedPosition; 3]> {
        let corners = prop::array::uniform3((0.0..1.0, 0.0..1.0));
        let size = prop_oneof![Just(3.0), Just(30.0), Just(3000.0), Just(90_000.0)];
        // Half pixels: edges run through centers.
        let grid = prop_oneof![Just(1), Just(128)];
        let origin = [-40_000..40_000, -40_000..40_000];
        (corners, size, grid, origin, any::<bool>()).prop_map(
            |(corners, size, grid, [left, bottom], is_thin)| {
                let most = |along: i32| along.clamp(-1 << 24, 1 << 24) / grid * grid;
                let coordinate = |share: f64, origin: i32| most(origin * 8 + (share * size * 256.0) as i32);
                let mut positions = corners.map(|(x, y)| [coordinate(x, left), coordinate(y, bottom)]);
                if is_thin {
                    positions[2] =
                        [0, 1].map(|axis| (positions[0][axis] + positions[1][axis]) / 2 + axis as i32);
                }
                positions
            },
        )
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 2000, ..ProptestConfig::default() })]

        #[test]
        fn spans_are_exact(positions in triangle(), which in any::<prop::sample::Index>()) {
            let Some(coverage) = Coverage::of(positions.map(|position| position.map(i64::from))) else { return Ok(()) };
            let picture = Rect { left: 0, bottom: 0, right: COLUMNS, top: 100_000 };
            let Some(area) = shared(box_of(positions), picture) else { return Ok(()) };
            let bottom = area.bottom + which.index(area.rows().len()) as i32;
            let rows = bottom..area.top.min(bottom + TILE_HEIGHT);

            let setup = TriangleSetup::new(positions);
            let mut spans = Spans::NONE;
            spans.find(&setup, rows.clone(), COLUMNS);
            let bits = |weights: [f32; 2]| weights.map(f32::to_bits);
            prop_assert_eq!(bits(setup.weight_step()), bits(coverage.weight_step()));
            for (row, y) in rows.enumerate() {
                let expected = coverage.covered_columns(0..COLUMNS, y);
                let (first, covered, weights) = spans.row(row, &(0..COLUMNS));
                prop_assert_eq!(covered.is_empty(), expected.is_empty());
                if !covered.is_empty() {
                    prop_assert_eq!(&covered, &expected);
                    prop_assert_eq!(first, covered.start);
                    let expected = coverage.weights(coverage.edge_values(center(first, y)));
                    prop_assert_eq!(bits(weights), bits(expected));
                }
            }
        }

        #[test]
        fn small_triangles_are_exact(
            positions in prop::array::uniform3([0..2304, 0..2304]),
            origin in -3..900,
            grid in prop_oneof![Just(1), Just(128)],
            below in 0..8_i32,
        ) {
            let positions = positions.map(|position| position.map(|along| (origin * 256 + along) / grid * grid));
            let Some(coverage) = Coverage::of(positions.map(|position| position.map(i64::from))) else { return Ok(()) };
            let whole = box_of(positions);
            prop_assume!(is_at_most(whole, SMALL_SIDE as i32));
            // Rows may be missing below, which belong to another tile.
            let picture = Rect { bottom: i32::max(whole.bottom + below, 0), ..Rect::sized(2000, 2000) };
            let Some(area) = shared(whole, picture) else { return Ok(()) };
            let small = SmallTriangleSetup::new(positions, (area.left, area.bottom));
            let bits_of = |weights: [f32; 2]| weights.map(f32::to_bits);
            prop_assert_eq!(bits_of(small.weight_step()), bits_of(coverage.weight_step()));
            let covered = small.covered(area);
            let (columns, weights) = small.starts(covered);
            for (row, y) in area.rows().enumerate() {
                let expected = coverage.covered_columns(area.columns(), y);
                let bits = expected.clone().fold(0, |bits, x| bits | 1_u64 << (x - area.left));
                prop_assert_eq!(covered >> (8 * row) & 0xFF, bits);
                if !expected.is_empty() {
                    let expected_weights = coverage.weights::<f32>(coverage.edge_values(center(expected.start, y)));
                    prop_assert_eq!(columns[row], expected.start - area.left);
                    prop_assert_eq!(bits_of(weights.map(|weights| weights[row])), bits_of(expected_weights));
                }
            }
        }
    }
}
