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

#[cfg(test)]
mod tests {
    use std::array::from_fn;

    use super::*;
    use crate::clip::NdcVertex;
    use crate::rect::Rect;
    use crate::state::RenderState;
    use crate::tiled::instructions::with_each;
    use crate::tiled::vertices::{Projection, Vertices};
    use crate::varyings::TriangleVaryings;
    use glam::dvec3;

    /// All numbers of a triangle, in all lanes, against those of the exact rasterizer.
    fn check<const N: usize>() {
        let vertex = |seed: f64| {
            let varyings = from_fn(|k| seed * (k as f64 + 0.3) - 7.0);
            NdcVertex { position: dvec3(0.1 * seed, 0.3, 1.0 / seed), w: seed + 1.0, varyings }
        };
        let ndc = [1.0, 2.5, 6.0].map(vertex);
        let (mut vertices, state) = (Vertices::default(), RenderState::default());
        vertices.push(&ndc, &Projection::new(&state, Rect::sized(8, 8))).expect("near enough");
        let expected = TriangleVaryings::<f32, N>::new(&ndc, state.interpolation);
        with_each!(instructions => {
            let packed = PackedTriangleVaryings::<_, N>::of(instructions, vertices.triangle::<N>([0, 1, 2]));
            for weights in [[0.0, 0.0], [0.25, 0.625], [0.1, -0.7]] {
                for (packed, expected) in [
                    (packed.at(instructions, weights), expected.linear_at(weights)),
                    (packed.change(instructions, weights), expected.change(weights)),
                ] {
                    let LinearVaryings { distance, depth, values } = packed.spread(instructions);
                    assert_eq!(instructions.numbers(distance), [expected.distance; LANES]);
                    assert_eq!(instructions.numbers(depth), [expected.depth; LANES]);
                    for (value, expected) in values.into_iter().zip(expected.values) {
                        assert_eq!(instructions.numbers(value), [expected; LANES], "{N} varyings");
                    }
                }
            }
        });
    }

    #[test]
    fn packed_as_one_by_one() {
        // One block, a full one, and one number more; two full ones, and one number more.
        check::<0>();
        check::<6>();
        check::<7>();
        check::<14>();
        check::<15>();
    }
}
