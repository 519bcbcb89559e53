//! # Chapter 9: the pipeline
//!
//! **How is all this put together?** What the last chapters called by hand becomes a list of stages, the same for every
//! picture; what differs from picture to picture is data: a mesh, a state, and two small programs, the shaders.
//!
//! New here: meshes (`lib/mesh.rs`), shaders (`lib/shader.rs`), culling (`lib/cull.rs`), blending (`lib/merge.rs`), the
//! stages in order (`lib/pipeline.rs`), and double buffering (`lib/swap_chain.rs`). Book: chapter 9.

use std::process::ExitCode;

use glam::{DVec3, dvec2, dvec3};
use rasterbook::area::Winding;
use rasterbook::cull::CullMode;
use rasterbook::figure::{Animation, Canvas, Chapter, Knob, Knobs, Variant};
use rasterbook::merge::{Blend, Merge};
use rasterbook::swap_chain::SwapChain;
use rasterbook::texture::{AddressMode, Texture};
use rasterbook::transform::Frustum;
use rasterbook::{ClipVertex, Color, Mesh, Real, RenderState, Shaded, Shader};

pub(crate) const CHAPTER: Chapter = Chapter {
    name: "ch09_pipeline",
    question: "How is all this put together?",
    variants: &[
        Variant::with_pipeline("blended", blended, "translucent triangles over a checkered wall: source-over on the left, where order matters; additive on the right").knobs(BLENDING),
        Variant::with_pipeline("vbo", vbo, "chapter 8's triangle from a vertex buffer, through the whole pipeline: the same picture").source("section 9.2"),
        Variant::with_pipeline("cull-ccw", cull_ccw, "two triangles, the back culled: the counter-clockwise one is left, which is the picture 'vbo'").source("section 9.3").knobs(&[VERTEX]),
        Variant::with_pipeline("cull-cw", cull_cw, "the same with clockwise as the front, the back culled: the clockwise one is left").source("section 9.3").knobs(&[VERTEX]),
        Variant::with_pipeline("cull-none", cull_none, "the same, nothing culled: both").source("section 9.3").knobs(&[VERTEX, CULL]),
        Variant::with_pipeline("uncleared", uncleared, "five frames of a moving triangle, nothing cleared between them: the old ones stay").source("section 9.4.1, Figure 9-8").remedied_by("cleared").knobs(FRAMES),
        Variant::with_pipeline("cleared", cleared, "the fifth of these frames, color and depth cleared before it").source("section 9.4.1").knobs(FRAMES),
        Variant::with_pipeline("double-buffer", double_buffer, "the near plane comes closer by 0.01 a frame, and the triangle of 'vbo' shrinks; no frame is seen half drawn")
            .animated(FLIGHT)
            .source("section 9.4.2"),
        Variant::with_pipeline("tearing", tearing, "one buffer, shown half drawn: the new frame in the lower half, the old one above it; a step, as where a picture tears").source("section 9.4.2").remedied_by("presented").knobs(&[FRAME, DRAWN]),
        Variant::with_pipeline("presented", presented, "two buffers, at the same moment: the old frame, whole, which is the picture 'vbo'").source("section 9.4.2, Figure 9-9").knobs(&[FRAME]),
        Variant::with_pipeline("indexed", indexed, "a hill of 49 vertices and 72 triangles; each vertex is shaded once, and up to six triangles share it").knobs(HILL),
    ],
};

const BLENDING: &[Knob] = &[
    Knob::number(
        "opacity",
        0.6,
        [0.0, 1.0],
        "",
        "at 1 the last triangle hides the others on the left; on the right it only adds",
    ),
    Knob::choice(
        "order",
        &[
            "red-green-blue",
            "green-blue-red",
            "blue-red-green",
            "blue-green-red",
            "green-red-blue",
            "red-blue-green",
        ],
        "which is drawn first, which last: on the left the overlaps change, on the right they do not",
    ),
    Knob::choice(
        "left",
        &["source-over", "additive", "opaque"],
        "how the left triangles are blended",
    ),
    Knob::choice(
        "right",
        &["additive", "source-over", "opaque"],
        "how the right triangles are blended",
    ),
];

const VERTEX: Knob = Knob::point(
    "vertex",
    [600.0, 430.0],
    "drag the small triangle's upper right vertex across the opposite edge: it runs the other way",
);
const CULL: Knob = Knob::choice(
    "cull",
    &["none", "back", "front"],
    "the same two triangles, and which are left out",
);

const FRAMES: &[Knob] = &[Knob::number(
    "step",
    90.0,
    [0.0, 110.0],
    "pixels",
    "how far the triangle moves in a frame: the smaller the step, the more of the trail is hidden",
)];

const FRAME: Knob = Knob::whole(
    "frame",
    0,
    [0, 349],
    "",
    "which frame has been shown before; the new one is 150 frames later: the step is where the two differ",
);
const DRAWN: Knob = Knob::number(
    "drawn",
    50.0,
    [0.0, 100.0],
    "%",
    "how much of the new frame has been drawn when the screen is read: the step moves up",
);

const HILL: &[Knob] = &[
    Knob::whole(
        "side",
        7,
        [2, 25],
        "vertices",
        "the more vertices, the smoother the bands; with two the hill is lost",
    ),
    Knob::choice("cull", &["none", "back", "front"], "without the fronts you look into the hill"),
];

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

    fn position(&self, attributes: &Attributes) -> Option<DVec3> {
        Some(attributes.position)
    }

    fn vertex(&self, attributes: &Attributes) -> ClipVertex<2> {
        ClipVertex { position: self.view.project(attributes.position), varyings: attributes.uv }
    }

    fn fragment<R: Real>(&self, uv: [R; 2]) -> Shaded<R> {
        Shaded::texel(self.texture.nearest_texel(uv, AddressMode::Clamp))
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

/// A second triangle in the upper right, which runs clockwise; its middle vertex is where the knob says.
fn with_clockwise_triangle(knobs: &Knobs) -> Vec<Attributes> {
    // At the distance 10 a pixel is two units.
    let [x, y] = ((knobs.point("vertex") - dvec2(320.0, 240.0)) * 2.0).to_array();
    let mut vertices = large_triangle();
    for (x, y, uv) in [(80.0, 380.0, [0.0, 0.0]), (x, y, [0.0, 1.0]), (560.0, 40.0, [1.0, 1.0])] {
        vertices.push(Attributes { position: dvec3(x, y, 10.0), uv });
    }
    vertices
}

fn book_texture(view: Frustum) -> Textured {
    Textured { view, texture: Texture::book() }
}

// ANCHOR: render
/// Clears the canvas, and sends triangles through the pipeline.
fn textured_picture(canvas: &mut Canvas, vertices: Vec<Attributes>, state: &RenderState) {
    canvas.render(&Mesh::unindexed(vertices).expect("whole triangles"), &book_texture(VIEW), state);
}
// ANCHOR_END: render

/// One triangle, from a vertex buffer.
fn vbo(canvas: &mut Canvas) {
    textured_picture(canvas, large_triangle(), &RenderState::default());
}

fn cull_mode(knobs: &Knobs) -> CullMode {
    match knobs.choice("cull") {
        "back" => CullMode::Back,
        "front" => CullMode::Front,
        _ => CullMode::None,
    }
}

// ANCHOR: culling
/// The front of a triangle runs counter-clockwise; the back is culled.
fn cull_ccw(canvas: &mut Canvas) {
    let state = RenderState {
        cull: CullMode::Back,
        front_face: Winding::CounterClockwise,
        ..RenderState::default()
    };
    textured_picture(canvas, with_clockwise_triangle(&canvas.knobs), &state);
}

/// Clockwise ones are kept.
fn cull_cw(canvas: &mut Canvas) {
    let state = RenderState {
        cull: CullMode::Back,
        front_face: Winding::Clockwise,
        ..RenderState::default()
    };
    textured_picture(canvas, with_clockwise_triangle(&canvas.knobs), &state);
}

/// Both are kept, unless the knob says otherwise.
fn cull_none(canvas: &mut Canvas) {
    let state = RenderState { cull: cull_mode(&canvas.knobs), ..RenderState::default() };
    textured_picture(canvas, with_clockwise_triangle(&canvas.knobs), &state);
}
// ANCHOR_END: culling

// ANCHOR: frames
/// The view of a frame: its near plane is nearer by 0.01 for each frame before it.
fn view_of(frame: u32) -> Frustum {
    let near = (0..frame).fold(VIEW.near, |near, _| near - 0.01);
    Frustum { near, ..VIEW }
}

/// One frame: drawn into the back buffer, then presented. The picture is what the screen shows.
fn double_buffer(canvas: &mut Canvas) {
    let mut screen = screen_for(canvas);
    draw_frame(canvas, canvas.frame);
    screen.present(canvas.picture_mut());
    *canvas.picture_mut() = screen.front().clone();
}

fn screen_for(canvas: &Canvas) -> SwapChain {
    SwapChain::new(canvas.picture().width(), canvas.picture().height())
}

fn draw_frame(canvas: &mut Canvas, frame: u32) {
    let state = RenderState { cull: CullMode::Back, ..RenderState::default() };
    canvas.render(
        &Mesh::unindexed(large_triangle()).expect("whole triangles"),
        &book_texture(view_of(frame)),
        &state,
    );
}
// ANCHOR_END: frames

// ANCHOR: uncleared
/// Five frames of a triangle that moves to the right, drawn into one target.
fn five_frames(canvas: &mut Canvas, clear: bool) {
    let (state, step) = (RenderState::default(), canvas.knobs.number("step"));
    canvas.clear(&state);
    for frame in 0..5 {
        if clear {
            canvas.clear(&state);
        }
        let (x, fade) = (30.0 + step * f64::from(frame), 50.0 * f64::from(frame));
        let vertices = vec![[x, 90.0], [x + 190.0, 150.0], [x + 60.0, 400.0]];
        let shader = Flat { color: [40.0 + fade, 90.0 + fade / 3.0, 240.0 - fade], opacity: 1.0 };
        canvas.draw(&Mesh::unindexed(vertices).expect("whole triangles"), &shader, &state);
    }
}

/// Nothing is cleared: the old frames stay.
fn uncleared(canvas: &mut Canvas) {
    five_frames(canvas, false);
}

/// Each frame begins with a cleared target.
fn cleared(canvas: &mut Canvas) {
    five_frames(canvas, true);
}
// ANCHOR_END: uncleared

/// The frame before the one that is being drawn.
fn shown_frame(canvas: &Canvas) -> u32 {
    canvas.knobs.whole("frame").unsigned_abs()
}

// ANCHOR: tearing
/// A screen with one buffer, shown when the lower half of the new frame has been drawn.
fn tearing(canvas: &mut Canvas) {
    let drawn = canvas.knobs.number("drawn") / 100.0;
    draw_frame(canvas, shown_frame(canvas));
    let old = canvas.picture().clone();
    draw_frame(canvas, shown_frame(canvas) + 150);
    let picture = canvas.picture_mut();
    for y in picture.rect().rows().skip((f64::from(picture.height()) * drawn) as usize) {
        for x in picture.rect().columns() {
            picture.set(x, y, old.get(x, y).unwrap_or_default());
        }
    }
}

/// A screen with two buffers at the same moment: the new frame is in the back buffer, unseen.
fn presented(canvas: &mut Canvas) {
    let mut screen = screen_for(canvas);
    draw_frame(canvas, shown_frame(canvas));
    screen.present(canvas.picture_mut());
    draw_frame(canvas, shown_frame(canvas) + 150);
    *canvas.picture_mut() = screen.front().clone();
}
// ANCHOR_END: tearing

// ANCHOR: indexed
/// Colors by height.
struct Relief;

impl Shader<1> for Relief {
    type Attributes = DVec3;

    fn vertex(&self, &view: &DVec3) -> ClipVertex<1> {
        let frustum =
            Frustum { left: -4.0, right: 4.0, bottom: -3.0, top: 3.0, near: 6.0, far: 40.0 };
        ClipVertex { position: frustum.project(view), varyings: [view.y] }
    }

    fn fragment<R: Real>(&self, [height]: [R; 1]) -> Shaded<R> {
        // Bands of equal height, from green to white.
        let band = ((height + R::of(4.6)) * R::of(2.0)).floor() / R::of(9.0);
        let mix = |low: f64, high: f64| R::of(low) + R::of(high - low) * band;
        Shaded::opaque([mix(30.0, 255.0), mix(90.0, 250.0), mix(50.0, 235.0)])
    }
}

/// A hill of 7×7 vertices, unless the knob says otherwise.
fn indexed(canvas: &mut Canvas) {
    let side = canvas.knobs.whole("side").unsigned_abs();
    let vertex = |column: u32, row: u32| {
        let [x, z] = [column, row].map(|place| f64::from(6 * place) / f64::from(side - 1) - 3.0);
        dvec3(2.4 * x, 4.5 / (1.0 + 0.35 * (x * x + z * z)) - 4.6, 13.0 + 2.0 * z)
    };
    let vertices = (0..side * side).map(|i| vertex(i % side, i / side)).collect();
    let squares =
        (0..side - 1).flat_map(|row| (0..side - 1).map(move |column| row * side + column));
    let indices = squares
        .flat_map(|first| {
            [first, first + 1, first + side, first + 1, first + side + 1, first + side]
        })
        .collect();

    let state = RenderState { cull: cull_mode(&canvas.knobs), ..RenderState::default() };
    canvas.render(&Mesh::indexed(vertices, indices).expect("indices of the hill"), &Relief, &state);
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
        // The viewport's inverse, so that vertices come to lie on whole pixels.
        ClipVertex {
            position: glam::dvec4(x / 639.0 * 2.0 - 1.0, y / 479.0 * 2.0 - 1.0, 0.0, 1.0),
            varyings: [],
        }
    }

    fn fragment<R: Real>(&self, _: [R; 0]) -> Shaded<R> {
        Shaded::translucent(R::array_of(self.color), R::of(self.opacity))
    }
}

fn blend_mode(name: &str) -> Blend {
    match name {
        "source-over" => Blend::SourceOver,
        "additive" => Blend::Additive,
        _ => Blend::Opaque,
    }
}

/// Three overlapping triangles on either side, blended in two ways.
fn blended(canvas: &mut Canvas) {
    let (opacity, order) = (canvas.knobs.number("opacity"), canvas.knobs.choice("order"));
    let [left, right] = ["left", "right"].map(|side| blend_mode(canvas.knobs.choice(side)));
    canvas.clear(&RenderState { clear_color: Color::gray(40), ..RenderState::default() });
    let mut add = |vertices: [[f64; 2]; 3], color, opacity, blend| {
        let merge = Merge { blend, ..Merge::default() };
        let state = RenderState { merge, ..RenderState::default() };
        canvas.draw(
            &Mesh::unindexed(vertices.to_vec()).expect("whole triangles"),
            &Flat { color, opacity },
            &state,
        );
    };

    // The wall behind them: squares of 40 pixels.
    for (column, row) in (0..12)
        .flat_map(|row| (0..16).map(move |column| (column, row)))
        .filter(|(c, r)| (c + r) % 2 == 0)
    {
        let (x, y) = (f64::from(column) * 40.0, f64::from(row) * 40.0);
        for vertices in [
            [[x, y], [x + 39.0, y], [x, y + 39.0]],
            [[x + 39.0, y], [x + 39.0, y + 39.0], [x, y + 39.0]],
        ] {
            add(vertices, [75.0; 3], 1.0, Blend::Opaque);
        }
    }
    for (shift, blend) in [(0.0, left), (310.0, right)] {
        let at = |x: f64, y: f64| [x + shift, y];
        for name in order.split('-') {
            let (vertices, color) = match name {
                "red" => {
                    ([at(40.0, 180.0), at(220.0, 180.0), at(130.0, 440.0)], [230.0, 60.0, 50.0])
                }
                "green" => {
                    ([at(100.0, 60.0), at(290.0, 140.0), at(120.0, 320.0)], [60.0, 190.0, 80.0])
                }
                _ => ([at(70.0, 300.0), at(260.0, 220.0), at(280.0, 400.0)], [70.0, 110.0, 240.0]),
            };
            add(vertices, color, opacity, blend);
        }
    }
}
// ANCHOR_END: blended

fn main() -> ExitCode {
    CHAPTER.main()
}
