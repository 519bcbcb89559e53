//! # Chapter 9: the pipeline
//!
//! **How is all this put together?** What the last chapters called by hand becomes a list of stages, the same for every
//! picture; what differs from picture to picture is data: a mesh, a state, and two small programs, the shaders.
//!
//! New here: meshes (`lib/mesh.rs`), shaders (`lib/shader.rs`), culling (`lib/cull.rs`), blending (`lib/merge.rs`), the
//! stages in order (`lib/pipeline.rs`), and double buffering (`lib/swap_chain.rs`). Book: chapter 9.

use std::process::ExitCode;

use glam::{DVec3, dvec3};
use rasterbook::area::Winding;
use rasterbook::clip::ClipVertex;
use rasterbook::cull::CullMode;
use rasterbook::depth::Target;
use rasterbook::merge::{Blend, Merge};
use rasterbook::mesh::{Mesh, MeshError};
use rasterbook::pipeline::{RenderState, draw};
use rasterbook::probe::Silent;
use rasterbook::program::{Animation, Chapter, Variant};
use rasterbook::raster::Scanline;
use rasterbook::real::Real;
use rasterbook::shader::{Shaded, Shader};
use rasterbook::swap_chain::SwapChain;
use rasterbook::texture::{AddressMode, Texture};
use rasterbook::transform::{Frustum, Viewport};
use rasterbook::{Color, Framebuffer};

pub(crate) const CHAPTER: Chapter = Chapter {
    name: "ch09_pipeline",
    question: "How is all this put together?",
    variants: &[
        Variant::new("vbo", vbo, "chapter 8's triangle from a vertex buffer, through the whole pipeline: the same picture").source("section 9.2"),
        Variant::new("cull-ccw", cull_ccw, "two triangles, the back culled: the counter-clockwise one is left").source("section 9.3"),
        Variant::new("cull-cw", cull_cw, "the same, the front culled: the clockwise one is left").source("section 9.3"),
        Variant::new("cull-none", cull_none, "the same, nothing culled: both").source("section 9.3"),
        Variant::new("uncleared", uncleared, "five frames of a moving triangle, nothing cleared between them: the old ones stay").source("section 9.4.1, Figure 9-8").mended_by("cleared"),
        Variant::new("cleared", cleared, "the fifth of these frames, color and depth cleared before it").source("section 9.4.1"),
        Variant::animated("double-buffer", double_buffer, FLIGHT, "the near plane comes closer by 0.01 a frame, and the triangle shrinks; no frame is seen half drawn")
            .source("section 9.4.2"),
        Variant::new("tearing", tearing, "one buffer, seen while it is drawn: the new picture in the lower half, the old one above it").source("section 9.4.2").mended_by("presented"),
        Variant::new("presented", presented, "two buffers, seen at the same moment: the old picture, whole").source("section 9.4.2, Figure 9-9"),
        Variant::new("indexed", indexed, "a hill of 49 vertices and 72 triangles; each vertex is shaded once, and up to six triangles share it"),
        Variant::new("blended", blended, "translucent triangles over a checkered wall: source-over on the left, where order matters; additive on the right"),
    ],
};

/// The view of chapter 8.
const VIEW: Frustum =
    Frustum { left: -320.0, right: 320.0, bottom: -240.0, top: 240.0, near: 5.0, far: 20.0 };
/// 500 frames; the book waits 50 milliseconds after each.
const FLIGHT: Animation = Animation { frames: 500, rate: 20 };

// ANCHOR: shader
/// A point of camera space, and what belongs to it.
#[derive(Clone, Copy)]
struct Attributes {
    position: DVec3,
    uv: [f64; 2],
}

/// Projects, and looks texels up.
struct Textured {
    view: Frustum,
    texture: Texture,
}

impl Shader<2> for Textured {
    type Attributes = Attributes;

    fn vertex(&self, attributes: &Attributes) -> ClipVertex<2> {
        ClipVertex { position: self.view.project(attributes.position), varyings: attributes.uv }
    }

    fn fragment<R: Real>(&self, uv: [R; 2]) -> Shaded<R> {
        Shaded::opaque(self.texture.nearest(uv, AddressMode::Clamp))
    }
}
// ANCHOR_END: shader

/// The book's triangle, larger than the view and nearer than the near plane.
fn large_triangle() -> Vec<Attributes> {
    let attributes = |x, y, z, uv| Attributes { position: dvec3(x, y, z), uv };
    vec![
        attributes(-512.0, 384.0, 10.0, [0.0, 1.0]),
        attributes(-512.0, -384.0, 10.0, [0.0, 0.0]),
        attributes(512.0, -384.0, 4.0, [1.0, 0.0]),
    ]
}

/// A second triangle in the upper right, which runs clockwise.
fn with_clockwise_triangle() -> Vec<Attributes> {
    let mut vertices = large_triangle();
    for (x, y, uv) in [(80.0, 380.0, [0.0, 0.0]), (560.0, 380.0, [0.0, 1.0]), (560.0, 40.0, [1.0, 1.0])] {
        vertices.push(Attributes { position: dvec3(x, y, 10.0), uv });
    }
    vertices
}

// ANCHOR: render
/// Clears a target and draws one mesh into it, its 4 : 3 view fitted into the picture.
fn render<S: Shader<N>, const N: usize>(
    target: &mut Target,
    mesh: &Mesh<S::Attributes>,
    shader: &S,
    state: RenderState,
) {
    target.clear(state.clear_color, state.clear_depth);
    draw_more(target, mesh, shader, state);
}

/// The same without clearing.
fn draw_more<S: Shader<N>, const N: usize>(
    target: &mut Target,
    mesh: &Mesh<S::Attributes>,
    shader: &S,
    state: RenderState,
) {
    let viewport = Viewport::fitting(target.color.rect(), 4.0 / 3.0);
    let state = RenderState { viewport: Some(viewport), ..state };
    draw(mesh, shader, &state, &Scanline, target, &Silent);
}
// ANCHOR_END: render

fn book_texture(view: Frustum) -> Textured {
    Textured { view, texture: Texture::book() }
}

/// A mesh of the chapter itself, which is well formed.
fn triangles<A>(mesh: Result<Mesh<A>, MeshError>) -> Mesh<A> {
    mesh.unwrap_or_else(|error| unreachable!("{error}"))
}

fn textured_picture(framebuffer: &mut Framebuffer, vertices: Vec<Attributes>, state: RenderState) {
    let mut target = Target::new(framebuffer.width(), framebuffer.height());
    render(&mut target, &triangles(Mesh::unindexed(vertices)), &book_texture(VIEW), state);
    *framebuffer = target.color;
}

/// One triangle, from a vertex buffer.
fn vbo(framebuffer: &mut Framebuffer) {
    textured_picture(framebuffer, large_triangle(), RenderState::default());
}

// ANCHOR: culling
/// The front of a triangle runs counter-clockwise; the back is culled.
fn cull_ccw(framebuffer: &mut Framebuffer) {
    let state =
        RenderState { cull: CullMode::Back, front_face: Winding::CounterClockwise, ..RenderState::default() };
    textured_picture(framebuffer, with_clockwise_triangle(), state);
}

/// Clockwise ones are kept.
fn cull_cw(framebuffer: &mut Framebuffer) {
    let state =
        RenderState { cull: CullMode::Back, front_face: Winding::Clockwise, ..RenderState::default() };
    textured_picture(framebuffer, with_clockwise_triangle(), state);
}

/// Both are kept.
fn cull_none(framebuffer: &mut Framebuffer) {
    textured_picture(framebuffer, with_clockwise_triangle(), RenderState::default());
}
// ANCHOR_END: culling

// ANCHOR: frames
/// The view of a frame: its near plane is nearer by 0.01 for each frame before it.
fn view_of(frame: u32) -> Frustum {
    let near = (0..frame).fold(VIEW.near, |near, _| near - 0.01);
    Frustum { near, ..VIEW }
}

/// One frame: drawn into the back buffer, then presented.
fn double_buffer(framebuffer: &mut Framebuffer, frame: u32) {
    let mut chain = SwapChain::new(framebuffer.width(), framebuffer.height());
    draw_frame(&mut chain.back, frame);
    chain.present();
    *framebuffer = chain.into_front();
}

fn draw_frame(target: &mut Target, frame: u32) {
    let state = RenderState { cull: CullMode::Back, ..RenderState::default() };
    render(target, &triangles(Mesh::unindexed(large_triangle())), &book_texture(view_of(frame)), state);
}
// ANCHOR_END: frames

// ANCHOR: uncleared
/// Five frames of a triangle that moves to the right, drawn into one target.
fn five_frames(framebuffer: &mut Framebuffer, clear: bool) {
    let mut target = Target::new(framebuffer.width(), framebuffer.height());
    for frame in 0..5 {
        if clear {
            target.clear(Color::BLACK, 1.0);
        }
        let (x, fade) = (30.0 + 90.0 * f64::from(frame), 50.0 * f64::from(frame));
        let corners = vec![[x, 90.0], [x + 190.0, 150.0], [x + 60.0, 400.0]];
        let shader = Flat { color: [40.0 + fade, 90.0 + fade / 3.0, 240.0 - fade], opacity: 1.0 };
        draw_more(&mut target, &triangles(Mesh::unindexed(corners)), &shader, RenderState::default());
    }
    *framebuffer = target.color;
}

/// Nothing is cleared: the old frames stay.
fn uncleared(framebuffer: &mut Framebuffer) {
    five_frames(framebuffer, false);
}

/// Each frame begins with a cleared target.
fn cleared(framebuffer: &mut Framebuffer) {
    five_frames(framebuffer, true);
}
// ANCHOR_END: uncleared

// ANCHOR: tearing
/// A screen with one buffer, looked at when the lower half of the new picture has been drawn.
fn tearing(framebuffer: &mut Framebuffer) {
    let mut only = Target::new(framebuffer.width(), framebuffer.height());
    draw_frame(&mut only, 0);
    let old = only.color.clone();
    draw_frame(&mut only, 150);
    *framebuffer = only.color;
    for y in framebuffer.rect().rows().skip(framebuffer.height() as usize / 2) {
        for x in framebuffer.rect().columns() {
            framebuffer.set(x, y, old.get(x, y).unwrap_or_default());
        }
    }
}

/// A screen with two buffers, looked at in the same moment.
fn presented(framebuffer: &mut Framebuffer) {
    let mut chain = SwapChain::new(framebuffer.width(), framebuffer.height());
    draw_frame(&mut chain.back, 0);
    chain.present();
    draw_frame(&mut chain.back, 150);
    *framebuffer = chain.into_front();
}
// ANCHOR_END: tearing

// ANCHOR: indexed
/// Colors by height.
struct Relief;

impl Shader<1> for Relief {
    type Attributes = DVec3;

    fn vertex(&self, &view: &DVec3) -> ClipVertex<1> {
        let frustum = Frustum { left: -4.0, right: 4.0, bottom: -3.0, top: 3.0, near: 6.0, far: 40.0 };
        ClipVertex { position: frustum.project(view), varyings: [view.y] }
    }

    fn fragment<R: Real>(&self, [height]: [R; 1]) -> Shaded<R> {
        // Bands of equal height, from green to white.
        let band = ((height + R::of(4.6)) * R::of(2.0)).floor() / R::of(9.0);
        let mix = |low: f64, high: f64| R::of(low) + R::of(high - low) * band;
        Shaded::opaque([mix(30.0, 255.0), mix(90.0, 250.0), mix(50.0, 235.0)])
    }
}

/// A hill of 7×7 vertices.
fn indexed(framebuffer: &mut Framebuffer) {
    let vertex = |column: u32, row: u32| {
        let (x, z) = (f64::from(column) - 3.0, f64::from(row) - 3.0);
        dvec3(2.4 * x, 4.5 / (1.0 + 0.35 * (x * x + z * z)) - 4.6, 13.0 + 2.0 * z)
    };
    let vertices = (0..49).map(|i| vertex(i % 7, i / 7)).collect();
    let quads = (0..36).map(|i| i / 6 * 7 + i % 6);
    let indices = quads
        .flat_map(|corner| [corner, corner + 1, corner + 7, corner + 1, corner + 8, corner + 7])
        .collect();

    let mut target = Target::new(framebuffer.width(), framebuffer.height());
    render(&mut target, &triangles(Mesh::indexed(vertices, indices)), &Relief, RenderState::default());
    *framebuffer = target.color;
}
// ANCHOR_END: indexed

// ANCHOR: blended
/// A flat color with an opacity; positions are pixels of a picture of 640×480.
struct Flat {
    color: [f64; 3],
    opacity: f64,
}

impl Shader<0> for Flat {
    type Attributes = [f64; 2];

    fn vertex(&self, &[x, y]: &[f64; 2]) -> ClipVertex<0> {
        // The viewport's inverse, so that corners come to lie on whole pixels.
        ClipVertex {
            position: glam::dvec4(x / 639.0 * 2.0 - 1.0, y / 479.0 * 2.0 - 1.0, 0.0, 1.0),
            varyings: [],
        }
    }

    fn fragment<R: Real>(&self, _: [R; 0]) -> Shaded<R> {
        Shaded::translucent(self.color.map(R::of), R::of(self.opacity))
    }
}

/// Three overlapping triangles on either side, blended in two ways.
fn blended(framebuffer: &mut Framebuffer) {
    let mut target = Target::new(framebuffer.width(), framebuffer.height());
    target.clear(Color::gray(40), 1.0);
    let mut add = |corners: [[f64; 2]; 3], color, opacity, blend| {
        let merge = Merge { blend, ..Merge::default() };
        let state = RenderState { merge, ..RenderState::default() };
        draw_more(
            &mut target,
            &triangles(Mesh::unindexed(corners.to_vec())),
            &Flat { color, opacity },
            state,
        );
    };

    // The wall behind them: squares of 40 pixels.
    for (column, row) in
        (0..12).flat_map(|row| (0..16).map(move |column| (column, row))).filter(|(c, r)| (c + r) % 2 == 0)
    {
        let (x, y) = (f64::from(column) * 40.0, f64::from(row) * 40.0);
        for corners in
            [[[x, y], [x + 39.0, y], [x, y + 39.0]], [[x + 39.0, y], [x + 39.0, y + 39.0], [x, y + 39.0]]]
        {
            add(corners, [75.0; 3], 1.0, Blend::Opaque);
        }
    }
    for (shift, blend) in [(0.0, Blend::SourceOver), (310.0, Blend::Additive)] {
        let at = |x: f64, y: f64| [x + shift, y];
        add([at(40.0, 180.0), at(220.0, 180.0), at(130.0, 440.0)], [230.0, 60.0, 50.0], 0.6, blend);
        add([at(100.0, 60.0), at(290.0, 140.0), at(120.0, 320.0)], [60.0, 190.0, 80.0], 0.6, blend);
        add([at(70.0, 300.0), at(260.0, 220.0), at(280.0, 400.0)], [70.0, 110.0, 240.0], 0.6, blend);
    }
    *framebuffer = target.color;
}
// ANCHOR_END: blended

fn main() -> ExitCode {
    CHAPTER.main()
}
