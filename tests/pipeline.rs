//! The pipeline as a whole: what must be equal is equal, whatever way it is drawn.

use std::cell::RefCell;

use glam::{DVec2, DVec3, dvec3};
use proptest::prelude::*;
use rasterbook::area::Winding;
use rasterbook::clip::{Assembled, ClipVolume};
use rasterbook::cull::CullMode;
use rasterbook::depth::{DepthEncoding, DepthTest};
use rasterbook::exact::Exact;
use rasterbook::interpolate::Interpolation;
use rasterbook::merge::{Merge, Verdict};
use rasterbook::model::{Model, ModelVertex};
use rasterbook::observer::Observer;
use rasterbook::payload::{StepClamp, Walk};
use rasterbook::probe::{Fragment, Piece, Probe};
use rasterbook::raster::Rasterizer;
use rasterbook::transform::{Frustum, Viewport, about, rotate_x_to_y, rotate_z_to_y};
use rasterbook::{
    ClipVertex, Color, Framebuffer, LoadOp, Mesh, Pixel, Real, Rect, RenderState, Scanline, Shaded, Shader,
    Silent, Target, draw,
};

const VIEW: Frustum = Frustum { left: -1.0, right: 1.0, bottom: -0.75, top: 0.75, near: 1.0, far: 20.0 };
const SIZE: (u32, u32) = (64, 48);

/// A point of camera space and its color; its place travels along as varyings.
#[derive(Clone, Copy, Debug)]
struct Point {
    view: DVec3,
    color: [f64; 3],
}

struct Places;

impl Shader<6> for Places {
    type Attributes = Point;

    fn vertex(&self, point: &Point) -> ClipVertex<6> {
        let [x, y, z] = point.view.to_array();
        let [r, g, b] = point.color;
        ClipVertex { position: VIEW.project(point.view), varyings: [x, y, z, r, g, b] }
    }

    fn fragment<R: Real>(&self, [_, _, _, r, g, b]: [R; 6]) -> Shaded<R> {
        Shaded::opaque([r, g, b])
    }
}

fn render(points: &[Point], state: RenderState, probe: &impl Probe) -> Target {
    let mut target = Target::new(SIZE.0, SIZE.1);
    target.clear(state.clear_color, state.clear_depth);
    let mesh = Mesh::unindexed(points.to_vec()).expect("whole triangles");
    draw(&mesh, &Places, &state, &Scanline, &mut target, probe);
    target
}

fn point() -> impl Strategy<Value = Point> {
    (prop::array::uniform3(0.0..255.0), -6.0..6.0, -5.0..5.0, -2.0..22.0)
        .prop_map(|(color, x, y, z)| Point { view: dvec3(x, y, z), color })
}

fn triangles(count: std::ops::Range<usize>) -> impl Strategy<Value = Vec<Point>> {
    prop::collection::vec(prop::array::uniform3(point()), count).prop_map(|triangles| triangles.concat())
}

fn colors(target: &Target) -> Vec<Color> {
    target.color.rows_from_top().flatten().copied().collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn a_load_operation_clears_as_clearing_does(points in triangles(0..4), color in any::<[u8; 3]>()) {
        let [red, green, blue] = color;
        let state = RenderState { clear_color: Color::rgb(red, green, blue), clear_depth: 0.9, ..RenderState::default() };
        let cleared = render(&points, state, &Silent);
        let mesh = Mesh::unindexed(points).expect("whole triangles");
        let mut target = Target::new(SIZE.0, SIZE.1);
        target.clear(Color::WHITE, -1.0);
        draw(&mesh, &Places, &RenderState { load: LoadOp::Clear, ..state }, &Scanline, &mut target, &Silent);
        prop_assert!(target.color == cleared.color && target.depth == cleared.depth);
    }

    #[test]
    fn clockwise_and_counter_clockwise_make_all(points in triangles(1..6)) {
        let culled = |cull| RenderState { cull, ..RenderState::default() };
        let all = render(&points, culled(CullMode::None), &Silent);
        let [back, front] = [CullMode::Back, CullMode::Front].map(|cull| render(&points, culled(cull), &Silent));
        let [all_colors, back_colors, front_colors] = [&all, &back, &front].map(colors);
        for (i, color) in all_colors.into_iter().enumerate() {
            prop_assert!(color == back_colors[i] || color == front_colors[i]);
        }
        for y in all.color.rect().rows() {
            for x in all.color.rect().columns() {
                let [all, back, front] = [&all, &back, &front].map(|target| target.depth.get(x, y).expect("inside"));
                prop_assert_eq!(all, back.min(front));
            }
        }
    }

    #[test]
    fn front_face_turns_culling_round(points in triangles(1..4)) {
        let picture = |cull, front_face| render(&points, RenderState { cull, front_face, ..RenderState::default() }, &Silent);
        let a = picture(CullMode::Back, Winding::Clockwise);
        let b = picture(CullMode::Front, Winding::CounterClockwise);
        prop_assert_eq!(colors(&a), colors(&b));
    }

    #[test]
    fn order_does_not_matter_with_a_depth_test(points in triangles(2..5)) {
        // Unless two fragments are equally far: `Less` keeps the first of them, `LessOrEqual` the last.
        let reversed: Vec<Point> = points.chunks(3).rev().flatten().copied().collect();
        let [forth, back] = [&points, &reversed].map(|points| render(points, RenderState::default(), &Silent));
        prop_assert_eq!(&forth.depth, &back.depth, "the nearest depth is the nearest depth");
        let merge = |depth_test| Merge { depth_test, ..Merge::default() };
        let less = render(&points, RenderState { merge: merge(DepthTest::Less), ..RenderState::default() }, &Silent);
        let less = colors(&less);
        for (i, (a, b)) in colors(&forth).into_iter().zip(colors(&back)).enumerate() {
            prop_assert!(a == b || less[i] != a, "pixel {} differs without a tie", i);
        }
    }

    #[test]
    fn indexed_equals_unindexed(points in prop::collection::vec(point(), 3..8), order in prop::collection::vec(0_u32..3, 9)) {
        let mesh = Mesh::indexed(points, order).expect("indices in range");
        let [a, b] = [&mesh, &mesh.to_unindexed()].map(|mesh| {
            let mut target = Target::new(SIZE.0, SIZE.1);
            target.clear(Color::BLACK, 1.0);
            draw(mesh, &Places, &RenderState::default(), &Scanline, &mut target, &Silent);
            target
        });
        prop_assert_eq!(colors(&a), colors(&b));
        prop_assert_eq!(a.depth, b.depth);
    }

    #[test]
    fn varyings_are_where_the_ray_meets_the_triangle(points in triangles(1..2)) {
        // Each fragment's place in camera space, as it arrives in the fragment shader, must lie in the plane of its
        // triangle and be seen at its pixel; depth and ω must be those of that place.
        let [a, b, c] = [0, 1, 2].map(|i| points[i].view);
        let normal = (b - a).cross(c - a);
        prop_assume!(normal.length() > 1.0);
        let normal = normal.normalize();
        // Seen edge-on, a triangle's places are all but undefined.
        prop_assume!(a.dot(normal).abs() > 0.1);
        let viewport = Viewport::whole(Rect::sized(SIZE.0, SIZE.1));
        // Clamped everywhere: with the book's remedy the last pixel of a row that is a hair wide lies so many row widths
        // beyond its end that rounding shows.
        let walk = Walk { clamp: StepClamp::Everywhere, ..Walk::default() };
        let recorder = Recorder::default();
        render(&points, RenderState { walk, ..RenderState::default() }, &recorder);
        // On an exactly level edge between two rows the book's clamp makes one row of one constant value.
        prop_assume!(recorder.edges.borrow().iter().all(|[a, b]| a.y != b.y || a.y.fract() == 0.0));
        for fragment in recorder.fragments.into_inner() {
            let place = dvec3(fragment.varyings[0], fragment.varyings[1], fragment.varyings[2]);
            let off = (place - a).dot(normal);
            prop_assert!(off.abs() < 1e-5 * fragment.w, "{} is {} off the plane", place, off);
            prop_assert!((fragment.w - place.z).abs() < 1e-6, "ω is z");
            let clip = VIEW.project(place);
            let seen = viewport.pixel_corners(rasterbook::transform::perspective_divide(clip));
            let off = seen - glam::dvec2(f64::from(fragment.x), f64::from(fragment.y));
            prop_assert!(off.x.abs() < 1.01 && off.y.abs() < 1.01, "seen {off} beside its pixel");
        }
    }

    #[test]
    fn clipping_to_the_window_cuts_it_out_of_a_larger_picture(points in triangles(1..2)) {
        // Drawn into a picture three times as large with the window in its middle, or clipped at the window's borders:
        // only pixels along an edge may differ, that of the triangle or one that clipping made.
        let inside: Vec<Point> = points.iter().map(|point| Point { view: dvec3(point.view.x, point.view.y, 5.0 + point.view.z.abs() / 2.0), ..*point }).collect();
        let recorder = Recorder::default();
        let clipped = render(&inside, RenderState::default(), &recorder);
        let [width, height] = [SIZE.0, SIZE.1].map(f64::from);
        let mut large = Target::new(3 * SIZE.0, 3 * SIZE.1);
        large.clear(Color::BLACK, 1.0);
        let state = RenderState {
            clip_volume: ClipVolume::InFront(0.1),
            viewport: Some(Viewport { x: width, y: height, width, height }),
            ..RenderState::default()
        };
        draw(&Mesh::unindexed(inside).expect("one triangle"), &Places, &state, &Scanline, &mut large, &recorder);

        let is_covered = |target: &Target, x: i32, y: i32| target.color.get(x, y) != Some(Color::BLACK);
        let edges = recorder.edges.borrow();
        for (x, y) in (0..SIZE.1 as i32).flat_map(|y| (0..SIZE.0 as i32).map(move |x| (x, y))) {
            if is_covered(&clipped, x, y) != is_covered(&large, x + SIZE.0 as i32, y + SIZE.1 as i32) {
                let pixel = glam::dvec2(f64::from(x), f64::from(y));
                let distance = edges.iter().map(|&[a, b]| {
                    let along = ((pixel - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
                    pixel.distance(a + (b - a) * along)
                });
                let nearest = distance.fold(f64::MAX, f64::min);
                prop_assert!(nearest < 1.5, "({}, {}) differs, {} from any edge", x, y, nearest);
            }
        }
    }

    #[test]
    fn anything_goes_in_and_nothing_panics(
        points in prop::collection::vec((prop::array::uniform3(prop::num::f64::ANY), prop::array::uniform3(prop::num::f64::ANY)), 3)
    ) {
        let points: Vec<Point> = points.into_iter().map(|(view, color)| Point { view: DVec3::from(view), color }).collect();
        for clip_volume in [ClipVolume::Everything, ClipVolume::InFront(0.5), ClipVolume::Canonical] {
            for clip_test in [Default::default(), rasterbook::clip::ClipTest::AfterDivide] {
                for interpolation in [Interpolation::Affine, Interpolation::PerspectiveCorrect] {
                    render(&points, RenderState { clip_volume, clip_test, interpolation, ..RenderState::default() }, &Silent);
                }
            }
        }
    }
}

/// What the probe saw of a fragment.
#[derive(Clone, Debug)]
struct Seen {
    x: i32,
    y: i32,
    w: f64,
    varyings: Vec<f64>,
    verdict: Verdict,
    color: [f64; 4],
}

#[derive(Debug, Default)]
struct Recorder {
    fragments: RefCell<Vec<Seen>>,
    triangles: RefCell<usize>,
    culled: RefCell<usize>,
    /// The edges of all pieces, on the screen.
    edges: RefCell<Vec<[DVec2; 2]>>,
}

impl Observer for Recorder {}

impl Probe for Recorder {
    fn assembled(&self, _: &dyn Fn() -> Assembled) {
        *self.triangles.borrow_mut() += 1;
    }

    fn piece(&self, piece: &dyn Fn() -> Piece) {
        let viewport = Viewport::whole(Rect::sized(SIZE.0, SIZE.1));
        let [a, b, c] = piece().vertices.map(|vertex| viewport.pixel_corners(vertex.position.truncate()));
        self.edges.borrow_mut().extend([[a, b], [b, c], [c, a]]);
    }

    fn culled(&self) {
        *self.culled.borrow_mut() += 1;
    }

    fn fragment(&self, (x, y): Pixel, fragment: &dyn Fn() -> Fragment) {
        let Fragment { w, varyings, verdict, color, .. } = fragment();
        self.fragments.borrow_mut().push(Seen { x, y, w, varyings, verdict, color });
    }
}

#[test]
fn a_probe_observes_everything_and_changes_nothing() {
    let at = |x, y, z, color| Point { view: dvec3(x, y, z), color };
    let points = [
        at(-2.0, -1.0, 5.0, [255.0, 0.0, 0.0]),
        at(2.0, -1.0, 5.0, [255.0, 0.0, 0.0]),
        at(0.0, 2.0, 5.0, [255.0, 0.0, 0.0]),
        // The same, clockwise and farther away.
        at(-2.0, -1.0, 6.0, [0.0, 255.0, 0.0]),
        at(0.0, 2.0, 6.0, [0.0, 255.0, 0.0]),
        at(2.0, -1.0, 6.0, [0.0, 255.0, 0.0]),
    ];
    let state = RenderState::default();
    let recorder = Recorder::default();
    let observed = render(&points, state, &recorder);
    assert_eq!(colors(&observed), colors(&render(&points, state, &Silent)));
    assert_eq!(*recorder.triangles.borrow(), 2);

    let fragments = recorder.fragments.borrow();
    assert!(
        fragments.iter().any(|fragment| fragment.verdict == Verdict::Hidden && fragment.color[1] == 255.0)
    );
    for fragment in fragments.iter().filter(|fragment| fragment.verdict != Verdict::Hidden) {
        assert!(observed.color.get(fragment.x, fragment.y) != Some(Color::BLACK));
    }

    let culling = Recorder::default();
    render(&points, RenderState { cull: CullMode::Back, ..state }, &culling);
    assert_eq!(*culling.culled.borrow(), 1);
    assert!(culling.fragments.borrow().iter().all(|fragment| fragment.color[0] == 255.0));
}

#[test]
fn encodings_agree_on_what_is_in_front() {
    let at = |x, y, z, color| Point { view: dvec3(x, y, z), color };
    let (red, green) = ([255.0, 0.0, 0.0], [0.0, 255.0, 0.0]);
    let points = [
        at(-3.0, -2.0, 4.0, red),
        at(3.0, -2.0, 9.0, red),
        at(0.0, 3.0, 6.0, red),
        at(-3.0, -2.0, 9.0, green),
        at(3.0, -2.0, 4.0, green),
        at(0.0, 3.0, 6.5, green),
    ];
    let picture = |depth_encoding| {
        render(&points, RenderState { depth_encoding, clear_depth: 1e9, ..RenderState::default() }, &Silent)
    };
    let [ndc, w] = [DepthEncoding::Ndc, DepthEncoding::ViewZ].map(picture);
    assert_eq!(colors(&ndc), colors(&w));
    let covered = colors(&ndc).into_iter().filter(|&color| color != Color::BLACK).count();
    assert!(covered > 300, "{covered} pixels");
    for (x, y) in [(20, 15), (32, 20), (44, 15)] {
        let [z, w] = [&ndc, &w].map(|target| target.depth.get(x, y).expect("inside"));
        // NDC run from −1 to 1, hardware depths from 0 to 1.
        assert!((rasterbook::depth::z_from_w(w, VIEW.near, VIEW.far) * 2.0 - 1.0 - z).abs() < 1e-9);
    }
}

/// How far a line of constant color is from straight in a tilted square, drawn by the whole pipeline.
fn bend(interpolation: Interpolation) -> f64 {
    let at = |x, z, height: f64| Point {
        view: dvec3(x, 1.5 * height - 0.75, z),
        color: [0.0, height * 200.0, 55.0],
    };
    let [a, b, c, d] = [at(-1.0, 1.5, 0.0), at(3.0, 9.0, 0.0), at(-1.0, 1.5, 1.0), at(3.0, 9.0, 1.0)];
    let state = RenderState { interpolation, ..RenderState::default() };
    let picture: Framebuffer = render(&[a, b, c, b, d, c], state, &Silent).color;
    // The height at which green passes 100, in each column.
    let is_upper = |color: Color| color.channels()[1] >= 100;
    let border: Vec<(f64, f64)> = (12..40)
        .map(|x| {
            let y = picture.rect().rows().find(|&y| picture.get(x, y).is_some_and(is_upper));
            (f64::from(x), f64::from(y.expect("the square is in every column")))
        })
        .collect();
    let [(x0, y0), (x1, y1)] = [border[0], border[border.len() - 1]];
    border.iter().map(|&(x, y)| (y - (y0 + (y1 - y0) * (x - x0) / (x1 - x0))).abs()).fold(0.0, f64::max)
}

#[test]
fn the_mistake_of_chapter_five_is_one_option_of_the_pipeline() {
    assert!(bend(Interpolation::PerspectiveCorrect) <= 1.5, "{}", bend(Interpolation::PerspectiveCorrect));
    assert!(bend(Interpolation::Affine) > 3.0, "{}", bend(Interpolation::Affine));
}

#[test]
fn an_empty_mesh_draws_nothing() {
    let target = render(&[], RenderState::default(), &Silent);
    assert!(colors(&target).iter().all(|&color| color == Color::BLACK));
}

/// The texture coordinates of a ball, and nothing else.
struct Coordinates;

impl Shader<2> for Coordinates {
    type Attributes = ModelVertex;

    fn vertex(&self, vertex: &ModelVertex) -> ClipVertex<2> {
        // Turned, so that edges run in all directions.
        let turned = about(dvec3(0.0, 0.0, 4.0), rotate_x_to_y(0.785) * rotate_z_to_y(0.785))
            * vertex.position.extend(1.0);
        let camera = Frustum { left: -1.6, right: 1.6, bottom: -1.2, top: 1.2, near: 2.0, far: 10.0 };
        ClipVertex { position: camera.project(turned.truncate()), varyings: vertex.uv }
    }

    fn fragment<R: Real>(&self, [u, v]: [R; 2]) -> Shaded<R> {
        Shaded::opaque([u, v, R::of(0.0)])
    }
}

/// Counts fragments whose texel lies outside the texels of their own triangle's corners.
#[derive(Debug, Default)]
struct Strays {
    range: RefCell<[[f64; 2]; 2]>,
    count: RefCell<usize>,
}

impl Observer for Strays {}

impl Probe for Strays {
    fn piece(&self, piece: &dyn Fn() -> Piece) {
        let vertices = piece().vertices;
        let of = |k: usize, pick: fn(f64, f64) -> f64| {
            vertices.iter().map(|v| v.varyings[k]).reduce(pick).unwrap_or_default()
        };
        *self.range.borrow_mut() = [[of(0, f64::min), of(1, f64::min)], [of(0, f64::max), of(1, f64::max)]];
    }

    fn fragment(&self, _: Pixel, fragment: &dyn Fn() -> Fragment) {
        let varyings = fragment().varyings;
        // Rounding alone makes no stray: corners lie on the borders of texels.
        const ROUNDING: f64 = 1e-9;
        let texel = |coordinate: f64| (coordinate * 512.0).floor();
        let [low, high] = *self.range.borrow();
        let is_inside = |k: usize| {
            let value = varyings[k];
            texel(value + ROUNDING) >= texel(low[k]) && texel(value - ROUNDING) <= texel(high[k])
        };
        *self.count.borrow_mut() += usize::from(!(is_inside(0) && is_inside(1)));
    }
}

#[test]
fn spikes_are_texels_from_outside_a_triangle() {
    fn strays(clamp: StepClamp, rasterizer: &impl Rasterizer<Depth = f64>, ball: &Model) -> usize {
        let walk = Walk { clamp, ..Walk::default() };
        let state = RenderState { walk, cull: CullMode::Back, ..RenderState::default() };
        let mut target = Target::new(640, 480);
        target.clear(state.clear_color, state.clear_depth);
        let probe = Strays::default();
        draw(&ball.parts[0].mesh, &Coordinates, &state, rasterizer, &mut target, &probe);
        probe.count.into_inner()
    }
    let ball = rasterbook::figure::assets::model("sphere.obj").expect("an asset");
    let [overrun, edges, everywhere] = [StepClamp::Overrun, StepClamp::Edges, StepClamp::Everywhere]
        .map(|clamp| strays(clamp, &Scanline, &ball));
    assert_eq!(strays(StepClamp::Overrun, &Exact::<f64>::new(), &ball), 0, "nothing is stepped");
    assert_eq!(everywhere, 0);
    assert!(edges > 0, "the ends of rows still pass");
    assert!(overrun > edges + 1000, "{overrun} without the remedy, {edges} with it");
}
