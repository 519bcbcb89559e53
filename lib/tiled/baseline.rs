//! The instructions that the whole program is compiled for, by the crate `wide`, which knows those of all processors.

use bytemuck::cast;
use wide::{CmpEq, CmpLe, CmpLt, f32x8, f64x4, i16x8, i32x8};

use super::instruction_set::{Four, InstructionSet};
use super::lanes::{ALL, Block, LANES, LaneMask, Lanes, each_lane, is_less_or_equal, packed};

/// What the whole program is compiled for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Baseline;

impl InstructionSet for Baseline {
    const ONLY_PLAIN: bool = false;
    type Lanes = Lanes;
    type Four = f64x4;

    #[inline(always)]
    fn run<R>(self, work: impl FnOnce() -> R) -> R {
        work()
    }

    #[inline(always)]
    fn lanes(self, numbers: [f32; LANES]) -> Lanes {
        Lanes::new(numbers)
    }

    #[inline(always)]
    fn splat(self, number: f32) -> Lanes {
        Lanes::splat(number)
    }

    #[inline(always)]
    fn numbers(self, lanes: Lanes) -> [f32; LANES] {
        lanes.to_array()
    }

    #[inline(always)]
    fn transposed(self, rows: &[Block; LANES]) -> [Lanes; LANES] {
        let columns = f32x8::transpose(each_lane(|row| f32x8::new(rows[row].0)));
        each_lane(|column| Lanes(columns[column]))
    }

    #[inline(always)]
    fn signs(self, [a, b, c]: [Lanes; 3]) -> u8 {
        (a.0 | b.0 | c.0).move_mask() as u8
    }

    #[inline(always)]
    fn is_less_or_equal(self, a: Lanes, b: Lanes) -> LaneMask {
        is_less_or_equal(a, b)
    }

    #[inline(always)]
    fn mask(self, bits: i32) -> LaneMask {
        LaneMask::of_bits(bits)
    }

    #[inline(always)]
    fn bits(self, mask: LaneMask) -> i32 {
        mask.bits()
    }

    #[inline(always)]
    fn lowest(self, count: i32) -> i32 {
        ALL >> (LANES as i32 - count).max(0)
    }

    #[inline(always)]
    fn packed(self, color: [Lanes; 3]) -> i32x8 {
        packed(color)
    }

    #[inline(always)]
    fn words(self, words: [u32; LANES]) -> i32x8 {
        cast(words)
    }

    #[inline(always)]
    fn word_array(self, words: i32x8) -> [u32; LANES] {
        cast(words)
    }

    #[inline(always)]
    fn choose(self, mask: LaneMask, yes: i32x8, no: i32x8) -> i32x8 {
        mask.choose(yes, no)
    }

    #[inline(always)]
    fn lowest_bits(self, bytes: u64) -> ([i32; LANES], Lanes) {
        let bytes = i16x8::from_u8x16_low(cast([bytes.to_le(), 0]));
        // The exponent of a power of two is the number of its bit.
        let lowest = i32x8::from_i16x8(bytes & -bytes).round_float();
        let numbers: i32x8 = (cast::<f32x8, i32x8>(lowest) >> 23) - i32x8::splat(127);
        (numbers.to_array(), Lanes(numbers.round_float()))
    }

    #[inline(always)]
    fn four(self, numbers: [f64; 4]) -> f64x4 {
        f64x4::new(numbers)
    }

    #[inline(always)]
    fn four_of(self, number: f64) -> f64x4 {
        f64x4::splat(number)
    }
}

impl Four for f64x4 {
    type Mask = Self;

    #[inline(always)]
    fn to_array(self) -> [f64; 4] {
        self.to_array()
    }

    #[inline(always)]
    fn abs(self) -> Self {
        self.abs()
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.fast_min(other)
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.fast_max(other)
    }

    #[inline(always)]
    fn or(self, other: Self) -> Self {
        self | other
    }

    #[inline(always)]
    fn flip_signs(self, signs: Self) -> Self {
        self.flip_signs(signs)
    }

    #[inline(always)]
    fn is_equal(self, other: Self) -> Self {
        self.cmp_eq(other)
    }

    #[inline(always)]
    fn is_less(self, other: Self) -> Self {
        self.cmp_lt(other)
    }

    #[inline(always)]
    fn is_less_or_equal(self, other: Self) -> Self {
        self.cmp_le(other)
    }

    #[inline(always)]
    fn select(mask: Self, yes: Self, no: Self) -> Self {
        mask.blend(yes, no)
    }
}
