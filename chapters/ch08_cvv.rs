//! # Chapter 8: the canonical view volume
//!
//! **What of the world gets into the picture?** Whatever the size of the screen, what is seen lies between −1 and 1 in
//! all three directions, once it has been projected and divided. Six planes cut away the rest.
//!
//! New here: the frustum and the viewport (`lib/transform.rs`), and clipping with six planes (`lib/clip.rs`).
//! Book: chapter 8.

use std::process::ExitCode;

use glam::{DVec2, DVec3, DVec4, dvec2, dvec3};
use rasterbook::clip::{ClipTest, ClipVolume, DepthRange, NdcVertex, Plane, clip_triangle, fan};
use rasterbook::figure::{Chapter, Fit, Knob, Knobs, Variant};
use rasterbook::interpolate::{Projected, ScreenVertex};
use rasterbook::line::{StepAxis, dda};
use rasterbook::texture::{AddressMode, Texture};
use rasterbook::transform::{Frustum, Viewport, perspective_divide};
use rasterbook::{ClipVertex, Color, Framebuffer, Target};

pub(crate) const CHAPTER: Chapter = Chapter {
    name: "ch08_cvv",
    question: "What of the world gets into the picture?",
    variants: &[
        Variant::with_knobs("clipped", clipped, BORDERS, "a triangle that is larger than the view, one vertex nearer than the near plane: cut off at the borders of the picture")
            .source("section 8.3, Figure 8-9"),
        Variant::with_knobs("ndc", ndc, BORDERS, "a triangle that fits: the frustum's borders become the borders of the picture").source("section 8.2, Figure 8-6"),
        Variant::with_knobs("planes", planes, PLANES, "the polygon before clipping and after each plane: left, right, bottom, top, near, far; the square is the view")
            .source("section 8.3, Table 8-1").size(800, 400),
        Variant::with_knobs("frustum", frustum, DEPTHS, "left: 35 points in the view volume from above, the eye at the bottom; right: the same in NDC. Equal steps in depth crowd together far away")
            .source("section 8.1, Figure 8-4").size(760, 400),
        Variant::with_knobs("divide-first", divide_first, BEGIN, "a floor that passes under the eye, tested after the divide: behind us the comparison is reversed, and the floor is cut off far in front of our feet")
            .source("section 8.3").remedied_by("clip-first"),
        Variant::with_knobs("clip-first", clip_first, BEGIN, "the same floor, clipped before the divide: it comes up to the near plane, at the lower border").source("section 8.3"),
        Variant::with_knobs("zero-to-one", zero_to_one, BORDERS, "Direct3D's range, 0 ≤ z ≤ w: another projection, another near plane, the same picture as 'clipped'"),
    ],
};

/// The view of this chapter: as many units on the near plane as the picture has pixels.
const VIEW: Frustum =
    Frustum { left: -320.0, right: 320.0, bottom: -240.0, top: 240.0, near: 5.0, far: 20.0 };
const ASPECT: f64 = 4.0 / 3.0;

const BORDERS: &[Knob] = &[
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

const PLANES: &[Knob] = &[
    Knob::switch("left", true, "off: what lies beyond the left border stays from the second drawing on"),
    Knob::switch("right", true, "off: what lies beyond the right border stays from the third drawing on"),
    Knob::switch("bottom", true, "off: what lies below stays from the fourth drawing on"),
    Knob::switch("top", true, "off: what lies above stays from the fifth drawing on"),
    Knob::switch("near", true, "off: what is too near stays in the last two drawings"),
    Knob::switch("far", true, "off: what is too far stays in the last drawing"),
];

const DEPTHS: &[Knob] = &[
    Knob::number(
        "near",
        2.0,
        [0.25, 6.0],
        "",
        "the near plane comes closer to the eye: in the box all rows but the first crowd together at its far end",
    ),
    Knob::number(
        "far",
        10.0,
        [6.5, 10.5],
        "",
        "the far plane comes closer: the box stays, and its rows spread",
    ),
];

const BEGIN: &[Knob] = &[Knob::number(
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
fn draw(target: &mut Target, triangle: [ClipVertex<2>; 3], planes: &[Plane], test: ClipTest) {
    let texture = Texture::book();
    let viewport = Viewport::fitting(target.color.rect(), ASPECT);
    for piece in fan(target.clip_triangle(triangle, planes, test)) {
        let on_screen = piece.map(|vertex| {
            let NdcVertex { position, w, varyings } = vertex.into();
            let varyings = (Projected { w, values: varyings }, position.z);
            ScreenVertex { position: viewport.pixel_corners(position), varyings }
        });
        target.fill(on_screen, |uv| Color::truncated(texture.nearest(uv, AddressMode::Clamp)));
    }
}

/// A vertex in camera space, and its texture coordinates.
type SpaceCorner = ([f64; 3], [f64; 2]);

/// Draws triangles into a cleared picture; `project` takes camera space to clip space.
fn draw_all(
    framebuffer: &mut Framebuffer,
    triangles: &[[SpaceCorner; 3]],
    project: impl Fn(DVec3) -> DVec4,
    range: DepthRange,
    test: ClipTest,
) {
    let mut target = Target::like(framebuffer);
    target.clear(Color::BLACK, 1.0);
    for corners in triangles {
        let vertices = corners.map(|(view, uv)| ClipVertex { position: project(view.into()), varyings: uv });
        draw(&mut target, vertices, &ClipVolume::Canonical.planes(range), test);
    }
    *framebuffer = target.color;
}
// ANCHOR_END: draw

/// A triangle that fits into the view.
fn ndc(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    let view = view(knobs);
    let corners = [
        ([-320.0, 240.0, 10.0], [0.0, 1.0]),
        ([-320.0, -240.0, 10.0], [0.0, 0.0]),
        ([320.0, -240.0, 10.0], [1.0, 0.0]),
    ];
    draw_all(
        framebuffer,
        &[corners],
        |place| view.project(place),
        DepthRange::NegativeOneToOne,
        ClipTest::BeforeDivide,
    );
}

/// A triangle that is larger than the view and comes nearer than the near plane.
const LARGE: [SpaceCorner; 3] = [
    ([-512.0, 384.0, 10.0], [0.0, 1.0]),
    ([-512.0, -384.0, 10.0], [0.0, 0.0]),
    ([512.0, -384.0, 4.0], [1.0, 0.0]),
];

/// Clipped by the six planes.
fn clipped(framebuffer: &mut Framebuffer, knobs: &Knobs) {
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
fn zero_to_one(framebuffer: &mut Framebuffer, knobs: &Knobs) {
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
fn passing(begin: f64) -> [[SpaceCorner; 3]; 2] {
    let [a, b] = [([-700.0, -240.0, begin], [0.0, 0.0]), ([700.0, -240.0, begin], [1.0, 0.0])];
    let [c, d] = [([700.0, -240.0, 19.0], [1.0, 1.0]), ([-700.0, -240.0, 19.0], [0.0, 1.0])];
    [[a, b, c], [a, c, d]]
}

/// The comparison after the divide.
fn divide_first(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    draw_all(
        framebuffer,
        &passing(knobs.number("begin")),
        |view| VIEW.project(view),
        DepthRange::NegativeOneToOne,
        ClipTest::AfterDivide,
    );
}

/// The comparison before the divide.
fn clip_first(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    draw_all(
        framebuffer,
        &passing(knobs.number("begin")),
        |view| VIEW.project(view),
        DepthRange::NegativeOneToOne,
        ClipTest::BeforeDivide,
    );
}
// ANCHOR_END: divide_first

fn draw_line(framebuffer: &mut Framebuffer, a: DVec2, b: DVec2, color: Color) {
    dda(a, b, StepAxis::Longer, framebuffer.scissor(), |x, y| framebuffer.set(x, y, color));
}

// ANCHOR: plane_by_plane
/// The polygon in NDC after no plane, one, two, … six; in each panel the view is the square in the
/// middle. A plane that is switched off cuts nothing.
fn planes(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    const PANEL: f64 = 200.0;
    framebuffer.clear(Color::gray(24));
    let fit = Fit::new(framebuffer.rect(), [4.0 * PANEL, 2.0 * PANEL]);
    let corners = [[-10_400.0, 2600.0, 90.0], [58.0, -245.0, 3.0], [820.0, 576.0, 8.0]];
    let triangle = corners.map(|view| ClipVertex { position: VIEW.project(DVec3::from(view)), varyings: [] });
    let is_on = ["left", "right", "bottom", "top", "near", "far"].map(|name| knobs.is_on(name));
    for count in 0..=6 {
        let middle = PANEL * dvec2(0.5 + (count % 4) as f64, if count < 4 { 1.5 } else { 0.5 });
        let in_panel = |ndc: DVec2| fit.at(middle + ndc * 45.0);
        let place = |vertex: &ClipVertex<0>| in_panel(perspective_divide(vertex.position).truncate());

        let view = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|corner| in_panel(corner.into()));
        for i in 0..4 {
            draw_line(framebuffer, view[i], view[(i + 1) % 4], Color::gray(110));
        }
        let planes = Plane::CANONICAL[..count].iter().zip(is_on).filter(|(_, is_on)| *is_on);
        let planes: Vec<Plane> = planes.map(|(plane, _)| *plane).collect();
        let polygon = clip_triangle(triangle, &planes, ClipTest::BeforeDivide);
        for (i, vertex) in polygon.iter().enumerate() {
            let next = &polygon[(i + 1) % polygon.len()];
            draw_line(framebuffer, place(vertex), place(next), Color::rgb(110, 190, 255));
        }
        for vertex in &polygon {
            framebuffer.fill(fit.mark(place(vertex), 2.0), Color::rgb(255, 200, 60));
        }
    }
}
// ANCHOR_END: plane_by_plane

// ANCHOR: frustum
/// Rows of points at equal steps of depth, from above: in camera space on the left, in NDC on the
/// right.
fn frustum(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    const ROWS: [Color; 5] = [
        Color::rgb(255, 90, 80),
        Color::rgb(255, 180, 60),
        Color::rgb(240, 240, 90),
        Color::rgb(100, 220, 120),
        Color::rgb(100, 160, 255),
    ];
    let (near, far) = (knobs.number("near"), knobs.number("far"));
    // As wide as it is far away, wherever it is cut off.
    let right = near / 2.0;
    let view = Frustum { left: -right, right, bottom: -right, top: right, near, far };
    let fit = Fit::new(framebuffer.rect(), [760.0, 400.0]);
    let in_camera = |p: DVec3| fit.at(dvec2(190.0, 30.0) + dvec2(p.x, p.z) * 34.0);
    let in_ndc = |p: DVec3| {
        let ndc = perspective_divide(view.project(p));
        fit.at(dvec2(570.0, 200.0) + dvec2(ndc.x, ndc.z) * 150.0)
    };
    let point = |column: i32, row: i32| {
        let z = near + (far - near) / 4.0 * f64::from(row);
        // The borders of the view are at x = ±z · right / near.
        dvec3(f64::from(column - 3) / 3.0 * z / 2.0, 0.0, z)
    };

    for place in [&in_camera as &dyn Fn(DVec3) -> DVec2, &in_ndc] {
        for column in 0..7 {
            draw_line(framebuffer, place(point(column, 0)), place(point(column, 4)), Color::gray(90));
        }
        for (row, color) in (0..).zip(ROWS) {
            draw_line(framebuffer, place(point(0, row)), place(point(6, row)), color);
            for column in 0..7 {
                framebuffer.fill(fit.mark(place(point(column, row)), 2.0), color);
            }
        }
    }
    // The eye, and the two rays along the borders.
    for column in [0, 6] {
        draw_line(framebuffer, in_camera(DVec3::ZERO), in_camera(point(column, 0)), Color::gray(60));
    }
    framebuffer.fill(fit.mark(in_camera(DVec3::ZERO), 2.0), Color::WHITE);
}
// ANCHOR_END: frustum

fn main() -> ExitCode {
    CHAPTER.main()
}
