//! The exact rasterizer against a production rasterizer, against a slow oracle, and against itself: no hole, no double.

use std::cell::RefCell;
use std::f64::consts::TAU;

use glam::{DVec2, DVec4, dvec2, dvec4};
use proptest::prelude::*;
use rasterbook::area::Winding;
use rasterbook::clip::{ClipTest, ClipVolume, MAX_VERTICES, NdcVertex, Plane, clip_triangle, fan};
use rasterbook::cull::CullMode;
use rasterbook::depth::DepthTest;
use rasterbook::exact::Exact;
use rasterbook::exact::edge::{Coverage, SUBPIXELS, Subpixel, center, snap};
use rasterbook::interpolate::Interpolation;
use rasterbook::merge::{Blend, Merge};
use rasterbook::observer::Observer;
use rasterbook::probe::{Fragment, Probe};
use rasterbook::raster::Rasterizer;
use rasterbook::real::Scalar;
use rasterbook::varyings::TriangleVaryings;
use rasterbook::{
    ClipVertex, Color, Mesh, Pixel, Real, Rect, RenderState, Shaded, Shader, Silent, Target, draw,
};

// ---- An oracle -----------------------------------------------------------------------------------------------------

/// How often a closed line winds round the center of a pixel, by another formulation than that of the library.
///
/// The top-left rule is a shift: a center belongs to what lies a hair to the right of it and a far smaller hair below.
/// From there a ray runs to the right; an edge that crosses it upwards counts 1, one that crosses it downwards −1. All
/// numbers are whole and wide, so that nothing is rounded.
fn winding_number(outline: &[Subpixel], x: i32, y: i32) -> i32 {
    let half = SUBPIXELS / 2;
    let [px, py] = [x, y].map(|i| i128::from(i64::from(i) * SUBPIXELS + half));
    let mut count = 0;
    for (i, &start) in outline.iter().enumerate() {
        let end = outline[(i + 1) % outline.len()];
        let [[ax, ay], [bx, by]] = [start, end].map(|point| point.map(i128::from));
        // Points as high as the center are above it, since it is a hair lower.
        let (is_start_above, is_end_above) = (ay >= py, by >= py);
        if is_start_above == is_end_above {
            continue;
        }
        // Where the edge crosses the height py: x = ax + (bx − ax)(py − ay)/(by − ay). Right of the center?
        let (numerator, denominator) = ((bx - ax) * (py - ay), by - ay);
        let is_right = if denominator > 0 {
            numerator > (px - ax) * denominator
        } else {
            numerator < (px - ax) * denominator
        };
        // On a crossing exactly at the center the hair to the right decides: the edge is left of it.
        if is_right {
            count += if is_end_above { 1 } else { -1 };
        }
    }
    count
}

fn snapped(points: &[DVec2]) -> Vec<Subpixel> {
    points.iter().map(|&point| snap(point).expect("near enough")).collect()
}

const WINDOW: Rect = Rect::sized(48, 48);

/// The number of times that each pixel of the window is covered, clockwise triangles counting −1.
fn signed_counts(triangles: &[[DVec2; 3]]) -> Vec<i32> {
    let mut counts = vec![0; 48 * 48];
    for &triangle in triangles {
        if let Some(coverage) = Coverage::new(triangle) {
            let sign = if coverage.winding == Winding::CounterClockwise { 1 } else { -1 };
            for (x, y, _) in coverage.pixels(WINDOW) {
                counts[WINDOW.index(x, y).expect("inside the window")] += sign;
            }
        }
    }
    counts
}

fn winding_numbers(outline: &[DVec2]) -> Vec<i32> {
    let outline = snapped(outline);
    WINDOW.pixels().map(|(x, y)| winding_number(&outline, x, y)).collect()
}

/// A coordinate: anywhere, on a center, on a border, at 1/256 steps about a center, or far away.
fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        -8.0..56.0,
        (-4..52).prop_map(|i| f64::from(i) + 0.5),
        (-4..52).prop_map(f64::from),
        (5000..7000).prop_map(|i| f64::from(i) / 256.0),
        -60_000.0..60_000.0,
    ]
}

fn corner() -> impl Strategy<Value = DVec2> {
    (coordinate(), coordinate()).prop_map(DVec2::from)
}

fn sliver() -> impl Strategy<Value = [DVec2; 3]> {
    (corner(), corner(), 0.0..1.0, -0.01..0.01, -0.01..0.01)
        .prop_map(|(a, b, t, dx, dy)| [a, b, a + (b - a) * t + dvec2(dx, dy)])
}

fn tiny() -> impl Strategy<Value = [DVec2; 3]> {
    (10.0..20.0, 10.0..20.0, prop::array::uniform3((-1.0..1.0, -1.0..1.0)))
        .prop_map(|(x, y, corners)| corners.map(|offset| dvec2(x, y) + DVec2::from(offset)))
}

proptest! {
    #[test]
    fn coverage_equals_the_oracle(
        triangle in prop_oneof![prop::array::uniform3(corner()), sliver(), tiny()],
    ) {
        prop_assert_eq!(signed_counts(&[triangle]), winding_numbers(&triangle));
    }

    #[test]
    fn weights_are_those_of_areas(triangle in prop::array::uniform3((-8.0..56.0, -8.0..56.0).prop_map(DVec2::from))) {
        let Some(coverage) = Coverage::new(triangle) else { return Ok(()) };
        let corners = coverage.vertices.map(|[x, y]| dvec2(x as f64, y as f64) / SUBPIXELS as f64);
        prop_assume!(coverage.signed_area().abs() > 1.0);
        for (x, y, values) in coverage.pixels(WINDOW) {
            let areas = rasterbook::interpolate::barycentric_weights(dvec2(f64::from(x) + 0.5, f64::from(y) + 0.5), corners);
            let [second, third]: [f64; 2] = coverage.weights(values);
            prop_assert!((second - areas[1]).abs() < 1e-9 && (third - areas[2]).abs() < 1e-9);
            let single: [f32; 2] = coverage.weights(values);
            prop_assert!((f64::from(single[0]) - second).abs() < 2e-7);
        }
    }

    #[test]
    fn no_value_leaves_the_range_of_the_vertices(
        triangle in prop_oneof![prop::array::uniform3(corner()), sliver(), tiny()],
        w in prop::array::uniform3(0.1..20.0), values in prop::array::uniform3(-5.0..5.0),
    ) {
        fn check<R: Scalar>(coverage: &Coverage, corners: &[NdcVertex<1>; 3], tolerance: f64) {
            let values = corners.map(|corner| corner.varyings[0]);
            let [low, high] = [values.iter().copied().fold(5.0, f64::min), values.iter().copied().fold(-5.0, f64::max)];
            let varyings = TriangleVaryings::<R, 1>::new(corners, Interpolation::PerspectiveCorrect);
            let step = varyings.change(coverage.weight_step());
            for y in 0..WINDOW.top {
                let columns = coverage.covered_columns(WINDOW.columns(), y);
                let start = varyings.linear_at(coverage.weights(coverage.edge_values(center(columns.start, y))));
                for (count, x) in columns.enumerate() {
                    let even = start.moved(&step, R::of(count as f64));
                    let value: f64 = even.multiplied(Interpolation::PerspectiveCorrect).values[0].into();
                    assert!(value >= low - tolerance && value <= high + tolerance, "{value} at ({x}, {y}) is not in {low}..{high}");
                }
            }
        }
        let Some(coverage) = Coverage::new(triangle) else { return Ok(()) };
        let corners = [0, 1, 2].map(|i| NdcVertex { position: triangle[i].extend(0.0), w: w[i], varyings: [values[i]] });
        check::<f64>(&coverage, &corners, 1e-11);
        check::<f32>(&coverage, &corners, 1e-3);
    }

    #[test]
    fn triangles_of_a_polygon_cover_it_once(
        radii in prop::collection::vec(4.0..20.0, 3..12), cuts in prop::collection::vec((any::<prop::sample::Index>(), 0.2..0.6, 0.2..0.4), 0..12),
        center in (20.0..28.0, 20.0..28.0), rotation in prop_oneof![0.0..TAU, Just(0.0), Just(TAU / 4.0), Just(TAU / 8.0)],
    ) {
        // A polygon round a center, cut into triangles, and these cut into three now and then.
        let count = radii.len() as f64;
        let mut points: Vec<DVec2> = vec![DVec2::ZERO];
        points.extend(radii.iter().enumerate().map(|(i, radius)| DVec2::from_angle(TAU * i as f64 / count) * *radius));
        let rim = 1..points.len();
        let mut triangles: Vec<[usize; 3]> = rim.clone().map(|i| [0, i, i % radii.len() + 1]).collect();
        for (which, s, t) in cuts {
            let [a, b, c] = triangles.swap_remove(which.index(triangles.len()));
            points.push(points[a] + (points[b] - points[a]) * s + (points[c] - points[a]) * t);
            let new = points.len() - 1;
            triangles.extend([[a, b, new], [b, c, new], [c, a, new]]);
        }
        let turned: Vec<DVec2> = points.iter().map(|p| DVec2::from(center) + DVec2::from_angle(rotation).rotate(*p)).collect();
        let triangles: Vec<[DVec2; 3]> = triangles.iter().map(|triangle| triangle.map(|i| turned[i])).collect();
        prop_assert_eq!(signed_counts(&triangles), winding_numbers(&turned[rim]));
    }
}

proptest! {
    #[test]
    fn far_corners_cover_what_each_pixel_says(corners in prop::array::uniform3((-65_000.0..65_000.0, -65_000.0..65_000.0))) {
        if let Some(coverage) = Coverage::new(corners.map(DVec2::from)) {
            let is_covered = |&(x, y): &(i32, i32)| coverage.covers(coverage.edge_values(center(x, y)));
            let one_by_one = WINDOW.pixels().filter(is_covered);
            prop_assert!(coverage.pixels(WINDOW).map(|(x, y, _)| (x, y)).eq(one_by_one));
            prop_assert!(coverage.pixels(WINDOW).all(|(x, y, values)| values == coverage.edge_values(center(x, y))));
        }
    }
}

#[test]
fn any_vertex_is_safe() {
    let odd = [0.0, 0.5, -65_536.0, 65_536.0, 65_536.1, 1e9, f64::MAX, f64::NAN, f64::INFINITY, -1e300];
    for &a in &odd {
        for &b in &odd {
            for &c in &odd {
                if let Some(coverage) = Coverage::new([dvec2(a, b), dvec2(b, c), dvec2(c, a)]) {
                    assert!(coverage.pixels(WINDOW).count() <= 48 * 48);
                }
            }
        }
    }
    assert_eq!(snap(dvec2(0.001, -65_536.0)), Some([0, -65_536 * 256]));
    assert_eq!(snap(dvec2(0.0, 65_537.0)), None);
    assert_eq!(snap(dvec2(1.5 / 256.0, -1.5 / 256.0)), Some([2, -2]), "halves away from zero");
}

// ---- Through the pipeline ------------------------------------------------------------------------------------------

/// Clip space as it comes, and a color.
struct Flat;

impl Shader<3> for Flat {
    type Attributes = (DVec4, [f64; 3]);

    fn vertex(&self, &(position, varyings): &Self::Attributes) -> ClipVertex<3> {
        ClipVertex { position, varyings }
    }

    fn fragment<R: Real>(&self, color: [R; 3]) -> Shaded<R> {
        Shaded::opaque(color)
    }
}

/// Counts the fragments of each pixel.
#[derive(Debug)]
struct Counter(RefCell<Vec<u32>>, Rect);

impl Counter {
    fn new<D>(target: &Target<D>) -> Self {
        let rect = target.color.rect();
        Self(RefCell::new(vec![0; rect.columns().len() * rect.rows().len()]), rect)
    }
}

impl Observer for Counter {}

impl Probe for Counter {
    fn fragment(&self, (x, y): Pixel, _: &dyn Fn() -> Fragment) {
        self.0.borrow_mut()[self.1.index(x, y).expect("inside")] += 1;
    }
}

/// A net of (n + 1)² points over the square −`reach`..`reach`, its inner points shifted by `jitter`, each with an ω.
fn net(n: usize, reach: f64, jitter: &[(f64, f64)], w: impl Fn(f64, f64) -> f64) -> Mesh<(DVec4, [f64; 3])> {
    let mut vertices = Vec::new();
    for row in 0..=n {
        for column in 0..=n {
            let place = |i: usize| (2.0 * i as f64 / n as f64 - 1.0) * reach;
            let is_inner = (1..n).contains(&row) && (1..n).contains(&column);
            let (dx, dy) =
                if is_inner { jitter[(row * 7 + column) % jitter.len()] } else { Default::default() };
            let (x, y) = (place(column) + dx * reach / n as f64, place(row) + dy * reach / n as f64);
            let w = w(x, y);
            vertices.push((dvec4(x * w, y * w, 0.0, w), [0.0; 3]));
        }
    }
    let mut indices = Vec::new();
    for row in 0..n {
        for column in 0..n {
            let a = (row * (n + 1) + column) as u32;
            let (b, c, d) = (a + 1, a + n as u32 + 2, a + n as u32 + 1);
            indices.extend(if (row + column) % 2 == 0 { [a, b, c, a, c, d] } else { [a, b, d, b, c, d] });
        }
    }
    Mesh::indexed(vertices, indices).expect("indices in range")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn a_net_over_the_screen_has_no_hole_and_no_double(
        n in 1_usize..12, reach in prop_oneof![Just(1.0), 1.0..1.5, 2.0..9.0], tilt in (-0.4..0.4, -0.4..0.4),
        jitter in prop::collection::vec((-0.3..0.3, -0.3..0.3), 11), size in (1_u32..70, 1_u32..70),
        volume in prop_oneof![Just(ClipVolume::Canonical), Just(ClipVolume::Everything), Just(ClipVolume::InFront(0.01))],
    ) {
        let mesh = net(n, reach, &jitter, |x, y| 1.0 / (1.0 + (tilt.0 * x + tilt.1 * y) / reach));
        let state = RenderState { clip_volume: volume, merge: Merge { depth_test: DepthTest::Always, ..Merge::default() }, ..RenderState::default() };
        let mut target = Target::new(size.0, size.1);
        let counter = Counter::new(&target);
        draw(&mesh, &Flat, &state, &Exact::<f64>::new(), &mut target, &counter);
        prop_assert!(counter.0.borrow().iter().all(|&count| count == 1));
    }

    #[test]
    fn a_plane_and_its_opposite_neither_lose_nor_double_a_pixel(
        corners in prop::array::uniform3((-3.0..3.0, -3.0..3.0, 0.3..4.0)), normal in (-1.0..1.0, -1.0..1.0, -1.0..1.0),
    ) {
        let triangle = corners.map(|(x, y, w)| ClipVertex { position: dvec4(x * w, y * w, 0.0, w), varyings: [0.0; 3] });
        let normal = dvec4(normal.0, normal.1, 0.0, normal.2);
        let count = |planes: &[Plane]| {
            let mut target = Target::new(64, 48);
            let counter = Counter::new(&target);
            let state = RenderState { merge: Merge { depth_test: DepthTest::Always, ..Merge::default() }, ..RenderState::default() };
            let polygon = clip_triangle(triangle, planes, ClipTest::BeforeDivide);
            let divided: arrayvec::ArrayVec<NdcVertex<3>, MAX_VERTICES> = polygon.into_iter().map(NdcVertex::from).collect();
            Exact::<f64>::new().draw(fan(divided), &state, &Flat, &mut target, &counter);
            counter.0.into_inner()
        };
        // Cut points are rounded to 1/256 pixel: the parts of an edge may lie a hair beside the whole, but where the
        // triangle covers a pixel and its neighbors, the parts do, once.
        let (one, other) = (count(&[Plane::homogeneous(normal)]), count(&[Plane::homogeneous(-normal)]));
        let whole = count(&[]);
        let both: Vec<u32> = one.iter().zip(&other).map(|(a, b)| a + b).collect();
        prop_assert!(both.iter().all(|&count| count <= 1), "a double");
        for y in 1..47 {
            for x in 1..63 {
                let covered = |x: usize, y: usize| whole[y * 64 + x] == 1;
                if covered(x, y) && covered(x - 1, y) && covered(x + 1, y) && covered(x, y - 1) && covered(x, y + 1) {
                    prop_assert!(both[y * 64 + x] == 1, "a hole at ({x}, {y})");
                }
            }
        }
    }

    #[test]
    fn single_precision_covers_the_same_pixels_in_nearly_the_same_colors(
        corners in prop::array::uniform3((-1.5..1.5, -1.5..1.5, 0.5..5.0, prop::array::uniform3(0.0..255.0))),
    ) {
        let vertices = corners.map(|(x, y, w, color)| (dvec4(x * w, y * w, 0.5 * w, w), color));
        let mesh = Mesh::unindexed(vertices.to_vec()).expect("a triangle");
        let double = picture(&mesh, &Exact::<f64>::new());
        let single = picture(&mesh, &Exact::<f32>::new());
        for y in double.color.rect().rows() {
            for x in double.color.rect().columns() {
                let [a, b] = [&double.color, &single.color].map(|color| color.get(x, y).expect("inside").channels());
                prop_assert!(a.iter().zip(b).all(|(a, b)| a.abs_diff(b) <= 1));
                let (a, b) = (double.depth.get(x, y).expect("inside"), single.depth.get(x, y).expect("inside"));
                prop_assert!((a - f64::from(b)).abs() < 1e-6 && (a == 1.0) == (b == 1.0));
            }
        }
    }
}

/// The largest difference of a channel between both precisions, where most digits cancel: in pixels whose centers lie on the
/// far edge of a triangle, which is so many times as far away as its near vertex.
fn difference_on_far_edges(ratio: f64) -> u8 {
    let mut state = 1_u64;
    let mut next = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as f64 / (1_u64 << 31) as f64
    };
    let mut most = 0;
    for round in 0..1000 {
        // Its left edge: what lies on it is covered.
        let x = ((next() * 20.0).floor() + 0.5) / 20.0 - 1.0;
        let corners =
            [(x + next(), next() * 2.0 - 1.0, 1.0), (x, 0.9, ratio), (x, -0.9, ratio * (0.5 + 0.5 * next()))];
        let mut vertices = corners
            .map(|(x, y, w)| (dvec4(x * w, y * w, 0.5 * w, w), [next(), next(), next()].map(|v| v * 255.0)));
        vertices.rotate_left(round % 3);
        let mesh = Mesh::unindexed(vertices.to_vec()).expect("a triangle");
        let colors = [picture(&mesh, &Exact::<f64>::new()).color, picture(&mesh, &Exact::<f32>::new()).color];
        let [double, single] = colors.map(|color| color.rgb_from_top());
        most = double.iter().zip(single).map(|(a, b)| a.abs_diff(b)).fold(most, u8::max);
    }
    most
}

#[test]
fn colors_of_both_precisions_differ_by_one_up_to_ten_thousand_times_the_distance() {
    assert!(difference_on_far_edges(1e4) <= 1);
    let far_beyond = difference_on_far_edges(1e6);
    assert!((2..=30).contains(&far_beyond), "single precision shows: {far_beyond}");
}

fn picture<Z: Rasterizer>(mesh: &Mesh<(DVec4, [f64; 3])>, rasterizer: &Z) -> Target<Z::Depth> {
    let state = RenderState::default();
    let mut target = Target::sized(40, 30);
    target.clear(state.clear_color, Z::Depth::of(state.clear_depth));
    draw(mesh, &Flat, &state, rasterizer, &mut target, &Silent);
    target
}

#[test]
fn what_is_beside_the_eye_is_cut_and_not_lost() {
    // From far on the right, beside the eye, into the picture.
    let corners = |w| [dvec4(-0.5, -0.8, 0.5, 1.0), dvec4(1.0, 0.0, 0.5, w), dvec4(-0.5, 0.8, 0.5, 1.0)];
    let count = |w, volume| {
        let mesh = Mesh::unindexed(corners(w).map(|corner| (corner, [0.0; 3])).to_vec()).expect("a triangle");
        let state = RenderState {
            clip_volume: volume,
            merge: Merge { depth_test: DepthTest::Always, ..Merge::default() },
            ..RenderState::default()
        };
        let mut target = Target::new(64, 48);
        let counter = Counter::new(&target);
        draw(&mesh, &Flat, &state, &Exact::<f64>::new(), &mut target, &counter);
        counter.0.into_inner()
    };
    for volume in [ClipVolume::Everything, ClipVolume::InFront(0.0)] {
        let beside = count(0.0, volume);
        assert!(beside.iter().sum::<u32>() > 1000);
        assert_eq!(beside, count(1e-12, volume));
    }
}

#[test]
fn an_orthographic_projection_needs_no_correction() {
    // With the same ω everywhere, affine and perspective-correct interpolation draw the same picture.
    let vertices = [(-0.9, -0.8, 10.0), (0.95, -0.3, 250.0), (-0.1, 0.9, 90.0)]
        .map(|(x, y, red)| (dvec4(x, y, 0.1, 1.0), [red, 255.0 - red, 30.0]));
    let mesh = Mesh::unindexed(vertices.to_vec()).expect("a triangle");
    let drawn = |interpolation| {
        let state = RenderState { interpolation, ..RenderState::default() };
        let mut target = Target::new(40, 30);
        target.clear(state.clear_color, state.clear_depth);
        draw(&mesh, &Flat, &state, &Exact::<f64>::new(), &mut target, &Silent);
        target.color
    };
    assert!(drawn(Interpolation::Affine) == drawn(Interpolation::PerspectiveCorrect));
}

#[test]
fn facing_is_decided_where_pixels_are() {
    // Front, back, and so thin that rounding leaves no area.
    let front = [(-0.5, -0.5), (0.5, -0.5), (0.0, 0.5)];
    let back = [front[1], front[0], front[2]];
    let thin = [(-0.5, 0.0), (0.5, 0.0), (0.0, 1e-5)];
    let drawn = |corners: [(f64, f64); 3], cull| {
        let vertices = corners.map(|(x, y)| (dvec4(x, y, 0.0, 1.0), [255.0; 3]));
        let state = RenderState { cull, ..RenderState::default() };
        let mut target = Target::new(40, 30);
        let counter = Counter::new(&target);
        let mesh = Mesh::unindexed(vertices.to_vec()).expect("a triangle");
        draw(&mesh, &Flat, &state, &Exact::<f64>::new(), &mut target, &counter);
        counter.0.into_inner().iter().any(|&count| count > 0)
    };
    let modes = [CullMode::None, CullMode::Back, CullMode::Front];
    assert_eq!(modes.map(|cull| drawn(front, cull)), [true, true, false]);
    assert_eq!(modes.map(|cull| drawn(back, cull)), [true, false, true]);
    assert_eq!(modes.map(|cull| drawn(thin, cull)), [false; 3]);
}

#[test]
fn values_are_taken_at_centers_and_rounded_to_nearest() {
    // A triangle twice as large as the screen; red grows by 3.9 a pixel from the left border on.
    let vertices = [(-1.0, -1.0, 0.0), (3.0, -1.0, 2.0 * 40.0 * 3.9), (-1.0, 3.0, 0.0)]
        .map(|(x, y, red)| (dvec4(x, y, 0.0, 1.0), [red, 254.5, 254.49]));
    let target = picture(&Mesh::unindexed(vertices.to_vec()).expect("a triangle"), &Exact::<f64>::new());
    for x in 0..40 {
        let red = ((f64::from(x) + 0.5) * 3.9 + 0.5) as u8;
        assert_eq!(target.color.get(x, 7), Some(Color::rgb(red, 255, 254)), "column {x}");
    }
}

#[test]
fn blending_counts_every_pixel_once() {
    // Additive light over a net: a seam drawn twice would be brighter.
    let mesh = net(9, 1.3, &[(0.2, -0.1), (-0.25, 0.3), (0.0, 0.1)], |_, _| 1.0);
    let vertices = mesh.vertices().iter().map(|&(position, _)| (position, [100.0; 3])).collect();
    let indices = mesh.triangles().flat_map(|triangle| triangle.map(|i| i as u32)).collect();
    let mesh = Mesh::indexed(vertices, indices).expect("as before");
    let state = RenderState {
        merge: Merge { blend: Blend::Additive, depth_test: DepthTest::Always, ..Merge::default() },
        ..RenderState::default()
    };
    let mut target = Target::new(61, 47);
    target.clear(Color::BLACK, 1.0);
    draw(&mesh, &Flat, &state, &Exact::<f64>::new(), &mut target, &Silent);
    assert!(target.color.rows_from_top().flatten().all(|&color| color == Color::gray(100)));
}

// ---- A production rasterizer ---------------------------------------------------------------------------------------

/// The lines of a fixture: what stands before and after the colon. `tests/fixtures/make_fixtures.py` made them.
fn lines(fixture: &str) -> impl Iterator<Item = (Vec<f64>, &str)> {
    let lines = fixture.lines().filter(|line| !line.starts_with('#'));
    lines.map(|line| {
        let (triangle, seen) = line.split_once(':').expect("a colon");
        let numbers = triangle.split_whitespace().map(|number| number.parse().expect("a number"));
        (numbers.collect(), seen.trim())
    })
}

#[test]
fn coverage_is_that_of_a_production_rasterizer() {
    let mut count = 0;
    for (numbers, seen) in lines(include_str!("fixtures/coverage.txt")) {
        let mut expected = Vec::new();
        let mut spans = seen.split_whitespace();
        let first_row = spans.next().expect("a row").parse().unwrap_or(0);
        for (y, span) in (first_row..).zip(spans) {
            if let Some((start, end)) = span.split_once('-') {
                let [start, end]: [i32; 2] = [start, end].map(|number| number.parse().expect("a column"));
                expected.extend((start..end).map(|x| (x, y)));
            }
        }
        let corner = |i: usize| dvec2(numbers[2 * i], numbers[2 * i + 1]) / 256.0;
        let coverage = Coverage::new([corner(0), corner(1), corner(2)]);
        let window = Rect::sized(64, 64);
        let covered: Vec<(i32, i32)> =
            coverage.iter().flat_map(|coverage| coverage.pixels(window)).map(|(x, y, _)| (x, y)).collect();
        assert_eq!(covered, expected, "{numbers:?}");
        count += 1;
    }
    assert_eq!(count, 445);
}

/// Colors of 0..=1.
struct Bright;

impl Shader<3> for Bright {
    type Attributes = (DVec4, [f64; 3]);

    fn vertex(&self, &(position, varyings): &Self::Attributes) -> ClipVertex<3> {
        ClipVertex { position, varyings }
    }

    fn fragment<R: Real>(&self, color: [R; 3]) -> Shaded<R> {
        Shaded::opaque(color.map(|channel| channel * R::of(255.0)))
    }
}

fn interpolation_is_that_of_a_production_rasterizer<R: Scalar>() {
    let mut count = 0;
    for (numbers, seen) in lines(include_str!("fixtures/interpolation.txt")) {
        let vertex = |i: usize| {
            let [x, y, w, r, g, b] = numbers[6 * i..6 * i + 6] else { panic!("six numbers a vertex") };
            let ndc = (dvec2(x, y) / 256.0 / 16.0 - 1.0).extend(0.0);
            NdcVertex { position: ndc, w, varyings: [r, g, b] }
        };
        let mut target = Target::sized(32, 32);
        let counter = Counter::new(&target);
        target.clear(Color::BLACK, R::of(1.0));
        let triangle = [vertex(0), vertex(1), vertex(2)];
        Exact::<R>::new().draw(
            [triangle].into_iter(),
            &RenderState::default(),
            &Bright,
            &mut target,
            &counter,
        );
        let mut covered = 0;
        for row in seen.split(';').filter(|row| *row != "-") {
            let mut words = row.split_whitespace();
            let mut next = || words.next().expect("a word").parse::<i32>().expect("a number");
            let (y, first) = (next(), next());
            for (x, word) in (first..).zip(words) {
                let expected = u32::from_str_radix(word, 16).expect("a color").to_be_bytes();
                let found = target.color.get(x, y).expect("inside").channels();
                let differs = (0..3).any(|k| found[k].abs_diff(expected[k + 1]) > 1);
                assert!(!differs, "{found:?} is not {expected:?} at ({x}, {y}) of {numbers:?}");
                covered += 1;
            }
        }
        assert_eq!(counter.0.into_inner().iter().sum::<u32>(), covered);
        count += 1;
    }
    assert_eq!(count, 42);
}

#[test]
fn colors_are_those_of_a_production_rasterizer() {
    interpolation_is_that_of_a_production_rasterizer::<f64>();
}

#[test]
fn colors_are_those_of_a_production_rasterizer_in_single_precision_too() {
    interpolation_is_that_of_a_production_rasterizer::<f32>();
}
