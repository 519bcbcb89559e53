//! Beyond the book: eight numbers at a time.
//!
//! A formula that is generic over [`Real`] runs on eight `f32` with one instruction for each operation, the same
//! operations in the same order as on one. So eight fragments are shaded in the time of one, to the same colors.
//!
//! ```
//! use rasterbook::tiled::lanes::Lanes;
//! use rasterbook::light::lambert;
//! use rasterbook::real::Real;
//!
//! // Eight normals at once, leaning from upright to flat.
//! let y = Lanes::new([1.0, 0.9, 0.8, 0.7, 0.6, 0.4, 0.2, 0.0]);
//! let bright = lambert([Lanes::of(0.0), y, Lanes::of(0.0)], [0.0, 1.0, 0.0].map(Lanes::of));
//! assert_eq!(bright.to_array(), y.to_array());
//! ```

use std::array::from_fn;
use std::ops::{Add, Div, Mul, Neg, Sub};

use bytemuck::cast;
use wide::{CmpEq, CmpGt, CmpLe, CmpLt, f32x8, i32x8};

use crate::color::Color;
use crate::real::{Mask, Real, sealed};

/// How many numbers.
pub const LANES: usize = 8;

/// Eight numbers of single precision.
///
/// A type of our own around that of the crate `wide`, whose −x is 0 − x: of 0 that makes 0, and not −0 as of one number.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(transparent)]
pub struct Lanes(pub(super) f32x8);

impl Lanes {
    /// A number for each lane.
    #[must_use]
    #[inline(always)]
    pub const fn new(numbers: [f32; LANES]) -> Self {
        Self(f32x8::new(numbers))
    }

    /// The same number in all lanes.
    #[must_use]
    #[inline(always)]
    pub fn splat(number: f32) -> Self {
        Self(f32x8::splat(number))
    }

    /// The numbers of the lanes.
    #[must_use]
    #[inline(always)]
    pub fn to_array(self) -> [f32; LANES] {
        self.0.to_array()
    }
}

impl From<f32> for Lanes {
    #[inline(always)]
    fn from(number: f32) -> Self {
        Self::splat(number)
    }
}

macro_rules! operators {
    ($($operator:ident $function:ident),*) => {$(
        impl $operator for Lanes {
            type Output = Self;

            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                Self($operator::$function(self.0, other.0))
            }
        }
    )*};
}
operators!(Add add, Sub sub, Mul mul, Div div);

impl Neg for Lanes {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0 ^ f32x8::splat(-0.0))
    }
}

/// What a function gives for each lane. (`from_fn` and `map` of the standard library need not be inlined.)
#[inline(always)]
pub(super) fn each_lane<T>(of: impl Fn(usize) -> T) -> [T; LANES] {
    [of(0), of(1), of(2), of(3), of(4), of(5), of(6), of(7)]
}

/// Eight numbers in memory, where all processors can read and write them at once.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub(super) struct Block(pub(super) [f32; LANES]);

impl Block {
    pub(super) const ZERO: Self = Self([0.0; LANES]);
}

/// Yes for all of them, as bits.
pub(crate) const ALL: i32 = 0xFF;

/// Yes or no for each of eight numbers.
#[derive(Clone, Copy, Debug)]
pub struct LaneMask(f32x8);

impl sealed::Sealed for LaneMask {}

impl Mask for LaneMask {
    #[inline]
    fn all(answer: bool) -> Self {
        Self(f32x8::splat(f32::from_bits(if answer { u32::MAX } else { 0 })))
    }

    #[inline]
    fn and(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    #[inline]
    fn not(self) -> Self {
        Self(self.0 ^ Self::all(true).0)
    }
}

impl LaneMask {
    /// The lanes whose bit is set, the first lane in the lowest bit.
    #[inline]
    pub(crate) fn of_bits(bits: i32) -> Self {
        let bit = i32x8::new([1, 2, 4, 8, 16, 32, 64, 128]);
        Self(cast((i32x8::splat(bits) & bit).cmp_eq(bit)))
    }

    /// `yes` in the lanes of the mask, `no` in the others.
    #[inline]
    pub(crate) fn choose(self, yes: i32x8, no: i32x8) -> i32x8 {
        let mask: i32x8 = cast(self.0);
        mask.blend(yes, no)
    }

    /// A bit for each lane.
    #[inline]
    pub(crate) fn bits(self) -> i32 {
        self.0.move_mask()
    }
}

/// Comparisons of eight depths.
#[inline]
pub(crate) fn is_less_or_equal(a: Lanes, b: Lanes) -> LaneMask {
    LaneMask(a.0.cmp_le(b.0))
}

impl sealed::Sealed for Lanes {}

impl Real for Lanes {
    type Mask = LaneMask;
    /// Words 0x00RRGGBB.
    type Colors = i32x8;

    #[inline]
    fn of(value: f64) -> Self {
        Self::splat(value as f32)
    }

    #[inline]
    fn min(self, other: Self) -> Self {
        // Others disagree on NaN and on zeros of two signs; the instruction of x86 is this very comparison.
        if cfg!(target_feature = "sse") {
            Self(self.0.fast_min(other.0))
        } else {
            Self(self.0.cmp_lt(other.0).blend(self.0, other.0))
        }
    }

    #[inline]
    fn max(self, other: Self) -> Self {
        if cfg!(target_feature = "sse") {
            Self(self.0.fast_max(other.0))
        } else {
            Self(self.0.cmp_gt(other.0).blend(self.0, other.0))
        }
    }

    #[inline]
    fn floor(self) -> Self {
        const HAS_INSTRUCTION: bool = cfg!(any(
            target_feature = "sse4.1",
            target_feature = "simd128",
            all(target_feature = "neon", target_arch = "aarch64"),
        ));
        if HAS_INSTRUCTION {
            return Self(self.0.floor());
        }
        // Old instruction sets cannot round down: cut off, and take one away where that went up. Negative zero, which has
        // lost its sign, gets it back. From 2²³ on there are no fractions, and whole numbers need not fit.
        let number = self.0;
        let cut = number.fast_trunc_int().round_float();
        let floor = (cut - (cut.cmp_gt(number) & f32x8::ONE)) | (number & f32x8::splat(-0.0));
        Self(number.abs().cmp_lt(f32x8::splat(8_388_608.0)).blend(floor, number))
    }

    #[inline]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }

    #[inline]
    fn is_less(self, other: Self) -> LaneMask {
        LaneMask(self.0.cmp_lt(other.0))
    }

    #[inline]
    fn select(mask: LaneMask, yes: Self, no: Self) -> Self {
        Self(mask.0.blend(yes.0, no.0))
    }

    #[inline]
    fn map(self, function: impl Fn(f64) -> f64) -> Self {
        // `from_fn` is inlined, `map` of an array of eight is a call, with eight calls of the function in it.
        let numbers = self.to_array();
        Self::new(from_fn(|lane| function(f64::from(numbers[lane])) as f32))
    }

    #[inline]
    fn map_all<const N: usize, const M: usize>(
        values: [Self; N],
        function: impl Fn([f64; N]) -> [f64; M],
    ) -> [Self; M] {
        let values = values.map(Self::to_array);
        let results: [[f64; M]; LANES] = from_fn(|lane| function(values.map(|value| f64::from(value[lane]))));
        from_fn(|k| Self::new(from_fn(|lane| results[lane][k] as f32)))
    }

    #[inline]
    fn gather<const C: usize>(
        column: Self,
        row: Self,
        table: impl Fn(usize, usize) -> [f64; C],
    ) -> [Self; C] {
        let (columns, rows) = (column.to_array(), row.to_array());
        let records: [[f64; C]; LANES] = from_fn(|lane| table(columns[lane] as usize, rows[lane] as usize));
        from_fn(|k| Self::new(from_fn(|lane| records[lane][k] as f32)))
    }

    #[inline]
    fn gather_color(column: Self, row: Self, row_bits: u32, colors: &[Color]) -> i32x8 {
        let indices = (row.0.fast_trunc_int() << row_bits) + column.0.fast_trunc_int();
        // Two by two: half as many numbers leave the register, which keeps those parts of the processor busy that the
        // arithmetic needs.
        let pairs: [u64; LANES / 2] = cast(indices);
        let is_high = |lane: usize| (lane % 2 == 1) == cfg!(target_endian = "little");
        let index = |lane: usize| {
            let pair = pairs[lane / 2];
            if is_high(lane) { pair >> 32 } else { pair & 0xFFFF_FFFF }
        };
        i32x8::new(from_fn(|lane| colors[index(lane) as usize].bits() as i32))
    }

    #[inline]
    fn channels(words: i32x8) -> [Self; 3] {
        let byte = i32x8::splat(0xFF);
        [(words >> 16) & byte, (words >> 8) & byte, words & byte].map(|channel| Self(channel.round_float()))
    }
}

/// The words of eight colors, channels rounded to the nearest of 0..=255; NaN gives 0.
#[inline]
pub(crate) fn packed(color: [Lanes; 3]) -> i32x8 {
    let (zero, half, most) = (Lanes::splat(0.0), Lanes::splat(0.5), Lanes::splat(255.0));
    let [red, green, blue] = color.map(|channel| {
        let limited = Real::min(Real::max(channel + half, zero), most);
        limited.0.fast_trunc_int()
    });
    (red << 16) | (green << 8) | blue
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::merge::Rounding;
    use crate::tiled::instruction_set::{InstructionSet, MaskOf};
    use crate::tiled::instructions::with_each;

    const ODD: [f32; 8] = [-0.5, 0.0, 2.999_999, -3.0, 8_388_607.5, 1e30, -7.25, 254.5];
    const OTHER: [f32; 8] = [1.0, -2.0, 3.5, 0.25, -1e9, 1e-3, 7.0, 255.0];
    const ZEROS: [f32; 8] = [-0.0, 0.0, -0.0, 0.0, f32::NAN, 1.0, f32::NAN, -1e-40];
    const OTHER_ZEROS: [f32; 8] = [0.0, -0.0, -0.0, 0.0, -0.0, f32::NAN, f32::NAN, 1e-40];

    #[test]
    fn lanes_do_what_one_number_does() {
        for (a, b) in [(ODD, OTHER), (ZEROS, OTHER_ZEROS), (OTHER_ZEROS, ZEROS)] {
            with_each!(instructions => { lanes_do_what_each_does(instructions, a, b) });
        }
    }

    fn lanes_do_what_each_does<I: InstructionSet>(instructions: I, numbers: [f32; 8], others: [f32; 8]) {
        let (a, b) = (instructions.lanes(numbers), instructions.lanes(others));
        // There are many ways to write what is not a number.
        let bits = |number: f32| if number.is_nan() { f32::NAN.to_bits() } else { number.to_bits() };
        let check = |lanes: I::Lanes, one: fn(f32, f32) -> f32| {
            let expected: [u32; 8] = from_fn(|i| bits(one(numbers[i], others[i])));
            assert_eq!(instructions.numbers(lanes).map(bits), expected);
        };
        check(a + b, |a, b| a + b);
        check(a - b, |a, b| a - b);
        check(a * b, |a, b| a * b);
        check(a / b, |a, b| a / b);
        check(-a, |a, _| -a);
        check(-(a - I::Lanes::of(0.25)), |a, _| -(a - 0.25));
        check(Real::min(a, b), Real::min);
        check(Real::max(a, b), Real::max);
        check(Real::floor(a), |a, _| Real::floor(a));
        check(Real::floor(b), |_, b| Real::floor(b));
        check(Real::sqrt(b), |_, b| b.sqrt());
        check(Real::select(a.is_less(b), a, b), |a, b| if a < b { a } else { b });
        check(Real::select(instructions.is_less_or_equal(a, b), a, b), |a, b| if a <= b { a } else { b });
        check(Real::select(a.is_less(b).not(), a, b), |a, b| if a < b { b } else { a });
        check(Real::map(b, |v| v * 0.1), |_, b| Real::map(b, |v| v * 0.1));
        let both = |[a, b]: [f64; 2]| [a - b, a * 0.1];
        check(Real::map_all([a, b], both)[0], |a, b| Real::map_all([a, b], |[a, b]| [a - b])[0]);
        check(Real::map_all([a, b], both)[1], |a, _| Real::map_all([a], |[a]| [a * 0.1])[0]);
        let places = instructions.lanes([0.0, 1.5, 2.0, 3.0, 4.9, 5.0, 6.0, 7.0]);
        let record = |column: usize, row: usize| [column as f64 + 0.25, 10.0 * row as f64];
        let [columns, rows] = Real::gather(places, I::Lanes::of(3.0), record);
        assert_eq!(instructions.numbers(columns), [0.25, 1.25, 2.25, 3.25, 4.25, 5.25, 6.25, 7.25]);
        assert_eq!(instructions.numbers(rows), [30.0; 8]);
        let [_, rows] = Real::gather(I::Lanes::of(1.0), places, record);
        assert_eq!(instructions.numbers(rows), [0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0]);
        // What is the same in all lanes, on either side.
        for number in ZEROS {
            let same = I::Lanes::from(number);
            let check_same = |lanes: I::Lanes, one: fn(f32, f32) -> f32| {
                let expected: [u32; 8] = from_fn(|i| bits(one(number, others[i])));
                assert_eq!(instructions.numbers(lanes).map(bits), expected);
            };
            check_same(same - b, |a, b| a - b);
            check_same(I::Lanes::of(0.25) - same, |a, _| 0.25 - a);
            check_same(-same, |a, _| -a);
            check_same(b - same, |a, b| b - a);
            check_same(same / b, |a, b| a / b);
            check_same(Real::min(same, b), Real::min);
            check_same(Real::max(b, same), |a, b| Real::max(b, a));
            check_same(Real::select(b.is_less(same), same, b), |a, b| if b < a { a } else { b });
            check_same(Real::min(same, I::Lanes::of(0.0)), |a, _| Real::min(a, 0.0));
            check_same(Real::map_all([same, b], both)[0], |a, b| Real::map_all([a, b], |[a, b]| [a - b])[0]);
            check_same(Real::map_all([same, same], both)[1], |a, _| Real::map_all([a], |[a]| [a * 0.1])[0]);
        }
    }

    #[test]
    fn a_number_that_is_none_gives_way() {
        let nan = Lanes::of(f64::NAN);
        assert_eq!(Real::max(nan, Lanes::of(2.0)).to_array(), [2.0; 8]);
        assert_eq!(Real::min(nan, Lanes::of(2.0)).to_array(), [2.0; 8]);
    }

    #[test]
    fn masks() {
        with_each!(instructions => { check_masks(instructions) });
    }

    fn check_masks<I: InstructionSet>(instructions: I) {
        let mask = |bits| instructions.mask(bits);
        assert_eq!(instructions.bits(mask(0b1_1100)), 0b1_1100);
        let yes = instructions.words([1, 2, 0, 3, u32::MAX, 1 << 31, 7, 9]);
        let no = instructions.words([5; 8]);
        assert!(yes == instructions.words(instructions.word_array(yes)) && yes != no);
        let chosen = |mask| instructions.word_array(instructions.choose(mask, yes, no));
        assert_eq!(chosen(mask(0b110)), [5, 2, 0, 5, 5, 5, 5, 5]);
        assert_eq!(chosen(Mask::all(true)), instructions.word_array(yes));
        assert_eq!(chosen(Mask::all(false)), [5; 8]);
        let all = |answer| -> MaskOf<I> { Mask::all(answer) };
        assert_eq!(instructions.bits(all(true)), ALL);
        assert_eq!(instructions.bits(all(true).not()), 0);
        assert_eq!(
            [1, 3, 8, 9, 32, 128, 255].map(|count| instructions.lowest(count)),
            [1, 7, ALL, ALL, ALL, ALL, ALL]
        );
        let some = mask(0b1111);
        let both = |other| instructions.bits(some.and(other));
        assert_eq!([mask(0b1111_1000), all(true), all(false)].map(both), [0b1000, 0b1111, 0]);
        assert_eq!(instructions.bits(all(false).and(some)), 0);
        assert_eq!(
            instructions.signs([[-1.0, 1.0], [1.0, -0.0], [1.0, 1.0]].map(|[first, second]| {
                instructions.lanes([first, second, 1.0, 1.0, 1.0, 1.0, 1.0, first])
            })),
            0b1000_0011
        );
    }

    #[test]
    fn colors_to_words_and_back() {
        with_each!(instructions => { check_colors(instructions) });
    }

    fn check_colors<I: InstructionSet>(instructions: I) {
        let values = [-1.0, 0.0, 0.5, 127.49, 254.5, 255.0, 300.0, f32::NAN];
        let far = [f32::INFINITY, f32::NEG_INFINITY, 3e9, -3e9, 40_000.0, -40_000.0, 70_000.0, 128.5];
        for values in [values, far] {
            // Each of them as each channel.
            for turn in 0..3 {
                let mut color = [instructions.lanes(values), I::Lanes::of(10.0), I::Lanes::of(20.0)];
                color.rotate_right(turn);
                let words = instructions.word_array(instructions.packed(color));
                for (word, value) in words.into_iter().zip(values) {
                    let mut color = [value, 10.0, 20.0];
                    color.rotate_right(turn);
                    assert_eq!(Color::from_bits(word), Rounding::Nearest.color(color));
                }
            }
        }
        let [red, green, blue] = I::Lanes::channels(instructions.words([0x0010_2030; 8]));
        assert_eq!([red, green, blue].map(|lanes| instructions.numbers(lanes)[3]), [16.0, 32.0, 48.0]);
    }

    #[test]
    fn colors_are_looked_up() {
        with_each!(instructions => { check_look_up(instructions) });
    }

    fn check_look_up<I: InstructionSet>(instructions: I) {
        let colors: Vec<Color> = (0..8).map(|i| Color::rgb(i * 10, i, 255 - i)).collect();
        let columns = instructions.lanes([0.0, 1.0, 2.0, 0.0, 1.0, 2.0, 1.0, 0.0]);
        let rows = instructions.lanes([0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 0.0, 1.0]);
        let reds = |columns, rows| {
            let [red, ..] = I::Lanes::channels(I::Lanes::gather_color(columns, rows, 2, &colors));
            instructions.numbers(red)
        };
        assert_eq!(reds(columns, rows), [0.0, 10.0, 20.0, 40.0, 50.0, 60.0, 10.0, 40.0]);
        assert_eq!(reds(I::Lanes::of(1.0), rows), [10.0, 10.0, 10.0, 50.0, 50.0, 50.0, 10.0, 50.0]);
        assert_eq!(reds(I::Lanes::of(1.0), I::Lanes::of(1.0)), [50.0; 8]);
    }

    #[test]
    fn rows_become_columns() {
        with_each!(instructions => {
            let rows = from_fn(|row| Block(from_fn(|column| (row * 10 + column) as f32)));
            let columns = instructions.transposed(&rows).map(|column| instructions.numbers(column));
            assert_eq!(columns, from_fn(|row| from_fn(|column| (column * 10 + row) as f32)));
        });
    }
}
