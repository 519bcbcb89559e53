//! Triangles from camera space to the picture: clip, divide, lay onto the screen.

use glam::{DVec3, DVec4};
use rasterbook::clip::{ClipTest, ClipVolume, DepthRange, NdcVertex, Plane, fan};
use rasterbook::figure::{Knob, Knobs};
use rasterbook::interpolate::{Projected, ScreenVertex};
use rasterbook::texture::{AddressMode, Texture};
use rasterbook::transform::{Frustum, Viewport};
use rasterbook::{ClipVertex, Color, Framebuffer, Target};

/// The view of this chapter: as many units on the near plane as the picture has pixels.
pub(super) const VIEW: Frustum =
    Frustum { left: -320.0, right: 320.0, bottom: -240.0, top: 240.0, near: 5.0, far: 20.0 };
pub(super) const ASPECT: f64 = 4.0 / 3.0;

pub(super) const BORDERS: &[Knob] = &[
    Knob::number(
        "left",
        VIEW.left,
        [-960.0, -80.0],
        "",
        "the left border goes outwards: more of the world is squeezed into the same picture",
    ),
    Knob::number(
        "right",
        VIEW.right,
        [80.0, 960.0],
        "",
        "the right border goes outwards: what was cut off on the right comes into view",
    ),
    Knob::number(
        "near",
        VIEW.near,
        [1.0, 8.0],
        "",
        "the near plane and its borders go away from the eye: the view becomes narrow, as through a telescope",
    ),
    Knob::number(
        "far",
        VIEW.far,
        [8.5, 20.0],
        "",
        "the far plane comes closer: nothing changes down to 10, then what is farther away is gone",
    ),
];

pub(super) const BEGIN: &[Knob] = &[Knob::number(
    "begin",
    -9.0,
    [-20.0, 18.0],
    "",
    "where the floor begins: in front of the eye, too, 'divide-first' cuts in the wrong place; from 11 on nothing is cut",
)];

/// The view with some of its borders in other places.
fn view(knobs: &Knobs) -> Frustum {
    let [left, right, near, far] = ["left", "right", "near", "far"].map(|name| knobs.number(name));
    Frustum { left, right, near, far, ..VIEW }
}

// ANCHOR: draw
/// Draws a triangle from clip space: clip, divide, lay onto the screen, fill with depth test.
pub(super) fn draw<const N: usize>(
    target: &mut Target,
    viewport: Viewport,
    triangle: [ClipVertex<N>; 3],
    (planes, test): (&[Plane], ClipTest),
    color_of: impl Fn([f64; N]) -> Color,
) {
    for piece in fan(target.clip_triangle(triangle, planes, test)) {
        let on_screen = piece.map(|vertex| {
            let NdcVertex { position, w, varyings } = vertex.into();
            let varyings = (Projected { w, values: varyings }, position.z);
            ScreenVertex { position: viewport.pixel_corners(position), varyings }
        });
        target.fill(on_screen, &color_of);
    }
}
// ANCHOR_END: draw

// ANCHOR: draw_all
/// A vertex in camera space, and its texture coordinates.
type SpaceVertex = ([f64; 3], [f64; 2]);

/// Draws triangles into a cleared picture; `project` takes camera space to clip space.
fn draw_all(
    framebuffer: &mut Framebuffer,
    triangles: &[[SpaceVertex; 3]],
    project: impl Fn(DVec3) -> DVec4,
    range: DepthRange,
    test: ClipTest,
) {
    let mut target = Target::like(framebuffer);
    target.clear(Color::BLACK, 1.0);
    let texture = Texture::book();
    let viewport = Viewport::fitting(target.color.rect(), ASPECT);
    for triangle in triangles {
        let vertices =
            triangle.map(|(view, uv)| ClipVertex { position: project(view.into()), varyings: uv });
        draw(&mut target, viewport, vertices, (&ClipVolume::Canonical.planes(range), test), |uv| {
            Color::truncated(texture.nearest(uv, AddressMode::Clamp))
        });
    }
    *framebuffer = target.color;
}
// ANCHOR_END: draw_all

/// A triangle that fits into the view.
pub(super) fn ndc(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    let view = view(knobs);
    let triangle = [
        ([-320.0, 240.0, 10.0], [0.0, 1.0]),
        ([-320.0, -240.0, 10.0], [0.0, 0.0]),
        ([320.0, -240.0, 10.0], [1.0, 0.0]),
    ];
    draw_all(
        framebuffer,
        &[triangle],
        |place| view.project(place),
        DepthRange::NegativeOneToOne,
        ClipTest::BeforeDivide,
    );
}

/// A triangle that is larger than the view and comes nearer than the near plane.
const LARGE: [SpaceVertex; 3] = [
    ([-512.0, 384.0, 10.0], [0.0, 1.0]),
    ([-512.0, -384.0, 10.0], [0.0, 0.0]),
    ([512.0, -384.0, 4.0], [1.0, 0.0]),
];

/// Clipped by the six planes.
pub(super) fn clipped(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    let view = view(knobs);
    draw_all(
        framebuffer,
        &[LARGE],
        |place| view.project(place),
        DepthRange::NegativeOneToOne,
        ClipTest::BeforeDivide,
    );
}

/// The same with z from 0 to w.
pub(super) fn zero_to_one(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    let view = view(knobs);
    draw_all(
        framebuffer,
        &[LARGE],
        |place| view.project_zero_to_one(place),
        DepthRange::ZeroToOne,
        ClipTest::BeforeDivide,
    );
}

// ANCHOR: divide_first
/// A floor of two triangles, from behind the eye, begin = −9, to the far plane.
fn passing(begin: f64) -> [[SpaceVertex; 3]; 2] {
    let [a, b] = [([-700.0, -240.0, begin], [0.0, 0.0]), ([700.0, -240.0, begin], [1.0, 0.0])];
    let [c, d] = [([700.0, -240.0, 19.0], [1.0, 1.0]), ([-700.0, -240.0, 19.0], [0.0, 1.0])];
    [[a, b, c], [a, c, d]]
}

/// The comparison after the divide.
pub(super) fn divide_first(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    draw_all(
        framebuffer,
        &passing(knobs.number("begin")),
        |view| VIEW.project(view),
        DepthRange::NegativeOneToOne,
        ClipTest::AfterDivide,
    );
}

/// The comparison before the divide.
pub(super) fn clip_first(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    draw_all(
        framebuffer,
        &passing(knobs.number("begin")),
        |view| VIEW.project(view),
        DepthRange::NegativeOneToOne,
        ClipTest::BeforeDivide,
    );
}
// ANCHOR_END: divide_first
