//! The front end: from vertices to lists of triangles for each tile. All of it runs on all threads.

use std::ops::Range;

use arrayvec::ArrayVec;
use rayon::prelude::*;

use super::bands::{TILE_HEIGHT, TILE_WIDTH, tiles_of};
use super::instructions::Instructions;
use super::snapped::{SnappedPosition, box_of, shared, signed_area};
use super::vertices::{NOT_REPRESENTABLE, Projection, Triangle, Vertices};
use crate::area::Winding;
use crate::clip::{NdcVertex, clip_triangle, fan};
use crate::exact::{cut_to_guard_band, is_in_guard_band};
use crate::mesh::Mesh;
use crate::real::map3;
use crate::rect::Rect;
use crate::shader::Shader;
use crate::state::RenderState;

/// Where triangles come from.
pub(super) enum Source<'a, S: Shader<N>, const N: usize> {
    /// A mesh: all stages are still to be done.
    Mesh(&'a Mesh<S::Attributes>),
    /// Triangles that have been clipped and divided.
    Pieces(&'a [[NdcVertex<N>; 3]]),
}

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

/// What is the same for all triangles of a picture.
struct Context<'a> {
    projection: Projection<'a>,
    culls_clockwise: bool,
    culls_counterclockwise: bool,
    picture: Rect,
    columns: usize,
    tiles: usize,
}

impl Front {
    /// Sorts the triangles of a source into tiles.
    pub(super) fn prepare<S: Shader<N>, const N: usize>(
        &mut self,
        instructions: Instructions,
        source: &Source<'_, S, N>,
        shader: &S,
        state: &RenderState,
        picture: Rect,
    ) {
        let [columns, rows] = tiles_of(picture);
        let culls = |winding| state.cull.culls_winding(winding, state.front_face);
        let context = Context {
            projection: Projection::new(state, picture),
            culls_clockwise: culls(Winding::Clockwise),
            culls_counterclockwise: culls(Winding::CounterClockwise),
            picture,
            columns,
            tiles: columns * rows,
        };
        match source {
            Source::Mesh(mesh) => {
                self.vertices.shade(instructions, mesh, shader, &context.projection);
                self.bin(mesh.triangle_count(), &context, &|vertices, chunk, numbers| {
                    for number in numbers {
                        assemble(vertices, chunk, number, mesh, shader, &context);
                    }
                });
            }
            Source::Pieces(pieces) => {
                self.vertices.clear();
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
        match source {
            Source::Mesh(mesh) if number & EXTRA == 0 => {
                self.vertices.triangle::<N>(mesh.triangle(number as usize))
            }
            _ => {
                let first = 3 * (number & !EXTRA) as usize;
                chunk.extra.triangle::<N>([first, first + 1, first + 2])
            }
        }
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
    let triangle = mesh.triangle(number);
    let outside = vertices.outside(triangle);
    let (any, all) = (outside[0] | outside[1] | outside[2], outside[0] & outside[1] & outside[2]);
    let beyond_a_plane = context.projection.state.clip_test.keeps_sides() && all & !NOT_REPRESENTABLE != 0;
    if any == 0 {
        chunk.add(number as u32, vertices.positions(triangle), context);
    } else if !beyond_a_plane {
        let projection = &context.projection;
        // Clipping is rare, and needs the vertex as it was: shade it once more.
        let unclipped = map3(triangle, |vertex| shader.vertex(&mesh.vertices()[vertex]));
        let polygon = clip_triangle(unclipped, &projection.planes, projection.state.clip_test);
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
        self.extra.clear();
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
        let number = self.extra.triangle_count() as u32;
        if let Some(positions) = self.extra.push(piece, &context.projection) {
            self.add(EXTRA | number, positions, context);
        }
    }

    // ANCHOR: bin
    /// Puts a triangle into the bins of the tiles that its bounding box touches, if it is seen at all.
    ///
    /// Inlined, so that the positions stay in registers: what turns away costs little else.
    #[inline(always)]
    fn add(&mut self, number: u32, positions: [SnappedPosition; 3], context: &Context<'_>) {
        let area = signed_area(positions);
        let is_culled = if area > 0 { context.culls_counterclockwise } else { context.culls_clockwise };
        if area == 0 || is_culled {
            return;
        }
        let Some(Rect { left, bottom, right, top }) = shared(box_of(positions), context.picture) else {
            return;
        };
        self.has_large |= right - left >= TILE_WIDTH && top - bottom >= TILE_HEIGHT;
        for row in bottom / TILE_HEIGHT..=(top - 1) / TILE_HEIGHT {
            for column in left / TILE_WIDTH..=(right - 1) / TILE_WIDTH {
                self.bins[row as usize * context.columns + column as usize].push(number);
            }
        }
    }
    // ANCHOR_END: bin
}
