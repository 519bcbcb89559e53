//! Which pixels of a tile a triangle covers, and how much its vertices weigh there: always exact.

use std::ops::Range;

use super::bands::TILE_HEIGHT;
use super::instruction_set::{Four, InstructionSet};
use super::lanes::LANES;
use super::snapped::{NO_FRACTIONS, SnappedPosition};
use crate::exact::edge::{SUBPIXELS, is_top_left};
use crate::real::{each, map3};
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
    origin: [f64; 4],
    right: [f64; 4],
    up: [f64; 4],
    /// The numerator of the quotient in row 0, and how it changes upwards.
    above: [f64; 4],
    above_up: [f64; 4],
    one_over_step: [f64; 4],
    /// Added to the quotient: 0, or what makes it no bound at all, for the first column and for the one after the last.
    no_first: [f64; 4],
    no_end: [f64; 4],
    pub(super) one_over_area: f32,
}

impl TriangleSetup {
    #[inline(always)]
    pub(super) fn new<I: InstructionSet>(instructions: I, positions: [SnappedPosition; 3]) -> Self {
        // Without change to the right a row is covered, or it is not: a bound far to the right of all, or to the left.
        const FAR: f64 = 1e6;
        let (zero, half, one) =
            (instructions.four_of(0.0), instructions.four_of(0.5), instructions.four_of(1.0));
        let infinity = instructions.four_of(f64::INFINITY);
        // From the vertices b, c, a to c, a, b.
        let [[ax, ay], [bx, by], [cx, cy]] =
            positions.map(|position| position.map(|along| f64::from(along - PIXEL / 2)));
        let from = [instructions.four([bx, cx, ax, 0.0]), instructions.four([by, cy, ay, 0.0])];
        let to = [instructions.four([cx, ax, bx, 0.0]), instructions.four([cy, ay, by, 0.0])];
        let origin = cross(from, to);
        let [i, j, k, _] = origin.to_array();
        let area = i + j + k;
        // Seen so that the triangle is on the left of each.
        let sign = instructions.four_of(area.signum());
        let pixel = instructions.four_of(f64::from(PIXEL) * area.signum());
        let (origin, right, up) = (origin * sign, (from[1] - to[1]) * pixel, (to[0] - from[0]) * pixel);
        // A whole number has one zero only, which is positive.
        let (origin, right) = (origin + zero, right + zero);

        let (grows, is_level, step) = (zero.is_less(right), right.is_equal(zero), right.abs());
        let is_top_left = grows | (is_level & up.is_less(zero));
        let value = origin + I::Four::select(is_top_left, half, -half);
        Self {
            above: (step + I::Four::select(grows, -value, value)).to_array(),
            above_up: I::Four::select(grows, -up, up).to_array(),
            one_over_step: I::Four::select(is_level, instructions.four_of(FAR), one / step).to_array(),
            no_first: I::Four::select(grows, zero, -infinity).to_array(),
            no_end: I::Four::select(grows, infinity, zero).to_array(),
            origin: origin.to_array(),
            right: right.to_array(),
            up: up.to_array(),
            one_over_area: 1.0 / (area.abs() as f32),
        }
    }

    /// How much more the second and the third vertex weigh one pixel farther to the right.
    #[inline]
    pub(super) fn weight_step(&self) -> [f32; 2] {
        [1, 2].map(|i| self.right[i] as f32 * self.one_over_area)
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
    #[inline(always)]
    pub(super) fn find<I: InstructionSet>(
        &mut self,
        instructions: I,
        setup: &TriangleSetup,
        rows: Range<i32>,
        columns: i32,
    ) {
        // (A closure would not be inlined for sure.)
        macro_rules! four {
            ($number:expr) => {
                instructions.four_of($number)
            };
        }
        let number = instructions.four([0.0, 1.0, 2.0, 3.0]) + four!(f64::from(rows.start));
        let [mut above, mut values] = [[number; 3]; 2];
        for i in 0..3 {
            above[i] = four!(setup.above[i]) + four!(setup.above_up[i]) * number;
            values[i] = four!(setup.origin[i]) + four!(setup.up[i]) * number;
        }
        let leftmost = four!(0.5);
        let rightmost = four!(f64::from(columns) + 0.5);
        for row in (0..rows.len()).step_by(AT_A_TIME) {
            let (mut first, mut end) = (leftmost, rightmost);
            for (i, above) in above.iter_mut().enumerate() {
                let column = *above * four!(setup.one_over_step[i]);
                first = first.max(column + four!(setup.no_first[i]));
                end = end.min(column + four!(setup.no_end[i]));
                *above = *above + four!(setup.above_up[i] * AT_A_TIME as f64);
            }
            let first = whole_below(instructions, first.min(rightmost), &mut self.first[row..]);
            whole_below(instructions, end.max(leftmost), &mut self.end[row..]);
            for i in [1, 2] {
                let value = (values[i] + four!(setup.right[i]) * first).to_array();
                for (weight, value) in self.weights[i - 1][row..].iter_mut().zip(value) {
                    *weight = value as f32 * setup.one_over_area;
                }
                values[i] = values[i] + four!(setup.up[i] * AT_A_TIME as f64);
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
fn whole_below<I: InstructionSet>(instructions: I, numbers: I::Four, list: &mut [i32]) -> I::Four {
    // To the nearest of what is half less. The last bits of the sum are the whole number.
    let no_fractions = instructions.four_of(NO_FRACTIONS);
    let sum = (numbers - instructions.four_of(0.5)) + no_fractions;
    for (whole, sum) in list.iter_mut().zip(sum.to_array()) {
        *whole = sum.to_bits() as i32;
    }
    sum - no_fractions
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
        let right = map3(edges, |[from, to]| (from[1] - to[1]) * sign);
        let up = map3(edges, |[from, to]| (to[0] - from[0]) * sign);
        Self {
            start: map3(start, |value| (value * sign) as f32),
            right: map3(right, |step| (step * PIXEL) as f32),
            up: map3(up, |step| (step * PIXEL) as f32),
            fill_rule_bias: map3([0, 1, 2], |i| f32::from(u8::from(!is_top_left(right[i], up[i])))),
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
    pub(super) fn covered<I: InstructionSet>(&self, instructions: I, area: Rect) -> u64 {
        let columns = (1_u64 << area.columns().len()) - 1;
        // A zero is positive here: the first summand is never −0, and then no sum is.
        let mut values = [instructions.lanes(STEPS); 3];
        for (i, value) in values.iter_mut().enumerate() {
            let start = instructions.splat(self.start[i] - self.fill_rule_bias[i]);
            *value = start + instructions.splat(self.right[i]) * *value;
        }
        let mut covered = 0;
        for y in 0..area.rows().len() {
            // None of the three values says, by its sign, that the pixel is outside.
            let outside = instructions.signs(values);
            covered |= (u64::from(!outside) & columns) << (SMALL_SIDE * y);
            values = each(
                values,
                #[inline(always)]
                |i, value| value + instructions.splat(self.up[i]),
            );
        }
        covered
    }

    /// The first covered column of each row, and how much the second and the third vertex weigh there. In rows without any
    /// what is answered means nothing.
    #[inline(always)]
    pub(super) fn starts<I: InstructionSet>(
        &self,
        instructions: I,
        covered: u64,
    ) -> ([i32; SMALL_SIDE], [[f32; SMALL_SIDE]; 2]) {
        let (columns, column) = instructions.lowest_bits(covered);
        let weights = each(
            [instructions.lanes(STEPS); 2],
            #[inline(always)]
            |i, row| {
                let [start, right, up] = [self.start[i + 1], self.right[i + 1], self.up[i + 1]];
                let value = instructions.splat(start) + instructions.splat(right) * column;
                (value + instructions.splat(up) * row) * instructions.splat(self.one_over_area)
            },
        );
        (columns, [instructions.numbers(weights[0]), instructions.numbers(weights[1])])
    }
}
// ANCHOR_END: small

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::edge::{Coverage, center};
    use crate::tiled::instructions::with_each;
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

            let bits = |weights: [f32; 2]| weights.map(f32::to_bits);
            with_each!(instructions => {
                let setup = TriangleSetup::new(instructions, positions);
                let mut spans = Spans::NONE;
                spans.find(instructions, &setup, rows.clone(), COLUMNS);
                prop_assert_eq!(bits(setup.weight_step()), bits(coverage.weight_step()));
                for (row, y) in rows.clone().enumerate() {
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
            });
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
            with_each!(instructions => {
                let covered = small.covered(instructions, area);
                let (columns, weights) = small.starts(instructions, covered);
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
            });
        }
    }
}
