//! A picture, and beside it the camera's view volume from outside.

use std::f64::consts::PI;

use glam::{DVec2, DVec3, DVec4, dvec2, dvec3};
use rasterbook::clip::{ClipTest, Plane, clip_polygon};
use rasterbook::depth::DepthTest;
use rasterbook::exact::edge::Coverage;
use rasterbook::figure::{Fit, Knob, Knobs, stroke};
use rasterbook::texture::{AddressMode, Texture};
use rasterbook::transform::{Frustum, Viewport, look_at, perspective_divide};
use rasterbook::{ClipVertex, Color, Framebuffer, Rect, Target};

use super::clipped::{ASPECT, draw};

pub(super) const OUTSIDE: &[Knob] = &[
    Knob::number(
        "near",
        2.0,
        [0.5, 6.0],
        "",
        "the near plane goes away from the eye: it passes through the yellow triangle and takes a piece from it",
    ),
    Knob::number(
        "far",
        9.0,
        [6.5, 13.0],
        "",
        "the far plane comes closer: the floor ends sooner, and the blue triangle goes piece by piece",
    ),
    Knob::number(
        "fov",
        45.0,
        [20.0, 75.0],
        "°",
        "the four sides open: more of the world comes into the picture, and all in it gets smaller",
    ),
    Knob::number(
        "angle",
        50.0,
        [-180.0, 180.0],
        "°",
        "the right camera goes round: at 0 it looks the same way as the left one; the picture stays",
    ),
];

/// A vertex in space, where the left camera is at the origin: what is interpolated is its place.
type Vertex = ClipVertex<3>;

/// Triangles in space and their colors; the floor has none of its own. One is inside, the others reach
/// through the right, the near and the far plane.
const SCENE: [([[f64; 3]; 3], Option<Color>); 6] = [
    ([[-7.0, -1.0, -2.0], [7.0, -1.0, -2.0], [7.0, -1.0, 14.0]], None),
    ([[-7.0, -1.0, -2.0], [7.0, -1.0, 14.0], [-7.0, -1.0, 14.0]], None),
    ([[-1.7, -1.0, 5.6], [0.5, -1.0, 5.0], [-0.6, 1.2, 5.2]], Some(Color::rgb(235, 80, 70))),
    ([[1.0, -1.0, 4.4], [4.6, -1.0, 5.6], [2.8, 1.3, 5.0]], Some(Color::rgb(90, 200, 110))),
    ([[-1.5, -1.0, 1.0], [-0.7, -1.0, 3.6], [-1.0, 0.5, 2.6]], Some(Color::rgb(245, 215, 70))),
    ([[0.2, -1.0, 7.2], [2.4, -1.0, 11.0], [1.4, 2.0, 9.2]], Some(Color::rgb(90, 140, 250))),
];

/// By all six planes.
const CANONICAL: (&[Plane], ClipTest) = (&Plane::CANONICAL, ClipTest::BeforeDivide);

/// On the left what the camera at the origin sees; on the right what another one sees, which goes round it.
pub(super) fn outside(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    let [near, far, fov, angle] = ["near", "far", "fov", "angle"].map(|name| knobs.number(name));
    let camera = Frustum::from_field_of_view(fov * PI / 180.0, ASPECT, near, far);
    let lens = Frustum::from_field_of_view(31.0 * PI / 180.0, ASPECT, 8.0, 60.0);
    let (sin, cos) = libm::sincos(angle * PI / 180.0);
    let (middle, away) = (dvec3(0.0, -0.5, 5.0), dvec3(20.0 * sin, 10.0, -20.0 * cos));
    // What is before the other camera; chapter 10 explains the matrix.
    let turned = look_at(middle + away, middle, DVec3::Y);
    let from_outside = |point: DVec3| lens.project(turned.transform_point3(point));

    let fit = Fit::new(framebuffer.rect(), [808.0, 300.0]);
    let [left, right] = [0.0, 408.0].map(|x| {
        let DVec2 { x, y } = fit.at(dvec2(x, 0.0));
        Viewport { x, y, width: 400.0 * fit.scale, height: 300.0 * fit.scale }
    });
    let mut target = Target::like(framebuffer);
    // Behind the far plane, whose depth of 1 is subject to rounding.
    target.clear(Color::gray(24), 2.0);
    target.color.fill(fit.rect(Rect::sized(400, 300)), Color::rgb(60, 75, 100));
    let floor = Texture::checkerboard(Color::rgb(90, 85, 80), Color::rgb(190, 185, 175));
    for (triangle, plain) in SCENE {
        let color = |[x, _, z]: [f64; 3]| {
            plain.unwrap_or_else(|| {
                Color::truncated(floor.nearest([(x + 0.5) / 2.0, z / 2.0], AddressMode::Repeat))
            })
        };
        let is_left = |place: [f64; 3]| {
            let clip = camera.project(place.into());
            CANONICAL.0.iter().all(|plane| plane.signed_distance(clip) >= 0.0)
        };
        let vertices = |project: &dyn Fn(DVec3) -> DVec4| {
            triangle.map(|place| Vertex { position: project(place.into()), varyings: place })
        };
        draw(&mut target, left, vertices(&|point| camera.project(point)), CANONICAL, color);
        // From outside all of it; each point is tested as clipping tests it.
        draw(&mut target, right, vertices(&from_outside), CANONICAL, |place| {
            if is_left(place) { color(place) } else { dimmed(color(place), 0.3) }
        });
    }
    for (ends, color) in edges(&camera) {
        line(&mut target, right, ends.map(from_outside), 2.0 * fit.scale, color);
    }
    *framebuffer = target.color;
}

/// The edges of a frustum, and four dimmer lines from the eye to its near plane.
fn edges(frustum: &Frustum) -> Vec<([DVec3; 2], Color)> {
    let Frustum { left, right, bottom, top, near, far } = *frustum;
    let vertices = [(left, bottom), (right, bottom), (right, top), (left, top)];
    let at = |i: usize, z: f64| dvec3(vertices[i % 4].0, vertices[i % 4].1, near) * (z / near);
    let of_side = |i: usize| {
        [
            ([DVec3::ZERO, at(i, near)], Color::gray(150)),
            ([at(i, near), at(i + 1, near)], Color::WHITE),
            ([at(i, far), at(i + 1, far)], Color::WHITE),
            ([at(i, near), at(i, far)], Color::WHITE),
        ]
    };
    (0..4).flat_map(of_side).collect()
}

fn dimmed(color: Color, brightness: f64) -> Color {
    Color::truncated(color.to_f64().map(|channel| channel * brightness))
}

/// A line between two points of clip space; behind what has been drawn it is dimmer.
fn line(target: &mut Target, viewport: Viewport, ends: [DVec4; 2], width: f64, color: Color) {
    // A segment is a polygon of two vertices.
    let mut segment = ends.map(|position| ClipVertex { position, varyings: [] }).to_vec();
    for plane in CANONICAL.0 {
        segment = clip_polygon::<0, 2>(&segment, plane, CANONICAL.1).to_vec();
    }
    let [a, b] = segment[..] else { return };
    let [a, b] = [a, b].map(|end| perspective_divide(end.position));
    let [start, end] = [a, b].map(|end| viewport.pixel_areas(end));
    for triangle in stroke([start, end], width.max(1.0)) {
        let Some(coverage) = Coverage::new(triangle) else { continue };
        for (x, y, _) in coverage.pixels(target.color.scissor()) {
            let center = dvec2(f64::from(x), f64::from(y)) + 0.5;
            let t = (center - start).dot(end - start) / start.distance_squared(end);
            let stored = target.depth.get(x, y).unwrap_or_default();
            let is_seen = DepthTest::LessOrEqual.passes(a.z + (b.z - a.z) * t, stored);
            target.color.set(x, y, if is_seen { color } else { dimmed(color, 0.5) });
        }
    }
}
