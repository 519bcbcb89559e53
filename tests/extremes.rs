//! The functions of the core library, and of figures those for pictures, sketches and knobs, with the oddest numbers that
//! their types have: each keeps what its documentation says, and none panics unless that says so. What the rasterizers
//! make of such numbers as a whole is in `tests/tiled.rs`, what is made of odd files in `tests/wild.rs`.

#[path = "extremes/exact.rs"]
mod exact;
#[cfg(feature = "figure")]
#[path = "extremes/figure.rs"]
mod figure;
#[path = "extremes/light.rs"]
mod light;
#[path = "extremes/number.rs"]
mod number;
#[path = "extremes/odd.rs"]
mod odd;

use std::array::from_fn;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

use arrayvec::ArrayVec;
use glam::{DMat4, DVec2, DVec3, DVec4, dvec3};
use odd::{any_number, any_rect, any_whole, numbers, point, small_rect, triangle};
use proptest::prelude::*;
use proptest::sample::select;
use rasterbook::area::{Winding, is_drawable, twice_signed_area};
use rasterbook::clip::{
    ClipTest, ClipVolume, DepthRange, NdcVertex, Plane, RecordedVertex, clip_polygon, clip_triangle, fan,
};
use rasterbook::cull::CullMode;
use rasterbook::depth::{
    DepthBuffer, DepthEncoding, DepthFormat, DepthTest, reversed_z_from_w, w_from_z, z_from_w,
};
use rasterbook::exact::samples::{CENTER, Samples};
use rasterbook::interpolate::{
    Interpolation, Projected, ScreenVertex, barycentric_weights, linear, perspective_weights, step_parameter,
    step_parameter_and_depth, step_values,
};
use rasterbook::line::{Line, StepAxis, dda};
use rasterbook::merge::{Blend, Merge, Rounding, Verdict, merge};
use rasterbook::mesh::MeshError;
use rasterbook::mipmap::MipMaps;
use rasterbook::observer::{Enlargement, Observer};
use rasterbook::payload::{Payload, StepClamp, Walk};
use rasterbook::real::Scalar;
use rasterbook::scanline::{Edge, EdgeWalk, Half, Span, spans, split};
use rasterbook::scissor::Scissor;
use rasterbook::swap_chain::SwapChain;
use rasterbook::texture::{AddressMode, Texture};
use rasterbook::transform::{self, Frustum, Viewport};
use rasterbook::varyings::{LinearVaryings, TriangleVaryings, weight_gradients};
use rasterbook::{ClipVertex, Color, Framebuffer, Mesh, Pixel, Rect, RenderState, Shaded, Target, srgb};

fn walk() -> impl Strategy<Value = Walk> {
    let edges = select(&[EdgeWalk::Clamped, EdgeWalk::Unclamped][..]);
    let clamp = select(&[StepClamp::Overrun, StepClamp::Edges, StepClamp::Everywhere][..]);
    (edges, clamp).prop_map(|(edges, clamp)| Walk { edges, clamp })
}

fn reals<R: Scalar, const N: usize>(numbers: [f64; N]) -> [R; N] {
    numbers.map(R::of)
}

const INTERPOLATIONS: [Interpolation; 3] =
    [Interpolation::Affine, Interpolation::PerspectiveCorrect, Interpolation::Reciprocal];
const MODES: [AddressMode; 3] = [AddressMode::Clamp, AddressMode::Repeat, AddressMode::Mirror];
const TESTS: [DepthTest; 4] =
    [DepthTest::Less, DepthTest::LessOrEqual, DepthTest::Greater, DepthTest::Always];

/// An observer that wants to know all that it can.
#[derive(Debug)]
struct Curious;

impl Observer for Curious {
    fn note(&self, _: Pixel, text: &dyn Fn() -> String) {
        assert!(!text().is_empty());
    }
}

fn observed(rect: Rect) -> Scissor {
    Scissor { rect, observer: Some(Arc::new(Curious)) }
}

/// It panics, as is said under "Panics".
fn assert_panics<T>(what: &str, function: impl FnOnce() -> T) {
    assert!(catch_unwind(AssertUnwindSafe(function)).is_err(), "{what} does not panic");
}

/// A number as a channel.
fn channel(number: f64) -> u8 {
    // NaN gives 0.
    number.clamp(0.0, 255.0) as u8
}

fn assert_within<R: Scalar>(channels: [R; 3], [low, high]: [f64; 2]) {
    for channel in channels.map(Into::<f64>::into) {
        assert!((low..=high).contains(&channel), "{channel} is not in {low} to {high}");
    }
}

// Chapter 1: rect, framebuffer, scissor; chapter 9: swap_chain.

proptest! {
    #[test]
    fn pixels_outside_are_none(
        x in prop_oneof![any_whole(), -1..6], y in prop_oneof![any_whole(), -1..5], rect in any_rect(),
    ) {
        let mut framebuffer = Framebuffer::new(5, 4);
        let (whole, is_inside) = (framebuffer.rect(), framebuffer.rect().contains(x, y));
        framebuffer.set(x, y, Color::RED);
        assert_eq!(framebuffer.get(x, y), is_inside.then_some(Color::RED));
        framebuffer.fill(rect, Color::GREEN);
        let green = framebuffer.rows_from_top().flatten().filter(|&&color| color == Color::GREEN).count();
        let part = framebuffer.scissor().within(rect).rect;
        assert_eq!(part, rect.intersection(whole));
        // What the rectangle contains has a place, unless there are more of them than numbers.
        assert!(rect.index(x, y).is_none() || rect.contains(x, y));
        assert_eq!(whole.index(x, y), is_inside.then(|| 5 * y as usize + x as usize));
        assert_eq!(green, part.rows().len() * part.columns().len());
    }
}

proptest! {
    #[test]
    fn blocks_of_an_enlarged_screen(
        pixel in (any_whole(), any_whole()), origin in (any_whole(), any_whole()),
        factor in prop_oneof![1_u32..9, Just(i32::MAX as u32), Just(1 << 31), Just(u32::MAX), any::<u32>()],
    ) {
        let enlargement = Enlargement { screen: Rect::sized(3, 2), factor, origin };
        if factor == 0 {
            assert_panics("no factor", || enlargement.pixel_at(pixel));
            return Ok(());
        }
        let (x, y) = enlargement.pixel_at(pixel);
        for (number, place, origin) in [(x, pixel.0, origin.0), (y, pixel.1, origin.1)] {
            let [number, place, origin] = [number, place, origin].map(i64::from);
            let first = origin + number * i64::from(factor);
            let is_in_it = first <= place && place < first + i64::from(factor);
            assert!(is_in_it || [i32::MIN, i32::MAX].map(i64::from).contains(&number), "{number}: {first}");
        }
    }

    #[test]
    fn colors_of_any_channels([red, green, blue] in any::<[u8; 3]>()) {
        let color = Color::rgb(red, green, blue);
        assert_eq!(Color::truncated(color.to_f64()), color);
        let board = Texture::checkerboard(color, Color::WHITE);
        assert_eq!(board.nearest_texel([0.25, 0.25], AddressMode::Clamp), color);
    }
}

#[test]
fn sizes_that_are_refused() {
    const MOST: u32 = Framebuffer::MAX_SIDE;
    for (width, height) in [(0, 1), (1, 0), (MOST + 1, 1), (1, MOST + 1), (u32::MAX, u32::MAX)] {
        assert_panics("a framebuffer", || Framebuffer::new(width, height));
        assert_panics("a swap chain", || SwapChain::new(width, height));
        assert_panics("a target", || Target::new(width, height));
        assert_panics("a target", || Target::<f32>::sized(width, height));
        assert_panics("samples", || Samples::new(width, height, &CENTER));
    }
    assert_panics("samples", || Samples::new(1, 1, &[]));
    // The last two, multiplied in 32 bits, are what is given.
    for (width, height, count) in [
        (0, 0, 0),
        (0, 9, 0),
        (9, 0, 0),
        (2, 2, 3),
        (u32::MAX, u32::MAX, 1),
        (1 << 16, (1 << 16) + 1, 1 << 16),
        (3 << 15, 1 << 17, 0),
    ] {
        assert_panics("a texture", || Texture::new(width, height, vec![Color::RED; count]));
    }
    let most = (1 << 24) + 1;
    assert_panics("a texture", || Texture::new(most, 1, vec![Color::RED; most as usize]));
    assert_panics("a plane of depths", || DepthBuffer::<f64>::new(u32::MAX, u32::MAX));
    for (width, height) in [(0, u32::MAX), (u32::MAX, 0)] {
        let empty = DepthBuffer::<f32>::new(width, height);
        assert_eq!((empty.get(0, 0), empty.rows_from_top().count()), (None, 0));
    }
}

#[test]
fn the_largest_pictures() {
    const MOST: u32 = Framebuffer::MAX_SIDE;
    for (width, height) in [(MOST, 1), (1, MOST)] {
        let (mut screen, mut back) = (SwapChain::new(1, 1), Framebuffer::new(width, height));
        screen.present(&mut back);
        let front = screen.front();
        assert_eq!((front.width(), front.height(), back.rect()), (width, height, Rect::sized(1, 1)));
        assert_eq!(front.rgb_from_top().len(), 3 * MOST as usize);
        assert_ne!(front.fingerprint(), back.fingerprint());
        assert!(front.write_ppm(&mut [0; 8][..]).is_err(), "there is no room");
    }
}

// Chapter 2: area, line, scanline; chapter 9: cull.

proptest! {
    #[test]
    fn areas_and_sides(triangle in triangle(), area in any_number()) {
        let [a, b, c] = triangle;
        for area in [twice_signed_area(a, b, c), area] {
            let winding = Winding::of(area);
            assert_eq!(winding.is_some(), area.abs() > 0.0);
            assert!(!is_drawable(area) || (area.is_finite() && winding.is_some()));
            for front in [Winding::Clockwise, Winding::CounterClockwise] {
                assert!(!CullMode::None.culls(area, front));
                assert_ne!(CullMode::Back.culls(area, front), CullMode::Front.culls(area, front));
                assert_eq!(CullMode::Front.culls(area, front), winding == Some(front));
                let of_winding = winding.map(|winding| CullMode::Back.culls_winding(winding, front));
                assert!(of_winding.is_none_or(|culls| culls == CullMode::Back.culls(area, front)));
            }
        }
    }

    #[test]
    fn lines_stay_in_the_scissor(a in point(), b in point(), rect in small_rect()) {
        for axis in [StepAxis::Longer, StepAxis::X] {
            let (mut pixels, line) = (Vec::new(), Line { a, b, axis });
            dda(a, b, axis, observed(rect), |x, y| pixels.push((x, y)));
            assert!(pixels.iter().all(|&(x, y)| rect.contains(x, y)), "{pixels:?}");
            assert!(pixels.is_empty() || (b - a).is_finite());
            assert_eq!(line.is_x_major(), axis == StepAxis::X || line.slope().abs() < 1.0);
        }
    }

    #[test]
    fn spans_stay_in_the_scissor(triangle in triangle(), walk in walk(), rect in small_rect()) {
        let [a, b, c] = triangle;
        let check = |span: Span| {
            let is_covered = |x: f64| span.start - 1.0 < x && x <= span.end;
            assert!(span.columns().all(|x| is_covered(x.into()) && rect.contains(x, span.y)), "{span:?}");
            let mut columns = Vec::new();
            span.step(a.x, b.y, walk.clamp, |x, _| columns.push(x));
            assert!(columns.into_iter().eq(span.columns()));
        };
        spans(triangle, walk.edges, rect, check);
        if let Some(split) = split(triangle) {
            assert!(triangle.iter().all(|vertex| vertex.is_finite()));
            let [lower, upper] = split.attach([0, 1, 2], |_, _, _| 3);
            assert_eq!([lower.left.start, upper.right.end], [split.order[0], split.order[2]]);
        }
        // A half that nothing has checked.
        let half = Half { left: Edge { start: a, end: b }, right: Edge { start: a, end: c } };
        half.spans(walk.edges, rect, check);
        let carried = Half { left: Edge { start: a.x, end: b.x }, right: Edge { start: a.y, end: c.y } };
        half.step(&carried, walk, rect, |span, _| check(span));
    }
}

// Chapter 3: payload, interpolate.

fn carried<V: Copy>(positions: [DVec2; 3], varyings: [V; 3]) -> [ScreenVertex<V>; 3] {
    from_fn(|i| ScreenVertex { position: positions[i], varyings: varyings[i] })
}

proptest! {
    #[test]
    fn stepped_values_stay_in_the_scissor(
        triangle in triangle(), values in numbers::<9>(), walk in walk(), rect in small_rect(),
    ) {
        let [w, v, z] = from_fn(|k| from_fn(|i| values[3 * k + i]));
        let inside = |x, y| assert!(rect.contains(x, y), "{x} {y}");
        step_values(carried(triangle, v.map(|v: f64| [v])), walk, observed(rect), |x, y, _| inside(x, y));
        let points: [_; 3] = from_fn(|i| Projected { w: w[i], values: [v[i]] });
        let deep: [(_, f64); 3] = from_fn(|i| (points[i], z[i]));
        for interpolation in INTERPOLATIONS {
            let (points, deep) = (carried(triangle, points), carried(triangle, deep));
            step_parameter(points, interpolation, walk, observed(rect), |x, y, _| inside(x, y));
            step_parameter_and_depth(deep, interpolation, walk, observed(rect), |x, y, _, _| inside(x, y));
        }
    }

    #[test]
    fn clamped_everywhere_nothing_leaves_the_range_of_the_vertices(
        triangle in triangle(), values in numbers::<3>(), rect in small_rect(), edges in walk(),
    ) {
        // Beyond this, differences and products are infinite.
        let moderate = |number: f64| if number.abs() < 1e151 { number } else { 1.0 };
        let (triangle, values) = (triangle.map(|vertex| vertex.map(moderate)), values.map(moderate));
        let walk = Walk { clamp: StepClamp::Everywhere, ..edges };
        let [low, high] = [values.into_iter().fold(f64::MAX, f64::min), values.into_iter().fold(f64::MIN, f64::max)];
        // The new point is rounded.
        let dust = 1e-15 * low.abs().max(high.abs());
        step_values(carried(triangle, values.map(|v| [v])), walk, rect, |_, _, [value]| {
            assert!((low - dust..=high + dust).contains(&value), "{value}");
        });
    }

    #[test]
    fn payloads_do_not_pass_their_end([value, start, end, count] in numbers()) {
        let stepped = value.stepped(f64::slope(start, end, count), count);
        for limit in [StepClamp::Edges, StepClamp::Everywhere] {
            let [clamped] = [stepped].clamped([start], [end], limit);
            let is_beyond = if start < end { clamped > end } else { start > end && clamped < end };
            assert!(!is_beyond, "{clamped} of {start} to {end}");
        }
    }

    #[test]
    fn weights_of_any_numbers(p in point(), triangle in triangle(), numbers in numbers::<6>()) {
        let [a, b, c] = triangle;
        if Winding::of(twice_signed_area(a, b, c)).is_none() {
            assert!(barycentric_weights(p, triangle).iter().all(|weight| !weight.is_finite()));
        }
        perspective_weights_of::<f64>(numbers);
        perspective_weights_of::<f32>(numbers);
    }
}

/// A number as bits, zeros with their signs; all NaN are one: which of them it is, the processor chooses.
fn bits_of(number: f64) -> u64 {
    if number.is_nan() { f64::NAN.to_bits() } else { number.to_bits() }
}

fn perspective_weights_of<R: Scalar>(numbers: [f64; 6]) {
    let numbers: [R; 6] = reals(numbers);
    let [weights, w] = [0, 3].map(|first| from_fn(|i| numbers[first + i]));
    let corrected = perspective_weights(weights, w);
    let bits = |numbers: [R; 3]| numbers.map(|number| bits_of(number.into()));
    if w.contains(&R::of(0.0)) {
        assert_eq!(bits(corrected), bits(weights), "they stay as they are");
    }
    let [a, b] = [(w[0], weights[0]), (w[1], weights[1])].map(|(w, value)| Projected { w, values: [value] });
    assert_eq!(
        bits([linear(a.values, b.values, w[2])[0]; 3]),
        bits([(weights[1] - weights[0]) * w[2] + weights[0]; 3])
    );
    for interpolation in INTERPOLATIONS {
        let _ = interpolation.between(a, b, w[2]);
    }
}

// Chapter 3: texture; chapter 10: mipmap; chapter 11: srgb.

fn assert_texels<R: Scalar>(texture: &Texture, maps: &MipMaps, numbers: [f64; 5]) {
    let [u, v, level, du, dv]: [R; 5] = reals(numbers);
    for mode in MODES {
        assert_within(texture.nearest([u, v], mode), [0.0, 255.0]);
        let shaded = Shaded::<R>::texel(texture.nearest_texel([u, v], mode));
        let [red, green, blue] = texture.nearest([u, v], mode);
        assert_eq!((shaded.color.channels(), shaded.keep), ([red, green, blue, R::of(1.0)], true));
        for mixed in [
            texture.bilinear([u, v], mode),
            maps.bilinear([u, v], level, mode),
            maps.trilinear([u, v], level, mode),
        ] {
            // Infinity has no fraction, nor has what becomes infinite when it is scaled.
            let is_scaled = [u, v].map(|c| Into::<f64>::into(c * R::of(21.0)).is_finite()) == [true; 2];
            if mode == AddressMode::Clamp || is_scaled {
                assert_within(mixed, [-0.001, 255.001]);
            }
        }
    }
    let last = (maps.count() - 1) as f64;
    for changes in [[[u, v], [du, dv]], [[du, dv], [u, v]]] {
        assert_within([maps.level_of_detail(changes[0], changes[1]); 3], [0.0, last]);
    }
}

fn assert_light<R: Scalar>(numbers: [f64; 3]) {
    let numbers: [R; 3] = reals(numbers);
    assert_within(srgb::decode(numbers), [0.0, 1.0]);
    for (light, stored) in numbers.into_iter().zip(srgb::encode(numbers)) {
        let [light, stored]: [f64; 2] = [light.into(), stored.into()];
        assert_eq!(stored, if light >= 1.0 { 255.0 } else { f64::from(channel(stored)) });
        assert!(light > 0.0 || stored == 0.0, "{light} gives {stored}");
    }
}

proptest! {
    #[test]
    fn texels_of_any_coordinates(numbers in numbers(), shades in prop::collection::vec(any::<u8>(), 21)) {
        for (width, height) in [(7, 3), (3, 7), (1, 21), (21, 1)] {
            let texture = Texture::new(width, height, shades.iter().map(|&shade| Color::gray(shade)).collect());
            let maps = MipMaps::new(&texture);
            assert_texels::<f64>(&texture, &maps, numbers);
            assert_texels::<f32>(&texture, &maps, numbers);
        }
    }

    #[test]
    fn light_of_any_numbers(numbers in numbers()) {
        assert_light::<f64>(numbers);
        assert_light::<f32>(numbers);
    }
}

// Chapters 4, 8 and 10: transform.

fn borders(viewport: Viewport) -> [[f64; 2]; 2] {
    let Viewport { x, y, width, height } = viewport;
    [[x, x + width], [y, y + height]]
}

proptest! {
    #[test]
    fn matrices_of_any_numbers(numbers in numbers::<9>(), angle in any_number()) {
        let [eye, target, up] = from_fn(|k| DVec3::from_array(from_fn(|i| numbers[3 * k + i])));
        let project = transform::perspective(eye, target.x);
        assert!(project.w == eye.z || eye.z.is_nan());
        assert_eq!(transform::orthographic(eye).w, 1.0);
        assert!(!transform::perspective_divide(eye.extend(0.0)).is_finite());
        let [left, right, bottom, top, near, far] = from_fn(|i| numbers[3 + i]);
        let symmetric = Frustum::from_field_of_view(angle, top, near, far);
        for frustum in [Frustum { left, right, bottom, top, near, far }, symmetric] {
            let clip = [frustum.project(eye), frustum.project_zero_to_one(eye)];
            assert!(clip.iter().all(|clip| clip.w.to_bits() == eye.z.to_bits() || eye.z.is_nan()));
            let _ = frustum.matrix();
        }
        let turns = [transform::rotate_x_to_y, transform::rotate_z_to_y, transform::rotate_x_to_z];
        for turn in turns.map(|turn| turn(angle)) {
            assert_eq!(turn.is_finite(), angle.is_finite());
            assert!(!turn.is_finite() || turn.to_cols_array().iter().all(|number| number.abs() <= 1.0));
            let _ = transform::about(eye, turn);
        }
        assert_eq!(transform::translate(eye).is_finite(), eye.is_finite());
        assert_eq!(transform::scale(eye).is_finite(), eye.is_finite());
        let _ = transform::look_at(eye, target, up);
        assert!(!transform::look_at(eye, eye, up).is_finite());
        assert!(!transform::look_at(DVec3::ZERO, up, up).is_finite());
        assert!(!transform::normal_matrix(transform::scale(dvec3(0.0, eye.y, eye.z))).is_finite());
        assert!(!transform::normal_matrix(DMat4::ZERO).is_finite());
    }

    #[test]
    fn viewports_lie_in_the_middle(rect in any_rect(), aspect in any_number(), ndc in numbers::<3>()) {
        let (whole, fitting) = (Viewport::whole(rect), Viewport::fitting(rect, aspect));
        for ([low, high], [from, to]) in borders(whole).into_iter().zip(borders(fitting)) {
            // A side without pixels stays one.
            assert!(low > high || (low <= from && from <= to && to <= high), "{fitting:?} in {whole:?}");
            assert!(low >= high || to - from >= 1.0, "{fitting:?}");
        }
        let ndc = DVec3::from_array(ndc);
        for screen in [fitting.pixel_corners(ndc), fitting.pixel_areas(ndc)] {
            assert!(!ndc.truncate().is_nan() || screen.is_nan());
        }
        assert!(fitting.matrix().is_finite());
        for viewport in [None, Some(fitting)] {
            let state = RenderState { viewport, ..RenderState::default() };
            assert_eq!(state.viewport_in(rect), viewport.unwrap_or(whole));
        }
    }
}

// Chapter 6: depth, target.

fn assert_depths<R: Scalar>(numbers: [f64; 2], (x, y): (i32, i32)) {
    let [depth, stored]: [R; 2] = reals(numbers);
    let is_none = numbers.iter().any(|number| number.is_nan());
    for test in TESTS {
        let mut target = Target::<R>::sized(3, 2);
        target.set_observer(Some(Arc::new(Curious)));
        target.clear(Color::RED, stored);
        let passes = test.passes(depth, stored);
        assert!(test == DepthTest::Always || !(passes && is_none), "NaN passes {test:?}");
        let is_inside = target.color.rect().contains(x, y);
        assert_eq!(target.depth.test_and_set(x, y, depth, test), passes && is_inside);
        let bits = target.depth.get(x, y).map(|depth| bits_of(depth.into()));
        let expected: f64 = if passes { depth } else { stored }.into();
        assert_eq!(bits, is_inside.then_some(bits_of(expected)));
        for depth_write in [false, true] {
            let options = Merge { depth_test: test, depth_write, blend: Blend::Additive };
            let shaded = Shaded::translucent([depth; 3], stored);
            let verdict = merge(&mut target, options, Rounding::Nearest, (x, y), depth, shaded);
            assert!(is_inside || verdict == Verdict::Hidden);
            let opaque = Shaded::opaque([depth; 3]).color.channels().map(|number| bits_of(number.into()));
            assert_eq!(opaque, [depth, depth, depth, R::of(1.0)].map(|number| bits_of(number.into())));
            let discarded =
                merge(&mut target, options, Rounding::Nearest, (x, y), depth, shaded.discard(true));
            assert_eq!(discarded, Verdict::Discarded);
        }
    }
}

fn assert_stored(depth: f64) {
    for format in [DepthFormat::Unorm24, DepthFormat::Float32] {
        let (stored, step) = (format.stored(depth), format.step(depth));
        assert_eq!(stored.is_nan(), depth.is_nan());
        if (0.0..1.0).contains(&depth) {
            assert!(step > 0.0 && (stored - depth).abs() <= 0.500_001 * step, "{stored} for {depth}");
            assert_eq!(format.stored(stored), stored, "what is stored stays");
        }
    }
}

fn assert_blended<R: Scalar>(numbers: [f64; 7]) {
    let [red, green, blue, opacity, there @ ..]: [R; 7] = reals(numbers);
    let apply = |blend: Blend| blend.apply([red, green, blue, opacity], there);
    assert!(apply(Blend::Additive).iter().all(|&channel| channel <= R::of(255.0)));
    let _ = apply(Blend::SourceOver);
    let source = apply(Blend::Opaque);
    let clamped = |half: f64| source.map(|number| channel((number + R::of(half)).into()));
    assert_eq!(Rounding::Truncate.color(source).channels(), clamped(0.0));
    assert_eq!(Color::truncated(source.map(Into::into)).channels(), clamped(0.0));
    assert_eq!(Rounding::Nearest.color(source).channels(), clamped(0.5));
}

proptest! {
    #[test]
    fn depths_and_blending_of_any_numbers(numbers in numbers(), x in any_whole(), y in any_whole()) {
        assert_depths::<f64>([numbers[0], numbers[1]], (x, y));
        assert_depths::<f32>([numbers[0], numbers[1]], (x, y));
        assert_blended::<f64>(numbers);
        assert_blended::<f32>(numbers);
        let [z, near, far, ..] = numbers;
        for encoding in [DepthEncoding::ViewZ, DepthEncoding::Reciprocal, DepthEncoding::Ndc] {
            let clip_z = encoding.clip_z(z, near, far);
            assert!(!encoding.is_linear_on_screen() || clip_z == -1.0 || encoding == DepthEncoding::Ndc);
        }
        let _ = [z_from_w(z, near, far), w_from_z(z, near, far)];
        for (w, expected) in [(near, 1.0), (far, 0.0)] {
            let [above, below] = [near * (far - w), (far - near) * w];
            let reversed = reversed_z_from_w(w, near, far);
            let is_lost = |number: f64| !number.is_finite() || number == 0.0;
            assert!(is_lost(below) || above.is_infinite() || above.is_nan() || reversed == expected, "{reversed}");
            assert_eq!(reversed_z_from_w(z, near, far).is_nan(), {
                let [above, below] = [near * (far - z), (far - near) * z];
                above.is_nan() || below.is_nan() || (above == 0.0 && below == 0.0) || (above.is_infinite() && below.is_infinite())
            });
        }
        for depth in [z, near, far] {
            assert_stored(depth);
        }
    }

    #[test]
    fn targets_are_filled_within(triangle in triangle(), numbers in numbers::<9>()) {
        let mut target = Target::new(5, 4);
        target.clear(Color::BLACK, f64::MAX);
        let vertices = from_fn(|i| (Projected { w: numbers[i], values: [numbers[3 + i]] }, numbers[6 + i]));
        target.fill(carried(triangle, vertices), |[value]| Color::truncated([value; 3]));
        for (x, y) in (0..20).map(|i| (i % 5, i / 5)) {
            let depth = target.depth.get(x, y).expect("inside");
            assert!(depth == f64::MAX || (depth < f64::MAX && split(triangle).is_some()), "{depth}");
        }
    }
}

// Chapter 7: clip; chapter 9: mesh, varyings.

fn clip_vertex() -> impl Strategy<Value = ClipVertex<1>> {
    let vertex =
        |[x, y, z, w, value]: [f64; 5]| ClipVertex { position: DVec4::new(x, y, z, w), varyings: [value] };
    numbers().prop_map(vertex)
}

/// Distances have the sign of what is compared, however large that is.
fn assert_distances(position: DVec4, distance: f64) {
    let DVec4 { x, y, z, w } = position;
    let compared = [[x, -w], [w, x], [y, -w], [w, y], [z, -w], [w, z]];
    for (plane, [greater, less]) in Plane::CANONICAL.into_iter().zip(compared) {
        let found = plane.signed_distance(position);
        assert_eq!((found >= 0.0, found < 0.0), (greater >= less, greater < less), "{plane:?} {position}");
    }
    assert_eq!(Plane::ZERO_TO_ONE[4].signed_distance(position), z);
    let found = Plane::in_front(distance).signed_distance(position);
    assert_eq!((found >= 0.0, found < 0.0), (w >= distance, w < distance), "{distance} {position}");
}

fn assert_varyings<R: Scalar>(vertices: &[NdcVertex<1>; 3], screen: [DVec2; 3], numbers: [f64; 2]) {
    let weights: [R; 2] = reals(numbers);
    for interpolation in INTERPOLATIONS {
        let varyings = TriangleVaryings::<R, 1>::new(vertices, interpolation);
        let vertex = LinearVaryings::<R, 1>::new(&vertices[0], interpolation);
        let moved = vertex.moved(&varyings.change(weights), weights[0]).multiplied(interpolation);
        let point = varyings.at(weights);
        let same = varyings.linear_at(weights).multiplied(interpolation);
        assert_eq!(format!("{point:?}"), format!("{same:?}"));
        let gradients: [[R; 2]; 2] = weight_gradients(screen);
        let derivatives = varyings.derivatives(&moved, gradients);
        let along = gradients.map(|weights| varyings.change(weights).derivative(&moved, interpolation));
        assert_eq!(
            format!("{:?}{:?}", derivatives.dx, derivatives.dy),
            format!("{:?}{:?}", along[0], along[1])
        );
        let (change, point) = (varyings.change(gradients[0]), moved.values[0]);
        let expected = match interpolation {
            Interpolation::Affine => change.values[0],
            _ => (change.values[0] - point * change.distance) * moved.w,
        };
        assert_eq!(bits_of(along[0][0].into()), bits_of(expected.into()));
    }
}

proptest! {
    #[test]
    fn what_is_left_of_a_triangle_is_finite(
        vertices in prop::array::uniform3(clip_vertex()), normal in numbers::<5>(), screen in triangle(),
    ) {
        let [x, y, z, w, distance] = normal;
        let odd = [Plane::homogeneous(DVec4::new(x, y, z, w)), Plane::in_front(distance)];
        for test in [ClipTest::BeforeDivide, ClipTest::AfterDivide] {
            for volume in [ClipVolume::Everything, ClipVolume::InFront(distance), ClipVolume::Canonical] {
                for planes in [&volume.planes(DepthRange::ZeroToOne)[..], &odd] {
                    let polygon = clip_triangle(vertices, planes, test);
                    assert!(polygon.iter().all(|vertex| vertex.position.is_finite()), "{polygon:?}");
                    assert_eq!(Target::new(1, 1).clip_triangle(vertices, planes, test).len(), polygon.len());
                    assert_eq!(fan(polygon.clone()).count(), polygon.len().saturating_sub(2));
                }
            }
            let kept: ArrayVec<_, 2> = clip_polygon(&vertices, &odd[0], test);
            let none: ArrayVec<_, 0> = clip_polygon(&vertices[..1], &odd[1], test);
            assert!(kept.len() <= 2 && none.is_empty() && clip_polygon::<1, 9>(&[], &odd[0], test).is_empty());
            assert_panics("a seventh plane", || clip_triangle(vertices, &[odd[0]; 7], test));
        }
        for position in vertices.map(|vertex| vertex.position).into_iter().filter(|it| it.is_finite()) {
            assert_distances(position, distance);
        }
        let divided = vertices.map(NdcVertex::from);
        assert!(divided.iter().all(|vertex| vertex.w != 0.0));
        assert!(divided.each_ref().map(RecordedVertex::from).iter().all(|vertex| vertex.varyings.len() == 1));
        assert_varyings::<f64>(&divided, screen, [x, y]);
        assert_varyings::<f32>(&divided, screen, [x, y]);
    }
}

#[test]
fn meshes_name_their_vertices() {
    for index in [3, i32::MAX as u32, u32::MAX] {
        let refused = Mesh::indexed(vec![(); 3], vec![0, 1, index]);
        assert_eq!(refused.err(), Some(MeshError::IndexOutOfRange { index, vertices: 3 }));
    }
    assert!(
        Mesh::unindexed(vec![(); usize::MAX - 1]).is_err_and(|error| error.to_string().contains("whole"))
    );
    let indexed = Mesh::indexed(vec![0.0, f64::NAN, 2.0], vec![0, 1, 2, 2, 1, 0]).expect("two triangles");
    let mapped = indexed.map(|vertex| vertex * f64::MAX);
    for mesh in [&indexed, &mapped, &indexed.to_unindexed()] {
        assert_eq!(mesh.triangles().count(), mesh.triangle_count());
        // Three times the last number is 2, where 64 bits end.
        for number in [2, 3, usize::MAX / 3, usize::MAX / 3 + 1, usize::MAX] {
            assert_panics("a triangle that there is not", || mesh.triangle(number));
        }
    }
}
