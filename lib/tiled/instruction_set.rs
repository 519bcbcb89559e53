//! What the fast rasterizer asks of a set of instructions.
//!
//! Whatever computes several numbers at a time is generic over an [`InstructionSet`], and compiled once for each.

use std::fmt::Debug;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Sub};

use super::lanes::{Block, LANES};
use crate::real::Real;

/// The numbers of a fragment, or of eight: a mask and colors go with them.
pub(super) type MaskOf<I> = <<I as InstructionSet>::Lanes as Real>::Mask;
/// Eight words 0x00RRGGBB.
pub(super) type WordsOf<I> = <<I as InstructionSet>::Lanes as Real>::Colors;

/// A set of instructions, and with it the proof that they may be used.
///
/// The trap is what is *not* inlined: a function of its own is compiled for the baseline, and then each operation of
/// another set in it is a call. So `#[inline(always)]` stands on everything between [`Self::run`] and a single operation.
pub(super) trait InstructionSet: Copy + Debug + Send + Sync {
    /// Whether only pictures with the default options for pixels are drawn with it. Each copy of the code takes time to compile.
    const ONLY_PLAIN: bool;
    /// Eight `f32`, one for each fragment.
    type Lanes: Real;
    /// Four `f64`.
    type Four: Four;

    /// Does some work with these instructions: all that is inlined into it is compiled for them.
    fn run<R>(self, work: impl FnOnce() -> R) -> R;

    /// Eight numbers.
    fn lanes(self, numbers: [f32; LANES]) -> Self::Lanes;
    /// The same number in all lanes.
    fn splat(self, number: f32) -> Self::Lanes;
    /// The numbers in the lanes.
    fn numbers(self, lanes: Self::Lanes) -> [f32; LANES];
    /// The first numbers of all, then the second ones of all, and so on.
    fn transposed(self, rows: &[Block; LANES]) -> [Self::Lanes; LANES];
    /// A bit for each lane in which one of three numbers has a negative sign.
    fn signs(self, lanes: [Self::Lanes; 3]) -> u8;

    /// Where `a` is less than `b` or equal to it.
    fn is_less_or_equal(self, a: Self::Lanes, b: Self::Lanes) -> MaskOf<Self>;
    /// The lanes whose bit is set, the first lane in the lowest bit.
    fn mask(self, bits: i32) -> MaskOf<Self>;
    /// The bits of the first lanes, or of all if there are fewer; for 1..=255.
    fn lowest(self, count: i32) -> i32;
    /// A bit for each lane.
    fn bits(self, mask: MaskOf<Self>) -> i32;

    /// The words of eight colors, channels rounded to the nearest of 0..=255; NaN gives 0.
    fn packed(self, color: [Self::Lanes; 3]) -> WordsOf<Self>;
    /// Eight words.
    fn words(self, words: [u32; LANES]) -> WordsOf<Self>;
    /// The words in the lanes.
    fn word_array(self, words: WordsOf<Self>) -> [u32; LANES];
    /// `yes` in the lanes of the mask, `no` in the others.
    fn choose(self, mask: MaskOf<Self>, yes: WordsOf<Self>, no: WordsOf<Self>) -> WordsOf<Self>;
    /// The number of the lowest bit that is set in each byte, the first byte in the lowest bits; where none is, anything.
    fn lowest_bits(self, bytes: u64) -> ([i32; LANES], Self::Lanes);

    /// Four numbers.
    fn four(self, numbers: [f64; 4]) -> Self::Four;
    /// The same number four times.
    fn four_of(self, number: f64) -> Self::Four;
}

/// Four `f64`.
pub(super) trait Four:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// Yes or no for each of them.
    type Mask: Copy + BitAnd<Output = Self::Mask> + BitOr<Output = Self::Mask>;

    fn to_array(self) -> [f64; 4];
    fn abs(self) -> Self;
    /// The bits of both.
    fn or(self, other: Self) -> Self;
    /// The lesser and the greater of two numbers, neither of which is NaN.
    fn min(self, other: Self) -> Self;
    fn max(self, other: Self) -> Self;
    /// This number, with the other sign where `signs` is negative.
    fn flip_signs(self, signs: Self) -> Self;
    fn is_equal(self, other: Self) -> Self::Mask;
    fn is_less(self, other: Self) -> Self::Mask;
    fn is_less_or_equal(self, other: Self) -> Self::Mask;
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
}
