//! Figures: fit, picture, knobs.

use rasterbook::figure::picture::{Zoom, draw_enlarged_within, enlarged, paste, side_by_side, zoomed};
use rasterbook::figure::{Fit, Knob, Knobs, Value};

use super::*;

const KNOBS: [Knob; 6] = [
    Knob::number("number", 0.5, [-2.0, 7.0], "", ""),
    Knob::whole("whole", 0, [i32::MIN, i32::MAX], "", ""),
    Knob::choice("choice", &["a", "b", "c"], ""),
    Knob::switch("switch", false, ""),
    Knob::point("point", [0.0, 0.0], ""),
    Knob::color("color", Color::RED, ""),
];

proptest! {
    #[test]
    fn scenes_fit(
        picture in any_rect(), size in numbers(), at in point(), rect in any_rect(), reach in any_number(),
    ) {
        let fit = Fit::new(picture, size);
        let _ = (fit.at(at), fit.back(at), fit.rect(rect));
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
fn too_large_pictures_panic() {
    let picture = Framebuffer::new(3, 3);
    // Three times the second is 2, where 32 bits end.
    for factor in [0, 1_431_655_766, u32::MAX] {
        assert_panics("an enlarged picture", || enlarged(&picture, factor));
        assert_panics("a zoomed picture", || zoomed(&picture, Zoom { factor, center: None }));
    }
    assert_panics("no factor", || Zoom { factor: 0, center: None }.part(picture.rect()));
    assert!(side_by_side(&[]).is_none() && side_by_side(&vec![picture; 5000]).is_none());
    let mut knobs = Knobs::new(&KNOBS, (640, 480));
    assert_panics("a wrong kind", || knobs.number("whole"));
    knobs.put("none", Value::Switch(true));
    assert_panics("no knob", || knobs.is_on("none"));
}
