//! What vertices carry, packed: 1/w, depth and V/w side by side, eight numbers of one point at a time, where lanes are
//! mostly one number of eight points.

use std::hint::black_box;

use super::instruction_set::InstructionSet;
use super::lanes::{Block, LANES};
use super::vertices::Triangle;
use crate::real::Real;
use crate::varyings::LinearVaryings;

/// 2 + N numbers: the first block, and as many more as it takes. (What is too much is never read.)
#[derive(Clone, Copy)]
pub(super) struct PackedVaryings<R, const N: usize> {
    pub(super) first: R,
    pub(super) more: [R; N],
}

impl<R: Real, const N: usize> PackedVaryings<R, N> {
    #[inline(always)]
    fn of<I: InstructionSet<Lanes = R>>(instructions: I, blocks: &[Block]) -> Self {
        let mut more = [instructions.splat(0.0); N];
        for (i, more) in more.iter_mut().enumerate() {
            if (i + 1) * LANES < 2 + N {
                *more = instructions.lanes(blocks[i + 1].0);
            }
        }
        Self { first: instructions.lanes(blocks[0].0), more }
    }

    /// Its numbers, each for all lanes.
    ///
    /// By way of memory: taking a number out of a register, for all lanes, would keep those parts of the processor busy that
    /// the arithmetic needs. It changes nothing but the time.
    #[inline(always)]
    pub(super) fn spread<I: InstructionSet<Lanes = R>>(self, instructions: I) -> LinearVaryings<R, N> {
        let first = Block(instructions.numbers(self.first));
        let first = &black_box(&first).0;
        linear(
            #[inline(always)]
            |k| {
                instructions.splat(if k < LANES {
                    first[k]
                } else {
                    instructions.numbers(self.more[k / LANES - 1])[k % LANES]
                })
            },
        )
    }

    #[inline(always)]
    fn with(&self, other: &Self, combine: impl Fn(R, R) -> R) -> Self {
        let mut result = *self;
        result.first = combine(self.first, other.first);
        for (i, more) in result.more.iter_mut().enumerate() {
            *more = combine(*more, other.more[i]);
        }
        result
    }
}

/// What the vertices of a triangle carry, packed and made ready for weights, with the same sums in the same order as in
/// [`TriangleVaryings`](crate::varyings::TriangleVaryings).
pub(super) struct PackedTriangleVaryings<R, const N: usize> {
    first: PackedVaryings<R, N>,
    to_second: PackedVaryings<R, N>,
    to_third: PackedVaryings<R, N>,
}

impl<R: Real, const N: usize> PackedTriangleVaryings<R, N> {
    #[inline(always)]
    pub(super) fn of<I: InstructionSet<Lanes = R>>(instructions: I, triangle: Triangle<'_>) -> Self {
        let [first, second, third] = triangle.packed;
        let first = PackedVaryings::of(instructions, first);
        let [second, third] =
            [PackedVaryings::of(instructions, second), PackedVaryings::of(instructions, third)];
        let to_second = second.with(
            &first,
            #[inline(always)]
            |vertex, first| vertex - first,
        );
        let to_third = third.with(
            &first,
            #[inline(always)]
            |vertex, first| vertex - first,
        );
        Self { first, to_second, to_third }
    }

    /// Where the second and the third vertex have these weights.
    #[inline(always)]
    pub(super) fn at<I: InstructionSet<Lanes = R>>(
        &self,
        instructions: I,
        [second, third]: [f32; 2],
    ) -> PackedVaryings<R, N> {
        let [second, third] = [instructions.splat(second), instructions.splat(third)];
        let on_the_way = self.first.with(
            &self.to_second,
            #[inline(always)]
            |first, difference| first + difference * second,
        );
        on_the_way.with(
            &self.to_third,
            #[inline(always)]
            |there, difference| there + difference * third,
        )
    }

    /// How much changes where their weights change by so much.
    #[inline(always)]
    pub(super) fn change<I: InstructionSet<Lanes = R>>(
        &self,
        instructions: I,
        [second, third]: [f32; 2],
    ) -> PackedVaryings<R, N> {
        let [second, third] = [instructions.splat(second), instructions.splat(third)];
        self.to_second.with(
            &self.to_third,
            #[inline(always)]
            |to_second, to_third| to_second * second + to_third * third,
        )
    }
}

/// Packed numbers by their meaning.
#[inline(always)]
pub(super) fn linear<R: Real, const N: usize>(number: impl Fn(usize) -> R) -> LinearVaryings<R, N> {
    let mut values = [R::from(0.0); N];
    for (k, value) in values.iter_mut().enumerate() {
        *value = number(k + 2);
    }
    LinearVaryings { distance: number(0), depth: number(1), values }
}
