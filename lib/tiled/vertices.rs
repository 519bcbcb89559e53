//! Vertices: shaded, divided by w and snapped to the grid, each once, for all triangles that share it. On all threads.

use std::array::from_fn;

use arrayvec::ArrayVec;
use glam::{DVec3, DVec4, dvec3};
use rayon::prelude::*;

use super::baseline::Baseline;
use super::instruction_set::{Four, InstructionSet};
#[cfg(all(target_arch = "x86_64", not(target_feature = "avx2")))]
use super::instructions::Compiled;
use super::instructions::Instructions;
use super::lanes::{Block, LANES};
use super::snapped::{NO_FRACTIONS, SnappedPosition};
use crate::clip::{ClipTest, ClipVertex, NdcVertex, Plane};
use crate::exact::GUARD_BAND;
use crate::exact::edge::{FARTHEST, SUBPIXELS, Subpixel, snap};
use crate::interpolate::Interpolation;
use crate::mesh::Mesh;
use crate::real::{each, map3};
use crate::rect::Rect;
use crate::shader::Shader;
use crate::state::RenderState;
use crate::transform::Viewport;
use crate::varyings::LinearVaryings;

/// Vertices, made ready for triangles.
#[derive(Debug, Default)]
pub(super) struct Vertices {
    positions: Vec<SnappedPosition>,
    /// Which planes a vertex lies outside of, a bit each; and the bit below.
    outside: Vec<u8>,
    /// 1/w, depth, V/w: as many blocks of eight numbers for a vertex as it takes.
    packed: Vec<Block>,
}

/// The vertex is not finite, beyond the guard band or too far away on the screen: triangles of it cannot be drawn as they
/// are.
pub(super) const NOT_REPRESENTABLE: u8 = 1 << 7;

/// A triangle as a tile needs it.
#[derive(Clone, Copy)]
pub(super) struct Triangle<'a> {
    pub(super) positions: [SnappedPosition; 3],
    pub(super) packed: [&'a [Block]; 3],
}

impl Triangle<'_> {
    /// The positions, as [`edge`](crate::exact::edge) knows them.
    pub(super) fn vertices(&self) -> [Subpixel; 3] {
        map3(self.positions, |[x, y]| [i64::from(x), i64::from(y)])
    }
}

/// So many vertices are divided and snapped at a time.
const AT_A_TIME: usize = 4;

/// What a function gives for each of four vertices. (`from_fn` of the standard library need not be inlined, and what it gives is
/// then written to memory and copied.)
#[inline(always)]
fn each_of_four<T>(of: impl Fn(usize) -> T) -> [T; AT_A_TIME] {
    [of(0), of(1), of(2), of(3)]
}

/// How many blocks of eight numbers so many varyings take.
const fn blocks_of(varyings: usize) -> usize {
    (2 + varyings).div_ceil(LANES)
}

impl Vertices {
    /// Forgets all.
    pub(super) fn clear(&mut self) {
        self.positions.clear();
        self.outside.clear();
        self.packed.clear();
    }

    // ANCHOR: shade_vertices
    /// Shades, projects and snaps every vertex of a mesh once.
    pub(super) fn shade<S: Shader<N>, const N: usize>(
        &mut self,
        instructions: Instructions,
        mesh: &Mesh<S::Attributes>,
        shader: &S,
        projection: &Projection<'_>,
    ) {
        match instructions.0 {
            #[cfg(all(target_arch = "x86_64", not(target_feature = "avx2")))]
            Compiled::Avx2(avx2) if S::IS_INLINED => self.shade_with(avx2, mesh, shader, projection),
            _ => self.shade_with(Baseline, mesh, shader, projection),
        }
    }

    fn shade_with<I: InstructionSet, S: Shader<N>, const N: usize>(
        &mut self,
        instructions: I,
        mesh: &Mesh<S::Attributes>,
        shader: &S,
        projection: &Projection<'_>,
    ) {
        let vertices = mesh.vertices();
        // Rounded up to a multiple of four. What is too much repeats the last vertex, and no triangle names it.
        let count = vertices.len().next_multiple_of(AT_A_TIME);
        let blocks = blocks_of(N);
        self.positions.resize(count, [0; 2]);
        self.outside.resize(count, 0);
        self.packed.resize(count * blocks, Block::ZERO);
        self.each_part(blocks, &|first, Slots { positions, outside, packed }| {
            instructions.run(
                #[inline(always)]
                || {
                    // Computed again: so it is a constant in here, and not a captured number.
                    let blocks = blocks_of(N);
                    let slots = positions.as_chunks_mut().0.iter_mut().zip(outside.as_chunks_mut().0);
                    let slots = slots.zip(packed.chunks_exact_mut(AT_A_TIME * blocks));
                    for (four, ((positions, outside), packed)) in slots.enumerate() {
                        let number = |i: usize| (first + four * AT_A_TIME + i).min(vertices.len() - 1);
                        let clip = each_of_four(
                            #[inline(always)]
                            |i| shader.vertex(&vertices[number(i)]),
                        );
                        let ndc;
                        (*positions, *outside, ndc) = projection.project(instructions, &clip);
                        let packed = packed.chunks_exact_mut(blocks);
                        for ((vertex, position), packed) in clip.iter().zip(ndc).zip(packed) {
                            let ClipVertex { position: DVec4 { w, .. }, varyings } = *vertex;
                            pack(
                                &NdcVertex { position, w, varyings },
                                projection.state.interpolation,
                                packed,
                            );
                        }
                    }
                },
            );
        });
    }
    // ANCHOR_END: shade_vertices
}

impl Vertices {
    /// Hands the vertices out in parts, to all threads; `shade` gets the number of the first in each.
    fn each_part(&mut self, blocks: usize, shade: &(dyn Fn(usize, Slots<'_>) + Sync)) {
        // A multiple of `AT_A_TIME`: no group is divided.
        const PART: usize = 1024;
        let positions = self.positions.par_chunks_mut(PART);
        let parts = positions.zip(self.outside.par_chunks_mut(PART));
        let parts = parts.zip(self.packed.par_chunks_mut(PART * blocks)).enumerate();
        parts.for_each(|(i, ((positions, outside), packed))| {
            shade(i * PART, Slots { positions, outside, packed });
        });
    }

    /// Adds the vertices of a triangle that has been clipped and divided; answers where they are, if they are near enough.
    pub(super) fn push<const N: usize>(
        &mut self,
        triangle: &[NdcVertex<N>; 3],
        projection: &Projection<'_>,
    ) -> Option<[SnappedPosition; 3]> {
        let [a, b, c] = map3(triangle.each_ref(), |vertex| projection.snapped_position(vertex));
        let positions = [a?, b?, c?];
        let first = self.packed.len();
        self.positions.extend(positions);
        self.packed.resize(first + 3 * blocks_of(N), Block::ZERO);
        for (vertex, packed) in triangle.iter().zip(self.packed[first..].chunks_exact_mut(blocks_of(N))) {
            pack(vertex, projection.state.interpolation, packed);
        }
        Some(positions)
    }

    /// How many triangles have been pushed.
    pub(super) fn triangle_count(&self) -> usize {
        self.positions.len() / 3
    }

    /// Where vertices are.
    #[inline(always)]
    pub(super) fn positions(&self, triangle: [usize; 3]) -> [SnappedPosition; 3] {
        map3(triangle, |vertex| self.positions[vertex])
    }

    /// What each of them lies outside of.
    #[inline(always)]
    pub(super) fn outside(&self, triangle: [usize; 3]) -> [u8; 3] {
        map3(triangle, |vertex| self.outside[vertex])
    }

    /// A triangle of vertices with so many varyings.
    ///
    /// Inlined, as [`SmallTriangleSetup::new`](super::edges::SmallTriangleSetup::new) is: positions that are written to memory here would be read there
    /// in wider pieces, for which the processor waits.
    #[inline(always)]
    pub(super) fn triangle<const N: usize>(&self, triangle: [usize; 3]) -> Triangle<'_> {
        let blocks = blocks_of(N);
        Triangle {
            positions: self.positions(triangle),
            packed: map3(triangle, |vertex| &self.packed[vertex * blocks..(vertex + 1) * blocks]),
        }
    }
}

/// Some vertices, one after the other, to be filled.
struct Slots<'a> {
    positions: &'a mut [SnappedPosition],
    outside: &'a mut [u8],
    packed: &'a mut [Block],
}

#[inline(always)]
fn pack<const N: usize>(vertex: &NdcVertex<N>, interpolation: Interpolation, packed: &mut [Block]) {
    let linear = LinearVaryings::<f32, N>::new(vertex, interpolation);
    let mut numbers = [linear.distance, linear.depth].into_iter().chain(linear.values);
    for block in packed {
        *block = Block(from_fn(|_| numbers.next().unwrap_or(0.0)));
    }
}

/// From clip space to the grid: what is the same for all vertices of a picture.
pub(super) struct Projection<'a> {
    pub(super) state: &'a RenderState,
    pub(super) planes: ArrayVec<Plane, 6>,
    wide_planes: ArrayVec<WidePlane, 6>,
    viewport: Viewport,
}

/// A plane, each number for four vertices.
#[repr(align(32))]
struct WidePlane {
    normal: [[f64; AT_A_TIME]; 4],
    offset: [f64; AT_A_TIME],
    /// Its bit.
    bit: u64,
}

impl WidePlane {
    fn new((number, plane): (usize, &Plane)) -> Self {
        let (normal, offset) = plane.coefficients();
        Self {
            normal: normal.map(|component| [component; AT_A_TIME]),
            offset: [offset; AT_A_TIME],
            bit: 1 << number,
        }
    }
}

/// Four vertices: where they are, what each of them lies outside of, and their positions in NDC.
type FourVertices = ([SnappedPosition; AT_A_TIME], [u8; AT_A_TIME], [DVec3; AT_A_TIME]);

impl<'a> Projection<'a> {
    pub(super) fn new(state: &'a RenderState, picture: Rect) -> Self {
        let planes = state.clip_volume.planes(state.depth_range);
        let wide_planes = planes.iter().enumerate().map(WidePlane::new).collect();
        Self { state, planes, wide_planes, viewport: state.viewport_in(picture) }
    }

    /// Where on the screen a vertex is, if it is near enough.
    fn snapped_position<const N: usize>(&self, vertex: &NdcVertex<N>) -> Option<SnappedPosition> {
        snap(self.viewport.pixel_areas(vertex.position)).map(|position| position.map(|along| along as i32))
    }

    // ANCHOR: project_vertices
    /// Which planes four points of clip space lie outside of, a bit each.
    #[inline(always)]
    fn outside<I: InstructionSet>(&self, instructions: I, clip: [I::Four; 4]) -> I::Four {
        let [x, y, z, w] = match (self.state.clip_test, clip[3]) {
            (ClipTest::BeforeDivide, _) => clip,
            (ClipTest::AfterDivide, w) => [clip[0] / w, clip[1] / w, clip[2] / w, clip[3] / w],
        };
        let zero = instructions.four_of(0.0);
        let mut outside = zero;
        for WidePlane { normal, offset, bit } in &self.wide_planes {
            let distance = instructions.four(normal[0]) * x
                + instructions.four(normal[1]) * y
                + instructions.four(normal[2]) * z
                + instructions.four(normal[3]) * w
                + instructions.four(*offset);
            outside = outside.or(unless(instructions, zero.is_less_or_equal(distance), *bit));
        }
        outside
    }

    /// Projects four vertices: what the functions of the chapters do with one, in the same order.
    #[inline(always)]
    fn project<I: InstructionSet, const N: usize>(
        &self,
        instructions: I,
        vertices: &[ClipVertex<N>; AT_A_TIME],
    ) -> FourVertices {
        let [a, b, c, d] = vertices.each_ref().map(|vertex| vertex.position);
        let clip = [
            instructions.four([a.x, b.x, c.x, d.x]),
            instructions.four([a.y, b.y, c.y, d.y]),
            instructions.four([a.z, b.z, c.z, d.z]),
            instructions.four([a.w, b.w, c.w, d.w]),
        ];
        let [x, y, z, w] = clip;
        let ndc = [x / w, y / w, z / w];
        let (one, half) = (instructions.four_of(1.0), instructions.four_of(0.5));
        let Viewport { x, y, width, height, .. } = self.viewport;
        let x = instructions.four_of(x) + (ndc[0] + one) * half * instructions.four_of(width);
        let y = instructions.four_of(y) + (ndc[1] + one) * half * instructions.four_of(height);

        let mut is_ready = instructions.four_of(0.0).is_less(w);
        for component in clip {
            is_ready = is_ready & is_within(instructions, component, f64::MAX);
        }
        for (along, pixels) in [(ndc[0], x), (ndc[1], y)] {
            is_ready = is_ready & is_within(instructions, along, GUARD_BAND);
            is_ready = is_ready & is_within(instructions, pixels, FARTHEST);
        }
        let outside =
            self.outside(instructions, clip).or(unless(instructions, is_ready, NOT_REPRESENTABLE.into()));

        let subpixels = instructions.four_of(SUBPIXELS as f64);
        let x = whole(instructions, rounded(instructions, x * subpixels));
        let y = whole(instructions, rounded(instructions, y * subpixels));
        let ndc = [ndc[0].to_array(), ndc[1].to_array(), ndc[2].to_array()];
        (
            each([[0; 2]; AT_A_TIME], |i, _| [x[i], y[i]]),
            outside.to_array().map(|bits| bits.to_bits() as u8),
            each([DVec3::ZERO; AT_A_TIME], |i, _| dvec3(ndc[0][i], ndc[1][i], ndc[2][i])),
        )
    }
    // ANCHOR_END: project_vertices
}

/// Bits where the answer is no.
#[inline(always)]
fn unless<I: InstructionSet>(instructions: I, answer: <I::Four as Four>::Mask, bits: u64) -> I::Four {
    I::Four::select(answer, instructions.four_of(0.0), instructions.four_of(f64::from_bits(bits)))
}

/// Whether numbers are no farther from zero than this, on either side; not so for NaN.
#[inline(always)]
fn is_within<I: InstructionSet>(instructions: I, numbers: I::Four, most: f64) -> <I::Four as Four>::Mask {
    numbers.abs().is_less_or_equal(instructions.four_of(most))
}

/// The nearest whole numbers, from the middle away from zero, as [`f64::round`] has it; for numbers of less than 2⁵¹.
#[inline(always)]
fn rounded<I: InstructionSet>(instructions: I, numbers: I::Four) -> I::Four {
    let (size, no_fractions) = (numbers.abs(), instructions.four_of(NO_FRACTIONS));
    // From the middle to the even one: once too low, perhaps.
    let nearest = (size + no_fractions) - no_fractions;
    let is_too_low = (size - nearest).is_equal(instructions.four_of(0.5));
    let too_low = I::Four::select(is_too_low, instructions.four_of(1.0), instructions.four_of(0.0));
    (nearest + too_low).flip_signs(numbers)
}

/// Whole numbers of at most 31 bits and a sign, such as positions are (25 bits), as integers.
///
/// One addition, where `as` tests first whether the number fits.
#[inline(always)]
fn whole<I: InstructionSet>(instructions: I, numbers: I::Four) -> [i32; AT_A_TIME] {
    (numbers + instructions.four_of(NO_FRACTIONS)).to_array().map(|number| number.to_bits() as i32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clip::ClipVolume;
    use crate::exact::is_in_guard_band;
    use crate::shader::from_fn;
    use crate::tiled::instructions::with_each;
    use glam::{dvec3, dvec4};
    use proptest::prelude::*;

    /// Positions in clip space, in the view or not, and some that are none.
    fn position() -> impl Strategy<Value = DVec4> {
        let odd =
            prop::sample::select(vec![0.0, -0.0, 1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300]);
        let component = || prop_oneof![8 => -1.5..1.5, 1 => -300.0..300.0, 1 => odd.clone()];
        (component(), component(), component(), prop_oneof![4 => 0.1..3.0, 1 => component()])
            .prop_map(|(x, y, z, w)| dvec4(x, y, z, w))
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 3000, ..ProptestConfig::default() })]

        #[test]
        fn four_vertices_as_one_by_one(
            clip in prop::array::uniform4(position()),
            clip_test in prop::sample::select(vec![ClipTest::BeforeDivide, ClipTest::AfterDivide]),
            clip_volume in prop::sample::select(vec![ClipVolume::Canonical, ClipVolume::InFront(0.5), ClipVolume::Everything]),
            side in prop::sample::select(vec![640.0, 1.0, 1e5, 1e9]),
        ) {
            let viewport = Some(Viewport { x: -3.5, y: 2.0, width: side, height: 480.0 });
            let state = RenderState { clip_test, clip_volume, viewport, ..RenderState::default() };
            let projection = Projection::new(&state, Rect::sized(640, 480));
            let vertices = clip.map(|position| ClipVertex { position, varyings: [] });
            with_each!(instructions => {
                let (positions, outside, ndc) = projection.project(instructions, &vertices);
                for i in 0..AT_A_TIME {
                    let one = NdcVertex::<0>::from(vertices[i]);
                    let is_ready = clip[i].is_finite() && clip[i].w > 0.0 && is_in_guard_band(&one);
                    let position = projection.snapped_position(&one).filter(|_| is_ready);
                    prop_assert_eq!(outside[i] & NOT_REPRESENTABLE != 0, position.is_none());
                    if let Some(position) = position {
                        prop_assert_eq!(positions[i], position);
                        prop_assert_eq!(ndc[i], one.position);
                    }
                    let asked = match clip_test {
                        ClipTest::BeforeDivide => clip[i],
                        ClipTest::AfterDivide => clip[i] / clip[i].w,
                    };
                    let planes = projection.planes.iter().enumerate();
                    let expected = planes.fold(0, |bits, (number, plane)| {
                        let is_inside = plane.signed_distance(asked) >= 0.0;
                        bits | u8::from(!is_inside) << number
                    });
                    prop_assert_eq!(outside[i] & !NOT_REPRESENTABLE, expected);
                }
            });
        }
    }

    #[test]
    fn each_vertex_of_a_mesh_has_its_place() {
        // Some lie beyond the right side of the view. Nine numbers are two blocks.
        let place = |i: f64| dvec4(i / 300.0 - 0.5, 0.25, 0.5, 1.0 + i / 1000.0);
        let shader = from_fn(|&i: &f64| ClipVertex { position: place(i), varyings: [i; 7] }, |_| [0.0; 3]);
        let state = RenderState::default();
        let projection = Projection::new(&state, Rect::sized(640, 480));
        let mut vertices = Vertices::default();
        // Fewer than four, some more, and more than one thread has.
        for count in [1, 7, 1030] {
            let mesh = Mesh::indexed((0..count).map(f64::from).collect(), vec![0, 0, 0]).expect("a triangle");
            vertices.shade(Instructions::default(), &mesh, &shader, &projection);
            for (i, number) in mesh.vertices().iter().enumerate() {
                let one = NdcVertex::from(shader.vertex(number));
                let mut packed = [Block::ZERO; 2];
                pack(&one, state.interpolation, &mut packed);
                let triangle = vertices.triangle::<7>([i; 3]);
                assert_eq!(Some(triangle.positions[0]), projection.snapped_position(&one), "{i} of {count}");
                assert_eq!([0, 1].map(|block| triangle.packed[2][block].0), packed.map(|block| block.0));
                let is_outside = |plane: &Plane| plane.signed_distance(place(*number)) < 0.0;
                let outside = projection.planes.iter().enumerate();
                let outside = outside.fold(0, |bits, (bit, plane)| bits | u8::from(is_outside(plane)) << bit);
                assert_eq!(vertices.outside([0, i, i]), [0, outside, outside], "{i} of {count}");
            }
        }
    }

    #[test]
    fn nothing_is_left_of_a_picture_before() {
        let state = RenderState::default();
        let projection = Projection::new(&state, Rect::sized(640, 480));
        let vertex = |x| NdcVertex { position: dvec3(x, 0.0, 0.5), w: 1.0, varyings: [x; 3] };
        let mut vertices = Vertices::default();
        for _ in 0..2 {
            assert!(vertices.push(&[0.0, 0.5, 0.25].map(vertex), &projection).is_some());
            assert!(vertices.push(&[0.0, 1e9, 0.25].map(vertex), &projection).is_none(), "too far away");
            assert_eq!(vertices.triangle_count(), 1);
            vertices.clear();
            assert_eq!((vertices.triangle_count(), vertices.packed.len(), vertices.outside.len()), (0, 0, 0));
        }
    }

    #[test]
    fn whole_numbers() {
        let most = 2_147_483_647.0;
        for number in [0.0, -0.0, 1.0, -1.0, 16_777_216.0, -16_777_216.0, most, -most - 1.0] {
            with_each!(instructions => {
                assert_eq!(whole(instructions, instructions.four_of(number)), [number as i32; 4]);
            });
        }
    }

    #[test]
    fn rounded_as_one_by_one() {
        let below_half = 0.5_f64.next_down();
        for number in [0.0, below_half, 0.5, 1.5, 2.5, 2.499, 16_777_215.5, 16_777_216.5, 1e9 + below_half] {
            let signs = [number, -number, number + 1.0, -number - 1.0];
            with_each!(instructions => {
                let rounded = rounded(instructions, instructions.four(signs)).to_array();
                assert_eq!(rounded, signs.map(f64::round));
            });
        }
    }
}
