//! Our rasterizers, ready to be measured. Another one is a line in [`RASTERIZERS`].

use std::array::from_fn;

use arrayvec::ArrayVec;
use glam::{DMat4, DVec4, Vec3, dvec4};
use rasterbook::clip::{MAX_VERTICES, NdcVertex, clip_triangle, fan};
use rasterbook::cull::CullMode;
use rasterbook::exact::Exact;
use rasterbook::light::lambert;
use rasterbook::probe::Probe;
use rasterbook::raster::Rasterizer;
use rasterbook::real::{Mask, Scalar};
use rasterbook::texture::{AddressMode, Texture};
use rasterbook::tiled::{Instructions, Tiled};
use rasterbook::transform::Viewport;
use rasterbook::{
    ClipVertex, Color, LoadOp, Mesh, Real, RenderState, Scanline, Shaded, Shader, Silent, Target, draw,
};

use crate::scenes::{AMBIENT, Scene, TEXTURE_SIDE, TO_LIGHT, Vertex, texels};

/// Something that draws a scene again and again.
pub(crate) trait Frame {
    /// Clears and draws, until all pixels are in memory.
    fn draw(&mut self);
    /// What was drawn last: the channels of all pixels, the lowest row first.
    fn picture(&mut self) -> Vec<[u8; 3]>;
}

/// One of our rasterizers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ours {
    /// As tables call it.
    pub(crate) name: &'static str,
    /// How many threads it can use.
    pub(crate) threads: Threads,
    /// Which pixels it covers.
    pub(crate) coverage: Coverage,
    /// Makes a scene ready to be drawn.
    pub(crate) prepare: fn(Scene) -> Box<dyn Frame + Send>,
    /// Makes a scene ready to be drawn stage by stage.
    pub(crate) stages: fn(Scene) -> Box<dyn Stages + Send>,
}

/// How many threads a renderer can use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Threads {
    /// The caller's.
    One,
    /// As many as its pool has.
    Many,
}

/// Which pixels a renderer covers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Coverage {
    /// Those that the graphics standards prescribe.
    Exact,
    /// Nearly those.
    Near,
}

/// A rasterizer, and the way in which it draws a whole mesh.
trait Contestant: Rasterizer + Default + Send + 'static {
    fn draw_mesh<S: Shader<N>, const N: usize>(
        &self,
        mesh: &Mesh<S::Attributes>,
        shader: &S,
        state: &RenderState,
        target: &mut Target<Self::Depth>,
    ) {
        draw(mesh, shader, state, self, target, &Silent);
    }
}

impl Contestant for Scanline {}
impl Contestant for Exact<f64> {}
impl Contestant for Exact<f32> {}

impl Contestant for Tiled {
    fn draw_mesh<S: Shader<N>, const N: usize>(
        &self,
        mesh: &Mesh<S::Attributes>,
        shader: &S,
        state: &RenderState,
        target: &mut Target<f32>,
    ) {
        Self::draw_mesh(self, mesh, shader, state, target);
    }
}

/// `tiled` with no better instructions than those that all of the program is compiled for.
struct TiledBaseline(Tiled);

impl Default for TiledBaseline {
    fn default() -> Self {
        Self(Tiled::new().with_instructions(Instructions::baseline()))
    }
}

impl Rasterizer for TiledBaseline {
    type Depth = f32;

    fn draw<S: Shader<N>, P: Probe + ?Sized, const N: usize>(
        &self,
        triangles: impl Iterator<Item = [NdcVertex<N>; 3]>,
        state: &RenderState,
        shader: &S,
        target: &mut Target<f32>,
        probe: &P,
    ) {
        self.0.draw(triangles, state, shader, target, probe);
    }
}

impl Contestant for TiledBaseline {
    fn draw_mesh<S: Shader<N>, const N: usize>(
        &self,
        mesh: &Mesh<S::Attributes>,
        shader: &S,
        state: &RenderState,
        target: &mut Target<f32>,
    ) {
        self.0.draw_mesh(mesh, shader, state, target);
    }
}

const fn ours<Z: Contestant>(name: &'static str, threads: Threads, coverage: Coverage) -> Ours
where
    Z::Depth: Send,
{
    Ours { name, threads, coverage, prepare: prepare::<Z>, stages: stages::<Z> }
}

/// The table of our rasterizers.
pub(crate) const RASTERIZERS: [Ours; 5] = [
    ours::<Scanline>("scanline", Threads::One, Coverage::Near),
    ours::<Exact<f64>>("exact-f64", Threads::One, Coverage::Exact),
    ours::<Exact<f32>>("exact-f32", Threads::One, Coverage::Exact),
    ours::<Tiled>("tiled", Threads::Many, Coverage::Exact),
    ours::<TiledBaseline>("tiled-baseline", Threads::Many, Coverage::Exact),
];

/// How all scenes are drawn.
fn state() -> RenderState {
    RenderState { cull: CullMode::Back, load: LoadOp::Clear, ..RenderState::default() }
}

/// The shaders' uniforms.
#[derive(Clone, Debug)]
struct Uniforms {
    clip_from_view: DMat4,
    texture: Texture,
}

impl Uniforms {
    fn new(scene: &Scene) -> Self {
        let rows = scene.clip_from_view.map(|row| row.map(f64::from));
        let texels = texels().into_iter().map(|[r, g, b]| Color::rgb(r, g, b)).collect();
        Self {
            clip_from_view: DMat4::from_cols_array_2d(&rows).transpose(),
            texture: Texture::new(TEXTURE_SIDE, TEXTURE_SIDE, texels),
        }
    }

    fn project(&self, vertex: &Vertex) -> DVec4 {
        self.clip_from_view * Vec3::from(vertex.position).as_dvec3().extend(1.0)
    }
}

/// The texel.
#[derive(Clone, Debug)]
struct Unlit(Uniforms);

impl Unlit {
    fn new(scene: &Scene) -> Self {
        Self(Uniforms::new(scene))
    }
}

impl Shader<2> for Unlit {
    type Attributes = Vertex;
    const IS_INLINED: bool = true;

    fn vertex(&self, vertex: &Vertex) -> ClipVertex<2> {
        ClipVertex { position: self.0.project(vertex), varyings: vertex.uv.map(f64::from) }
    }

    #[inline(always)]
    fn fragment<R: Real>(&self, uv: [R; 2]) -> Shaded<R> {
        Shaded::texel(self.0.texture.nearest_texel(uv, AddressMode::Repeat))
    }
}

/// Diffuse light on the texel.
#[derive(Clone, Debug)]
struct Lit(Uniforms);

impl Lit {
    fn new(scene: &Scene) -> Self {
        Self(Uniforms::new(scene))
    }
}

impl Shader<5> for Lit {
    type Attributes = Vertex;
    const IS_INLINED: bool = true;

    fn vertex(&self, vertex: &Vertex) -> ClipVertex<5> {
        let ([u, v], [x, y, z]) = (vertex.uv, vertex.normal);
        ClipVertex { position: self.0.project(vertex), varyings: [u, v, x, y, z].map(f64::from) }
    }

    #[inline(always)]
    fn fragment<R: Real>(&self, [u, v, x, y, z]: [R; 5]) -> Shaded<R> {
        let diffuse = lambert([x, y, z], [R::from(TO_LIGHT[0]), R::from(TO_LIGHT[1]), R::from(TO_LIGHT[2])]);
        let brightness = (diffuse + R::of(f64::from(AMBIENT))).min(R::of(1.0));
        let texel = self.0.texture.nearest([u, v], AddressMode::Repeat);
        let [red, green, blue] = texel;
        Shaded::opaque([brightness * red, brightness * green, brightness * blue])
    }
}

/// The scene's triangles.
fn mesh(scene: Scene) -> Mesh<Vertex> {
    Mesh::indexed(scene.vertices, scene.indices).expect("every index names a vertex of the scene")
}

/// Makes a target as it is before a frame.
fn clear<D: Scalar>(target: &mut Target<D>, state: &RenderState) {
    target.clear(state.clear_color, D::of(state.clear_depth));
}

/// A scene, a shader for it and a rasterizer.
struct Prepared<Z: Rasterizer, S, const N: usize> {
    rasterizer: Z,
    shader: S,
    mesh: Mesh<Vertex>,
    state: RenderState,
    target: Target<Z::Depth>,
}

impl<Z: Contestant, S, const N: usize> Prepared<Z, S, N> {
    fn new(shader: S, scene: Scene) -> Self {
        let [width, height] = scene.size;
        let target = Target::sized(width, height);
        Self { rasterizer: Z::default(), shader, mesh: mesh(scene), state: state(), target }
    }
}

fn prepare<Z: Contestant>(scene: Scene) -> Box<dyn Frame + Send>
where
    Z::Depth: Send,
{
    if scene.is_lit {
        Box::new(Prepared::<Z, Lit, 5>::new(Lit::new(&scene), scene))
    } else {
        Box::new(Prepared::<Z, Unlit, 2>::new(Unlit::new(&scene), scene))
    }
}

impl<Z: Contestant, S, const N: usize> Frame for Prepared<Z, S, N>
where
    S: Shader<N, Attributes = Vertex> + Sync,
{
    fn draw(&mut self) {
        self.rasterizer.draw_mesh(&self.mesh, &self.shader, &self.state, &mut self.target);
    }

    fn picture(&mut self) -> Vec<[u8; 3]> {
        let picture = &self.target.color;
        let pixels = picture.rect().pixels();
        pixels.map(|(x, y)| picture.get(x, y).unwrap_or_default().channels()).collect()
    }
}

/// What can be done alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stage {
    /// All pixels get the background's color and depth.
    Clear,
    /// The vertex shader.
    Vertex,
    /// Assembly, clipping and the divide.
    Clip,
    /// What a rasterizer does once a triangle: it draws onto a target of one pixel.
    Setup,
    /// That, and finding the covered pixels: the fragment shader throws all of them away.
    Raster,
    /// That, and what is done for each of them: interpolation, shading, the depth test, writing.
    Shade,
    /// What is done for each pixel, where memory has no part in it: as many as the picture has, all seen, in one tile that
    /// stays in the cache.
    Kernel,
    /// All of it.
    Frame,
}

/// A scene that can be drawn stage by stage: each of them with what the stage before it has left.
pub(crate) trait Stages {
    /// Does what is to be done in one stage.
    fn run(&mut self, stage: Stage);
}

/// A scene, and what its stages leave.
struct Staged<Z: Rasterizer, S, const N: usize> {
    prepared: Prepared<Z, S, N>,
    shaded: Vec<ClipVertex<N>>,
    pieces: Vec<[NdcVertex<N>; 3]>,
    /// One pixel, the lower left one of the view.
    dot: Target<Z::Depth>,
    /// As large as a tile of `tiled`.
    tile: Target<Z::Depth>,
    /// Triangles each of which covers that, in a view twice as large.
    covers: Vec<[NdcVertex<N>; 3]>,
}

/// The size of `tile`.
const TILE: [u32; 2] = [128, 32];

impl<Z: Contestant, S: Shader<N, Attributes = Vertex> + Sync, const N: usize> Staged<Z, S, N> {
    fn new(prepared: Prepared<Z, S, N>) -> Self {
        let pixels = prepared.target.color.rect().pixels().count();
        let covers = vec![cover(); pixels.div_ceil((TILE[0] * TILE[1]) as usize)];
        let [dot, mut tile] = [[1, 1], TILE].map(|[width, height]| Target::sized(width, height));
        clear(&mut tile, &prepared.state);
        let mut staged = Self { prepared, shaded: vec![], pieces: vec![], dot, tile, covers };
        staged.run(Stage::Vertex);
        staged.run(Stage::Clip);
        staged
    }

    fn clip(&mut self) {
        let Prepared { mesh, state, .. } = &self.prepared;
        let planes = state.clip_volume.planes(state.depth_range);
        let triangles = mesh.triangles().map(|triangle| triangle.map(|index| self.shaded[index]));
        self.pieces.clear();
        self.pieces.extend(triangles.flat_map(|triangle| {
            let polygon = clip_triangle(triangle, &planes, state.clip_test);
            let divided: ArrayVec<NdcVertex<N>, MAX_VERTICES> =
                polygon.into_iter().map(NdcVertex::from).collect();
            fan(divided)
        }));
    }
}

/// Half of a view, cut along its diagonal, which covers the lower left quarter as a whole. Of a texture it shows about a texel
/// for each pixel of `TILE` there.
fn cover<const N: usize>() -> [NdcVertex<N>; 3] {
    [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0)].map(|(x, y)| {
        let uv = [(x + 1.0) / 4.0, (y + 1.0) / 16.0];
        let varyings = from_fn(|k| uv.get(k).copied().unwrap_or(0.5));
        NdcVertex::from(ClipVertex { position: dvec4(x, y, 0.0, 1.0), varyings })
    })
}

fn stages<Z: Contestant>(scene: Scene) -> Box<dyn Stages + Send>
where
    Z::Depth: Send,
{
    if scene.is_lit {
        Box::new(Staged::new(Prepared::<Z, Lit, 5>::new(Lit::new(&scene), scene)))
    } else {
        Box::new(Staged::new(Prepared::<Z, Unlit, 2>::new(Unlit::new(&scene), scene)))
    }
}

impl<Z: Contestant, S: Shader<N, Attributes = Vertex> + Sync, const N: usize> Stages for Staged<Z, S, N> {
    fn run(&mut self, stage: Stage) {
        let Prepared { rasterizer, shader, mesh, state, target } = &mut self.prepared;
        let pieces = self.pieces.iter().copied();
        match stage {
            Stage::Clear => clear(target, state),
            Stage::Vertex => {
                self.shaded.clear();
                self.shaded.extend(mesh.vertices().iter().map(|vertex| shader.vertex(vertex)));
            }
            Stage::Clip => self.clip(),
            Stage::Setup => {
                let viewport = Some(state.viewport_in(target.color.rect()));
                let state = RenderState { viewport, ..*state };
                rasterizer.draw(pieces, &state, &Discard(shader), &mut self.dot, &Silent);
            }
            Stage::Raster => rasterizer.draw(pieces, state, &Discard(shader), target, &Silent),
            Stage::Shade => {
                clear(target, state);
                rasterizer.draw(pieces, state, shader, target, &Silent);
            }
            Stage::Kernel => {
                let covers = self.covers.iter().copied();
                let [width, height] = TILE.map(|side| 2.0 * f64::from(side));
                let state =
                    RenderState { viewport: Some(Viewport { x: 0.0, y: 0.0, width, height }), ..*state };
                rasterizer.draw(covers, &state, shader, &mut self.tile, &Silent);
            }
            Stage::Frame => self.prepared.draw(),
        }
    }
}

/// Another shader's vertices, and no fragments.
struct Discard<'a, S>(&'a S);

impl<S: Shader<N>, const N: usize> Shader<N> for Discard<'_, S> {
    type Attributes = S::Attributes;
    const IS_INLINED: bool = true;

    fn vertex(&self, attributes: &S::Attributes) -> ClipVertex<N> {
        self.0.vertex(attributes)
    }

    #[inline(always)]
    fn fragment<R: Real>(&self, _: [R; N]) -> Shaded<R> {
        Shaded::opaque([R::of(0.0); 3]).discard(R::Mask::all(true))
    }
}
