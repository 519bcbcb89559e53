//! Figures: fit, picture, sketch, knobs; of inspect what draws.

use std::ops::Range;

use rasterbook::exact::edge::snap;
use rasterbook::figure::picture::{
    Zoom, difference, draw_enlarged, draw_enlarged_within, enlarged, paste, side_by_side, width_side_by_side,
    zoomed,
};
use rasterbook::figure::{DrawOptions, Fit, Knob, Knobs, Sketch, Value, Variant, stroke};
use rasterbook::inspect::{Steps, heat_legend, overdraw, with_legend};

use super::*;

const KNOBS: [Knob; 6] = [
    Knob::number("number", 0.5, [-2.0, 7.0], "", ""),
    Knob::whole("whole", 0, [i32::MIN, i32::MAX], "", ""),
    Knob::choice("choice", &["a", "b", "c"], ""),
    Knob::switch("switch", false, ""),
    Knob::point("point", [0.0, 0.0], ""),
    Knob::color("color", Color::RED, ""),
];

/// What a sketch leaves in a white picture of 7 × 5 pixels whose scene has this size: which pixels are red.
fn sketched(size: [f64; 2], part: Rect, draw: impl FnOnce(&mut Sketch<'_>)) -> (Fit, impl Fn(Pixel) -> bool) {
    let mut picture = Framebuffer::new(7, 5);
    let fit = Fit::new(picture.rect(), size);
    draw(&mut Sketch::new(&mut picture, fit).within(part));
    let is_red = move |(x, y)| picture.get(x, y) == Some(Color::RED);
    assert!(Rect::sized(7, 5).pixels().all(|pixel| part.contains(pixel.0, pixel.1) || !is_red(pixel)));
    (fit, is_red)
}

/// Sizes of a scene: one that is enlarged, one that stays, and others.
fn scene() -> impl Strategy<Value = [f64; 2]> {
    prop_oneof![Just([3.5, 2.5]), Just([7.0, 5.0]), Just([1e9, 1e9]), Just([1e-9, 1e-9]), numbers()]
}

proptest! {
    #[test]
    fn strokes_have_their_width([a, b, _] in triangle(), width in any_number()) {
        let [[first, second, third], [fourth, fifth, sixth]] = stroke([a, b], width);
        assert_eq!(format!("{first}{third}"), format!("{fourth}{fifth}"), "they share an edge");
        let square = (b - a).length_squared();
        if square == 0.0 || square.is_infinite() {
            assert!(second == third || !width.is_finite(), "no width, and no area: {second} {third}");
        } else if width.abs() < 1e6 && a.abs().max_element() < 1e6 && (1e-6..1e12).contains(&square) {
            assert!((first.distance(sixth) - width.abs()).abs() < 1e-6, "{first} {sixth}");
            assert!((second.distance(third) - width.abs()).abs() < 1e-6, "{second} {third}");
        }
    }

    #[test]
    fn sketches_stay_in_their_part(
        size in scene(), part in small_rect(), points in triangle(), length in any_number(), number in any::<u32>(),
    ) {
        let [a, b, _] = points;
        let (fit, is_red) = sketched(size, part, |sketch| sketch.triangle(points, Color::RED));
        let is_near = points.iter().all(|&point| snap(fit.at(point)).is_some());
        assert!(is_near || !Rect::sized(7, 5).pixels().any(is_red));

        let (fit, is_red) = sketched(size, part, |sketch| sketch.line(a, b, length, Color::RED));
        assert!((fit.at(a) + fit.at(b)).is_finite() || !Rect::sized(7, 5).pixels().any(is_red));

        let (fit, is_red) = sketched(size, part, |sketch| sketch.dot(a, length, Color::RED));
        let (center, radius) = (fit.at(a), length * fit.scale);
        for (x, y) in part.intersection(Rect::sized(7, 5)).pixels() {
            let distance = center.distance(DVec2::new(x.into(), y.into()) + 0.5);
            // Beyond, squares are infinite; and some are rounded.
            if radius.abs() < 1e150 && center.abs().max_element() < 1e150 && (distance - radius).abs() > 1e-6 {
                assert_eq!(is_red((x, y)), distance < radius, "({x}, {y}): {center} {radius}");
            }
            assert!(!is_red((x, y)) || radius >= 0.0);
        }

        let (fit, is_red) = sketched(size, part, |sketch| sketch.bar(a, b, Color::RED));
        let [low, high] = [a, b].map(|point| fit.at(point).round());
        for (x, y) in part.intersection(Rect::sized(7, 5)).pixels().filter(|_| !(low + high).is_nan()) {
            let point = DVec2::new(x.into(), y.into());
            assert_eq!(is_red((x, y)), low.cmple(point).all() && point.cmplt(high).all(), "({x}, {y})");
        }

        let (fit, is_red) = sketched(size, part, |sketch| sketch.number(number, a, Color::RED));
        // Ten digits are forty dots wide, each of two pixels of the scene and at least one of the picture. Dots that are as
        // large as numbers go reach the picture from anywhere.
        let is_far = fit.scale < 1e6 && fit.at(a).abs().max_element() > 100.0 * fit.scale.max(1.0);
        assert!(!is_far || !Rect::sized(7, 5).pixels().any(is_red));
    }

    #[test]
    fn scenes_fit(
        picture in any_rect(), size in numbers(), at in point(), rect in any_rect(), reach in any_number(),
    ) {
        let fit = Fit::new(picture, size);
        let _ = (fit.at(at), fit.back(at), fit.rect(rect));
        let placed = fit.triangle([ScreenVertex { position: at, varyings: reach }; 3]);
        let bits = |point: DVec2| point.to_array().map(bits_of);
        assert!(placed.iter().all(|vertex| bits(vertex.position) == bits(fit.at(at))));
        assert!(placed.iter().all(|vertex| vertex.varyings.to_bits() == reach.to_bits()));
        let mark = fit.mark(at, reach);
        let pixel = (at.x as i32, at.y as i32);
        if reach >= 0.0 && fit.scale >= 0.0 && pixel.0 < i32::MAX && pixel.1 < i32::MAX {
            assert!(mark.contains(pixel.0, pixel.1), "{mark:?} is not around {pixel:?}");
        }
    }

    #[test]
    fn parts_are_inside(x in any_whole(), y in any_whole(), factor in 1_u32..70, left in any_whole()) {
        let mut picture = Framebuffer::new(5, 4);
        for factor in [factor, Zoom::MAX_FACTOR, u32::MAX] {
            let part = Zoom { factor, center: Some((x, y)) }.part(picture.rect());
            assert!(!part.rows().is_empty() && !part.columns().is_empty());
            assert_eq!(part, part.intersection(picture.rect()));
        }
        let zoom = Zoom { factor, center: Some((x, y)) };
        assert!(zoomed(&picture, zoom).width() >= enlarged(&picture, factor).width());
        let mut white = picture.clone();
        white.clear(Color::WHITE);
        paste(&mut picture, &white, left, y);
        let is_pasted = |x: i32, y: i32| picture.get(x, y) == Some(Color::WHITE);
        for x in 0..5 {
            let is_white = (-3..4).contains(&y) && (left..left.saturating_add(5)).contains(&x);
            assert_eq!(is_pasted(x, y.max(0)), is_white);
        }
        draw_enlarged_within(&mut picture, Rect::sized(0, 0), (factor, 1), |screen| screen.clear(Color::RED));
    }

    #[test]
    fn screens_lie_in_the_middle_of_any_part(
        part in any_rect(), (width, height) in (1_u32..9, 1_u32..9), observed in any::<bool>(),
    ) {
        let mut picture = Framebuffer::new(5, 4);
        picture.set_observer(observed.then(|| Arc::new(Curious) as _));
        // Of one axis there is only room for the screen itself: a block of any size would be too large a picture.
        let low = Rect { bottom: -3, top: height as i32 - 3, ..part };
        let thin = Rect { left: 2, right: width as i32 + 2, ..part };
        let middle = |columns: Range<i32>, side: u32| {
            let free = (i64::from(columns.end) - i64::from(columns.start)).max(0) - i64::from(side);
            (i64::from(columns.start) + free.div_euclid(2)).clamp(i32::MIN.into(), i32::MAX.into()) as f64
        };
        for part in [low, thin] {
            let clear = |screen: &mut Framebuffer| screen.clear(Color::RED);
            let cells = draw_enlarged_within(&mut picture, part, (width, height), clear);
            let place = DVec2::new(middle(part.columns(), width), middle(part.rows(), height));
            assert_eq!((cells.at(DVec2::ZERO), cells.scale), (place, 1.0));
        }
    }

    #[test]
    fn knobs_stay_in_range(fraction in 0.0..=1.0, steps in any_whole(), number in any_number(), point in point()) {
        for knob in &KNOBS {
            let values = [Some(knob.stepped(knob.default(), steps)), knob.at(fraction)];
            for value in values.into_iter().flatten() {
                let mut knobs = Knobs::new(&KNOBS, (640, 480));
                // The point is stepped out of the picture, which is what a text must not do.
                if !matches!(value, Value::Point(_)) {
                    knobs.set(&format!("{}={}", knob.name, knob.shown(value))).expect("in range");
                    let put = knobs.iter().find(|(other, _)| other.name == knob.name);
                    assert_eq!(put.map(|(_, value)| value), Some(value));
                }
            }
        }
        let mut knobs = Knobs::new(&KNOBS, (640, 480));
        knobs.put("point", Value::Point(point));
        assert!(Viewport::whole(Rect::sized(641, 481)).width > knobs.point("point").x);
        assert!(knobs.point("point").cmpge(DVec2::ZERO).all(), "{}", knobs.point("point"));
        let set = knobs.set(&format!("number={number}"));
        assert_eq!(set.is_ok(), (-2.0..=7.0).contains(&number));
        assert!(knobs.set(&format!("whole={number}.5")).is_err());
        let _ = KNOBS[2].shown(Value::Choice(usize::MAX));
    }
}

#[test]
fn writes_are_counted_where_an_enlarged_screen_is_far_away() {
    fn draw(picture: &mut Framebuffer) {
        let far = Rect { left: i32::MAX - 1, bottom: i32::MIN, right: i32::MAX, top: i32::MIN + 1 };
        draw_enlarged_within(picture, far, (4, 4), |screen| {
            screen.set(3, 3, Color::RED);
            // As a program may say that draws blocks of its own.
            let (rect, observer) = (screen.rect(), screen.observer().expect("writes are counted"));
            for factor in [0, 1 << 31, u32::MAX] {
                observer.enlarged(Some(Enlargement { screen: rect, factor, origin: (0, 0) }));
                screen.set(0, 0, Color::RED);
                screen.set(3, 3, Color::RED);
            }
        });
    }
    let variant = Variant::new("far", draw, "").size(2, 1);
    let (picture, lines) = overdraw(&variant, &variant.options(None));
    assert_eq!(picture.get(0, 0), picture.get(1, 0));
    assert_eq!(lines[3], "2: yellow (2 pixels)", "of two blocks, each larger than the picture");
}

#[test]
fn sizes_are_judged_before_anything_is_drawn() {
    let variant = Variant::new("none", |_: &mut Framebuffer| unreachable!("it is too large"), "");
    for size in [(u32::MAX, u32::MAX), (1 << 31, 1), (1 << 16, 1 << 15), (1 << 13, 1 << 12)] {
        let options = DrawOptions { size, ..variant.options(None) };
        let (width, height) = Steps::new(&variant, &options).expect_err("too many steps").fitting;
        assert!(u64::from(width) * u64::from(height) <= 1 << 24, "{width}×{height} do not fit");
    }
}

#[test]
fn the_largest_pictures_are_compared_and_explained() {
    const MOST: u32 = Framebuffer::MAX_SIDE;
    let other = Framebuffer::new(2, 2);
    for (width, height, below) in
        [(MOST, 1, 22), (1, MOST, 0), (1, 1, 118), (MOST, 23, 22), (23, MOST - 117, 0), (23, MOST - 118, 118)]
    {
        let mut picture = Framebuffer::new(width, height);
        let black = picture.clone();
        let (right, top) = (width as i32 - 1, height as i32 - 1);
        picture.set(right, top, Color::RED);
        let (marked, count) = difference(&black, &picture).expect("of the same size");
        assert_eq!((marked.rect(), count), (picture.rect(), 1));
        assert!(difference(&picture, &other).is_none());

        let shown = with_legend(picture);
        assert!(shown.width() >= width && shown.height() == height + below, "{shown:?}");
        assert_eq!(shown.get(right, top + below as i32), Some(Color::RED));
    }
    assert!(heat_legend().lines().count() == 1 && heat_legend().contains("black 0"));
}

#[test]
fn too_large_pictures_panic() {
    let picture = Framebuffer::new(3, 3);
    // Three times the second is 2, where 32 bits end.
    for factor in [0, 1_431_655_766, u32::MAX] {
        assert_panics("an enlarged picture", || enlarged(&picture, factor));
        assert_panics("a zoomed picture", || zoomed(&picture, Zoom { factor, center: None }));
    }
    for screen in [(0, 1), (1, 0), (Framebuffer::MAX_SIDE + 1, 1), (u32::MAX, u32::MAX)] {
        assert_panics("an enlarged screen", || draw_enlarged(&mut Framebuffer::new(3, 3), screen, |_| ()));
    }
    assert_panics("no factor", || Zoom { factor: 0, center: None }.part(picture.rect()));
    assert_eq!([vec![], vec![u32::MAX; 2], vec![u32::MAX]].map(width_side_by_side), [None; 3]);
    assert!(side_by_side(&[]).is_none() && side_by_side(&vec![picture; 5000]).is_none());
    let mut knobs = Knobs::new(&KNOBS, (640, 480));
    assert_panics("a wrong kind", || knobs.number("whole"));
    knobs.put("none", Value::Switch(true));
    assert_panics("no knob", || knobs.is_on("none"));
}
