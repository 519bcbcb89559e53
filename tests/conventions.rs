//! The lines of the page on conventions that no unit test beside the code holds already.

use std::collections::BTreeSet;

use glam::{DVec2, dvec2, dvec3};
use rasterbook::Rect;
use rasterbook::interpolate::{Interpolation, Projected, step_values};
use rasterbook::line::{StepAxis, dda};
use rasterbook::scanline::{Corner, EdgeWalk, Payload, StepLimit, Walk, split};
use rasterbook::texture::AddressMode;
use rasterbook::transform::{perspective, perspective_divide};

const WINDOW: Rect = Rect::sized(400, 400);

/// The spans of a triangle: row, first column, column after the last.
fn spans(corners: [(f64, f64); 3]) -> Vec<(i32, i32, i32)> {
    let corners = corners.map(|position| Corner { position: DVec2::from(position), attributes: () });
    let mut spans = Vec::new();
    for half in split(corners, |(), (), _| ()).into_iter().flatten() {
        half.walk(
            |_| [(), ()],
            Walk::default(),
            WINDOW,
            |span| {
                spans.push((span.y, span.columns().start, span.columns().end));
            },
        );
    }
    spans
}

#[test]
fn camera_space_is_left_handed() {
    let seen = |x, y, z| perspective_divide(perspective(dvec3(x, y, z), 1.0));
    assert!(seen(2.0, 0.0, 10.0).x > seen(1.0, 0.0, 10.0).x, "+x is right");
    assert!(seen(0.0, 2.0, 10.0).y > seen(0.0, 1.0, 10.0).y, "+y is up");
    assert!(seen(1.0, 1.0, 20.0).length() < seen(1.0, 1.0, 10.0).length() * 20.0, "+z is away from us");
    assert!(seen(1.0, 1.0, 20.0).truncate().length() < seen(1.0, 1.0, 10.0).truncate().length());
    assert_eq!(perspective(dvec3(0.0, 0.0, 10.0), 1.0).w, 10.0);
}

#[test]
fn omega_is_the_z_of_camera_space() {
    assert_eq!(perspective(dvec3(3.0, 4.0, 7.0), 2.0).to_array(), [6.0, 8.0, 14.0, 7.0]);
}

#[test]
fn a_span_runs_from_trunc_start_while_x_is_at_most_end() {
    let row_0 = |right: f64| {
        spans([(1.9, 0.0), (right, 0.0), (1.9, 10.0)]).into_iter().find(|span| span.0 == 0 && span.2 > span.1)
    };
    assert_eq!(row_0(4.0), Some((0, 1, 5)), "columns 1 to 4");
    assert_eq!(row_0(3.999), Some((0, 1, 4)), "columns 1 to 3");
}

#[test]
fn rows_run_from_trunc_y1_while_y_is_below_y2() {
    let rows = |top: f64| -> Vec<i32> {
        let rows: BTreeSet<i32> =
            spans([(0.0, 1.9), (8.0, 1.9), (0.0, top)]).into_iter().map(|span| span.0).collect();
        rows.into_iter().collect()
    };
    assert_eq!(rows(5.0), [1, 2, 3, 4]);
    assert_eq!(rows(5.1), [1, 2, 3, 4, 5]);
}

#[test]
fn the_row_of_a_fractional_middle_corner_is_drawn_twice() {
    let rows = |middle: f64| -> Vec<i32> {
        spans([(4.0, 0.0), (0.0, middle), (4.0, 5.0)]).into_iter().map(|span| span.0).collect()
    };
    assert_eq!(rows(2.5), [0, 1, 2, 2, 3, 4]);
    assert_eq!(rows(2.0), [0, 1, 2, 3, 4]);
}

#[test]
fn the_first_pixel_has_the_value_of_the_exact_start() {
    let corners = [(0.5, 0.0), (8.5, 0.0), (0.5, 8.0)]
        .map(|(x, y)| Corner { position: dvec2(x, y), attributes: [x, y] });
    let mut emitted = Vec::new();
    step_values(corners, Walk::default(), WINDOW, |x, y, values| emitted.push((x, y, values)));
    assert_eq!(emitted[..2], [(0, 0, [0.5, 0.0]), (1, 0, [1.5, 0.0])]);
}

#[test]
fn the_end_point_of_a_line_is_not_drawn() {
    let pixels = |a: (f64, f64), b: (f64, f64)| {
        let mut pixels = Vec::new();
        dda(a.into(), b.into(), StepAxis::Longer, WINDOW, |x, y| pixels.push((x, y)));
        pixels
    };
    let line = pixels((100.0, 0.0), (100.0, 300.0));
    assert_eq!((line.len(), line[299]), (300, (100, 299)));
    assert_eq!(pixels((100.0, 300.0), (100.0, 0.0)), line);
    assert_eq!(pixels((0.0, 1.0), (3.0, 4.0)), [(0, 1), (1, 2), (2, 3)]);
}

#[test]
fn arithmetic_is_not_fused() {
    // Fused, −1 + 0.1 · 10 would keep the error of 0.1 and give 5.55e-17.
    assert_eq!((-1.0_f64).stepped(0.1, 10.0), 0.0);
    let [a, b] = [(100.0, 0.0), (340.0, 1.0)].map(|(w, v)| Projected { w, values: [v] });
    assert_eq!(Interpolation::PerspectiveCorrect.between(a, b, 0.5).values, [50.0 / 220.0]);
}

#[test]
fn the_default_of_every_option() {
    assert_eq!(StepAxis::default(), StepAxis::Longer);
    assert_eq!(EdgeWalk::default(), EdgeWalk::Clamped);
    assert_eq!(StepLimit::default(), StepLimit::Edges, "the book's remedy");
    assert_eq!(Interpolation::default(), Interpolation::PerspectiveCorrect);
    assert_eq!(AddressMode::default(), AddressMode::Clamp);
    let state = rasterbook::pipeline::RenderState::default();
    assert_eq!(state.clip_volume, rasterbook::clip::ClipVolume::Canonical);
    assert_eq!(state.clip_test, rasterbook::clip::ClipTest::BeforeDivide);
    assert_eq!(state.depth_range, rasterbook::clip::DepthRange::NegativeOneToOne);
    assert_eq!(state.front_face, rasterbook::area::Winding::CounterClockwise);
    assert_eq!(state.merge.depth_test, rasterbook::depth::DepthTest::LessOrEqual);
}
