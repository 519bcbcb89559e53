//! # Chapter 7: clipping
//!
//! **What if a triangle reaches behind the eye?** There the division mirrors everything. What is not in front
//! must be cut away before the divide, where edges and values are still linear; the depth must be linear there too.
//!
//! New here: the depth a + b/z, which changes linearly on the screen (`lib/depth.rs`, `lib/interpolate.rs`), and clipping
//! (`lib/clip.rs`). Book: chapter 7.

use std::process::ExitCode;

use arrayvec::ArrayVec;
use glam::{DVec4, dvec2, dvec3, dvec4};
use rasterbook::clip::{ClipTest, ClipVolume, NdcVertex, Plane, clip_polygon, fan};
use rasterbook::depth::DepthEncoding;
use rasterbook::figure::{Chapter, Fit, Knob, Knobs, Variant};
use rasterbook::interpolate::{Projected, ScreenVertex};
use rasterbook::line::{StepAxis, dda};
use rasterbook::texture::{AddressMode, Texture};
use rasterbook::transform::perspective;
use rasterbook::{ClipVertex, Color, Framebuffer, Target};

pub(crate) const CHAPTER: Chapter = Chapter {
    name: "ch07_clipping",
    question: "What if a triangle reaches behind the eye?",
    variants: &[
        Variant::with_knobs("in-front", in_front, &[BEGIN, CUT], "the same floor, clipped at the near plane: it ends at the horizon, and below the picture's lower edge")
            .source("section 7.3, Figure 7-5"),
        Variant::with_knobs("near", near, &[WALL_CUT, WALL], "two crossing walls, cut off at w = 15: compare with 'reciprocal', their near ends are gone")
            .source("section 7.4, Figure 7-10"),
        Variant::with_knobs("reciprocal", reciprocal, &[WALL], "two crossing walls with the depth −1/z: they meet in a straight, vertical line")
            .source("section 7.2"),
        Variant::with_knobs("behind", behind, &[BEGIN], "a floor that begins behind the eye, not clipped: what is behind us turns up in the sky, upside down")
            .source("section 7.3, Figure 7-5").remedied_by("in-front"),
        Variant::with_knobs("polygon", polygon, LINE, "left: a polygon and a line that cuts it; right: what is left. Green: where the outline enters, red: where it leaves")
            .source("section 7.4, Figure 7-6"),
    ],
};

const BEGIN: Knob = Knob::number(
    "begin",
    -6.0,
    [-20.0, 8.0],
    "",
    "where the floor begins: as soon as that is in front of the eye, above 0, 'behind' looks like 'in-front'",
);
const CUT: Knob = Knob::number(
    "cut",
    0.5,
    [0.05, 8.0],
    "",
    "the cut goes away from the eye: from 1.25 on the floor leaves the lower border",
);
const WALL_CUT: Knob = Knob::number(
    "cut",
    15.0,
    [5.0, 100.0],
    "",
    "the cut goes away from the eye: the wall's near end moves to the right, beyond 55 the other wall is gone",
);
const WALL: Knob = Knob::number(
    "distance",
    55.0,
    [20.0, 100.0],
    "",
    "the wall that faces us goes away: the line in which they meet moves to the right and stays vertical",
);
const LINE: &[Knob] = &[
    Knob::number(
        "place",
        190.0,
        [20.0, 270.0],
        "",
        "the line moves to the right: the points of the cut come and go in pairs of red and green",
    ),
    Knob::number(
        "slope",
        0.05,
        [-0.2, 0.2],
        "",
        "the line tilts: each point of the cut stays on an edge",
    ),
];

/// The depth that the buffer is cleared to: larger than −1/z of anything drawn.
const FAR_AWAY: f64 = 1000.0;

// ANCHOR: draw
/// Draws a triangle from clip space: clip, divide, fill with depth test.
fn draw(
    target: &mut Target,
    triangle: [ClipVertex<2>; 3],
    volume: ClipVolume,
    to_screen: impl Fn(NdcVertex<2>) -> glam::DVec2,
    texel: impl Fn([f64; 2]) -> Color,
) {
    // The scenes are made for a picture of 640×480.
    let fit = Fit::new(target.color.rect(), [640.0, 480.0]);
    let planes = volume.planes(Default::default());
    for piece in fan(target.clip_triangle(triangle, &planes, ClipTest::BeforeDivide)) {
        let on_screen = piece.map(|vertex| {
            let divided = NdcVertex::from(vertex);
            let projected = Projected { w: divided.w, values: divided.varyings };
            // a + b/z changes linearly on the screen: it is stepped beside t′, without correction.
            ScreenVertex { position: to_screen(divided), varyings: (projected, divided.position.z) }
        });
        target.fill(fit.triangle(on_screen), &texel);
    }
}
// ANCHOR_END: draw

// ANCHOR: vertex
/// Projects a point. The third component is b = −1, a = 0: after the divide the depth is −1/z.
fn vertex([x, y, z]: [f64; 3], near: f64, uv: [f64; 2]) -> ClipVertex<2> {
    let clip = perspective(dvec3(x, y, z), near);
    let z = DepthEncoding::Reciprocal.clip_z(z, near, FAR_AWAY);
    ClipVertex { position: DVec4 { z, ..clip }, varyings: uv }
}
// ANCHOR_END: vertex

// ANCHOR: walls
/// The book's scene: a wall that runs away from us, and one at the distance 55 (or another) that
/// faces us.
fn walls(framebuffer: &mut Framebuffer, distance: f64, volume: ClipVolume) {
    let at = |x: f64, y: f64, z: f64| vertex([x, y, z], 9.0, [x / 1280.0, y / 480.0]);
    let mut target = Target::like(framebuffer);
    target.clear(Color::BLACK, FAR_AWAY);
    let texture = Texture::book();
    for triangle in [
        [at(0.0, 0.0, 10.0), at(0.0, 480.0, 10.0), at(1280.0, 0.0, 100.0)],
        [at(1280.0, 0.0, 100.0), at(0.0, 480.0, 10.0), at(1280.0, 480.0, 100.0)],
        [at(0.0, 0.0, distance), at(0.0, 480.0, distance), at(1280.0, 0.0, distance)],
        [at(1280.0, 480.0, distance), at(0.0, 480.0, distance), at(1280.0, 0.0, distance)],
    ] {
        let texel = |uv| Color::truncated(texture.nearest(uv, AddressMode::Clamp));
        draw(&mut target, triangle, volume, |divided| divided.position.truncate(), texel);
    }
    *framebuffer = target.color;
}

/// Nothing needs to be cut away: everything is in front.
fn reciprocal(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    walls(framebuffer, knobs.number("distance"), ClipVolume::Everything);
}

/// Cut off at w = 15, unless the knob says otherwise.
fn near(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    walls(framebuffer, knobs.number("distance"), ClipVolume::InFront(knobs.number("cut")));
}
// ANCHOR_END: walls

// ANCHOR: behind
/// A checkered floor from 6 behind the eye, begin = −6, to 60 in front of it.
fn floor(framebuffer: &mut Framebuffer, begin: f64, volume: ClipVolume) {
    let at = |x: f64, z: f64| vertex([x, -1.0, z], 300.0, [x / 2.0, z / 2.0]);
    let [a, b] = [at(-4.0, begin), at(4.0, begin)];
    let [c, d] = [at(4.0, 60.0), at(-4.0, 60.0)];
    let texture = Texture::checkerboard(Color::rgb(60, 80, 110), Color::rgb(230, 225, 200));
    let texel = |uv| Color::truncated(texture.nearest(uv, AddressMode::Repeat));

    let mut target = Target::like(framebuffer);
    target.clear(Color::rgb(20, 24, 32), FAR_AWAY);
    for triangle in [[a, b, c], [a, c, d]] {
        let to_screen = |divided: NdcVertex<2>| dvec2(320.0, 240.0) + divided.position.truncate();
        draw(&mut target, triangle, volume, to_screen, texel);
    }
    *framebuffer = target.color;
}

/// Not clipped: the divide mirrors what is behind the eye.
fn behind(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    floor(framebuffer, knobs.number("begin"), ClipVolume::Everything);
}

/// Clipped a little in front of the eye.
fn in_front(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    floor(framebuffer, knobs.number("begin"), ClipVolume::InFront(knobs.number("cut")));
}
// ANCHOR_END: behind

// ANCHOR: polygon
/// A polygon that a line crosses four times, and the part of it on one side.
fn polygon(framebuffer: &mut Framebuffer, knobs: &Knobs) {
    let (place, slope) = (knobs.number("place"), knobs.number("slope"));
    let vertices = [
        (40.0, 90.0),
        (270.0, 60.0),
        (250.0, 210.0),
        (140.0, 240.0),
        (280.0, 300.0),
        (220.0, 420.0),
        (70.0, 380.0),
    ];
    let outline =
        vertices.map(|(x, y)| ClipVertex { position: dvec4(x, y, 0.0, 1.0), varyings: [] });
    // Kept is what lies left of the line x = place + slope · y: with w = 1 a plane of clip space is
    // a line.
    let plane = Plane::homogeneous(dvec4(-1.0, slope, 0.0, place));
    let kept: ArrayVec<ClipVertex<0>, 16> = clip_polygon(&outline, &plane, ClipTest::BeforeDivide);

    let fit = Fit::new(framebuffer.rect(), [640.0, 480.0]);
    let at = |point: DVec4| fit.at(dvec2(point.x, point.y));
    let line = |framebuffer: &mut Framebuffer, a: DVec4, b: DVec4, color| {
        dda(at(a), at(b), StepAxis::Longer, framebuffer.scissor(), |x, y| {
            framebuffer.set(x, y, color);
        });
    };
    let right = dvec4(330.0, 0.0, 0.0, 0.0);
    for shift in [DVec4::ZERO, right] {
        let [low, high] = [0.0, 480.0].map(|y| dvec4(place + slope * y, y, 0.0, 1.0));
        line(framebuffer, low + shift, high + shift, Color::rgb(255, 200, 60));
    }
    for (vertices, shift, color) in
        [(&outline[..], DVec4::ZERO, Color::rgb(120, 160, 230)), (&kept, right, Color::WHITE)]
    {
        for (i, start) in vertices.iter().enumerate() {
            let end = vertices[(i + 1) % vertices.len()];
            line(framebuffer, start.position + shift, end.position + shift, color);
        }
    }

    // An outline enters where the vertex after the cut is off the line, and inside.
    for (i, cut) in kept.iter().enumerate().filter(|(_, vertex)| !outline.contains(vertex)) {
        let enters = plane.signed_distance(kept[(i + 1) % kept.len()].position) > 1e-9;
        let color = if enters { Color::rgb(60, 220, 90) } else { Color::rgb(240, 60, 50) };
        for shift in [DVec4::ZERO, right] {
            framebuffer.fill(fit.mark(at(cut.position + shift), 4.0), color);
        }
    }
}
// ANCHOR_END: polygon

fn main() -> ExitCode {
    CHAPTER.main()
}
