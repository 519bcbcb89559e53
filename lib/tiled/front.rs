//! The front end: from vertices to lists of triangles for each tile. All of it runs on all threads.

use std::array::from_fn;
use std::ops::Range;

use arrayvec::ArrayVec;
use glam::DVec4;
use rayon::prelude::*;
use wide::{CmpGe, f32x8, f64x4};

use super::edges::NO_FRACTIONS;
use super::{TILE_HEIGHT, TILE_WIDTH, tiles_of};
use crate::Rect;
use crate::area::Winding;
use crate::clip::{ClipTest, ClipVertex, NdcVertex, Plane, clip_triangle, fan};
use crate::edge::{SUBPIXELS, Subpixel, snapped};
use crate::exact::{cut_to_guard_band, is_in_guard_band};
use crate::interpolate::Interpolation;
use crate::lanes::LANES;
use crate::mesh::Mesh;
use crate::pipeline::RenderState;
use crate::shader::Shader;
use crate::transform::Viewport;
use crate::varyings::EvenVaryings;

/// A place on the screen in 1/256 pixel.
pub(super) type Place = [i32; 2];

/// Where triangles come from.
pub(super) enum Source<'a, S: Shader<N>, const N: usize> {
    /// A mesh: all stages are still to be done.
    Mesh(&'a Mesh<S::Attributes>),
    /// Triangles that have been clipped and divided.
    Pieces(&'a [[NdcVertex<N>; 3]]),
}

/// Vertices, made ready for all triangles that share them.
#[derive(Debug, Default)]
struct Vertices {
    places: Vec<Place>,
    /// Which planes a vertex lies outside of, a bit each; and the two bits below.
    outside: Vec<u8>,
    /// 1/ω, depth, V/ω: as many blocks of eight numbers for a vertex as it takes.
    records: Vec<f32x8>,
}

/// Some of them, one after the other, to be filled.
struct Slots<'a> {
    places: &'a mut [Place],
    outside: &'a mut [u8],
    records: &'a mut [f32x8],
}

/// The vertex is not finite, or too far away: no triangle of it is drawn.
const NOWHERE: u8 = 1 << 6;
/// The vertex lies beyond the guard band.
const BEYOND: u8 = 1 << 7;

/// The triangles of a part of the mesh, and which tiles each of them may touch.
#[derive(Debug, Default)]
struct Chunk {
    /// For each tile the numbers of triangles, in order.
    bins: Vec<Vec<u32>>,
    /// Pieces of clipped triangles, three vertices each.
    extra: Vertices,
    /// Whether a triangle is as large as a tile.
    has_large: bool,
}

/// Marks the number of a piece among a chunk's own.
const EXTRA: u32 = 1 << 31;

/// How many triangles a chunk has at least.
const CHUNK: usize = 4096;

/// The working memory of the front end.
#[derive(Debug, Default)]
pub(super) struct Front {
    vertices: Vertices,
    chunks: Vec<Chunk>,
}

/// A triangle as a tile needs it.
#[derive(Clone, Copy)]
pub(super) struct Triangle<'a> {
    pub(super) places: [Place; 3],
    pub(super) records: [&'a [f32x8]; 3],
}

impl Triangle<'_> {
    /// The places, as [`edge`](crate::edge) knows them.
    pub(super) fn vertices(&self) -> [Subpixel; 3] {
        self.places.map(|place| place.map(i64::from))
    }
}

/// What is the same for all vertices and triangles of a picture.
struct Context<'a> {
    state: &'a RenderState,
    viewport: Viewport,
    window: Rect,
    planes: ArrayVec<Plane, 6>,
    sides: Sides,
    blocks: usize,
    columns: usize,
    tiles: usize,
}

impl Front {
    /// Sorts the triangles of a source into tiles.
    pub(super) fn prepare<S: Shader<N>, const N: usize>(
        &mut self,
        source: &Source<'_, S, N>,
        shader: &S,
        state: &RenderState,
        window: Rect,
    ) {
        let [columns, rows] = tiles_of(window);
        let planes = state.clip_volume.planes(state.depth_range);
        let context = Context {
            state,
            sides: Sides::new(&planes),
            viewport: state.viewport_in(window),
            window,
            planes,
            blocks: blocks_of(N),
            columns,
            tiles: columns * rows,
        };
        match source {
            Source::Mesh(mesh) => {
                self.vertices.shade(mesh, shader, &context);
                self.bin(mesh.triangle_count(), &context, &|vertices, chunk, numbers| {
                    for number in numbers {
                        assemble(vertices, chunk, number, mesh, shader, &context);
                    }
                });
            }
            Source::Pieces(pieces) => {
                self.vertices.resize(0, context.blocks);
                self.bin(pieces.len(), &context, &|_, chunk, numbers| {
                    for piece in &pieces[numbers] {
                        chunk.add_piece(piece, &context);
                    }
                });
            }
        }
    }

    /// Lets `assemble` put triangles into the chunks' bins, several chunks at a time.
    fn bin(
        &mut self,
        triangles: usize,
        context: &Context<'_>,
        assemble: &(dyn Fn(&Vertices, &mut Chunk, Range<usize>) + Sync),
    ) {
        let most = 4 * rayon::current_num_threads();
        let count = triangles.div_ceil(CHUNK).clamp(1, most);
        let size = triangles.div_ceil(count).max(1);
        self.chunks.resize_with(count, Chunk::default);
        let first = |chunk: usize| (chunk * size).min(triangles);
        let vertices = &self.vertices;
        self.chunks.par_iter_mut().enumerate().for_each(|(i, chunk)| {
            chunk.clear(context);
            assemble(vertices, chunk, first(i)..first(i + 1));
        });
    }

    /// Whether some triangle may cover all of a tile.
    pub(super) fn has_large_triangles(&self) -> bool {
        self.chunks.iter().any(|chunk| chunk.has_large)
    }

    /// Whether no triangle touches a tile.
    pub(super) fn is_empty(&self, tile: usize) -> bool {
        self.chunks.iter().all(|chunk| chunk.bins[tile].is_empty())
    }

    /// Does something with each of the triangles that may touch a tile, in order.
    #[inline(always)]
    pub(super) fn each_triangle_in<'a, S: Shader<N>, const N: usize>(
        &'a self,
        source: &Source<'_, S, N>,
        tile: usize,
        mut draw: impl FnMut(Triangle<'a>),
    ) {
        for chunk in &self.chunks {
            for &number in &chunk.bins[tile] {
                draw(self.triangle(source, chunk, number));
            }
        }
    }

    /// Inlined, so that triangles stay in registers.
    #[inline(always)]
    fn triangle<'a, S: Shader<N>, const N: usize>(
        &'a self,
        source: &Source<'_, S, N>,
        chunk: &'a Chunk,
        number: u32,
    ) -> Triangle<'a> {
        let blocks = blocks_of(N);
        match source {
            Source::Mesh(mesh) if number & EXTRA == 0 => {
                self.vertices.triangle(mesh.triangle(number as usize), blocks)
            }
            _ => {
                let first = 3 * (number & !EXTRA) as usize;
                chunk.extra.triangle([first, first + 1, first + 2], blocks)
            }
        }
    }
}

/// How many blocks of eight numbers a record with so many varyings has.
const fn blocks_of(varyings: usize) -> usize {
    (2 + varyings).div_ceil(LANES)
}

impl Vertices {
    fn resize(&mut self, count: usize, blocks: usize) {
        self.places.resize(count, [0; 2]);
        self.outside.resize(count, 0);
        self.records.resize(count * blocks, f32x8::ZERO);
    }

    // ANCHOR: shade_vertices
    /// Shades, projects and snaps every vertex once.
    fn shade<S: Shader<N>, const N: usize>(
        &mut self,
        mesh: &Mesh<S::Attributes>,
        shader: &S,
        context: &Context<'_>,
    ) {
        self.resize(mesh.vertices().len(), context.blocks);
        self.each_part(context.blocks, &|first, Slots { places, outside, records }| {
            let slots = places.iter_mut().zip(outside).zip(records.chunks_exact_mut(context.blocks));
            for (attributes, ((place, outside), record)) in mesh.vertices()[first..].iter().zip(slots) {
                let clip = shader.vertex(attributes);
                *outside = outside_of(&clip, context);
                let ndc = NdcVertex::from(clip);
                if *outside == 0 {
                    match context.place_of(&ndc) {
                        _ if !is_in_guard_band(&ndc) => *outside = BEYOND,
                        None => *outside = NOWHERE,
                        Some(seen) => *place = seen,
                    }
                }
                write_record(&ndc, context.state.interpolation, record);
            }
        });
    }
    // ANCHOR_END: shade_vertices

    /// Hands the vertices out in parts, to all threads; `shade` is told the number of the first in each.
    fn each_part(&mut self, blocks: usize, shade: &(dyn Fn(usize, Slots<'_>) + Sync)) {
        const PART: usize = 1024;
        let places = self.places.par_chunks_mut(PART);
        let parts = places.zip(self.outside.par_chunks_mut(PART));
        let parts = parts.zip(self.records.par_chunks_mut(PART * blocks)).enumerate();
        parts.for_each(|(i, ((places, outside), records))| {
            shade(i * PART, Slots { places, outside, records });
        });
    }

    /// Inlined, as [`Small::new`](super::edges::Small::new) is: places that are written to memory here would be read there
    /// in wider pieces, for which the processor waits.
    #[inline(always)]
    fn triangle(&self, corners: [usize; 3], blocks: usize) -> Triangle<'_> {
        Triangle {
            places: corners.map(|corner| self.places[corner]),
            records: corners.map(|corner| &self.records[corner * blocks..(corner + 1) * blocks]),
        }
    }
}

/// The planes of the view volume, four at a time, and the components of their normals apart.
struct Sides([Side; 2]);

/// Four planes.
struct Side {
    normal: [f64x4; 4],
    offset: f64x4,
}

impl Sides {
    fn new(planes: &[Plane]) -> Self {
        // What lies on no side of anything is outside of nothing.
        let plane = |i: usize| planes.get(i).map_or(([0.0; 4], 0.0), Plane::coefficients);
        Self([0, 4].map(|from| Side {
            normal: from_fn(|k| f64x4::new(from_fn(|i| plane(from + i).0[k]))),
            offset: f64x4::new(from_fn(|i| plane(from + i).1)),
        }))
    }

    /// A bit for each plane on whose wrong side a point is.
    #[inline]
    fn outside(&self, position: DVec4) -> u8 {
        let [x, y, z, w] = position.to_array().map(f64x4::splat);
        let bits = |Side { normal, offset }: &Side| {
            let distance = normal[0] * x + normal[1] * y + normal[2] * z + normal[3] * w + *offset;
            0xF & !distance.cmp_ge(f64x4::ZERO).move_mask() as u8
        };
        bits(&self.0[0]) | bits(&self.0[1]) << 4
    }
}

/// Which planes a vertex lies outside of.
#[inline]
fn outside_of<const N: usize>(vertex: &ClipVertex<N>, context: &Context<'_>) -> u8 {
    let position = vertex.position;
    match context.state.clip_test {
        _ if !position.is_finite() => NOWHERE,
        ClipTest::BeforeDivide => context.sides.outside(position),
        ClipTest::AfterDivide => context.sides.outside(position / position.w),
    }
}

impl Context<'_> {
    /// Where on the screen a vertex is, if it is near enough.
    fn place_of<const N: usize>(&self, vertex: &NdcVertex<N>) -> Option<Place> {
        snapped(self.viewport.pixel_areas(vertex.position)).map(|place| place.map(whole))
    }
}

/// A whole number of at most 31 bits and a sign, such as `snapped` gives (25 bits), as an integer.
///
/// One addition, where `as` asks first whether the number fits.
#[inline]
fn whole(number: f64) -> i32 {
    (number + NO_FRACTIONS).to_bits() as i32
}

fn write_record<const N: usize>(vertex: &NdcVertex<N>, interpolation: Interpolation, record: &mut [f32x8]) {
    let corner = EvenVaryings::<f32, N>::new(vertex, interpolation);
    let mut numbers = [corner.distance, corner.depth].into_iter().chain(corner.values);
    for block in record {
        *block = f32x8::new(from_fn(|_| numbers.next().unwrap_or(0.0)));
    }
}

// ANCHOR: assemble
/// Brings a triangle of the mesh into the bins: as it is, if it lies inside all planes, else in pieces.
fn assemble<S: Shader<N>, const N: usize>(
    vertices: &Vertices,
    chunk: &mut Chunk,
    number: usize,
    mesh: &Mesh<S::Attributes>,
    shader: &S,
    context: &Context<'_>,
) {
    let corners = mesh.triangle(number);
    let outside = corners.map(|corner| vertices.outside[corner]);
    let (any, all) = (outside[0] | outside[1] | outside[2], outside[0] & outside[1] & outside[2]);
    let beyond_a_plane = all & !(NOWHERE | BEYOND) != 0;
    if any == 0 {
        chunk.add(number as u32, corners.map(|corner| vertices.places[corner]), context);
    } else if any & NOWHERE == 0 && !beyond_a_plane {
        // Clipping is rare, and needs the vertex as it was: shade it once more.
        let triangle = corners.map(|corner| shader.vertex(&mesh.vertices()[corner]));
        let polygon = clip_triangle(triangle, &context.planes, context.state.clip_test);
        let divided: ArrayVec<NdcVertex<N>, 9> = polygon.into_iter().map(NdcVertex::from).collect();
        for piece in fan(divided) {
            chunk.add_piece(&piece, context);
        }
    }
}
// ANCHOR_END: assemble

impl Chunk {
    fn clear(&mut self, context: &Context<'_>) {
        self.bins.resize_with(context.tiles, Vec::new);
        self.bins.iter_mut().for_each(Vec::clear);
        self.extra.resize(0, context.blocks);
        self.has_large = false;
    }

    /// Adds a piece with vertices of its own.
    fn add_piece<const N: usize>(&mut self, piece: &[NdcVertex<N>; 3], context: &Context<'_>) {
        if piece.iter().all(is_in_guard_band) {
            self.add_vertices(piece, context);
        } else {
            for piece in fan(cut_to_guard_band(*piece)) {
                self.add_vertices(&piece, context);
            }
        }
    }

    fn add_vertices<const N: usize>(&mut self, piece: &[NdcVertex<N>; 3], context: &Context<'_>) {
        let first = self.extra.places.len();
        let [Some(a), Some(b), Some(c)] = piece.each_ref().map(|vertex| context.place_of(vertex)) else {
            return;
        };
        let places = [a, b, c];
        self.extra.resize(first + 3, context.blocks);
        for (i, vertex) in piece.iter().enumerate() {
            self.extra.places[first + i] = places[i];
            let record = (first + i) * context.blocks..(first + i + 1) * context.blocks;
            write_record(vertex, context.state.interpolation, &mut self.extra.records[record]);
        }
        self.add(EXTRA | (first / 3) as u32, places, context);
    }

    // ANCHOR: bin
    /// Puts a triangle into the bins of the tiles that its bounding box touches, if it is seen at all.
    ///
    /// Inlined, so that the places stay in registers: what turns away costs little else.
    #[inline(always)]
    fn add(&mut self, number: u32, places: [Place; 3], context: &Context<'_>) {
        let area = signed_area(places);
        let winding = if area > 0 { Winding::CounterClockwise } else { Winding::Clockwise };
        if area == 0 || context.state.cull.culls_winding(winding, context.state.front_face) {
            return;
        }
        let Some(Rect { left, bottom, right, top }) = shared(box_of(places), context.window) else { return };
        self.has_large |= right - left >= TILE_WIDTH && top - bottom >= TILE_HEIGHT;
        for row in bottom / TILE_HEIGHT..=(top - 1) / TILE_HEIGHT {
            for column in left / TILE_WIDTH..=(right - 1) / TILE_WIDTH {
                self.bins[row as usize * context.columns + column as usize].push(number);
            }
        }
    }
    // ANCHOR_END: bin
}

/// Twice the area of a triangle in 1/256 × 1/256 pixel, positive against the clock.
fn signed_area([a, b, c]: [Place; 3]) -> i64 {
    let difference = |to: Place, axis: usize| i64::from(to[axis]) - i64::from(a[axis]);
    difference(b, 0) * difference(c, 1) - difference(b, 1) * difference(c, 0)
}

/// The pixels whose centers lie in the bounding box of a triangle, in the picture or not.
///
/// As [`Coverage::bounding_box`](crate::edge::Coverage::bounding_box), but in the 32 bits that places have here: it is
/// asked for every triangle, and once more in each of its tiles.
#[inline(always)]
pub(super) fn box_of([a, b, c]: [Place; 3]) -> Rect {
    const PIXEL: i32 = SUBPIXELS as i32;
    let range = |axis: usize| {
        let (low, high) = (a[axis].min(b[axis]).min(c[axis]), a[axis].max(b[axis]).max(c[axis]));
        // The first center not below `low`, and the one after the last not above `high`; shifts round down.
        ((low + PIXEL / 2 - 1) >> 8, ((high - PIXEL / 2) >> 8) + 1)
    };
    let ((left, right), (bottom, top)) = (range(0), range(1));
    Rect { left, bottom, right, top }
}

/// Whether a rectangle is no larger than a square.
#[inline(always)]
pub(super) fn is_at_most(Rect { left, bottom, right, top }: Rect, side: i32) -> bool {
    right - left <= side && top - bottom <= side
}

/// What two rectangles share, if anything.
#[inline(always)]
pub(super) fn shared(a: Rect, b: Rect) -> Option<Rect> {
    let rect = Rect {
        left: a.left.max(b.left),
        bottom: a.bottom.max(b.bottom),
        right: a.right.min(b.right),
        top: a.top.min(b.top),
    };
    (rect.left < rect.right && rect.bottom < rect.top).then_some(rect)
}
#[cfg(test)]
mod tests {
    use super::whole;

    #[test]
    fn whole_numbers() {
        for number in [0.0, -0.0, 1.0, -1.0, 16_777_216.0, -16_777_216.0, 2_147_483_647.0, -2_147_483_648.0] {
            assert_eq!(whole(number), number as i32);
        }
    }
}
