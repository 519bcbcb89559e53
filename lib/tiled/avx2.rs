//! AVX2, where a program that is compiled for any processor finds it: by the crate `fearless_simd`, in safe code.
//!
//! Its numbers carry the proof that the processor has these instructions ([`Avx2`], which takes no room). A constant,
//! [`Real::of`], has no proof to carry. So a value is one number until it meets eight. Which of the two it is the compiler
//! knows once everything is inlined: nothing of it is left in the program.

use std::arch::x86_64::{
    _bzhi_u32, _mm_cvtsi64_si128, _mm_setr_epi8, _mm256_and_pd, _mm256_and_si256,
    _mm256_broadcastsi128_si256, _mm256_castps_si256, _mm256_cvtepi32_ps, _mm256_cvtepu8_epi32,
    _mm256_movemask_ps, _mm256_or_pd, _mm256_or_ps, _mm256_packs_epi32, _mm256_packus_epi16,
    _mm256_permute2f128_ps, _mm256_set1_epi32, _mm256_set1_pd, _mm256_setzero_si256, _mm256_shuffle_epi8,
    _mm256_shuffle_ps, _mm256_srli_epi32, _mm256_sub_epi32, _mm256_unpackhi_ps, _mm256_unpacklo_ps,
    _mm256_xor_pd,
};
use std::array::from_fn;
use std::ops::{Add, Div, Mul, Neg, Sub};

use bytemuck::cast;
pub(super) use fearless_simd::Avx2;
use fearless_simd::{Level, Simd, SimdInto, SimdMask, f32x8, f64x4, i32x8, kernel, mask32x8, mask64x4};

use super::instruction_set::{Four, InstructionSet};
use super::lanes::{ALL, Block, LANES};
use crate::color::Color;
use crate::real::{Mask, Real, sealed};

/// The proof that this processor has AVX2, if it has.
pub(super) fn avx2() -> Option<Avx2> {
    Level::new().as_avx2()
}

// ANCHOR: one_or_eight
/// Eight values, or one that stands for eight equal ones.
#[derive(Clone, Copy, Debug)]
pub(super) enum OneOrEight<One, Eight> {
    One(One),
    Eight(Eight),
}

use OneOrEight::{Eight, One};

type Numbers = OneOrEight<f32, f32x8<Avx2>>;
type Answers = OneOrEight<bool, mask32x8<Avx2>>;
/// 0x00RRGGBB.
type Words = OneOrEight<u32, i32x8<Avx2>>;

/// Does something with one number and another one, or with eight and eight.
macro_rules! with_both {
    ($a:expr, $b:expr, $one:expr, $eight:ident) => {
        match ($a, $b) {
            (One(a), One(b)) => One($one(a, b)),
            (One(a), Eight(b)) => Eight(b.simd.$eight(b.simd.splat_f32x8(a), b)),
            (Eight(a), One(b)) => Eight(a.simd.$eight(a, a.simd.splat_f32x8(b))),
            (Eight(a), Eight(b)) => Eight(a.simd.$eight(a, b)),
        }
    };
}

/// An operator of two numbers.
macro_rules! operator {
    ($trait:ident, $method:ident, $eight:ident) => {
        impl $trait for Numbers {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                with_both!(self, other, $trait::$method, $eight)
            }
        }
    };
}

operator!(Add, add, add_f32x8);
operator!(Sub, sub, sub_f32x8);
operator!(Mul, mul, mul_f32x8);
operator!(Div, div, div_f32x8);
// ANCHOR_END: one_or_eight

impl Neg for Numbers {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        match self {
            One(number) => One(-number),
            Eight(numbers) => Eight(numbers.simd.neg_f32x8(numbers)),
        }
    }
}

impl From<f32> for Numbers {
    #[inline(always)]
    fn from(number: f32) -> Self {
        One(number)
    }
}

impl Numbers {
    #[inline(always)]
    fn eight(self, avx2: Avx2) -> f32x8<Avx2> {
        match self {
            One(number) => avx2.splat_f32x8(number),
            Eight(numbers) => numbers,
        }
    }

    #[inline(always)]
    fn to_array(self) -> [f32; LANES] {
        match self {
            One(number) => [number; LANES],
            Eight(numbers) => numbers.into(),
        }
    }

    #[inline(always)]
    fn proof(self) -> Option<Avx2> {
        match self {
            One(_) => None,
            Eight(numbers) => Some(numbers.simd),
        }
    }
}

impl Words {
    #[inline(always)]
    fn eight(self, avx2: Avx2) -> i32x8<Avx2> {
        match self {
            One(word) => avx2.splat_i32x8(word.cast_signed()),
            Eight(words) => words,
        }
    }

    #[inline(always)]
    fn to_array(self) -> [u32; LANES] {
        match self {
            One(word) => [word; LANES],
            Eight(words) => cast::<[i32; LANES], _>(words.into()),
        }
    }
}

impl PartialEq for Words {
    fn eq(&self, other: &Self) -> bool {
        self.to_array() == other.to_array()
    }
}

/// What a function gives for each lane. (That of the standard library need not be inlined.)
#[inline(always)]
fn each_lane<T>(of: impl Fn(usize) -> T) -> [T; LANES] {
    [of(0), of(1), of(2), of(3), of(4), of(5), of(6), of(7)]
}

impl sealed::Sealed for Answers {}

impl Mask for Answers {
    #[inline(always)]
    fn all(answer: bool) -> Self {
        One(answer)
    }

    #[inline(always)]
    fn and(self, other: Self) -> Self {
        match (self, other) {
            (Eight(a), Eight(b)) => Eight(a.witness().and_mask32x8(a, b)),
            (One(true), answers) | (answers, One(true)) => answers,
            (One(false), _) | (_, One(false)) => One(false),
        }
    }

    #[inline(always)]
    fn not(self) -> Self {
        match self {
            One(answer) => One(!answer),
            Eight(answers) => Eight(answers.witness().not_mask32x8(answers)),
        }
    }
}

impl sealed::Sealed for Numbers {}

impl Real for Numbers {
    type Mask = Answers;
    type Colors = Words;

    #[inline(always)]
    fn of(value: f64) -> Self {
        One(value as f32)
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // The instruction is this very comparison, NaN and zeros included, as for one number.
        with_both!(self, other, <f32 as Real>::min, min_f32x8)
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        with_both!(self, other, <f32 as Real>::max, max_f32x8)
    }

    #[inline(always)]
    fn floor(self) -> Self {
        match self {
            One(number) => One(number.floor()),
            Eight(numbers) => Eight(numbers.simd.floor_f32x8(numbers)),
        }
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        match self {
            One(number) => One(number.sqrt()),
            Eight(numbers) => Eight(numbers.simd.sqrt_f32x8(numbers)),
        }
    }

    #[inline(always)]
    fn is_less(self, other: Self) -> Answers {
        with_both!(self, other, <f32 as Real>::is_less, simd_lt_f32x8)
    }

    #[inline(always)]
    fn select(mask: Answers, yes: Self, no: Self) -> Self {
        match mask {
            One(true) => yes,
            One(false) => no,
            Eight(answers) => {
                let avx2 = answers.witness();
                Eight(avx2.select_f32x8(answers, yes.eight(avx2), no.eight(avx2)))
            }
        }
    }

    #[inline(always)]
    fn map(self, function: impl Fn(f64) -> f64) -> Self {
        match self {
            One(number) => One(function(f64::from(number)) as f32),
            Eight(numbers) => {
                let (avx2, numbers) = (numbers.simd, self.to_array());
                let numbers = each_lane(
                    #[inline(always)]
                    |lane| function(f64::from(numbers[lane])) as f32,
                );
                Eight(numbers.simd_into(avx2))
            }
        }
    }

    #[inline(always)]
    fn map_all<const N: usize, const M: usize>(
        values: [Self; N],
        function: impl Fn([f64; N]) -> [f64; M],
    ) -> [Self; M] {
        let numbers = values.map(Self::to_array);
        let result = |lane: usize| function(from_fn(|k| f64::from(numbers[k][lane])));
        match values.into_iter().find_map(Self::proof) {
            None => result(0).map(Self::of),
            Some(avx2) => {
                let results = each_lane(result);
                from_fn(|k| Eight(each_lane(|lane| results[lane][k] as f32).simd_into(avx2)))
            }
        }
    }

    #[inline(always)]
    fn gather<const C: usize>(
        column: Self,
        row: Self,
        table: impl Fn(usize, usize) -> [f64; C],
    ) -> [Self; C] {
        Self::map_all([column, row], |[column, row]| table(column as usize, row as usize))
    }

    #[inline(always)]
    fn gather_color(column: Self, row: Self, row_bits: u32, colors: &[Color]) -> Words {
        let Some(avx2) = column.proof().or(row.proof()) else {
            let [column, row] = [column, row].map(|index| index.to_array()[0]);
            return One(f32::gather_color(column, row, row_bits, colors).bits());
        };
        let [column, row] = [column.eight(avx2), row.eight(avx2)];
        let rows = avx2.shl_i32x8(avx2.cvt_i32_f32x8(row), row_bits);
        let indices = avx2.add_i32x8(rows, avx2.cvt_i32_f32x8(column));
        // Two by two, as for the baseline.
        let pairs: [u64; LANES / 2] = cast::<[i32; LANES], _>(indices.into());
        let words = each_lane(
            #[inline(always)]
            |lane| {
                let index = pairs[lane / 2] >> (lane % 2 * 32) & 0xFFFF_FFFF;
                colors[index as usize].bits().cast_signed()
            },
        );
        Eight(words.simd_into(avx2))
    }

    #[inline(always)]
    fn channels(words: Words) -> [Self; 3] {
        match words {
            One(word) => f32::channels(Color::from_bits(word)).map(One),
            Eight(words) => {
                let avx2 = words.simd;
                [low_byte(avx2.shr_i32x8(words, 16)), low_byte(avx2.shr_i32x8(words, 8)), low_byte(words)]
            }
        }
    }
}

kernel!(
    /// As [`wide::f32x8::transpose`] does it: pairs, fours, halves.
    #[inline(always)]
    fn transposed(avx2: Avx2, rows: [f32x8<Avx2>; LANES]) -> [Numbers; LANES] {
        let [a, b, c, d, e, f, g, h] = rows;
        let (a, b, c, d, e, f, g, h) =
            (a.into(), b.into(), c.into(), d.into(), e.into(), f.into(), g.into(), h.into());
        // Of each pair the first and third numbers of each half, and the others.
        let (ab, ab_more) = (_mm256_unpacklo_ps(a, b), _mm256_unpackhi_ps(a, b));
        let (cd, cd_more) = (_mm256_unpacklo_ps(c, d), _mm256_unpackhi_ps(c, d));
        let (ef, ef_more) = (_mm256_unpacklo_ps(e, f), _mm256_unpackhi_ps(e, f));
        let (gh, gh_more) = (_mm256_unpacklo_ps(g, h), _mm256_unpackhi_ps(g, h));
        // Of four.
        const LOW: i32 = 0b01_00_01_00;
        const HIGH: i32 = 0b11_10_11_10;
        let low = [
            _mm256_shuffle_ps::<LOW>(ab, cd),
            _mm256_shuffle_ps::<HIGH>(ab, cd),
            _mm256_shuffle_ps::<LOW>(ab_more, cd_more),
            _mm256_shuffle_ps::<HIGH>(ab_more, cd_more),
        ];
        let high = [
            _mm256_shuffle_ps::<LOW>(ef, gh),
            _mm256_shuffle_ps::<HIGH>(ef, gh),
            _mm256_shuffle_ps::<LOW>(ef_more, gh_more),
            _mm256_shuffle_ps::<HIGH>(ef_more, gh_more),
        ];
        // The halves of all eight.
        [
            Eight(_mm256_permute2f128_ps::<0x20>(low[0], high[0]).simd_into(avx2)),
            Eight(_mm256_permute2f128_ps::<0x20>(low[1], high[1]).simd_into(avx2)),
            Eight(_mm256_permute2f128_ps::<0x20>(low[2], high[2]).simd_into(avx2)),
            Eight(_mm256_permute2f128_ps::<0x20>(low[3], high[3]).simd_into(avx2)),
            Eight(_mm256_permute2f128_ps::<0x31>(low[0], high[0]).simd_into(avx2)),
            Eight(_mm256_permute2f128_ps::<0x31>(low[1], high[1]).simd_into(avx2)),
            Eight(_mm256_permute2f128_ps::<0x31>(low[2], high[2]).simd_into(avx2)),
            Eight(_mm256_permute2f128_ps::<0x31>(low[3], high[3]).simd_into(avx2)),
        ]
    }
);

impl InstructionSet for Avx2 {
    const ONLY_PLAIN: bool = true;
    type Lanes = Numbers;
    type Four = f64x4<Self>;

    #[inline(always)]
    fn run<R>(self, work: impl FnOnce() -> R) -> R {
        self.vectorize(work)
    }

    #[inline(always)]
    fn lanes(self, numbers: [f32; LANES]) -> Numbers {
        Eight(numbers.simd_into(self))
    }

    #[inline(always)]
    fn splat(self, number: f32) -> Numbers {
        Eight(self.splat_f32x8(number))
    }

    #[inline(always)]
    fn numbers(self, lanes: Numbers) -> [f32; LANES] {
        lanes.to_array()
    }

    #[inline(always)]
    fn transposed(self, rows: &[Block; LANES]) -> [Numbers; LANES] {
        transposed(
            self,
            each_lane(
                #[inline(always)]
                |row| rows[row].0.simd_into(self),
            ),
        )
    }

    #[inline(always)]
    fn signs(self, [a, b, c]: [Numbers; 3]) -> u8 {
        let [a, b, c] = [a.eight(self), b.eight(self), c.eight(self)];
        signs(self, a, b, c)
    }

    #[inline(always)]
    fn is_less_or_equal(self, a: Numbers, b: Numbers) -> Answers {
        Eight(self.simd_le_f32x8(a.eight(self), b.eight(self)))
    }

    #[inline(always)]
    fn mask(self, bits: i32) -> Answers {
        Eight(self.from_bitmask_mask32x8(bits as u64))
    }

    #[inline(always)]
    fn bits(self, mask: Answers) -> i32 {
        match mask {
            One(answer) => {
                if answer {
                    ALL
                } else {
                    0
                }
            }
            Eight(answers) => self.to_bitmask_mask32x8(answers) as i32,
        }
    }

    #[inline(always)]
    fn lowest(self, count: i32) -> i32 {
        lowest(self, count)
    }

    #[inline(always)]
    fn packed(self, [red, green, blue]: [Numbers; 3]) -> Words {
        let [red, green, blue] = [channel(self, red), channel(self, green), channel(self, blue)];
        Eight(narrowed(self, red, green, blue))
    }

    #[inline(always)]
    fn words(self, words: [u32; LANES]) -> Words {
        Eight(cast::<_, [i32; LANES]>(words).simd_into(self))
    }

    #[inline(always)]
    fn word_array(self, words: Words) -> [u32; LANES] {
        words.to_array()
    }

    #[inline(always)]
    fn choose(self, mask: Answers, yes: Words, no: Words) -> Words {
        match mask {
            One(true) => yes,
            One(false) => no,
            Eight(mask) => Eight(self.select_i32x8(mask, yes.eight(self), no.eight(self))),
        }
    }

    #[inline(always)]
    fn lowest_bits(self, bytes: u64) -> ([i32; LANES], Numbers) {
        let numbers = lowest_bits(self, bytes);
        (numbers.into(), Eight(self.cvt_f32_i32x8(numbers)))
    }

    #[inline(always)]
    fn four(self, numbers: [f64; 4]) -> f64x4<Self> {
        numbers.simd_into(self)
    }

    #[inline(always)]
    fn four_of(self, number: f64) -> f64x4<Self> {
        self.splat_f64x4(number)
    }
}

/// The lowest byte of each word, as a number.
#[inline(always)]
fn low_byte(words: i32x8<Avx2>) -> Numbers {
    let avx2 = words.simd;
    Eight(avx2.cvt_f32_i32x8(avx2.and_i32x8(words, avx2.splat_i32x8(0xFF))))
}

/// A channel, rounded to the nearest whole number up to 255; far below zero or not a number, the least there is.
#[inline(always)]
fn channel(avx2: Avx2, channel: Numbers) -> i32x8<Avx2> {
    // In this order: what is not a number stays so.
    let limited = One(255.0).min(channel + One(0.5));
    avx2.cvt_i32_f32x8(limited.eight(avx2))
}

kernel!(
    /// Words of three channels each, of which what is negative counts as 0.
    ///
    /// Narrowed twice with that limit, within each half of the registers: first the four blues, greens and reds of it, then
    /// in the order of pixels.
    #[inline(always)]
    fn narrowed(avx2: Avx2, red: i32x8<Avx2>, green: i32x8<Avx2>, blue: i32x8<Avx2>) -> i32x8<Avx2> {
        let (red, green, blue) = (red.into(), green.into(), blue.into());
        let bytes = _mm256_packus_epi16(_mm256_packs_epi32(blue, green), _mm256_packs_epi32(red, red));
        let zero = -1;
        let pixels = _mm_setr_epi8(0, 4, 8, zero, 1, 5, 9, zero, 2, 6, 10, zero, 3, 7, 11, zero);
        _mm256_shuffle_epi8(bytes, _mm256_broadcastsi128_si256(pixels)).simd_into(avx2)
    }
);

kernel!(
    #[inline(always)]
    fn lowest(_avx2: Avx2, count: i32) -> i32 {
        _bzhi_u32(ALL as u32, count as u32) as i32
    }
);

kernel!(
    #[inline(always)]
    fn signs(avx2: Avx2, a: f32x8<Avx2>, b: f32x8<Avx2>, c: f32x8<Avx2>) -> u8 {
        let any = _mm256_or_ps(_mm256_or_ps(a.into(), b.into()), c.into());
        _mm256_movemask_ps(any) as u8
    }
);

kernel!(
    #[inline(always)]
    fn lowest_bits(avx2: Avx2, bytes: u64) -> i32x8<Avx2> {
        let bytes = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(bytes.cast_signed()));
        // The exponent of a power of two is the number of its bit.
        let lowest = _mm256_and_si256(bytes, _mm256_sub_epi32(_mm256_setzero_si256(), bytes));
        let exponents = _mm256_srli_epi32::<23>(_mm256_castps_si256(_mm256_cvtepi32_ps(lowest)));
        _mm256_sub_epi32(exponents, _mm256_set1_epi32(127)).simd_into(avx2)
    }
);

impl Four for f64x4<Avx2> {
    type Mask = mask64x4<Avx2>;

    #[inline(always)]
    fn to_array(self) -> [f64; 4] {
        self.into()
    }

    #[inline(always)]
    fn abs(self) -> Self {
        self.simd.abs_f64x4(self)
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.simd.min_f64x4(self, other)
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.simd.max_f64x4(self, other)
    }

    #[inline(always)]
    fn or(self, other: Self) -> Self {
        or(self.simd, self, other)
    }

    #[inline(always)]
    fn flip_signs(self, signs: Self) -> Self {
        flip_signs(self.simd, self, signs)
    }

    #[inline(always)]
    fn is_equal(self, other: Self) -> Self::Mask {
        self.simd.simd_eq_f64x4(self, other)
    }

    #[inline(always)]
    fn is_less(self, other: Self) -> Self::Mask {
        self.simd.simd_lt_f64x4(self, other)
    }

    #[inline(always)]
    fn is_less_or_equal(self, other: Self) -> Self::Mask {
        self.simd.simd_le_f64x4(self, other)
    }

    #[inline(always)]
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self {
        yes.simd.select_f64x4(mask, yes, no)
    }
}

kernel!(
    #[inline(always)]
    fn or(avx2: Avx2, a: f64x4<Avx2>, b: f64x4<Avx2>) -> f64x4<Avx2> {
        _mm256_or_pd(a.into(), b.into()).simd_into(avx2)
    }
);

kernel!(
    #[inline(always)]
    fn flip_signs(avx2: Avx2, numbers: f64x4<Avx2>, signs: f64x4<Avx2>) -> f64x4<Avx2> {
        let signs = _mm256_and_pd(signs.into(), _mm256_set1_pd(-0.0));
        _mm256_xor_pd(numbers.into(), signs).simd_into(avx2)
    }
);
