//! AVX2, where a program that is compiled for any processor finds it: by the crate `fearless_simd`, in safe code.
//!
//! Its numbers carry the proof that the processor has these instructions ([`Avx2`], which takes no room). A constant,
//! [`Real::of`], has no proof to carry. So a value is one number until it meets eight. Which of the two it is the compiler
//! knows once everything is inlined: nothing of it is left in the program.

use std::arch::x86_64::{
    _CMP_LE_OQ, _CMP_LT_OQ, _bzhi_u32, _mm_cvtsi32_si128, _mm_cvtsi64_si128, _mm_setr_epi8, _mm256_add_epi32,
    _mm256_add_ps, _mm256_and_pd, _mm256_and_si256, _mm256_blendv_epi8, _mm256_blendv_ps,
    _mm256_broadcastsi128_si256, _mm256_castps_si256, _mm256_castsi256_ps, _mm256_cmp_ps, _mm256_cmpeq_epi32,
    _mm256_cvtepi32_ps, _mm256_cvtepu8_epi32, _mm256_cvttps_epi32, _mm256_div_ps, _mm256_floor_ps,
    _mm256_max_ps, _mm256_min_ps, _mm256_movemask_ps, _mm256_mul_ps, _mm256_or_pd, _mm256_or_ps,
    _mm256_packs_epi32, _mm256_packus_epi16, _mm256_permute2f128_ps, _mm256_set1_epi32, _mm256_set1_pd,
    _mm256_set1_ps, _mm256_setr_epi32, _mm256_setzero_si256, _mm256_shuffle_epi8, _mm256_shuffle_ps,
    _mm256_sll_epi32, _mm256_sqrt_ps, _mm256_srl_epi32, _mm256_srli_epi32, _mm256_sub_epi32, _mm256_sub_ps,
    _mm256_unpackhi_ps, _mm256_unpacklo_ps, _mm256_xor_pd, _mm256_xor_ps, _mm256_xor_si256,
};
use std::array::from_fn;
use std::ops::{Add, Div, Mul, Neg, Sub};

use bytemuck::cast;
pub(super) use fearless_simd::Avx2;
use fearless_simd::{Level, Simd, SimdFrom, SimdMask, f32x8, f64x4, i32x8, kernel, mask32x8, mask64x4};

use super::instruction_set::{Four, InstructionSet};
use super::lanes::{ALL, Block, LANES, each_lane};
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
            (One(a), Eight(b)) => Eight($eight(b.simd, splat(b.simd, a), b)),
            (Eight(a), One(b)) => Eight($eight(a.simd, a, splat(a.simd, b))),
            (Eight(a), Eight(b)) => Eight($eight(a.simd, a, b)),
        }
    };
}

/// An operator of two numbers.
macro_rules! operator {
    ($trait:ident, $method:ident) => {
        impl $trait for Numbers {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                with_both!(self, other, $trait::$method, $method)
            }
        }
    };
}

operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);
// ANCHOR_END: one_or_eight

impl Neg for Numbers {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        match self {
            One(number) => One(-number),
            Eight(numbers) => Eight(neg(numbers.simd, numbers)),
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
            One(number) => splat(avx2, number),
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
            One(word) => splat_word(avx2, word),
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

impl sealed::Sealed for Answers {}

impl Mask for Answers {
    #[inline(always)]
    fn all(answer: bool) -> Self {
        One(answer)
    }

    #[inline(always)]
    fn and(self, other: Self) -> Self {
        match (self, other) {
            (Eight(a), Eight(b)) => Eight(and(a.witness(), a, b)),
            (One(true), answers) | (answers, One(true)) => answers,
            (One(false), _) | (_, One(false)) => One(false),
        }
    }

    #[inline(always)]
    fn not(self) -> Self {
        match self {
            One(answer) => One(!answer),
            Eight(answers) => Eight(not(answers.witness(), answers)),
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
        with_both!(self, other, <f32 as Real>::min, min)
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        with_both!(self, other, <f32 as Real>::max, max)
    }

    #[inline(always)]
    fn floor(self) -> Self {
        match self {
            One(number) => One(number.floor()),
            Eight(numbers) => Eight(floor(numbers.simd, numbers)),
        }
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        match self {
            One(number) => One(number.sqrt()),
            Eight(numbers) => Eight(sqrt(numbers.simd, numbers)),
        }
    }

    #[inline(always)]
    fn is_less(self, other: Self) -> Answers {
        with_both!(self, other, <f32 as Real>::is_less, is_less)
    }

    #[inline(always)]
    fn select(mask: Answers, yes: Self, no: Self) -> Self {
        match mask {
            One(true) => yes,
            One(false) => no,
            Eight(answers) => {
                let avx2 = answers.witness();
                Eight(select(avx2, answers, yes.eight(avx2), no.eight(avx2)))
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
                Eight(SimdFrom::simd_from(avx2, numbers))
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
            None => Self::array_of(result(0)),
            Some(avx2) => {
                let results = each_lane(result);
                from_fn(|k| Eight(SimdFrom::simd_from(avx2, each_lane(|lane| results[lane][k] as f32))))
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
        let rows = shifted_left(avx2, whole(avx2, row), row_bits);
        let indices = add_words(avx2, rows, whole(avx2, column));
        // Two by two, as for the baseline.
        let pairs: [u64; LANES / 2] = cast::<[i32; LANES], _>(indices.into());
        let words = each_lane(
            #[inline(always)]
            |lane| {
                let index = pairs[lane / 2] >> (lane % 2 * 32) & 0xFFFF_FFFF;
                colors[index as usize].bits().cast_signed()
            },
        );
        Eight(SimdFrom::simd_from(avx2, words))
    }

    #[inline(always)]
    fn channels(words: Words) -> [Self; 3] {
        match words {
            One(word) => f32::channels(Color::from_bits(word)).map(One),
            Eight(words) => {
                let avx2 = words.simd;
                [Eight(byte(avx2, words, 16)), Eight(byte(avx2, words, 8)), Eight(byte(avx2, words, 0))]
            }
        }
    }
}

/// Functions of eight values, each of one instruction or a few.
///
/// The crate has most of them as methods. But these call a function, `simd_into`, that need not be inlined, and without
/// link-time optimisation, as in the dev profile, it is not: `tiled` took twice as long.
macro_rules! instructions {
    ($($(#[$attribute:meta])* fn $name:ident($($argument:ident: $type:ty),*) -> $result:ty = $vector:expr;)*) => {$(
        kernel!(
            $(#[$attribute])*
            #[inline(always)]
            fn $name(avx2: Avx2, $($argument: $type),*) -> $result {
                SimdFrom::simd_from(avx2, $vector)
            }
        );
    )*};
}

instructions! {
    fn splat(number: f32) -> f32x8<Avx2> = _mm256_set1_ps(number);
    fn add(a: f32x8<Avx2>, b: f32x8<Avx2>) -> f32x8<Avx2> = _mm256_add_ps(a.into(), b.into());
    fn sub(a: f32x8<Avx2>, b: f32x8<Avx2>) -> f32x8<Avx2> = _mm256_sub_ps(a.into(), b.into());
    fn mul(a: f32x8<Avx2>, b: f32x8<Avx2>) -> f32x8<Avx2> = _mm256_mul_ps(a.into(), b.into());
    fn div(a: f32x8<Avx2>, b: f32x8<Avx2>) -> f32x8<Avx2> = _mm256_div_ps(a.into(), b.into());
    fn neg(a: f32x8<Avx2>) -> f32x8<Avx2> = _mm256_xor_ps(a.into(), _mm256_set1_ps(-0.0));
    fn min(a: f32x8<Avx2>, b: f32x8<Avx2>) -> f32x8<Avx2> = _mm256_min_ps(a.into(), b.into());
    fn max(a: f32x8<Avx2>, b: f32x8<Avx2>) -> f32x8<Avx2> = _mm256_max_ps(a.into(), b.into());
    fn floor(a: f32x8<Avx2>) -> f32x8<Avx2> = _mm256_floor_ps(a.into());
    fn sqrt(a: f32x8<Avx2>) -> f32x8<Avx2> = _mm256_sqrt_ps(a.into());
    fn whole(a: f32x8<Avx2>) -> i32x8<Avx2> = _mm256_cvttps_epi32(a.into());

    fn is_less(a: f32x8<Avx2>, b: f32x8<Avx2>) -> mask32x8<Avx2>
        = _mm256_castps_si256(_mm256_cmp_ps::<_CMP_LT_OQ>(a.into(), b.into()));
    fn is_less_or_equal(a: f32x8<Avx2>, b: f32x8<Avx2>) -> mask32x8<Avx2>
        = _mm256_castps_si256(_mm256_cmp_ps::<_CMP_LE_OQ>(a.into(), b.into()));
    fn and(a: mask32x8<Avx2>, b: mask32x8<Avx2>) -> mask32x8<Avx2> = _mm256_and_si256(a.into(), b.into());
    fn not(a: mask32x8<Avx2>) -> mask32x8<Avx2> = _mm256_xor_si256(a.into(), _mm256_set1_epi32(-1));
    fn mask(bits: i32) -> mask32x8<Avx2> = {
        let bit_of_lane = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
        _mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32(bits), bit_of_lane), bit_of_lane)
    };
    fn select(mask: mask32x8<Avx2>, yes: f32x8<Avx2>, no: f32x8<Avx2>) -> f32x8<Avx2>
        = _mm256_blendv_ps(no.into(), yes.into(), _mm256_castsi256_ps(mask.into()));
    fn select_words(mask: mask32x8<Avx2>, yes: i32x8<Avx2>, no: i32x8<Avx2>) -> i32x8<Avx2>
        = _mm256_blendv_epi8(no.into(), yes.into(), mask.into());

    fn splat_word(word: u32) -> i32x8<Avx2> = _mm256_set1_epi32(word.cast_signed());
    fn numbers_of(words: i32x8<Avx2>) -> f32x8<Avx2> = _mm256_cvtepi32_ps(words.into());
    fn shifted_left(words: i32x8<Avx2>, by: u32) -> i32x8<Avx2>
        = _mm256_sll_epi32(words.into(), _mm_cvtsi32_si128(by.cast_signed()));
    /// The byte from this bit on.
    fn byte(words: i32x8<Avx2>, bit: u32) -> f32x8<Avx2>
        = _mm256_cvtepi32_ps(_mm256_and_si256(
            _mm256_srl_epi32(words.into(), _mm_cvtsi32_si128(bit.cast_signed())),
            _mm256_set1_epi32(0xFF),
        ));
    fn add_words(a: i32x8<Avx2>, b: i32x8<Avx2>) -> i32x8<Avx2> = _mm256_add_epi32(a.into(), b.into());
}

kernel!(
    #[inline(always)]
    fn bits_of(_avx2: Avx2, mask: mask32x8<Avx2>) -> i32 {
        _mm256_movemask_ps(_mm256_castsi256_ps(mask.into()))
    }
);

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
            Eight(SimdFrom::simd_from(avx2, _mm256_permute2f128_ps::<0x20>(low[0], high[0]))),
            Eight(SimdFrom::simd_from(avx2, _mm256_permute2f128_ps::<0x20>(low[1], high[1]))),
            Eight(SimdFrom::simd_from(avx2, _mm256_permute2f128_ps::<0x20>(low[2], high[2]))),
            Eight(SimdFrom::simd_from(avx2, _mm256_permute2f128_ps::<0x20>(low[3], high[3]))),
            Eight(SimdFrom::simd_from(avx2, _mm256_permute2f128_ps::<0x31>(low[0], high[0]))),
            Eight(SimdFrom::simd_from(avx2, _mm256_permute2f128_ps::<0x31>(low[1], high[1]))),
            Eight(SimdFrom::simd_from(avx2, _mm256_permute2f128_ps::<0x31>(low[2], high[2]))),
            Eight(SimdFrom::simd_from(avx2, _mm256_permute2f128_ps::<0x31>(low[3], high[3]))),
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
        Eight(SimdFrom::simd_from(self, numbers))
    }

    #[inline(always)]
    fn splat(self, number: f32) -> Numbers {
        Eight(splat(self, number))
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
                |row| SimdFrom::simd_from(self, rows[row].0),
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
        Eight(is_less_or_equal(self, a.eight(self), b.eight(self)))
    }

    #[inline(always)]
    fn mask(self, bits: i32) -> Answers {
        Eight(mask(self, bits))
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
            Eight(answers) => bits_of(self, answers),
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
        Eight(SimdFrom::simd_from(self, cast::<_, [i32; LANES]>(words)))
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
            Eight(mask) => Eight(select_words(self, mask, yes.eight(self), no.eight(self))),
        }
    }

    #[inline(always)]
    fn lowest_bits(self, bytes: u64) -> ([i32; LANES], Numbers) {
        let numbers = lowest_bits(self, bytes);
        (numbers.into(), Eight(numbers_of(self, numbers)))
    }

    #[inline(always)]
    fn four(self, numbers: [f64; 4]) -> f64x4<Self> {
        SimdFrom::simd_from(self, numbers)
    }

    #[inline(always)]
    fn four_of(self, number: f64) -> f64x4<Self> {
        self.splat_f64x4(number)
    }
}

/// A channel, rounded to the nearest whole number up to 255; far below zero or not a number, the least there is.
#[inline(always)]
fn channel(avx2: Avx2, channel: Numbers) -> i32x8<Avx2> {
    // In this order: what is not a number stays so.
    let limited = One(255.0).min(channel + One(0.5));
    whole(avx2, limited.eight(avx2))
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
        SimdFrom::simd_from(avx2, _mm256_shuffle_epi8(bytes, _mm256_broadcastsi128_si256(pixels)))
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
        SimdFrom::simd_from(avx2, _mm256_sub_epi32(exponents, _mm256_set1_epi32(127)))
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
        SimdFrom::simd_from(avx2, _mm256_or_pd(a.into(), b.into()))
    }
);

kernel!(
    #[inline(always)]
    fn flip_signs(avx2: Avx2, numbers: f64x4<Avx2>, signs: f64x4<Avx2>) -> f64x4<Avx2> {
        let signs = _mm256_and_pd(signs.into(), _mm256_set1_pd(-0.0));
        SimdFrom::simd_from(avx2, _mm256_xor_pd(numbers.into(), signs))
    }
);
