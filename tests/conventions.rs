//! The lines of the page on conventions that no unit test beside the code holds already.

use std::cell::RefCell;
use std::collections::BTreeSet;

use glam::{DVec2, DVec3, DVec4, dvec2, dvec3, dvec4};
use rasterbook::clip::{ClipTest, ClipVolume, DepthRange, Plane, clip_triangle, fan};
use rasterbook::cull::CullMode;
use rasterbook::depth::{DepthBuffer, DepthTest};
use rasterbook::interpolate::{Interpolation, Projected, ScreenVertex, step_values};
use rasterbook::line::{StepAxis, dda};
use rasterbook::merge::Merge;
use rasterbook::observer::Observer;
use rasterbook::payload::{Payload, StepClamp, Walk};
use rasterbook::probe::{Fragment, Piece, Probe};
use rasterbook::scanline::{self, EdgeWalk};
use rasterbook::texture::AddressMode;
use rasterbook::transform::{Frustum, perspective, perspective_divide};
use rasterbook::{
    ClipVertex, Color, Mesh, Pixel, Real, Rect, RenderState, Scanline, Shaded, Shader, Target, draw,
};

const SCISSOR: Rect = Rect::sized(400, 400);

/// The spans of a triangle: row, first column, column after the last.
fn spans(triangle: [(f64, f64); 3]) -> Vec<(i32, i32, i32)> {
    let mut spans = Vec::new();
    scanline::spans(triangle.map(DVec2::from), EdgeWalk::Clamped, SCISSOR, |span| {
        spans.push((span.y, span.columns().start, span.columns().end));
    });
    spans
}

#[test]
fn camera_space_is_left_handed() {
    let seen = |x, y, z| perspective_divide(perspective(dvec3(x, y, z), 1.0));
    assert!(seen(2.0, 0.0, 10.0).x > seen(1.0, 0.0, 10.0).x, "+x is right");
    assert!(seen(0.0, 2.0, 10.0).y > seen(0.0, 1.0, 10.0).y, "+y is up");
    let from_middle = |z| seen(1.0, 1.0, z).truncate().length();
    assert!(from_middle(20.0) < from_middle(10.0), "+z is away from us");
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
fn the_row_of_a_fractional_middle_vertex_is_drawn_twice() {
    let rows = |middle: f64| -> Vec<i32> {
        spans([(4.0, 0.0), (0.0, middle), (4.0, 5.0)]).into_iter().map(|span| span.0).collect()
    };
    assert_eq!(rows(2.5), [0, 1, 2, 2, 3, 4]);
    assert_eq!(rows(2.0), [0, 1, 2, 3, 4]);
}

#[test]
fn the_first_pixel_has_the_value_of_the_exact_start() {
    let triangle = [(0.5, 0.0), (8.5, 0.0), (0.5, 8.0)]
        .map(|(x, y)| ScreenVertex { position: dvec2(x, y), varyings: [x, y] });
    let mut emitted = Vec::new();
    step_values(triangle, Walk::default(), SCISSOR, |x, y, values| emitted.push((x, y, values)));
    assert_eq!(emitted[..2], [(0, 0, [0.5, 0.0]), (1, 0, [1.5, 0.0])]);
}

#[test]
fn the_end_point_of_a_line_is_not_drawn() {
    let pixels = |a: (f64, f64), b: (f64, f64)| {
        let mut pixels = Vec::new();
        dda(a.into(), b.into(), StepAxis::Longer, SCISSOR, |x, y| pixels.push((x, y)));
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
    assert_eq!(StepClamp::default(), StepClamp::Edges, "the book's remedy");
    assert_eq!(Interpolation::default(), Interpolation::PerspectiveCorrect);
    assert_eq!(AddressMode::default(), AddressMode::Clamp);
    let state = RenderState::default();
    assert_eq!(state.clip_volume, ClipVolume::Canonical);
    assert_eq!(state.clip_test, ClipTest::BeforeDivide);
    assert_eq!(state.depth_range, DepthRange::NegativeOneToOne);
    assert_eq!(state.front_face, rasterbook::area::Winding::CounterClockwise);
    assert_eq!(state.merge.depth_test, DepthTest::LessOrEqual);
}

fn clip_vertex(position: DVec4) -> ClipVertex<0> {
    ClipVertex { position, varyings: [] }
}

#[test]
fn a_point_on_a_clip_plane_is_inside() {
    let on_the_borders =
        [dvec4(-1.0, -1.0, 1.0, 1.0), dvec4(1.0, -1.0, 0.0, 1.0), dvec4(1.0, 1.0, 1.0, 1.0)].map(clip_vertex);
    for planes in [Plane::CANONICAL, Plane::ZERO_TO_ONE] {
        let touched = planes
            .iter()
            .filter(|plane| on_the_borders.iter().any(|v| plane.signed_distance(v.position) == 0.0));
        assert!(touched.count() >= 5);
        assert_eq!(clip_triangle(on_the_borders, &planes, ClipTest::BeforeDivide).as_slice(), on_the_borders);
    }
}

#[test]
fn clip_planes_come_in_the_order_of_the_book() {
    let [left, right, bottom, top, far] = [Plane::LEFT, Plane::RIGHT, Plane::BOTTOM, Plane::TOP, Plane::FAR];
    let canonical = ClipVolume::Canonical.planes(DepthRange::NegativeOneToOne);
    assert_eq!(canonical.as_slice(), [left, right, bottom, top, Plane::NEAR, far]);
    let other = ClipVolume::Canonical.planes(DepthRange::ZeroToOne);
    assert_eq!(other.as_slice(), [left, right, bottom, top, Plane::NEAR_ZERO, far]);
}

#[test]
fn a_fan_begins_at_the_first_vertex() {
    let polygon: arrayvec::ArrayVec<char, 4> = ['a', 'b', 'c', 'd'].into();
    assert_eq!(fan(polygon).collect::<Vec<_>>(), [['a', 'b', 'c'], ['a', 'c', 'd']]);
}

/// Flat colors on triangles that are given in clip space.
struct Flat;

impl Shader<3> for Flat {
    type Attributes = (DVec4, [f64; 3]);

    fn vertex(&self, &(position, color): &Self::Attributes) -> ClipVertex<3> {
        ClipVertex { position, varyings: color }
    }

    fn fragment<R: Real>(&self, color: [R; 3]) -> Shaded<R> {
        Shaded::opaque(color)
    }
}

/// Records the pixel and the color of every fragment, and how many pieces were culled.
#[derive(Debug, Default)]
struct Recorder {
    fragments: RefCell<Vec<(i32, i32, [f64; 4])>>,
    pieces: RefCell<usize>,
    culled: RefCell<usize>,
}

impl Observer for Recorder {}

impl Probe for Recorder {
    fn piece(&self, _: &dyn Fn() -> Piece) {
        *self.pieces.borrow_mut() += 1;
    }

    fn culled(&self) {
        *self.culled.borrow_mut() += 1;
    }

    fn fragment(&self, (x, y): Pixel, fragment: &dyn Fn() -> Fragment) {
        self.fragments.borrow_mut().push((x, y, fragment().color));
    }
}

const RED: [f64; 3] = [255.0, 0.0, 0.0];
const GREEN: [f64; 3] = [0.0, 255.0, 0.0];

type FlatTriangle = ([(f64, f64); 3], [f64; 3]);

fn record(triangles: &[FlatTriangle], state: &RenderState) -> (Target, Recorder) {
    let corners =
        triangles.iter().flat_map(|(corners, color)| corners.map(|(x, y)| (dvec4(x, y, 0.0, 1.0), *color)));
    let mesh = Mesh::unindexed(corners.collect()).expect("whole triangles");
    let mut target = Target::new(9, 9);
    target.clear(state.clear_color, state.clear_depth);
    let recorder = Recorder::default();
    draw(&mesh, &Flat, state, &Scanline, &mut target, &recorder);
    (target, recorder)
}

const TRIANGLE: [(f64, f64); 3] = [(-0.75, -0.75), (0.75, -0.75), (-0.75, 0.75)];
const REVERSED: [(f64, f64); 3] = [(-0.75, -0.75), (-0.75, 0.75), (0.75, -0.75)];

#[test]
fn the_front_runs_counter_clockwise() {
    let drawn = |corners, cull| {
        let state = RenderState { cull, ..RenderState::default() };
        !record(&[(corners, RED)], &state).1.fragments.borrow().is_empty()
    };
    assert!(drawn(TRIANGLE, CullMode::Back) && !drawn(REVERSED, CullMode::Back));
    assert_eq!(RenderState::default().cull, CullMode::None);
    assert!(drawn(TRIANGLE, CullMode::None) && drawn(REVERSED, CullMode::None));
}

#[test]
fn a_triangle_without_area_is_always_left_out() {
    let tiny = 3e-8;
    for corners in
        [[(-0.5, -0.5), (0.0, 0.0), (0.5, 0.5)], [(0.0, 0.0), (tiny, 0.0), (0.0, tiny)], [(0.1, 0.1); 3]]
    {
        for cull in [CullMode::None, CullMode::Back, CullMode::Front] {
            let (_, recorder) = record(&[(corners, RED)], &RenderState { cull, ..RenderState::default() });
            assert!(recorder.fragments.borrow().is_empty(), "{corners:?}");
            assert_eq!((*recorder.pieces.borrow(), *recorder.culled.borrow()), (1, 1));
        }
    }
}

#[test]
fn of_equal_depths_the_later_is_seen() {
    let color = |depth_test| {
        let merge = Merge { depth_test, ..Merge::default() };
        let (target, _) =
            record(&[(TRIANGLE, RED), (TRIANGLE, GREEN)], &RenderState { merge, ..RenderState::default() });
        target.color.get(2, 2)
    };
    assert_eq!(color(DepthTest::LessOrEqual), Some(Color::GREEN));
    assert_eq!(color(DepthTest::Less), Some(Color::RED));
}

#[test]
fn a_target_is_cleared_to_black_and_the_far_plane() {
    let state = RenderState::default();
    assert_eq!((state.clear_color, state.clear_depth), (Color::BLACK, 1.0));
    assert_eq!(DepthBuffer::new(2, 2).get(1, 1), Some(0.0), "not cleared yet");
}

#[test]
fn fragments_arrive_in_the_order_of_the_triangles() {
    let (_, recorder) = record(&[(TRIANGLE, RED), (REVERSED, GREEN)], &RenderState::default());
    let fragments = recorder.fragments.borrow();
    let first_green = fragments.iter().position(|fragment| fragment.2[1] == 255.0).expect("a green one");
    assert!(fragments[..first_green].iter().all(|fragment| fragment.2[0] == 255.0));
    assert!(fragments[first_green..].iter().all(|fragment| fragment.2[1] == 255.0));
    // Within a triangle rows go up, and columns to the right.
    let places: Vec<(i32, i32)> = fragments[..first_green].iter().map(|&(x, y, _)| (y, x)).collect();
    assert!(places.is_sorted());

    // A triangle that is cut at the right border: its pieces come in the order of the fan.
    let (_, recorder) = record(&[([(-0.5, -0.5), (2.0, 0.0), (-0.5, 0.5)], RED)], &RenderState::default());
    assert_eq!(*recorder.pieces.borrow(), 2);
}

// ---- Derivations that the pages give ------------------------------------------------------------------------------

#[test]
fn the_six_planes_are_the_walls_of_the_frustum() {
    let view = Frustum { left: -1.5, right: 2.0, bottom: -0.5, top: 1.0, near: 2.0, far: 9.0 };
    let Frustum { left, right, bottom, top, near, far } = view;
    for i in 0..4000 {
        // Points in and around the frustum, none of them on a wall.
        let part = |k: i32| f64::from(i * k % 997) / 997.0 + 1e-4;
        let point = dvec3(part(131) * 26.0 - 13.0, part(311) * 16.0 - 8.0, part(577) * 12.0);
        let clip = view.project(point);
        let on_glass = point * near / point.z;
        let is_inside = [
            on_glass.x > left,
            on_glass.x < right,
            on_glass.y > bottom,
            on_glass.y < top,
            point.z > near,
            point.z < far,
        ];
        assert_eq!(Plane::CANONICAL.map(|plane| plane.signed_distance(clip) > 0.0), is_inside, "{point}");
    }
}

#[test]
fn the_parameter_on_the_screen_from_that_in_space() {
    // t′ = t ωb / ((1 − t) ωa + t ωb), against points that are projected one by one.
    let (a, b) = (dvec3(-3.0, 1.0, 2.0), dvec3(5.0, -4.0, 11.0));
    let on_screen = |point: DVec3| point.x / point.z;
    for i in 0..=20 {
        let t = f64::from(i) / 20.0;
        let measured = (on_screen(a + (b - a) * t) - on_screen(a)) / (on_screen(b) - on_screen(a));
        assert!((measured - t * b.z / ((1.0 - t) * a.z + t * b.z)).abs() < 1e-12);
    }
}

#[test]
fn a_step_of_a_z_buffer_grows_with_the_square_of_the_distance() {
    // Δω ≈ Δ ω² (f − n) / (n f).
    let (near, far, step) = (1.0, 100.0, 1e-7);
    for w in [1.0, 2.0, 10.0, 50.0, 99.0] {
        let z = rasterbook::depth::z_from_w(w, near, far);
        let grown = rasterbook::depth::w_from_z(z + step, near, far) - w;
        let expected = step * w * w * (far - near) / (near * far);
        assert!((grown / expected - 1.0).abs() < 1e-3, "{grown} is not {expected} at {w}");
    }
}

#[test]
fn how_far_apart_two_surfaces_must_be() {
    use rasterbook::depth::{DepthFormat, reversed_z_from_w, z_from_w};

    // The table of chapter 6: the distance w; integers, `f32` and reversed `f32`; how much finer the last one is.
    let table = [
        (1.0, [5.96e-7, 5.96e-7, 7.45e-8], 8.0),
        (10.0, [5.96e-5, 5.96e-5, 9.31e-7], 64.0),
        (100.0, [0.00596, 0.00596, 5.82e-6], 1024.0),
        (500.0, [0.149, 0.149, 1.82e-5], 8192.0),
    ];
    let (near, far) = (0.1, 1000.0);
    for (w, expected, finer) in table {
        let ordinary = z_from_w(w, near, far);
        let reversed = reversed_z_from_w(w, near, far);
        let steps = [
            DepthFormat::Unorm24.step(ordinary),
            DepthFormat::Float32.step(ordinary),
            DepthFormat::Float32.step(reversed),
        ];
        let distances = steps.map(|step| step * w * w * (far - near) / (near * far));
        for (distance, expected) in distances.into_iter().zip(expected) {
            assert!((distance / expected - 1.0).abs() < 2e-3, "{distance} is not {expected} at {w}");
        }
        assert_eq!(steps[1] / steps[2], finer);

        // A little more than a step apart they are told apart, wherever they lie between two steps.
        for index in 0..100 {
            let from = w * (1.0 + f64::from(index) * 1e-5);
            let to = distances.map(|distance| from + 1.01 * distance);
            for (format, to) in [(DepthFormat::Unorm24, to[0]), (DepthFormat::Float32, to[1])] {
                let [a, b] = [from, to].map(|w| format.stored(z_from_w(w, near, far)));
                assert!(a < b, "{format:?} at {from}");
            }
            let stored = |w| DepthFormat::Float32.stored(reversed_z_from_w(w, near, far));
            assert!(stored(from) > stored(to[2]), "reversed at {from}");
        }
    }
}
