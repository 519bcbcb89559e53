//! Beyond the book: the fast rasterizer. What [`Exact`](crate::exact::Exact) draws in `f32`, to the last bit, in a
//! fraction of the time.
//!
//! Eight things make the difference: eight fragments are shaded at a time ([`lanes`](crate::lanes)); every vertex is
//! made ready once, however many triangles share it (`vertices.rs`), and triangles that turn away are gone before anything
//! is reckoned for them (`front.rs`); triangles are sorted into *tiles*, rectangles of the picture that are small enough to
//! stay near, and a row of tiles belongs to one thread (`front.rs`); within a tile, the covered part of a row is known by
//! its ends (`edges.rs`), and values go on evenly from its first pixel (`record.rs`); triangles that cover only a few
//! pixels share the eight lanes with others (`tile.rs`); what is hidden in all of a tile is left out there
//! (`occlusion.rs`); what is blank is not cleared again (`background.rs`); and while pixels are drawn, others that are soon
//! cleared are fetched (`tile.rs`).
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
//! ```
//! use glam::{DVec4, dvec4};
//! use rasterbook::Color;
//! use rasterbook::clip::ClipVertex;
//! use rasterbook::depth::Target;
//! use rasterbook::mesh::Mesh;
//! use rasterbook::pipeline::{LoadOp, RenderState, draw};
//! use rasterbook::probe::Silent;
//! use rasterbook::real::Real;
//! use rasterbook::shader::{Shaded, Shader};
//! use rasterbook::tiled::Tiled;
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
//! draw(&mesh, &Red, &state, &Tiled::new(), &mut target, &Silent);
//! assert_eq!(target.color.get(639, 479), Some(Color::RED));
//! # Ok::<(), rasterbook::mesh::MeshError>(())
//! ```
//!
//! Sources: J. Pineda, A parallel algorithm for polygon rasterization, 1988; M. Abrash, Rasterization on Larrabee, 2009;
//! S. Laine and T. Karras, High-performance software rasterization on GPUs, 2011; N. Greene, M. Kass and G. Miller,
//! Hierarchical Z-buffer visibility, 1993.

mod background;
mod edges;
mod front;
mod occlusion;
mod record;
mod tile;
mod vertices;

use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::AtomicBool;

use rayon::prelude::*;

use crate::clip::NdcVertex;
use crate::depth::Target;
use crate::lanes::LANES;
use crate::mesh::Mesh;
use crate::pipeline::{LoadOp, RenderState};
use crate::probe::Probe;
use crate::raster::Rasterizer;
use crate::shader::Shader;
use crate::{Color, Rect};

use background::Background;
use front::{Front, Source};
use tile::{Frame, Tile};

/// The width of a tile in pixels.
const TILE_WIDTH: i32 = 128;
/// The height of a tile in pixels.
const TILE_HEIGHT: i32 = 32;

/// The fast rasterizer. It keeps its working memory from picture to picture: make one and use it again.
///
/// Computes in `f32`. Probes hear nothing of it: [`Exact`](crate::exact::Exact) draws the same and tells.
#[derive(Debug, Default)]
pub struct Tiled {
    front: Mutex<Front>,
}

impl Tiled {
    /// The rasterizer, without working memory yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    fn draw_source<S: Shader<N>, const N: usize>(
        &self,
        source: &Source<'_, S, N>,
        shader: &S,
        state: &RenderState,
        target: &mut Target<f32>,
    ) {
        let window = target.color.rect();
        // Two pictures at a time do not share working memory.
        let mut own = Front::default();
        let mut shared = self.front.try_lock();
        let front = shared.as_deref_mut().unwrap_or(&mut own);
        // Into the pool once, not once for each of the steps.
        in_pool(&mut || {
            front.prepare(source, shader, state, window);
            let frame = Frame {
                shader,
                state,
                is_plain: tile::is_plain(state),
                front,
                source,
                columns: window.right,
                discards: AtomicBool::new(false),
            };
            draw_tiles(&frame, window, target);
        });
    }
}

/// Lets a thread of the pool do some work.
///
/// This and the other ways to the threads know nothing of shaders: so they are compiled once, and not for each of them.
fn in_pool(work: &mut (dyn FnMut() + Send)) {
    rayon::scope(|_| work());
}

/// How many columns and rows of tiles a picture has.
fn tiles_of(window: Rect) -> [usize; 2] {
    [(window.right, TILE_WIDTH), (window.top, TILE_HEIGHT)]
        .map(|(pixels, side)| (pixels as usize).div_ceil(side as usize))
}

// ANCHOR: tiles
/// Draws all tiles, those of several bands at a time.
fn draw_tiles<S: Shader<N>, const N: usize>(frame: &Frame<'_, S, N>, window: Rect, target: &mut Target<f32>) {
    let [columns, rows] = tiles_of(window);
    let (colors, depths) = (target.color.plane_mut(), target.depth.plane_mut());
    let background = Background::take(frame.state, window, colors, depths);
    each_band(window, colors, depths, &|row, mut band| {
        // Here and not before: what was just written is still near when the tiles come.
        background.clear(&mut band, row * columns);
        band.with_room(|band| band.draw(frame, row * columns));
    });
    background.put_back(colors, depths, columns * rows, &|tile| frame.front.is_empty(tile));
}

/// Hands a picture out in bands, counted from below, each a part that belongs to one thread alone.
fn each_band(
    window: Rect,
    colors: &mut [Color],
    depths: &mut [f32],
    draw: &(dyn Fn(usize, Band<'_>) + Sync),
) {
    let width = window.right as usize;
    let pixels = width * TILE_HEIGHT as usize;
    let bands = colors.par_chunks_mut(pixels).zip(depths.par_chunks_mut(pixels)).enumerate();
    bands.for_each(|(row, (colors, depths))| {
        let bottom = row as i32 * TILE_HEIGHT;
        let rect = Rect { bottom, top: (bottom + TILE_HEIGHT).min(window.top), ..window };
        draw(row, Band { rect, stride: width, to_next_band: pixels, colors, depths });
    });
}

/// The rows of a picture in which a row of tiles lies, or a copy of them if they are very short.
struct Band<'a> {
    /// Its lower left pixel is the first of colors and depths.
    rect: Rect,
    /// How many pixels there are from one row to the next.
    stride: usize,
    /// How many there are to the same place of the next band; 0 in a copy, for which nothing is fetched ahead.
    to_next_band: usize,
    colors: &'a mut [Color],
    depths: &'a mut [f32],
}

impl Band<'_> {
    /// Its tiles from left to right, numbered from `first` on.
    fn tiles(&self, first: usize) -> impl Iterator<Item = (usize, Rect)> + use<> {
        let band = self.rect;
        let lefts = band.columns().step_by(TILE_WIDTH as usize);
        let rects = lefts.map(move |left| Rect { left, right: (left + TILE_WIDTH).min(band.right), ..band });
        (first..).zip(rects)
    }

    /// Draws its tiles.
    fn draw<S: Shader<N>, const N: usize>(self, frame: &Frame<'_, S, N>, first: usize) {
        let tiles = self.tiles(first);
        let mut tile = Tile::new(self);
        for (number, rect) in tiles {
            if !frame.front.is_empty(number) {
                tile.draw(frame, number, rect);
            }
        }
    }
}
// ANCHOR_END: tiles

impl Band<'_> {
    /// Lets it be drawn: where it is, or in a copy if it has no room for a group of eight pixels.
    fn with_room(self, draw: impl FnOnce(Band<'_>)) {
        let count = self.colors.len();
        if count >= LANES {
            return draw(self);
        }
        let (mut colors, mut depths) = ([Color::BLACK; LANES], [0.0; LANES]);
        colors[..count].copy_from_slice(self.colors);
        depths[..count].copy_from_slice(self.depths);
        draw(Band { to_next_band: 0, colors: &mut colors, depths: &mut depths, ..self });
        self.colors.copy_from_slice(&colors[..count]);
        self.depths.copy_from_slice(&depths[..count]);
    }

    /// Where in the band a pixel stands.
    fn place(&self, [x, y]: [i32; 2]) -> usize {
        (y - self.rect.bottom) as usize * self.stride + (x - self.rect.left) as usize
    }

    /// Where the rows of a rectangle stand.
    fn places(&self, rect: Rect) -> impl Iterator<Item = Range<usize>> + Clone + use<> {
        let (first, stride) = (self.place([rect.left, rect.bottom]), self.stride);
        (0..rect.rows().len()).map(move |row| {
            let start = first + row * stride;
            start..start + rect.columns().len()
        })
    }
}

impl Rasterizer for Tiled {
    type Depth = f32;

    fn draw<S: Shader<N>, P: Probe + ?Sized, const N: usize>(
        &self,
        triangles: impl Iterator<Item = [NdcVertex<N>; 3]>,
        state: &RenderState,
        shader: &S,
        target: &mut Target<f32>,
        _: &P,
    ) {
        let pieces: Vec<[NdcVertex<N>; 3]> = triangles.collect();
        // Clearing belongs to whoever draws a whole mesh.
        let state = RenderState { load: LoadOp::Load, ..*state };
        self.draw_source(&Source::Pieces(&pieces), shader, &state, target);
    }

    fn draw_mesh<S: Shader<N>, const N: usize>(
        &self,
        mesh: &Mesh<S::Attributes>,
        shader: &S,
        state: &RenderState,
        target: &mut Target<f32>,
    ) -> bool {
        self.draw_source(&Source::Mesh(mesh), shader, state, target);
        true
    }
}
