//! # Chapter 4: projection
//!
//! **Why do distant things look smaller?** A point is seen where the line from it to the eye crosses the image plane.
//! Similar triangles make a division of it: x′ = n x / z.
//!
//! New here: homogeneous coordinates and the perspective projection (`lib/transform.rs`). The book has no program for
//! this chapter; the pictures here are made of the lines of chapter 2. Book: chapter 4.

use std::process::ExitCode;

use glam::{DVec2, DVec3, DVec4, dvec2, dvec3};
use rasterbook::figure::{Chapter, Fit, Knob, Knobs, Sketch, Variant};
use rasterbook::line::{StepAxis, dda};
use rasterbook::transform::{orthographic, perspective, perspective_divide};
use rasterbook::{Color, Framebuffer, Rect};

pub(crate) const CHAPTER: Chapter = Chapter {
    name: "ch04_projection",
    question: "Why do distant things look smaller?",
    variants: &[
        Variant::with_knobs("cube", cube, CUBE, "five cubes of one size, one behind the other: each looks smaller than the one before it, and so does its back")
            .source("section 4.2.2, Figure 4-3"),
        Variant::with_knobs("orthographic", orthographic_cubes, ORTHOGRAPHIC, "the same cubes without the division: all of one size, and each hides its own back"),
        Variant::with_knobs("rails", rails, RAILS, "parallel rails meet at the horizon; the yellow points, each projected by itself, lie on them: straight stays straight")
            .source("section 4.2.2, Figure 4-4"),
        Variant::new("near", near, "one scene at n = 150 (blue), 300 (green) and 600 (red): twice the distance n is twice the picture, and nothing else"),
        Variant::with_knobs("from-above", from_above, FROM_ABOVE, "two rods of one length, from above, and the rays from their ends to the eye: on the image plane the far one is the shorter one")
            .source("section 4.2.1"),
    ],
};

// ANCHOR: to_screen
/// Divides, and moves the point at which the camera looks to the middle of a picture of 640×480,
/// scaled to `picture`.
fn to_screen(clip: DVec4, picture: Rect) -> DVec2 {
    let fit = Fit::new(picture, [640.0, 480.0]);
    fit.at(dvec2(320.0, 240.0) + perspective_divide(clip).truncate())
}

/// Draws the segment between two points of space: it suffices to project its ends.
fn segment(
    framebuffer: &mut Framebuffer,
    project: impl Fn(DVec3) -> DVec4,
    a: DVec3,
    b: DVec3,
    color: Color,
) {
    let [a, b] = [a, b].map(|point| to_screen(project(point), framebuffer.rect()));
    dda(a, b, StepAxis::Longer, framebuffer.scissor(), |x, y| framebuffer.set(x, y, color));
}
// ANCHOR_END: to_screen

/// The vertices of a cube's front, in order around it.
const FRONT: [(f64, f64); 4] = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];

/// Draws the edges of a cube that faces us: those of the front in the color, the others dimmer.
fn draw_cube(
    framebuffer: &mut Framebuffer,
    project: impl Fn(DVec3) -> DVec4 + Copy,
    center: DVec3,
    half: f64,
    color: Color,
) {
    let vertex = |i: usize, z: f64| center + half * dvec3(FRONT[i % 4].0, FRONT[i % 4].1, z);
    let dim = Color::truncated(color.to_f64().map(|channel| channel * 0.55));
    for i in 0..4 {
        segment(framebuffer, project, vertex(i, 1.0), vertex(i + 1, 1.0), dim);
        segment(framebuffer, project, vertex(i, -1.0), vertex(i, 1.0), dim);
    }
    for i in 0..4 {
        segment(framebuffer, project, vertex(i, -1.0), vertex(i + 1, -1.0), color);
    }
}

const ASIDE: Knob = Knob::number(
    "aside",
    0.0,
    [-200.0, 200.0],
    "",
    "the eye goes to the right: in perspective near cubes move the most, without it all move alike",
);
const CUBE: &[Knob] = &[
    Knob::number(
        "near",
        520.0,
        [100.0, 2000.0],
        "",
        "the picture grows with n around its middle, and the cubes keep their shapes",
    ),
    Knob::number(
        "distance",
        600.0,
        [150.0, 2400.0],
        "",
        "from farther away the back of a cube is nearly as large as its front",
    ),
    ASIDE,
];
const ORTHOGRAPHIC: &[Knob] = &[ASIDE];

// ANCHOR: cubes
/// Five cubes, each farther away and more to the right than the one before it. The first is at a
/// distance from the eye, which may have gone aside.
fn cubes(
    framebuffer: &mut Framebuffer,
    project: impl Fn(DVec3) -> DVec4 + Copy,
    distance: f64,
    aside: f64,
) {
    let colors = [
        Color::rgb(255, 90, 80),
        Color::rgb(255, 180, 60),
        Color::rgb(240, 240, 90),
        Color::rgb(100, 220, 120),
        Color::rgb(90, 160, 255),
    ];
    for (i, color) in (0..).zip(colors) {
        let step = f64::from(i);
        let center =
            dvec3(-230.0 + 115.0 * step - aside, -150.0 + 75.0 * step, distance + 260.0 * step);
        draw_cube(framebuffer, project, center, 70.0, color);
    }
}

/// The cubes in perspective.
fn cube(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    let near = knobs.number("near");
    let project = |point| perspective(point, near);
    cubes(framebuffer, project, knobs.number("distance"), knobs.number("aside"));
}

/// The cubes without perspective: the distance would change nothing.
fn orthographic_cubes(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    cubes(framebuffer, orthographic, 600.0, knobs.number("aside"));
}
// ANCHOR_END: cubes

const RAILS: &[Knob] = &[
    Knob::number(
        "height",
        120.0,
        [10.0, 220.0],
        "",
        "the eye goes up: the rails close, and meet where they met before",
    ),
    Knob::number(
        "aside",
        0.0,
        [-250.0, 250.0],
        "",
        "the eye goes to the right: all lines rotate about the point where they meet",
    ),
];

// ANCHOR: rails
/// A railway line towards the horizon, seen from a height above the track; the eye may have gone
/// aside.
fn rails(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    let (height, aside) = (knobs.number("height"), knobs.number("aside"));
    let project = |point: DVec3| perspective(point - dvec3(aside, height, 0.0), 300.0);
    let (first, last) = (150.0, 60_000.0);

    // Sleepers at equal distances, and poles beside the track.
    for i in 0..120 {
        let z = first + 90.0 * f64::from(i);
        segment(
            framebuffer,
            project,
            dvec3(-140.0, 0.0, z),
            dvec3(140.0, 0.0, z),
            Color::rgb(130, 85, 50),
        );
        if i % 4 == 2 {
            segment(
                framebuffer,
                project,
                dvec3(260.0, 0.0, z),
                dvec3(260.0, 230.0, z),
                Color::gray(150),
            );
        }
    }

    // What is parallel to the track: two rails, and the wire along the poles.
    let [left, right, wire] = [(-100.0, 0.0), (100.0, 0.0), (260.0, 230.0)];
    for (x, y) in [left, right, wire] {
        segment(
            framebuffer,
            project,
            dvec3(x, y, first),
            dvec3(x, y, last),
            Color::rgb(210, 220, 230),
        );
    }

    // Points on the rails, each projected by itself.
    let fit = Fit::new(framebuffer.rect(), [640.0, 480.0]);
    for i in 0..10 {
        let z = first + 180.0 * f64::from(i);
        for (x, y) in [left, right] {
            let point = to_screen(project(dvec3(x, y, z)), framebuffer.rect());
            framebuffer.fill(fit.mark(point, 1.0), Color::rgb(255, 220, 0));
        }
    }
}
// ANCHOR_END: rails

// ANCHOR: near
/// One scene, three distances of the image plane.
fn near(framebuffer: &mut Framebuffer) {
    for (near, color) in [
        (600.0, Color::rgb(255, 90, 80)),
        (300.0, Color::rgb(100, 220, 120)),
        (150.0, Color::rgb(100, 150, 255)),
    ] {
        let project = |point| perspective(point, near);
        draw_cube(framebuffer, project, dvec3(-70.0, -20.0, 650.0), 110.0, color);
        draw_cube(framebuffer, project, dvec3(170.0, 60.0, 900.0), 90.0, color);
    }
}
// ANCHOR_END: near

const FROM_ABOVE: &[Knob] = &[
    Knob::point(
        "a",
        [170.0, 250.0],
        "go up with it, twice as far from the eye: its image is half as long",
    ),
    Knob::point(
        "b",
        [450.0, 440.0],
        "go to the side with it: its image moves, and keeps its length",
    ),
    Knob::number(
        "near",
        140.0,
        [60.0, 200.0],
        "",
        "the plane goes away from the eye: both images grow, and the longer one stays longer by the same factor",
    ),
];

/// Two rods from above, x to the right and z upwards, the eye at the bottom, and their images on the plane.
fn from_above(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    const EYE: DVec2 = DVec2::new(320.0, 30.0);
    let fit = Fit::new(framebuffer.rect(), [640.0, 480.0]);
    let near = knobs.number("near");
    let half = dvec2(80.0, 0.0);
    let rods = [("a", [240.0, 150.0, 50.0]), ("b", [90.0, 160.0, 255.0])].map(|(name, color)| {
        let place = knobs.point(name) - EYE;
        // It stays behind the plane.
        let middle = dvec2(place.x, place.y.max(near + 4.0));
        ([middle - half, middle + half], color)
    });

    let mut sketch = Sketch::new(framebuffer, fit);
    for (ends, color) in rods {
        let [left, right] = ends.map(|end| EYE + end);
        sketch.triangle([EYE, left, right], Color::truncated(color.map(|channel| channel * 0.25)));
    }
    sketch.line(EYE + dvec2(-290.0, near), EYE + dvec2(290.0, near), 2.0, Color::gray(150));
    for (ends, color) in rods {
        let image = ends.map(|end| {
            let on_plane = perspective_divide(perspective(dvec3(end.x, 0.0, end.y), near));
            EYE + dvec2(on_plane.x, near)
        });
        let [left, right] = ends.map(|end| EYE + end);
        let color = Color::truncated(color);
        for end in [left, right] {
            sketch.line(EYE, end, 2.0, color);
        }
        sketch.line(left, right, 9.0, color);
        sketch.line(image[0], image[1], 9.0, color);
        sketch.dot((left + right) / 2.0, 7.0, Color::WHITE);
    }
    sketch.dot(EYE, 8.0, Color::WHITE);
}

fn main() -> ExitCode {
    CHAPTER.main()
}
