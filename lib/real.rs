//! Chapter 3: the numbers that interpolation and shading are written for.
//!
//! A formula that is generic over [`Real`] is written once and runs on `f64`, as the book computes, on `f32`, and on
//! several numbers at a time. That is why comparisons do not give a `bool` but a [`Real::Mask`]: of several numbers
//! some may be less and others not.
//!
//! ```
//! use rasterbook::real::Real;
//!
//! fn mean<R: Real>(a: R, b: R) -> R {
//!     (a + b) * R::of(0.5)
//! }
//! assert_eq!(mean(1.0_f64, 2.0), 1.5);
//! assert_eq!(mean(1.0_f32, 2.0), 1.5);
//! ```

use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::color::Color;

/// Only this library says what a number is: the pictures depend on every operation being exact IEEE arithmetic.
pub(crate) mod sealed {
    /// Implemented for the number types and their masks alone.
    pub trait Sealed {}
}

/// A number with the four operations, which are exact IEEE operations: one rounding each, nothing fused.
pub trait Real:
    sealed::Sealed
    + Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + From<f32>
{
    /// Yes or no for each of the numbers.
    type Mask: Mask;
    /// A color for each of the numbers, as it is stored.
    type Colors: Copy + Debug + PartialEq;

    /// A literal: the number nearest to `value`.
    fn of(value: f64) -> Self;
    /// Several literals: a vector or a color that is the same everywhere.
    #[inline(always)]
    #[must_use]
    fn array_of<const N: usize>(values: [f64; N]) -> [Self; N] {
        each(
            [Self::of(0.0); N],
            #[inline(always)]
            |k, _| Self::of(values[k]),
        )
    }
    /// The lesser of two numbers: this one if it is less, else the other one. So the other one if either is NaN, and of two
    /// zeros, whatever their signs.
    #[must_use]
    fn min(self, other: Self) -> Self;
    /// The greater of two numbers: this one if it is greater, else the other one. So the other one if either is NaN, and of
    /// two zeros, whatever their signs.
    #[must_use]
    fn max(self, other: Self) -> Self;
    /// The greatest whole number that is not greater; −0 for −0.
    #[must_use]
    fn floor(self) -> Self;
    /// The square root, rounded once.
    #[must_use]
    fn sqrt(self) -> Self;
    /// Where this number is less than the other one.
    #[must_use]
    fn is_less(self, other: Self) -> Self::Mask;
    /// `yes` where the mask says so, `no` elsewhere.
    #[must_use]
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// A function of one number, for each of them: what has no formula in the four operations, such as a power.
    #[must_use]
    fn map(self, function: impl Fn(f64) -> f64) -> Self;
    /// The same for a function of N numbers that gives M, such as a fragment shader written for `f64`.
    #[must_use]
    fn map_all<const N: usize, const M: usize>(
        values: [Self; N],
        function: impl Fn([f64; N]) -> [f64; M],
    ) -> [Self; M];
    /// Gathers a record of C numbers from a table, by two whole numbers that are not negative, such as a texel by column and row.
    #[must_use]
    fn gather<const C: usize>(column: Self, row: Self, table: impl Fn(usize, usize) -> [f64; C])
    -> [Self; C];
    /// Gathers the color in a column and a row (not negative, fractions are cut off) of a plane of colors in which a row has 2 to the
    /// power of `row_bits` places. It must be inside the plane: outside, the answer is any color, or a panic.
    #[must_use]
    fn gather_color(column: Self, row: Self, row_bits: u32, colors: &[Color]) -> Self::Colors;
    /// The channels of colors, 0..=255.
    #[must_use]
    fn channels(colors: Self::Colors) -> [Self; 3];
}

/// Changes each of some numbers, which are counted from 0.
///
/// As `map` of an array and `array::from_fn` do, but these are only asked to be inlined. Where a number is several at a time,
/// a function that is not inlined may be compiled for another processor than its caller.
#[inline(always)]
#[must_use]
pub fn each<T: Copy, const N: usize>(mut numbers: [T; N], change: impl Fn(usize, T) -> T) -> [T; N] {
    // A loop is unrolled too late: of a number that is one or eight the compiler would keep asking which.
    macro_rules! change {
        ($($k:literal)*) => {
            $(if const { $k < N } {
                numbers[$k] = change($k, numbers[$k]);
            })*
        };
    }
    change!(0 1 2 3 4 5 6 7);
    let mut k = 8;
    while k < N {
        numbers[k] = change(k, numbers[k]);
        k += 1;
    }
    numbers
}

/// `map` of an array of three: the vertices of a triangle, the channels of a color.
///
/// That `map` is seven functions, one calling the other, for each closure. Where the compiler optimises little, as in the dev
/// profile, they took a fifth of the time in which chapter 10 is built, and a tenth of that in which it draws.
#[inline(always)]
#[must_use]
pub(crate) fn map3<T, U>([a, b, c]: [T; 3], mut change: impl FnMut(T) -> U) -> [U; 3] {
    [change(a), change(b), change(c)]
}

/// A single number: one answer to a comparison, and a value that can be stored.
pub trait Scalar: Real<Mask = bool, Colors = Color> + PartialOrd + Into<f64> {}

impl Scalar for f64 {}
impl Scalar for f32 {}

/// Yes or no, for one number or for several.
pub trait Mask: sealed::Sealed + Copy + Debug {
    /// The same answer for all.
    fn all(answer: bool) -> Self;
    /// Yes where both say yes.
    #[must_use]
    fn and(self, other: Self) -> Self;
    /// Yes where this one says no.
    #[must_use]
    fn not(self) -> Self;
}

impl sealed::Sealed for bool {}

impl Mask for bool {
    #[inline]
    fn all(answer: bool) -> Self {
        answer
    }

    #[inline]
    fn and(self, other: Self) -> Self {
        self && other
    }

    #[inline]
    fn not(self) -> Self {
        !self
    }
}

/// The same lines for both sizes of a plain number.
macro_rules! plain_number {
    ($number:ident) => {
        impl sealed::Sealed for $number {}

        impl Real for $number {
            type Mask = bool;
            type Colors = Color;

            #[inline]
            fn of(value: f64) -> Self {
                value as Self
            }

            #[inline]
            fn min(self, other: Self) -> Self {
                // As the method of the same name, but for NaN and zeros: one instruction instead of four. For aarch64, LLVM 22
                // takes one that puts −0 before 0 if one of the two is a constant: there, equal numbers are looked for first.
                if cfg!(target_arch = "aarch64") && self == other {
                    return other;
                }
                if self < other { self } else { other }
            }

            #[inline]
            fn max(self, other: Self) -> Self {
                if cfg!(target_arch = "aarch64") && self == other {
                    return other;
                }
                if self > other { self } else { other }
            }

            #[inline]
            fn floor(self) -> Self {
                Self::floor(self)
            }

            #[inline]
            fn sqrt(self) -> Self {
                Self::sqrt(self)
            }

            #[inline]
            fn is_less(self, other: Self) -> bool {
                self < other
            }

            #[inline]
            fn select(mask: bool, yes: Self, no: Self) -> Self {
                if mask { yes } else { no }
            }

            #[inline]
            fn map(self, function: impl Fn(f64) -> f64) -> Self {
                function(f64::from(self)) as Self
            }

            #[inline]
            fn map_all<const N: usize, const M: usize>(
                values: [Self; N],
                function: impl Fn([f64; N]) -> [f64; M],
            ) -> [Self; M] {
                let values = each([0.0; N], |k, _| f64::from(values[k]));
                Self::array_of(function(values))
            }

            #[inline]
            fn gather<const C: usize>(
                column: Self,
                row: Self,
                table: impl Fn(usize, usize) -> [f64; C],
            ) -> [Self; C] {
                Self::array_of(table(column as usize, row as usize))
            }

            #[inline]
            fn gather_color(column: Self, row: Self, row_bits: u32, colors: &[Color]) -> Color {
                // A plane has fewer than 2³² columns and rows; from a float, a `u32` is made faster than a `usize`.
                // Both in one `map`: written one by one, LLVM makes the exact rasterizer a fifth slower in `f64`.
                let [column, row] = [column, row].map(|index| index as u32 as usize);
                colors[(row << row_bits) + column]
            }

            #[inline]
            fn channels(color: Color) -> [Self; 3] {
                map3(color.channels(), Self::from)
            }
        }
    };
}

plain_number!(f64);
plain_number!(f32);
