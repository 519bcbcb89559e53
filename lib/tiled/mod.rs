//! Beyond the book: the fast rasterizer. What [`Exact`] draws in `f32`, to the last bit, in a
//! fraction of the time.
//!
//! Nine things make the difference: eight fragments are shaded at a time ([`lanes`]); every vertex is
//! made ready once, however many triangles share it (`vertices.rs`), and triangles that turn away are gone before anything
//! is computed for them (`front.rs`); triangles are sorted into *tiles*, rectangles of the picture that are small enough to
//! stay near, and a row of tiles belongs to one thread (`front.rs`); within a tile, the covered part of a row is known by
//! its ends (`edges.rs`), and values go on linearly from its first pixel (`packed.rs`); triangles that cover only a few
//! pixels share the eight lanes with others (`tile.rs`); what is hidden in all of a tile is left out there
//! (`occlusion.rs`); what is blank is not cleared again (`background.rs`); while pixels are drawn, others that are soon
//! cleared are fetched (`tile.rs`); and all of this is compiled twice, for any processor and for those with AVX2
//! ([`Instructions`]).
//!
//! ```text
//!   vertices ──► shaded, divided, ──► triangles: culled, ──► bins: for each tile, ──► tiles: coverage, depth,
//!                snapped once         clipped if need be     which triangles         eight fragments at a time
//!   (all threads)                     (all threads)                                   (all threads, rows of tiles)
//! ```
//!
//! Within a tile triangles keep their order: the picture does not depend on the number of threads, which is that of the
//! `rayon` pool in which it is called. A thread outside of the pool must wake one of the pool's for each picture: a tenth
//! of the time of a small one. `ThreadPool::install` around the loop avoids it, and so does a pool that is built with
//! `ThreadPoolBuilder::use_current_thread`.
//!
//! AVX2 is used where a program finds it, if the shader says [`Shader::IS_INLINED`] and the options for pixels are the default
//! ones.
//!
//! ```
//! use glam::{DVec4, dvec4};
//! use rasterbook::tiled::Tiled;
//! use rasterbook::{ClipVertex, Color, LoadOp, Mesh, Real, RenderState, Shaded, Shader, Target};
//!
//! struct Red;
//!
//! impl Shader<0> for Red {
//!     type Attributes = DVec4;
//!     fn vertex(&self, clip: &DVec4) -> ClipVertex<0> {
//!         ClipVertex { position: *clip, varyings: [] }
//!     }
//!     fn fragment<R: Real>(&self, _: [R; 0]) -> Shaded<R> {
//!         Shaded::opaque([255.0, 0.0, 0.0].map(R::of))
//!     }
//! }
//!
//! let mesh = Mesh::unindexed(vec![dvec4(-1.0, -1.0, 0.0, 1.0), dvec4(3.0, -1.0, 0.0, 1.0), dvec4(-1.0, 3.0, 0.0, 1.0)])?;
//! let state = RenderState { load: LoadOp::Clear, ..RenderState::default() };
//! let mut target = Target::<f32>::sized(640, 480);
//! Tiled::new().draw_mesh(&mesh, &Red, &state, &mut target);
//! assert_eq!(target.color.get(639, 479), Some(Color::RED));
//! # Ok::<(), rasterbook::mesh::MeshError>(())
//! ```
//!
//! Sources: J. Pineda, A parallel algorithm for polygon rasterization, 1988; M. Abrash, Rasterization on Larrabee, 2009;
//! S. Laine and T. Karras, High-performance software rasterization on GPUs, 2011; N. Greene, M. Kass and G. Miller,
//! Hierarchical Z-buffer visibility, 1993.

#[cfg(all(target_arch = "x86_64", not(target_feature = "avx2")))]
mod avx2;
mod background;
mod bands;
mod baseline;
mod edges;
mod frame;
mod front;
mod instruction_set;
mod instructions;
pub mod lanes;
mod occlusion;
mod packed;
mod snapped;
mod tile;
mod vertices;

use std::sync::Mutex;
use std::sync::atomic::AtomicBool;

use crate::clip::NdcVertex;
use crate::exact::Exact;
use crate::mesh::Mesh;
use crate::pipeline::draw;
use crate::probe::{Probe, Silent};
use crate::raster::Rasterizer;
use crate::rect::Rect;
use crate::shader::Shader;
use crate::state::{LoadOp, RenderState};
use crate::target::Target;

use background::Background;
use bands::{Band, each_band, tiles_of};
use baseline::Baseline;
use frame::{Frame, is_plain};
use front::{Front, Source};
use instruction_set::InstructionSet;
#[cfg(all(target_arch = "x86_64", not(target_feature = "avx2")))]
use instructions::Compiled;
use tile::Tile;

pub use instructions::Instructions;

/// The fast rasterizer. It keeps its working memory from picture to picture: make one and use it again.
///
/// Computes in `f32`. A mesh is drawn by [`Self::draw_mesh`]; as a [`Rasterizer`] it takes triangles that others have
/// shaded and clipped, and is not as fast. It reports nothing: [`Exact`] draws the same and does.
#[derive(Debug, Default)]
pub struct Tiled {
    instructions: Instructions,
    front: Mutex<Front>,
}

impl Tiled {
    /// The rasterizer, without working memory yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// The same, but drawn with these instructions.
    #[must_use]
    pub fn with_instructions(self, instructions: Instructions) -> Self {
        Self { instructions, ..self }
    }

    /// Which instructions it draws with: the best that this processor has, unless others were asked for.
    #[must_use]
    pub const fn instructions(&self) -> Instructions {
        self.instructions
    }

    // ANCHOR: draw_mesh
    /// Draws a mesh into a target: all stages of the pipeline, and the load operation. The picture is that of
    /// [`draw`] with [`Exact<f32>`](crate::exact::Exact), to the last bit (but for what is not a number: there are
    /// many ways to write it, and a stored depth may be another one of them).
    ///
    /// # Panics
    /// If a pixel of the target has no depth: its plane of depths is smaller than that of colors.
    pub fn draw_mesh<S: Shader<N>, const N: usize>(
        &self,
        mesh: &Mesh<S::Attributes>,
        shader: &S,
        state: &RenderState,
        target: &mut Target<f32>,
    ) {
        if HAS_NO_LANES {
            return draw(mesh, shader, state, &Exact::<f32>::new(), target, &Silent);
        }
        self.draw_source(&Source::Mesh(mesh), shader, state, target);
    }
    // ANCHOR_END: draw_mesh

    fn draw_source<S: Shader<N>, const N: usize>(
        &self,
        source: &Source<'_, S, N>,
        shader: &S,
        state: &RenderState,
        target: &mut Target<f32>,
    ) {
        target.assert_depths();
        let picture = target.color.rect();
        // Two pictures at a time do not share working memory.
        let mut own = Front::default();
        let mut shared = self.front.try_lock();
        let front = shared.as_deref_mut().unwrap_or(&mut own);
        // Into the pool once, not once for each of the steps.
        in_pool(&mut || {
            front.prepare(self.instructions, source, shader, state, picture);
            let frame = Frame {
                shader,
                state,
                is_plain: is_plain(state),
                front,
                source,
                columns: picture.right,
                discards: AtomicBool::new(false),
            };
            // ANCHOR: dispatch
            match self.instructions.0 {
                #[cfg(all(target_arch = "x86_64", not(target_feature = "avx2")))]
                Compiled::Avx2(avx2) if S::IS_INLINED && frame.is_plain => {
                    draw_tiles(avx2, &frame, picture, target);
                }
                _ => draw_tiles(Baseline, &frame, picture, target),
            }
            // ANCHOR_END: dispatch
        });
    }
}

/// Whether lanes are computed one by one: in WebAssembly without `simd128`. Then [`Exact`] draws the same picture in half of
/// the time.
const HAS_NO_LANES: bool = cfg!(all(target_arch = "wasm32", not(target_feature = "simd128")));

/// Lets a thread of the pool do some work.
///
/// This and the other ways to the threads know nothing of shaders: so they are compiled once, and not for each of them.
fn in_pool(work: &mut (dyn FnMut() + Send)) {
    rayon::scope(|_| work());
}

// ANCHOR: tiles
/// Draws all tiles, those of several bands at a time.
fn draw_tiles<I: InstructionSet, S: Shader<N>, const N: usize>(
    instructions: I,
    frame: &Frame<'_, S, N>,
    picture: Rect,
    target: &mut Target<f32>,
) {
    let [columns, rows] = tiles_of(picture);
    let (colors, depths) = (target.color.plane_mut(), target.depth.plane_mut());
    let background = Background::take(frame.state, picture, colors, depths);
    each_band(picture, colors, depths, &|row, mut band| {
        // Here and not before: what was just written is still near when the tiles come.
        background.clear(&mut band, row * columns);
        band.with_room(|band| draw_band(instructions, frame, band, row * columns));
    });
    background.put_back(colors, depths, columns * rows, &|tile| frame.front.is_empty(tile));
}

/// Draws the tiles of a band, which are numbered from `first` on.
fn draw_band<I: InstructionSet, S: Shader<N>, const N: usize>(
    instructions: I,
    frame: &Frame<'_, S, N>,
    band: Band<'_>,
    first: usize,
) {
    let tiles = band.tiles(first);
    let mut tile = Tile::new(instructions, band);
    for (number, rect) in tiles {
        if !frame.front.is_empty(number) {
            tile.draw(frame, number, rect);
        }
    }
}
// ANCHOR_END: tiles

impl Rasterizer for Tiled {
    type Depth = f32;

    fn draw<S: Shader<N>, P: Probe + ?Sized, const N: usize>(
        &self,
        triangles: impl Iterator<Item = [NdcVertex<N>; 3]>,
        state: &RenderState,
        shader: &S,
        target: &mut Target<f32>,
        probe: &P,
    ) {
        if HAS_NO_LANES {
            return Exact::<f32>::new().draw(triangles, state, shader, target, probe);
        }
        let pieces: Vec<[NdcVertex<N>; 3]> = triangles.collect();
        // Clearing belongs to those who draw a whole mesh.
        let state = RenderState { load: LoadOp::Load, ..*state };
        self.draw_source(&Source::Pieces(&pieces), shader, &state, target);
    }
}
