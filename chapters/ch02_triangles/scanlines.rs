//! Triangles by rows: split at the middle vertex, walk up both edges, fill what lies between.

use glam::{DVec2, DVec3, dvec2};
use rasterbook::figure::{Fit, Knob, Knobs, Subject};
use rasterbook::scanline::{EdgeWalk, spans, split};
use rasterbook::{Color, Framebuffer};

// ANCHOR: fill
/// Colors all pixels of a triangle.
fn fill(framebuffer: &mut Framebuffer, triangle: [DVec2; 3], edges: EdgeWalk, color: Color) {
    spans(triangle, edges, framebuffer.scissor(), |span| {
        for x in span.columns() {
            framebuffer.set(x, span.y, color);
        }
    });
}
// ANCHOR_END: fill

/// The book's triangle.
pub(super) const FLAT: &[Knob] = &[
    Knob::point(
        "a",
        [100.0, 0.0],
        "bring it to the line from b to c: the triangle gets narrow, then it is gone",
    ),
    Knob::point("b", [100.0, 300.0], "bring it below c: the order of the vertices does not matter"),
    Knob::point(
        "c",
        [300.0, 0.0],
        "move it by fractions of a pixel: a row ends with the pixel in which its end lies",
    ),
];

/// The triangle of three knobs.
pub(super) fn flat(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    let fit = Fit::new(framebuffer.rect(), [640.0, 480.0]);
    let triangle = ["a", "b", "c"].map(|name| fit.at(knobs.point(name)));
    fill(framebuffer, triangle, EdgeWalk::Clamped, Color::RED);
}

pub(super) const SPLIT: &[Knob] = &[
    Knob::point(
        "a",
        [430.0, 40.0],
        "raise it above b: it is now the middle vertex, and the cut goes through it",
    ),
    Knob::point(
        "b",
        [90.0, 190.0],
        "the cut has its height, and P′ slides along the opposite edge",
    ),
    Knob::point("c", [540.0, 440.0], "lower it to the height of b: the upper half vanishes"),
];

// ANCHOR: split_in_two
/// The halves in two colors; the vertices and P′ marked.
pub(super) fn split_in_two(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    let fit = Fit::new(framebuffer.rect(), [640.0, 480.0]);
    let triangle = ["a", "b", "c"].map(|name| fit.at(knobs.point(name)));
    // A triangle without area has no halves.
    let Some(split) = split(triangle) else { return };
    let halves = [(split.lower, Color::rgb(230, 120, 40)), (split.upper, Color::rgb(50, 110, 210))];
    for (half, color) in halves {
        half.spans(EdgeWalk::Clamped, framebuffer.scissor(), |span| {
            for x in span.columns() {
                framebuffer.set(x, span.y, color);
            }
        });
        for end in [half.left.start, half.left.end, half.right.start, half.right.end] {
            let is_new = !triangle.contains(&end);
            let color = if is_new { Color::rgb(255, 230, 0) } else { Color::WHITE };
            framebuffer.fill(fit.mark(end, 4.0), color);
        }
    }
}
// ANCHOR_END: split_in_two

pub(super) const TREE: &[Knob] = &[Knob::number(
    "tilt",
    0.001,
    [0.0, 1.0],
    "pixels",
    "without the clamp rows shoot out, the farther the smaller it is; at 0 and from 0.5 on none does",
)];

/// The tree with x free to leave its edges.
pub(super) fn overshoot(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    tree(framebuffer, EdgeWalk::Unclamped, knobs.number("tilt"));
}

/// The tree with x kept between the ends of its edges.
pub(super) fn clamped(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    tree(framebuffer, EdgeWalk::Clamped, knobs.number("tilt"));
}

// ANCHOR: tree
/// A fir tree. Each layer's base is horizontal but for twice the tilt. If that is two thousandths
/// of a pixel, one step of y moves x by 30,000 to 100,000, in a larger picture by more.
fn tree(framebuffer: &mut Framebuffer, edges: EdgeWalk, tilt: f64) {
    let fit = Fit::new(framebuffer.rect(), [320.0, 320.0]);
    for i in 0..6 {
        let layer = f64::from(i);
        let (base, half_width) = (60.0 + 36.0 * layer, 100.0 - 14.0 * layer);
        let [left, right, top] =
            [(160.0 - half_width, base), (160.0 + half_width, base), (160.0, base + 70.0)]
                .map(|vertex| fit.at(vertex.into()));
        // The base is on a whole row, whatever the size; its lower end is now on the left, now on
        // the right.
        let (base, tilt) = (left.y.round(), if i % 2 == 0 { tilt } else { -tilt });
        let triangle = [dvec2(left.x, base - tilt), dvec2(right.x, base + tilt), top];
        fill(framebuffer, triangle, edges, Color::rgb(20, 90 + 22 * i, 50));
    }
}
// ANCHOR_END: tree

// ANCHOR: facets
/// A model's triangles, seen along z, from far to near; each in one gray.
pub(super) fn facets(framebuffer: &mut Framebuffer, subject: &Subject) {
    let mut triangles: Vec<[DVec3; 3]> = Vec::new();
    for part in subject.model.parts.iter() {
        let vertices = part.mesh.vertices();
        triangles.extend(
            part.mesh.triangles().map(|triangle| triangle.map(|index| vertices[index].position)),
        );
    }
    triangles.sort_by(|a, b| depth_sum(b).total_cmp(&depth_sum(a)));

    let fit = Fit::new(framebuffer.rect(), [480.0, 480.0]);
    for [a, b, c] in triangles {
        // How much of a face's normal points to us: the cosine of the angle at which we see it.
        let facing = -(c - a).cross(b - a).normalize_or_zero().z;
        if facing > 0.0 {
            let triangle =
                [a, b, c].map(|point| fit.at(dvec2(240.0, 240.0) + point.truncate() * 135.0));
            fill(
                framebuffer,
                triangle,
                EdgeWalk::Clamped,
                Color::gray((40.0 + 215.0 * facing) as u8),
            );
        }
    }
}

/// The distance of a triangle's middle, times three.
fn depth_sum(triangle: &[DVec3; 3]) -> f64 {
    triangle.iter().map(|vertex| vertex.z).sum()
}
// ANCHOR_END: facets
