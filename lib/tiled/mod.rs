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
    /// If a pixel of the target has no depth: its plane of depths is smaller than that of colors. And where no thread can be
    /// started, as [`rayon::scope`] does: who has to draw there anyway makes a pool of the calling thread.
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

#[cfg(test)]
mod tests {
    use std::array::from_fn;

    use glam::{DVec4, dvec4};

    use super::bands::{TILE_HEIGHT, TILE_WIDTH};
    use super::*;
    use crate::area::Winding;
    use crate::clip::{ClipTest, ClipVertex, ClipVolume};
    use crate::color::Color;
    use crate::cull::CullMode;
    use crate::depth::{DepthEncoding, DepthTest};
    use crate::interpolate::Interpolation;
    use crate::merge::{Blend, Merge};
    use crate::real::Real;
    use crate::shader::Shaded;
    use crate::transform::Viewport;
    use crate::varyings::Derivatives;

    /// Colors that change from pixel to pixel, with holes and with opacities; by their slopes, or not.
    struct Patterned<const SLOPED: bool>;

    impl<const SLOPED: bool> Shader<3> for Patterned<SLOPED> {
        type Attributes = (DVec4, [f64; 3]);
        const IS_INLINED: bool = true;
        const USES_DERIVATIVES: bool = SLOPED;

        fn vertex(&self, &(position, varyings): &Self::Attributes) -> ClipVertex<3> {
            ClipVertex { position, varyings }
        }

        #[inline(always)]
        fn fragment<R: Real>(&self, [u, v, w]: [R; 3]) -> Shaded<R> {
            let stripe = u - u.floor();
            let color = [stripe * R::of(255.0), v * R::of(99.0), (w - u).max(R::of(0.0)) * R::of(300.0)];
            Shaded::translucent(color, stripe).discard(stripe.is_less(R::of(0.125)))
        }

        #[inline(always)]
        fn fragment_with_derivatives<R: Real>(
            &self,
            [u, v, w]: [R; 3],
            change: Derivatives<R, 3>,
        ) -> Shaded<R> {
            self.fragment([u, v + change.dx[0] * R::of(9.0), w - change.dy[1] * R::of(9.0)])
        }
    }

    /// Triangles of all sizes, on the screen, over its border and behind the eye; each shares an edge with the next one.
    fn scene(round: usize) -> Mesh<(DVec4, [f64; 3])> {
        let number = |i: usize| {
            let i = (i + 1000 * round) as f64;
            (i * i * 0.618_033_988_749_9).fract()
        };
        let vertex = |i: usize| {
            let [x, y, z, w, a, b, c] = from_fn(|k| number(7 * i + k));
            // Some strips are small, and some are very small.
            let size = [2.6, 0.3, 0.08][i / 5 % 3];
            let center = number(i / 5) - 0.5;
            let position = [(x - 0.5) * size + center, (y - 0.5) * size + center, z * 2.2 - 1.1];
            let w = if i.is_multiple_of(11) { -0.5 } else { w + 0.5 };
            let [x, y, z] = position.map(|along| along * w);
            (dvec4(x, y, z, w), [a, b, c].map(|value| 4.0 * value))
        };
        let triangles = (0..90).flat_map(|i| [i, i + 1, if i % 5 < 3 { i + 2 } else { i - 2 }]);
        // Seen from everywhere, though all of its vertices are too far away.
        let huge = [(-1e7, -1e7), (1e7, -1e7), (0.0, 1e7)].map(|(x, y)| (dvec4(x, y, 0.9, 1.0), [x, y, 1.5]));
        // Exactly where very small ones are already: of equal depths the later is seen.
        let again = (25..30).map(|i| (vertex(i).0, [0.6, 2.0, 3.0]));
        let vertices = (0..92).map(vertex).chain(huge).chain(again).collect();
        let more = [92, 93, 94, 95, 96, 97, 96, 97, 98, 97, 98, 99];
        Mesh::indexed(vertices, triangles.chain(more).collect()).expect("whole triangles")
    }

    fn states() -> Vec<RenderState> {
        let plain = RenderState { load: LoadOp::Clear, clear_color: Color::BLUE, ..RenderState::default() };
        let merge = |depth_test, depth_write, blend| Merge { depth_test, depth_write, blend };
        vec![
            plain,
            RenderState { load: LoadOp::Load, ..plain },
            RenderState { cull: CullMode::Back, clip_test: ClipTest::AfterDivide, ..plain },
            RenderState {
                cull: CullMode::Front,
                front_face: Winding::Clockwise,
                interpolation: Interpolation::Affine,
                ..plain
            },
            RenderState {
                merge: merge(DepthTest::Less, false, Blend::SourceOver),
                interpolation: Interpolation::Reciprocal,
                ..plain
            },
            RenderState {
                merge: merge(DepthTest::Greater, true, Blend::Additive),
                depth_encoding: DepthEncoding::Reciprocal,
                clear_depth: -9.0,
                ..plain
            },
            RenderState {
                merge: merge(DepthTest::Always, true, Blend::Opaque),
                depth_encoding: DepthEncoding::ViewZ,
                clip_volume: ClipVolume::InFront(0.1),
                viewport: Some(Viewport { x: 30.0, y: 5.5, width: 90.0, height: 60.0 }),
                ..plain
            },
        ]
    }

    fn assert_same(target: &Target<f32>, exact: &Target<f32>, what: &str) {
        for (x, y) in exact.color.rect().pixels() {
            assert_eq!(target.color.get(x, y), exact.color.get(x, y), "{what}: color at ({x}, {y})");
            let [this, that] = [target, exact].map(|it| it.depth.get(x, y).map(f32::to_bits));
            assert_eq!(this, that, "{what}: depth at ({x}, {y})");
        }
    }

    /// With all instructions of this processor: a mesh, twice with one `Tiled`, and triangles that others have clipped.
    fn compare<const SLOPED: bool>(state: &RenderState, round: usize) {
        // Two columns and three rows of tiles, which are not whole.
        let mut cleared = Target::<f32>::sized(131, 70);
        cleared.clear(Color::GREEN, 1.0);
        let (mesh, shader) = (scene(round), Patterned::<SLOPED>);
        let mut exact = cleared.clone();
        draw(&mesh, &shader, state, &Exact::<f32>::new(), &mut exact, &Silent);
        let drawn =
            exact.color.rect().pixels().filter(|&(x, y)| exact.color.get(x, y) != cleared.color.get(x, y));
        assert!(drawn.count() > 2000, "there is something to compare");
        for instructions in Instructions::available() {
            let tiled = Tiled::new().with_instructions(instructions);
            assert_eq!(tiled.instructions().to_string(), instructions.to_string());
            for what in ["a first picture", "a second one"] {
                let mut target = cleared.clone();
                tiled.draw_mesh(&mesh, &shader, state, &mut target);
                assert_same(&target, &exact, what);
            }
            let mut target = cleared.clone();
            draw(&mesh, &shader, state, &tiled, &mut target, &Silent);
            assert_same(&target, &exact, "triangles that others have clipped");
        }
    }

    #[test]
    fn tiled_draws_what_the_exact_rasterizer_draws() {
        for (round, state) in states().iter().enumerate() {
            compare::<false>(state, round);
            compare::<true>(state, round + 10);
        }
    }

    #[derive(Clone, Copy, Debug)]
    enum Holes {
        None,
        InEveryTile,
        /// Nothing is left of what is nearer than 0.
        InPlaceOfNear,
    }

    /// Layers that are larger than the view.
    fn layers(depths: &[f64], holes: Holes) -> Mesh<(DVec4, [f64; 3])> {
        let layer = |(i, &depth): (usize, &f64)| {
            [(-4.0, -4.0), (8.0, -4.0), (-4.0, 8.0)].map(|(x, y)| {
                let stripes = match holes {
                    Holes::InEveryTile => 6.0 * x + y + 7.0 * depth,
                    Holes::InPlaceOfNear if depth < 0.0 => 0.0,
                    _ => 0.5,
                };
                (dvec4(x, y, depth, 1.0), [stripes, i as f64 / 2.0, x * depth])
            })
        };
        Mesh::unindexed(depths.iter().enumerate().flat_map(layer).collect()).expect("whole triangles")
    }

    #[test]
    fn what_is_hidden_in_all_of_a_tile_shows_only_through_holes() {
        // Not clipped: the pieces would not cover those tiles through which they are cut.
        let (load, clip_volume) = (LoadOp::Clear, ClipVolume::Everything);
        let state = RenderState { load, clip_volume, ..RenderState::default() };
        let orders: [&[f64]; 3] = [&[-0.5, 0.1, 0.2, 0.6], &[0.6, -0.2, 0.1], &[0.3, 0.0, 0.0]];
        let holes = [Holes::None, Holes::InEveryTile, Holes::InPlaceOfNear];
        for (depths, holes) in orders.into_iter().flat_map(|depths| holes.map(|holes| (depths, holes))) {
            let mesh = layers(depths, holes);
            let mut exact = Target::<f32>::sized(300, 70);
            draw(&mesh, &Patterned::<false>, &state, &Exact::<f32>::new(), &mut exact, &Silent);
            for instructions in Instructions::available() {
                let mut target = Target::<f32>::sized(300, 70);
                let tiled = Tiled::new().with_instructions(instructions);
                tiled.draw_mesh(&mesh, &Patterned::<false>, &state, &mut target);
                assert_same(&target, &exact, &format!("{depths:?}, holes: {holes:?}"));
            }
        }
    }

    #[test]
    #[cfg_attr(all(target_arch = "wasm32", not(target_feature = "simd128")), ignore = "`Exact` draws")]
    fn the_tiles_of_a_triangle_are_those_of_its_box() {
        // Three columns and three rows of tiles.
        let (width, height) = (3 * TILE_WIDTH, 3 * TILE_HEIGHT);
        let tiled = Tiled::new();
        let mut target = Target::<f32>::sized(width as u32, height as u32);
        let mut touched = |left: f64, bottom: f64, right: f64, top: f64| {
            let vertices = [(left, bottom), (right, bottom), (left, top)].map(|(x, y)| {
                let (x, y) = (x / f64::from(width) * 2.0 - 1.0, y / f64::from(height) * 2.0 - 1.0);
                (dvec4(x, y, 0.0, 1.0), [0.5; 3])
            });
            let mesh = Mesh::unindexed(vertices.to_vec()).expect("a triangle");
            tiled.draw_mesh(&mesh, &Patterned::<false>, &RenderState::default(), &mut target);
            let front = tiled.front.lock().expect("not poisoned");
            let touched: Vec<usize> = (0..9).filter(|&tile| !front.is_empty(tile)).collect();
            (touched, front.has_large_triangles())
        };
        // Large ones cover a tile, or might.
        assert_eq!(touched(0.0, 0.0, 128.0, 32.0), (vec![0], true));
        assert_eq!(touched(0.0, 0.0, 127.0, 32.0), (vec![0], false));
        assert_eq!(touched(0.0, 0.0, 128.0, 31.0), (vec![0], false));
        assert_eq!(touched(130.0, 40.0, 250.0, 60.0), (vec![4], false));
        assert_eq!(touched(10.0, 33.0, 380.0, 60.0), (vec![3, 4, 5], false));
        assert_eq!(touched(130.0, 1.0, 200.0, 95.0), (vec![1, 4, 7], false));
        assert_eq!(touched(-900.0, -900.0, 2000.0, 2000.0), ((0..9).collect(), true));
    }

    #[test]
    fn a_rasterizer_by_itself_does_not_clear() {
        let state = RenderState { load: LoadOp::Clear, ..RenderState::default() };
        let mut target = Target::<f32>::sized(131, 70);
        target.clear(Color::GREEN, 0.5);
        let mut exact = target.clone();
        let triangles = || {
            let vertices = [[-0.5, -0.5], [0.5, -0.5], [0.0, 0.5]]
                .map(|[x, y]| ClipVertex { position: dvec4(x, y, 0.0, 1.0), varyings: [0.3, 1.0, 2.0] });
            std::iter::once(vertices.map(NdcVertex::from))
        };
        Tiled::new().draw(triangles(), &state, &Patterned::<false>, &mut target, &Silent);
        Exact::<f32>::new().draw(triangles(), &state, &Patterned::<false>, &mut exact, &Silent);
        assert_eq!(target.color.get(0, 0), Some(Color::GREEN));
        assert_same(&target, &exact, "one triangle");
    }

    /// What is blank is not cleared again.
    #[test]
    fn pictures_follow_one_another_on_one_target() {
        let state = |clear_color, clear_depth| RenderState {
            load: LoadOp::Clear,
            clear_color,
            clear_depth,
            ..RenderState::default()
        };
        let (blue, green, deep) =
            (state(Color::BLUE, 1.0), state(Color::GREEN, 1.0), state(Color::GREEN, 2.0));
        // Four columns and four rows of tiles, or one and three; some beside and some above the ones before.
        let triangle = |[x, y]: [f64; 2]| {
            let vertices = [(-0.1, -0.1), (0.1, -0.1), (0.0, 0.2)];
            vertices.map(|(dx, dy)| (dvec4(x + dx, y + dy, 0.5, 1.0), [0.3, 1.0, 2.0]))
        };
        let pictures: [(RenderState, &[[f64; 2]]); 7] = [
            (blue, &[[-0.8, -0.8], [0.8, 0.6]]),
            (blue, &[[0.8, -0.8]]),
            (blue, &[[-0.8, 0.1], [-0.2, -0.4], [0.3, 0.6]]),
            (green, &[]),
            (green, &[[0.8, 0.1], [0.8, 0.6]]),
            (deep, &[[-0.2, -0.8]]),
            (deep, &[]),
        ];
        let cases = Instructions::available().flat_map(|it| [(it, (400, 100)), (it, (100, 70))]);
        for (instructions, (width, height)) in cases {
            let tiled = Tiled::new().with_instructions(instructions);
            let mut target = Target::<f32>::sized(width, height);
            for (state, places) in pictures {
                let vertices = places.iter().copied().flat_map(triangle).collect();
                let mesh = Mesh::unindexed(vertices).expect("whole triangles");
                let mut exact = Target::<f32>::sized(width, height);
                draw(&mesh, &Patterned::<false>, &state, &Exact::<f32>::new(), &mut exact, &Silent);
                tiled.draw_mesh(&mesh, &Patterned::<false>, &state, &mut target);
                assert_same(&target, &exact, "one after the other");
            }
        }
    }
}
