//! The view volume: what each of its planes cuts away, and what the projection makes of it.

use glam::{DVec2, DVec3, dvec2, dvec3};
use rasterbook::clip::{ClipTest, Plane, clip_triangle};
use rasterbook::figure::{Fit, Knob, Knobs};
use rasterbook::line::{StepAxis, dda};
use rasterbook::transform::{Frustum, perspective_divide};
use rasterbook::{ClipVertex, Color, Framebuffer};

use super::clipped::VIEW;

pub(super) const PLANES: &[Knob] = &[
    Knob::switch(
        "left",
        true,
        "off: what lies beyond the left border stays from the second drawing on",
    ),
    Knob::switch(
        "right",
        true,
        "off: what lies beyond the right border stays from the third drawing on",
    ),
    Knob::switch("bottom", true, "off: what lies below stays from the fourth drawing on"),
    Knob::switch("top", true, "off: what lies above stays from the fifth drawing on"),
    Knob::switch("near", true, "off: what is too near stays in the last two drawings"),
    Knob::switch("far", true, "off: what is too far stays in the last drawing"),
];

pub(super) const DEPTHS: &[Knob] = &[
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

fn draw_line(framebuffer: &mut Framebuffer, a: DVec2, b: DVec2, color: Color) {
    dda(a, b, StepAxis::Longer, framebuffer.scissor(), |x, y| framebuffer.set(x, y, color));
}

// ANCHOR: plane_by_plane
/// The polygon in NDC after no plane, one, two, … six; in each panel the view is the square in the
/// middle. A plane that is switched off cuts nothing.
pub(super) fn planes(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    const PANEL: f64 = 200.0;
    framebuffer.clear(Color::gray(24));
    let fit = Fit::new(framebuffer.rect(), [4.0 * PANEL, 2.0 * PANEL]);
    let vertices = [[-10_400.0, 2600.0, 90.0], [58.0, -245.0, 3.0], [820.0, 576.0, 8.0]];
    let triangle =
        vertices.map(|view| ClipVertex { position: VIEW.project(DVec3::from(view)), varyings: [] });
    let is_on = ["left", "right", "bottom", "top", "near", "far"].map(|name| knobs.is_on(name));
    for count in 0..=6 {
        let middle = PANEL * dvec2(0.5 + (count % 4) as f64, if count < 4 { 1.5 } else { 0.5 });
        let in_panel = |ndc: DVec2| fit.at(middle + ndc * 45.0);
        let place =
            |vertex: &ClipVertex<0>| in_panel(perspective_divide(vertex.position).truncate());

        let view = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|corner| in_panel(corner.into()));
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
pub(super) fn frustum(framebuffer: &mut Framebuffer, knobs: &Knobs) {
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
            draw_line(
                framebuffer,
                place(point(column, 0)),
                place(point(column, 4)),
                Color::gray(90),
            );
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
        draw_line(
            framebuffer,
            in_camera(DVec3::ZERO),
            in_camera(point(column, 0)),
            Color::gray(60),
        );
    }
    framebuffer.fill(fit.mark(in_camera(DVec3::ZERO), 2.0), Color::WHITE);
}
// ANCHOR_END: frustum
