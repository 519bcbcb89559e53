//! Beside the data flow: somebody who watches how a picture comes about.
//!
//! A framebuffer can carry an [`Observer`]; the framebuffer itself reports to it, and so do the stages that draw into it.
//! All methods do nothing by default. Nothing that an observer does changes a picture. The pipeline of
//! chapter 9 reports more: see [`probe`](crate::probe).
//!
//! A stage announces what it is about to do with a value of its own type, such as [`line::Line`](crate::line::Line).
//! That is why [`Observer::begun`] takes `&dyn Any`: this room comes before all stages, and names none of them.
//!
//! ```
//! use std::sync::Arc;
//! use std::sync::atomic::{AtomicU32, Ordering};
//! use rasterbook::observer::Observer;
//! use rasterbook::{Color, Framebuffer, Pixel};
//!
//! /// Counts the pixels that are written.
//! #[derive(Debug, Default)]
//! struct Writes(AtomicU32);
//!
//! impl Observer for Writes {
//!     fn written(&self, _: Pixel, _: Color) {
//!         self.0.fetch_add(1, Ordering::Relaxed);
//!     }
//! }
//!
//! let writes = Arc::new(Writes::default());
//! let mut framebuffer = Framebuffer::new(4, 3);
//! framebuffer.set_observer(Some(writes.clone()));
//! framebuffer.set(1, 1, Color::RED);
//! assert_eq!(writes.0.load(Ordering::Relaxed), 1);
//! ```

use std::any::Any;
use std::fmt::Debug;
use std::sync::Arc;

use crate::color::Color;
use crate::rect::{Pixel, Rect};

/// A small screen that a picture shows, each of its pixels as a block of the picture's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Enlargement {
    /// The pixels of the screen.
    pub screen: Rect,
    /// How many pixels of the picture a block is wide and high.
    pub factor: u32,
    /// The lower left pixel of the block that shows the pixel (0, 0) of the screen.
    pub origin: Pixel,
}

impl Enlargement {
    /// The pixel of the screen that a pixel of the picture shows; beside the blocks, one outside the screen.
    ///
    /// # Panics
    /// If the factor is 0.
    #[must_use]
    pub fn pixel_at(self, (x, y): Pixel) -> Pixel {
        // Of blocks of one pixel there are more than numbers: the last stand for those beyond.
        let block = |place: i32, origin: i32| {
            let number = (i64::from(place) - i64::from(origin)).div_euclid(self.factor.into());
            number.clamp(i32::MIN.into(), i32::MAX.into()) as i32
        };
        (block(x, self.origin.0), block(y, self.origin.1))
    }
}

/// Somebody who watches the stages. Recording needs a cell or a lock: the stages share the observer.
pub trait Observer: Debug {
    /// A pixel of the framebuffer has been given a color.
    fn written(&self, _pixel: Pixel, _color: Color) {}

    /// All pixels have been given a color.
    fn cleared(&self, _color: Color) {}

    /// A depth has been compared with the stored one.
    fn tested(&self, _pixel: Pixel, _depth: f64, _stored: f64, _passed: bool) {}

    /// What follows happens on a screen of its own, which the picture shows enlarged; with `None`, on the picture again.
    fn enlarged(&self, _enlargement: Option<Enlargement>) {}

    /// A stage begins with something: a value of the stage's own type. What emits pixels says when it is [done](Self::done);
    /// a triangle that is [clipped](crate::clip::Assembled) is followed by its pieces instead.
    fn begun(&self, _what: &dyn Any) {}

    /// What was begun last is done.
    fn done(&self) {}

    /// Something else that is worth knowing about a pixel.
    fn note(&self, _pixel: Pixel, _text: &dyn Fn() -> String) {}
}

/// An observer that a framebuffer and the stages share.
pub type SharedObserver = Arc<dyn Observer + Send + Sync>;

#[cfg(test)]
mod tests {
    use super::*;

    use std::sync::Mutex;

    use glam::{dvec2, dvec4};

    use crate::clip::{Assembled, ClipTest, ClipVertex, NdcVertex, Plane, RecordedVertex};
    use crate::depth::DepthTest;
    use crate::exact::edge::Coverage;
    use crate::exact::samples::{CENTER, Samples};
    use crate::line::{Line, StepAxis, dda};
    use crate::scanline::{EdgeWalk, HalfFill, spans};
    use crate::{Framebuffer, Target};

    /// What it is told, a line each.
    #[derive(Debug, Default)]
    struct Told(Mutex<Vec<String>>);

    impl Told {
        fn push(&self, line: String) {
            self.0.lock().expect("not poisoned").push(line);
        }

        /// The lines so far; it begins anew.
        fn take(&self) -> Vec<String> {
            std::mem::take(&mut self.0.lock().expect("not poisoned"))
        }
    }

    impl Observer for Told {
        fn written(&self, pixel: Pixel, color: Color) {
            self.push(format!("{pixel:?} {color:?}"));
        }

        fn cleared(&self, color: Color) {
            self.push(format!("all {color:?}"));
        }

        fn tested(&self, pixel: Pixel, depth: f64, stored: f64, passed: bool) {
            self.push(format!("{pixel:?} {depth} {stored} {passed}"));
        }

        fn begun(&self, what: &dyn Any) {
            let line = what.downcast_ref().map(|line: &Line| format!("{line:?}"));
            let half = what.downcast_ref().map(|half: &HalfFill| format!("{half:?}"));
            let coverage = what.downcast_ref().map(|coverage: &Coverage| format!("{coverage:?}"));
            let assembled = what.downcast_ref().map(|assembled: &Assembled| format!("{assembled:?}"));
            self.push(line.or(half).or(coverage).or(assembled).unwrap_or_default());
        }

        fn done(&self) {
            self.push("done".to_owned());
        }

        fn note(&self, pixel: Pixel, text: &dyn Fn() -> String) {
            self.push(format!("{pixel:?} {}", text()));
        }
    }

    fn told() -> (Arc<Told>, Option<SharedObserver>) {
        let told = Arc::new(Told::default());
        (told.clone(), Some(told))
    }

    #[test]
    fn writing_is_told() {
        let (told, observer) = told();
        let mut framebuffer = Framebuffer::new(2, 1);
        framebuffer.set(0, 0, Color::BLUE);
        framebuffer.set_observer(observer);
        framebuffer.clear(Color::RED);
        framebuffer.set(1, 0, Color::GREEN);
        framebuffer.set(2, 0, Color::GREEN);
        framebuffer.fill(framebuffer.rect(), Color::BLUE);
        let [red, green, blue] = [Color::RED, Color::GREEN, Color::BLUE].map(|color| format!("{color:?}"));
        let expected = [
            format!("all {red}"),
            format!("(1, 0) {green}"),
            format!("(0, 0) {blue}"),
            format!("(1, 0) {blue}"),
        ];
        assert_eq!(told.take(), expected, "what is outside is not written");
        framebuffer.set_observer(None);
        framebuffer.clear(Color::RED);
        assert!(told.take().is_empty());
    }

    #[test]
    fn a_target_tells_of_colors_and_of_depths() {
        let (told, observer) = told();
        let mut framebuffer = Framebuffer::new(2, 1);
        framebuffer.set_observer(observer);
        let mut target = Target::<f64>::like(&framebuffer);
        target.clear(Color::RED, 0.5);
        let passed = [0.75, 0.25].map(|depth| target.depth.test_and_set(1, 0, depth, DepthTest::Less));
        assert_eq!(passed, [false, true]);
        assert!(!target.depth.test_and_set(2, 0, 0.25, DepthTest::Less));
        let expected =
            [format!("all {:?}", Color::RED), "(1, 0) 0.75 0.5 false".into(), "(1, 0) 0.25 0.5 true".into()];
        assert_eq!(told.take(), expected);
    }

    #[test]
    fn what_is_drawn_is_told_before_its_pixels_and_done_after_them() {
        let (told, observer) = told();
        let mut framebuffer = Framebuffer::new(4, 4);
        framebuffer.set_observer(observer);
        let scissor = framebuffer.scissor();
        let mut mark = |x, y| framebuffer.set(x, y, Color::RED);

        let line = Line { a: dvec2(0.0, 0.0), b: dvec2(1.0, 0.0), axis: StepAxis::Longer };
        dda(line.a, line.b, line.axis, scissor.clone(), &mut mark);
        let pixel = format!("(0, 0) {:?}", Color::RED);
        assert_eq!(told.take(), [format!("{line:?}"), pixel.clone(), "done".to_owned()]);

        // One row: the lower half has none.
        let triangle = [dvec2(0.0, 0.0), dvec2(0.5, 0.0), dvec2(0.0, 1.0)];
        spans(triangle, EdgeWalk::Clamped, scissor.clone(), |span| {
            span.columns().for_each(|x| mark(x, span.y));
        });
        let lines = told.take();
        assert!(lines[0].starts_with("HalfFill") && lines[2].starts_with("HalfFill"), "{lines:?}");
        assert_eq!([&lines[1], &lines[3], &lines[4]], ["done", &pixel, "done"]);

        let coverage = Coverage::new([dvec2(0.0, 0.0), dvec2(1.2, 0.0), dvec2(0.0, 1.2)]).expect("an area");
        coverage.pixels(scissor.clone()).for_each(|(x, y, _)| mark(x, y));
        assert_eq!(told.take(), [format!("{coverage:?}"), pixel, "done".to_owned()]);
        assert_eq!(coverage.all_pixels(scissor).count(), 16);
        assert_eq!(told.take(), [format!("{coverage:?}"), "done".to_owned()]);
    }

    #[test]
    fn samples_are_told_by_their_numbers() {
        let (told, observer) = told();
        let mut framebuffer = Framebuffer::new(2, 1);
        framebuffer.set_observer(observer);
        let mut samples = Samples::like(&framebuffer, &CENTER);
        assert_eq!(samples.rect(), framebuffer.rect());
        for depth in [0.5, 0.75, 0.5] {
            samples.draw(1, 0, 0, depth, Color::RED);
        }
        let red = format!("{:?}", Color::RED);
        let line = |depth: &str, stored: &str, passes: &str| {
            format!("(1, 0) sample 0: {depth} against {stored}, {red} {passes}")
        };
        let expected = [
            line("0.5000", "inf", "drawn"),
            line("0.7500", "0.5000", "hidden"),
            line("0.5000", "0.5000", "drawn"),
        ];
        assert_eq!(told.take(), expected);
    }

    #[test]
    fn what_is_clipped_is_told_with_its_planes() {
        let (told, observer) = told();
        let mut target = Target::<f64>::sized(1, 1);
        target.set_observer(observer);
        let vertex = |x, u| ClipVertex { position: dvec4(x, 0.5, 0.25, 2.0), varyings: [u] };
        let triangle = [vertex(0.0, 1.0), vertex(1.0, 2.0), vertex(0.5, 3.0)];
        let left = target.clip_triangle(triangle, &[Plane::RIGHT], ClipTest::AfterDivide);
        assert_eq!(left.as_slice(), triangle);
        let vertices = [(0.0, 1.0), (1.0, 2.0), (0.5, 3.0)]
            .map(|(x, u)| RecordedVertex { position: dvec4(x, 0.5, 0.25, 2.0), varyings: vec![u] });
        let test = ClipTest::AfterDivide;
        let assembled = Assembled { vertices, model: None, planes: vec![Plane::RIGHT], test };
        assert_eq!(told.take(), [format!("{assembled:?}")]);

        // After the divide w is kept; of a recorded vertex the position comes back.
        let recorded = RecordedVertex::from(&NdcVertex::from(triangle[1]));
        assert_eq!(recorded, RecordedVertex { position: dvec4(0.5, 0.25, 0.125, 2.0), varyings: vec![2.0] });
        let position = dvec4(0.5, 0.25, 0.125, 2.0);
        assert_eq!(ClipVertex::<0>::from(&recorded), ClipVertex { position, varyings: [] });
    }

    #[test]
    fn blocks_of_an_enlarged_screen() {
        let enlargement = Enlargement { screen: Rect::sized(4, 3), factor: 10, origin: (5, 7) };
        let at = |x, y| enlargement.pixel_at((x, y));
        assert_eq!([at(5, 7), at(14, 16), at(15, 7), at(5, 17)], [(0, 0), (0, 0), (1, 0), (0, 1)]);
        assert_eq!([at(4, 7), at(5, 6), at(28, 40)], [(-1, 0), (0, -1), (2, 3)]);
        let far = Enlargement { factor: 1, origin: (i32::MAX, i32::MIN), ..enlargement };
        assert_eq!(
            far.pixel_at((i32::MIN, i32::MAX)),
            (i32::MIN, i32::MAX),
            "farther than there are numbers"
        );
    }
}
