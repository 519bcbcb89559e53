//! What vertices carry, packed: 1/w, depth and V/w side by side, eight numbers of one point at a time, where
//! [`Lanes`] are one number of eight points.

use std::array::from_fn;
use std::hint::black_box;

use wide::f32x8;

use super::lanes::{LANES, Lanes};
use super::vertices::Triangle;
use crate::varyings::LinearVaryings;

/// 2 + N numbers: the first block, and as many more as it takes. (What is too much is never read.)
#[derive(Clone, Copy)]
pub(super) struct PackedVaryings<const N: usize> {
    pub(super) first: f32x8,
    pub(super) more: [f32x8; N],
}

impl<const N: usize> PackedVaryings<N> {
    #[inline(always)]
    fn of(blocks: &[f32x8]) -> Self {
        let is_used = |i: usize| i * LANES < 2 + N;
        Self { first: blocks[0], more: from_fn(|i| if is_used(i + 1) { blocks[i + 1] } else { f32x8::ZERO }) }
    }

    /// Its numbers, each for all lanes.
    ///
    /// By way of memory: taking a number out of a register, for all lanes, would keep those parts of the processor busy that
    /// the arithmetic needs. It changes nothing but the time.
    #[inline(always)]
    pub(super) fn spread(self) -> LinearVaryings<Lanes, N> {
        let Self { first, more } = self;
        let first = black_box(first.as_array_ref());
        linear(|k| {
            Lanes::splat(if k < LANES { first[k] } else { more[k / LANES - 1].as_array_ref()[k % LANES] })
        })
    }

    #[inline(always)]
    fn with(&self, other: &Self, combine: impl Fn(f32x8, f32x8) -> f32x8) -> Self {
        Self {
            first: combine(self.first, other.first),
            more: from_fn(|i| combine(self.more[i], other.more[i])),
        }
    }
}

/// What the vertices of a triangle carry, packed and made ready for weights, with the same sums in the same order as in
/// [`TriangleVaryings`](crate::varyings::TriangleVaryings).
pub(super) struct PackedTriangleVaryings<const N: usize> {
    first: PackedVaryings<N>,
    to_second: PackedVaryings<N>,
    to_third: PackedVaryings<N>,
}

impl<const N: usize> PackedTriangleVaryings<N> {
    #[inline(always)]
    pub(super) fn of(triangle: Triangle<'_>) -> Self {
        let [first, second, third] = triangle.packed.map(PackedVaryings::of);
        let difference = |vertex: PackedVaryings<N>| vertex.with(&first, |vertex, first| vertex - first);
        Self { first, to_second: difference(second), to_third: difference(third) }
    }

    /// Where the second and the third vertex have these weights.
    #[inline(always)]
    pub(super) fn at(&self, [second, third]: [f32; 2]) -> PackedVaryings<N> {
        let [second, third] = [second, third].map(f32x8::splat);
        let on_the_way = self.first.with(&self.to_second, |first, difference| first + difference * second);
        on_the_way.with(&self.to_third, |there, difference| there + difference * third)
    }

    /// How much changes where their weights change by so much.
    #[inline(always)]
    pub(super) fn change(&self, [second, third]: [f32; 2]) -> PackedVaryings<N> {
        let [second, third] = [second, third].map(f32x8::splat);
        self.to_second.with(&self.to_third, |to_second, to_third| to_second * second + to_third * third)
    }
}

/// Packed numbers by their meaning.
#[inline(always)]
pub(super) fn linear<const N: usize>(number: impl Fn(usize) -> Lanes) -> LinearVaryings<Lanes, N> {
    LinearVaryings { distance: number(0), depth: number(1), values: from_fn(|k| number(k + 2)) }
}
